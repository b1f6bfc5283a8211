//! `life --out --resume`: a life that was interrupted, in whatever way, ends with the same bits.

use std::fs;
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::command::{Answer, Folder, linkwear, start};

/// Coarse steps: only bits are compared. Most of the time goes into the table, then come the lives.
const LIFE: [&str; 9] =
    ["life", "mechanisms/rssr.toml", "--rigid", "--step", "5e-5", "--settle", "0", "--seed", "7"];
const RANDOM: [&str; 4] = ["--trajectories", "3000", "--format", "json"];
const FULL: [&str; 5] = ["--coupling", "full", "--mean", "--format", "json"];
const RESULTS: [&str; 5] =
    ["life.json", "cycles.csv", "cycles.csv-metadata.json", "lives.csv", "lives.csv-metadata.json"];

fn arguments<'a>(more: &[&'a str], out: &'a str) -> Vec<&'a str> {
    [&LIFE[..], more, &["--out", out]].concat()
}

/// A random part, other in every process: the moment of a kill is to be any.
fn part() -> f64 {
    RandomState::new().build_hasher().finish() as f64 / u64::MAX as f64
}

/// The results in a folder; none where there is none.
fn results(folder: &Folder, out: &str) -> Vec<Option<Vec<u8>>> {
    RESULTS.map(|name| fs::read(folder.path(&format!("{out}/{name}"))).ok()).into()
}

/// Bytes in the journal of a run.
fn journal(folder: &Folder, out: &str) -> u64 {
    fs::metadata(folder.path(&format!("{out}/life.journal"))).map_or(0, |found| found.len())
}

/// A run that is held once its journal has so many bytes, however slow or fast the machine is: one that has ended before it was looked
/// at begins anew.
fn held(folder: &Folder, out: &str, more: &[&str], bytes: u64) -> Child {
    for _ in 0..50 {
        let mut child = start(&arguments(more, &folder.path(out)));
        let mut has_ended = || child.try_wait().expect("a child").is_some();
        while journal(folder, out) < bytes && !has_ended() {
            sleep(Duration::from_millis(1));
        }
        if !has_ended() {
            signal(&child, "-STOP");
            if child.try_wait().expect("a child").is_none() {
                return child;
            }
        }
        fs::remove_dir_all(folder.path(out)).expect("its folder");
    }
    panic!("fifty runs ended before anyone saw {bytes} bytes");
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(sent.expect("kill runs").success());
}

/// A run killed when its journal has so many bytes, and its end by `--resume`; says how long both parts took.
fn killed(folder: &Folder, out: &str, more: &[&str], bytes: u64) -> (Answer, [Duration; 2]) {
    let begin = Instant::now();
    let mut child = held(folder, out, more, bytes);
    child.kill().expect("it is held");
    child.wait().expect("it is dead");
    let before = begin.elapsed();
    let begin = Instant::now();
    let answer = linkwear(&[&arguments(more, &folder.path(out))[..], &["--resume"]].concat());
    (answer, [before, begin.elapsed()])
}

/// So many runs, each killed once, against one that was not: by turns anywhere in what is measured, anywhere in the lives, and
/// when the journal is whole and results are written. Says how long the whole one took, and at how many bytes its lives begin.
fn kills(folder: &Folder, more: &[&str], count: usize) -> (Duration, u64) {
    let begin = Instant::now();
    let whole = linkwear(&arguments(more, &folder.path("whole")));
    let took = begin.elapsed();
    let expected = results(folder, "whole");
    assert!(expected[0].is_some());
    let size = journal(folder, "whole");
    let lives = folder.read("whole/life.journal").find("{\"life\"").map_or(size, |at| at as u64);
    for at in 0..count {
        let out = format!("run{at}");
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a small file")]
        let within = |from: u64, to: u64| from + ((to - from) as f64 * part()) as u64;
        let bytes = [within(0, lives), within(lives, size), size][at % 3];
        let (answer, _) = killed(folder, &out, more, bytes);
        assert_eq!(answer.code, 0, "killed at {bytes} of {size} bytes: {}{}", answer.out, answer.err);
        assert_eq!(answer.out, whole.out, "killed at {bytes} of {size} bytes");
        assert!(results(folder, &out) == expected, "killed at {bytes} of {size} bytes");
    }
    (took, lives)
}

#[test]
fn a_killed_life_ends_with_the_same_bits() {
    kills(&Folder::new("kill"), &RANDOM, 3);
}

/// `cargo test --release --test cli life_resume:: -- --ignored --nocapture`, alone on its machine: it measures times.
#[test]
#[ignore = "minutes; times want a machine of their own"]
fn fifty_killed_lives_end_with_the_same_bits_and_lose_little() {
    let folder = Folder::new("kills");
    let (took, lives) = kills(&folder, &RANDOM, 45);
    kills(&Folder::new("kills-full"), &FULL, 5);
    // What both parts took together beside a whole run, killed when the table is made; the median of five.
    let both = |at: usize| killed(&folder, &format!("timed{at}"), &RANDOM, lives).1.iter().sum::<Duration>();
    let mut times: Vec<Duration> = (0..5).map(both).collect();
    times.sort();
    let part = times[2].as_secs_f64() / took.as_secs_f64();
    println!(
        "50 of 50 the same bits; killed and gone on with, a run took {:.0} % of a whole one",
        100.0 * part
    );
    // Two starts of the program and what was not yet written.
    assert!(part <= 1.35, "{part}");
}

/// Bytes of a journal that has begun, far from its end.
const BEGUN: u64 = 3000;

#[test]
fn signals_keep_what_is_finished_and_say_how_to_go_on() {
    let folder = Folder::new("signals");
    let whole = linkwear(&arguments(&RANDOM, &folder.path("whole")));
    for name in ["INT", "TERM", "HUP"] {
        let child = held(&folder, name, &RANDOM, BEGUN);
        signal(&child, &format!("-{name}"));
        signal(&child, "-CONT");
        let answer = Answer::of(child.wait_with_output().expect("it ends"));
        let error = answer.errors()[0].clone();
        let text = |key: &str| error[key].as_str().expect("a text").to_owned();
        assert!(answer.code == 1 && text("message").contains("stopped on request"), "{name}: {error}");
        assert_eq!(text("code"), "C0009", "{name}: as every other command that is stopped");
        assert!(text("help").contains("--resume"), "{name}: {error}");
        let path = folder.path(name);
        let again = linkwear(&[&arguments(&RANDOM, &path)[..], &["--resume"]].concat());
        assert_eq!((again.code, &again.out), (0, &whole.out), "{name}");
        assert!(results(&folder, name) == results(&folder, "whole"));
    }
}

#[test]
fn a_folder_has_one_run_at_a_time() {
    let folder = Folder::new("two");
    let out = folder.path("lives");
    let mut first = held(&folder, "lives", &RANDOM, BEGUN);
    let second = linkwear(&[&arguments(&RANDOM, &out)[..], &["--resume"]].concat());
    assert_eq!((second.code, &second.errors()[0]["code"]), (1, &"C0013".into()), "{}", second.out);
    assert!(second.out.contains("another run is writing"), "{}", second.out);
    let fresh = linkwear(&arguments(&RANDOM, &out));
    assert_eq!((fresh.code, &fresh.errors()[0]["code"]), (1, &"C0004".into()));
    // The lock of the dead hinders nobody.
    first.kill().expect("it is held");
    first.wait().expect("it is dead");
    assert_eq!(linkwear(&[&arguments(&RANDOM, &out)[..], &["--resume"]].concat()).code, 0);
}

#[test]
fn a_folder_of_other_files_has_no_run_to_go_on_with() {
    let folder = Folder::new("foreign");
    let notes = folder.write("notes.txt", "mine");
    let holder = folder.path("");
    let answer = linkwear(&["life", "mechanisms/rssr.toml", "--out", &holder, "--resume"]);
    assert_eq!(answer.code, 1, "{}", answer.err);
    assert!(answer.err.contains("C0004") && answer.err.contains("no run of linkwear"), "{}", answer.err);
    assert!(!answer.err.contains("by --resume"), "{}", answer.err);
    assert_eq!(fs::read_to_string(notes).expect("the file"), "mine");
}

#[test]
fn only_the_same_run_goes_on_and_more_lives_extend_it() {
    let folder = Folder::new("same");
    let ask = |out: &str, count: &str, more: &[&str]| {
        let path = folder.path(out);
        let lives = ["--trajectories", count, "--format", "json"];
        linkwear(&[&arguments(&lives, &path)[..], more].concat())
    };
    // Without a state it begins, on a finished run it says the same again.
    let few = ask("lives", "40", &["--resume"]);
    assert_eq!(ask("lives", "40", &["--resume"]).json(), few.json());
    let more = ask("lives", "90", &["--resume"]);
    assert_eq!(more.out, ask("fresh", "90", &[]).out);
    assert!(results(&folder, "lives") == results(&folder, "fresh"));
    // With fewer lives the results are of these, and say that there are more.
    let fewer = ask("lives", "40", &["--resume"]);
    assert_eq!(fewer.json(), few.json());
    assert!(fewer.err.contains("keeps 90 random lives, of which 40 are asked for"), "{}", fewer.err);
    assert!(fewer.err.contains("--trajectories 90"), "{}", fewer.err);
    let all = ask("lives", "90", &["--resume"]);
    assert!(all.out == more.out && !all.err.contains("random lives, of which"), "{}", all.err);

    let journal = folder.read("lives/life.journal");
    let refused = |more: &[&str], words: &str| {
        let answer = ask("lives", "40", &[&["--resume"], more].concat());
        let message = answer.errors()[0]["message"].as_str().expect("a text").to_owned();
        assert_eq!(answer.errors()[0]["code"], "C0013");
        assert!(message.contains(words), "{message}");
    };
    refused(&["--set", "speed=3 Hz"], "parameter speed is 3.0 now, and was 2.0");
    refused(&["--average", "2"], "the number of revolutions to average is 2 now, and was 1");
    refused(&["--no-feedback"], "feedback is false now, and was true");
    refused(&["--shared-factor", "0.1"], "the shared factor is 0.1 now, and was not given");
    // A flipped bit, anywhere but in a last line that has no end.
    folder.write("lives/life.journal", &journal.replacen("measurement", "measurementt", 1));
    refused(&[], "line 2 of");
    folder.write("lives/life.journal", &journal);
    assert_eq!(ask("lives", "90", &["--resume"]).out, more.out);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_and_a_folder_that_cannot_be_written_are_refused() {
    let folder = Folder::new("full");
    let out = folder.path("lives");
    // A limit on the size of files, in blocks of 1024 bytes, is as good as a full disk.
    let line = format!(
        "ulimit -f 12; trap '' XFSZ; exec {} {} --resume",
        env!("CARGO_BIN_EXE_linkwear"),
        arguments(&RANDOM, &out).join(" ")
    );
    let stopped = Command::new("bash").args(["-c", &line]).output().expect("bash runs");
    let stopped = Answer::of(stopped);
    assert_eq!((stopped.code, &stopped.errors()[0]["code"]), (1, &"C0003".into()), "{}", stopped.out);
    assert!(folder.read("lives/life.journal").ends_with('\n'));
    assert!(!fs::exists(folder.path("lives/life.json")).expect("a folder"));
    let rest = linkwear(&[&arguments(&RANDOM, &out)[..], &["--resume"]].concat());
    assert_eq!(rest.out, linkwear(&arguments(&RANDOM, &folder.path("whole"))).out);

    let answer = linkwear(&arguments(&RANDOM, "/proc/lives"));
    assert_eq!((answer.code, &answer.errors()[0]["code"]), (1, &"C0003".into()));
}
