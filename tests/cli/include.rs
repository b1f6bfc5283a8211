//! Mechanisms of parts by the command line: columns, `--set`, faults, C, FMI.

use crate::command::{Folder, linkwear};

const WALKER: &str = "examples/data/walker.toml";

/// Columns of a run, and its rows.
fn run(folder: &Folder, file: &str, options: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
    let table = folder.path("run.csv");
    let answer = linkwear(
        &[&["simulate", file, "--time", "0.3", "--samples", "4", "--out", &table], options].concat(),
    );
    assert_eq!(answer.code, 0, "{}", answer.err);
    let text = std::fs::read_to_string(&table).expect("written");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let head = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let rows = lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect());
    (head, rows.collect())
}

#[test]
fn columns_and_parameters_have_the_name_of_their_part() {
    let folder = Folder::new("include-columns");
    let (head, rows) = run(&folder, WALKER, &[]);
    let at = |name: &str| {
        head.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name}: {head:?}"))
    };
    let (left, right, slide) = (at("left.R1.Fx [N]"), at("right.R1.Fx [N]"), at("slide.q [m]"));
    for row in &rows {
        // The right leg is the left one turned about the vertical: along x its forces cancel those of the left one.
        let scale = row[left].abs().max(1.0);
        assert!((row[left] + row[right]).abs() < 1e-9 * scale, "{row:?}");
        // Accuracy of the run, beside millimetres that one leg alone moves the frame.
        assert!(row[slide].abs() < 1e-9, "{row:?}");
    }
    let (_, rows) = run(&folder, WALKER, &["--set", "left.phase=90 deg", "--set", "right.r=45 mm"]);
    assert!(rows.iter().any(|row| row[slide].abs() > 1e-6), "{rows:?}");
    let answer = linkwear(&["check", WALKER, "--set", "left.phse=90 deg"]);
    assert!(answer.code == 1 && answer.err.contains("did you mean `left.phase`"), "{}", answer.err);
}

#[test]
fn a_fault_in_a_part_is_told_with_its_file_and_line() {
    let folder = Folder::new("include-fault");
    let host = std::fs::read_to_string(WALKER).expect("shipped");
    let leg = std::fs::read_to_string("examples/data/leg.toml").expect("shipped");
    let host = folder.write("walker.toml", &host);
    folder.write("leg.toml", &leg.replace("radius = \"6 mm\"", "radius = \"6 N\""));
    let answer = linkwear(&["check", &host]);
    assert!(answer.code == 1 && answer.err.contains("leg.toml:22"), "{}", answer.err);
    let told = linkwear(&["check", &host, "--format", "json"]).out;
    assert!(told.contains("leg.toml") && told.contains("E0303"), "{told}");
}

#[test]
fn parts_reach_c_and_fmi_with_legal_names() {
    let folder = Folder::new("include-generate");
    let source = folder.path("walker.c");
    let answer = linkwear(&["generate", WALKER, "--target", "c", "--out", &folder.path("walker")]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let text = std::fs::read_to_string(&source).expect("written");
    assert!(text.contains("left_r") && text.contains("\"left.R1.Fx\""), "no names of parts");
    let unit = folder.path("walker.fmu");
    let answer = linkwear(&["fmu", WALKER, "--out", &unit]);
    assert_eq!(answer.code, 0, "{}", answer.err);
}
