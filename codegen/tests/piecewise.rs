//! Formulas with pieces, run against closed forms: what adaptive steps locate, what fixed steps pass through, what drives do.

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Run, Settings, Span, Watch, simulate};

/// A block of 2 kg on a rail along x, with a joint as written.
fn block(parameters: &str, joint: &str, start: &str) -> Compiled {
    let text = format!(
        r#"spec = 1
name = "block"
gravity = [0, 0, 0]
[parameters]
F = "3 N"
{parameters}
[points]
O = [0, 0, 0]
A = ["0.1 m", 0, 0]
[bodies]
body = {{ rod = ["O", "A"], radius = "10 mm", mass = "2 kg" }}
[joints]
rail = {{ prismatic = ["ground", "body"], at = "O", axis = [1, 0, 0], {joint} }}
{start}
"#
    );
    let source = SourceFile { name: "block.toml".into(), text };
    compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn run(compiled: &Compiled, span: f64, samples: usize, integrator: Integrator) -> Run {
    let settings = Settings { span: Span::Time(span), samples, integrator, ..Settings::default() };
    let system = compiled.interpreter();
    let run =
        simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE).unwrap();
    assert!(run.stopped.is_none(), "{:?}", run.stopped);
    run
}

const ADAPTIVE: Integrator = Integrator::Dopri5 { tolerance: 1e-6, max_step: None };

/// Largest distance of the position from a function of time.
fn worst(run: &Run, position: impl Fn(f64) -> f64) -> f64 {
    let q = run.column("rail.q").unwrap();
    run.times.iter().zip(q).fold(0.0, |worst, (t, q)| (q - position(*t)).abs().max(worst))
}

/// Way after a force of `a` [m/s²] up to 0.3 s and of `-2 a` from then on.
fn thrown(t: f64) -> f64 {
    const A: f64 = 1.5;
    if t < 0.3 { 0.5 * A * t * t } else { 0.5 * A * 0.09 + 0.3 * A * (t - 0.3) - A * (t - 0.3) * (t - 0.3) }
}

#[test]
fn a_force_that_jumps_in_time_is_met_to_rounding_at_a_coarse_tolerance() {
    for joint in [
        r#"force = "if(t < 0.3 s, F, -2*F)""#,
        r#"force = "if(t >= 0.3 s, -2*F, F)""#,
        r#"force = "F - 3*F*step(t - 0.3 s)""#,
        r#"force = "-0.5*F - 1.5*F*sign(t - 0.3 s)""#,
        r#"force = "F - 3*F*clamp(floor(t/(0.3 s)), 0, 1)""#,
    ] {
        for integrator in [ADAPTIVE, Integrator::Rk43 { tolerance: 1e-6, max_step: None }] {
            let off = worst(&run(&block("", joint, ""), 1.0, 101, integrator), thrown);
            // The motion is a parabola on both sides, which steps meet exactly: what is left is 1e-9 of a step, in which the
            // force is that of the other side, times a speed that changes by 4.5 m/s² in it.
            assert!(off < 1e-11, "{joint} {integrator:?}: {off:e}");
        }
    }
}

#[test]
fn steps_of_one_length_pass_through_a_jump() {
    let joint = r#"force = "if(t < 0.3 s, F, -2*F)""#;
    let off = worst(&run(&block("", joint, ""), 1.0, 11, Integrator::Rk4 { step: 0.07 }), thrown);
    // A jump of 4.5 m/s² for up to a step of 0.05 s, which ends a sample, leaves a speed of up to 0.2 m/s too much.
    assert!(off > 1e-6 && off < 0.2, "{off:e}");
}

/// A block that meets a spring at 0.2 m with 1 m/s, is thrown back, and does so in a time that is half a period.
#[test]
fn a_stop_made_of_max_gives_the_speed_back_and_is_entered_where_it_begins() {
    let stop = r#"force = "-(800 N/m)*max(rail.q - 0.2 m, 0)""#;
    let by_if = r#"force = "if(rail.q > 0.2 m, -(800 N/m)*(rail.q - 0.2 m), 0)""#;
    let omega = (800.0_f64 / 2.0).sqrt();
    let position = |t: f64| {
        let (touch, leave) = (0.2, 0.2 + std::f64::consts::PI / omega);
        if t < touch {
            t
        } else if t < leave {
            0.2 + (omega * (t - touch)).sin() / omega
        } else {
            0.2 - (t - leave)
        }
    };
    for joint in [stop, by_if] {
        let compiled = block("", joint, "[initial]\nrail = { q = \"0 m\", v = \"1 m/s\" }");
        let integrator = Integrator::Dopri5 { tolerance: 1e-9, max_step: None };
        let off = worst(&run(&compiled, 0.5, 201, integrator), position);
        // The tolerance, in some ten steps of the half period.
        assert!(off < 1e-8, "{joint}: {off:e}");
    }
}

/// Position after a push to and fro every 0.1 s.
#[test]
fn a_force_that_comes_again_and_again_is_met_every_time() {
    let joint = r#"force = "if(mod(t, 0.2 s) < 0.1 s, F, -F)""#;
    let run = run(&block("", joint, ""), 2.0, 201, ADAPTIVE);
    let position = |t: f64| {
        let (rounds, left) = ((t / 0.2).floor(), t - 0.2 * (t / 0.2).floor());
        let within = if left < 0.1 { 0.75 * left * left } else { 0.015 - 0.75 * (0.2 - left) * (0.2 - left) };
        0.015 * rounds + within
    };
    // As after one jump, twenty times.
    assert!(worst(&run, position) < 1e-9, "{:e}", worst(&run, position));
}

#[test]
fn a_drive_with_dwells_has_the_speed_and_the_force_of_its_law() {
    // Rise in the first quarter of a second, rest, return in the third.
    let drive = r#"drive = "0.1 m*(cycloidal(t/T, 4) - cycloidal((t - 0.5 s)/T, 4))""#;
    let run = run(&block("T = \"0.25 s\"", drive, ""), 3.0, 301, ADAPTIVE);
    let turn = 2.0 * std::f64::consts::PI;
    let law = |s: f64| {
        let s = s.clamp(0.0, 1.0);
        let (sine, cosine) = (turn * s).sin_cos();
        [s - sine / turn, 1.0 - cosine, turn * sine]
    };
    let columns = ["rail.q", "rail.v", "rail.a", "rail.drive"].map(|name| run.column(name).unwrap());
    for (k, t) in run.times.iter().enumerate() {
        let t = t.rem_euclid(1.0);
        let (rise, back) = (law(t / 0.25), law((t - 0.5) / 0.25));
        let exact = |order: usize| 0.1 * (rise[order] - back[order]) / 0.25_f64.powi(order as i32);
        // Roundings of the time in its rounds, 3 s of 1e-16, times the next derivative: 63 m/s³ at most.
        assert!((columns[0][k] - exact(0)).abs() < 1e-14, "{t}");
        assert!((columns[1][k] - exact(1)).abs() < 1e-13, "{t}");
        assert!((columns[2][k] - exact(2)).abs() < 1e-11, "{t}");
        assert!((columns[3][k] - 2.0 * exact(2)).abs() < 1e-11, "{t}");
    }
}

#[test]
fn names_that_functions_have_too_are_still_names() {
    let compiled = block("min = \"2 N\"\nstep = \"3 s\"\nif = 2", r#"force = "min*if*t/step""#, "");
    assert_eq!(compiled.mechanism.parameters.len(), 4);
}

#[test]
fn a_piece_that_is_never_taken_may_be_no_number() {
    for (parameters, joint) in [
        ("p = 0", r#"force = "if(p > 0, F/p, F)""#),
        ("p = { value = 0, tunable = true }", r#"force = "if(p > 0, F/p, F)""#),
        ("", r#"force = "if(t < 0 s, F*sqrt(t/(1 s) - 5), F)""#),
    ] {
        let off = worst(&run(&block(parameters, joint, ""), 1.0, 11, ADAPTIVE), |t| 0.75 * t * t);
        // A parabola, met exactly but for roundings.
        assert!(off < 1e-12, "{joint}: {off:e}");
    }
}
