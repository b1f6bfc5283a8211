//! Every cited equation of the paper has a row in docs/equations.md, and every row a citation, a function and a test.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// One row: equations, and the file and name of the function and of the test.
struct Row {
    equations: BTreeSet<u32>,
    function: (String, String),
    test: (String, String),
}

fn rows() -> Vec<Row> {
    let text = fs::read_to_string("docs/equations.md").expect("docs/equations.md");
    let rows = text.lines().filter(|line| line.starts_with("| [CS"));
    rows.map(|line| {
        let cells: Vec<&str> = line.split('|').collect();
        Row { equations: citations(cells[1]), function: place(cells[3], line), test: place(cells[4], line) }
    })
    .collect()
}

/// "`path` `name`".
fn place(cell: &str, line: &str) -> (String, String) {
    let parts: Vec<&str> = cell.split('`').skip(1).step_by(2).collect();
    let [path, name] = parts[..] else { panic!("`file` `name` expected in a cell of\n{line}") };
    (path.to_owned(), name.to_owned())
}

/// Equation numbers in every `[CS ..]` of a text: `(1)`, `(1),(2)`, `(1)(2)`, `(4)-(6)`.
fn citations(text: &str) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for part in text.split("[CS (").skip(1) {
        let inside = part.split(']').next().unwrap_or_default();
        let mut last = None;
        for piece in inside.split('(') {
            let (number, after) = piece.split_once(')').unwrap_or((piece, ""));
            let Ok(number) = number.trim().parse::<u32>() else { continue };
            let from = last.take().map_or(number, |first: u32| first + 1);
            found.extend(from..=number);
            if after.trim() == "-" {
                last = Some(number);
            }
        }
    }
    found
}

fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

fn defines(file: &str, name: &str) -> bool {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
    ["(", "<"].iter().any(|end| text.contains(&format!("fn {name}{end}")))
}

#[test]
fn every_row_names_a_function_and_a_test_that_exist() {
    for row in rows() {
        let (file, name) = &row.function;
        assert!(defines(file, name), "{file} has no function {name}");
        let (file, name) = &row.test;
        assert!(defines(file, name), "{file} has no test {name}");
        let text = fs::read_to_string(file).expect("a file");
        let before = text.split(&format!("fn {name}(")).next().unwrap_or_default();
        let attributes = before.rsplit("\n\n").next().unwrap_or_default();
        let is_test = attributes.contains("#[test]") || before.rsplit("proptest!").next() != Some(before);
        assert!(is_test, "{name} in {file} is not a test");
    }
}

#[test]
fn citations_in_the_source_and_rows_are_the_same_equations() {
    let mut files = Vec::new();
    for folder in ["codegen/src", "reader/src", "gamma/src", "runtime/src"] {
        sources(Path::new(folder), &mut files);
    }
    let texts = files.iter().map(|file| fs::read_to_string(file).expect("a source file"));
    let cited: BTreeSet<u32> = texts.flat_map(|text| citations(&text)).collect();
    let listed: BTreeSet<u32> = rows().into_iter().flat_map(|row| row.equations).collect();
    assert_eq!(cited, listed, "cited in the source (left), rows in docs/equations.md (right)");
}

#[test]
fn citations_are_read_singly_in_lists_and_in_ranges() {
    let numbers = |text: &str| citations(text).into_iter().collect::<Vec<_>>();
    assert_eq!(numbers("see [CS (3)], and [CS (1)(2)]"), [1, 2, 3]);
    assert_eq!(numbers("[CS (9)-(12),(16)]"), [9, 10, 11, 12, 16]);
    assert!(numbers("[CS]").is_empty());
}
