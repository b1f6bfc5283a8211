//! Elements that the oracle does not know, against it all the same: it is handed the forces that they exert, or exerts them itself, and
//! must see the motion and the forces in joints that the generated equations give.

mod agreement;
mod support;

use agreement::compare;
use linkwear_codegen::compile::Compiled;
use linkwear_codegen::source::SourceFile;
use linkwear_oracle::{BodyState, Oracle, Tolerance};
use linkwear_runtime::{Integrator, Run, Settings, Span, Watch, simulate};
use nalgebra::{Matrix3, Vector3};
use support::compile_source;

/// Both are exact up to rounding, in loops closed to 1e-13.
const AGREEMENT: f64 = 1e-8;

fn compiled(name: &str, text: &str) -> Compiled {
    let text = format!("spec = 1\nname = \"{name}\"\n{text}");
    compile_source(&SourceFile { name: name.into(), text }, &[], None)
}

fn run(compiled: &Compiled, end: f64, samples: usize) -> Run {
    let method = Integrator::Dopri5 { tolerance: 1e-11, max_step: None };
    let settings = Settings::new(method, Span::Time(end), samples);
    let run = simulate(
        &compiled.interpreter(),
        compiled.description(),
        &compiled.parameters(),
        &settings,
        Watch::NONE,
    );
    let run = run.expect("it starts");
    assert_eq!(run.stopped, None);
    run
}

/// x, y, z of a row.
fn vector(run: &Run, row: usize, form: &dyn Fn(&str) -> String) -> Vector3<f64> {
    Vector3::from(["x", "y", "z"].map(|axis| run.column(&form(axis)).expect("a column")[row]))
}

/// Two helical wheels on a tumbling arm, all three out of balance. The oracle has no wheels that mesh: their teeth are a force at the
/// pitch point, a place of the arm, on one and the other.
#[test]
fn wheels_that_mesh_on_a_moving_arm() {
    let [axis, across] = [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0]].map(|v| Vector3::from(v) / 3.0);
    let (first, second) = (0.03, 0.06);
    let [a, b] = [0.1, 0.1 + first + second].map(|at| at * across);
    let at = |p: Vector3<f64>| format!("[\"{:e} m\", \"{:e} m\", \"{:e} m\"]", p.x, p.y, p.z);
    let off = Vector3::new(0.004, -0.002, 0.01);
    let inertia = |j: [f64; 3]| j.map(|j| format!("\"{j} kg m^2\"")).join(", ");
    let text = |parameters: &str, between: &str| {
        format!(
            "gravity = [\"1 m/s^2\", \"-9 m/s^2\", \"2 m/s^2\"]\n[parameters]\n{parameters}\n[points]\nO = [0, 0, 0]\nA = {}\nB = {}\nP = {}\n\
             CA = {}\nCB = {}\n[bodies]\narm = {{ mass = \"2 kg\", centre = \"A\", inertia = [{}] }}\nw1 = {{ mass = \"0.5 kg\", centre = \"CA\", inertia = [{}] }}\n\
             w2 = {{ mass = \"1.2 kg\", centre = \"CB\", inertia = [{}] }}\n[joints]\nR0 = {{ spherical = [\"ground\", \"arm\"], at = \"O\" }}\n\
             R1 = {{ revolute = [\"arm\", \"w1\"], at = \"A\", axis = [1, 2, 2], damping = \"0.002 N m s\" }}\n\
             R2 = {{ revolute = [\"w2\", \"arm\"], at = \"B\", axis = [1, 2, 2], force = \"0.4 N m\" }}\n\
             [initial]\nR0 = {{ v1 = \"3 rad/s\", v2 = \"-2 rad/s\", v3 = \"1 rad/s\" }}\nR1 = {{ v = \"20 rad/s\" }}\n{between}\n",
            at(a),
            at(b),
            at(a + first * across),
            at(a + off),
            at(b - 2.0 * off),
            inertia([0.01, 0.02, 0.015]),
            inertia([3e-4, 2e-4, 2.5e-4]),
            inertia([2e-3, 2.5e-3, 1.5e-3]),
        )
    };
    let meshing = "[couplings]\nmesh = { gears = [\"w1\", \"w2\"], teeth = [20, 40], helix_angle = \"20 deg\", pressure_angle = \"22 deg\", at = \"P\" }";
    let compiled_wheels = compiled("wheels", &text("", meshing));
    let run = run(&compiled_wheels, 0.4, 9);
    let pushed = "[forces]\non1 = { force = \"arm\", at = \"P\", components = [\"fx\", \"fy\", \"fz\"], reaction = \"w1\" }\n\
                  on2 = { force = \"arm\", at = \"P\", components = [\"-fx\", \"-fy\", \"-fz\"], reaction = \"w2\" }";
    let free = compiled("pushed", &text("fx = \"0 N\"\nfy = \"0 N\"\nfz = \"0 N\"", pushed));
    let arm = Oracle::with_defaults(&free.mechanism).expect("a model");
    let (alpha, beta) = (22_f64.to_radians(), 20_f64.to_radians());
    let mut forces = Vec::new();
    for (row, t) in run.times.iter().enumerate() {
        let column = |name: &str| Some(run.column(name).ok()?[row]);
        let states = arm.states_from(&column).expect("columns reach every body");
        // What was along the arm's directions at the reference pose, now.
        let turn = states[0].rotation;
        let [u, e] = [turn * axis, turn * across];
        let tangent = u.cross(&e);
        let place = turn * (a + first * across);
        // Their pitch circles roll on each other.
        let [v1, v2] = [1, 2].map(|body| {
            let BodyState { centre, velocity, omega, .. } = &states[body];
            velocity + omega.cross(&(place - centre))
        });
        // Of 0.6 m/s.
        assert!((v2 - v1).dot(&tangent).abs() < 1e-11, "{}", (v2 - v1).dot(&tangent));
        let lambda = column("mesh.Ft").expect("a column");
        // A right hand: the angle is above zero.
        let force = lambda * (tangent - beta.tan() * u) + lambda.abs() * alpha.tan() / beta.cos() * e;
        forces.push(lambda);
        let model = Oracle::new(&free.mechanism, force.as_slice()).expect("a model");
        let rows = [(*t, run.rows[row].as_slice())].into_iter();
        let ledger = compare(&model, rows, &|name| run.index(name).ok());
        let (name, error) = ledger.worst(0.0).expect("numbers");
        assert!(error < AGREEMENT, "{name} ({error:.1e})");
    }
    // Both flanks are at work.
    let most = |sign: f64| forces.iter().fold(0.0, |most: f64, force| most.max(sign * force));
    assert!(most(1.0) > 0.1 && most(-1.0) > 0.1, "{forces:?}");
}

/// A rod that bounces in its bush, touching with either end. The oracle's rod flies free, pushed at its ends towards the line of the bush by
/// the normal forces of the run.
#[test]
fn a_rod_that_bounces_in_its_bush() {
    let (length, radial) = (0.06, 2e-4);
    let axis = Vector3::new(1.0, 1.0, 0.0).normalize();
    let end = |sign: f64| {
        let p = sign * 0.5 * length * axis;
        format!("[\"{:e} m\", \"{:e} m\", 0]", p.x, p.y)
    };
    let text = |parameters: &str, joint: &str, forces: &str, more: &str| {
        format!(
            r#"gravity = ["1 m/s^2", "-9.81 m/s^2", "3 m/s^2"]
[parameters]
{parameters}
[points]
O = [0, 0, 0]
C = {{ on = "rod", at = ["20 mm", "5 mm", "-8 mm"] }}
X = {{ on = "rod", at = ["1.02 m", "5 mm", "-8 mm"] }}
Y = {{ on = "rod", at = ["20 mm", "1.005 m", "-8 mm"] }}
E1 = {{ on = "rod", at = {} }}
E2 = {{ on = "rod", at = {} }}
[bodies]
rod = {{ mass = "0.5 kg", centre = "C", inertia = ["4e-4 kg m^2", "6e-4 kg m^2", "7e-4 kg m^2"] }}
[joints]
G = {{ {joint} }}
[forces]
shaker = {{ force = "rod", at = "C", components = [0, "15 N*sin(600*t/(1 s))", 0] }}
{forces}
{more}
"#,
            end(-1.0),
            end(1.0)
        )
    };
    let sensors: String = ["x", "y", "z"]
        .map(|axis| format!("a{axis} = \"C.a{axis}\"\nalpha{axis} = \"rod.alpha_{axis}\"\n"))
        .concat();
    let more = r#"[initial]
G = { v1 = "20 rad/s", v2 = "0.3 m/s" }
[clearance.G]
radial = "0.2 mm"
journal_radius = "10 mm"
length = "60 mm"
modulus = "1 GPa"
ends = "journal"
restitution = 0.7
"#;
    let loose = text(
        "",
        r#"cylindrical = ["ground", "rod"], at = "O", axis = [1, 1, 0]"#,
        "",
        &format!("{more}[sensors]\n{sensors}"),
    );
    let loose = compiled("loose", &loose);
    let run = run(&loose, 0.03, 301);
    let parameters = ["x1", "y1", "z1", "x2", "y2", "z2"].map(|name| format!("{name} = \"0 N\"\n")).concat();
    let pushes = r#"one = { force = "rod", at = "E1", components = ["x1", "y1", "z1"] }
two = { force = "rod", at = "E2", components = ["x2", "y2", "z2"] }"#;
    let free = compiled("flying", &text(&parameters, r#"free = ["ground", "rod"], at = "O""#, pushes, ""));
    let mut touched = [0, 0, 0];
    for row in 0..run.times.len() {
        let place = |name: &str| vector(&run, row, &|axis| format!("{name}.{axis}"));
        let centre = place("C");
        let [x, y] = ["X", "Y"].map(|name| place(name) - centre);
        let state = BodyState {
            rotation: Matrix3::from_columns(&[x, y, x.cross(&y)]),
            centre,
            velocity: vector(&run, row, &|axis| format!("C.v{axis}")),
            omega: vector(&run, row, &|axis| format!("rod.w{axis}")),
        };
        let mut forces = Vec::new();
        let mut count = 0;
        for number in [1, 2] {
            let end = place(&format!("E{number}"));
            let off = end - axis * axis.dot(&end);
            let [gap, normal] = ["gap", "Fn"]
                .map(|what| run.column(&format!("G.end{number}.{what}")).expect("a column")[row]);
            // Differences of places of some centimetres.
            assert!((gap - (radial - off.norm())).abs() < 1e-15, "{gap}");
            assert!(normal == 0.0 || gap < 0.0, "{normal} N at {gap} m");
            count += usize::from(normal > 0.0);
            forces.extend_from_slice((-normal * off.normalize()).as_slice());
        }
        touched[count] += 1;
        let model = Oracle::new(&free.mechanism, &forces).expect("a model");
        let solution = model.accelerations(run.times[row], &[state]);
        for (found, form) in [(solution.acceleration[0], "a"), (solution.alpha[0], "alpha")] {
            let ours = vector(&run, row, &|axis| format!("{form}{axis}.value"));
            let scale = 1.0 + found.amax();
            assert!((ours - found).amax() < AGREEMENT * scale, "{form}, row {row}: {ours} {found}");
        }
    }
    // In flight, on one end, on both.
    assert!(touched.iter().all(|rows| *rows > 0), "{touched:?}");
}

/// A double pendulum whose first joint a sampled PID controller with limits holds: the oracle's integrator goes from sample to sample, its
/// torque follows from (4) and (5) of docs/controllers.md, written here.
#[test]
fn a_double_pendulum_under_a_sampled_controller() {
    let text = |more: &str, motor: &str| {
        format!(
            "gravity = [0, \"-9.81 m/s^2\", \"1 m/s^2\"]\n{more}\n[points]\nO = [0, 0, 0]\nA = [\"0.3 m\", 0, 0]\nB = [\"0.5 m\", \"0.1 m\", 0]\n\
             [bodies]\nfirst = {{ mass = \"1 kg\", centre = \"A\", inertia = [\"0.01 kg m^2\", \"0.02 kg m^2\", \"0.03 kg m^2\"] }}\n\
             second = {{ mass = \"0.4 kg\", centre = \"B\", inertia = [\"0.01 kg m^2\", \"0.005 kg m^2\", \"0.01 kg m^2\"] }}\n[joints]\n\
             R1 = {{ revolute = [\"ground\", \"first\"], at = \"O\", axis = [0, 0, 1], force = \"{motor}\" }}\n\
             R2 = {{ revolute = [\"first\", \"second\"], at = \"A\", axis = [0, 1, 2], damping = \"0.02 N m s\" }}\n"
        )
    };
    let controller = "[controllers]\nmotor = { measured = \"R1.q\", setpoint = \"0.4 rad\", proportional = \"30 N m\", integral = \"60 N m/s\", \
                      derivative = \"3 N m s\", derivative_filter = \"3 ms\", sample_time = \"5 ms\", tracking = \"20 ms\", lower = \"-2 N m\", upper = \"7 N m\" }\n";
    let held = compiled(
        "held",
        &text("[parameters]", "motor").replace("[points]", &format!("{controller}[points]")),
    );
    let (end, h) = (0.8, 0.005);
    let run = run(&held, end, 161);
    let free = compiled("free", &text("[parameters]\nu = \"0 N m\"", "u"));
    let mut states = Oracle::with_defaults(&free.mechanism).expect("a model").reference_states();
    let [k, ki, kd, filter, tracking] = [30.0, 60.0, 3.0, 0.003, 0.02];
    let (mut integral, mut x) = (0.0, 0.0);
    let (mut limited, mut inside) = (false, false);
    let joint = linkwear_codegen::id::JointId::new(0);
    for sample in 0..160 {
        let model = Oracle::with_defaults(&free.mechanism).expect("a model");
        let y = model.joint_motion(joint, &states).position[0];
        let column = |name: &str| run.column(name).expect("a column")[sample];
        // The tolerance of both integrations.
        assert!((column("R1.q") - y).abs() < AGREEMENT, "{sample}: {} {y}", column("R1.q"));
        let wish = {
            let d = kd * (-y - x) / (filter + h);
            x += h * (-y - x) / (filter + h);
            k * (0.4 - y) + integral + d
        };
        let u: f64 = wish.clamp(-2.0, 7.0);
        integral += h * (ki * (0.4 - y) + (u - wish) / tracking);
        assert!((column("motor.value") - u).abs() < 1e-6, "{sample}: {} {u}", column("motor.value"));
        limited |= u != wish;
        inside |= u == wish;
        let model = Oracle::new(&free.mechanism, &[u]).expect("a model");
        let t = sample as f64 * h;
        states = model.integrate(t, t + h, &states, Tolerance(1e-12)).expect("it goes on");
    }
    assert!(limited && inside);
}
