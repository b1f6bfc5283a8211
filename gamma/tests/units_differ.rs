//! Whether units differ: how often the test says so where they do not, and how often the interval of their variation holds it.

#![allow(clippy::disallowed_methods, reason = "nothing here has to have the same bits on every machine")]

mod runs;

use linkwear_gamma::data::{Increment, Observations};
use linkwear_gamma::fit::{Model, estimate_units};
use linkwear_gamma::process::{Gamma, InverseGaussian, Process, Wiener};
use linkwear_gamma::random::Stream;
use runs::runs_or;

/// Units of equal increments of a process over exposure 1 each, all units alike, or with such a coefficient of variation.
fn drawn(
    process: &dyn Process,
    (logs, cv): ([f64; 2], Option<f64>),
    (units, readings): (usize, usize),
    run: u64,
) -> Observations {
    let (mut stream, mut of_units) = (Stream::new(31, run, 0), Stream::new(31, run, 1));
    let mut own = logs;
    let one = |at: usize| {
        if at.is_multiple_of(readings) {
            let effect = process.random_effect().expect("a law");
            own = cv.map_or(logs, |cv| effect.draw(logs, cv, &mut of_units));
        }
        Increment {
            unit: at / readings,
            from: (at % readings) as f64,
            to: (at % readings + 1) as f64,
            wear: process.draw(own, 1.0, &mut stream).max(if process.is_increasing() {
                f64::MIN_POSITIVE
            } else {
                f64::MIN
            }),
            ln_covariates: Vec::new(),
            row: 0,
            ..Increment::default()
        }
    };
    let increments = (0..units * readings).map(one).collect();
    Observations { units: (0..units).map(|unit| unit.to_string()).collect(), increments }
}

/// Runs of a cell: parts of p-values below 1, 5 and 10 %, asymptotic ones below 5 %, and parts on the boundary and refused.
fn sizes(
    process: &'static dyn Process,
    logs: [f64; 2],
    cell: (usize, usize),
    power_law: bool,
    runs: u64,
) -> [f64; 6] {
    let model = Model { process, power_law, ..Model::default() };
    let mut counts = [0.0; 6];
    for run in 0..runs {
        let Ok(found) = estimate_units(&drawn(process, (logs, None), cell, run), &model) else {
            counts[5] += 1.0;
            continue;
        };
        let (p, asymptotic) = (found.test.p_value, found.test.asymptotic_p);
        let seen = [p < 0.01, p < 0.05, p < 0.1, asymptotic < 0.05, found.boundary, false];
        counts.iter_mut().zip(seen).for_each(|(count, seen)| *count += f64::from(u8::from(seen)));
    }
    counts.map(|count| 100.0 * count / runs as f64)
}

const CELLS: [(usize, usize); 4] = [(5, 10), (10, 9), (15, 16), (50, 10)];

#[test]
fn the_interval_of_few_jumpy_units_ends_where_drawn_data_fall_as_far() {
    let law = [0.3_f64.ln(); 2];
    let data = drawn(&Gamma, (law, Some(0.6)), (5, 10), 1);
    let found = estimate_units(&data, &Model::default()).expect("a fit");
    let ends = found.cv_interval(&data, 0.95).expect("an interval");
    let holds = |cv: f64| found.holds_cv(&data, cv, 0.95).expect("a test");
    // 199 drawn data tell an end to some percent.
    assert!(holds(ends.high / 1.1) && !holds(1.1 * ends.high), "{ends:?}");
    assert!(ends.low == 0.0 || (holds(1.2 * ends.low) && !holds(ends.low / 1.2)), "{ends:?}");
}

/// Gamma processes by the shape of an increment, the others by its coefficient of variation.
fn processes() -> Vec<(String, &'static dyn Process, [f64; 2])> {
    let gamma = [0.3_f64, 2.0, 20.0]
        .map(|shape| (format!("gamma, shape {shape}"), &Gamma as &dyn Process, [shape.ln(), shape.ln()]));
    let normal =
        [0.5_f64].map(|cv| (format!("wiener, variation {cv}"), &Wiener as &dyn Process, [0.0, cv.ln()]));
    let inverse = [1.0_f64, 0.3].map(|cv| {
        (format!("inverse Gaussian, variation {cv}"), &InverseGaussian as &dyn Process, [0.0, -2.0 * cv.ln()])
    });
    gamma.into_iter().chain(normal).chain(inverse).collect()
}

#[test]
#[ignore = "minutes; run with --release --ignored --nocapture"]
fn the_test_of_no_difference_is_wrong_as_often_as_it_says() {
    println!(
        "| process | units x readings | 1 % | 5 % | 10 % | 5 % asymptotic | boundary | refused |\n|---|---|---|---|---|---|---|---|"
    );
    let runs = runs_or(4000);
    for (name, process, logs) in processes() {
        for cell in CELLS {
            let found = sizes(process, logs, cell, false, runs).map(|part| format!("{part:.2}"));
            println!("| {name} | {} x {} | {} |", cell.0, cell.1, found.join(" | "));
        }
    }
}

/// How many intervals of `runs` hold the coefficient of variation of units, and how many there are.
fn held(process: &'static dyn Process, law: ([f64; 2], f64), cell: (usize, usize), runs: u64) -> [usize; 2] {
    let model = Model { process, ..Model::default() };
    let mut count = [0; 2];
    for run in 0..runs {
        let data = drawn(process, (law.0, Some(law.1)), cell, run);
        let is_held = estimate_units(&data, &model).and_then(|found| found.holds_cv(&data, law.1, 0.95));
        let Ok(is_held) = is_held else { continue };
        count[0] += usize::from(is_held);
        count[1] += 1;
    }
    count
}

#[test]
fn intervals_of_few_units_hold_their_variation() {
    let [held, of] = held(&Gamma, ([2.0_f64.ln(); 2], 0.5), (10, 9), 100);
    // Three standard errors below 95 %; the chi-square law has 92 %.
    assert!(
        of >= 99 && held as f64 >= 100.0 * (0.95 - 3.0 * (0.95_f64 * 0.05 / 100.0).sqrt()),
        "{held} of {of}"
    );
}

/// `CELL=0` does five units alone, `PROCESS=4` the inverse Gaussian process of variation 1.
#[test]
#[ignore = "minutes; run with --release --ignored --nocapture"]
fn table_of_coverages_of_variation() {
    println!(
        "| process | units x readings | variation of units 0.1 | 0.3 | 0.6 | samples |\n|---|---|---|---|---|---|"
    );
    let runs = runs_or(1000);
    let is_asked = |what: &str, at: usize| {
        let asked = std::env::var(what).ok().and_then(|asked| asked.parse::<usize>().ok());
        asked.is_none_or(|asked| asked == at)
    };
    for (number, (name, process, logs)) in processes().into_iter().enumerate() {
        for (at, cell) in CELLS.into_iter().enumerate() {
            if !is_asked("PROCESS", number) || !is_asked("CELL", at) {
                continue;
            }
            let part = [0.1, 0.3, 0.6].map(|cv| {
                let [held, of] = held(process, (logs, cv), cell, runs);
                let missing = if of < runs as usize { format!(" of {of}") } else { String::new() };
                format!("{:.1}{missing}", 100.0 * held as f64 / of as f64)
            });
            println!("| {name} | {} x {} | {} | {runs} |", cell.0, cell.1, part.join(" | "));
        }
    }
}
