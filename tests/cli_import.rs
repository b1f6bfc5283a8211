//! `import`: a robot by the command line, and its inverse dynamics by another program.

mod command;

use command::{Folder, linkwear};

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
    let file = folder.path("arm.toml");
    let told = linkwear(&["import", ARM, "--out", &file, "--format", "json"]).json();
    assert_eq!((&told["bodies"], &told["joints"]), (&7.into(), &7.into()), "{told}");
    let mut text = std::fs::read_to_string(&file).expect("written");
    for (name, [q, v, a], unit) in MOTION {
        let half = 0.5 * a;
        let drive = format!("{q:?} {unit} + ({v:?} {unit}/s)*t + ({half:?} {unit}/s^2)*t^2");
        let joint = format!("\n{name} = {{ ");
        assert!(text.contains(&joint), "{name}: {text}");
        text = text.replace(&joint, &format!("\n{name} = {{ drive = \"{drive}\", "));
    }
    let driven = folder.write("driven.toml", &text);
    let table = folder.path("run.csv");
    let run = linkwear(&["simulate", &driven, "--time", "0.001", "--out", &table]);
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = std::fs::read_to_string(&table).expect("written");
    let mut lines = rows.lines().filter(|line| !line.starts_with('#'));
    let (head, first) = (lines.next().expect("a header"), lines.next().expect("a row"));
    for ((name, ..), expected) in MOTION.into_iter().zip(PINOCCHIO) {
        let column = format!("{name}.drive ");
        let at = head.split(',').position(|title| title.starts_with(&column)).expect("a column");
        let found: f64 = first.split(',').nth(at).expect("a cell").parse().expect("a number");
        // Rounding of a chain of seven joints, beside torques of 10 N m.
        assert!((found - expected).abs() < 1e-10, "{name}: {found} {expected}");
    }
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
