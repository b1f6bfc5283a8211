//! The shipped benchmark mechanisms, read from their files, against published numbers (tests/reference).

use linkwear_codegen::id::{JointId, PointId};
use linkwear_codegen::input::Reach;
use linkwear_codegen::model::{Overrides, resolve};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec::parse;
use linkwear_oracle::{Oracle, Tolerance};
use nalgebra::Vector3;

fn read(name: &str, text: String) -> Oracle {
    let source = SourceFile { name: name.to_owned(), text };
    let spec = parse(&source).unwrap_or_else(|errors| panic!("{name}: {errors:#?}"));
    let (mechanism, _) = resolve(&spec, &Overrides::default(), Reach::Below)
        .unwrap_or_else(|errors| panic!("{name}: {errors:#?}"));
    Oracle::with_defaults(&mechanism).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn shipped(name: &str) -> Oracle {
    let path = format!("{}/../mechanisms/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    read(name, std::fs::read_to_string(path).expect("a shipped mechanism"))
}

fn joint(oracle: &Oracle, name: &str) -> JointId {
    let at = oracle.mechanism.joints.iter().position(|joint| joint.name == name);
    JointId::new(at.expect("a joint of the file"))
}

fn point(oracle: &Oracle, name: &str) -> PointId {
    let at = oracle.mechanism.points.iter().position(|point| point.name == name);
    PointId::new(at.expect("a point of the file"))
}

/// Rows of a file in tests/reference: comment, header, numbers; empty cells are not numbers.
fn reference(name: &str) -> Vec<Vec<f64>> {
    let path = format!("{}/../tests/reference/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a reference file of this repository");
    let number = |cell: &str| cell.parse::<f64>().unwrap_or(f64::NAN);
    text.lines().skip(2).map(|line| line.split(',').map(number).collect()).collect()
}

const ANGLES: [&str; 7] = ["beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"];

#[test]
fn andrews_starts_with_the_published_accelerations_and_multipliers() {
    let oracle = shipped("andrews");
    let start = oracle.start().expect("a closed start");
    let expected = &reference("andrews")[0][1..8];
    for (name, q) in ANGLES.iter().zip(expected) {
        let motion = oracle.joint_motion(joint(&oracle, name), &start);
        // Sixteen digits printed, closed to 1e-13 by assembly on lengths of centimetres.
        assert!((motion.position[0] - q).abs() < 1e-12, "{name}: {} {q}", motion.position[0]);
    }
    let solution = oracle.accelerations(0.0, &start);
    // IVP Test Set, "andrews", section 4: beta'', Theta'' and the first two multipliers at t = 0.
    let beta = solution.alpha[0].z;
    let theta = solution.alpha[1].z - beta;
    // Numbers of order 1e4: 1e-9 is 13 digits.
    assert!((beta - 14_222.443_919_954_113).abs() < 1e-8, "{beta}");
    assert!((theta + 10_666.832_939_965_585).abs() < 1e-8, "{theta}");
    let at_f = &solution.wrenches[joint(&oracle, "F3").index()];
    let force = Vector3::new(98.566_870_396_241_09, -6.122_688_344_255_663, 0.0);
    assert!((at_f.force - force).xy().norm() < 1e-9, "{}", at_f.force);
    assert_eq!(at_f.unique, [true, true, false, false, false, true]);
}

#[test]
fn andrews_reaches_the_published_end() {
    let oracle = shipped("andrews");
    let start = oracle.start().expect("a closed start");
    let end = oracle.integrate(0.0, 0.03, &start, Tolerance(1e-11)).expect("a smooth motion");
    let expected = &reference("andrews")[1];
    for (k, name) in ANGLES.iter().enumerate() {
        let motion = oracle.joint_motion(joint(&oracle, name), &end);
        let (q, v) = (expected[1 + k], expected[8 + k]);
        let turns = ((motion.position[0] - q) / std::f64::consts::TAU).round();
        let position = motion.position[0] - turns * std::f64::consts::TAU;
        // 1e-11 per step, some hundred steps; the fast crank's phase is worth 1e-7 in the slow speeds.
        assert!((position - q).abs() < 1e-8, "{name}: {position} {q}");
        assert!((motion.speed[0] - v).abs() < 1e-7 * v.abs(), "{name}: {} {v}", motion.speed[0]);
    }
}

#[test]
fn bricard_moves_its_tracked_point_as_exudyn_says() {
    let oracle = shipped("bricard");
    let start = oracle.start().expect("a closed start");
    let solution = oracle.accelerations(0.0, &start);
    // Five bodies, six revolutes: 30 rows, of which one follows from the others; one freedom.
    assert_eq!((solution.rows, solution.rank), (30, 29));
    let end = oracle.integrate(0.0, 1.0, &start, Tolerance(1e-11)).expect("a smooth motion");
    let row = &reference("bricard")[0];
    let (place, _) = oracle.point(point(&oracle, "P3"), &end);
    // Eight digits printed, extrapolated from a method of second order.
    assert!((place - Vector3::new(row[1], row[2], row[3])).norm() < 5e-8, "{place}");
}

#[test]
fn flyball_starts_to_climb() {
    let oracle = shipped("flyball");
    let start = oracle.start().expect("a closed start");
    // Explicit extrapolation is bound by the damper's time constant, so a tenth of a second only. The same
    // governor in two coordinates (arm and slider, angular momentum kept), Runge-Kutta with h = 1e-4 s and half
    // of it, reaches this height; and it reaches the published 0.501421 m after 1 s.
    let end = oracle.integrate(0.0, 0.1, &start, Tolerance(1e-9)).expect("a smooth motion");
    let (place, _) = oracle.point(point(&oracle, "S"), &end);
    assert!((place.z - 0.523_836_475_569).abs() < 1e-9, "{place}");
}

/// Positions and rank along a run of the crank, walked in small steps so that Newton keeps the branch.
fn turn(name: &str, seconds: f64, rank: usize) -> f64 {
    let oracle = shipped(name);
    let mut states = oracle.start().expect("a closed start");
    let mut smallest = f64::INFINITY;
    for k in 1..=400 {
        let t = seconds * f64::from(k) / 400.0;
        states = oracle.assemble(t, &states, &[]).unwrap_or_else(|error| panic!("{name} at {t} s: {error}"));
        let solution = oracle.accelerations(t, &states);
        assert_eq!(solution.rank, rank, "{name} at {t} s");
        smallest = smallest.min(solution.smallest_kept);
    }
    let back = oracle.start().expect("a closed start");
    // A whole turn of the crank ends where it began (assembly closes to 1e-13).
    for (a, b) in states.iter().zip(&back) {
        assert!((a.centre - b.centre).norm() < 1e-10, "{name}: {} {}", a.centre, b.centre);
    }
    smallest
}

#[test]
fn driven_linkages_turn_right_round_with_constant_rank() {
    // 6 per body: the drive takes the one freedom. Far from singular all the way.
    for (name, seconds, rank) in
        [("bennett", 2.0, 18), ("six_bar", 1.0, 30), ("spatial_slider_crank", 0.5, 18), ("four_bar", 1.0, 18)]
    {
        let smallest = turn(name, seconds, rank);
        assert!(smallest > 1e-3, "{name}: {smallest:.1e}");
    }
}

#[test]
fn forty_cells_close_with_one_freedom() {
    let oracle = shipped("n_four_bar_40");
    let start = oracle.start().expect("upright bars close");
    assert_eq!((oracle.bodies.len(), oracle.mechanism.joints.len()), (81, 121));
    let (place, velocity) = oracle.point(point(&oracle, "B0"), &start);
    // Closed to 1e-13 at the start, where all is exact.
    assert!((place - Vector3::y()).norm() < 1e-12 && (velocity - Vector3::x()).norm() < 1e-12);
    assert!(oracle.velocity_residual(0.0, &start) < 1e-11);
}
