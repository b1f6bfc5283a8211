//! The README says what is true: its embedding section is the example crate, its commands and links exist.

use std::fs;
use std::path::Path;

fn readme() -> String {
    fs::read_to_string("README.md").expect("README.md")
}

/// A section of the README shows these files of an example crate, word for word, and no others.
fn assert_shown(section: &str, example: &str, files: &[(&str, &str)]) {
    let readme = readme();
    let heading = format!("\n## {section}\n");
    let text = readme.split(&heading).nth(1).expect("the section");
    let text = text.split("\n## ").next().expect("a section");
    let mut shown = Vec::new();
    for (name, language) in files {
        let file = fs::read_to_string(format!("examples/{example}/{name}")).expect("a file of the example");
        let fence = format!("\n`{name}`\n\n```{language}\n{file}```\n");
        assert!(text.contains(&fence), "README.md must have, under {section}:{fence}");
        shown.push(fence);
    }
    assert_eq!(text.matches("\n```\n").count(), shown.len(), "a fence that is no file of the example");
}

#[test]
fn example_crates_stand_in_the_readme_word_for_word() {
    let (cargo, main) = (("Cargo.toml", "toml"), ("src/main.rs", "rust"));
    let build = [cargo, ("build.rs", "rust"), ("mechanisms/swing.toml", "toml"), main];
    assert_shown("Embedding", "downstream", &build);
    assert_shown("A life from Rust", "life", &[cargo, main]);
}

/// `-2.36 ± 0.66 %` without its scatter, and `5.68 ± 0.18` without it.
fn rounded(cell: &str) -> String {
    cell.split(" ± ").next().unwrap_or(cell).trim_end_matches(" %").to_owned()
}

#[test]
fn the_table_of_baselines_is_that_of_the_case_study() {
    let study = fs::read_to_string("docs/case-study/case-study.md").expect("the case study");
    let readme = readme();
    let rows: Vec<Vec<&str>> = readme
        .lines()
        .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect())
        .filter(|cells: &Vec<&str>| cells.len() == 4 && cells[0].ends_with("cycles"))
        .collect();
    assert!(rows.len() >= 5, "{rows:?}");
    for cells in rows {
        let what: Vec<&str> = cells[0].split(", ").collect();
        let wear = what[0].replace("depth by the Hertz area", "depth");
        let title = format!("W is the {wear}, gamma = {};", what[1]);
        let table = study.split(&title).nth(1).expect("a table of the case study");
        let table = table.split("\n\n").nth(1).expect("its rows");
        let fitted = format!("| {} | ", what[2]);
        let models = table.lines().filter(|line| line.starts_with(&fitted)).map(|line| {
            let found: Vec<&str> = line.split(" | ").collect();
            format!("{} % ({} %)", rounded(found[5]), rounded(found[4]))
        });
        assert_eq!(models.collect::<Vec<_>>(), cells[1..], "{}", cells[0]);
    }
}

/// Who writes a row compares it too; a row that nobody writes any more would stay for ever.
#[test]
fn every_row_of_the_page_of_truth_is_of_a_test() {
    let page = fs::read_to_string("docs/truth.md").expect("the page");
    let rows = page.lines().skip_while(|line| !line.starts_with("|---")).skip(1);
    let mut count = 0;
    for row in rows {
        let cells: Vec<&str> =
            row.trim_matches('|').split(" | ").map(|cell| cell.trim().trim_matches('`')).collect();
        let [_, figure, error, bound, file, test] = cells[..] else { panic!("{row}") };
        let source = fs::read_to_string(file).expect("a file of tests");
        assert!(source.contains(&format!("fn {test}()")), "{file} has no test {test}");
        // `R1.Fn, rms over rms` may be put together, its words after the name are written.
        let words = figure.rsplit(", ").next().expect("one at least");
        assert!(source.contains(words) || words.contains(" at "), "{file} says nothing of {words}");
        let [error, bound] = [error, bound].map(|cell| cell.parse::<f64>().expect("a number"));
        assert!(error <= bound, "{row}");
        count += 1;
    }
    assert!(count >= 30, "{count} rows");
}

#[test]
fn there_is_one_command_to_run_and_one_to_test() {
    let readme = readme();
    for start in ["cargo run ", "cargo test "] {
        let lines: Vec<&str> = readme.lines().filter(|line| line.starts_with(start)).collect();
        assert_eq!(lines.len(), 1, "{lines:?}");
        let files = lines[0].split(' ').filter(|word| word.starts_with("mechanisms/"));
        assert!(files.into_iter().all(|file| Path::new(file).is_file()), "{}", lines[0]);
    }
}

/// Where a link to a heading leads.
fn anchor_of(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
    let words = heading.trim_start_matches('#').trim().to_lowercase();
    words.chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn links_between_documents_lead_somewhere() {
    let documents = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "tests/README.md"];
    for document in documents {
        let text = fs::read_to_string(document).expect("a document");
        let folder = Path::new(document).parent().expect("a folder");
        for part in text.split("](").skip(1) {
            let target = part.split(')').next().expect("a target");
            if target.starts_with("http") {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = match file {
                "" => Path::new(document).to_path_buf(),
                file if file.starts_with("tests/") => Path::new("").join(file),
                file => folder.join(file),
            };
            assert!(path.exists(), "{document} links to {target}");
            if !anchor.is_empty() {
                let text = fs::read_to_string(path).expect("a document");
                let mut headings = text.lines().filter(|line| line.starts_with('#')).map(anchor_of);
                assert!(headings.any(|heading| heading == anchor), "{document} links to {target}");
            }
        }
    }
}
