//! Runs that must end early, forces of every kind in the energy balance, parameters changed at run time.

mod support;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Run, RunError, Settings, Span, Watch, simulate};
use support::{compile_source, largest_difference, run, shipped};

fn source(text: &str) -> SourceFile {
    SourceFile { name: "test.toml".to_owned(), text: text.to_owned() }
}

/// Bars 0.2, 0.2 and 0.25 m over pivots 0.3 m apart: the crank cannot go round. Its tip and the far pivot are
/// 0.45 m apart at the latest where cos q = (0.2² + 0.3² - 0.45²) / (2 · 0.2 · 0.3), q = 127.17 deg.
const SHORT: &str = r#"
spec = 1
name = "short"
gravity = [0, 0, 0]
[points]
O = [0, 0, 0]
A = ["0.2 m", 0, 0]
D = ["0.3 m", 0, 0]
C = { coupler = ["0.4 m", 0, 0], rocker = ["0.55 m", 0, 0] }
[bodies]
crank = { rod = ["O", "A"], radius = "5 mm", mass = "1 kg" }
coupler = { rod = ["A", "C"], radius = "5 mm", mass = "1 kg" }
rocker = { rod = ["D", "C"], radius = "5 mm", mass = "1 kg" }
[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "90 deg + 1 rad/s*t" }
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }
[assembly]
R2 = "-90 deg"
R4 = "80 deg"
"#;

fn past_the_dead_point(integrator: Integrator) -> Run {
    let compiled = compile_source(&source(SHORT), &[], None);
    let settings = Settings::new(integrator, Span::Time(2.0), 201);
    let system = compiled.interpreter();
    simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .expect("it can start")
}

#[test]
fn a_crank_that_cannot_go_round_stops_with_joint_and_time_and_keeps_its_samples() {
    let q: f64 = (0.2_f64.powi(2) + 0.3_f64.powi(2) - 0.45_f64.powi(2)) / (2.0 * 0.2 * 0.3);
    let dead = q.acos() - std::f64::consts::FRAC_PI_2;
    let methods = [
        Integrator::Dopri5 { tolerance: 1e-8, max_step: None },
        Integrator::Rk4 { step: 1e-3 },
        Integrator::GeneralizedAlpha { step: 1e-3, rho: 0.8 },
    ];
    for integrator in methods {
        let run = past_the_dead_point(integrator);
        let stopped = run.stopped.expect("no crank turns further than its bars let it");
        let text = stopped.to_string();
        let RunError::DeadPoint { t, joint, position, angular: true } = stopped else {
            panic!("{integrator:?}: {text}")
        };
        // Loops count as closed at a start up to 1e-8, and so does a driver that is beyond its dead point by that.
        assert!((t - dead).abs() < 1e-6, "{text}, dead point at {dead}");
        assert!(joint == "R1" && (position - q.acos()).abs() < 1e-6, "{text}");
        // A sample every 10 ms.
        assert!(run.rows.len() as f64 >= (dead - 0.02) / 0.01, "{} samples", run.rows.len());
        assert!(run.rows.iter().flatten().all(|value| value.is_finite()));
    }
}

const HEAD: &str = r#"
spec = 1
name = "forces"
gravity = [0, 0, "-9.81 m/s^2"]
[points]
O = [0, 0, 0]
A = { at = ["0.4 m", 0, 0], on = "arm" }
B = { at = ["0.4 m", "0.5 m", 0], on = "bar" }
M = { at = ["0.2 m", "0.1 m", 0], on = "arm" }
[bodies]
arm = { box = ["O", "A"], width = ["20 mm", "30 mm"], width_axis = [0, 0, 1], mass = "1 kg" }
bar = { box = ["A", "B"], width = ["20 mm", "30 mm"], width_axis = [0, 0, 1], mass = "0.7 kg" }
"#;

/// Energy now = energy at the start + supplied - dissipated, to 1e-8 of what went through.
fn assert_balance(joints: &str, forces: &str, initial: &str) {
    let text = format!("{HEAD}[joints]\n{joints}\n[forces]\n{forces}\n[initial]\n{initial}\n");
    let compiled = compile_source(&source(&text), &[], None);
    let statistics = run(&compiled, Span::Time(5.0), Span::Time(0.0), 11, 1e-11).run.statistics;
    // 1e-8 is what users are promised; tolerance 1e-11 leaves about 1e-13.
    assert!(
        statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
        "{:e} J of {:e} J",
        statistics.energy_error_J,
        statistics.energy_throughput_J
    );
    assert!(statistics.energy_throughput_J > 0.1, "nothing happened: {:e} J", statistics.energy_throughput_J);
}

const HINGES: &str = r#"
J1 = { revolute = ["ground", "arm"], at = "O", axis = [0, 1, 0.3] }
J2 = { universal = ["arm", "bar"], at = "A", axes = [[1, 0, 0], [0, 0, 1]], damping = { q1 = "0.05 N m s/rad" } }
"#;

#[test]
fn springs_between_moving_bodies_balance() {
    let spring = r#"S = { spring = ["arm", "bar"], at = ["M", "B"], stiffness = "40 N/m", length = "0.3 m", damping = "0.5 N s/m", preload = "2 N" }
T = { spring = ["ground", "bar"], at = ["O", "B"], stiffness = "15 N/m", length = "0.2 m" }"#;
    assert_balance(HINGES, spring, "J1 = { v = \"2 rad/s\" }");
}

#[test]
fn forces_by_expression_over_coordinates_speeds_and_time_balance() {
    let forces = r#"F = { force = "bar", reaction = "arm", at = "B", axes = "bar", components = ["1 N*sin(3 rad/s*t)", "2 N*cos(J1.q)", "-0.2 N s/m*B.vz"] }
G = { force = "arm", at = "M", components = ["0.5 N", "3 N/m*B.y", "1 N*tanh(J2.v1/(1 rad/s))"] }"#;
    assert_balance(HINGES, forces, "J2 = { v2 = \"1 rad/s\" }");
}

#[test]
fn torques_in_body_axes_with_reactions_balance() {
    let torques = r#"T = { torque = "bar", reaction = "arm", axes = "bar", components = ["0.3 N m*sin(5 rad/s*t)", "0.1 N m*J1.q", "-0.2 N m s/rad*J2.v2"] }
U = { torque = "arm", axes = "arm", components = ["0.1 N m", "0.3 N m*cos(2 rad/s*t)", "0.2 N m"] }"#;
    assert_balance(HINGES, torques, "");
}

#[test]
fn actuators_springs_and_dampers_in_driven_loops_balance() {
    let joints = r#"
J1 = { revolute = ["ground", "arm"], at = "O", axis = [0, 0, 1], drive = "0.4*sin(3 rad/s*t)" }
J2 = { spherical = ["arm", "bar"], at = "A", friction = "0.02 N m s/rad" }
J3 = { universal = ["bar", "slide"], at = "B", axes = [[1, 0, 0], [0, 0, 1]], spring = { q1 = { stiffness = "2 N m", rest = "10 deg" } } }
J4 = { prismatic = ["ground", "slide"], at = "B", axis = [0, 1, 0], force = "2 N*sin(J1.q) - 3 N s/m*J4.v + 1 N*cos(7 rad/s*t)" }"#;
    let joints = joints.to_owned();
    let text = HEAD.replace(
        "[bodies]",
        "[bodies]\nslide = { mass = \"0.3 kg\", centre = \"B\", inertia = [\"1 g m^2\", \"1 g m^2\", \"1 g m^2\"] }",
    );
    let text = format!("{text}[joints]\n{joints}\n");
    let compiled = compile_source(&source(&text), &[], None);
    let statistics = run(&compiled, Span::Time(5.0), Span::Time(0.0), 11, 1e-11).run.statistics;
    assert!(
        statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
        "{:e} J of {:e} J",
        statistics.energy_error_J,
        statistics.energy_throughput_J
    );
}

/// The RSSR with every parameter that is not tunable yet made so.
fn all_tunable() -> SourceFile {
    let mut source = shipped("rssr_rigid");
    let mut inside = false;
    let lines = source.text.lines().map(|line| {
        if line.starts_with('[') {
            inside = line.starts_with("[parameters]");
        }
        let Some((name, value)) = line.split_once(" = ").filter(|_| inside && !line.starts_with('#')) else {
            return line.to_owned();
        };
        let value = value.split('#').next().unwrap_or_default().trim();
        if value.contains("tunable") {
            line.to_owned()
        } else if let Some(table) = value.strip_suffix('}') {
            format!("{name} = {table}, tunable = true }}")
        } else {
            format!("{name} = {{ value = {value}, tunable = true }}")
        }
    });
    source.text = lines.collect::<Vec<_>>().join("\n");
    source
}

#[test]
fn values_changed_at_run_time_act_as_values_compiled_in() {
    let changes = [
        ("L1", "130 mm", 0.13),
        ("L2", "0.45 m", 0.45),
        ("L3", "240 mm", 0.24),
        ("r", "8 mm", 0.008),
        ("steel", "2700 kg/m^3", 2700.0),
        ("speed", "3 Hz", 3.0),
        ("c_rocker", "1 N m s/rad", 1.0),
        ("c_ball", "2e-4 N m s/rad", 2e-4),
    ];
    let tunable = compile_source(&all_tunable(), &[], None);
    let mut parameters = tunable.parameters();
    assert_eq!(parameters.len(), changes.len(), "every parameter is tunable");
    for (name, _, value) in changes {
        let at = tunable.description().parameters.iter().position(|p| p.name == name).expect("a parameter");
        parameters[at] = value;
    }
    // Fixed steps: rounding must not decide their size.
    let settings = Settings::new(Integrator::Rk4 { step: 1e-4 }, Span::Time(0.3), 31);
    let system = tunable.interpreter();
    let changed =
        simulate(&system, tunable.description(), &parameters, &settings, Watch::NONE).expect("it runs");
    let overrides = changes.map(|(name, text, _)| (name, text));
    let folded = support::run_with(&compile_source(&shipped("rssr_rigid"), &overrides, None), &settings);
    assert_eq!(changed.times, folded.run.times);
    for (index, channel) in folded.description.channels.iter().enumerate() {
        let column = |rows: &[Vec<f64>]| rows.iter().map(|row| row[index]).collect::<Vec<f64>>();
        let (a, b) = (column(&changed.rows), column(&folded.run.rows));
        let scale = b.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        // One and the same formulas but for the order of rounding: 3000 steps leave less than 1e-13.
        let error = largest_difference(&a, &b) / scale;
        assert!(error < 1e-12, "{}: {error:e}", channel.name);
    }
}
