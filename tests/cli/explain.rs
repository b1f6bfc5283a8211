//! `explain`: what every code of the command line means, by command lines that give it and some that do not. The codes of
//! mechanism files are tried where they are explained.

use std::os::unix::fs::symlink;

use crate::command::{Answer, Folder, linkwear};

/// A folder that looks like the project's to a command line.
fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    for shared in ["mechanisms", "examples"] {
        let there = std::env::current_dir().expect("the package").join(shared);
        symlink(there, folder.path(shared)).expect("a link");
    }
    folder
}

/// Runs commands one after the other, each of which but the last must succeed.
fn run(folder: &Folder, commands: &str) -> Answer {
    let mut lines = commands.split(" && ").peekable();
    while let Some(line) = lines.next() {
        let mut words: Vec<&str> = line.split(' ').skip(1).collect();
        if lines.peek().is_none() {
            words.extend(["--format", "json"]);
            return folder.linkwear(&words);
        }
        let answer = folder.linkwear(&words);
        assert_eq!(answer.code, 0, "{line}: {}", answer.err);
    }
    unreachable!("no command")
}

#[test]
fn every_code_of_the_command_line_comes_from_its_wrong_example_and_not_from_the_right_one() {
    for number in 1..=17 {
        let code = format!("C{number:04}");
        let told = linkwear(&["explain", &code, "--format", "json"]).json();
        // 9 needs Ctrl-C, and 12 is of the program of the case study.
        if ["C0009", "C0012"].contains(&code.as_str()) {
            continue;
        }
        let [wrong, right] = ["wrong", "right"].map(|key| told[key].as_str().expect("commands").to_owned());
        let errors = run(&folder(&format!("explain-wrong-{code}")), &wrong).errors();
        assert!(errors.iter().any(|error| error["code"] == code.as_str()), "{wrong}: {errors:?}");
        let answer = run(&folder(&format!("explain-right-{code}")), &right);
        assert_eq!(answer.code, 0, "{right}: {}{}", answer.out, answer.err);
    }
}

#[test]
fn remarks_on_runs_and_lives_come_from_their_examples() {
    for code in ["run", "life"] {
        let told = linkwear(&["explain", code, "--format", "json"]).json();
        for (key, is_said) in [("wrong", true), ("right", false)] {
            let commands = told[key].as_str().expect("commands");
            let answer = run(&folder(&format!("explain-{code}-{key}")), commands).json();
            let warnings = answer["warnings"].as_array().expect("a list");
            assert_eq!(
                warnings.iter().any(|warning| warning["code"] == code),
                is_said,
                "{commands}: {warnings:?}"
            );
        }
    }
}

#[test]
fn an_error_says_once_where_to_read_more_and_an_unknown_code_is_a_usage_error() {
    let folder = Folder::new("explain");
    let json = linkwear(&["explain", "E0106", "--format", "json"]).json();
    let file = folder.write("bad.toml", json["wrong_file"].as_str().expect("a file"));
    let answer = linkwear(&["check", &file]);
    assert!(answer.err.trim_end().ends_with("linkwear explain E0106"), "{}", answer.err);
    assert_eq!(answer.err.matches("linkwear explain").count(), 1);
    assert!(!linkwear(&["check", &file, "--format", "json"]).out.contains("linkwear explain"));
    let told = linkwear(&["explain", "error[E0106]"]);
    assert!(told.code == 0 && told.out.contains("Wrong:") && told.out.contains("Right:"), "{}", told.out);
    let cured = folder.write("good.toml", json["right_file"].as_str().expect("a file"));
    assert_eq!(linkwear(&["check", &cured]).code, 0);
    let unknown = linkwear(&["explain", "E0610"]);
    assert!(unknown.code == 2 && unknown.err.contains("there is no code `E0610`"), "{}", unknown.err);
    let near = linkwear(&["explain", "EO204"]);
    assert!(near.code == 2 && near.err.contains("did you mean `E0204`?"), "{}", near.err);
}

#[test]
fn examples_stand_with_the_files_that_they_name() {
    let folder = Folder::new("explain-beside");
    for code in ["E0414", "W0125"] {
        let json = linkwear(&["explain", code, "--format", "json"]).json();
        for file in json["beside"].as_array().expect("files") {
            let [name, text] = ["name", "text"].map(|key| file[key].as_str().expect("a text"));
            folder.write(name, text);
            assert!(linkwear(&["explain", code]).out.contains(&format!("{name}:")), "{code}");
        }
        for (key, is_said) in [("wrong_file", true), ("right_file", false)] {
            let file = folder.write("example.toml", json[key].as_str().expect("a file"));
            let answer = linkwear(&["check", &file]);
            assert_eq!(answer.err.contains(&format!("[{code}]")), is_said, "{key} of {code}: {}", answer.err);
        }
    }
}
