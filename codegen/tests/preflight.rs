//! What `check` answers does not depend on size or speed, and is true of linkages that once were misjudged.

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::diagnostic::Diagnostics;
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Settings, Span, Watch, simulate};

const SLIDER_CRANK: &str = r#"
[points]
O = [0, 0, 0]
A = ["0.05*s", 0, 0]
P = ["0.17*s", 0, 0]
Q = ["0.19*s", 0, 0]
[bodies]
crank = { rod = ["O", "A"], radius = "0.005*s", density = "7850 kg/m^3" }
rod = { rod = ["A", "P"], radius = "0.005*s", density = "7850 kg/m^3" }
slider = { box = ["P", "Q"], width = "0.02*s", density = "7850 kg/m^3" }
[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }
R2 = { revolute = ["crank", "rod"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["rod", "slider"], at = "P", axis = [0, 0, 1] }
G = { prismatic = ["ground", "slider"], at = "P", axis = [1, 0, 0] }
"#;

/// The coupler spins between its balls; the loop is drawn open.
const RSSR: &str = r#"
[points]
O = [0, 0, 0]
A = ["0.12*s", 0, 0]
P = ["0.35*s", "0.05*s", "-0.3*s"]
B = { coupler = ["0.54*s", 0, 0], rocker = ["0.61*s", "0.05*s", "-0.3*s"] }
[bodies]
crank = { rod = ["O", "A"], radius = "0.006*s", density = "7850 kg/m^3" }
coupler = { rod = ["A", "B"], radius = "0.006*s", density = "7850 kg/m^3" }
rocker = { rod = ["P", "B"], radius = "0.006*s", density = "7850 kg/m^3" }
[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }
S2 = { spherical = ["crank", "coupler"], at = "A" }
R4 = { revolute = ["ground", "rocker"], at = "P", axis = [0, 1, 0] }
S3 = { spherical = ["coupler", "rocker"], at = "B" }
[assembly]
R4 = "-48 deg"
"#;

/// A wishbone on two balls, held by a strut whose lower end turns in a fork.
const WISHBONE: &str = r#"
[points]
S1 = [0, 0, 0]
S2 = ["0.3*s", 0, 0]
S3 = ["0.15*s", 0, "0.4*s"]
S4 = ["0.15*s", "0.5*s", "0.4*s"]
M = ["0.15*s", "0.25*s", "0.4*s"]
[bodies]
wishbone = { rod = ["S1", "S3"], radius = "0.01*s", density = "7850 kg/m^3" }
lower = { rod = ["S3", "M"], radius = "0.005*s", density = "7850 kg/m^3" }
upper = { rod = ["S4", "M"], radius = "0.008*s", density = "7850 kg/m^3" }
[joints]
B1 = { spherical = ["ground", "wishbone"], at = "S1" }
B2 = { spherical = ["ground", "wishbone"], at = "S2" }
U = { universal = ["wishbone", "lower"], at = "S3", axes = [[1, 0, 0], [0, 0, 1]] }
strut = { prismatic = ["lower", "upper"], at = "M", axis = [0, 1, 0] }
B4 = { spherical = ["ground", "upper"], at = "S4" }
"#;

/// A link on two balls, with or without a spring beside the line through them.
const LEVER: &str = r#"
[points]
S1 = [0, 0, 0]
S2 = ["0.3*s", 0, 0]
C = ["0.15*s", 0, 0]
E = ["0.15*s", 0, "0.4*s"]
T = ["0.15*s", "0.5*s", "0.4*s"]
[bodies]
lever = { mass = "2 kg", centre = "C", inertia = ["1 kg*s^2", "1 kg*s^2", "1 kg*s^2"] }
[joints]
B1 = { spherical = ["ground", "lever"], at = "S1", friction = "1e-4 N m s/rad" }
B2 = { spherical = ["ground", "lever"], at = "S2" }
"#;

fn file(body: &str, more: &str) -> SourceFile {
    let head = "spec = 1\nname = \"tried\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[parameters]\ns = \"1 m\"\nspeed = \"2 Hz\"\n";
    SourceFile { name: "tried.toml".to_owned(), text: format!("{head}{body}{more}") }
}

fn compiled(body: &str, more: &str, overrides: &[(&str, String)]) -> Compiled {
    let overrides = overrides.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    compile(&file(body, more), &Options { overrides, ..Options::default() }).unwrap_or_else(|e| panic!("{e}"))
}

/// The arms of a Delta robot, each with its parallelogram of rods on balls: the platform never turns.
fn delta() -> String {
    let (mut points, mut bodies, mut joints) = (String::new(), String::new(), String::new());
    let (base, platform, arm, rod, half) = (0.2_f64, 0.05, 0.2, 0.5_f64, 0.06);
    let (x, down) = (base + arm * 0.4_f64.cos(), -arm * 0.4_f64.sin());
    let z = down - (rod * rod - (x - platform).powi(2)).sqrt();
    for i in 0..3 {
        let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 3.0).sin_cos();
        let place = |x: f64, y: f64, z: f64| {
            format!("[\"{:?}*s\", \"{:?}*s\", \"{z:?}*s\"]", x * cosine - y * sine, x * sine + y * cosine)
        };
        points += &format!("B{i} = {}\nE{i} = {}\n", place(base, 0.0, 0.0), place(x, 0.0, down));
        bodies += &format!(
            "arm{i} = {{ rod = [\"B{i}\", \"E{i}\"], radius = \"0.008*s\", density = \"2700 kg/m^3\" }}\n"
        );
        joints += &format!(
            "R{i} = {{ revolute = [\"ground\", \"arm{i}\"], at = \"B{i}\", axis = [{:?}, {cosine:?}, 0], drive = \"0.2*sin(2*pi*speed*t)\" }}\n",
            -sine
        );
        for (side, y) in [("a", half), ("b", -half)] {
            let k = format!("{i}{side}");
            points += &format!("E{k} = {}\nP{k} = {}\n", place(x, y, down), place(platform, y, z));
            bodies += &format!(
                "f{k} = {{ rod = [\"E{k}\", \"P{k}\"], radius = \"0.004*s\", density = \"1600 kg/m^3\" }}\n"
            );
            joints += &format!(
                "U{k} = {{ spherical = [\"arm{i}\", \"f{k}\"], at = \"E{k}\" }}\nL{k} = {{ spherical = [\"f{k}\", \"platform\"], at = \"P{k}\" }}\n"
            );
        }
    }
    format!(
        "[points]\n{points}C = [0, 0, \"{z:?}*s\"]\nC2 = [0, 0, \"{:?}*s\"]\n[bodies]\n{bodies}platform = {{ rod = [\"C\", \"C2\"], radius = \"0.05*s\", density = \"2700 kg/m^3\" }}\n[joints]\n{joints}",
        z - 0.01
    )
}

#[test]
fn a_mechanism_of_any_size_and_speed_is_judged_alike() {
    let delta = delta();
    for (name, body, mobility, redundant, idle) in [
        ("slider-crank", SLIDER_CRANK, 1, 3, 0),
        ("RSSR", RSSR, 2, 0, 1),
        ("wishbone", WISHBONE, 1, 1, 0),
        ("Delta", &delta, 9, 0, 6),
    ] {
        let ordinary = compiled(body, "", &[]).analysis;
        for size in ["1e-9 m", "1e-6 m", "1 m", "1e4 m"] {
            for speed in ["1e-6 Hz", "1e4 Hz"] {
                let case = format!("{name} at {size}, {speed}");
                let compiled = compiled(body, "", &[("s", size.to_owned()), ("speed", speed.to_owned())]);
                let warnings: Vec<_> =
                    compiled.warnings.iter().map(|warning| warning.code.as_str()).collect();
                // No material stands cranks of a metre at 10,000 turns a second.
                let bursts = speed == "1e4 Hz" && !size.contains('-');
                let is_known = |code: &str| code == "W0104" || (code == "W0126" && bursts);
                assert!(warnings.iter().all(|code| is_known(code)), "{case}: {warnings:?}");
                assert_eq!(compiled.analysis.mobility, mobility, "{case}");
                assert_eq!(compiled.analysis.redundant.len(), redundant, "{case}");
                assert_eq!(compiled.analysis.idle.len(), idle, "{case}: {:?}", compiled.analysis.idle);
                assert_eq!(compiled.analysis, ordinary, "{case}");
            }
        }
    }
}

#[test]
fn a_spring_on_an_idle_freedom_makes_it_none() {
    let spring = "[forces]\nspring = { spring = [\"ground\", \"lever\"], at = [\"T\", \"E\"], stiffness = \"1 kN/m\", length = \"0.4 m\" }\n";
    let along = "[forces]\nspring = { spring = [\"ground\", \"lever\"], at = [\"S2\", \"C\"], stiffness = \"1 kN/m\", length = \"0.4 m\" }\n";
    let idle = |more: &str| compiled(LEVER, more, &[]).analysis.idle;
    assert_eq!(idle(spring), [""; 0]);
    let spins = ["lever spins freely about the line through B1 and B2"];
    assert_eq!(idle(along), spins);
    // Friction slows a spin down and leaves open where it ends.
    assert_eq!(idle("[forces]\n"), spins);
}

#[test]
fn a_start_beside_a_singular_position_is_taken() {
    let parallelogram = |start: &str| {
        format!(
            "[points]\nO = [0, 0, 0]\nA = [\"0.1 m\", 0, 0]\nB = [\"0.4 m\", 0, 0]\nD = [\"0.3 m\", 0, 0]\n[bodies]\n\
             crank = {{ rod = [\"O\", \"A\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }}\n\
             coupler = {{ rod = [\"A\", \"B\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }}\n\
             rocker = {{ rod = [\"D\", \"B\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }}\n[joints]\n\
             R1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1], drive = \"{start} + 10 rad/s*t\" }}\n\
             R2 = {{ revolute = [\"crank\", \"coupler\"], at = \"A\", axis = [0, 0, 1] }}\n\
             R3 = {{ revolute = [\"coupler\", \"rocker\"], at = \"B\", axis = [0, 0, 1] }}\n\
             R4 = {{ revolute = [\"ground\", \"rocker\"], at = \"D\", axis = [0, 0, 1] }}\n\
             [assembly]\nR4 = \"{start}\"\nR2 = \"-({start})\"\n"
        )
    };
    let code = |start: &str| match compile(&file(&parallelogram(start), ""), &Options::default()) {
        Ok(_) => "taken",
        Err(errors) => errors.list()[0].code.as_str(),
    };
    assert_eq!(
        ["0 deg", "1 deg", "180 deg", "90 deg", "1e-3 deg", "0.1 deg"].map(code),
        ["E0608", "taken", "E0608", "taken", "E0608", "taken"]
    );
}

#[test]
fn a_linkage_with_clearance_is_judged_as_if_it_had_none() {
    let joint = |text: &str, from: &str, to: &str| text.replacen(from, to, 1);
    let clearance = "[clearance.R3]\nradial = \"0.1 mm\"\njournal_radius = \"5 mm\"\nlength = \"20 mm\"\nmodulus = \"100 GPa\"\nlaw = \"lankarani_nikravesh\"\nrestitution = 0.9\n";
    let codes = |body: &str| -> Vec<&str> {
        match compile(&file(body, clearance), &Options::default()) {
            Ok(compiled) => compiled.warnings.iter().map(|warning| warning.code.as_str()).collect(),
            Err(errors) => errors.list().iter().map(|error| error.code.as_str()).collect(),
        }
    };
    let guide = "at = \"P\", axis = [1, 0, 0]";
    assert_eq!(codes(SLIDER_CRANK), [""; 0]);
    let second = joint(SLIDER_CRANK, guide, "at = \"P\", axis = [1, 0, 0], drive = \"0.01*s*sin(t*1 Hz)\"");
    assert_eq!(codes(&second), ["E0603"]);
    let crooked = joint(SLIDER_CRANK, "at = \"P\", axis = [0, 0, 1]", "at = \"P\", axis = [0, 0.5, 1]");
    assert_eq!(codes(&crooked), ["E0603"]);
    let driven = joint(&second, ", drive = \"2*pi*speed*t\"", "");
    assert_eq!(codes(&driven), ["E0608"]);
    let apart = "P = { rod = [\"0.17*s\", 0, 0], slider = [\"0.17*s\", \"0.3*s\", 0] }";
    let short = joint(SLIDER_CRANK, "P = [\"0.17*s\", 0, 0]", apart);
    let short = joint(&short, "Q = [\"0.19*s\", 0, 0]", "Q = [\"0.19*s\", \"0.3*s\", 0]");
    let short = joint(&short, guide, "at = \"Q\", axis = [1, 0, 0]");
    assert_eq!(codes(&short), ["E0601"]);
}

/// What warnings say of a file, with their places.
fn warnings(body: &str) -> String {
    let source = file(body, "");
    let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
    Diagnostics::from_list(compiled.warnings).located(&source).to_string()
}

#[test]
fn the_body_that_flies_is_the_loose_one() {
    let inertia = "inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"]";
    let body = format!(
        "[points]\nA = {{ at = [0, 0, 0], on = \"a\" }}\nB = {{ at = [\"0.1*s\", 0, 0], on = \"b\" }}\n[bodies]\n\
         a = {{ mass = \"1 kg\", centre = \"A\", {inertia} }}\nb = {{ mass = \"2 kg\", centre = \"B\", {inertia} }}\n[joints]\n\
         F = {{ free = [\"ground\", \"a\"], at = \"A\" }}\n\
         J = {{ revolute = [\"a\", \"b\"], at = \"A\", axis = [0, 0, 1], drive = \"2*pi*speed*t\" }}\n"
    );
    // The other body hangs by one joint, which is driven.
    let told = warnings(&body);
    assert!(told.contains("W0115") && told.contains("F = {") && !told.contains("b = {"), "{told}");
}

#[test]
fn what_a_file_integrates_beside_contacts_and_modes_is_no_matter_of_positions() {
    let body = "[points]\nO = [0, 0, 0]\nA = [\"0.2*s\", \"0.1*s\", 0]\nB = [\"0.4*s\", 0, 0]\n[bodies]\n\
        a = { rod = [\"O\", \"A\"], radius = \"5 mm\", density = \"2700 kg/m^3\", flexible = { modes = 1, young = \"70 GPa\" } }\n\
        b = { rod = [\"A\", \"B\"], radius = \"4 mm\", density = \"2700 kg/m^3\" }\n\
        c = { mass = \"0.1 kg\", centre = \"B\" }\n[joints]\n\
        R = { revolute = [\"ground\", \"a\"], at = \"O\", axis = [0, 0, 1], drive = \"0.2*sin(2*pi*speed*t)\" }\n\
        J = { revolute = [\"a\", \"b\"], at = \"A\", axis = [0, 0, 1] }\n\
        P = { prismatic = [\"ground\", \"c\"], at = \"B\", axis = [1, 0, 0] }\n\
        K = { revolute = [\"b\", \"c\"], at = \"B\", axis = [0, 0, 1] }\n\
        [clearance.J]\nradial = \"0.1 mm\"\njournal_radius = \"5 mm\"\nlength = \"10 mm\"\nmodulus = \"1 GPa\"\nrestitution = 0.8\n";
    let without = warnings(body);
    let state = "[states]\nx = { initial = \"0 rad\", rate = \"R.v\" }\n";
    // A state changes nothing about contacts and modes.
    assert_eq!(warnings(&format!("{body}{state}")), without);
}

/// A crank that drives a ram whose cylindrical guide lets it turn.
const TURNING_RAM: &str = r#"
[points]
O = [0, 0, 0]
A = ["0.05*s", 0, 0]
P = ["0.25*s", 0, 0]
C = ["0.25*s", 0, "0.1*s"]
[bodies]
crank = { rod = ["O", "A"], radius = "0.01*s", density = "7850 kg/m^3" }
rod = { rod = ["A", "P"], radius = "0.008*s", density = "7850 kg/m^3" }
ram = { mass = "2 kg", centre = "C", inertia = ["2e-3 kg*s^2", "2e-3 kg*s^2", "2e-3 kg*s^2"] }
[joints]
main = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }
big = { revolute = ["crank", "rod"], at = "A", axis = [0, 0, 1] }
wrist = { revolute = ["rod", "ram"], at = "P", axis = [0, 0, 1] }
gd = { cylindrical = ["ground", "ram"], at = "P", axis = [1, 0, 0], damping = { q2 = "100 N s/m" } }
"#;

/// Balls at both ends of the rod; of a slide or a hinge that closes the loop rows of angles are sines.
const BALL_ROD: &str = r#"
[points]
O = [0, 0, 0]
A = ["0.05*s", 0, 0]
B = ["0.3*s", "0.1*s", "0.12*s"]
C = ["0.3*s", "0.1*s", 0]
G = ["0.3*s", "0.14*s", "0.06*s"]
[bodies]
crank = { rod = ["O", "A"], radius = "0.01*s", density = "7850 kg/m^3" }
rod = { rod = ["A", "B"], radius = "0.006*s", density = "7850 kg/m^3" }
last = { mass = "1 kg", centre = "G", inertia = ["1e-3 kg*s^2", "2e-3 kg*s^2", "2e-3 kg*s^2"] }
[joints]
main = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }
s1 = { spherical = ["crank", "rod"], at = "A" }
s2 = { spherical = ["rod", "last"], at = "B" }
end = { revolute = ["ground", "last"], at = "C", axis = [0, 1, 0], cut = true }
"#;

/// Drive torques over a tenth of a turn.
fn torques(body: &str, more: &str, closure: Closure) -> Vec<f64> {
    let options = Options { closure: Some(closure), ..Options::default() };
    let compiled = compile(&file(body, more), &options).unwrap_or_else(|errors| panic!("{errors}"));
    let settings = Settings::new(Integrator::Rk4 { step: 1e-3 }, Span::Time(0.05), 6);
    let run = simulate(
        &compiled.interpreter(),
        compiled.description(),
        &compiled.parameters(),
        &settings,
        Watch::NONE,
    );
    run.expect("it runs").column("main.drive").expect("it is driven")
}

#[test]
fn a_guess_half_a_turn_off_does_not_turn_a_joint_over() {
    let slide = BALL_ROD.replace(
        "revolute = [\"ground\", \"last\"], at = \"C\"",
        "prismatic = [\"ground\", \"last\"], at = \"C\"",
    );
    // One that the crank can drive goes along the rod.
    let slide = slide.replace("axis = [0, 1, 0], cut", "axis = [1, 0, 0.2], cut");
    for (body, guess) in [
        (TURNING_RAM, "gd = { q1 = \"180 deg\" }"),
        (TURNING_RAM, "gd = { q1 = \"150 deg\" }"),
        (BALL_ROD, "s2 = [0, 0, \"170 deg\"]"),
        // Where the logarithm is no number.
        (BALL_ROD, "s1 = [0, 0, \"180 deg\"]"),
        (BALL_ROD, "s2 = [0, 0, \"180 deg\"]"),
        (&slide, "s2 = [0, \"179 deg\", 0]"),
    ] {
        let guess = format!("[assembly]\n{guess}\n");
        let [right, found] = [Closure::Log, Closure::Joint].map(|closure| torques(body, &guess, closure));
        let most = right.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
        for (found, right) in found.iter().zip(right) {
            // Rods spin about themselves at other rates, which moves no load; assembly ends within 1e-10 of the closed position.
            assert!((found - right).abs() < 1e-6 * most, "{guess}: {found} {right}");
        }
    }
}

#[test]
fn no_way_to_close_a_loop_turns_a_joint_over() {
    let yoke = "[points]\nO = [0, 0, 0]\nA = [\"0.1*s\", 0, 0]\n[bodies]\n\
        crank = { rod = [\"O\", \"A\"], radius = \"0.01*s\", density = \"7850 kg/m^3\" }\n\
        block = { mass = \"1 kg\", centre = \"A\", inertia = [\"1e-3 kg*s^2\", \"1e-3 kg*s^2\", \"1e-3 kg*s^2\"] }\n\
        yoke = { mass = \"2 kg\", centre = \"A\" }\n[joints]\n\
        main = { revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1], drive = \"2*pi*speed*t\" }\n\
        pin = { revolute = [\"crank\", \"block\"], at = \"A\", axis = [0, 0, 1] }\n\
        slot = { prismatic = [\"yoke\", \"block\"], at = \"A\", axis = [0, 1, 0] }\n\
        guide = { prismatic = [\"ground\", \"yoke\"], at = \"A\", axis = [1, 0, 0] }\n";
    // A Scotch yoke goes together in one way, which a pin half a turn off leads to as well.
    let turned = "[assembly]\npin = \"-180 deg\"\n";
    for more in ["", turned] {
        let assemblies = compiled(yoke, more, &[]).assemblies();
        assert_eq!(assemblies.others, Vec::<Vec<_>>::new(), "{more}");
        let pin = assemblies.taken.iter().find(|at| at.joint == "pin").expect("it is free").value;
        assert!(pin.abs() < 1e-6, "{more}: {pin}");
    }
}

#[test]
fn play_that_a_plane_linkage_does_not_need_is_no_reason_why_it_moves() {
    let loose = "[clearance.gd]\nradial = \"5 um\"\njournal_radius = \"20 mm\"\nlength = \"60 mm\"\nends = \"journal\"\n\
        modulus = \"115 GPa\"\nrestitution = 0.5\n";
    assert_eq!(warnings(&format!("{TURNING_RAM}{loose}")), "");
}

/// A shaft that turns a nut along a guide, 5 mm per turn.
const SPINDLE: &str = r#"
[points]
O = [0, 0, 0]
N = ["0.1*s", 0, 0]
[bodies]
shaft = { mass = "1 kg", centre = "O", inertia = ["1e-3 kg*s^2", "1e-3 kg*s^2", "1e-3 kg*s^2"] }
nut = { mass = "1 kg", centre = "N", inertia = ["1e-3 kg*s^2", "1e-3 kg*s^2", "1e-3 kg*s^2"] }
[joints]
turn = { revolute = ["ground", "shaft"], at = "O", axis = [1, 0, 0], drive = "2*pi*speed*t" }
along = { prismatic = ["ground", "nut"], at = "N", axis = [1, 0, 0] }
thread = { screw = ["shaft", "nut"], at = "N", axis = [1, 0, 0], lead = "0.005*s", cut = true }
"#;

#[test]
fn a_nut_is_never_half_a_pitch_off_its_thread() {
    for guess in [0.5, 1.2, 1.25, 1.3, 2.4, 2.5, 2.6, 4.9, 7.5, 42.4] {
        let more = format!("[assembly]\nalong = \"{guess} mm\"\n");
        let assemblies = compiled(SPINDLE, &more, &[]).assemblies();
        let places = assemblies.others.iter().chain([&assemblies.taken]).flatten();
        let mut nearest = f64::INFINITY;
        for at in places.filter(|at| at.joint == "along") {
            // Assembly closes loops to 1e-10 of the longest arm.
            assert!((at.value / 5e-3 - (at.value / 5e-3).round()).abs() < 1e-6, "{guess} mm: {}", at.value);
            nearest = nearest.min((1e3 * at.value - guess).abs());
        }
        assert!(nearest <= 2.5 + 1e-6, "{guess} mm: the next thread is {nearest} mm away");
    }
}
