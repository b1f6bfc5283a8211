//! A machine with clearance starts where its ideal twin does, but for the clearances: on the branch of the guess, within half a
//! turn of it, in any scale; what is told of branches, of turns and of dead points is told with clearances in the loop too.

mod bars;

use std::f64::consts::PI;

use bars::four_bar_text;
use linkwear_codegen::compile::Compiled;
use linkwear_codegen::preflight::as_guesses;
use linkwear_codegen::{Options, SourceFile, compile};
use linkwear_runtime::{
    Evaluator, Integrator, RunError, Settings, Span, Watch, assemble_static_contact, simulate,
};

const FOUR_BAR: &str = include_str!("../../mechanisms/four_bar_wear.toml");
const RSSR: &str = include_str!("../../mechanisms/rssr.toml");
const CLEARANCES: [&str; 4] = [
    "",
    "[clearance.R2]\nradial = \"20 um\"\njournal_radius = \"8 mm\"\nlength = \"20 mm\"\nmodulus = \"100 GPa\"\n",
    "[clearance.R3]\nradial = \"20 um\"\njournal_radius = \"8 mm\"\nlength = \"20 mm\"\nmodulus = \"100 GPa\"\n",
    "[clearance.R1]\nradial = \"20 um\"\njournal_radius = \"8 mm\"\nlength = \"20 mm\"\nmodulus = \"100 GPa\"\n",
];

fn compiled_with(text: String, set: &[(&str, &str)]) -> Compiled {
    let overrides = set.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let source = SourceFile { name: "start.toml".to_owned(), text };
    compile(&source, &Options { overrides, ..Options::default() }).expect("it compiles")
}

/// Where coordinates start.
fn start<const N: usize>(compiled: &Compiled, names: [&str; N]) -> [f64; N] {
    let system = compiled.interpreter();
    let description = compiled.description();
    let mut evaluator = Evaluator::new(&system, description, &compiled.parameters()).expect("it fits");
    let state = assemble_static_contact(&mut evaluator, 0.0).expect("it closes");
    names.map(|name| {
        let place = description.coordinates.iter().position(|coordinate| coordinate.name == name);
        state.q[place.expect("a coordinate")]
    })
}

/// A link that bends moves the pin at its end in its bush, and starts unbent.
#[test]
fn a_link_that_bends_is_put_together_with_the_clearance_at_its_end() {
    let (ideal, _) = FOUR_BAR.split_once("[clearance.R2]").expect("clearances");
    let bends =
        "density = \"7850 kg/m^3\", flexible = { modes = 2, young = \"210 GPa\", damping = 0.02 } }\nrocker";
    let ideal = ideal.replace("density = \"7850 kg/m^3\" }\nrocker", bends);
    let [coupler, rocker] = [55.77_f64.to_radians(), 97.18_f64.to_radians()];
    for clearance in &CLEARANCES[1..] {
        for guess in ["97 deg", "90 deg", "20 deg"] {
            let text = ideal.replace("97 deg", guess) + clearance;
            let compiled = compiled_with(text, &[]);
            let (system, parameters) = (compiled.interpreter(), compiled.parameters());
            let mut evaluator =
                Evaluator::new(&system, compiled.description(), &parameters).expect("it fits");
            let state = assemble_static_contact(&mut evaluator, 0.0).expect("it closes");
            // Two clearances of 20 um at arms of 200 mm and more turn joints by some 1e-4.
            let [found_2, found_4] = start(&compiled, ["R2.q", "R4.q"]);
            let apart = (found_2 - coupler).abs().max((found_4 - rocker).abs());
            assert!(apart < 1e-3, "{clearance} from {guess}: {found_2} {found_4}");
            // It rests where its load presses it.
            evaluator.evaluate_contacts(0.0, &state.q, &state.v);
            let touch = evaluator.clearances().contacts()[0];
            let depth = touch.penetration() / touch.clearance;
            assert!(depth > 0.0 && depth < 1.0, "{clearance} from {guess}: {depth}");
        }
    }
}

#[test]
fn loops_with_clearance_close_on_the_branch_of_the_guess() {
    // The triangle of the file: 55.8 deg at the crank pin and 97.2 deg outside the angle at the rocker's bearing, or mirrored.
    let [coupler, rocker] = [55.77_f64.to_radians(), 97.18_f64.to_radians()];
    for (guess_2, guess_4) in
        [(56, 97), (5, 60), (20, 150), (1, 20), (80, 40), (120, 170), (-30, -60), (-100, -160)]
    {
        let text = FOUR_BAR
            .replace("R2 = \"56 deg\"", &format!("R2 = \"{guess_2} deg\""))
            .replace("R4 = \"97 deg\"", &format!("R4 = \"{guess_4} deg\""));
        let side = f64::from(guess_4).signum();
        let found = start(&compiled_with(text, &[]), ["R2.q", "R4.q"]);
        // Two clearances of 20 um at arms of 200 mm and more turn joints by some 1e-4.
        let apart = (found[0] - side * coupler).abs().max((found[1] - side * rocker).abs());
        assert!(apart < 1e-3, "from {guess_2} and {guess_4} deg: {found:?}");
    }
}

#[test]
fn one_clearance_anywhere_in_a_loop_leaves_its_branch() {
    let corners = [[0.1, 0.0], [0.25, 0.25], [0.4, 0.0]];
    let ideal = |guess: &str| {
        start(&compiled_with(four_bar_text(corners, ", drive = \"1 rad/s*t\"", "", guess), &[]), ["R4.q"])
    };
    for guess in ["", "[assembly]\nR4 = \"-50 deg\"\n"] {
        for clearance in CLEARANCES {
            let text = four_bar_text(corners, ", drive = \"1 rad/s*t\"", "", &format!("{guess}{clearance}"));
            let [found] = start(&compiled_with(text, &[]), ["R4.q"]);
            let [wanted] = ideal(guess);
            // 20 um at an arm of a quarter of a metre, on either side of the play.
            assert!((found - wanted).abs() < 1e-3, "{guess}{clearance}: {found} for {wanted}");
        }
    }
}

#[test]
fn the_case_study_starts_on_the_branch_of_a_far_guess() {
    let text = |guess: f64| {
        let line = RSSR.lines().find(|line| line.starts_with("R4 = \"")).expect("a guess");
        RSSR.replace(line, &format!("R4 = \"{guess} deg\""))
    };
    // The two ways of its ideal twin.
    for (guess, wanted) in
        [(150.0, 153.3), (170.0, 153.3), (100.0, 153.3), (-20.0, -48.2), (5.0, -48.2), (-100.0, -48.2)]
    {
        let [found] = start(&compiled_with(text(guess), &[]), ["R4.q"]);
        // 10 um of play at 100 mm.
        assert!((found.to_degrees() - wanted).abs() < 0.1, "from {guess} deg: {} deg", found.to_degrees());
    }
}

#[test]
fn branches_are_told_with_every_joint_of_the_loop_loose() {
    let ways = compiled_with(FOUR_BAR.to_owned(), &[]).assemblies();
    assert_eq!(as_guesses(&ways.taken), "R2 = \"55.8 deg\", R4 = \"97.2 deg\"");
    let others: Vec<String> = ways.others.iter().map(|way| as_guesses(way)).collect();
    assert_eq!(others, ["R2 = \"-55.8 deg\", R4 = \"-97.2 deg\""]);
    let taken = compiled_with(RSSR.to_owned(), &[]).assemblies().taken;
    assert_eq!(as_guesses(&taken), "R4 = \"-48.2 deg\"");
}

/// A crank too long for its rocker: 400 mm where Grashof's rule wants it shortest.
#[test]
fn the_end_of_a_turn_is_told_with_clearances_in_the_loop() {
    let compiled = compiled_with(FOUR_BAR.to_owned(), &[("a", "400 mm")]);
    let told: Vec<_> = compiled.warnings.iter().filter(|warning| warning.code.as_str() == "W0116").collect();
    let [told] = told.as_slice() else { panic!("{:?}", compiled.warnings) };
    // Crank and ground in one triangle with coupler and rocker in line: 102.6 deg by the rule of cosines.
    assert!(told.message.contains("102.5 deg") || told.message.contains("102.6 deg"), "{}", told.message);
    let settings = Settings::new(Integrator::Rk43 { tolerance: 1e-6, max_step: None }, Span::Turns(1.0), 2);
    let (system, parameters) = (compiled.interpreter(), compiled.parameters());
    let run =
        simulate(&system, compiled.description(), &parameters, &settings, Watch::NONE).expect("it starts");
    match run.stopped {
        Some(RunError::DeadPoint { joint, position, .. }) => {
            assert_eq!(joint, "R1");
            assert!((position.to_degrees() - 102.64).abs() < 0.01, "{}", position.to_degrees());
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_guess_that_leads_nowhere_is_answered_with_one_that_closes() {
    let end = FOUR_BAR.find("[clearance.R2]").expect("it has clearances");
    let text = FOUR_BAR[..end].to_owned();
    let set = vec![("a".to_owned(), "360 mm".to_owned())];
    let options = || Options { overrides: set.clone(), ..Options::default() };
    let source = |text| SourceFile { name: "bars.toml".to_owned(), text };
    let refused = compile(&source(text.clone()), &options())
        .map(drop)
        .expect_err("its guesses lead nowhere")
        .to_string();
    assert!(refused.contains("E0601") && refused.contains("not from the guesses of the file"), "{refused}");
    let help = refused.split("`[assembly]` with `").nth(1).and_then(|rest| rest.split('`').next());
    let [head, _] = [0, 1].map(|part| text.split("[assembly]").nth(part).expect("two parts"));
    let cured = format!("{head}[assembly]\n{}\n", help.expect("a cure").replace(", ", "\n"));
    compile(&source(cured), &options()).map(drop).expect("the guesses told close it");
}

/// What is drawn open and driven by nothing is closed by the least motion, which knows no metre.
#[test]
fn a_drawing_of_another_scale_starts_as_this_one() {
    let drawn = |scale: f64, clearance: &str| {
        let corners = [[0.1, 0.0], [0.25, 0.25], [0.4, 0.02]].map(|corner| corner.map(|x| scale * x));
        let guess = "[assembly]\nR1 = \"10 deg\"\nR4 = \"-20 deg\"\n";
        compiled_with(four_bar_text(corners, "", "", &format!("{guess}{clearance}")), &[])
    };
    let names = ["R1.q", "R4.q"];
    let known = start(&drawn(1.0, ""), names);
    assert!((known[0] - 10.0 * PI / 180.0).abs() > 1e-3, "drawn closed: no case");
    for scale in [1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3] {
        let found = start(&drawn(scale, ""), names);
        let apart = known.iter().zip(found).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        // Newton ends at 1e-9 of an arm.
        assert!(apart < 1e-8, "{scale}: {found:?} for {known:?}");
    }
    // Without R3, where loops are cut otherwise: what moves least is then told by other joints.
    for clearance in [CLEARANCES[1], CLEARANCES[3]] {
        let found = start(&drawn(1.0, clearance), names);
        let apart = known.iter().zip(found).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        // 20 um at arms of a tenth of a metre, pressed to either side.
        assert!(apart < 2e-3, "{clearance}: {found:?} for {known:?}");
    }
}
