//! `import`: a robot by the command line, and its inverse dynamics by another program.

mod mjcf;
mod parts;

use std::collections::BTreeMap;

use crate::command::{Folder, linkwear};

const ARM: &str = "examples/data/arm.urdf";

/// Coordinates, speeds, accelerations of the joints.
const MOTION: [(&str, [f64; 3], &str); 7] = [
    ("shoulder_pan", [0.3, 0.5, 1.5], "rad"),
    ("shoulder_lift", [-0.7, -1.2, -2.0], "rad"),
    ("elbow", [1.1, 0.8, 3.0], "rad"),
    ("wrist_1_2", [0.4, 2.0, -4.0], "rad"),
    ("wrist_2_2", [-0.9, -1.5, 2.5], "rad"),
    ("wrist_3_2", [0.6, 3.0, 6.0], "rad"),
    ("grip", [0.012, 0.07, -0.3], "m"),
];

/// By Pinocchio 4.1.0 (PyPI `pin`): `rnea` of the same file at this motion, and the file's damping times the speeds, which its `rnea`
/// leaves out. J. Carpentier et al., The Pinocchio C++ library, IEEE/SICE SII 2019.
const PINOCCHIO: [f64; 7] = [
    1.839_744_632_257_219_5,
    -12.901_137_227_697_72,
    -5.525_081_601_709_771,
    2.011_260_804_753_678,
    -0.326_409_981_803_355_4,
    0.078_044_504_967_260_56,
    0.317_026_477_913_726_4,
];

#[test]
fn the_drives_of_the_shipped_arm_are_those_of_pinocchio() {
    let folder = Folder::new("import-arm");
    let (text, told) = imported(&folder, ARM);
    assert_eq!((&told["bodies"], &told["joints"]), (&7.into(), &7.into()), "{told}");
    let drives = MOTION.map(|(name, [q, v, a], unit)| {
        let half = 0.5 * a;
        (name, format!("{q:?} {unit} + ({v:?} {unit}/s)*t + ({half:?} {unit}/s^2)*t^2"))
    });
    let rows = driven(&folder, &text, &drives, &["--time", "0.001"]);
    for ((name, ..), expected) in MOTION.into_iter().zip(PINOCCHIO) {
        let found = rows[0][&format!("{name}.drive")];
        // Rounding of a chain of seven joints, beside torques of 10 N m.
        assert!((found - expected).abs() < 1e-10, "{name}: {found} {expected}");
    }
}

const PANDA: &str = "tests/data/panda/panda.urdf";
/// By `rnea.py` in the same folder.
const PANDA_RNEA: &str = include_str!("../data/panda/rnea.csv");
/// Mean, amplitude and rate [rad/s] of its joints: the motion of `rnea.py`. The second finger follows by the file's mimic.
const PANDA_MOTION: [(&str, [f64; 3], &str); 8] = [
    ("panda_joint1", [0.3, 0.9, 2.1], "rad"),
    ("panda_joint2", [-0.4, 0.7, 1.7], "rad"),
    ("panda_joint3", [0.2, -0.8, 2.9], "rad"),
    ("panda_joint4", [-1.5, 0.9, 2.3], "rad"),
    ("panda_joint5", [0.6, 1.1, 3.7], "rad"),
    ("panda_joint6", [1.8, -1.2, 3.1], "rad"),
    ("panda_joint7", [-0.5, 1.3, 4.3], "rad"),
    ("panda_finger_joint1", [0.02, 0.015, 5.0], "m"),
];
/// Rounding of a chain of nine bodies, beside torques of 40 N m; 2e-14 was found.
const PANDA_ROUNDING: f64 = 1e-10;

/// The rows of Pinocchio's file: time, then a number for each joint.
fn pinocchio(what: &str) -> Vec<(f64, [f64; 8])> {
    let rows = PANDA_RNEA.lines().filter_map(|line| line.strip_prefix(what)?.strip_prefix(','));
    let numbers =
        rows.map(|row| row.split(',').map(|cell| cell.parse().expect("a number")).collect::<Vec<f64>>());
    numbers.map(|row| (row[0], row[1..].try_into().expect("8 joints"))).collect()
}

fn greatest_difference(row: &BTreeMap<String, f64>, expected: [f64; 8]) -> f64 {
    let differences = PANDA_MOTION
        .iter()
        .zip(expected)
        .map(|((name, ..), value)| (row[&format!("{name}.drive")] - value).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn the_drives_of_a_panda_are_those_of_pinocchio_along_its_motion() {
    let folder = Folder::new("import-panda");
    let (text, told) = imported(&folder, PANDA);
    assert_eq!((&told["bodies"], &told["joints"]), (&9.into(), &9.into()), "{told}");
    assert!(!told["left_out"].to_string().contains("mimic"), "{told}");
    let drives = PANDA_MOTION.map(|(name, [mean, swing, rate], unit)| {
        (name, format!("{mean:?} {unit} + ({swing:?} {unit})*sin(({rate:?} rad/s)*t)"))
    });
    let rows = driven(&folder, &text, &drives, &["--time", "1", "--samples", "11"]);
    let expected = pinocchio("moving");
    assert_eq!((rows.len(), expected.len()), (11, 11));
    for (row, (time, expected)) in rows.iter().zip(expected) {
        let difference = greatest_difference(row, expected);
        assert!((row["t"] - time).abs() < 1e-12 && difference < PANDA_ROUNDING, "{time} s: {difference:e}");
    }
}

#[test]
fn what_holds_a_panda_against_gravity_is_what_pinocchio_says() {
    let folder = Folder::new("import-panda-gravity");
    let (text, _) = imported(&folder, PANDA);
    for (time, expected) in pinocchio("gravity").into_iter().step_by(5) {
        let drives = PANDA_MOTION.map(|(name, [mean, swing, rate], unit)| {
            (name, format!("{:?} {unit}", mean + swing * libm::sin(rate * time)))
        });
        let rows = driven(&folder, &text, &drives, &["--time", "0.001", "--samples", "2"]);
        let difference = greatest_difference(&rows[0], expected);
        assert!(difference < PANDA_ROUNDING, "at the place of {time} s: {difference:e}");
    }
}

/// What `import` writes of a file and tells.
fn imported(folder: &Folder, robot: &str) -> (String, serde_json::Value) {
    let file = folder.path(&format!("{}.toml", robot.rsplit('/').next().expect("a name")));
    let told = linkwear(&["import", robot, "--out", &file, "--format", "json"]).json();
    (std::fs::read_to_string(&file).expect("written"), told)
}

/// Rows of a run with drives on joints, by column without its unit.
fn driven(
    folder: &Folder,
    text: &str,
    drives: &[(&str, String)],
    options: &[&str],
) -> Vec<BTreeMap<String, f64>> {
    let mut text = text.to_owned();
    for (name, drive) in drives {
        let joint = format!("\n{name} = {{ ");
        let at = text.find("[joints]").expect("joints");
        assert!(text[at..].contains(&joint), "{name}: {text}");
        text = text.replace(&joint, &format!("\n{name} = {{ drive = \"{drive}\", "));
    }
    let file = folder.write("driven.toml", &text);
    let table = folder.path("run.csv");
    let run = linkwear(&[&["simulate", &file, "--out", &table], options].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = std::fs::read_to_string(&table).expect("written");
    let mut lines = rows.lines().filter(|line| !line.starts_with('#'));
    let head = lines.next().expect("a header").split(',');
    let columns: Vec<&str> = head.map(|title| title.split(' ').next().expect("a name")).collect();
    let row = |line: &str| {
        let cells = columns.iter().zip(line.split(','));
        cells.map(|(name, cell)| ((*name).to_owned(), cell.parse().expect("a number"))).collect()
    };
    lines.map(row).collect()
}

#[test]
fn faults_have_their_line_and_files_that_are_there_stay() {
    let folder = Folder::new("import-wrong");
    let bad = folder.write("bad.urdf", "<robot name=\"r\">\n<link/>\n</robot>\n");
    let out = folder.path("bad.toml");
    let answer = linkwear(&["import", &bad, "--out", &out]);
    assert!(answer.code == 1 && answer.err.contains("bad.urdf:2"), "{}", answer.err);
    assert!(!std::path::Path::new(&out).exists());
    let kept = folder.write("kept.toml", "mine");
    let answer = linkwear(&["import", ARM, "--out", &kept]);
    assert!(answer.code != 0 && std::fs::read_to_string(&kept).expect("kept") == "mine", "{}", answer.err);
}
