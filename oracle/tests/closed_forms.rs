//! The oracle against textbook formulas. Mechanisms are written in Rust: nothing here parses a file.

mod sketch;

use linkwear_codegen::id::JointId;
use linkwear_codegen::model::{Carrier, JointModel};
use linkwear_oracle::closed_form::{FourBar, Motion, NFourBar, Pendulum, SliderCrank};
use linkwear_oracle::{BodyState, JointMotion, Oracle, Tolerance};
use nalgebra::{Matrix2, Vector2, Vector3};
use sketch::{Sketch, axis, law};

const G: f64 = 9.81;
const UP: [f64; 3] = [0.0, -G, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn scalar(position: f64, speed: f64) -> JointMotion {
    JointMotion { position: vec![position], speed: vec![speed] }
}

fn oracle(sketch: &Sketch) -> Oracle {
    Oracle::with_defaults(&sketch.0).expect("a sound sketch")
}

/// Mass 2 kg, 0.7 m below a pivot with axis z.
fn pendulum() -> (Oracle, JointId) {
    let mut s = Sketch::new(UP);
    let bob = s.body(2.0, [0.0, -0.7, 0.0], [0.02, 0.03, 0.04]);
    let pivot = s.joint(JointModel::new("revolute", &[axis(Z)]), Carrier::Ground, bob, [0.0; 3]);
    (oracle(&s), pivot)
}

#[test]
fn pendulum_accelerates_and_pulls_as_in_the_textbook() {
    let (oracle, pivot) = pendulum();
    let (q, v) = (0.8_f64, 1.7);
    let states = oracle.place(&[(pivot, scalar(q, v))]);
    let solution = oracle.accelerations(0.0, &states);
    let about_pivot = 0.04 + 2.0 * 0.49;
    let expected = -2.0 * G * 0.7 * q.sin() / about_pivot;
    // Rounding of numbers of order 10.
    assert!((solution.alpha[0].z - expected).abs() < 1e-13);
    // Force of the pivot on the bob: m (a - g), with the centre on a circle.
    let along = Vector3::new(q.sin(), -q.cos(), 0.0);
    let across = Vector3::new(q.cos(), q.sin(), 0.0);
    let acceleration = 0.7 * (expected * across - v * v * along);
    let force = 2.0 * (acceleration + G * Vector3::y());
    assert!((solution.wrenches[0].force - force).norm() < 1e-12);
    assert!(solution.wrenches[0].moment.norm() < 1e-12);
    assert!(solution.wrenches[0].unique.iter().all(|unique| *unique));
    assert_eq!((solution.rows, solution.rank), (5, 5));
}

#[test]
fn pendulum_swings_along_elliptic_functions() {
    let (oracle, pivot) = pendulum();
    let exact = Pendulum { frequency: (2.0 * G * 0.7 / (0.04 + 2.0 * 0.49_f64)).sqrt(), amplitude: 2.0 };
    let start = oracle.place(&[(pivot, scalar(2.0, 0.0))]);
    let times = [0.0, 0.5 * exact.period(), 2.3, 5.0];
    let path = oracle.trajectory(&times, &start, Tolerance(1e-13)).expect("a smooth motion");
    for (t, states) in times.iter().zip(&path) {
        let motion = oracle.joint_motion(pivot, states);
        // 1e-13 per step, some hundred steps.
        assert!((motion.position[0] - exact.motion(*t).position).abs() < 1e-11, "t = {t}");
        assert!((motion.speed[0] - exact.motion(*t).speed).abs() < 1e-11, "t = {t}");
    }
}

#[test]
fn free_body_keeps_energy_and_momentum() {
    let mut s = Sketch::new([0.0; 3]);
    s.body(3.0, [0.0; 3], [0.1, 0.25, 0.3]);
    let oracle = oracle(&s);
    let mut start = oracle.reference_states();
    // Near the unstable middle axis, so that the body tumbles.
    start[0].omega = Vector3::new(0.1, 5.0, 0.2);
    start[0].velocity = Vector3::new(1.0, -2.0, 0.5);
    let end = oracle.integrate(0.0, 4.0, &start, Tolerance(1e-13)).expect("a smooth motion");
    let spin = |s: &BodyState| s.rotation * (oracle.bodies[0].inertia * (s.rotation.transpose() * s.omega));
    // Rounding and 1e-13 per step over some hundred steps.
    assert!((spin(&end[0]) - spin(&start[0])).norm() < 1e-11);
    assert!((oracle.kinetic_energy(&end) - oracle.kinetic_energy(&start)).abs() < 1e-11);
    assert!((end[0].centre - Vector3::new(4.0, -8.0, 2.0)).norm() < 1e-12);
    // It did tumble: the middle axis points elsewhere.
    assert!((end[0].rotation * Vector3::y()).dot(&Vector3::y()) < 0.9);
}

#[test]
fn double_pendulum_accelerates_as_in_the_textbook() {
    // Two point masses on massless rods have (m1 + m2) l1² a1 + m2 l1 l2 cos(d) a2 + m2 l1 l2 sin(d) w2²
    // + (m1 + m2) g l1 sin q1 = 0 and its partner (Goldstein, chapter 1); absolute angles.
    let (m1, m2, l1, l2) = (1.3, 0.8, 0.6, 0.9);
    let mut s = Sketch::new(UP);
    let tiny = [1e-12; 3];
    let first = s.body(m1, [0.0, -l1, 0.0], tiny);
    let second = s.body(m2, [0.0, -l1 - l2, 0.0], tiny);
    let a = s.joint(JointModel::new("revolute", &[axis(Z)]), Carrier::Ground, first, [0.0; 3]);
    let b = s.joint(JointModel::new("revolute", &[axis(Z)]), first, second, [0.0, -l1, 0.0]);
    let oracle = oracle(&s);
    let (q1, q2, w1, w2) = (0.5_f64, -0.9_f64, 1.1, -2.3);
    let states = oracle.place(&[(a, scalar(q1, w1)), (b, scalar(q2 - q1, w2 - w1))]);
    let solution = oracle.accelerations(0.0, &states);
    let d = q1 - q2;
    let coupling = m2 * l1 * l2;
    let mass = Matrix2::new((m1 + m2) * l1 * l1, coupling * d.cos(), coupling * d.cos(), m2 * l2 * l2);
    let rhs = Vector2::new(
        -coupling * d.sin() * w2 * w2 - (m1 + m2) * G * l1 * q1.sin(),
        coupling * d.sin() * w1 * w1 - m2 * G * l2 * q2.sin(),
    );
    let expected = mass.lu().solve(&rhs).expect("a positive mass matrix");
    // The bodies' own inertia of 1e-12 kg m² shifts the result by about 1e-11.
    assert!((solution.alpha[0].z - expected[0]).abs() < 1e-9);
    assert!((solution.alpha[1].z - expected[1]).abs() < 1e-9);
}

#[test]
fn slider_crank_follows_its_closed_form() {
    let bars = SliderCrank { crank: 0.1, rod: 0.35, offset: 0.03 };
    let mut s = Sketch::new(UP);
    let crank = s.body(0.5, [0.05, 0.0, 0.0], [1e-4, 4e-4, 4e-4]);
    let reach = (0.35_f64.powi(2) - 0.03_f64.powi(2)).sqrt();
    let pin = [0.1 + reach, 0.03, 0.0];
    let rod = s.body(0.9, [0.1 + 0.5 * reach, 0.015, 0.0], [1e-4, 9e-3, 9e-3]);
    let slider = s.body(1.1, pin, [1e-3; 3]);
    let a = s.joint(JointModel::new("revolute", &[axis(Z)]), Carrier::Ground, crank, [0.0; 3]);
    s.joint(JointModel::new("revolute", &[axis(Z)]), crank, rod, [0.1, 0.0, 0.0]);
    s.joint(JointModel::new("revolute", &[axis(Z)]), rod, slider, pin);
    let d = s.joint(JointModel::new("prismatic", &[axis([1.0, 0.0, 0.0])]), Carrier::Ground, slider, pin);
    s.drive(a, 0, law(0.2, 3.0, 0.4));
    let oracle = oracle(&s);
    let t = 0.9_f64;
    let crank = Motion {
        position: 0.2 + 3.0 * t + 0.4 * t.sin(),
        speed: 3.0 + 0.4 * t.cos(),
        acceleration: -0.4 * t.sin(),
    };
    let exact = bars.motion(crank);
    // Walk there, so that Newton keeps the branch.
    let mut states = oracle.guess();
    for k in 0..=30 {
        states = oracle.assemble(0.03 * f64::from(k), &states, &[]).expect("a crank that turns");
    }
    let solution = oracle.accelerations(t, &states);
    let slide = oracle.joint_motion(d, &states);
    // Positions are closed to 1e-13; accelerations are of order 1.
    assert!((slide.position[0] + pin[0] - exact.slider.position).abs() < 1e-12);
    assert!((slide.speed[0] - exact.slider.speed).abs() < 1e-12);
    assert!((solution.acceleration[2].x - exact.slider.acceleration).abs() < 1e-11);
    assert!((solution.alpha[1].z - exact.rod.acceleration).abs() < 1e-11);
    // 3 revolutes and a slider: 20 rows and the drive's on 18 coordinates; 3 are redundant.
    assert_eq!((solution.rows, solution.rank), (21, 18));
    assert!(solution.largest_dropped < 1e-12 && solution.smallest_kept > 1e-3);
    // Forces in the plane are unique, those across are shared out by choice.
    let unique = solution.wrenches[1].unique;
    assert_eq!(unique, [true, true, false, false, false, true]);
}

#[test]
fn four_bar_follows_freudenstein() {
    let bars = FourBar { ground: 0.4, crank: 0.1, coupler: 0.35, rocker: 0.3 };
    let at = |position: f64| bars.motion(Motion { position, speed: 0.0, acceleration: 0.0 }, true);
    let start = at(0.3);
    let tip = |origin: f64, angle: f64, r: f64| [origin + r * angle.cos(), r * angle.sin(), 0.0];
    let (a, b) = (tip(0.0, 0.3, 0.1), tip(0.4, start.rocker.position, 0.3));
    let middle = |p: [f64; 3], q: [f64; 3]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.0];
    let mut s = Sketch::new(UP);
    let crank = s.body(0.2, middle([0.0; 3], a), [1e-4; 3]);
    let coupler = s.body(0.5, middle(a, b), [1e-3; 3]);
    let rocker = s.body(0.4, middle(b, [0.4, 0.0, 0.0]), [1e-3; 3]);
    let turn = || JointModel::new("revolute", &[axis(Z)]);
    let o = s.joint(turn(), Carrier::Ground, crank, [0.0; 3]);
    s.joint(turn(), crank, coupler, a);
    s.joint(turn(), coupler, rocker, b);
    let c = s.joint(turn(), Carrier::Ground, rocker, [0.4, 0.0, 0.0]);
    s.drive(o, 0, law(0.0, 5.0, 1.0));
    let oracle = oracle(&s);
    let mut states = oracle.guess();
    for k in 0..=20 {
        states = oracle.assemble(0.02 * f64::from(k), &states, &[]).expect("a crank that turns");
    }
    let t = 0.4_f64;
    let crank = Motion { position: 0.3 + 5.0 * t + t.sin(), speed: 5.0 + t.cos(), acceleration: -t.sin() };
    let exact = bars.motion(crank, true);
    let solution = oracle.accelerations(t, &states);
    let rocker = oracle.joint_motion(c, &states);
    // Closed to 1e-13; accelerations of order 10.
    let turned = exact.rocker.position - start.rocker.position;
    assert!((rocker.position[0] - turned).abs() < 1e-12, "{} {turned}", rocker.position[0]);
    assert!((rocker.speed[0] - exact.rocker.speed).abs() < 1e-11);
    assert!((solution.alpha[2].z - exact.rocker.acceleration).abs() < 1e-10);
    assert!((solution.alpha[1].z - exact.coupler.acceleration).abs() < 1e-10);
}

#[test]
fn two_cell_four_bar_swings_along_its_regular_branch() {
    // Unit bars of 1 kg, upright, joined in a row by horizontal bars; benchmark A02 of IFToMM.
    let mut s = Sketch::new(UP);
    let bar = 1.0 / 12.0;
    let upright: Vec<_> = (0..3).map(|k| s.body(1.0, [f64::from(k), 0.5, 0.0], [bar, 1e-3, bar])).collect();
    let across: Vec<_> =
        (0..2).map(|k| s.body(1.0, [f64::from(k) + 0.5, 1.0, 0.0], [1e-3, bar, bar])).collect();
    let turn = || JointModel::new("revolute", &[axis(Z)]);
    let feet: Vec<_> = (0_u8..3)
        .map(|k| s.joint(turn(), Carrier::Ground, upright[usize::from(k)], [f64::from(k), 0.0, 0.0]))
        .collect();
    for (k, bar) in across.iter().enumerate() {
        s.joint(turn(), upright[k], *bar, [k as f64, 1.0, 0.0]);
        s.joint(turn(), *bar, upright[k + 1], [k as f64 + 1.0, 1.0, 0.0]);
    }
    let oracle = oracle(&s);
    let wish =
        linkwear_oracle::Wish { joint: feet[0], coordinate: 0, position: Some(0.0), speed: Some(-1.0) };
    let start = oracle.assemble(0.0, &oracle.guess(), &[wish]).expect("upright bars close");
    let exact = NFourBar::benchmark(2);
    let path = oracle.trajectory(&[0.0, 0.3, 0.6], &start, Tolerance(1e-12)).expect("a smooth motion");
    for (t, states) in [0.0, 0.3, 0.6].iter().zip(&path) {
        let tip = states[0].centre + states[0].rotation * Vector3::new(0.0, 0.5, 0.0);
        let [x, y, ..] = exact.tip(*t);
        // 1e-12 per step, ten steps.
        assert!((tip - Vector3::new(x, y, 0.0)).norm() < 1e-10, "t = {t}: {tip} {x} {y}");
    }
}
