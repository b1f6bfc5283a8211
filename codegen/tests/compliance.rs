//! Elastic mounts with full matrices, torsion springs, springs of ball and universal joints, against closed forms and the generalised
//! eigenvalue problem.

mod simulated;

use std::fmt::Write as _;

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Run, Settings, Span, Watch, simulate};
use nalgebra::{Matrix3, Matrix6, Quaternion, UnitQuaternion, Vector3, Vector6};
use simulated::run_with;

fn run(text: &str, end: f64) -> Run {
    run_with(
        text,
        &Settings::new(Integrator::Dopri5 { tolerance: 1e-12, max_step: None }, Span::Time(end), 101),
    )
}

/// Largest distance of a column from a function of time.
fn worst(run: &Run, column: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let values = run.column(column).expect(column);
    run.times.iter().zip(values).fold(0.0, |worst, (t, value)| (value - exact(*t)).abs().max(worst))
}

fn matrix_text(matrix: &Matrix6<f64>, units: [&str; 3]) -> String {
    let mut text = "[".to_owned();
    for i in 0..6 {
        text += "[";
        for j in 0..6 {
            let _ = write!(
                text,
                "\"{:e} {}\", ",
                matrix[(i, j)],
                units[usize::from(i >= 3) + usize::from(j >= 3)]
            );
        }
        text += "], ";
    }
    text + "]"
}

const STIFFNESS: [&str; 3] = ["N/m", "N", "N m"];
const DAMPING: [&str; 3] = ["N s/m", "N s", "N m s"];

/// A stiffness with all couplings, positive definite: a sum of six springs in different places and directions.
fn stiffness() -> Matrix6<f64> {
    let springs = [
        (8e4, [1.0, 0.2, 0.0], [0.0, 0.1, 0.05]),
        (5e4, [0.0, 1.0, 0.3], [0.1, 0.0, -0.1]),
        (9e4, [0.2, 0.0, 1.0], [0.1, 0.1, 0.0]),
        (4e4, [1.0, 1.0, 0.0], [0.0, -0.1, 0.2]),
        (6e4, [0.0, 1.0, -1.0], [-0.2, 0.1, 0.1]),
        (3e4, [1.0, 0.0, 1.0], [0.1, -0.2, 0.1]),
    ];
    let mut sum = Matrix6::zeros();
    for (k, direction, place) in springs {
        let u = Vector3::from(direction).normalize();
        let turn = Vector3::from(place).cross(&u);
        let line = Vector6::new(u.x, u.y, u.z, turn.x, turn.y, turn.z);
        sum += k * line * line.transpose();
    }
    sum
}

const MASS: f64 = 3.0;
const INERTIA: [f64; 3] = [0.02, 0.03, 0.045];
const CENTRE: [f64; 3] = [0.03, -0.02, 0.05];

/// By velocity of the mount's point and angular velocity.
fn mass() -> Matrix6<f64> {
    let lever = Vector3::from(CENTRE).cross_matrix();
    let mut mass = Matrix6::zeros();
    mass.fixed_view_mut::<3, 3>(0, 0).copy_from(&(MASS * Matrix3::identity()));
    mass.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-MASS * lever));
    mass.fixed_view_mut::<3, 3>(3, 0).copy_from(&(MASS * lever));
    let own = Matrix3::from_diagonal(&Vector3::from(INERTIA)) - MASS * lever * lever;
    mass.fixed_view_mut::<3, 3>(3, 3).copy_from(&own);
    mass
}

/// A free body on a mount, which starts at x: displacement of the mount's point, then rotation.
fn mounted(mount: &str, x: &Vector6<f64>) -> String {
    format!(
        "gravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\nC = [\"{} m\", \"{} m\", \"{} m\"]\n[bodies]\n\
         engine = {{ mass = \"{MASS} kg\", centre = \"C\", inertia = [\"{} kg m^2\", \"{} kg m^2\", \"{} kg m^2\"] }}\n[joints]\n\
         F = {{ free = [\"ground\", \"engine\"], at = \"O\" }}\n[forces.mount]\nbushing = [\"ground\", \"engine\"]\nat = \"O\"\n{mount}\n\
         [initial]\nF = [\"{:e} rad\", \"{:e} rad\", \"{:e} rad\", \"{:e} m\", \"{:e} m\", \"{:e} m\"]\n",
        CENTRE[0],
        CENTRE[1],
        CENTRE[2],
        INERTIA[0],
        INERTIA[1],
        INERTIA[2],
        x[3],
        x[4],
        x[5],
        x[0],
        x[1],
        x[2]
    )
}

/// The six modes: started in the shape of one, the body stays in it and swings with its frequency.
#[test]
fn a_body_on_a_full_matrix_swings_in_the_modes_of_the_generalised_eigenvalue_problem() {
    let k = stiffness();
    let root = mass().cholesky().expect("positive").l();
    let inverse = root.try_inverse().expect("regular");
    let eigen = (inverse * k * inverse.transpose()).symmetric_eigen();
    let amplitude = 1e-6;
    for mode in 0..6 {
        let omega = eigen.eigenvalues[mode].sqrt();
        let shape: Vector6<f64> = inverse.transpose() * eigen.eigenvectors.column(mode);
        let x = amplitude * shape / shape.amax();
        let mount = format!("stiffness_matrix = {}", matrix_text(&k, STIFFNESS));
        let run = run(&mounted(&mount, &x), 4.0 * std::f64::consts::PI / omega);
        for (i, column) in ["F.x", "F.y", "F.z", "F.q1", "F.q2", "F.q3"].into_iter().enumerate() {
            let scale = if i < 3 { 1.0 } else { 0.5 };
            let off = worst(&run, column, |t| scale * x[i] * (omega * t).cos());
            // What is not linear is of the order of the square of the amplitude, with levers of 0.1 m, over two periods; and a
            // run's tolerance.
            assert!(off < 1e-4 * amplitude, "mode {mode}, {column}: {off:e}");
        }
    }
}

#[test]
fn energy_of_a_full_mount_is_kept_and_lost_as_it_says() {
    let x = Vector6::new(0.002, -0.003, 0.001, 0.3, -0.2, 0.4);
    let k = stiffness();
    let elastic = format!(
        "stiffness_matrix = {}\ntranslation = {{ preload = [\"20 N\", 0, \"-30 N\"] }}\nrotation = {{ preload = [0, \"4 N m\", 0] }}",
        matrix_text(&k, STIFFNESS)
    );
    let kept = run(&mounted(&elastic, &x), 0.3);
    let total = |run: &Run, at: usize| {
        ["kinetic", "potential"]
            .map(|part| run.column(&format!("energy.{part}")).unwrap()[at])
            .iter()
            .sum::<f64>()
    };
    let begin = total(&kept, 0);
    let stored = 0.5 * x.dot(&(k * x)) + 20.0 * x[0] - 30.0 * x[2] + 4.0 * x[4];
    // Sums of a few products.
    assert!((begin - stored).abs() < 1e-10 * stored.abs(), "{begin} {stored}");
    // The tolerance of the run, on large rotations.
    assert!((total(&kept, 100) - begin).abs() < 1e-7 * begin, "{}", total(&kept, 100) - begin);
    let damped = format!("{elastic}\ndamping_matrix = {}", matrix_text(&(1e-3 * k), DAMPING));
    let lost = run(&mounted(&damped, &x), 0.3);
    assert!(total(&lost, 100) < 0.1 * begin);
    assert!(lost.statistics.energy_error_J < 1e-7 * begin, "{}", lost.statistics.energy_error_J);
}

/// The matrix of a mount by axis is the same mount.
#[test]
fn a_diagonal_matrix_is_a_mount_by_axis() {
    let x = Vector6::new(0.01, 0.02, -0.01, 0.3, 0.2, -0.4);
    let by_axis = "directions = [[2, 1, 0], [-1, 2, 0]]\ntranslation = { stiffness = [\"5e4 N/m\", \"2e4 N/m\", \"1e4 N/m\"], \
                   damping = [\"50 N s/m\", 0, \"20 N s/m\"] }\nrotation = { stiffness = [\"90 N m\", \"70 N m\", \"50 N m\"], \
                   damping = [0, \"0.3 N m s\", 0] }";
    let k = Matrix6::from_diagonal(&Vector6::new(5e4, 2e4, 1e4, 90.0, 70.0, 50.0));
    let c = Matrix6::from_diagonal(&Vector6::new(50.0, 0.0, 20.0, 0.0, 0.3, 0.0));
    let full = format!(
        "directions = [[2, 1, 0], [-1, 2, 0]]\nstiffness_matrix = {}\ndamping_matrix = {}",
        matrix_text(&k, STIFFNESS),
        matrix_text(&c, DAMPING)
    );
    let [one, other] = [by_axis.to_owned(), full].map(|mount| run(&mounted(&mount, &x), 0.2));
    for column in ["F.x", "F.y", "F.z", "F.q1", "F.q2", "F.q3"] {
        let (a, b) = (one.column(column).unwrap(), other.column(column).unwrap());
        // The same numbers in another order of sums, in steps that rounding may change.
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9), "{column}");
    }
}

const WHEEL: &str = "gravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\n[bodies]\nwheel = { mass = \"1 kg\", centre = \"O\", inertia = \
                     [\"0.02 kg m^2\", \"0.02 kg m^2\", \"0.02 kg m^2\"] }\n";

/// Around `rest - preload/k`, with sqrt(J/k).
#[test]
fn a_torsion_pendulum_swings_about_its_rest_angle() {
    for (spring, rest) in [
        ("stiffness = \"8 N m/rad\", rest = \"30 deg\"", 30_f64.to_radians()),
        ("stiffness = \"8 N m/rad\", rest = \"30 deg\", preload = \"2 N m\"", 30_f64.to_radians() - 0.25),
        ("q = { stiffness = \"8 N m/rad\", preload = \"-2 N m\" }", 0.25),
    ] {
        let text = format!(
            "{WHEEL}[joints]\nJ = {{ revolute = [\"ground\", \"wheel\"], at = \"O\", axis = [0, 1, 1], spring = {{ {spring} }} }}\n"
        );
        let run = run(&text, 2.0);
        // The tolerance of the run over six periods.
        let off = worst(&run, "J.q", |t| rest * (1.0 - (20.0 * t).cos()));
        assert!(off < 1e-9, "{spring}: {off:e}");
        assert!(run.statistics.energy_error_J < 1e-9);
    }
    // Without stiffness the preload is a torque that stays.
    let text = format!(
        "{WHEEL}[joints]\nJ = {{ revolute = [\"ground\", \"wheel\"], at = \"O\", axis = [0, 0, 1], spring = {{ stiffness = 0, preload = \"-1 N m\" }} }}\n"
    );
    // Met but for roundings: a parabola.
    assert!(worst(&run(&text, 1.0), "J.q", |t| 25.0 * t * t) < 1e-10);
}

/// A spring on a ball turns about the axis of its rotation vector however large that is; by components small ones are three springs.
#[test]
fn a_spring_on_a_ball_is_a_torsion_pendulum_about_any_axis() {
    let text = |spring: &str, start: [f64; 3]| {
        format!(
            "{WHEEL}[joints]\nS = {{ spherical = [\"ground\", \"wheel\"], at = \"O\", spring = {{ {spring} }} }}\n[initial]\n\
             S = [\"{} rad\", \"{} rad\", \"{} rad\"]\n",
            start[0], start[1], start[2]
        )
    };
    let vector = [1.2, -0.8, 1.5];
    let angle = Vector3::from(vector).norm();
    let one = run(&text("stiffness = \"8 N m/rad\"", vector), 2.0);
    let turned = |t: f64| angle * (20.0 * t).cos();
    // The tolerance of the run over six periods.
    assert!(worst(&one, "S.q0", |t| (0.5 * turned(t)).cos()) < 1e-9);
    for (i, column) in ["S.q1", "S.q2", "S.q3"].into_iter().enumerate() {
        assert!(worst(&one, column, |t| vector[i] / angle * (0.5 * turned(t)).sin()) < 1e-9);
    }
    let parts = "q1 = { stiffness = \"8 N m/rad\" }, q2 = { stiffness = \"2 N m/rad\", rest = \"0.002 rad\" }, \
                 q3 = { stiffness = \"18 N m/rad\", preload = \"0.018 N m\" }";
    let small = run(&text(parts, [0.001, 0.0, 0.0]), 1.0);
    let exact: [&dyn Fn(f64) -> f64; 3] =
        [&|t| 0.001 * (20.0 * t).cos(), &|t| 0.002 * (1.0 - (10.0 * t).cos()), &|t| {
            -0.001 * (1.0 - (30.0 * t).cos())
        }];
    for (i, column) in ["S.q1", "S.q2", "S.q3"].into_iter().enumerate() {
        // Of two rotations of some milliradians half the product is about the third axis.
        let off = worst(&small, column, |t| 0.5 * exact[i](t));
        assert!(off < 2e-5, "{column}: {off:e}");
    }
    assert!(small.statistics.energy_error_J < 1e-12);
}

/// Drives, springs, dampers and torques about either axis of a universal joint, also where it closes a loop.
#[test]
fn universal_joints_have_springs_dampers_and_drives_about_their_axes() {
    let text = |more: &str| {
        format!(
            "{WHEEL}[joints]\nU = {{ universal = [\"ground\", \"wheel\"], at = \"O\", axes = [[1, 0, 0], [0, 1, 0]], {more} }}\n[initial]\nU = {{ q2 = \"0.3 rad\" }}\n"
        )
    };
    let free = run(&text("drive = { q1 = 0 }, spring = { q2 = { stiffness = \"8 N m/rad\" } }"), 1.0);
    assert!(worst(&free, "U.q2", |t| 0.3 * (20.0 * t).cos()) < 1e-9);
    let damped = run(
        &text(
            "drive = { q1 = \"0.5*sin(3*t/(1 s))\" }, spring = { q2 = { stiffness = \"8 N m/rad\" } }, damping = { q2 = \"0.08 N m s\" }",
        ),
        1.0,
    );
    // An inertia that is the same about all axes does not feel the other turn: x'' + 4 x' + 400 x = 0.
    let w = 396_f64.sqrt();
    assert!(
        worst(&damped, "U.q2", |t| 0.3 * (-2.0 * t).exp() * ((w * t).cos() + 2.0 / w * (w * t).sin())) < 1e-8
    );
    assert!(worst(&damped, "U.drive1", |t| -0.02 * 0.5 * 9.0 * (3.0 * t).sin()) < 1e-8);
}

/// A weight that the preload carries rests where it is drawn; the first body takes the reaction.
#[test]
fn a_preload_carries_its_weight_in_the_reference_pose() {
    let text = "gravity = [0, 0, \"-9.81 m/s^2\"]\n[points]\nO = [0, 0, 0]\n[bodies]\nbase = { mass = \"1 kg\", centre = \"O\", inertia = \
                [\"0.02 kg m^2\", \"0.02 kg m^2\", \"0.02 kg m^2\"] }\nload = { mass = \"2 kg\", centre = \"O\", inertia = [\"0.02 kg m^2\", \
                \"0.02 kg m^2\", \"0.02 kg m^2\"] }\n[joints]\nB = { prismatic = [\"ground\", \"base\"], at = \"O\", axis = [0, 0, 1], drive = 0 }\n\
                F = { free = [\"ground\", \"load\"], at = \"O\" }\n[forces.mount]\nbushing = [\"base\", \"load\"]\nat = \"O\"\n\
                translation = { stiffness = [\"1e4 N/m\", \"1e4 N/m\", \"1e4 N/m\"], preload = [0, 0, \"-19.62 N\"] }\n\
                rotation = { stiffness = [\"10 N m\", \"10 N m\", \"10 N m\"] }\n";
    let run = run(text, 0.5);
    assert!(worst(&run, "F.z", |_| 0.0) < 1e-12);
    // Both weights.
    assert!(worst(&run, "B.drive", |_| 3.0 * 9.81) < 1e-9);
}

/// Newton's and Euler's equations of both bodies that a mount of full matrices holds together, flying and tumbling under gravity: its
/// columns are the force and the moment on the second about that one's point, and the first takes the reaction there.
#[test]
fn columns_of_a_mount_are_what_newton_and_euler_ask_of_both_bodies() {
    let [x, y] = [[0.002, -0.003, 0.001, 0.3, -0.2, 0.4], [-0.001, 0.002, 0.004, -0.5, 0.1, 0.2]];
    let k = stiffness();
    let bodies = [(MASS, INERTIA, [0.03, -0.02, 0.05]), (2.0, [0.01, 0.02, 0.015], [-0.06, 0.04, 0.01])];
    let mut text = "gravity = [0, \"1 m/s^2\", \"-9.81 m/s^2\"]\n[points]\nO = [0, 0, 0]\n".to_owned();
    for (i, (.., c)) in bodies.iter().enumerate() {
        let _ = writeln!(text, "C{i} = [\"{} m\", \"{} m\", \"{} m\"]", c[0], c[1], c[2]);
    }
    text += "[bodies]\n";
    for (i, (m, j, _)) in bodies.iter().enumerate() {
        let inertia = j.map(|j| format!("\"{j} kg m^2\"")).join(", ");
        let _ = writeln!(text, "b{i} = {{ mass = \"{m} kg\", centre = \"C{i}\", inertia = [{inertia}] }}");
    }
    text += "[joints]\n";
    for i in 0..2 {
        let _ = writeln!(text, "F{i} = {{ free = [\"ground\", \"b{i}\"], at = \"O\" }}");
    }
    let _ = writeln!(
        text,
        "[forces.mount]\nbushing = [\"b0\", \"b1\"]\nat = \"O\"\ndirections = [[2, 1, 0], [-1, 2, 0]]\nstiffness_matrix = {}\n\
         damping_matrix = {}\ntranslation = {{ preload = [\"20 N\", 0, \"-30 N\"] }}\nrotation = {{ preload = [0, \"4 N m\", 0] }}\n[sensors]",
        matrix_text(&k, STIFFNESS),
        matrix_text(&(1e-4 * k), DAMPING)
    );
    for i in 0..2 {
        for axis in ["x", "y", "z"] {
            let _ = writeln!(text, "a{i}{axis} = \"C{i}.a{axis}\"\nalpha{i}{axis} = \"b{i}.alpha_{axis}\"");
        }
    }
    text += "[initial]\n";
    for (i, x) in [x, y].iter().enumerate() {
        let _ = writeln!(
            text,
            "F{i} = [\"{} rad\", \"{} rad\", \"{} rad\", \"{} m\", \"{} m\", \"{} m\"]",
            x[3], x[4], x[5], x[0], x[1], x[2]
        );
    }
    let run = run(&text, 0.2);
    let at = |column: String, row: usize| run.column(&column).expect(&column)[row];
    let vector = |form: &dyn Fn(&str) -> String, row: usize| {
        Vector3::from(["x", "y", "z"].map(|axis| at(form(axis), row)))
    };
    let gravity = Vector3::new(0.0, 1.0, -9.81);
    let mut most = 0.0_f64;
    for row in 0..run.times.len() {
        let force = vector(&|axis| format!("mount.F{axis}"), row);
        let moment = vector(&|axis| format!("mount.M{axis}"), row);
        let place = vector(&|axis| format!("F1.{axis}"), row);
        for (i, (m, j, _)) in bodies.iter().enumerate() {
            let sign = if i == 0 { -1.0 } else { 1.0 };
            let centre = vector(&|axis| format!("C{i}.{axis}"), row);
            let acceleration = vector(&|axis| format!("a{i}{axis}.value"), row);
            let off = *m * (acceleration - gravity) - sign * force;
            // Sums of some products of forces of 1 kN.
            assert!(off.amax() < 1e-9, "row {row}, body {i}: {off}");
            let [w, alpha] = [
                vector(&|axis| format!("b{i}.w{axis}"), row),
                vector(&|axis| format!("alpha{i}{axis}.value"), row),
            ];
            let q = [0, 1, 2, 3].map(|n| at(format!("F{i}.q{n}"), row));
            let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
            let turn = turn.to_rotation_matrix();
            let inertia = turn * Matrix3::from_diagonal(&Vector3::from(*j)) * turn.inverse();
            let off =
                inertia * alpha + w.cross(&(inertia * w)) - sign * (moment + (place - centre).cross(&force));
            // Moments of 100 N m.
            assert!(off.amax() < 1e-10, "row {row}, body {i}: {off}");
        }
        most = most.max(moment.amax());
    }
    assert!(most > 10.0, "{most}");
}

/// A formula may ask for the force of a mount as for that in a joint, and it is known before the equations are solved: also beside a joint
/// with clearance.
#[test]
fn formulas_ask_for_the_force_of_a_mount_and_the_pull_of_a_cable() {
    let text = "gravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\nW = [\"-1 m\", 0, 0]\n[bodies]\nload = { mass = \"2 kg\", centre = \"O\", \
                inertia = [\"0.02 kg m^2\", \"0.02 kg m^2\", \"0.02 kg m^2\"] }\n[joints]\n\
                S = { prismatic = [\"ground\", \"load\"], at = \"O\", axis = [1, 0, 0], force = \"2*mount.Fx - rope.F\" }\n\
                [forces.mount]\nbushing = [\"ground\", \"load\"]\nat = \"O\"\ntranslation = { stiffness = [\"100 N/m\", 0, 0] }\n\
                [forces.rope]\ncable = [\"ground\", \"load\"]\nat = [\"W\", \"O\"]\nstiffness = \"250 N/m\"\nlength = \"0.5 m\"\n\
                [states]\npush = { initial = \"0 N s\", rate = \"mount.Fx\" }\n[sensors]\ntwice = \"2*mount.Fx\"\nspan = \"rope.length\"\n\
                [initial]\nS = \"-250 mm\"\n";
    let run = run(text, 1.0);
    // 300 N/m by the mount and what follows it, 500 N/m by the rope, which is taut throughout, and 250 N of its stretch.
    let (w, mean) = (20.0, -250.0 / 800.0);
    let x = |t: f64| mean + (-0.25 - mean) * (w * t).cos();
    // The tolerance of the run over three periods.
    assert!(worst(&run, "S.q", x) < 1e-9);
    assert!(worst(&run, "twice.value", |t| -200.0 * x(t)) < 1e-7);
    assert!(worst(&run, "span.value", |t| 1.0 + x(t)) < 1e-9);
    let sum = |t: f64| -100.0 * (mean * t + (-0.25 - mean) * (w * t).sin() / w);
    assert!(worst(&run, "push.value", sum) < 1e-7);
}

/// The moment of a spring on a ball is beside the joint's own.
#[test]
fn a_spring_on_a_ball_tells_its_moment() {
    let text = format!(
        "{WHEEL}[joints]\nS = {{ spherical = [\"ground\", \"wheel\"], at = \"O\", spring = {{ stiffness = \"8 N m/rad\" }} }}\n[initial]\n\
         S = [0, \"0.6 rad\", \"0.8 rad\"]\n"
    );
    let run = run(&text, 1.0);
    for (axis, share) in [("x", 0.0), ("y", 0.6), ("z", 0.8)] {
        // The tolerance of the run over three periods, times 8 N m.
        assert!(worst(&run, &format!("S.spring_M{axis}"), |t| -8.0 * share * (20.0 * t).cos()) < 1e-8);
        assert!(worst(&run, &format!("S.M{axis}"), |_| 0.0) < 1e-12);
    }
    assert!(run.column("S.spring_Fx").is_err());
}

/// The shipped example has a stop, a strap, a full mount and a preloaded spring at work, and loses no energy unseen.
#[test]
fn the_drop_hammer_uses_all_its_elements() {
    let text = include_str!("../../examples/data/drop_hammer.toml");
    let source = SourceFile { name: "drop_hammer.toml".into(), text: text.into() };
    let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(compiled.warnings.len(), 0, "{:?}", compiled.warnings);
    let method = Integrator::Dopri5 { tolerance: 1e-8, max_step: None };
    let settings = Settings::new(method, Span::Time(1.2), 2401);
    let system = compiled.interpreter();
    let run = simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(run.stopped, None);
    for column in ["blow.F", "flap.T", "strap.F"] {
        assert!(run.column(column).unwrap().iter().any(|force| *force > 0.0), "{column}");
    }
    // Both masses part with e times the speed they met with: the ram comes up by v²/2g.
    let heights = run.column("guide.q").unwrap();
    let struck = heights.iter().position(|q| *q < 1e-4).expect("it falls");
    let next = heights[struck..].iter().position(|q| *q > 0.005).expect("it comes up") + struck;
    let rebound = heights[next..next + 400].iter().fold(0.0_f64, |most, q| q.max(most));
    let v = (2.0 * 9.81 * 0.25_f64).sqrt() * (0.4 * 180.0 - 12.0) / (180.0 + 12.0);
    // Meanwhile the frame swings by 0.19 m/s sqrt(192 kg/(3 MN/m)) = 1.5 mm.
    assert!((rebound - v * v / (2.0 * 9.81)).abs() < 2e-3, "{rebound}");
    // Of the 30 J of the fall, at a tolerance of 1e-8 through some contacts of microseconds.
    assert!(run.statistics.energy_error_J < 1e-4, "{}", run.statistics.energy_error_J);
}
