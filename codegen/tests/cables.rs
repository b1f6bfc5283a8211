//! Cables that go slack, against closed forms.

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Run, Settings, Span, Watch, simulate};

/// A load of 3 kg on a vertical rail below a point 1 m above it, with a cable of these keys, under 10 m/s², at a height [m] and speed [m/s].
fn run(cable: &str, [q, v]: [f64; 2], end: f64) -> Run {
    let text = format!(
        "spec = 1\nname = \"m\"\ngravity = [0, 0, \"-10 m/s^2\"]\n[points]\nT = [0, 0, \"1 m\"]\nO = [0, 0, 0]\n[bodies]\n\
         load = {{ mass = \"3 kg\", centre = \"O\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"1 kg m^2\"] }}\n[joints]\n\
         rail = {{ prismatic = [\"ground\", \"load\"], at = \"O\", axis = [0, 0, 1] }}\n[forces]\n\
         rope = {{ cable = [\"ground\", \"load\"], at = [\"T\", \"O\"], {cable} }}\n[initial]\nrail = {{ q = \"{q} m\", v = \"{v} m/s\" }}\n"
    );
    let source = SourceFile { name: "cable".into(), text };
    let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
    let method = Integrator::Dopri5 { tolerance: 1e-11, max_step: None };
    let settings = Settings::new(method, Span::Time(end), 401);
    let system = compiled.interpreter();
    let run =
        simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE).unwrap();
    assert_eq!(run.stopped, None);
    // The tolerance of the run on an energy of some joules.
    assert!(run.statistics.energy_error_J < 1e-8, "{} J", run.statistics.energy_error_J);
    run
}

/// Thrown up from the length at which the rope is just taut, the load flies a parabola and then hangs on a spring.
#[test]
fn a_load_that_jumps_flies_while_the_rope_is_slack() {
    let (m, k, g, v) = (3.0, 2700.0, 10.0, 2.0);
    let run = run("stiffness = \"2700 N/m\"", [0.0, v], 0.55);
    let omega = f64::sqrt(k / m);
    let flight = 2.0 * v / g;
    // About the place where it would rest.
    let sag = m * g / k;
    let (q, pull, length) =
        (run.column("rail.q").unwrap(), run.column("rope.F").unwrap(), run.column("rope.length").unwrap());
    let mut hung = 0;
    for (i, t) in run.times.iter().enumerate() {
        let after = t - flight;
        let hangs = -sag + sag * (omega * after).cos() - v / omega * (omega * after).sin();
        // Within the first half of the swing, before it jumps again.
        let exact = if after < 0.0 { v * t - 0.5 * g * t * t } else { hangs };
        if after > 0.11 {
            break;
        }
        hung += usize::from(after > 0.0);
        // The tolerance of the run in some ten steps.
        assert!((q[i] - exact).abs() < 1e-9, "{t}: {} {exact}", q[i]);
        assert!(
            (pull[i] - k * (-exact).max(0.0)).abs() < 1e-5 && (length[i] - 1.0 + exact).abs() < 1e-9,
            "{t}"
        );
    }
    assert!(hung > 50);
}

#[test]
fn damping_of_a_rope_never_pushes() {
    let run = run("stiffness = \"2700 N/m\", damping = \"150 N s/m\"", [0.0, 2.0], 3.0);
    let pull = run.column("rope.F").unwrap();
    assert!(pull.iter().all(|pull| *pull >= 0.0) && pull.contains(&0.0));
    // Damped to a fifth of critical and more, after three seconds it hangs at rest.
    assert!((pull.last().unwrap() - 30.0).abs() < 1e-6, "{:?}", pull.last());
}

/// `preload` is the pull at `length`: it moves the place of rest up, and the length at which the rope goes slack.
#[test]
fn a_preloaded_rope_pulls_at_its_length() {
    let taut = run("stiffness = \"2700 N/m\", length = \"1 m\", preload = \"30 N\"", [0.0, 0.0], 0.2);
    assert!(taut.column("rail.q").unwrap().iter().all(|q| q.abs() < 1e-12));
    // 30 N/2700 N/m above that it is slack.
    let slack = run("stiffness = \"2700 N/m\", preload = \"30 N\"", [0.02, 0.0], 0.03);
    assert!(slack.column("rope.F").unwrap()[..100].iter().all(|pull| *pull == 0.0));
}
