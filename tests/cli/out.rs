//! Where results are written: files whole and with their permissions, streams straight, nothing else.

use std::fs::{self, File, Permissions};
use std::io::Read as _;
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};
use std::process::{Command, Stdio};

use crate::command::{Folder, linkwear};

const PENDULUM: &str = "mechanisms/pendulum.toml";

/// Everything that writes one file, without the file.
const WRITERS: [&[&str]; 3] = [
    &["simulate", PENDULUM, "--samples", "5", "--time", "0.1", "--out"],
    &["generate", PENDULUM, "--out"],
    &[
        "fit",
        "examples/data/sliding_wear_100g.csv",
        "--unit",
        "unit",
        "--wear",
        "wear_um",
        "--exposure",
        "cycles",
        "--from-zero",
        "--out",
    ],
];

/// What linkwear wrote before.
const OLD: &str = "<!-- linkwear 0.0.0 #before# -->";

fn with<'a>(writer: &[&'a str], out: &'a str) -> Vec<&'a str> {
    [writer, &[out][..]].concat()
}

fn mode(path: &str) -> u32 {
    fs::metadata(path).expect("a file").permissions().mode() & 0o7777
}

/// Runs a line of the shell with the program as `$0`.
fn shell(line: &str) -> std::process::Output {
    let mut command = Command::new("sh");
    command.args(["-c", line, env!("CARGO_BIN_EXE_linkwear")]).stdin(Stdio::null());
    command.output().expect("a shell")
}

#[test]
fn a_replaced_file_keeps_its_permissions_and_a_new_one_has_those_of_the_umask() {
    let folder = Folder::new("mode");
    for (at, writer) in WRITERS.iter().enumerate() {
        let (old, new) = (folder.write(&format!("old{at}"), OLD), folder.path(&format!("new{at}")));
        fs::set_permissions(&old, Permissions::from_mode(0o640)).expect("a mode");
        assert_eq!(linkwear(&with(writer, &old)).code, 0);
        assert_eq!((mode(&old), folder.read(&format!("old{at}")).contains("#before#")), (0o640, false));
        assert_eq!(linkwear(&with(writer, &new)).code, 0);
        let plain = folder.write("plain", "");
        assert_eq!(mode(&new), mode(&plain), "{writer:?}");
    }
    let rows = ["new0", "new0-metadata.json", "new1", "new2"];
    let old = ["old0", "old0-metadata.json", "old1", "old2", "plain"];
    assert_eq!(folder.names(), [&rows[..], &old].concat());
}

/// Somebody's own file, which may well be the data that a run was to be compared with.
#[test]
fn what_linkwear_did_not_make_is_replaced_by_force_alone() {
    let folder = Folder::new("foreign");
    let own = |name: &str| folder.path(name);
    let mut writers: Vec<(Vec<&str>, String)> = WRITERS
        .iter()
        .zip(["a.csv", "a.rs", "a.json"])
        .map(|(writer, name)| (writer.to_vec(), own(name)))
        .collect();
    let plot = ["simulate", PENDULUM, "--samples", "5", "--time", "0.1", "--plot"];
    let arrays = &WRITERS[0];
    let study = [
        "study",
        "mechanisms/rssr_rigid.toml",
        "--vary",
        "speed=1 Hz,2 Hz",
        "--of",
        "energy_error_J",
        "--out",
    ];
    let unit = ["fmu", PENDULUM, "--out"];
    for (writer, name) in [
        (&plot[..], "a.svg"),
        (arrays, "a.npy"),
        (arrays, "a.parquet"),
        (&study, "study.csv"),
        (&unit, "a.fmu"),
    ] {
        writers.push((writer.to_vec(), own(name)));
    }
    for (writer, path) in &writers {
        fs::write(path, "cycle,wear\n1,2.5\n").expect("a file");
        let refused = linkwear(&with(writer, path));
        assert!(
            refused.code == 1 && refused.err.contains("C0004") && refused.err.contains("--force"),
            "{path}"
        );
        assert_eq!(fs::read_to_string(path).expect("a file"), "cycle,wear\n1,2.5\n");
        assert_eq!(linkwear(&[&with(writer, path)[..], &["--force"]].concat()).code, 0, "{path}");
        // Now it is linkwear's own. A study that was left undone would stand beside it.
        let _ = fs::remove_file(format!("{path}.journal"));
        let again = linkwear(&with(writer, path));
        assert_eq!(again.code, 0, "{path}: {}", again.err);
    }
    // What is left of a run that stops has a file beside it.
    let partial = folder.write("rows.partial.csv", "cycle,wear\n1,2.5\n");
    let rows = folder.path("rows.csv");
    let simulate = ["simulate", PENDULUM, "--samples", "5", "--time", "0.1", "--out", &rows];
    let refused = linkwear(&simulate);
    assert!(refused.code == 1 && refused.err.contains("C0004") && refused.err.contains("rows.partial.csv"));
    assert!(!fs::exists(&rows).expect("a folder"), "before the work");
    assert_eq!(linkwear(&[&simulate[..], &["--force"]].concat()).code, 0);
    assert_eq!(fs::read_to_string(partial).expect("a file"), "cycle,wear\n1,2.5\n", "it did not stop");
    // Two files of one name, a crate of its own.
    let stem = folder.path("pendulum");
    let source = folder.write("pendulum.c", "int main(void) { return 0; }\n");
    let c = ["generate", PENDULUM, "--target", "c", "-o", &stem];
    assert_eq!(linkwear(&c).code, 1);
    assert!(!fs::exists(folder.path("pendulum.h")).expect("a folder"), "nothing half-written");
    assert!(fs::read_to_string(source).expect("a file").contains("main"));
    let krate = folder.path("krate");
    let c_abi = ["generate", PENDULUM, "--target", "c-abi", "-o", &krate];
    (0..2).for_each(|_| assert_eq!(linkwear(&c_abi).code, 0));
    fs::remove_file(folder.path("krate/src/mechanism.rs")).expect("a file");
    assert_eq!(linkwear(&c_abi).code, 1, "somebody's crate");
}

#[test]
fn a_symbolic_link_stays_and_the_file_that_it_names_is_replaced() {
    let folder = Folder::new("link");
    fs::create_dir(folder.path("far")).expect("a folder");
    let target = folder.write("far/rows", OLD);
    let link = folder.path("link");
    symlink("far/rows", &link).expect("a link");
    for writer in WRITERS {
        fs::write(&target, OLD).expect("a file");
        assert_eq!(linkwear(&with(writer, &link)).code, 0);
        assert!(fs::symlink_metadata(&link).expect("a link").is_symlink());
        assert!(!folder.read("far/rows").contains("#before#"));
        assert_eq!(fs::read_dir(folder.path("far")).expect("a folder").count(), 1);
    }
}

#[test]
fn what_is_no_file_and_no_stream_is_refused_before_the_work() {
    let folder = Folder::new("refused");
    fs::create_dir(folder.path("folder")).expect("a folder");
    symlink("nothing", folder.path("dangling")).expect("a link");
    symlink("folder", folder.path("to_folder")).expect("a link");
    let _socket = std::os::unix::net::UnixListener::bind(folder.path("socket")).expect("a socket");
    let before = folder.names();
    let missing = folder.path("no/folder/rows.csv");
    for writer in WRITERS {
        for (name, reason) in [
            ("folder", "it is a folder"),
            ("to_folder", "it is a folder"),
            ("dangling", "it is a symbolic link to nothing"),
            ("socket", "it is neither a file nor a stream"),
        ] {
            let path = folder.path(name);
            let answer = linkwear(&with(writer, &path));
            assert_eq!((answer.code, answer.out.as_str()), (1, ""), "{name}");
            assert!(answer.err.contains("C0003") && answer.err.contains(reason), "{}", answer.err);
        }
        let answer = linkwear(&with(writer, &missing));
        assert!(answer.code == 1 && answer.err.contains("C0003"), "{}", answer.err);
    }
    for writer in &WRITERS[1..] {
        let answer = linkwear(&with(writer, "-"));
        assert!(answer.code == 2 && answer.err.contains("/dev/stdout"), "{}", answer.err);
    }
    let answer = linkwear(&["life", "mechanisms/rssr.toml", "--out", "-"]);
    assert_eq!(answer.code, 2, "{}", answer.err);
    assert_eq!(folder.names(), before);
    let dangling = folder.path("new.toml");
    symlink("nothing", &dangling).expect("a link");
    assert_eq!(folder.linkwear(&["new", "new"]).code, 1);
    assert!(fs::symlink_metadata(&dangling).expect("a link").is_symlink());
}

#[test]
fn devices_are_written_to_and_stay_devices() {
    for writer in WRITERS {
        assert_eq!(linkwear(&with(writer, "/dev/null")).code, 0);
        assert!(fs::metadata("/dev/null").expect("a device").file_type().is_char_device());
        let full = linkwear(&with(writer, "/dev/full"));
        assert!(full.code == 1 && full.err.contains("C0003"), "{}", full.err);
        assert!(fs::metadata("/dev/full").expect("a device").file_type().is_char_device());
    }
    // An incomplete run leaves no file beside a device either.
    let stuck =
        ["simulate", "mechanisms/four_bar.toml", "--step", "0.05", "--turns", "3", "--out", "/dev/null"];
    let _ = linkwear(&stuck);
    assert!(!fs::exists("/dev/null.partial").expect("a folder"));
}

#[test]
fn stdout_by_name_has_the_rows_and_then_the_answer_in_a_pipe_and_in_a_file() {
    let folder = Folder::new("stdout");
    let line = format!("\"$0\" simulate {PENDULUM} --samples 5 --time 0.1 --out /dev/stdout");
    let piped = String::from_utf8(shell(&format!("{line} | cat")).stdout).expect("UTF-8");
    let kept = folder.path("kept.txt");
    assert!(shell(&format!("{line} > {kept}")).status.success());
    for text in [piped, folder.read("kept.txt")] {
        let rows: Vec<&str> = text.lines().take(6).collect();
        assert!(rows[0].starts_with("t [s],") && rows[5].starts_with("0.1,"), "{text}");
        assert!(text.contains("/dev/stdout"), "{text}");
    }
    assert_eq!(folder.names(), ["kept.txt"]);
    assert!(shell(&format!("{line} | head -1")).status.success());
}

#[test]
fn a_dash_is_stdout_with_the_rows_and_nothing_else() {
    let folder = Folder::new("dash");
    let rows =
        ["simulate", "mechanisms/slider_crank_clearance.toml", "--samples", "5", "--time", "0.01", "--out"];
    let file = folder.path("rows.csv");
    assert_eq!(linkwear(&with(&rows, &file)).code, 0);
    let answer = linkwear(&with(&rows, "-"));
    assert_eq!((answer.code, answer.out), (0, folder.read("rows.csv")), "{}", answer.err);
    // A file may have this name all the same.
    let own = fs::canonicalize("mechanisms/pendulum.toml").expect("a file");
    let own = own.to_str().expect("UTF-8");
    assert_eq!(
        folder.linkwear(&["simulate", own, "--samples", "2", "--time", "0.1", "--out", "./-"]).code,
        0
    );
    assert!(folder.read("-").starts_with("t [s],"));
    for json in [&["--format", "json"][..], &["--format=json"]] {
        let answer = linkwear(&[&with(&rows, "-")[..], json].concat());
        assert_eq!((answer.code, answer.errors()[0]["code"].as_str()), (2, Some("C0001")));
    }
    let line =
        format!("\"$0\" simulate {PENDULUM} --samples 100000 --time 0.001 --step 1e-4 --out - | head -1");
    let head = shell(&line);
    assert!(
        head.status.success() && head.stderr.is_empty() && head.stdout.starts_with(b"t [s],"),
        "{head:?}"
    );
    let run = format!("simulate {PENDULUM}");
    for line in
        [&format!("{run} --out -"), &format!("{run} --time 0.1"), "--help", "--version", "life --help"]
    {
        let full = shell(&format!("\"$0\" {line} > /dev/full"));
        let said = String::from_utf8_lossy(&full.stderr);
        assert_eq!(full.status.code(), Some(1), "{said}");
        assert!(said.contains("cannot write `stdout`") && said.contains("make room"), "{said}");
        assert!(!said.contains("folder"), "{said}");
    }
}

#[test]
fn a_stderr_that_cannot_be_written_changes_no_exit_code_and_no_result() {
    let folder = Folder::new("stderr");
    let empty = folder.write("empty.csv", "");
    let fit = format!("\"$0\" fit {empty} --unit u --wear w --exposure h 2> /dev/full");
    assert_eq!(shell(&fit).status.code(), Some(1));
    // A driver that does not get round is a warning.
    let text = fs::read_to_string("mechanisms/four_bar.toml").expect("a mechanism");
    let rocking = folder.write("rocking.toml", &text.replace("2*pi*speed*t", "0.3*sin(2*pi*speed*t)"));
    let picture = folder.path("picture.svg");
    let draw = shell(&format!("\"$0\" draw {rocking} -o {picture} 2> /dev/full"));
    assert_eq!(draw.status.code(), Some(0), "{draw:?}");
    assert!(folder.read("picture.svg").starts_with("<svg"));
}

#[test]
fn a_pipe_by_name_hands_the_rows_to_its_reader() {
    let folder = Folder::new("fifo");
    let pipe = folder.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    for writer in WRITERS {
        let path = pipe.clone();
        let reader = std::thread::spawn(move || {
            let mut text = String::new();
            File::open(path).and_then(|mut pipe| pipe.read_to_string(&mut text)).expect("a pipe");
            text
        });
        assert_eq!(linkwear(&with(writer, &pipe)).code, 0);
        assert!(reader.join().expect("a reader").len() > 100);
        assert!(fs::metadata(&pipe).expect("a pipe").file_type().is_fifo());
    }
    assert_eq!(folder.names(), ["pipe"]);
}

#[test]
fn a_signal_while_a_large_file_is_written_leaves_nothing_half_written() {
    let folder = Folder::new("signal");
    let out = folder.write("rows.csv", OLD);
    let mut child = crate::command::start(&[
        "simulate",
        PENDULUM,
        "--time",
        "0.001",
        "--step",
        "1e-5",
        "--samples",
        "400000",
        "--out",
        &out,
    ]);
    // Bytes in its temporary file tell that the writing has begun: an empty one is made before the work, to see that it can be.
    let is_written = |name: &str| fs::metadata(folder.path(name)).is_ok_and(|file| file.len() > 0);
    let has_begun = || folder.names().iter().any(|name| name != "rows.csv" && is_written(name));
    while !has_begun() && child.try_wait().expect("a child").is_none() {
        std::thread::yield_now();
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill").success());
    let _ = child.wait_with_output();
    assert_eq!(folder.names(), ["rows.csv", "rows.csv-metadata.json"]);
    assert!(folder.read("rows.csv").lines().count() == 400_001);
}

#[test]
fn a_measured_curve_has_the_columns_of_a_run_and_is_replaced_by_force_alone() {
    let folder = Folder::new("measured");
    for name in ["curve.csv", "curve.npy"] {
        let curve = folder.write(name, "t [s],R1.drive [N m]\n0,1.5\n");
        let refused = linkwear(&with(WRITERS[0], &curve));
        assert!(refused.code == 1 && refused.err.contains("C0004"), "{name}: {}", refused.err);
        assert_eq!(folder.read(name), "t [s],R1.drive [N m]\n0,1.5\n");
    }
}

#[test]
fn no_file_is_written_that_is_read_or_twice() {
    let folder = Folder::new("apart");
    let part = |shard: &str, name: &str| {
        let out = folder.path(name);
        let study = ["study", "mechanisms/rssr_rigid.toml", "--vary", "speed=1 Hz,2 Hz", "--of", "steps"];
        assert_eq!(linkwear(&[&study[..], &["--shard", shard, "--out", &out]].concat()).code, 0);
        out
    };
    let (first, second) = (part("1/2", "first"), part("2/2", "second"));
    let life = folder.path("life");
    let lived =
        ["life", "mechanisms/rssr.toml", "--rigid", "--step", "1e-4", "--settle", "0", "--trajectories", "5"];
    assert_eq!(linkwear(&[&lived[..], &["--out", &life]].concat()).code, 0);
    let told = folder.path("life/life.json");
    let fit = with(WRITERS[2], &told);
    let of_a_joint = format!("R1={told}");
    for (command, kept) in [
        (vec!["merge", &first, &second, "--out", &first], &first),
        (vec!["report", &life, "-o", &told], &told),
        ([&fit[..], &["--lambda", &told]].concat(), &told),
        ([&fit[..], &["--lambda", &of_a_joint]].concat(), &told),
    ] {
        let before = fs::read(kept).expect("a file");
        let refused = linkwear(&[&command[..], &["--force"]].concat());
        assert!(
            refused.code == 1 && refused.err.contains("C0004"),
            "{command:?}: {}{}",
            refused.out,
            refused.err
        );
        assert!(fs::read(kept).expect("a file") == before, "{command:?}");
    }
    // Under two names, and before there is a file.
    let (curve, same) = (folder.path("curve.svg"), folder.path("life/../curve.svg"));
    for writer in [WRITERS[0], WRITERS[2]] {
        let refused = linkwear(&[&with(writer, &curve)[..], &["--plot", &same]].concat());
        assert!(refused.code == 2 && refused.err.contains("--plot"), "{}{}", refused.out, refused.err);
        assert!(!fs::exists(&curve).expect("a folder"));
    }
}

#[test]
fn names_that_are_not_utf_8_are_names_of_files() {
    let folder = Folder::new("bytes");
    let study = "--vary 'length=1 m,2 m' --of steps --shard 1/1";
    let answer = shell(&format!(
        "f=$(printf '{}/m\\377.toml') && cp {PENDULUM} \"$f\" && \"$0\" study \"$f\" {study} --out \"$f.part\"",
        folder.path("")
    ));
    assert_eq!(answer.status.code(), Some(0), "{}", String::from_utf8_lossy(&answer.stderr));
}

#[test]
fn an_error_that_stdout_has_no_room_for_is_said_on_stderr() {
    let answer = shell("\"$0\" check no_such.toml --format json >/dev/full");
    let said = String::from_utf8(answer.stderr).expect("UTF-8");
    assert_eq!(answer.status.code(), Some(1));
    assert!(said.contains("C0002") && said.contains("C0003"), "{said}");
}

#[test]
fn pages_that_were_written_before_a_failure_are_not_denied() {
    let folder = Folder::new("some-pages");
    fs::create_dir_all(folder.path("man/linkwear-fit.1")).expect("a folder in the way");
    let refused = linkwear(&["man", "--out", &folder.path("man")]);
    assert!(refused.code == 1 && refused.err.contains("C0003"), "{}", refused.err);
    assert!(fs::exists(folder.path("man/linkwear.1")).expect("a folder"));
    assert!(!refused.err.contains("nothing was changed"), "{}", refused.err);
}
