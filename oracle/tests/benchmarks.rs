//! The shipped benchmark mechanisms, read from their files, against published numbers (tests/reference).

use linkwear_codegen::id::{JointId, PointId};
use linkwear_codegen::model::{Overrides, resolve};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec::parse;
use linkwear_oracle::{BodyState, Oracle, Tolerance};
use nalgebra::Vector3;

fn read(name: &str, text: String) -> Oracle {
    let source = SourceFile { name: name.to_owned(), text };
    let spec = parse(&source).unwrap_or_else(|errors| panic!("{name}: {errors:#?}"));
    let (mechanism, _) =
        resolve(&spec, &Overrides::default()).unwrap_or_else(|errors| panic!("{name}: {errors:#?}"));
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
        println!("{name} {:.2e} {:.2e}", position - q, (motion.speed[0] - v) / v);
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
    println!("{place}");
    // Eight digits printed, extrapolated from a method of second order.
    assert!((place - Vector3::new(row[1], row[2], row[3])).norm() < 5e-8, "{place}");
}

#[test]
fn two_cells_pass_their_singular_position() {
    let oracle = shipped("n_four_bar_2");
    let start = oracle.start().expect("a closed start");
    let row = &reference("n_four_bar")[0];
    let end = oracle.integrate(0.0, 1.0, &start, Tolerance(1e-11)).expect("a regular motion");
    let (place, velocity) = oracle.point(point(&oracle, "B0"), &end);
    println!("{place} {velocity} {row:?}");
    // Passing the position where all bars lie flat costs some digits.
    assert!((place - Vector3::new(row[2], row[3], 0.0)).norm() < 1e-6);
}

#[test]
fn flyball_climbs() {
    let oracle = shipped("flyball");
    let start = oracle.start().expect("a closed start");
    println!("{:?}", oracle.bodies); println!("{:?}", oracle.mechanism.forces); let sol = oracle.accelerations(0.0, &start); println!("{:?} {:?}", sol.alpha, sol.acceleration);
    for tol in [1e-8] {
        for t in [0.001, 0.01, 0.1] {
            let end = oracle.integrate(0.0, t, &start, Tolerance(tol)).expect("a regular motion");
            println!("{tol} {t} {} {}", oracle.point(point(&oracle, "S"), &end).0.z, oracle.kinetic_energy(&end));
        }
    }
}

#[test]
fn every_shipped_mechanism_assembles_and_accelerates() {
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../mechanisms")).expect("a folder") {
        let path = entry.expect("a file").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let oracle = shipped(&name);
        if oracle.bodies.len() > 50 {
            continue;
        }
        let start = oracle.start().unwrap_or_else(|error| panic!("{name}: {error}"));
        let s = oracle.accelerations(0.0, &start);
        println!(
            "{name}: bodies {} rows {} rank {} kept {:.2e} dropped {:.2e} mobility {}",
            oracle.bodies.len(),
            s.rows,
            s.rank,
            s.smallest_kept,
            s.largest_dropped,
            6 * oracle.bodies.len() as i64 - s.rank as i64
        );
    }
}
