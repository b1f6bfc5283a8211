//! Pendulum, planar four-bar and slider-crank against closed forms or an integration that shares no code.

mod support;
mod truth;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, RunError, Settings, Span, Watch, simulate};
use support::{Recorded, compile_source, largest_difference, run, run_with};
use truth::reached;

/// The issue's bound: positions, speeds and accelerations relative to the size of each column.
const CLOSED_FORM: f64 = 1e-9;
/// Energy drift as a share of the energy that went through the mechanism.
const DRIFT: f64 = 1e-8;
/// Loops at every output [m].
const LOOP: f64 = 1e-10;

fn source(text: &str) -> SourceFile {
    SourceFile { name: "test.toml".to_owned(), text: text.to_owned() }
}

fn assert_close(values: &[f64], expected: &[f64], (case, what): (&str, &str)) {
    let scale = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let error = largest_difference(values, expected) / scale;
    reached(case, &format!("{what}, of its largest value"), error, CLOSED_FORM);
}

fn assert_energy(case: &str, run: &Recorded) {
    let statistics = &run.run.statistics;
    let drift = statistics.energy_error_J / statistics.energy_throughput_J;
    reached(case, "energy, of what went through", drift, DRIFT);
    assert!(statistics.max_loop_error_m < LOOP, "loops open by {:e} m", statistics.max_loop_error_m);
}

const PENDULUM: &str = r#"
spec = 1
name = "pendulum"
gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]
[parameters]
L = "0.8 m"
r = "5 mm"
[points]
O = ["0 m", "0 m", "0 m"]
P = ["L", "0 m", "0 m"]
[bodies]
bar = { rod = ["O", "P"], radius = "r", density = "7850 kg/m^3" }
[joints]
J = { revolute = ["ground", "bar"], at = "O", axis = [0, 1, 0] }
[initial]
J = { q = "10 deg", v = "0.3 rad/s" }
"#;

/// I q'' = m g (L/2) cos q (q from the horizontal, positive downwards), by RK4 with 1e-5 s: error below 1e-13.
fn pendulum_angles(samples: usize, time: f64) -> Vec<f64> {
    let (l, r, g): (f64, f64, f64) = (0.8, 0.005, 9.81);
    let inertia_over_mass = l * l / 3.0 + r * r / 4.0;
    let rate = |q: f64| g * 0.5 * l * q.cos() / inertia_over_mass;
    let per_sample = (time / (samples - 1) as f64 / 1e-5).round() as usize;
    let h = time / (samples - 1) as f64 / per_sample as f64;
    let (mut q, mut v) = (10_f64.to_radians(), 0.3);
    let mut angles = vec![q];
    for _ in 1..samples {
        for _ in 0..per_sample {
            let (k1, l1) = (v, rate(q));
            let (k2, l2) = (v + 0.5 * h * l1, rate(q + 0.5 * h * k1));
            let (k3, l3) = (v + 0.5 * h * l2, rate(q + 0.5 * h * k2));
            let (k4, l4) = (v + h * l3, rate(q + h * k3));
            q += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
        }
        angles.push(q);
    }
    angles
}

#[test]
fn pendulum_follows_an_independent_integration() {
    let compiled = compile_source(&source(PENDULUM), &[], None);
    let run = run(&compiled, Span::Time(4.0), Span::Time(0.0), 41, 1e-12);
    assert_close(&run.column("J.q"), &pendulum_angles(41, 4.0), ("pendulum", "angle"));
}

#[test]
fn pendulum_keeps_its_energy_for_ten_seconds() {
    let compiled = compile_source(&source(PENDULUM), &[], None);
    assert_energy("pendulum", &run(&compiled, Span::Time(10.0), Span::Time(0.0), 101, 1e-10));
}

/// Crank 0.2, coupler 0.5, rocker 0.4, ground 0.5 m, in the x-z plane about -y (positive from x to z).
fn four_bar(drive: &str, initial: &str) -> String {
    format!(
        r#"
spec = 1
name = "four_bar"
gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]
[parameters]
r = "5 mm"
[points]
A0 = ["0 m", "0 m", "0 m"]
B0 = ["0.5 m", "0 m", "0 m"]
A = ["0.2 m", "0 m", "0 m"]
B = {{ coupler = ["0.7 m", "0 m", "0 m"], rocker = ["0.9 m", "0 m", "0 m"] }}
[bodies]
crank = {{ rod = ["A0", "A"], radius = "r", density = "7850 kg/m^3" }}
coupler = {{ rod = ["A", "B"], radius = "r", density = "7850 kg/m^3" }}
rocker = {{ rod = ["B0", "B"], radius = "r", density = "7850 kg/m^3" }}
[joints]
J1 = {{ revolute = ["ground", "crank"], at = "A0", axis = [0, -1, 0]{drive} }}
J2 = {{ revolute = ["crank", "coupler"], at = "A", axis = [0, -1, 0] }}
J4 = {{ revolute = ["ground", "rocker"], at = "B0", axis = [0, -1, 0] }}
J3 = {{ revolute = ["coupler", "rocker"], at = "B", axis = [0, -1, 0] }}
[assembly]
J2 = "50 deg"
J4 = "100 deg"
{initial}
"#
    )
}

/// Rocker angle, speed and acceleration of the four-bar for a crank that turns at constant speed: Freudenstein's
/// closed form for the angle (open branch), implicit differentiation of the loop for the rest.
fn rocker(theta: f64, omega: f64) -> [f64; 3] {
    let (a, b, c, d) = (0.2_f64, 0.5_f64, 0.4_f64, 0.5_f64);
    let (x, y) = (d - a * theta.cos(), -a * theta.sin());
    let s = x.hypot(y);
    let towards = y.atan2(x);
    // Triangle A, B, B0 with sides b, c, s: B on the left of A -> B0.
    let at_a = ((b * b + s * s - c * c) / (2.0 * b * s)).acos();
    let coupler = towards + at_a;
    let (bx, by) = (a * theta.cos() + b * coupler.cos(), a * theta.sin() + b * coupler.sin());
    let phi = by.atan2(bx - d);
    let phi_dot = a * omega * (theta - coupler).sin() / (c * (phi - coupler).sin());
    let coupler_dot = -a * omega * (theta - phi).sin() / (b * (coupler - phi).sin());
    let numerator = a * omega * omega * (theta - coupler).cos() + b * coupler_dot * coupler_dot
        - c * phi_dot * phi_dot * (phi - coupler).cos();
    [phi, phi_dot, numerator / (c * (phi - coupler).sin())]
}

#[test]
fn four_bar_follows_freudenstein() {
    let omega = 7.0;
    let text = four_bar(", drive = \"7 rad/s * t\"", "");
    let compiled = compile_source(&source(&text), &[], None);
    let run = run(&compiled, Span::Turns(1.0), Span::Time(0.0), 73, 1e-10);
    let expected: Vec<[f64; 3]> = run.run.times.iter().map(|t| rocker(omega * t, omega)).collect();
    for (index, name) in ["J4.q", "J4.v", "J4.a"].into_iter().enumerate() {
        let column: Vec<f64> = expected.iter().map(|values| values[index]).collect();
        assert_close(&run.column(name), &column, ("four-bar, Freudenstein", name));
    }
    assert!(run.run.statistics.max_loop_error_m < LOOP);
}

#[test]
fn four_bar_left_to_itself_keeps_its_energy_and_its_loop() {
    let text = four_bar("", "[initial]\nJ1 = { q = \"60 deg\", v = \"0 rad/s\" }");
    let compiled = compile_source(&source(&text), &[], None);
    assert_energy("four-bar left to itself", &run(&compiled, Span::Time(10.0), Span::Time(0.0), 101, 1e-10));
}

#[test]
fn planar_four_bar_has_one_freedom_and_names_three_redundant_rows() {
    let compiled = compile_source(&source(&four_bar("", "")), &[], None);
    let analysis = &compiled.analysis;
    assert_eq!((analysis.mobility, analysis.redundant.len()), (1, 3));
    assert!(analysis.redundant.iter().all(|row| row.joint == "J3"));
    // In the plane everything is known; out of the plane nothing is.
    assert!(analysis.non_unique.contains(&"J1.Fy".to_owned()));
    assert!(!analysis.non_unique.contains(&"J1.Fx".to_owned()));
}

/// Crank 0.1, rod 0.3 m; slider along x without gravity.
fn slider_crank(drive: &str, initial: &str) -> String {
    format!(
        r#"
spec = 1
name = "slider_crank"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[parameters]
r = "5 mm"
[points]
O = ["0 m", "0 m", "0 m"]
A = ["0.1 m", "0 m", "0 m"]
B = ["0.4 m", "0 m", "0 m"]
[bodies]
crank = {{ rod = ["O", "A"], radius = "r", density = "7850 kg/m^3" }}
rod = {{ rod = ["A", "B"], radius = "r", density = "7850 kg/m^3" }}
slider = {{ mass = "0.6 kg", centre = "B", inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"] }}
[joints]
J1 = {{ revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1]{drive} }}
J2 = {{ revolute = ["crank", "rod"], at = "A", axis = [0, 0, 1] }}
J3 = {{ prismatic = ["ground", "slider"], at = "B", axis = [1, 0, 0] }}
J4 = {{ revolute = ["rod", "slider"], at = "B", axis = [0, 0, 1] }}
{initial}
"#
    )
}

#[test]
fn slider_crank_follows_the_textbook_stroke() {
    let (r, l, omega) = (0.1_f64, 0.3_f64, 20.0_f64);
    let compiled = compile_source(&source(&slider_crank(", drive = \"20 rad/s * t\"", "")), &[], None);
    let run = run(&compiled, Span::Turns(1.0), Span::Time(0.0), 73, 1e-10);
    let exact = |t: f64| {
        let (s, c) = (omega * t).sin_cos();
        let w = (l * l - r * r * s * s).sqrt();
        let w_dot = -r * r * s * c * omega / w;
        let x = r * c + w - (r + l);
        let v = -r * omega * s + w_dot;
        let w_ddot = (-r * r * omega * omega * (c * c - s * s) - w_dot * w_dot) / w;
        [x, v, -r * omega * omega * c + w_ddot]
    };
    for (index, name) in ["J3.q", "J3.v", "J3.a"].into_iter().enumerate() {
        let column: Vec<f64> = run.run.times.iter().map(|t| exact(*t)[index]).collect();
        assert_close(&run.column(name), &column, ("slider-crank, textbook stroke", name));
    }
}

#[test]
fn slider_crank_left_to_itself_keeps_its_energy() {
    let text = slider_crank("", "[initial]\nJ1 = { q = \"40 deg\", v = \"2 rad/s\" }");
    let compiled = compile_source(&source(&text), &[], None);
    assert_energy(
        "slider-crank left to itself",
        &run(&compiled, Span::Time(10.0), Span::Time(0.0), 101, 1e-10),
    );
}

/// A spindle that goes to and fro on top of a steady turn, up to 11 turns per second; its nut, and two joints more that are
/// cut. All of them turn as the spindle does.
const SCREW_JACK: &str = r#"
spec = 1
name = "screw_jack"
[points]
O = ["0 m", "0 m", "0 m"]
N = ["0 m", "0 m", "0.2 m"]
[bodies]
spindle = { mass = "3 kg", centre = "O", inertia = ["0.1 kg*m^2", "0.1 kg*m^2", "0.002 kg*m^2"] }
nut = { mass = "2 kg", centre = "N", inertia = ["0.01 kg*m^2", "0.01 kg*m^2", "0.01 kg*m^2"] }
[joints]
R = { revolute = ["ground", "spindle"], at = "O", axis = [0, 0, 1], drive = "40 rad/s*t + 30 rad*sin(t*1 rad/s)" }
G = { prismatic = ["ground", "nut"], at = "N", axis = [0, 0, 1] }
H = { screw = ["nut", "spindle"], at = "N", axis = [0, 0, 1], lead = "5 mm", cut = true }
S = { revolute = ["ground", "spindle"], at = "N", axis = [0, 0, 1], cut = true }
C = { cylindrical = ["ground", "spindle"], at = "N", axis = [0, 0, 1], cut = true }
"#;

#[test]
fn turns_of_cut_joints_do_not_depend_on_the_rows() {
    let compiled = compile_source(&source(SCREW_JACK), &[], None);
    // Steps of half a turn and more; those of the adaptive method grow to seven turns.
    let methods = [
        Integrator::Dopri5 { tolerance: 1e-6, max_step: None },
        Integrator::Rk4 { step: 0.1 },
        Integrator::GeneralizedAlpha { step: 0.1, rho: 0.9 },
    ];
    for integrator in methods {
        for samples in [2, 11, 201] {
            let run = run_with(&compiled, &Settings::new(integrator, Span::Time(10.0), samples));
            let expected: Vec<f64> = run.run.times.iter().map(|t| 40.0 * t + 30.0 * t.sin()).collect();
            for name in ["H.q", "S.q", "C.q1"] {
                let error = largest_difference(&run.column(name), &expected);
                // A wrong number of turns is off by 6; loops are closed to 1e-14 m, which is 1e-11 rad of the thread.
                assert!(error < 1e-9, "{name} with {samples} rows by {integrator:?}: {error:e}");
                let most = run.run.range(name).expect("a column").high.value;
                assert!((most - expected[samples - 1]).abs() < 1e-9, "{name}: {most}");
            }
        }
    }
}

#[test]
fn a_step_too_long_to_count_turns_stops_the_run() {
    let compiled = compile_source(&source(SCREW_JACK), &[], None);
    let settings = Settings::new(Integrator::Rk4 { step: 0.5 }, Span::Time(10.0), 21);
    let (system, parameters) = (compiled.interpreter(), compiled.parameters());
    let run =
        simulate(&system, compiled.description(), &parameters, &settings, Watch::NONE).expect("it starts");
    assert!(
        matches!(&run.stopped, Some(RunError::TurnsUnclear { angle, .. }) if angle == "H.q"),
        "{:?}",
        run.stopped
    );
}

/// A kite falls over and over: O, A, C, P with OA = AC = 1 m, OP = PC = 2 m. Twice a turn all its links lie in line; there the
/// crank could also go on with the coupler folded onto it and the rocker at rest.
const KITE: &str = r#"
spec = 1
name = "kite"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[points]
O = ["0 m", "0 m", "0 m"]
P = ["2 m", "0 m", "0 m"]
A = ["0 m", "1 m", "0 m"]
C = ["0.8 m", "1.6 m", "0 m"]
crank_centre = ["0 m", "0.5 m", "0 m"]
coupler_centre = ["0.3 m", "1.2 m", "0 m"]
rocker_centre = ["1.5 m", "0.9 m", "0 m"]
[bodies]
crank = { mass = "1 kg", centre = "crank_centre", inertia = ["0.1 kg*m^2", "0.1 kg*m^2", "0.1 kg*m^2"] }
coupler = { mass = "0.7 kg", centre = "coupler_centre", inertia = ["0.05 kg*m^2", "0.05 kg*m^2", "0.05 kg*m^2"] }
rocker = { mass = "1.5 kg", centre = "rocker_centre", inertia = ["0.2 kg*m^2", "0.2 kg*m^2", "0.2 kg*m^2"] }
[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1] }
R2 = { revolute = ["ground", "rocker"], at = "P", axis = [0, 0, 1] }
R3 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R4 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1] }
[initial]
R1 = { q = "0 rad", v = "-8 rad/s" }
"#;

/// Inertia of the kite by the crank's speed, and its potential energy, at the crank's angle from the ground link. C mirrors O
/// in the line AP, so the rocker turns by twice what AP does, and the coupler by that less the crank's angle.
fn kite(theta: f64) -> (f64, f64) {
    let turned =
        |[x, y]: [f64; 2], angle: f64| [angle.cos() * x - angle.sin() * y, angle.sin() * x + angle.cos() * y];
    let line = |theta: f64| theta.sin().atan2(theta.cos() - 2.0);
    let start = std::f64::consts::FRAC_PI_2;
    let rate = (1.0 - 2.0 * theta.cos()) / (5.0 - 4.0 * theta.cos());
    let rocker_angle = 2.0 * (line(theta) - line(start));
    let crank = turned([0.0, 0.5], theta - start);
    let rocker = turned([-0.5, 0.9], rocker_angle);
    let offset = turned([0.3, 0.2], rocker_angle - (theta - start));
    let spin = 2.0 * rate - 1.0;
    let (vx, vy) = (-theta.sin() - spin * offset[1], theta.cos() + spin * offset[0]);
    let inertia = 0.1
        + 0.25
        + (0.2 + 1.5 * (0.25 + 0.81)) * 4.0 * rate * rate
        + 0.05 * spin * spin
        + 0.7 * (vx * vx + vy * vy);
    (inertia, 9.81 * (crank[1] + 1.5 * rocker[1] + 0.7 * (theta.sin() + offset[1])))
}

/// Time from the start to an angle [s], from the energy, by Simpson's rule with an error below 1e-12 s.
fn kite_time(angle: f64) -> f64 {
    let start = std::f64::consts::FRAC_PI_2;
    let (inertia, potential) = kite(start);
    let energy = 32.0 * inertia + potential;
    let slowness = |theta: f64| {
        let (inertia, potential) = kite(theta);
        (inertia / (2.0 * (energy - potential))).sqrt()
    };
    let pieces = 40_000;
    let at = |i: usize| slowness(start + angle * i as f64 / pieces as f64);
    let inner: f64 = (1..pieces).map(|i| if i % 2 == 1 { 4.0 * at(i) } else { 2.0 * at(i) }).sum();
    (at(0) + inner + at(pieces)) * angle.abs() / (3.0 * pieces as f64)
}

#[test]
fn a_kite_passes_its_singular_positions_as_its_energy_says() {
    let compiled = compile_source(&source(KITE), &[], None);
    // Twelve passages in 5 s. At first the tolerance decides, a tenth of it in each of 1,400 steps; then rounding, with the
    // floor that the four-bars have too.
    for (tolerance, bound) in [(1e-8, 1e-7), (1e-10, 5e-9), (1e-12, 5e-9)] {
        let run = run(&compiled, Span::Time(5.0), Span::Time(0.0), 2, tolerance);
        let error = (kite_time(run.last("R1.q")) - 5.0).abs();
        reached("kite", &format!("tolerance {tolerance:e}, time to its angle at 5 s [s]"), error, bound);
        assert!(run.run.statistics.steps < 10_000);
    }
}
