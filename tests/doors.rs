//! A wrong file is told in the same words through every door: subcommands, targets, units, build scripts, the library. Code, line and
//! cure are those of the file, whoever asks.

mod command;

use command::{Folder, linkwear};
use linkwear::cli::ask;
use linkwear::mechanism::Mechanism;
use linkwear_codegen::{Builder, SourceFile};

const RIGHT: &str = r#"spec = 1
name = "wrong"

[bodies]
bar = { rod = ["O", "E"], radius = "10 mm", density = "7850 kg/m^3" }

[points]
O = ["0 m", "0 m", "0 m"]
E = ["1 m", "0 m", "0 m"]

[joints]
R1 = { revolute = ["ground", "bar"], at = "O", axis = [0, 1, 0] }
"#;

/// What is wrong in it, and where: a unit where a length stands, a body that no joint has, a misspelt key.
const WRONG: [[&str; 3]; 3] = [
    ["10 mm", "10 kg", "wrong.toml:5:"],
    [r#"["ground", "bar"]"#, r#"["ground", "barr"]"#, "wrong.toml:12:"],
    ["density", "densty", "wrong.toml:5:"],
];

/// Lines that are about the mistake: not empty, without what frames them.
fn told(text: &str) -> String {
    // The command line adds where to read more.
    let own = |line: &&str| !line.is_empty() && !line.starts_with("More about ");
    let lines = text.lines().map(str::trim_end).filter(own);
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn a_wrong_file_is_told_alike_through_every_door() {
    let folder = Folder::new("doors");
    let out = folder.path("out");
    for [from, to, place] in WRONG {
        let text = RIGHT.replace(from, to);
        let file = folder.write("wrong.toml", &text);
        let doors: [&[&str]; 9] = [
            &["check", &file],
            &["simulate", &file],
            &["life", &file],
            &["equations", &file],
            &["generate", &file],
            &["generate", &file, "--with-start"],
            &["generate", &file, "--target", "c", "-o", &out],
            &["generate", &file, "--target", "c-abi", "-o", &out],
            &["fmu", &file, "-o", &out],
        ];
        let first = linkwear(doors[0]);
        assert_eq!(first.code, 1, "{}", first.err);
        let expected = told(&first.err);
        // A code, the line, and what to do.
        assert!(expected.contains("error[E") && expected.contains(place), "{expected}");
        assert!(expected.contains("help: "), "{expected}");
        for door in doors {
            let answer = linkwear(door);
            assert_eq!(answer.code, 1, "{door:?}");
            assert_eq!(told(&answer.err), expected, "{door:?}");
            assert_eq!(answer.out, "", "{door:?}");
        }
        assert!(!std::path::Path::new(&out).exists(), "nothing is written");

        for builder in [Builder::new(), Builder::new().with_start()] {
            let error =
                builder.mechanism(&file).out_dir(folder.path("built")).try_write().expect_err("wrong");
            assert_eq!(told(&error.to_string()), expected);
        }
        let error = Mechanism::read(&file).expect_err("wrong");
        assert_eq!(told(&error.to_string()), expected);

        // And to machines; what asks within a program, as Python does, gets the same.
        let errors: Vec<_> =
            doors.iter().map(|door| linkwear(&[door, &["--format", "json"][..]].concat()).errors()).collect();
        for (door, found) in doors.iter().zip(&errors) {
            assert_eq!(found, &errors[0], "{door:?}");
        }
        let source = SourceFile { name: file.clone(), text };
        let failure = ask::check(&[], &source).expect_err("wrong");
        assert_eq!(failure.errors(), errors[0]);
    }
}
