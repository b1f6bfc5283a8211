//! What the balance of energy is judged by: runs that are right are told, though next to nothing goes through; wrong ones are not.

mod support;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Run, RunError, RunWarning, Settings, Span, Watch, simulate};
use support::{compile_source, loose_rotor};

fn run(text: &str, integrator: Option<Integrator>, span: Span) -> Run {
    let source = SourceFile { name: "test.toml".to_owned(), text: text.to_owned() };
    let compiled = compile_source(&source, &[], None);
    let integrator = integrator.unwrap_or_else(|| Integrator::adaptive(compiled.description(), None));
    let (system, settings) = (support::system(&compiled), Settings::new(integrator, span, 2));
    simulate(&*system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .expect("a start")
}

#[test]
fn a_rotor_without_friction_passes_nothing_on_and_is_told_at_any_speed() {
    for speed in [0.02, 0.1, 0.5, 5.0] {
        let run = run(&loose_rotor(speed, ""), None, Span::Turns(3.0));
        assert_eq!(run.stopped, None, "{speed} Hz");
        let off = |warning: &RunWarning| matches!(warning, RunWarning::EnergyOff { .. });
        assert!(!run.warnings.iter().any(off), "{speed} Hz: {:?}", run.warnings);
        // Weight times way.
        let by_hand = 5.0 * 9.81 * core::f64::consts::TAU * 0.01;
        let error = run.turns[0][0].wear_integral / by_hand - 1.0;
        assert!(error.abs() < 1e-4, "{speed} Hz: {error:e}");
    }
}

#[test]
fn the_same_rotor_in_steps_that_its_contact_does_not_bear_is_refused() {
    // Stable up to 0.3 ms.
    for step in [5e-4, 1e-3] {
        let run = run(&loose_rotor(5.0, ""), Some(Integrator::Rk4 { step }), Span::Turns(3.0));
        let wrong = |error: &RunError| {
            matches!(
                error,
                RunError::EnergyLost { .. } | RunError::Penetration { .. } | RunError::NonFinite { .. }
            )
        };
        assert!(run.stopped.as_ref().is_some_and(wrong), "{step} s: {:?} {:?}", run.stopped, run.warnings);
    }
}

/// A mass that stands until it is pushed for 5 ms, or on a spring.
fn pushed(force: &str) -> String {
    format!(
        r#"
spec = 1
name = "pushed"
gravity = [0, 0, 0]
[points]
O = [0, 0, 0]
[bodies]
a = {{ mass = "1 kg", centre = "O" }}
[joints]
X = {{ prismatic = ["ground", "a"], at = "O", axis = [1, 0, 0], spring = {{ stiffness = "1e4 N/m" }} }}
[forces]
f = {{ force = "a", at = "O", components = ["{force}", "0 N", "0 N"] }}
"#
    )
}

#[test]
fn a_motion_that_has_just_begun_is_judged_once_it_is_under_way() {
    let push = pushed("1 N*poly345((t-0.3 s)/(5 ms))").replace(", spring = { stiffness = \"1e4 N/m\" }", "");
    let rodas = Integrator::Rodas5P { tolerance: 1e-7, max_step: None };
    assert_eq!(run(&push, Some(rodas), Span::Time(1.0)).stopped, None);
    // 100 rad/s in steps of 30 ms, which the method makes grow by half.
    let coarse =
        run(&pushed("1 N*poly345((t-0.3 s)/(5 ms))"), Some(Integrator::Rk4 { step: 0.03 }), Span::Time(1.0));
    assert!(matches!(coarse.stopped, Some(RunError::EnergyLost { .. })), "{:?}", coarse.stopped);
}
