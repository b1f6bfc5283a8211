//! Derivatives of wear and life beside differences of the same over steps of parameters, and beside what is known exactly.

use std::path::Path;

use linkwear::backend::Backend;
use linkwear::codegen::{Options, SourceFile};
use linkwear::life::{Coupling, LifeStudy, Trajectories};
use linkwear::mechanism::Mechanism;
use linkwear::sensitivity::{SensitivityError, SensitivityResult, SensitivityStudy};

fn file(name: &str) -> SourceFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    SourceFile {
        name: name.to_owned(),
        text: std::fs::read_to_string(path).expect("a file of this repository"),
    }
}

/// Few clearances, and steps that every turn is followed in.
fn study(source: &SourceFile) -> SensitivityStudy<'_> {
    SensitivityStudy { points: 3, step: Some(5e-5), ..SensitivityStudy::new(source) }
}

fn by(study: &SensitivityStudy<'_>, names: &[&str]) -> SensitivityResult {
    let parameters = Some(names.iter().map(|name| (*name).to_owned()).collect());
    SensitivityStudy { parameters, ..study.clone() }.run().expect("derivatives")
}

/// S [J] and depth [m] of a revolution of the unworn joint, and the life, with parameters set.
fn at(study: &SensitivityStudy<'_>, set: &[(&str, String)]) -> [f64; 3] {
    let mut options = study.options.clone();
    options.overrides.extend(set.iter().map(|(name, value)| ((*name).to_owned(), value.clone())));
    let found = by(&SensitivityStudy { options, ..study.clone() }, &[]);
    [found.joints[0].wear_integral.value, found.joints[0].depth.value, found.life.cycles.value]
}

/// p/y dy/dp by differences of order 4.
fn differences(
    (study, middle): (&SensitivityStudy<'_>, [f64; 3]),
    (name, value, unit): (&str, f64, &str),
    part: f64,
) -> [f64; 3] {
    let moved = |steps: f64| at(study, &[(name, format!("{:?} {unit}", value * (1.0 + part * steps)))]);
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(moved);
    std::array::from_fn(|which| {
        let slope = (8.0 * (c[which] - b[which]) - (d[which] - a[which])) / (12.0 * part);
        slope / middle[which]
    })
}

/// A parameter, its value and unit, and the step of differences by it, as a part of it.
type Asked = (&'static str, f64, &'static str, f64);

/// Differences agree to what curvature of order 5 and settling to 1e-8 leave.
fn vary_as_differences_do(study: &SensitivityStudy<'_>, asked: &[Asked]) {
    let found = by(study, &asked.iter().map(|(name, ..)| *name).collect::<Vec<_>>());
    let middle = at(study, &[]);
    // What follows one direction has one thread: parameters side by side.
    let all: Vec<[f64; 3]> = std::thread::scope(|scope| {
        let one = |(name, value, unit, part): Asked| differences((study, middle), (name, value, unit), part);
        let work: Vec<_> = asked.iter().map(|asked| scope.spawn(move || one(*asked))).collect();
        work.into_iter().map(|thread| thread.join().expect("differences")).collect()
    });
    for ((place, (name, ..)), differences) in asked.iter().enumerate().zip(all) {
        let joint = &found.joints[0];
        for (of, difference) in
            [&joint.wear_integral, &joint.depth, &found.life.cycles].into_iter().zip(differences)
        {
            let own = found.elasticity(of, place).expect("a value");
            assert!((own - difference).abs() < 1e-5, "{name}: {own} {difference}");
        }
    }
}

/// The life is one to 2 um, in which no body bounces: where bodies do, differences are as rough as the wear itself.
#[test]
fn wear_and_life_vary_as_their_differences_do() {
    let source = file("mechanisms/rssr.toml");
    let short = [("W_crit".to_owned(), "2 um".to_owned())].to_vec();
    let options = Options { overrides: short, ..Options::default() };
    let study = SensitivityStudy { options, ..study(&source) };
    vary_as_differences_do(
        &study,
        &[
            ("L1", 120.0, "mm", 2e-3),
            ("c_rocker", 2.0, "N m s/rad", 2e-3),
            ("E", 210.0, "GPa", 2e-3),
            ("c0", 10.0, "um", 2e-3),
        ],
    );
    // Forces bend with the speed: its differences are over shorter steps. Turns of other lengths have other numbers of steps, whose errors
    // must not show.
    let fine = SensitivityStudy { step: Some(2.5e-5), ..study };
    vary_as_differences_do(&fine, &[("speed", 2.0, "Hz", 5e-4)]);
}

/// Where bodies come apart, a life varies as lives of the dynamics do: at 98.5 and 101.5 % of a parameter, where the study asks for none. Its
/// derivative is as near to their difference as it says.
#[test]
fn a_life_in_which_bodies_come_apart_varies_as_lives_do() {
    for (name, parameter, value, unit, rough) in [
        ("mechanisms/rssr.toml", "c_rocker", 2.0, "N m s/rad", 0.02),
        ("mechanisms/rssr_ball_wear.toml", "L1", 120.0, "mm", 2e-3),
    ] {
        let source = file(name);
        let found = by(&study(&source), &[parameter]);
        assert!(found.life.is_by_lives && found.losses > 0, "{name}");
        let cycles = |factor: f64| {
            let set = (parameter.to_owned(), format!("{:?} {unit}", value * factor));
            let options = Options { overrides: vec![set], ..Options::default() };
            let mechanism = Mechanism::compile(&source, &options, Backend::Auto).expect("a mechanism");
            let (coupling, trajectories) = (Some(Coupling::Full), Trajectories::MeanPath);
            let life = LifeStudy { coupling, trajectories, ..LifeStudy::new(&mechanism) };
            life.run().expect("a life").end.cycles
        };
        let difference = (cycles(1.015) / cycles(0.985)).ln() / (1.015_f64 / 0.985).ln();
        let own = found.elasticity(&found.life.cycles, 0).expect("a value");
        let doubt = (found.life.cycles.doubts[0] * own / found.life.cycles.by[0]).abs();
        println!("{name}, {parameter}: {own} +- {doubt}, lives {difference}");
        assert!(doubt < rough * own.abs(), "{name}: {own} +- {doubt}");
        // The lives that it is compared with are known as little as its own.
        assert!((own - difference).abs() < 2.0 * doubt, "{name}: {own} +- {doubt}, lives {difference}");
    }
}

/// Poisson's ratio ends at 0.5.
#[test]
fn where_bodies_come_apart_and_no_lives_are_beside_a_parameter_it_is_refused() {
    let source = file("mechanisms/rssr_ball_wear.toml");
    let options = Options { overrides: vec![("nu".to_owned(), "0.4996".to_owned())], ..Options::default() };
    let parameters = Some(vec!["nu".to_owned()]);
    let asked = SensitivityStudy { options, parameters, ..study(&source) };
    let refused = asked.run().expect_err("no lives beside it");
    assert!(matches!(&refused, SensitivityError::NoLives { parameter } if parameter == "nu"), "{refused}");
}

/// The life goes as H over k, whatever the motion does; by its threshold it grows as fast as the last cycle wears.
#[test]
fn a_life_varies_with_the_constants_of_wear_as_it_must() {
    let source = file("mechanisms/rssr_ball_wear.toml");
    let study = study(&source);
    let found = by(&study, &["k_wear", "hardness"]);
    let elasticity = |at| found.elasticity(&found.life.cycles, at).expect("a value");
    assert!((elasticity(0) + 1.0).abs() < 1e-6 && (elasticity(1) - 1.0).abs() < 1e-6);
    let wear = found.elasticity(&found.joints[0].depth, 0).expect("a value");
    assert!((wear - 1.0).abs() < 1e-9, "{wear}");
}

/// The mean of random lives, by the same random numbers on both sides of a parameter: within 3 standard errors of the difference.
#[test]
fn the_mean_of_random_lives_varies_as_its_differences_do() {
    let source = file("mechanisms/rssr.toml");
    let study = SensitivityStudy { trajectories: 400, ..study(&source) };
    let found = by(&study, &["c_rocker", "wear_rate"]);
    let random = found.random.as_ref().expect("random lives");
    for (place, (name, value, unit)) in
        [("c_rocker", 2.0, "N m s/rad"), ("wear_rate", 13.65, "1/um")].into_iter().enumerate()
    {
        let part = 0.02;
        let mean = |sign: f64| {
            let set = (name.to_owned(), format!("{:?} {unit}", value * (1.0 + sign * part)));
            let options = Options { overrides: vec![set], ..Options::default() };
            let found = by(&SensitivityStudy { options, ..study.clone() }, &[]);
            let random = found.random.expect("random lives");
            (random.mean.value, random.error)
        };
        let ((above, error), (below, _)) = (mean(1.0), mean(-1.0));
        let step = 2.0 * part * found.parameters[place].value;
        let (difference, own) = ((above - below) / step, random.mean.by[place]);
        // Draws of the two sides share their numbers, but not what is rejected of them: at worst they are independent.
        let bound = 3.0 * (random.errors[place].powi(2) + 2.0 * (error / step).powi(2)).sqrt();
        println!("{name}: {own:e} +- {:e}, difference {difference:e}, bound {bound:e}", random.errors[place]);
        assert!((own - difference).abs() < bound, "{name}: {own} {difference} {bound}");
    }
}

/// Impacts without a period have no derivative; and what cannot be varied says why.
#[test]
fn what_has_no_derivative_is_refused() {
    let chatters = file("mechanisms/four_bar_wear.toml");
    let asked =
        SensitivityStudy { parameters: Some(vec!["c2".to_owned()]), step: Some(2e-5), ..study(&chatters) };
    let refused = asked.run().expect_err("it never settles");
    let has_no_period =
        matches!(refused, SensitivityError::NotSettled { .. } | SensitivityError::NoPeriod { .. });
    assert!(has_no_period, "{refused}");
    let source = file("mechanisms/rssr.toml");
    let by =
        |name: &str| SensitivityStudy { parameters: Some(vec![name.to_owned()]), ..study(&source) }.run();
    let refused = by("modes").expect_err("a whole number");
    assert!(matches!(&refused, SensitivityError::At { parameter, .. } if parameter == "modes"), "{refused}");
    let refused = by("c1").expect_err("no such parameter");
    assert!(matches!(refused, SensitivityError::UnknownParameter { .. }), "{refused}");
    let refused =
        SensitivityStudy::new(&file("mechanisms/rssr_rigid.toml")).run().expect_err("nothing wears");
    assert!(matches!(refused, SensitivityError::NothingWears), "{refused}");
    let text = rotor("").text;
    let (head, rest) = text.split_once("[parameters]").expect("parameters");
    let (_, rest) = rest.split_once("[points]").expect("points");
    let text = format!("{head}[points]{}", rest.replace("\"k\"", "1e-7"));
    let refused = SensitivityStudy::new(&SourceFile { text, ..rotor("") }).run().expect_err("no parameters");
    assert!(matches!(refused, SensitivityError::NoParameters), "{refused}");
}

/// A rotor on one journal whose contact widens as it wears.
fn rotor(wear: &str) -> SourceFile {
    let text = format!(
        "spec = 1\nname = \"rotor\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[parameters]\nk = 1e-7\nfb = 1\nal = \"2 1/um\"\nbe = \"3 1/um\"\n\
         hr = 0.5\n[points]\nO = [0, 0, 0]\n[bodies]\n\
         rotor = {{ mass = \"10 kg\", centre = \"O\", inertia = [\"1e-2 kg m^2\", \"1e-2 kg m^2\", \"1e-2 kg m^2\"] }}\n[joints]\n\
         R1 = {{ revolute = [\"ground\", \"rotor\"], at = \"O\", axis = [0, 0, 1], drive = \"2*pi*2 Hz*t\" }}\n[clearance.R1]\n\
         radial = \"50 um\"\njournal_radius = \"10 mm\"\nlength = \"20 mm\"\nmodulus = \"50 GPa\"\nrestitution = 0.3\n[wear.R1]\n\
         coefficient = \"k\"\nhardness = \"1 GPa\"\nthreshold = \"40 um\"\nrevolutions_per_cycle = 5e4\n{wear}"
    );
    SourceFile { name: "rotor.toml".to_owned(), text }
}

/// 50 kg beside 0.02 kg m^2 make a factor of one, which the equations leave out, and a power of one is none: beside such a value they have
/// a form of their own.
#[test]
fn a_number_that_meets_others_by_accident_varies_as_one_that_does_not() {
    let text = rotor("").text.replace("10 kg", "m").replace("1e-2 kg m^2", "j");
    let numbers = "[parameters]\nm = \"50 kg\"\nj = \"0.02 kg m^2\"\n";
    let source = SourceFile { text: text.replace("[parameters]\n", numbers), ..rotor("") };
    let elasticities = |set: &[(&str, &str)], names: &[&str]| {
        let overrides = set.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        let options = Options { overrides, ..Options::default() };
        let found = by(&SensitivityStudy { options, ..SensitivityStudy::new(&source) }, names);
        let all = (0..names.len()).map(|at| found.elasticity(&found.life.cycles, at).expect("a value"));
        all.collect::<Vec<f64>>()
    };
    // By the law of Hertz the contact is as wide as the root of the load.
    let [met, apart] = ["50 kg", "51 kg"].map(|mass| elasticities(&[("m", mass)], &["k", "m", "j"]));
    for ((met, apart), expected) in met.iter().zip(&apart).zip([-1.0, -0.5, 0.0]) {
        assert!((met - apart).abs() < 1e-5 && (met - expected).abs() < 1e-3, "{met} {apart} {expected}");
    }
}

/// A part that is drawn turned begins at an angle that is that of its drive to the last digit or not: beside 0.2 rad it is on one side, and
/// is not on the other. Where two constants are one number, a sum has its operands in another order.
#[test]
fn a_number_that_is_another_but_for_rounding_leaves_the_form_as_it_is() {
    let text = rotor("").text;
    let text = text.replace("[parameters]\n", "[parameters]\nR = \"20 mm\"\ntilt = \"0.5 rad\"\n");
    let place = "Q = { at = [\"R*cos(tilt)\", \"R*sin(tilt)\", 0], on = \"rotor\" }\n";
    let text = text.replace("O = [0, 0, 0]\n", &format!("O = [0, 0, 0]\n{place}"));
    let part = text.replace("centre = \"O\"", "centre = \"Q\"").replace("*t\"", "*t + tilt\"");
    let folder = std::env::temp_dir().join(format!("linkwear-turned-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("part.toml"), part).expect("a part");
    let text = "spec = 1\nname = \"two\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[parameters]\nlean = \"0.2 rad\"\n\
                [include.left]\nfile = \"part.toml\"\n[include.right]\nfile = \"part.toml\"\n\
                parameters = { tilt = \"2*lean\" }\norigin = [\"1 m\", 0, 0]\n\
                rotation = { axis = [0, 1, 0], angle = \"180 deg\" }\n";
    let name = folder.join("two.toml").display().to_string();
    let source = SourceFile { name, text: text.to_owned() };
    let found =
        by(&SensitivityStudy { points: 3, step: Some(1e-4), ..SensitivityStudy::new(&source) }, &["lean"]);
    std::fs::remove_dir_all(&folder).expect("the folder");
    // Where a turn begins does not matter: turns settle to 1e-8 of their wear, and to 1e-4 where gaps close now here, now there.
    let elasticity = found.elasticity(&found.life.cycles, 0).expect("a value");
    assert!(elasticity.abs() < 1e-4, "{elasticity}");
}

/// The others are answered; nothing is left if it is the only one.
#[test]
fn a_parameter_that_cannot_be_varied_takes_no_answers_from_others() {
    let text = rotor("").text.replace("[parameters]\n", "[parameters]\ntwice = \"2*k\"\n");
    let source = SourceFile { text, ..rotor("") };
    let study = SensitivityStudy::new(&source);
    let found = by(&study, &["twice", "k"]);
    let left_out: Vec<&str> = found.left_out.iter().map(|one| &*one.parameter).collect();
    assert_eq!((left_out, &*found.parameters[0].name, found.parameters.len()), (vec!["twice"], "k", 1));
    let alone = SensitivityStudy { parameters: Some(vec!["twice".to_owned()]), ..study };
    let refused = alone.run().expect_err("a formula");
    assert!(matches!(&refused, SensitivityError::Formula { parameter } if parameter == "twice"), "{refused}");
}

/// The mean path of a life with a parameter set.
fn mean_path(source: &SourceFile, (name, value): (&str, f64)) -> f64 {
    let overrides = vec![(name.to_owned(), format!("{value:?}"))];
    let options = Options { overrides, ..Options::default() };
    let mechanism = Mechanism::compile(source, &options, Backend::Auto).expect("a mechanism");
    let study = LifeStudy {
        coupling: Some(Coupling::Full),
        trajectories: Trajectories::MeanPath,
        ..LifeStudy::new(&mechanism)
    };
    study.run().expect("a life").end.cycles
}

#[test]
fn lives_vary_with_all_that_the_mean_path_goes_by() {
    let by_lives = |source: &SourceFile, name: &str, value: f64| {
        let [below, above] = [0.99, 1.01].map(|part| mean_path(source, (name, part * value)).ln());
        (above - below) / (1.01_f64.ln() - 0.99_f64.ln())
    };
    // How much of the wear the clearance takes: at each clearance turns wear the same, but clearances are others.
    let source = rotor("feedback = \"fb\"\nalpha = \"al\"\n");
    let found = SensitivityStudy {
        parameters: Some(vec!["fb".to_owned()]),
        trajectories: 200,
        ..SensitivityStudy::new(&source)
    };
    let found = found.run().expect("derivatives");
    let lived = by_lives(&source, "fb", 1.0);
    let told = found.elasticity(&found.life.cycles, 0).expect("a value");
    // Curvature over a hundredth, and steps of a life.
    assert!(lived < -0.1 && (told / lived - 1.0).abs() < 2e-3, "{told} {lived}");
    let random = found.random.as_ref().expect("they were asked for");
    let of_mean = found.elasticity(&random.mean, 0).expect("a value");
    let error = random.errors[0] / random.mean.value;
    assert!((of_mean - lived).abs() < 4.0 * error + 2e-3, "{of_mean} +- {error} {lived}");
    // The mean path is slower than physics by beta over alpha.
    let source = rotor("alpha = \"al\"\nbeta = \"be\"\n");
    let found = by(&SensitivityStudy::new(&source), &["al", "be", "k"]);
    let elasticity = |at| found.elasticity(&found.life.cycles, at).expect("a value");
    for (at, expected) in [(0, -1.0), (1, 1.0), (2, -1.0)] {
        assert!((elasticity(at) - expected).abs() < 1e-6, "{at}: {}", elasticity(at));
    }
    // Within a cycle, a fortieth of the life here, a life opens the clearance as physics does.
    let life = mean_path(&source, ("k", 1e-7));
    assert!((found.life.cycles.value / life - 1.0).abs() < 0.01, "{} {life}", found.life.cycles.value);
    // Of many small increments few lives would tell all.
    let short = SourceFile { text: source.text.replace("5e4", "1e3"), ..source };
    let refused = SensitivityStudy {
        parameters: Some(vec!["k".to_owned()]),
        trajectories: 200,
        ..SensitivityStudy::new(&short)
    };
    let refused = refused.run().expect_err("increments of a small shape");
    assert!(
        matches!(&refused, SensitivityError::SmallShape { joint, shape } if joint == "R1" && *shape < 0.1),
        "{refused}"
    );

    // A journal that wears, too, has no derivatives of its own: lives say what comes of it.
    let source = rotor("hardness_ratio = \"hr\"\nalpha = \"al\"\n");
    let found = by(&SensitivityStudy::new(&source), &["k", "hr"]);
    let elasticity = |at| found.elasticity(&found.life.cycles, at).expect("a value");
    assert!(found.life.is_by_lives && (elasticity(0) + 1.0).abs() < 1e-3, "{}", elasticity(0));
    let lived = by_lives(&source, "hr", 0.5);
    let doubt = found.life.cycles.doubts[1] * 0.5 / found.life.cycles.value;
    assert!((elasticity(1) - lived).abs() < doubt.max(2e-3), "{} {lived} {doubt}", elasticity(1));
}

/// A slider-crank whose crank pin rings in its bearing, never leaving it.
const RINGING: &str = "spec = 1
name = \"ringing\"
gravity = [0, \"-9.81 m/s^2\", 0]
[parameters]
c2 = 15
[points]
O = [0, 0, 0]
A = [\"38.567256581192359 mm\", \"45.962666587138677 mm\", 0]
B = [\"233.21420179277161 mm\", 0, 0]
[bodies]
crank = { rod = [\"O\", \"A\"], radius = \"8 mm\", density = \"7850 kg/m^3\" }
rod = { rod = [\"A\", \"B\"], radius = \"7 mm\", density = \"7850 kg/m^3\" }
piston = { mass = \"1.2 kg\", centre = \"B\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }
[joints]
J1 = { revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1], drive = \"2*pi*3 Hz*t\" }
J2 = { revolute = [\"crank\", \"rod\"], at = \"A\", axis = [0, 0, 1] }
J3 = { revolute = [\"rod\", \"piston\"], at = \"B\", axis = [0, 0, 1] }
J4 = { prismatic = [\"ground\", \"piston\"], at = \"B\", axis = [1, 0, 0], damping = \"20 N s/m\" }
[forces]
gas = { force = \"piston\", at = \"B\", components = [\"-300 N\", 0, 0] }
[clearance.J2]
radial = \"c2*1 um\"
journal_radius = \"8 mm\"
length = \"16 mm\"
modulus = \"60 GPa\"
restitution = 0.6
friction = 0.08
[wear.J2]
coefficient = 2e-8
hardness = \"1.5 GPa\"
threshold = \"30 um\"
revolutions_per_cycle = 1e5
area = \"hertz\"
";

#[test]
fn a_motion_that_repeats_varies_though_tangents_of_its_turns_do_not_settle() {
    let source = SourceFile { name: "ringing.toml".into(), text: RINGING.into() };
    let found = by(&study(&source), &["c2"]);
    assert_eq!(found.turns, 0, "its tangents settle: another mechanism is wanted here");
    assert!(found.life.is_by_lives && found.step_error.is_finite());
    let lives = [0.99, 1.01].map(|part| mean_path(&source, ("c2", part * 15.0)));
    let expected = (lives[1] / lives[0]).ln() / (1.01_f64 / 0.99).ln();
    let elasticity = found.elasticity(&found.life.cycles, 0).expect("a life");
    // Its life, of wear that goes with the root of the clearance, is curved by less than a thousandth over these per cent.
    assert!((elasticity - expected).abs() < 1e-3, "{elasticity}, not {expected}");
    // By Hertz, 2 b goes with the root of c R, S hardly at all.
    let depth = found.elasticity(&found.joints[0].depth, 0).expect("a depth");
    assert!((depth - 0.5).abs() < 0.01, "{depth}");
}
