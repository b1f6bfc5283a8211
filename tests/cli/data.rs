//! Files that are read: those that a mechanism names lie below it, and no file is shown, waited for or taken whole.

use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;

use crate::command::{Answer, Folder, linkwear};

/// A folder with `inside/m.toml`, whose rod has its modes in `data`, and the modal data in and beside `inside`.
fn folder(test: &str, data: &str) -> (Folder, String) {
    let folder = Folder::new(test);
    fs::create_dir(folder.path("inside")).expect("a folder");
    let modes = fs::read_to_string("tests/data/slider_crank_rod.toml").expect("modal data");
    folder.write("outside.toml", &modes);
    folder.write("inside/rod.toml", &modes);
    let text = fs::read_to_string("tests/data/flexible_slider_crank.toml").expect("a mechanism");
    let file = folder.write("inside/m.toml", &text.replace("slider_crank_rod.toml", data));
    (folder, file)
}

fn refused(answer: &Answer, reason: &str) {
    assert_eq!(answer.code, 1, "{}{}", answer.out, answer.err);
    assert!(answer.err.contains("E0412") && answer.err.contains(reason), "{}", answer.err);
}

#[test]
fn data_lie_below_the_mechanism_unless_more_is_allowed() {
    let (here, file) = folder("below", "rod.toml");
    assert_eq!(linkwear(&["check", &file]).code, 0);
    // From the folder itself, where the file has no folder in its name.
    assert_eq!(Answer::of(run_in(&here.path("inside"), &["check", "m.toml"])).code, 0);
    let absolute = here.path("inside/rod.toml");
    here.write("inside/m.toml", &here.read("inside/m.toml").replace("rod.toml", &absolute));
    assert_eq!(linkwear(&["check", &file]).code, 0);
    for (test, data) in [("parent", "../outside.toml"), ("detour", "../inside/../outside.toml")] {
        let (_folder, file) = folder(test, data);
        refused(&linkwear(&["check", &file]), "outside the folder");
        assert_eq!(linkwear(&["check", &file, "--allow-outside-data"]).code, 0);
    }
    let (here, file) = folder("links", "link.toml");
    symlink("../outside.toml", here.path("inside/link.toml")).expect("a link");
    refused(&linkwear(&["check", &file]), "outside the folder");
    assert_eq!(linkwear(&["simulate", &file, "--time", "1e-3", "--allow-outside-data"]).code, 0);
    fs::remove_file(here.path("inside/link.toml")).expect("a link");
    symlink("rod.toml", here.path("inside/link.toml")).expect("a link");
    assert_eq!(linkwear(&["check", &file]).code, 0);
}

fn run_in(folder: &str, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwear"));
    command.args(arguments).current_dir(folder).output().expect("the program runs")
}

#[test]
fn data_that_are_no_regular_file_are_refused_without_waiting() {
    let (here, file) = folder("fifo", "pipe");
    assert!(Command::new("mkfifo").arg(here.path("inside/pipe")).status().expect("mkfifo").success());
    refused(&linkwear(&["check", &file]), "no regular file");
    for data in ["/dev/zero", "/dev/stdin", "."] {
        let (_folder, file) = folder("device", data);
        refused(&linkwear(&["check", &file, "--allow-outside-data"]), "no regular file");
    }
}

#[test]
fn what_is_read_is_not_shown() {
    let secret =
        "root:x:0:0:a very long line of a file that is not meant for the reader of the message:/root:/bin/sh";
    for text in [
        format!("{secret}\n"),
        format!("format = \"{secret}\"\n"),
        format!("mass = \"{secret}\"\n"),
        format!("\"{secret}\" = 1\n"),
        format!("\u{1b}]0;{secret}\u{7} = 1\n"),
    ] {
        let (here, file) = folder("secret", "other.toml");
        here.write("inside/other.toml", &text);
        for format in ["text", "json"] {
            let answer = linkwear(&["check", &file, "--format", format]);
            assert_eq!(answer.code, 1);
            let said = answer.out + &answer.err;
            assert!(!said.contains("not meant for the reader") && !said.contains('\u{1b}'), "{said}");
            assert!(said.contains("line 1"), "{said}");
        }
    }
}

#[test]
fn endless_and_huge_inputs_are_refused_before_they_are_taken_whole() {
    let folder = Folder::new("huge");
    let huge = folder.path("huge.csv");
    // Sparse: 40 MB of zeros take no room on the disk.
    fs::File::create(&huge).and_then(|file| file.set_len(40 << 20)).expect("a file");
    let fit = ["fit", "", "--unit", "unit", "--wear", "wear", "--exposure", "time"];
    for input in ["/dev/zero", &huge] {
        for command in [
            &["check", input][..],
            &["predict", input, "--threshold", "1"],
            &[&["fit", input], &fit[2..]].concat(),
        ] {
            let answer = linkwear(command);
            assert!(
                answer.code == 1 && answer.err.contains("it has more than"),
                "{command:?}: {}",
                answer.err
            );
        }
    }
    let long = format!("unit,wear,time\na,{},1\n", "x".repeat(1 << 20));
    let answer = linkwear(&[&["fit", &*folder.write("long.csv", &long)], &fit[2..]].concat());
    assert!(answer.code == 1 && answer.err.len() < 1000, "{} bytes", answer.err.len());
    let answer = linkwear(&["check", &folder.write("long.toml", &format!("spec = {}", "x".repeat(1 << 20)))]);
    assert!(answer.code == 1 && answer.err.len() < 5000, "{} bytes", answer.err.len());
}

#[test]
fn threads_have_a_limit() {
    let answer = linkwear(&["life", "mechanisms/rssr.toml", "--threads", "1025"]);
    assert!(answer.code == 2 && answer.err.contains("from 1 to 1024"), "{}", answer.err);
    assert_eq!(linkwear(&["life", "mechanisms/rssr.toml", "--threads", "0"]).code, 2);
}
