//! Shipped files with errors in them: never a panic, never an endless run, never a success over impossible numbers.
//!
//! `cargo test --release --test mutants -- --ignored --nocapture` tries 10,000; `LINKWEAR_MUTANTS=from..to` tries these.
//! Where bodies are rigid and joints ideal, a success must also agree with the independent model (crate `linkwear-oracle`).
//! What fails stays in `target/tmp/mutants` under its number.
#![cfg(unix)]

#[path = "../agreement/mod.rs"]
mod agreement;
#[path = "../command/mod.rs"]
mod command;
mod judge;
mod mutation;
mod program;

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use mutation::{Dice, mutate};
use program::{Ended, Patience, run};

/// How long each part may take, and how often a mutant that wears is lived.
struct Study {
    check: Patience,
    run: Patience,
    life: Patience,
}

fn shipped() -> Vec<PathBuf> {
    let paths =
        fs::read_dir("mechanisms").expect("the mechanisms").map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    paths.sort();
    paths
}

/// What became of one mutant, in a word; or what may not be.
fn try_one(
    number: u64,
    files: &[PathBuf],
    folder: &Path,
    study: &Study,
) -> Result<Vec<&'static str>, String> {
    let mut dice = Dice::new(number);
    let original = &files[dice.below(files.len())];
    let text = mutate(&fs::read_to_string(original).expect("a file"), &mut dice);
    let (file, table) = (folder.join(format!("{number}.toml")), folder.join(format!("{number}.csv")));
    fs::write(&file, &text).expect("a file");
    let (name, out) = (file.to_str().expect("UTF-8"), table.to_str().expect("UTF-8"));
    let mut words = Vec::new();
    let fault = (|| {
        let named = |command: &'static str| move |fault: String| format!("{command}: {fault}");
        let checked = match run(&["check", name, "--format", "json"], study.check).map_err(named("check"))? {
            Ended::Refused => {
                words.push("refused by check");
                return Ok(());
            }
            Ended::Interrupted => return Err("check had to be interrupted".to_owned()),
            Ended::Done(answer) => answer,
        };
        words.push("taken by check");
        let arguments = ["simulate", name, "--out", out, "--format", "json"];
        match run(&arguments, study.run).map_err(named("simulate"))? {
            Ended::Refused => words.push("run refused"),
            Ended::Interrupted => words.push("run interrupted"),
            Ended::Done(answer) => {
                judge::simulated(&answer, out, name, judge::is_plausible(&checked))
                    .map_err(named("simulate"))?;
                words.push("run done");
            }
        }
        if dice.below(10) == 0 && text.contains("[wear.") {
            let arguments = ["life", name, "--trajectories", "20", "--format", "json"];
            match run(&arguments, study.life).map_err(named("life"))? {
                Ended::Refused => words.push("life refused"),
                Ended::Interrupted => words.push("life interrupted"),
                Ended::Done(answer) => {
                    judge::lived(&answer).map_err(named("life"))?;
                    words.push("life done");
                }
            }
        }
        Ok(())
    })();
    let _ = fs::remove_file(&table);
    let _ = fs::remove_file(folder.join(format!("{number}.partial.csv")));
    if fault.is_ok() {
        let _ = fs::remove_file(&file);
    }
    fault.map(|()| words).map_err(|fault| format!("{number} ({}): {fault}", original.display()))
}

/// Tries these on all processors.
fn try_all(numbers: Range<u64>, study: &Study) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutants");
    fs::create_dir_all(&folder).expect("a folder");
    let files = shipped();
    let next = AtomicU64::new(numbers.start);
    let (counts, faults) = (Mutex::new(BTreeMap::new()), Mutex::new(Vec::new()));
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(number) =
                    Some(next.fetch_add(1, Ordering::Relaxed)).filter(|number| *number < numbers.end)
                {
                    match try_one(number, &files, &folder, study) {
                        Ok(words) => {
                            let mut counts = counts.lock().expect("counts");
                            words.into_iter().for_each(|word| *counts.entry(word).or_insert(0) += 1);
                        }
                        Err(fault) => {
                            eprintln!("{fault}");
                            faults.lock().expect("faults").push(fault);
                        }
                    }
                    if number % 500 == 499 {
                        eprintln!("{} tried", number + 1 - numbers.start);
                    }
                }
            });
        }
    });
    let (counts, faults): (BTreeMap<&str, u64>, Vec<String>) =
        (counts.into_inner().expect("counts"), faults.into_inner().expect("faults"));
    eprintln!("{counts:?}, {} faults", faults.len());
    assert!(
        faults.is_empty(),
        "{} of {} mutants:\n{}",
        faults.len(),
        numbers.end - numbers.start,
        faults.join("\n")
    );
    // Of files with one to three changes some must run and some be refused, or nothing was tried.
    let both = ["refused by check", "run done"].iter().all(|word| counts.contains_key(word));
    assert!(both, "{counts:?}");
}

/// On a machine full of other work: an end is asked for, not when.
#[test]
fn three_hundred_mutants_are_right_or_refused() {
    let patience =
        |run| Patience { run: Duration::from_secs(run), standstill: None, end: Duration::from_secs(60) };
    try_all(0..300, &Study { check: patience(120), run: patience(1), life: patience(3) });
}

#[test]
#[ignore = "an hour: cargo test --release --test mutants -- --ignored --nocapture"]
fn ten_thousand_mutants_are_right_or_refused() {
    let numbers = std::env::var("LINKWEAR_MUTANTS").ok().and_then(|range| {
        let (from, to) = range.split_once("..")?;
        Some(from.parse().ok()?..to.parse().ok()?)
    });
    let seconds = Duration::from_secs;
    let patience = |run| Patience { run: seconds(run), standstill: Some(seconds(30)), end: seconds(5) };
    // Checks end within a minute and show no progress.
    let check = Patience { standstill: None, ..patience(60) };
    try_all(numbers.unwrap_or(0..10_000), &Study { check, run: patience(5), life: patience(90) });
}
