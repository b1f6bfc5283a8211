//! Forces that depend on accelerations and joint forces of the same instant, dry friction, and states of a file's own,
//! against closed forms and integrations written here.

mod simulated;

use linkwear_codegen::compile::{Options, compile};
use linkwear_runtime::{Integrator, Run, Settings, Span, Watch, simulate};
use simulated::{at_end, refused, run_with, source};

const ADAPTIVE: Integrator = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };

fn run_by(text: &str, end: f64, samples: usize, method: Integrator) -> Run {
    run_with(text, &Settings::new(method, Span::Time(end), samples))
}

fn run(text: &str, end: f64) -> Run {
    run_by(text, end, 11, ADAPTIVE)
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs().max(1.0), "{found}, not {expected}");
}

#[track_caller]
fn energy_is_kept(run: &Run, part: f64) {
    let (error, throughput) = (run.statistics.energy_error_J, run.statistics.energy_throughput_J);
    assert!(error.abs() <= part * throughput, "{error} J of {throughput} J");
}

/// Rounding of some hundred operations and a run's tolerance of 1e-10.
const EXACT: f64 = 1e-8;

/// Blocks of 2 kg on rails along x.
fn blocks(gravity: &str, rails: &[&str], rest: &str) -> String {
    let mut bodies = String::from("[bodies]\n");
    let mut joints = String::from("[joints]\n");
    for (at, rail) in rails.iter().enumerate() {
        bodies += &format!(
            "block{at} = {{ mass = \"2 kg\", centre = \"O\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"1 kg m^2\"] }}\n"
        );
        joints += &format!(
            "rail{at} = {{ prismatic = [\"ground\", \"block{at}\"], at = \"O\", axis = [1, 0, 0], {rail} }}\n"
        );
    }
    format!("gravity = {gravity}\n[points]\nO = [0, 0, 0]\nE = [0, \"50 mm\", 0]\n{bodies}{joints}{rest}")
}

const FREE: &str = "[0, 0, 0]";

#[test]
fn a_force_against_the_acceleration_is_a_mass_more() {
    for method in
        [ADAPTIVE, Integrator::Rk4 { step: 0.05 }, Integrator::GeneralizedAlpha { step: 0.05, rho: 0.8 }]
    {
        let text = blocks(FREE, &[r#"force = "3 N - (4 kg)*rail0.a""#], "");
        let run = run_by(&text, 2.0, 11, method);
        near(at_end(&run, "rail0.a"), 0.5, EXACT);
        near(at_end(&run, "rail0.q"), 1.0, EXACT);
        energy_is_kept(&run, 1e-7);
    }
}

#[test]
fn forces_that_ask_for_each_other_are_solved_together() {
    let rails = [r#"force = "1 N - (1 kg)*rail1.a""#, r#"force = "2 N + (3 kg)*rail0.a + rail0.Fy""#];
    let run = run(&blocks("[0, \"-10 m/s^2\", 0]", &rails, ""), 1.0);
    // 2 a = 1 - b and 2 b = 2 + 3 a + 20.
    near(at_end(&run, "rail0.a"), -20.0 / 7.0, EXACT);
    near(at_end(&run, "rail1.a"), 1.0 + 40.0 / 7.0, EXACT);
}

#[test]
fn a_law_that_bends_is_solved_by_newtons_method() {
    // 2 a = 3 - a²/(4 m/s²): a = -4 + sqrt(16 + 12).
    let run = run(&blocks(FREE, &[r#"force = "3 N - (0.25 kg s^2/m)*rail0.a^2""#], ""), 1.0);
    near(at_end(&run, "rail0.a"), -4.0 + 28_f64.sqrt(), EXACT);
    near(at_end(&run, "rail0.q"), 0.5 * (-4.0 + 28_f64.sqrt()), EXACT);
}

#[test]
fn what_has_no_solution_is_no_number() {
    for force in ["3 N + (2 kg)*rail0.a", "3 N + (1 kg s^2/m)*rail0.a^2"] {
        let compiled =
            compile(&source(&blocks(FREE, &[&format!("force = \"{force}\"")], "")), &Options::default());
        let message = match compiled {
            Err(errors) => errors.to_string(),
            Ok(compiled) => {
                let settings = Settings::new(ADAPTIVE, Span::Time(1.0), 11);
                let system = compiled.interpreter();
                let run =
                    simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE);
                match run {
                    Err(error) => error.to_string(),
                    Ok(run) => run.stopped.map(|error| error.to_string()).expect("it is stopped"),
                }
            }
        };
        assert!(message.contains("rail0") && message.contains("finite"), "{message}");
    }
}

/// Of speeds far above the onset what is left of its smoothing.
const ONSET: &str = "onset = \"1e-6 m/s\"";

#[test]
fn a_block_slides_down_a_slope() {
    // 30 degrees: along the slope g sin, across g cos.
    let gravity = r#"["9.81*0.5 m/s^2", "-9.81 m/s^2 * sqrt(0.75)", 0]"#;
    let text = blocks(
        gravity,
        &[&format!("dry_friction = {{ coefficient = 0.2, {ONSET} }}")],
        "[initial]\nrail0 = { v = \"1 m/s\" }\n",
    );
    let run = run(&text, 1.0);
    let expected = 9.81 * (0.5 - 0.2 * 0.75_f64.sqrt());
    near(at_end(&run, "rail0.a"), expected, EXACT);
    near(at_end(&run, "rail0.q"), 1.0 + expected / 2.0, EXACT);
    energy_is_kept(&run, 1e-7);
}

#[test]
fn a_coefficient_falls_from_rest_to_sliding() {
    let text = blocks(
        "[0, \"-10 m/s^2\", 0]",
        &[&format!(
            "dry_friction = {{ coefficient = 0.1, at_rest = 0.3, stribeck_speed = \"0.5 m/s\", {ONSET} }}"
        )],
        "[initial]\nrail0 = { v = \"1 m/s\" }\n",
    );
    let run = run_by(&text, 0.1, 2, ADAPTIVE);
    near(run.column("rail0.a").unwrap()[0], -10.0 * (0.1 + 0.2 * (-4_f64).exp()), EXACT);
}

/// A drawer that is pulled beside its middle: both ends of the guide carry 10 N * 50 mm / L.
#[test]
fn a_drawer_pulled_at_its_side_runs_heavily() {
    let pull = "[forces]\npull = { force = \"block0\", at = \"E\", components = [\"10 N\", 0, 0] }\n[initial]\nrail0 = { v = \"1 m/s\" }\n";
    for (length, coefficient) in [(200.0, 0.3), (40.0, 0.3), (20.0, 0.3)] {
        let friction =
            format!("dry_friction = {{ coefficient = {coefficient}, {ONSET}, length = \"{length} mm\" }}");
        let run = run(&blocks(FREE, &[&friction], pull), 0.1);
        // Below `L = 2 mu e` it slows down however hard it is pulled.
        near(at_end(&run, "rail0.a"), 5.0 * (1.0 - 2.0 * coefficient * 50.0 / length), EXACT);
    }
}

fn pendulum(friction: &str) -> String {
    format!(
        r#"gravity = [0, "-9.81 m/s^2", 0]
[points]
O = [0, 0, 0]
A = ["0.5 m", 0, 0]
[bodies]
arm = {{ mass = "2 kg", centre = "A", inertia = ["0.01 kg m^2", "0.01 kg m^2", "0.01 kg m^2"] }}
[joints]
pin = {{ revolute = ["ground", "arm"], at = "O", axis = [0, 0, 1], {friction} }}
"#
    )
}

/// The same by its own equation: the moment of friction follows from the force in the pin, which follows from the
/// angular acceleration, found by iteration.
#[test]
fn a_pendulum_is_braked_by_its_own_bearing() {
    let (mu, radius, onset) = (0.3, 0.02, 0.05);
    let text = pendulum(&format!(
        "dry_friction = {{ coefficient = {mu}, radius = \"{radius} m\", onset = \"{onset} rad/s\" }}"
    ));
    let run = run_by(&text, 2.0, 5, ADAPTIVE);
    let (m, l, inertia, g) = (2.0, 0.5, 0.51, 9.81);
    let alpha = |q: f64, w: f64| {
        let mut alpha = 0.0;
        for _ in 0..100 {
            // Force of the pin on the arm, along it outwards and across it.
            let (along, across) = (m * (g * q.sin() - l * w * w), m * (g * q.cos() + l * alpha));
            let brake = -mu * radius * f64::hypot(along, across) * w / f64::hypot(w, onset);
            alpha = (brake - m * g * l * q.cos()) / inertia;
        }
        alpha
    };
    let (mut q, mut w) = (0.0, 0.0);
    let step = 1e-4;
    for _ in 0..20_000 {
        let k1 = (w, alpha(q, w));
        let k2 = (w + 0.5 * step * k1.1, alpha(q + 0.5 * step * k1.0, w + 0.5 * step * k1.1));
        let k3 = (w + 0.5 * step * k2.1, alpha(q + 0.5 * step * k2.0, w + 0.5 * step * k2.1));
        let k4 = (w + step * k3.1, alpha(q + step * k3.0, w + step * k3.1));
        q += step / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        w += step / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
    }
    near(at_end(&run, "pin.q"), q, EXACT);
    near(at_end(&run, "pin.v"), w, EXACT);
    energy_is_kept(&run, 1e-7);
}

const SLIDER_CRANK: &str = r#"gravity = [0, "-9.81 m/s^2", 0]
[points]
O = [0, 0, 0]
A = ["0.1 m", 0, 0]
B = ["0.4 m", 0, 0]
[bodies]
crank = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3" }
rod = { rod = ["A", "B"], radius = "8 mm", density = "7850 kg/m^3" }
piston = { mass = "1 kg", centre = "B", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }
"#;

/// The driver's torque is told by the power of friction and weight over a whole turn; the loop is cut elsewhere each time.
#[test]
fn the_drive_pays_for_friction_in_a_loop() {
    let mut ends = Vec::new();
    for cut in ["A", "B", "P"] {
        let mark = |joint: &str| if joint == cut { ", cut = true" } else { "" };
        let text = format!(
            r#"{SLIDER_CRANK}[joints]
O1 = {{ revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "20*t/(1 s)", dry_friction = {{ coefficient = 0.1, radius = "15 mm" }} }}
A1 = {{ revolute = ["crank", "rod"], at = "A", axis = [0, 0, 1], dry_friction = {{ coefficient = 0.1, radius = "12 mm", length = "20 mm" }}{} }}
B1 = {{ revolute = ["rod", "piston"], at = "B", axis = [0, 0, 1]{} }}
P1 = {{ prismatic = ["ground", "piston"], at = "B", axis = [1, 0, 0], dry_friction = {{ coefficient = 0.15, onset = "10 mm/s" }}{} }}
"#,
            mark("A"),
            mark("B"),
            mark("P")
        );
        let run = run(&text, 0.3);
        energy_is_kept(&run, 1e-6);
        let columns = ["O1.drive", "B1.Fx", "B1.Fy", "A1.Fx", "O1.Mz"];
        ends.push(columns.map(|column| at_end(&run, column)));
    }
    for other in &ends[1..] {
        for (a, b) in ends[0].iter().zip(other) {
            near(*a, *b, 1e-6);
        }
    }
}

#[test]
fn a_torque_may_follow_the_angular_velocity_and_acceleration_of_a_body() {
    let text = r#"gravity = [0, 0, 0]
[points]
O = [0, 0, 0]
[bodies]
top = { mass = "1 kg", centre = "O", inertia = ["1 kg m^2", "1 kg m^2", "1 kg m^2"] }
[joints]
ball = { spherical = ["ground", "top"], at = "O" }
[forces]
brake = { torque = "top", components = [0, 0, "-(3 N m s)*top.wz - (0.5 kg m^2)*top.alpha_z"] }
[initial]
ball = { v3 = "4 rad/s" }
"#;
    let run = run(text, 1.0);
    near(at_end(&run, "top.wz"), 4.0 * (-2_f64).exp(), EXACT);
}

#[test]
fn accelerations_of_points_are_those_of_their_columns_rates() {
    // Force in the direction of a point's acceleration: a point on the block moves as the block does.
    let rest = "[forces]\npush = { force = \"block0\", at = \"O\", components = [\"3 N - (4 kg)*E.ax\", \"(5 kg)*E.ay\", 0] }\n";
    let text = blocks("[0, \"-10 m/s^2\", 0]", &[""], rest)
        .replace(", axis = [1, 0, 0],  }", ", axis = [1, 0, 0] }")
        .replace("E = [0, \"50 mm\", 0]", "E = { at = [0, \"50 mm\", 0], on = \"block0\" }");
    let run = run(&text, 1.0);
    near(at_end(&run, "rail0.a"), 0.5, EXACT);
    near(at_end(&run, "rail0.Fy"), 20.0, EXACT);
}

#[test]
fn a_first_order_lag_follows_its_closed_form() {
    let text = blocks(
        FREE,
        &[r#"force = "x""#],
        "[states]\nx = { initial = \"1 N\", rate = \"(5 N - x)/(0.2 s)\" }\n",
    );
    let force = |t: f64| 5.0 - 4.0 * (-t / 0.2).exp();
    for method in [ADAPTIVE, Integrator::Rk4 { step: 1e-3 }] {
        let run = run_by(&text, 1.0, 11, method);
        for (t, x) in run.times.iter().zip(run.column("x.value").unwrap()) {
            near(x, force(*t), EXACT);
        }
        // Twice integrated: x/2 = 2.5 - 2 exp(-t/T).
        let speed = 2.5 - 2.0 * 0.2 * (1.0 - (-5_f64).exp());
        near(at_end(&run, "rail0.v"), speed, EXACT);
        near(at_end(&run, "x.rate"), 20.0 * (-5_f64).exp(), EXACT);
        energy_is_kept(&run, 1e-7);
    }
    // Of second order in the step: 4 (h/T)²/12 e^-1 at most.
    let method = Integrator::GeneralizedAlpha { step: 1e-3, rho: 0.9 };
    let run = run_by(&text, 1.0, 11, method);
    for (t, x) in run.times.iter().zip(run.column("x.value").unwrap()) {
        near(x, force(*t), 2e-4);
    }
}

/// A block under PID control: with `m s³ + kd s² + kp s + ki = 0` of roots -1, -2, -3 the error is a sum of three exponentials.
#[test]
fn a_pid_controller_moves_a_block_as_its_poles_say() {
    let rest = "[states]\nsum = { initial = \"0 m s\", rate = \"1 m - rail0.q\" }\n";
    let law = r#"force = "(22 N/m)*(1 m - rail0.q) + (12 N/(m s))*sum - (12 N s/m)*rail0.v""#;
    let run = run(&blocks(FREE, &[law], rest), 2.0);
    // e(0) = 1, e'(0) = 0, e''(0) = -11: coefficients of exp(-t), exp(-2t), exp(-3t).
    let (a, b, c) = (-2.5, 8.0, -4.5);
    near(a + b + c, 1.0, 1e-12);
    near(-a - 2.0 * b - 3.0 * c, 0.0, 1e-12);
    near(a + 4.0 * b + 9.0 * c, -11.0, 1e-12);
    let error = a * (-2_f64).exp() + b * (-4_f64).exp() + c * (-6_f64).exp();
    near(at_end(&run, "rail0.q"), 1.0 - error, EXACT);
}

/// Temperature of a bearing in a driven loop: what its friction heats less what it gives off, with friction that follows
/// the force of the same instant and falls as it warms. Energy that went in is energy that came out or was stored.
#[test]
fn a_state_in_a_driven_loop_takes_joint_forces() {
    let text = format!(
        r#"{SLIDER_CRANK}[joints]
O1 = {{ revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "20*t/(1 s)" }}
A1 = {{ revolute = ["crank", "rod"], at = "A", axis = [0, 0, 1] }}
B1 = {{ revolute = ["rod", "piston"], at = "B", axis = [0, 0, 1] }}
P1 = {{ prismatic = ["ground", "piston"], at = "B", axis = [1, 0, 0] }}
[states]
heat = {{ initial = "0 J", rate = "0.1*abs(P1.Fy*P1.v)" }}
work = {{ initial = "0 J", rate = "O1.drive*O1.v" }}
"#
    );
    let run = run_by(&text, 0.3, 301, ADAPTIVE);
    let column = |name: &str| run.column(name).unwrap();
    // All that the drive put in is motion and weight.
    let (kinetic, potential, work) =
        (column("energy.kinetic"), column("energy.potential"), column("work.value"));
    for at in 0..work.len() {
        near(work[at], kinetic[at] + potential[at] - kinetic[0] - potential[0], EXACT);
    }
    // The trapezoidal rule over the columns: its error is of second order in steps of 1 ms of 0.3 s.
    let power: Vec<f64> =
        column("P1.Fy").iter().zip(column("P1.v")).map(|(f, v)| 0.1 * (f * v).abs()).collect();
    let trapezoid: f64 = power.windows(2).map(|pair| 0.5e-3 * (pair[0] + pair[1])).sum();
    near(at_end(&run, "heat.value"), trapezoid, 1e-4);
}

/// Sensors over what the solution tells, of a pendulum whose pin has clearance too: contact forces are handed in.
#[test]
fn sensors_are_columns_and_stand_for_their_formulas() {
    let sensors = "[sensors]\nload = \"sqrt(pin.Fx^2 + pin.Fy^2)\"\ntwice = { value = \"2*load + (1 kg)*A.ay\", doc = \"and more\" }\n";
    let columns = |run: &Run| {
        for at in 0..run.times.len() {
            let value = |name: &str| run.column(name).unwrap()[at];
            let load = f64::hypot(value("pin.Fx"), value("pin.Fy"));
            near(value("load.value"), load, 1e-12);
            // Force and weight accelerate the arm.
            let vertical = value("pin.Fy") / 2.0 - 9.81;
            near(value("twice.value"), 2.0 * load + vertical, 1e-6);
        }
    };
    columns(&run(&(pendulum("") + sensors), 0.5));
    let loose = "[clearance.pin]\nradial = \"0.1 mm\"\njournal_radius = \"5 mm\"\nlength = \"10 mm\"\nmodulus = \"100 GPa\"\nrestitution = 0.5\n";
    let method = Integrator::Dopri5 { tolerance: 1e-8, max_step: None };
    columns(&run_by(&(pendulum("") + loose + sensors), 0.01, 21, method));
    // A force that asks by way of a sensor.
    let rest = "[sensors]\nhold = \"(4 kg)*rail0.a\"\n";
    let run = run(&blocks(FREE, &[r#"force = "3 N - hold""#], rest), 1.0);
    near(at_end(&run, "rail0.a"), 0.5, EXACT);
    near(at_end(&run, "hold.value"), 2.0, EXACT);
    let e = refused(&blocks(FREE, &[""], "[sensors]\na = \"2*b\"\nb = \"1 N\"\n").replace(",  }", " }"));
    assert!(e.contains("comes later"), "{e}");
}

#[test]
fn wrong_uses_are_answered() {
    let block = |rail: &str, rest: &str| refused(&blocks(FREE, &[rail], rest));
    let e = block(r#"force = "rail0.drive""#, "");
    assert!(e.contains("no drive"), "{e}");
    let e = block(r#"force = "rail0.a2*(1 kg)""#, "");
    assert!(e.contains("the acceleration `a`"), "{e}");
    let e = block(r#"drive = "x""#, "[states]\nx = { initial = \"1 m\", rate = \"1 m/s\" }\n");
    assert!(e.contains("E0202") || e.contains("not a number"), "{e}");
    let e = block(r#"force = "x""#, "[states]\nx = { initial = \"1 N\", rate = \"1 N\" }\n");
    assert!(e.contains("rate"), "{e}");
    let e = block(r#"force = "x""#, "[states]\nx = { initial = \"1 N\" }\n");
    assert!(e.contains("no rate"), "{e}");
    let e = block(r#"dry_friction = { coefficient = -0.1 }"#, "");
    assert!(e.contains("negative"), "{e}");
    let e = block(r#"dry_friction = { coefficient = 0.1, radius = "1 mm" }"#, "");
    assert!(e.contains("no `radius`"), "{e}");
    let e = block(r#"dry_friction = { coefficient = 0.1, at_rest = 0.2 }"#, "");
    assert!(e.contains("stribeck_speed"), "{e}");
    let e = refused(&pendulum("dry_friction = { coefficient = 0.1 }"));
    assert!(e.contains("`radius`"), "{e}");
    let loose = pendulum(r#"dry_friction = { coefficient = 0.1, radius = "5 mm" }"#)
        + "[clearance.pin]\nradial = \"0.1 mm\"\njournal_radius = \"5 mm\"\nlength = \"10 mm\"\nmodulus = \"100 GPa\"\n";
    let e = refused(&loose);
    assert!(e.contains("E0306") && e.contains("clearance"), "{e}");
}

#[test]
fn bearings_of_wheels_rub_by_the_force_of_rigid_teeth() {
    // Teeth that press wheels apart by tan 20 degrees of what they transmit; the second bearing has a radius of 10 mm and a coefficient of .1.
    let wheel = |name: &str, at: &str, inertia: f64| {
        format!(
            "{name} = {{ mass = \"1 kg\", centre = \"{at}\", inertia = [\"{inertia} kg m^2\", \"{inertia} kg m^2\", \"{inertia} kg m^2\"] }}\n"
        )
    };
    let text = |second: &str| {
        "gravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\nP = [\"80 mm\", 0, 0]\n[bodies]\n".to_owned()
            + &wheel("a", "O", 1e-3)
            + &wheel("b", "P", 1e-2)
            + "[joints]\nA = { revolute = [\"ground\", \"a\"], at = \"O\", axis = [0, 0, 1], force = \"2 N m\" }\n\
               B = { revolute = [\"ground\", \"b\"], at = \"P\", axis = [0, 0, 1], "
            + second
            + " }\n[couplings]\nm = { gears = [\"a\", \"b\"], teeth = [20, 60] }\n"
    };
    let tangent = (20.0_f64).to_radians().tan();
    // J1 a = 2 - .02 F, J2 a / 3 = .06 F - M; F and a are those of both wheels where M = m F.
    let solved = |m: f64| {
        let force = 2000.0 / (20.0 + 3.0 * (0.06 - m) / 1e-2);
        (force, 3.0 * (0.06 - m) * force / 1e-2)
    };
    let rubbing =
        run(&text("dry_friction = { coefficient = 0.1, radius = \"10 mm\", onset = \"1e-6 rad/s\" }"), 0.5);
    let (force, acceleration) = solved(1e-3 * tangent.hypot(1.0));
    near(at_end(&rubbing, "m.Ft").abs(), force, EXACT);
    near(at_end(&rubbing, "A.a"), acceleration, EXACT);
    energy_is_kept(&rubbing, 1e-7);
    // By a column of the force across the line of the teeth.
    let asking = run(&text("force = \"-(1 mm)*B.Fx\""), 0.5);
    let sign = at_end(&asking, "B.Fx").signum();
    let (force, acceleration) = solved(-sign * 1e-3 * tangent);
    near(at_end(&asking, "m.Ft").abs(), force, EXACT);
    near(at_end(&asking, "A.a"), acceleration, EXACT);
}
