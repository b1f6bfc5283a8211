//! `generate --target c` and `--target c-abi`: files, what `--check` says of them, and the page of the documentation word for word.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::{Folder, linkwear};

const PENDULUM: &str = "mechanisms/pendulum.toml";

#[test]
fn c_writes_a_source_and_a_header_that_check_accepts_until_one_is_stale() {
    let folder = Folder::new("generate-c");
    let stem = folder.path("swing");
    let written = linkwear(&["generate", PENDULUM, "--target", "c", "-o", &stem, "--format", "json"]).json();
    assert_eq!(written["files"], serde_json::json!([format!("{stem}.h"), format!("{stem}.c")]));
    let check = ["generate", PENDULUM, "--target", "c", "-o", &stem, "--check"];
    assert_eq!(linkwear(&check).code, 0);
    for file in [format!("{stem}.h"), format!("{stem}.c")] {
        let text = fs::read_to_string(&file).unwrap();
        fs::write(&file, text.replacen("Do not edit", "Edited", 1)).unwrap();
        let stale = linkwear(&check);
        assert_eq!(stale.code, 1);
        assert!(stale.err.contains(&file), "{}", stale.err);
        fs::write(&file, text).unwrap();
    }
    assert_eq!(linkwear(&check).code, 0);
}

#[test]
fn c_abi_writes_a_crate_that_check_accepts() {
    let folder = Folder::new("generate-c-abi");
    let out = folder.path("crate");
    assert_eq!(linkwear(&["generate", PENDULUM, "--target", "c-abi", "-o", &out]).code, 0);
    for file in ["Cargo.toml", "src/lib.rs", "src/mechanism.rs", "pendulum.h"] {
        assert!(Path::new(&out).join(file).is_file(), "{file}");
    }
    assert_eq!(linkwear(&["generate", PENDULUM, "--target", "c-abi", "-o", &out, "--check"]).code, 0);
}

#[test]
fn several_files_need_a_place() {
    for target in ["c", "c-abi"] {
        let answer = linkwear(&["generate", PENDULUM, "--target", target]);
        assert_eq!(answer.code, 2);
        assert!(answer.err.contains("--out"), "{}", answer.err);
    }
}

#[test]
fn a_wrong_mechanism_gets_the_same_answer_for_every_target() {
    let folder = Folder::new("generate-wrong");
    let text = fs::read_to_string(PENDULUM).unwrap().replace("revolute", "revolut");
    let file = folder.write("wrong.toml", &text);
    let answers = ["rust", "c", "c-abi"].map(|target| {
        let out = folder.path(&format!("out_{target}"));
        linkwear(&["generate", &file, "--target", target, "-o", &out, "--format", "json"]).errors()
    });
    assert!(!answers[0].is_empty());
    assert_eq!(answers[0], answers[1]);
    assert_eq!(answers[0], answers[2]);
}

/// Code blocks of a language of the page, in order.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let begin = format!("```{language}\n");
    page.split(&begin).skip(1).filter_map(|rest| rest.split("```").next()).map(str::to_owned).collect()
}

/// Runs the lines of a block as a shell does, in a folder, `linkwear` being this program. Out: what is printed.
fn shell(folder: &Folder, lines: &str) -> String {
    let bin = Path::new(env!("CARGO_BIN_EXE_linkwear")).parent().unwrap().display().to_string();
    let path = format!("{bin}:{}", std::env::var("PATH").unwrap_or_default());
    let output =
        Command::new("sh").args(["-euc", lines]).current_dir(&folder.0).env("PATH", path).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{lines}\n{said}");
    String::from_utf8(output.stdout).unwrap()
}

fn is_there(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if !found {
        println!("skipped: there is no {program}");
    }
    found
}

/// A folder with what a reader of the page has.
fn reader(name: &str) -> Folder {
    let folder = Folder::new(name);
    for part in ["cortex-m", "mechanisms"] {
        fs::create_dir_all(folder.0.join(part)).unwrap();
    }
    for file in ["main.c", "library.c", "cortex-m/main.c", "cortex-m/link.ld"] {
        fs::copy(format!("examples/c/{file}"), folder.0.join(file)).unwrap();
    }
    fs::copy("mechanisms/rssr_rigid.toml", folder.0.join("mechanisms/rssr_rigid.toml")).unwrap();
    folder
}

#[test]
fn the_page_s_c99_project_prints_what_the_page_shows() {
    let page = fs::read_to_string("docs/embedding-c.md").unwrap();
    assert_eq!(blocks(&page, "c")[0], fs::read_to_string("examples/c/main.c").unwrap());
    if !is_there("cc") {
        return;
    }
    let folder = reader("embedding-c");
    let printed = shell(&folder, &blocks(&page, "sh")[0]);
    let shown = &blocks(&page, "text")[0];
    assert!(printed.ends_with(shown.as_str()), "{printed}");
    // The angle is that of a run of the program.
    let rows = folder.path("rows.csv");
    let run = [
        "simulate",
        "mechanisms/rssr_rigid.toml",
        "--time",
        "0.5",
        "--step",
        "1e-4",
        "--samples",
        "2",
        "--out",
        &rows,
    ];
    assert_eq!(linkwear(&run).code, 0);
    let table = fs::read_to_string(&rows).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|name| name.starts_with("R4.q")).unwrap();
    let angle: f64 = lines.next_back().unwrap()[place].parse().unwrap();
    assert!(shown.starts_with(&format!("R4.q = {angle:.12} rad\n")), "{angle} {shown}");
}

#[test]
fn the_same_files_give_the_same_bits_on_bare_metal() {
    if !is_there("arm-none-eabi-gcc") || !is_there("qemu-system-arm") || !is_there("cc") {
        return;
    }
    let page = fs::read_to_string("docs/embedding-c.md").unwrap();
    let folder = reader("bare-metal");
    let commands = blocks(&page, "sh");
    let first = commands[0].lines().next().unwrap();
    let printed = shell(&folder, &format!("{first} > /dev/null\n{}", commands[1]));
    let host = include_str!("../command/thousand_steps.c");
    fs::write(folder.0.join("host.c"), host).unwrap();
    let expected =
        shell(&folder, "cc -std=c99 -O2 -ffp-contract=off host.c rssr_rigid.c -lm -o host\n./host");
    let bits: String =
        printed.lines().filter(|line| line.starts_with("y ")).flat_map(|line| [line, "\n"]).collect();
    assert_eq!(bits, expected);
    assert!(printed.contains("status 00"), "{printed}");
    println!("{printed}");
}
