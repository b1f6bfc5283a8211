//! Drives of balls and of universal joints: a body whose rotation is prescribed, against Euler's equations by hand.

mod simulated;

use linkwear_runtime::{Integrator, Run, Settings, Span};
use simulated::{refused, run_with};

fn run(text: &str, end: f64) -> Run {
    run_with(
        text,
        &Settings::new(Integrator::Dopri5 { tolerance: 1e-10, max_step: None }, Span::Time(end), 13),
    )
}

/// Rounding of some hundred operations.
const EXACT: f64 = 1e-11;

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= EXACT * expected.abs().max(1.0), "{found}, not {expected}");
}

#[track_caller]
fn all_near(found: V, expected: V) {
    found.into_iter().zip(expected).for_each(|(found, expected)| near(found, expected));
}

type V = [f64; 3];
type M = [V; 3];

fn add(a: V, b: V) -> V {
    [0, 1, 2].map(|i| a[i] + b[i])
}
fn times(s: f64, a: V) -> V {
    a.map(|x| s * x)
}
fn dot(a: V, b: V) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn apply(m: &M, a: V) -> V {
    [0, 1, 2].map(|i| dot(m[i], a))
}
fn product(a: &M, b: &M) -> M {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
fn transposed(m: &M) -> M {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[j][i]))
}
/// Rotation about an axis of the frame.
fn about(axis: usize, angle: f64) -> M {
    let (sin, cos) = angle.sin_cos();
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = [[0.0; 3]; 3];
    m[axis][axis] = 1.0;
    (m[j][j], m[k][k], m[k][j], m[j][k]) = (cos, cos, sin, -sin);
    m
}
fn unit(axis: usize) -> V {
    [0, 1, 2].map(|i| f64::from(u8::from(i == axis)))
}

/// Rotation, angular velocity and acceleration of a body that turns in turn about the given axes of the frame carried so far, by
/// angles with their rates; and these axes in W.
fn turned(start: (M, V, V), turns: &[(usize, [f64; 3])]) -> ((M, V, V), Vec<V>) {
    let ((mut rotation, mut omega, mut alpha), mut axes) = (start, Vec::new());
    for (axis, [q, v, a]) in turns {
        let along = apply(&rotation, unit(*axis));
        alpha = add(alpha, add(times(*a, along), times(*v, cross(omega, along))));
        omega = add(omega, times(*v, along));
        rotation = product(&rotation, &about(*axis, *q));
        axes.push(along);
    }
    ((rotation, omega, alpha), axes)
}

const REST: (M, V, V) = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3], [0.0; 3]);

/// Angle with its rates: `size sin(w t) + rate t`.
fn wave(t: f64, size: f64, w: f64, rate: f64) -> [f64; 3] {
    let (sin, cos) = (w * t).sin_cos();
    [size * sin + rate * t, size * w * cos + rate, -size * w * w * sin]
}

const MASS: f64 = 1.5;
const CENTRE: V = [0.1, 0.05, -0.02];
const PRINCIPAL: V = [0.02, 0.03, 0.04];
const GRAVITY: V = [0.0, 0.0, -9.81];
const BODY: &str =
    r#"body = { mass = "1.5 kg", centre = "C", inertia = ["0.02 kg m^2", "0.03 kg m^2", "0.04 kg m^2"] }"#;

/// What holds the body at a point of it that is at `lever` from its centre and moves with `acceleration`: moment about it, force.
fn euler((rotation, omega, alpha): (M, V, V), acceleration: V) -> [V; 2] {
    let lever = apply(&rotation, CENTRE);
    let centre = add(acceleration, add(cross(alpha, lever), cross(omega, cross(omega, lever))));
    let force = times(MASS, add(centre, times(-1.0, GRAVITY)));
    let inertia = |vector: V| {
        let own = apply(&transposed(&rotation), vector);
        apply(&rotation, [0, 1, 2].map(|i| PRINCIPAL[i] * own[i]))
    };
    let moment = add(inertia(alpha), cross(omega, inertia(omega)));
    [add(moment, cross(lever, force)), force]
}

fn vector(run: &Run, stem: &str, row: usize) -> V {
    run.vector(stem).expect("three columns")[row]
}

#[test]
fn a_driven_ball_takes_the_torque_of_eulers_equations() {
    for reversed in [false, true] {
        let pair = if reversed { r#"["body", "ground"]"# } else { r#"["ground", "body"]"# };
        let text = format!(
            r#"gravity = [0, 0, "-9.81 m/s^2"]
[points]
O = [0, 0, 0]
C = ["100 mm", "50 mm", "-20 mm"]
[bodies]
{BODY}
[joints]
ball = {{ spherical = {pair}, at = "O", drive = {{ q1 = "0.8*sin(3 rad/s*t)", q2 = "1.9*sin(2 rad/s*t)", q3 = "0.3*sin(5 rad/s*t) + 4 rad/s*t" }} }}
"#
        );
        // The second angle passes a right angle, where the first and the third axis are one.
        let run = run(&text, 2.0);
        for (row, t) in run.times.iter().enumerate() {
            let angles = [wave(*t, 0.8, 3.0, 0.0), wave(*t, 1.9, 2.0, 0.0), wave(*t, 0.3, 5.0, 4.0)];
            let (motion, moment, force, axes);
            if reversed {
                // The ground turns by these angles seen from the body: the body by the opposite, in opposite order.
                let back = [2, 1, 0].map(|i| (i, angles[i].map(|x| -x)));
                let (found, found_axes) = turned(REST, &back);
                let [m, f] = euler(found, [0.0; 3]);
                // The joint's child is the ground; generalised forces keep their sign with the coordinates.
                axes = [2, 1, 0].map(|i: usize| times(-1.0, found_axes[i]));
                (motion, moment, force) = (found, m, f);
                for (i, axis) in axes.iter().enumerate() {
                    near(run.column(&format!("ball.drive{}", i + 1)).unwrap()[row], dot(moment, *axis));
                }
                all_near(vector(&run, "ball.drive_M", row), times(-1.0, moment));
                all_near(vector(&run, "ball.F", row), times(-1.0, force));
            } else {
                let (found, found_axes) = turned(REST, &[0, 1, 2].map(|i| (i, angles[i])));
                [moment, force] = euler(found, [0.0; 3]);
                motion = found;
                for (i, axis) in found_axes.iter().enumerate() {
                    near(run.column(&format!("ball.drive{}", i + 1)).unwrap()[row], dot(moment, *axis));
                }
                all_near(vector(&run, "ball.drive_M", row), moment);
                all_near(vector(&run, "ball.F", row), force);
            }
            all_near(vector(&run, "body.w", row), motion.1);
            assert_eq!(vector(&run, "ball.M", row), [0.0; 3]);
        }
        let (error, through) = (run.statistics.energy_error_J, run.statistics.energy_throughput_J);
        // Work of the drive is integrated to the run's tolerance of 1e-10.
        assert!(error <= 1e-9 * through, "{error} J of {through} J");
    }
}

#[test]
fn both_coordinates_of_a_universal_joint_can_be_driven_on_a_turning_parent() {
    let text = format!(
        r#"gravity = [0, 0, "-9.81 m/s^2"]
[points]
O = [0, 0, 0]
C = ["100 mm", "50 mm", "-20 mm"]
[bodies]
table = {{ mass = "2 kg", centre = "O", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.1 kg m^2"] }}
{BODY}
[joints]
turn = {{ revolute = ["ground", "table"], at = "O", axis = [0, 0, 1], drive = "3 rad/s*t + 0.5*sin(4 rad/s*t)" }}
cross = {{ universal = ["table", "body"], at = "O", axes = [[1, 0, 0], [0, 1, 0]], drive = {{ q1 = "0.8*sin(3 rad/s*t)", q2 = "1.2*sin(2 rad/s*t)" }} }}
"#
    );
    let run = run(&text, 2.0);
    for (row, t) in run.times.iter().enumerate() {
        let turns =
            [(2, wave(*t, 0.5, 4.0, 3.0)), (0, wave(*t, 0.8, 3.0, 0.0)), (1, wave(*t, 1.2, 2.0, 0.0))];
        let (motion, axes) = turned(REST, &turns);
        let [moment, force] = euler(motion, [0.0; 3]);
        let [first, second] = [dot(moment, axes[1]), dot(moment, axes[2])];
        near(run.column("cross.drive1").unwrap()[row], first);
        near(run.column("cross.drive2").unwrap()[row], second);
        let left = add(moment, add(times(-first, axes[1]), times(-second, axes[2])));
        all_near(vector(&run, "cross.M", row), left);
        all_near(vector(&run, "cross.F", row), force);
        let own = 0.1 * wave(*t, 0.5, 4.0, 3.0)[2];
        near(run.column("turn.drive").unwrap()[row], own + moment[2]);
    }
    let (error, through) = (run.statistics.energy_error_J, run.statistics.energy_throughput_J);
    assert!(error <= 1e-9 * through, "{error} J of {through} J");
}

#[test]
fn one_coordinate_of_a_universal_joint_can_be_driven_and_the_other_swings() {
    // Driven about z, free about x: a pendulum on a turning shaft, w' = ((I_y - I_z) W² cos q sin q - m g l sin q)/I_x with its bar
    // along -z.
    for (axes, driven, free) in [("[[0, 0, 1], [1, 0, 0]]", "q1", 2), ("[[1, 0, 0], [0, 0, 1]]", "q2", 1)] {
        let text = format!(
            r#"gravity = [0, 0, "-9.81 m/s^2"]
[points]
O = [0, 0, 0]
E = [0, 0, "-0.4 m"]
[bodies]
bob = {{ mass = "1 kg", centre = "E", inertia = ["0.01 kg m^2", "0.02 kg m^2", "0.03 kg m^2"] }}
[joints]
cross = {{ universal = ["ground", "bob"], at = "O", axes = {axes}, drive = {{ {driven} = "2 rad/s*t" }} }}
[initial]
cross = {{ q{free} = "0.6 rad" }}
"#
        );
        if free == 1 {
            // The driven axis is carried by the pendulum, which spins about its own axis: the swing is that of a top, only its energy
            // is told here.
            let run = run(&text, 1.0);
            assert!(run.statistics.energy_error_J <= 1e-8 * run.statistics.energy_throughput_J.max(1e-3));
            continue;
        }
        let run = run(&text, 1.0);
        let (arm, spin) = (0.4, 2.0);
        // About the pin: x along it, y across, z along the bar; the mass adds m l² to both across the bar.
        let [ix, iy, iz] = [0.01 + arm * arm, 0.02 + arm * arm, 0.03];
        let rate = |q: f64| ((iy - iz) * spin * spin * q.cos() * q.sin() - 9.81 * arm * q.sin()) / ix;
        let (mut q, mut v, steps) = (0.6, 0.0, 100_000);
        let h = 1.0 / f64::from(steps);
        for _ in 0..steps {
            let (a, b) = (rate(q), rate(q + 0.5 * h * v));
            let c = rate(q + 0.5 * h * v + 0.25 * h * h * a);
            let d = rate(q + h * v + 0.5 * h * h * b);
            (q, v) = (q + h * v + h * h / 6.0 * (a + b + c), v + h / 6.0 * (a + 2.0 * b + 2.0 * c + d));
        }
        let angles = run.column("cross.q2").unwrap();
        let end = angles.last().copied().unwrap();
        // The run's tolerance of 1e-10.
        assert!((end - q).abs() < 1e-8, "{end}, not {q}");
        assert!(run.statistics.energy_error_J <= 1e-8 * run.statistics.energy_throughput_J);
    }
}

#[test]
fn wrong_uses_are_answered() {
    for (joint, code, cure) in [
        (r#"drive = "t/(1 s)""#, "E0409", "q2 ="),
        (r#"drive = { q1 = "t/(1 s)" }"#, "E0103", "add the others"),
        (r#"drive = { q1 = 0, q2 = 0, q3 = "if(t < 1 s, 0, 1)" }"#, "E0310", "smooth_step"),
        (r#"drive = { q1 = 0, q2 = 0, q3 = 0 }, damping = "1 N m s""#, "E0107", "take it away"),
        (r#"drive = { q1 = 0, q2 = 0, q3 = "1 m" }"#, "E0303", ""),
    ] {
        let told = refused(&format!(
            "gravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\nC = [\"1 m\", 0, 0]\n[bodies]\n{BODY}\n[joints]\nball = {{ spherical = [\"ground\", \"body\"], at = \"O\", {joint} }}\n"
        ));
        assert!(told.contains(code) && told.contains(cure), "{joint}\n{told}");
    }
}

/// The same start, written from the ground and from the body: place, turn and speeds of one as the other sees it.
#[test]
fn what_flies_starts_alike_from_either_side_of_its_joint() {
    let start = |joint: &str, values: &str| {
        run(
            &format!(
                "gravity = [0, 0, 0]\n[points]\nO = {{ at = [0, 0, 0], on = \"a\" }}\n[bodies]\n\
                 a = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"1e-2 kg m^2\", \"2e-2 kg m^2\", \"2.5e-2 kg m^2\"] }}\n[joints]\n\
                 J = {{ {joint}, at = \"O\" }}\n[initial]\nJ = {{ {values} }}\n"
            ),
            0.1,
        )
    };
    let of = |run: &Run, names: [&str; 3]| names.map(|name| run.column(name).expect("it is there")[0]);
    let reversed = start(
        "free = [\"a\", \"ground\"]",
        "q3 = \"90 deg\", q4 = \"0.2 m\", v3 = \"2 rad/s\", v4 = \"1 m/s\"",
    );
    // The ground is turned by 90 degrees as the body sees it, and the body by -90 in the ground.
    all_near(of(&reversed, ["O.x", "O.y", "O.z"]), [0.0, 0.2, 0.0]);
    all_near(of(&reversed, ["a.wx", "a.wy", "a.wz"]), [0.0, 0.0, -2.0]);
    all_near(of(&reversed, ["O.vx", "O.vy", "O.vz"]), [0.4, 1.0, 0.0]);
    let drawn = start(
        "free = [\"ground\", \"a\"]",
        "q3 = \"-90 deg\", q5 = \"0.2 m\", v3 = \"-2 rad/s\", v4 = \"0.4 m/s\", v5 = \"1 m/s\"",
    );
    all_near(of(&drawn, ["O.x", "O.y", "O.z"]), [0.0, 0.2, 0.0]);
    all_near(of(&drawn, ["O.vx", "O.vy", "O.vz"]), [0.4, 1.0, 0.0]);
    // A ball's speeds are along axes of the joint's first body.
    let ball = start("spherical = [\"a\", \"ground\"]", "q3 = \"90 deg\", v1 = \"1 rad/s\"");
    all_near(of(&ball, ["a.wx", "a.wy", "a.wz"]), [0.0, 1.0, 0.0]);
}

#[test]
fn a_free_joint_between_two_bodies_takes_no_start() {
    let inertia = "inertia = [\"1e-2 kg m^2\", \"1e-2 kg m^2\", \"1e-2 kg m^2\"]";
    let told = refused(&format!(
        "gravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\n[bodies]\na = {{ mass = \"1 kg\", centre = \"O\", {inertia} }}\n\
         b = {{ mass = \"1 kg\", centre = \"O\", {inertia} }}\n[joints]\nG = {{ free = [\"ground\", \"a\"], at = \"O\" }}\n\
         J = {{ free = [\"a\", \"b\"], at = \"O\" }}\n[initial]\nJ = {{ q4 = \"0.1 m\" }}\n"
    ));
    assert!(told.contains("E0410") && told.contains("between two bodies"), "{told}");
}
