//! Mechanisms of which a part is far smaller or far faster than a metre and a second, by the method that runs take without a hint,
//! against closed forms.

mod support;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Settings, Span};
use support::{Recorded, compile_source, largest_difference, run_with};

fn by_default(text: &str, tolerance: Option<f64>, time: f64) -> Recorded {
    let compiled =
        compile_source(&SourceFile { name: "test.toml".to_owned(), text: text.to_owned() }, &[], None);
    let integrator = Integrator::adaptive(compiled.description(), tolerance);
    run_with(&compiled, &Settings::new(integrator, Span::Time(time), 101))
}

#[test]
fn small_amplitudes_are_right_beside_themselves() {
    for (amplitude, metres) in [("1 mm", 1e-3), ("1 um", 1e-6), ("1 nm", 1e-9)] {
        let text = format!(
            r#"
spec = 1
name = "spring"
[points]
A = [0, 0, 0]
[bodies]
m = {{ mass = "1 kg", centre = "A" }}
[joints]
P = {{ prismatic = ["ground", "m"], at = "A", axis = [1, 0, 0], spring = {{ stiffness = "39.47841760435743 N/m" }} }}
[initial]
P = "{amplitude}"
"#
        );
        // 1 Hz; errors of ten periods add up to ten times the tolerance.
        let run = by_default(&text, Some(1e-6), 10.0);
        let expected: Vec<f64> =
            run.run.times.iter().map(|t| metres * (std::f64::consts::TAU * t).cos()).collect();
        let error = largest_difference(&run.column("P.q"), &expected) / metres;
        assert!(error < 1e-5, "{amplitude}: {error:e}");
    }
}

#[test]
fn friction_brakes_small_masses_as_large_ones() {
    for mass in ["1 kg", "1 mg", "0.01 mg"] {
        let text = format!(
            r#"
spec = 1
name = "block"
gravity = [0, "-9.81 m/s^2", 0]
[points]
A = [0, 0, 0]
[bodies]
m = {{ mass = "{mass}", centre = "A" }}
[joints]
P = {{ prismatic = ["ground", "m"], at = "A", axis = [1, 0, 0], dry_friction = {{ coefficient = 0.3 }} }}
[initial]
P = {{ v = "1 m/s" }}
"#
        );
        let run = by_default(&text, None, 0.1);
        // mu g; the onset leaves 1e-6 of it at these speeds.
        let error = run.column("P.a").iter().map(|a| (a / -2.943 - 1.0).abs()).fold(0.0, f64::max);
        assert!(error < 1e-5, "{mass}: {error:e}");
    }
}

#[test]
fn stiff_dampers_cost_no_steps_and_leave_forces_right() {
    // A gram on a kilogram that swings by 0.2 m at 10 rad/s, by a spring and a damper that are a million times as fast.
    let text = r#"
spec = 1
name = "stiff"
[points]
A = [0, 0, 0]
B = ["0.1 m", 0, 0]
[bodies]
large = { mass = "1 kg", centre = "A" }
small = { mass = "1 g", centre = "B" }
[joints]
P = { prismatic = ["ground", "large"], at = "A", axis = [1, 0, 0], spring = { stiffness = "100 N/m" } }
S = { prismatic = ["large", "small"], at = "B", axis = [1, 0, 0], spring = { stiffness = "1e8 N/m" }, damping = "1e4 N s/m" }
[initial]
P = { q = "0.2 m" }
"#;
    for tolerance in [None, Some(1e-4)] {
        let run = by_default(text, tolerance, 1.0);
        let steps = run.run.statistics.steps;
        // Dormand-Prince alone takes three million.
        assert!(steps < 1000, "{steps}");
        // What spring and damper bear: the mass of a gram under the acceleration of both, 100 N/m over 1.001 kg. The damper holds the
        // spring back by c/k, a tenth of a millisecond.
        let (rate, late) = ((100.0_f64 / 1.001).sqrt(), 1e-4);
        let most = 1e-3 * 0.2 * rate * rate / 1e8 / (1.0 + (late * rate).powi(2));
        let stretched = |t: &f64| most * ((rate * t).cos() + late * rate * (rate * t).sin());
        let stretch: Vec<f64> = run.run.times.iter().map(stretched).collect();
        // From the end of what dies out at first; ten times the tolerance.
        let error = largest_difference(&run.column("S.q")[10..], &stretch[10..]) / most;
        assert!(error < 10.0 * tolerance.unwrap_or(1e-9).max(1e-6), "{error:e}");
    }
}
