//! `study`: rows are what `simulate` and `life` answer at the same point, whatever runs them, in whatever order, in how many parts;
//! what cannot be studied is answered with what to write.

use std::fs;
use std::ops::{ControlFlow, Range};
use std::path::Path;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::Duration;

use crate::command::{Answer, Folder, linkwear, start};
use linkwear::cli::ask;
use linkwear::mechanism::read_source;
use linkwear::runtime::Watch;
use serde_json::Value;

const RIGID: &str = "mechanisms/rssr_rigid.toml";
/// Coarse steps: only bits are compared.
const LIFE: [&str; 6] = ["mechanisms/rssr.toml", "--rigid", "--step", "5e-5", "--settle", "0"];
const JSON: [&str; 2] = ["--format", "json"];

fn study(arguments: &[&[&str]]) -> Answer {
    linkwear(&[&["study"][..], &arguments.concat()].concat())
}

/// A column of an answer by its name.
fn column(answer: &Value, name: &str) -> Vec<Value> {
    let columns = answer["columns"].as_array().expect("columns");
    let at = columns.iter().position(|column| column["name"] == name).expect(name);
    answer["rows"].as_array().expect("rows").iter().map(|row| row[at].clone()).collect()
}

fn error(answer: &Answer) -> (String, String, String) {
    let error = &answer.errors()[0];
    let text = |key: &str| error[key].as_str().expect("a text").to_owned();
    (text("code"), text("message"), text("help"))
}

#[test]
fn rows_are_what_simulate_answers_at_their_point() {
    let of = "peak.R1.F,peak.R4.M,steps,max_loop_error_m,energy_error_J,peak.R1.drive,max.R4.q,final.R4.v";
    // A tunable one and one that is folded into the equations, units mixed.
    let vary = ["--vary", "L1=100mm..0.12m:3", "--vary", "speed=1 Hz,2.5 Hz"];
    let answer = study(&[&[RIGID, "--of", of], &vary, &JSON]).json();
    assert_eq!(answer["columns"][0], serde_json::json!({ "name": "L1", "unit": "m", "kind": "parameter" }));
    assert_eq!(
        answer["columns"][2],
        serde_json::json!({ "name": "peak.R1.F", "unit": "N", "kind": "result" })
    );
    assert_eq!((answer["format"].as_u64(), answer["failed"].as_u64()), (Some(1), Some(0)));
    assert_eq!(column(&answer, "L1"), [0.1, 0.1, 0.11, 0.11, 0.12, 0.12]);
    assert_eq!(column(&answer, "speed"), [1.0, 2.5, 1.0, 2.5, 1.0, 2.5], "the last one varies fastest");
    let folder = Folder::new("study-points");
    let points = ["100 mm", "110 mm", "120 mm"].into_iter().flat_map(|l| [(l, "1 Hz"), (l, "2.5 Hz")]);
    for (at, (length, speed)) in points.enumerate() {
        let (length, speed, out) =
            (format!("L1={length}"), format!("speed={speed}"), folder.path("rows.csv"));
        let run = linkwear(&[
            "simulate", RIGID, "--set", &length, "--set", &speed, "--out", &out, "--format", "json",
        ])
        .json();
        let peak = |joint: &str, load: &str| {
            let peaks = run["peaks"].as_array().expect("peaks").iter();
            peaks.clone().find(|peak| peak["joint"] == joint).expect(joint)[load].clone()
        };
        let expected = [
            ("peak.R1.F", peak("R1", "force_N")),
            ("peak.R4.M", peak("R4", "moment_N_m")),
            ("steps", run["steps"].as_f64().into()),
            ("max_loop_error_m", run["max_loop_error_m"].clone()),
            ("energy_error_J", run["energy_error_J"].clone()),
        ];
        for (name, value) in expected {
            assert_eq!(column(&answer, name)[at], value, "{name} at {length}, {speed}");
        }
        // Columns by the rows: extremes are those of the steps.
        let rows = fs::read_to_string(&out).expect("rows");
        let cells = |name: &str| {
            let at =
                rows.lines().next().expect("a head").split(',').position(|head| head == name).expect(name);
            let cells = rows.lines().skip(1).map(move |line| line.split(',').nth(at).expect("a cell"));
            cells.map(|cell| cell.parse::<f64>().expect("a number")).collect::<Vec<_>>()
        };
        let most = |values: Vec<f64>| values.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let drive = most(cells("R1.drive [N m]").into_iter().map(f64::abs).collect());
        let near = |name: &str, value: f64| {
            let found = column(&answer, name)[at].as_f64().expect("a number");
            assert!((found - value).abs() < 2e-3 * value.abs(), "{name}: {found}, {value}");
        };
        near("peak.R1.drive", drive);
        near("max.R4.q", most(cells("R4.q [rad]")));
        assert_eq!(column(&answer, "final.R4.v")[at].as_f64(), cells("R4.v [rad/s]").last().copied());
    }
}

/// Every mode has columns of its own, before the column that is asked for.
#[test]
fn a_column_is_the_same_one_at_every_point() {
    const FLEXIBLE: &str = "mechanisms/rssr_flexible.toml";
    let more = ["--time", "0.01", "--format", "json"];
    let of = ["--vary", "modes=1,2,8", "--of", "final.coupler.uz,final.coupler.eta2,final.coupler.eta8"];
    let answer = study(&[&[FLEXIBLE], &of, &more]).json();
    let folder = Folder::new("study-columns");
    for (at, modes) in [1, 2, 8].into_iter().enumerate() {
        let (set, out) = (format!("modes={modes}"), folder.path("rows.csv"));
        assert_eq!(
            linkwear(&[&["simulate", FLEXIBLE, "--set", &set, "--out", &out], &more[..]].concat()).code,
            0
        );
        let rows = fs::read_to_string(&out).expect("rows");
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let (head, last) =
            (cells(rows.lines().next().expect("a head")), cells(rows.lines().last().expect("a row")));
        let found = |name: &str| {
            let at = head.iter().position(|head| head.starts_with(&format!("{name} [")))?;
            Some(last[at].parse::<f64>().expect("a number"))
        };
        for name in ["coupler.uz", "coupler.eta2", "coupler.eta8"] {
            // With one mode there is no second one: an empty cell.
            assert_eq!(
                column(&answer, &format!("final.{name}"))[at].as_f64(),
                found(name),
                "{name}, {modes} modes"
            );
        }
    }
}

#[test]
fn rows_are_what_life_answers_at_their_point() {
    let keys = ["mean", "std", "cov", "mean_whole_cycles"];
    let of = "life.mean,life.std,life.cov,life.mean_whole_cycles,life.p10,life.p90,life.mean_path,\
              life.revolutions,life.hours,R1.wear_integral_J,R1.peak_normal_force_N,peak.R1.F";
    let lives = ["--trajectories", "200", "--seed", "7"];
    let vary = ["--vary", "c0=8um,15um", "--vary", "k_wear=3e-8"];
    let answer = study(&[&LIFE, &lives, &vary, &["--of", of], &JSON]).json();
    for (at, c0) in ["c0=8 um", "c0=15 um"].into_iter().enumerate() {
        let set = ["--set", c0, "--set", "k_wear=3e-8"];
        let life = linkwear(&[&["life"], &LIFE[..], &lives, &set, &JSON].concat()).json();
        let found = |name: &str| column(&answer, name)[at].clone();
        for key in keys {
            assert_eq!(found(&format!("life.{key}")), life[key], "{key} at {set:?}");
        }
        for key in ["p10", "p90"] {
            assert_eq!(found(&format!("life.{key}")), life["quantiles"][key], "{key} at {set:?}");
        }
        assert_eq!(found("life.mean_path"), life["mean_path"]["cycles"]);
        assert_eq!(found("life.revolutions"), life["revolutions"]);
        assert_eq!(found("life.hours"), life["time"]["mean"]["hours"]);
        let run = linkwear(&[&["simulate"], &LIFE[..4], &set, &JSON].concat()).json();
        let turn = &run["turns"][0];
        assert_eq!(found("R1.wear_integral_J"), turn["wear_integral_J"]);
        assert_eq!(found("R1.peak_normal_force_N"), turn["peak_normal_force_N"]);
        assert_eq!(found("peak.R1.F"), run["peaks"][0]["force_N"]);
    }
}

#[test]
fn a_point_that_cannot_be_is_told_in_its_row_and_the_others_are_run() {
    let folder = Folder::new("study-fail");
    let out = folder.path("rows.csv");
    let ask = |values: &str| {
        let vary = format!("L1={values}");
        study(&[&[RIGID, "--of", "peak.R1.F,steps", "--vary", &vary, "--out", &out], &JSON])
    };
    let answer = ask("120mm,2m,-1m,110mm").json();
    assert_eq!((&answer["failed"], answer["rows"][1][1].is_null()), (&Value::from(2), true), "{answer}");
    let codes = column(&answer, "error");
    assert!(codes[0].is_null() && codes[3].is_null() && answer["rows"][3][1].is_f64());
    let failures = answer["failures"].as_array().expect("failures");
    for (failure, row) in failures.iter().zip([1, 2]) {
        assert_eq!((&failure["row"], &failure["code"]), (&Value::from(row), &codes[row]));
        // As the file itself would be refused with this value.
        let value = ["", "L1=2m", "L1=-1m"][row];
        let alone = linkwear(&["simulate", RIGID, "--set", value, "--format", "json"]);
        assert_eq!((alone.code, &alone.errors()[0]["code"]), (1, &codes[row]));
        assert_eq!(alone.errors()[0]["message"], failure["message"]);
    }
    let rows = fs::read_to_string(&out).expect("rows");
    let lines: Vec<&str> = rows.lines().collect();
    assert_eq!(lines[0], "L1 [m],peak.R1.F [N],steps [1],error");
    assert_eq!(lines[2], format!("2,,,{}", codes[1].as_str().expect("a code")));
    assert!(lines[4].ends_with(','), "{rows}");
    let text = study(&[&[RIGID, "--of", "steps", "--vary", "L1=120mm,2m"]]);
    assert!(
        text.code == 0 && text.out.contains("2 points, 1 failed") && text.out.contains("failed at 1 point:"),
        "{}",
        text.out
    );

    let before = fs::read(&out).expect("rows");
    let none = ask("2m,3m");
    let (code, message, _) = error(&none);
    assert_eq!((none.code, &*code), (1, "C0015"));
    assert!(message.contains("any of 2 points"), "{message}");
    assert_eq!(fs::read(&out).expect("rows"), before, "nothing is written");
}

#[test]
fn a_sample_fills_the_square_and_goes_by_its_seed() {
    let ask = |seed: &str| {
        let vary = ["--vary", "speed=1Hz..3Hz", "--vary", "L1=100mm..120mm", "--vary", "L2=400mm,420mm"];
        let sample = ["--sample", "sobol:16", "--seed", seed, "--of", "steps", "--time", "0.01"];
        study(&[&[RIGID], &vary, &sample, &JSON])
    };
    let (one, again, other) = (ask("1"), ask("1"), ask("2"));
    assert_eq!(one.out, again.out);
    assert_ne!(one.out, other.out);
    for answer in [one.json(), other.json()] {
        let numbers = |name: &str| -> Vec<f64> {
            column(&answer, name).iter().map(|x| x.as_f64().expect(name)).collect()
        };
        let (speed, length) = (numbers("speed"), numbers("L1"));
        assert!(
            speed.iter().all(|x| (1.0..3.0).contains(x)) && length.iter().all(|x| (0.1..0.12).contains(x))
        );
        for (upper, right) in [(false, false), (false, true), (true, false), (true, true)] {
            let inside = |(x, y): (&f64, &f64)| (*x >= 2.0) == upper && (*y >= 0.11) == right;
            assert_eq!(
                speed.iter().zip(&length).filter(|one| inside(*one)).count(),
                4,
                "quarter {upper} {right}"
            );
        }
        assert_eq!(numbers("L2").iter().filter(|x| **x == 0.4).count(), 8);
        assert_eq!(
            (&answer["provenance"]["options"]["sample"], answer["rows"][15].is_array()),
            (&"sobol:16".into(), true)
        );
    }
}

/// Eight points, each of them a life; the folded parameter varies fastest, so that every point is compiled.
const WORK: [&str; 8] = [
    "--vary",
    "c0=5um..20um:4",
    "--vary",
    "k_wear=1e-8,4e-8",
    "--of",
    "life.mean,life.p10,R1.depth_m,steps",
    "--trajectories",
    "100",
];

#[test]
fn threads_shards_and_interruptions_change_no_byte() {
    let folder = Folder::new("study-same");
    let run = |out: &str, more: &[&str]| study(&[&LIFE, &WORK, &["--out", &folder.path(out)], more, &JSON]);
    let whole = run("whole.csv", &["--threads", "1"]);
    assert_eq!(whole.code, 0, "{}", whole.err);
    let bytes = |out: &str| fs::read(folder.path(out)).expect("rows");
    let expected = bytes("whole.csv");
    let again = run("two.csv", &["--threads", "2"]);
    assert!(again.out == whole.out && bytes("two.csv") == expected);

    // Killed after its first row and before its last, and stopped by a signal.
    for (at, rows) in [1..4, 5..8].into_iter().enumerate() {
        let out = format!("killed{at}.csv");
        let mut child = held_under_way(&folder.path(&out), rows);
        child.kill().expect("it is held");
        child.wait().expect("it is dead");
        let refused = run(&out, &[]);
        assert_eq!(
            (refused.code, &*error(&refused).0),
            (1, "C0004"),
            "what is unfinished is not overwritten"
        );
        let rest = run(&out, &["--resume"]);
        assert!(rest.out == whole.out && bytes(&out) == expected, "killed at {at}: {}", rest.err);
    }
    let path = folder.path("stopped.csv");
    let child = held_under_way(&path, 1..4);
    signal(&child, "-INT");
    signal(&child, "-CONT");
    let stopped = Answer::of(child.wait_with_output().expect("it ends"));
    let (code, message, help) = error(&stopped);
    assert_eq!((stopped.code, &*code), (1, "C0009"));
    assert!(message.contains("of 8 points") && help.contains("--resume"), "{message}; {help}");
    assert!(!fs::exists(&path).expect("a folder"));
    let other = study(&[&LIFE, &WORK, &["--out", &path, "--resume", "--seed", "2"], &JSON]);
    let (code, message, _) = error(&other);
    assert!(code == "C0013" && message.contains("the seed is 2 now, and was 1"), "{message}");
    assert!(run("stopped.csv", &["--resume"]).out == whole.out && bytes("stopped.csv") == expected);
    // Of a finished study the same is said without another row; without --resume it is made anew.
    let kept = bytes("stopped.csv.journal");
    assert_eq!(run("stopped.csv", &["--resume"]).out, whole.out);
    assert!(bytes("stopped.csv.journal") == kept, "a row was run again");
}

/// A study that is held when it has kept so many of its eight rows, however slow or fast the machine is: one that got further before
/// it was looked at begins anew.
fn held_under_way(out: &str, rows: Range<usize>) -> Child {
    let journal = format!("{out}.journal");
    // The line of the study, and the rows.
    let kept = || fs::read_to_string(&journal).map_or(0, |found| found.lines().count().saturating_sub(1));
    for _ in 0..50 {
        let mut child =
            start(&[&["study"][..], &LIFE, &WORK, &["--out", out, "--threads", "1"], &JSON].concat());
        loop {
            let has_ended = child.try_wait().expect("a child").is_some();
            let now = kept();
            assert!(now > 0 || !has_ended, "it ended without a row");
            if has_ended {
                break;
            }
            if now >= rows.start {
                signal(&child, "-STOP");
                if rows.contains(&kept()) {
                    return child;
                }
                child.kill().expect("it is held, or has ended");
                child.wait().expect("it is dead");
                break;
            }
            sleep(Duration::from_millis(1));
        }
        for file in [out, &journal] {
            let _ = fs::remove_file(file);
        }
    }
    panic!("fifty studies kept {} rows before anyone looked", rows.end);
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(sent.expect("kill runs").success());
}

#[test]
fn parts_of_any_number_in_any_order_are_together_the_undivided_study() {
    let folder = Folder::new("study-shards");
    let vary = ["--vary", "speed=1Hz..4Hz:5", "--vary", "L1=110mm,2m", "--of", "peak.R1.F,max.R4.q"];
    let run = |more: &[&str]| study(&[&[RIGID], &vary, more, &JSON]);
    let whole = run(&["--out", &folder.path("whole.csv")]);
    let expected = fs::read(folder.path("whole.csv")).expect("rows");
    let merge = |parts: &[&str], out: &str| {
        let parts: Vec<String> = parts.iter().map(|part| folder.path(part)).collect();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        linkwear(&[&["merge"], &parts[..], &["--out", &folder.path(out)], &JSON].concat())
    };
    for of in [1, 2, 3, 12] {
        let names: Vec<String> = (1..=of).map(|index| format!("{index}of{of}")).collect();
        for (index, name) in names.iter().enumerate() {
            let shard = format!("{}/{of}", index + 1);
            let part = run(&["--shard", &shard, "--out", &folder.path(name), "--threads", "1"]);
            assert_eq!(part.json()["shard"]["of"], of, "{}", part.err);
        }
        let mut given: Vec<&str> = names.iter().rev().map(String::as_str).collect();
        given.push(&names[0]);
        let out = format!("merged{of}.csv");
        let merged = merge(&given, &out);
        assert_eq!((merged.code, &merged.out), (0, &whole.out), "{of}: {}", merged.err);
        assert!(fs::read(folder.path(&out)).expect("rows") == expected, "{of} parts");
    }
    let missing = merge(&["1of3", "3of3"], "x.csv");
    let (code, message, help) = error(&missing);
    assert_eq!((missing.code, &*code, &*message), (1, "C0014", "1 of 3 shards is missing: 2"));
    // The command makes what is missing.
    let command = help.split('`').nth(1).expect("a command");
    assert!(command.contains("--shard 2/3 --out shard2"), "{command}");
    let line = command
        .replacen("linkwear", env!("CARGO_BIN_EXE_linkwear"), 1)
        .replace("shard2", &folder.path("shard2"));
    let made = Command::new("sh").args(["-c", &line]).output().expect("a shell");
    assert!(made.status.success(), "{command}");
    assert_eq!(merge(&["1of3", "3of3", "shard2"], "x.csv").out, whole.out);

    let other = folder.path("other");
    assert_eq!(run(&["--shard", "2/3", "--out", &other, "--tol", "1e-8"]).code, 0);
    let (code, message, _) = error(&merge(&["1of3", "3of3", "other"], "y.csv"));
    assert!(code == "C0014" && message.contains("another study"), "{message}");
    let mixed =
        linkwear(&["merge", &folder.path("1of3"), "src", "--out", &folder.path("y.csv"), "--format", "json"]);
    assert_eq!(mixed.code, 2, "{}", mixed.out);
    let bytes = fs::read(folder.path("1of3")).expect("a part");
    fs::write(folder.path("1of3"), &bytes[..bytes.len() / 2]).expect("a file");
    assert!(error(&merge(&["1of3", "2of3", "3of3"], "y.csv")).1.contains("damaged"));
    assert!(!fs::exists(folder.path("y.csv")).expect("a folder"), "nothing is written");
}

#[test]
fn a_program_gets_the_answer_of_the_command_line_and_may_stop_it() {
    let words = ["--vary", "speed=1Hz..3Hz:3", "--of", "steps,peak.R4.F"].map(str::to_owned);
    let source = read_source(Path::new(RIGID)).expect("a file");
    let studied = ask::study(&words, &source, Watch::NONE).expect("a study");
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    assert_eq!(format!("{:#}\n", studied.json), study(&[&[RIGID], &words, &JSON]).out);
    assert_eq!(studied.result.rows.len(), 3);

    let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
    let stop = |part: f64| if part > 0.5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let stopped = ask::study(&words, &source, Watch::new(&stop)).expect_err("it is stopped");
    assert_eq!(stopped.errors()[0]["code"], "C0009");
    let written = ask::study(&[words, vec!["--out".into(), "x.csv".into()]].concat(), &source, Watch::NONE);
    assert!(written.expect_err("nothing is written").is_usage());
}

#[test]
fn wrong_questions_are_answered_with_what_to_write() {
    let ask = |more: &[&str]| study(&[&[RIGID], more, &JSON]);
    let cases: [(&[&str], i32, &str, &str); 16] = [
        (&["--vary", "sped=1Hz,2Hz", "--of", "steps"], 1, "E0206", "did you mean `speed`"),
        (&["--vary", "speed=1mm..2mm:3", "--of", "steps"], 1, "E0303", "--vary speed=1 mm"),
        (&["--vary", "speed=1..2:3", "--of", "steps"], 1, "E0304", "--vary speed="),
        (&["--vary", "speed=1Hz..2mm:3", "--of", "steps"], 2, "C0001", "differ"),
        (&["--vary", "speed=1Hz..2Hz", "--of", "steps"], 2, "C0001", "no number of values"),
        (&["--vary", "speed=1Hz..2Hz:1", "--of", "steps"], 2, "C0001", "from 2 on"),
        (&["--vary", "speed", "--of", "steps"], 2, "C0001", "NAME=A..B:N"),
        (&["--vary", "speed=10:1", "--of", "steps"], 2, "C0001", "`10:1` is no value"),
        (&["--vary", "speed=1Hz,10:1", "--of", "steps"], 2, "C0001", "or NAME=a,b,c"),
        (
            &["--vary", "speed=1Hz..2Hz:3", "--sample", "sobol:8", "--of", "steps"],
            2,
            "C0001",
            "--sample chooses",
        ),
        (&["--vary", "speed=1Hz..2Hz", "--sample", "sobol:65537", "--of", "steps"], 2, "C0001", "65536"),
        (&["--vary", "speed=1Hz..2Hz", "--sample", "halton:8", "--of", "steps"], 2, "C0001", "sobol:64"),
        (
            &["--vary", "speed=1Hz,2Hz", "--set", "speed=3Hz", "--of", "steps"],
            2,
            "C0001",
            "leave --set or --vary",
        ),
        (&["--vary", "speed=1Hz,2Hz", "--of", "stepps"], 1, "C0006", "did you mean `steps`"),
        (&["--vary", "speed=1Hz,2Hz", "--of", "life.mean"], 1, "C0006", "peak.R1.F"),
        (
            &["--vary", "speed=1Hz..2Hz:1000", "--vary", "L1=1m..2m:1001", "--of", "steps"],
            2,
            "C0001",
            "1000000 are the most",
        ),
    ];
    for (case, exit, code, words) in cases {
        let answer = ask(case);
        let (found, message, help) = error(&answer);
        assert_eq!((answer.code, &*found), (exit, code), "{case:?}: {message}");
        assert!(format!("{message}; {help}").contains(words), "{case:?}: {message}; {help}");
    }
    for usage in [&["--vary", "speed=1Hz,2Hz"][..], &["--of", "steps"]] {
        assert_eq!(ask(usage).code, 2, "{usage:?}");
    }
    let near = study(&[&LIFE, &["--vary", "c0=5um,6um", "--of", "life.maen"], &JSON]);
    assert!(error(&near).2.contains("did you mean `life.mean`"));
}
