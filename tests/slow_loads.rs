//! Loads that change over many turns: lives are those of all of them, or are refused.

mod support;

use linkwear::backend::Backend;
use linkwear::mechanism::Mechanism;
use linkwear::sensitivity::{SensitivityError, SensitivityStudy};
use linkwear_codegen::Options;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::life::WearSource;
use linkwear_runtime::{DynamicsSource, RevolutionSettings, RunError};
use support::loose_rotor;

/// A rotor at five turns a second; `more`: tables behind those of its bearing, with a force `down` on it [N].
fn rotor(down: &str, more: &str) -> String {
    let wear = r#"friction = 0.1
[wear.J]
coefficient = 1e-7
hardness = "1 GPa"
threshold = "60 um"
area = "projected"
"#;
    let force =
        format!("[forces]\nF = {{ force = \"b\", at = \"O\", components = [0, \"-({down})\", 0] }}\n");
    loose_rotor(5.0, &format!("{wear}{force}{more}"))
}

/// What a turn wears at the unworn joint.
fn wear(text: &str, settings: RevolutionSettings) -> Result<f64, RunError> {
    let source = SourceFile { name: "rotor.toml".to_owned(), text: text.to_owned() };
    let mechanism = Mechanism::compile(&source, &Options::default(), Backend::Auto).expect("it compiles");
    let system = mechanism.system();
    let source = DynamicsSource::new(&*system, &mechanism.description, &mechanism.parameters, settings);
    let mut source = source.expect("a start");
    let unworn = source.unworn();
    source.measure(&unworn, &mut None)?;
    Ok(source.steadiness()[0].wear)
}

/// By hand, under a mean load besides the weight [N]: k N s / (H A).
fn by_hand(load: f64) -> f64 {
    1e-7 * (49.05 + load) / 1.01_f64.sqrt() * core::f64::consts::TAU * 0.01 / (1e9 * 4e-4)
}

#[track_caller]
fn assert_wears(text: &str, load: f64, within: f64) {
    let found = wear(text, RevolutionSettings::default()).expect("it turns");
    assert!((found / by_hand(load) - 1.0).abs() < within, "{found:e} {:e}", by_hand(load));
}

#[track_caller]
fn assert_refused(text: &str) {
    let found = wear(text, RevolutionSettings::default());
    assert!(matches!(found, Err(RunError::NeverAlike { .. })), "{found:?}");
}

#[test]
fn a_state_that_takes_a_thousand_turns_has_come_to_rest() {
    let state = "[states]\nx = { initial = \"0 N\", rate = \"(30 N - x)/(200 s)\" }\n";
    assert_wears(&rotor("x", state), 30.0, 1e-4);
    // One behind the other.
    let two = format!("{state}y = {{ initial = \"0 N\", rate = \"(x - y)/(50 s)\" }}\n");
    assert_wears(&rotor("y", &two), 30.0, 1e-4);
    // What counts the work does nothing.
    let counter = "[states]\nx = { initial = \"0 J\", rate = \"3 W\" }\n";
    assert_wears(&rotor("10 N", counter), 10.0, 1e-4);
    assert_wears(&rotor("x", &format!("{state}w = {{ initial = \"0 J\", rate = \"3 W\" }}\n")), 30.0, 1e-4);
    let grows = "[states]\nx = { initial = \"0 N\", rate = \"0.01 N/(1 s)\" }\n";
    assert_refused(&rotor("x", grows));
}

#[test]
fn loads_that_repeat_after_many_turns_count_in_all_of_them() {
    // Eight turns. Inertia of the journal on its way: 1e-3.
    assert_wears(&rotor("15 N*(1 - cos(2*pi*t/(1.6 s)))", ""), 15.0, 2e-3);
    // A pause of seven turns of eight.
    let pulse = "20 N*smooth_step(cos(2*pi*t/(1.6 s)) - 0.5, 0.4)";
    let mean = |text: &str| wear(text, RevolutionSettings::default()).expect("it turns");
    let later = pulse.replace("2*pi*t", "2*pi*(t + 0.8 s)");
    let (now, later) = (mean(&rotor(pulse, "")), mean(&rotor(&later, "")));
    assert!((now / later - 1.0).abs() < 2e-3, "{now:e} {later:e}");
    // From the tenth turn on.
    assert_wears(&rotor("if(t < 2 s, 0 N, 30 N)", ""), 30.0, 1e-4);
    // A beat that is no whole number of turns.
    assert_wears(&rotor("10 N*(1 - cos(2*pi*t*sqrt(2)/(1 s)))", ""), 10.0, 1e-2);
}

#[test]
fn a_second_drive_makes_turns_that_are_not_alike() {
    let text = rotor("20 N*(1 + sin(K.q))", "");
    let cam = "c = { mass = \"1 kg\", centre = \"O\", inertia = [\"0.01 kg m^2\", \"0.01 kg m^2\", \"0.01 kg m^2\"] }\n";
    let drive = "K = { revolute = [\"ground\", \"c\"], at = \"O\", axis = [0, 0, 1], drive = \"2*pi*0.5*t/(1 s)\" }\n";
    let after = text
        .replace("[joints]\n", &format!("{cam}[joints]\n"))
        .replace("[clearance", &format!("{drive}[clearance"));
    assert_wears(&after, 20.0, 2e-3);
}

/// Derivatives are those of one turn.
#[test]
fn derivatives_of_turns_that_are_not_alike_are_refused() {
    let more = "[parameters]\nload = { value = \"15 N\", tunable = true }\n";
    let text = rotor("load*(1 - cos(2*pi*t/(1.6 s)))", more);
    let source = SourceFile { name: "rotor.toml".to_owned(), text };
    let found = SensitivityStudy::new(&source).run();
    assert!(matches!(found, Err(SensitivityError::SeveralTurns { turns: 8 })), "{:?}", found.err());
}

#[test]
fn loads_that_do_not_repeat_are_refused_unless_somebody_says_how_to_measure() {
    assert_refused(&rotor("0.01 N*t/(1 s)", ""));
    let dies = rotor("30 N*exp(-t/(200 s))", "");
    assert_refused(&dies);
    let told = RevolutionSettings { settle: Some(3), ..RevolutionSettings::default() };
    let found = wear(&dies, told).expect("it was told");
    assert!((found / by_hand(30.0) - 1.0).abs() < 1e-2, "{found:e}");
}
