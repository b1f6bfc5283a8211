//! How well the second half of each unit's wear is told from the first half of it and all of the other units.

#![allow(clippy::disallowed_methods, reason = "nothing here has to have the same bits on every machine")]

use linkwear_gamma::FitFile;
use linkwear_gamma::data::{Gauge, Increment, Observations, Reading};
use linkwear_gamma::fit::{Fit, Model, estimate, estimate_units};
use linkwear_gamma::life::Sample;
use linkwear_gamma::metrics::{Coverage, coverage};
use linkwear_gamma::process::{Gamma, InverseGaussian, Process, Wiener};
use linkwear_gamma::random::{StandardNormal, Stream};
use rand::RngExt;

#[path = "units_second_half/gauge.rs"]
mod gauge;

/// Parameter sets of the fits whose units are alike.
const DRAWN: u64 = 500;
/// Cells of the grid over wear that a CRPS is summed on.
const CELLS: usize = 300;

/// Data with the columns of unit, exposure and wear, and of a covariate if there is one.
struct Set {
    name: &'static str,
    table: &'static str,
    columns: [usize; 3],
    covariate: Option<usize>,
    scale: f64,
    power_law: bool,
    from_zero: bool,
    /// Units that shrink, which exact increments cannot.
    left_out: &'static [&'static str],
    /// Readings with an error, so that some fall: for a Wiener process, and for a Gamma process with a gauge.
    has_errors: bool,
}

const SETS: [Set; 4] = [
    Set {
        name: "GaAs lasers",
        table: include_str!("data/gaas_lasers.csv"),
        columns: [0, 1, 2],
        covariate: None,
        scale: 1e-3,
        power_law: false,
        from_zero: false,
        left_out: &[],
        has_errors: false,
    },
    Set {
        name: "fatigue cracks",
        table: include_str!("data/fatigue_cracks.csv"),
        columns: [0, 1, 3],
        covariate: None,
        scale: 1.0,
        power_law: true,
        from_zero: false,
        left_out: &[],
        has_errors: false,
    },
    Set {
        name: "sliding wear, load as covariate",
        table: include_str!("data/sliding_wear.csv"),
        columns: [0, 2, 3],
        covariate: Some(1),
        scale: 1.0,
        power_law: true,
        from_zero: true,
        left_out: &["104", "105"],
        has_errors: false,
    },
    Set {
        name: "sliding wear as read, load as covariate",
        table: include_str!("data/sliding_wear.csv"),
        columns: [0, 2, 3],
        covariate: Some(1),
        scale: 1.0,
        power_law: true,
        from_zero: true,
        left_out: &[],
        has_errors: true,
    },
];

fn readings(set: &Set) -> Vec<Reading> {
    let lines = set.table.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1);
    let reading = |(at, line): (usize, &str)| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells[at].parse::<f64>().expect("a number");
        Reading {
            unit: cells[set.columns[0]].to_owned(),
            exposure: set.scale * number(set.columns[1]),
            wear: number(set.columns[2]),
            covariates: set.covariate.map(number).into_iter().collect(),
            row: at + 1,
            ..Reading::default()
        }
    };
    lines.map(reading).filter(|one| !set.left_out.contains(&&*one.unit)).collect()
}

fn observed(set: &Set) -> Observations {
    let gauge = if set.has_errors { Gauge::Noisy } else { Gauge::Exact };
    Observations::new(&readings(set), set.from_zero, gauge).expect("growing wear")
}

/// One possible law of the growth: process, logarithms over exposure 1, variation of the unit's own parameter (0: known), exposure.
struct Law {
    process: &'static dyn Process,
    logs: [f64; 2],
    cv: f64,
    exposure: f64,
    weight: f64,
}

impl Law {
    fn below(&self, wear: f64) -> f64 {
        match self.process.random_effect().filter(|_| self.cv > 0.0) {
            Some(effect) => effect.tails(self.logs, self.cv, self.exposure, wear).0,
            None => self.process.cumulative(self.logs, self.exposure, wear),
        }
    }

    fn density(&self, wear: f64) -> f64 {
        let powers = self.process.exposure_powers();
        let at = [0, 1].map(|k: usize| self.logs[k] + powers[k] * self.exposure.ln());
        match self.process.random_effect().filter(|_| self.cv > 0.0) {
            Some(effect) => effect.ln_density(at, self.cv, wear).exp(),
            None => self.process.ln_density(at, wear).exp(),
        }
    }
}

/// The possible laws of the growth over `later`, after `first` of the same unit, both at the load of the fit's `values`.
fn laws(
    fit: &Fit,
    file: &FitFile,
    values: &[(String, f64)],
    first: &[Increment],
    later: &[Increment],
) -> Vec<Law> {
    let process = fit.model.process;
    let informed = file.informed(values).expect("a fit");
    let sets: Vec<(Vec<f64>, f64)> = match informed.sample() {
        Sample::Sets(sets) => sets.iter().map(|set| (set.logs.clone(), set.weight)).collect(),
        _ => {
            // The normal law of the logarithms; its factor by Cholesky.
            let centre = fit.parameters();
            let covariance = fit.covariance();
            let size = centre.len();
            let scaled = |i: usize, j: usize| covariance[i][j] / (centre[i] * centre[j]);
            let mut lower = vec![vec![0.0; size]; size];
            for i in 0..size {
                for j in 0..=i {
                    let inner: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                    let rest: f64 = scaled(i, j) - inner;
                    lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
                }
            }
            let draw = |at: u64| {
                let mut stream = Stream::new(5, at, 0);
                let z: Vec<f64> = (0..size).map(|_| stream.sample(StandardNormal)).collect();
                let step = |i: usize| -> f64 { lower[i].iter().zip(&z).map(|(a, b)| a * b).sum() };
                ((0..size).map(|i| centre[i].ln() + step(i)).collect(), 1.0 / DRAWN as f64)
            };
            (0..DRAWN).map(draw).collect()
        }
    };
    let differs = file.units_differ();
    let exposure = |logs: &[f64], part: &[Increment]| -> f64 {
        let exponent = if fit.model.power_law { logs[2].exp() } else { 1.0 };
        part.iter().map(|one| one.to.powf(exponent) - one.from.powf(exponent)).sum()
    };
    let law = |(logs, weight): (Vec<f64>, f64)| {
        let common = [logs[0], logs[1]];
        let (logs_of_unit, cv) = match process.random_effect().filter(|_| differs) {
            Some(effect) => {
                let wear = first.iter().map(|one| one.wear).sum();
                effect.after(common, logs[logs.len() - 1].exp(), exposure(&logs, first), wear)?
            }
            None => (common, 0.0),
        };
        Some(Law { process, logs: logs_of_unit, cv, exposure: exposure(&logs, later), weight })
    };
    sets.into_iter().filter_map(law).collect()
}

/// Probability integral transform, minus ln density, CRPS.
fn scores(laws: &[Law], truth: f64) -> [f64; 3] {
    let all: f64 = laws.iter().map(|law| law.weight).sum();
    let below = |wear: f64| laws.iter().map(|law| law.weight * law.below(wear)).sum::<f64>() / all;
    let density = laws.iter().map(|law| law.weight * law.density(truth)).sum::<f64>() / all;
    let mut end = truth;
    while below(end) < 1.0 - 1e-7 {
        end *= 1.2;
    }
    let width = end / CELLS as f64;
    let crps: f64 = (0..CELLS)
        .map(|at| {
            let wear = width * (at as f64 + 0.5);
            let miss = below(wear) - f64::from(u8::from(wear >= truth));
            miss * miss * width
        })
        .sum();
    [below(truth), -density.ln(), crps]
}

/// Transforms and scores of every unit of a set by one model.
fn course(set: &Set, process: &'static dyn Process, differ: bool) -> Vec<[f64; 3]> {
    let data = observed(set);
    let covariates = usize::from(set.covariate.is_some());
    let model = Model { process, power_law: set.power_law, covariates, ..Model::default() };
    let of_unit = |unit: usize| {
        let own: Vec<&Increment> = data.increments.iter().filter(|one| one.unit == unit).collect();
        let (first, later) = own.split_at(own.len() / 2);
        let [first, later] =
            [first, later].map(|part| part.iter().map(|one| (*one).clone()).collect::<Vec<_>>());
        let known = data.increments.iter().filter(|one| one.unit != unit || first.contains(one));
        let known = Observations { units: data.units.clone(), increments: known.cloned().collect() };
        let names: Vec<String> = set.covariate.iter().map(|_| "load".to_owned()).collect();
        let (fit, file) = if differ {
            let found = estimate_units(&known, &model).expect("a maximum");
            let file = FitFile::new(&found.fit, &known, &names, ("um", "h"), false);
            (found.fit.clone(), file.with_units(&found, &vec![0.0; known.units.len()], &known))
        } else {
            let fit = estimate(&known, &model).expect("a maximum");
            let file = FitFile::new(&fit, &known, &names, ("um", "h"), false);
            (fit, file)
        };
        let load =
            names.iter().map(|name| (name.clone(), later[0].ln_covariates[0].exp())).collect::<Vec<_>>();
        let truth = later.iter().map(|one| one.wear).sum();
        scores(&laws(&fit, &file, &load, &first, &later), truth)
    };
    (0..data.units.len()).map(of_unit).collect()
}

const MODELS: [(&dyn Process, bool); 6] = [
    (&Gamma, false),
    (&Gamma, true),
    (&InverseGaussian, false),
    (&InverseGaussian, true),
    (&Wiener, false),
    (&Wiener, true),
];

/// Name, how units are taken, and the scores of every unit, of all models that take the data.
fn courses(set: &Set) -> Vec<(String, &'static str, Vec<[f64; 3]>)> {
    let takes = |process: &dyn Process| !(set.has_errors && process.is_increasing());
    let own = MODELS.into_iter().filter(|(process, _)| takes(*process));
    let mut all: Vec<_> = own
        .map(|(process, differ)| {
            let how = if differ { "differ" } else { "alike" };
            (process.title().to_owned(), how, course(set, process, differ))
        })
        .collect();
    if set.has_errors {
        let error = gauge::error_of_first_halves(set);
        all.push((format!("Gamma, gauge error {error}"), "alike", gauge::course(set, error)));
    }
    all
}

/// Sets whose name has what `ONLY` says.
fn asked() -> impl Iterator<Item = &'static Set> {
    let only = std::env::var("ONLY").unwrap_or_default();
    SETS.iter().filter(move |set| set.name.contains(&only))
}

/// What `benches/peers/second_half.py` compares with a peer.
#[test]
#[ignore = "a minute; run with --release --ignored --nocapture"]
fn scores_of_every_unit() {
    for set in asked() {
        for (process, how, rows) in courses(set) {
            for (unit, [below, log, crps]) in rows.into_iter().enumerate() {
                println!("score;{};{process} {how};{unit};{below};{log};{crps}", set.name);
            }
        }
    }
}

#[test]
#[ignore = "a minute; run with --release --ignored --nocapture"]
fn the_second_half_of_each_unit_is_told_by_its_first() {
    println!(
        "| data | process | units | in 50 % | in 80 % | in 95 % | log score | CRPS | worse than the best by, in standard errors |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for set in asked() {
        let found = courses(set);
        let mean =
            |rows: &[[f64; 3]], of: usize| rows.iter().map(|row| row[of]).sum::<f64>() / rows.len() as f64;
        let best = [1, 2].map(|of: usize| {
            found.iter().min_by(|a, b| mean(&a.2, of).total_cmp(&mean(&b.2, of))).expect("models").2.clone()
        });
        for (process, how, rows) in &found {
            let held = |level: f64| {
                let inside = |row: &[f64; 3]| (0.5 - 0.5 * level, 0.5 + 0.5 * level, row[0]);
                let intervals: Vec<_> = rows.iter().map(inside).collect();
                let Coverage { held, interval: (low, high), .. } = coverage(&intervals).expect("intervals");
                format!("{held} of {} ({:.0} to {:.0} %)", rows.len(), 100.0 * low, 100.0 * high)
            };
            // Paired differences to the best and their standard error.
            let behind = |of: usize| {
                let differences: Vec<f64> =
                    rows.iter().zip(&best[of - 1]).map(|(a, b)| a[of] - b[of]).collect();
                let n = differences.len() as f64;
                let mean = differences.iter().sum::<f64>() / n;
                let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0);
                if mean == 0.0 { "best".to_owned() } else { format!("{:.1}", mean / (variance / n).sqrt()) }
            };
            println!(
                "| {} | {} | {} | {} | {} | {} | {:.3} | {:.4} | {}, {} |",
                set.name,
                process,
                how,
                held(0.5),
                held(0.8),
                held(0.95),
                mean(rows, 1),
                mean(rows, 2),
                behind(1),
                behind(2)
            );
        }
    }
}
