//! Intervals of parameters from readings as the field has them: of units that entered below a limit, of parts that were replaced or
//! reground, of bounds, of a gauge that errs and rounds.

#![allow(clippy::disallowed_methods, reason = "nothing here has to have the same bits on every machine")]

mod runs;

use linkwear_gamma::data::{Gauge, Observations, Reading, Reset, Rounding, Seen};
use linkwear_gamma::fit::{Interval, Model, estimate, estimate_units, profile_interval};
use linkwear_gamma::process::{Gamma, Process};
use linkwear_gamma::random::{StandardNormal, Stream};
use rand::RngExt;
use runs::runs_or;

/// How a population is read. Increments over exposure 1 have the mean 1.
#[derive(Clone, Copy)]
struct Field {
    name: &'static str,
    shape: f64,
    /// Coefficient of variation of the units' rates.
    cv: f64,
    units: usize,
    readings: usize,
    /// Wear at the first reading that units entered below, and whether they are followed from new.
    entered: Option<(f64, bool)>,
    /// What is done to a part after its readings, by their numbers from 1.
    resets: &'static [(usize, Reset)],
    /// Range of the gauge.
    range: Option<[f64; 2]>,
    rounding: Option<Rounding>,
    power_law: bool,
}

const PLAIN: Field = Field {
    name: "",
    shape: 2.0,
    cv: 0.0,
    units: 15,
    readings: 6,
    entered: None,
    resets: &[],
    range: None,
    rounding: None,
    power_law: false,
};

const KNOWN: &[(usize, Reset)] = &[(2, Reset::Reground(Some(0.25))), (4, Reset::Replaced(Some(0.0)))];
const UNKNOWN: &[(usize, Reset)] = &[(2, Reset::Reground(None)), (4, Reset::Reground(None))];
const EXPONENT: f64 = 1.3;

/// Per cent of intervals that hold each parameter, and of samples that give them.
fn parts(found: &[Vec<bool>], runs: u64) -> (Vec<f64>, f64) {
    let count = found.len() as f64;
    let size = found.first().map_or(0, Vec::len);
    let of = |at: usize| 100.0 * found.iter().filter(|all| all[at]).count() as f64 / count;
    ((0..size).map(of).collect(), 100.0 * count / runs as f64)
}

impl Field {
    fn logs(&self) -> [f64; 2] {
        [self.shape.ln(), self.shape.ln()]
    }

    /// Readings of one unit; None if it does not enter.
    fn unit(&self, unit: usize, stream: &mut Stream) -> Option<Vec<Reading>> {
        let exponent = if self.power_law { EXPONENT } else { 1.0 };
        let own = match Gamma.random_effect().filter(|_| self.cv > 0.0) {
            Some(effect) => effect.draw(self.logs(), self.cv, stream),
            None => self.logs(),
        };
        let (mut wear, mut age) = (0.0, 0.0_f64);
        let mut rows = Vec::new();
        for at in 1..=self.readings {
            wear += Gamma.draw(own, (age + 1.0).powf(exponent) - age.powf(exponent), stream);
            age += 1.0;
            if at == 1 && self.entered.is_some_and(|(limit, _)| wear >= limit) {
                return None;
            }
            let reset = self.resets.iter().find(|(after, _)| *after == at).map(|(_, reset)| *reset);
            let (seen, read) = self.read(wear, stream);
            let entered_below = self.entered.map(|(limit, _)| limit);
            let row = rows.len() + 2;
            let exposure = at as f64;
            let unit = unit.to_string();
            rows.push(Reading {
                unit,
                exposure,
                wear: read,
                row,
                seen,
                reset,
                entered_below,
                ..Reading::default()
            });
            match reset {
                Some(Reset::Replaced(level)) => (wear, age) = (level.unwrap_or(0.1), 0.0),
                Some(Reset::Reground(level)) => wear = level.unwrap_or(0.1),
                None if seen == Seen::AtLeast => break,
                None => {}
            }
        }
        Some(rows)
    }

    fn read(&self, wear: f64, stream: &mut Stream) -> (Seen, f64) {
        if let Some(Rounding { step, error }) = self.rounding {
            let read = wear + error * stream.sample::<f64, _>(StandardNormal);
            return (Seen::Exact, (read / step).round() * step);
        }
        match self.range {
            Some([low, _]) if wear < low => (Seen::Below, low),
            Some([_, high]) if wear >= high => (Seen::AtLeast, high),
            _ => (Seen::Exact, wear),
        }
    }

    fn sample(&self, run: u64) -> Option<Observations> {
        let mut stream = Stream::new(52, run, 0);
        let mut readings = Vec::new();
        for unit in 0..self.units {
            readings.extend(std::iter::repeat_with(|| self.unit(unit, &mut stream)).flatten().next()?);
        }
        let from_zero = self.entered.is_none_or(|(_, from_new)| from_new);
        let gauge = self.rounding.map_or(Gauge::Exact, Gauge::Resolution);
        Observations::new(&readings, from_zero, gauge).ok()
    }

    /// Which parameters lie in their intervals; None where there is no fit or no interval.
    fn covered(&self, run: u64, mends: bool) -> Option<Vec<bool>> {
        let mut data = self.sample(run)?;
        if !mends {
            data.increments.retain(|one| one.is_exact());
        }
        let model = Model { resolution: self.rounding, power_law: self.power_law, ..Model::default() };
        let mut truth = vec![self.shape, self.shape];
        truth.extend(self.power_law.then_some(EXPONENT));
        let held = |interval: Interval, at: usize| interval.contains(truth[at]);
        if self.cv == 0.0 {
            let fit = estimate(&data, &model).ok()?;
            return (0..truth.len())
                .map(|at| profile_interval(&fit, &data, at, 0.95).ok().map(|interval| held(interval, at)))
                .collect();
        }
        let found = estimate_units(&data, &model).ok()?;
        let mut all: Vec<bool> = (0..2)
            .map(|at| profile_interval(&found.fit, &data, at, 0.95).ok().map(|interval| held(interval, at)))
            .collect::<Option<_>>()?;
        all.push(found.cv_interval(&data, 0.95).ok()?.contains(self.cv));
        Some(all)
    }

    /// Per cent of intervals that hold each parameter, and of samples that give them.
    fn coverage(&self, runs: u64, mends: bool) -> (Vec<f64>, f64) {
        let mut found: Vec<Vec<bool>> = Vec::new();
        for run in 0..runs {
            found.extend(self.covered(run, mends));
            // A long study that is broken off has counted something.
            if (run + 1) % 200 == 0 && run + 1 < runs {
                let (held, fitted) = parts(&found, run + 1);
                eprintln!("{}: {held:.1?} of {} samples, {fitted:.1} with intervals", self.name, run + 1);
            }
        }
        parts(&found, runs)
    }
}

const TRUNCATED: [Field; 3] = [
    Field {
        name: "entered below 0.6, from new",
        entered: Some((0.6, true)),
        units: 30,
        readings: 3,
        ..PLAIN
    },
    Field {
        name: "entered below 0.8, units differ, from new",
        entered: Some((0.8, true)),
        cv: 0.5,
        units: 40,
        shape: 4.0,
        ..PLAIN
    },
    Field {
        name: "entered below 0.8, units differ, seen from entry",
        entered: Some((0.8, false)),
        cv: 0.5,
        units: 40,
        shape: 4.0,
        ..PLAIN
    },
];

fn others() -> Vec<Field> {
    let gauge = Some(Rounding { step: 0.5, error: 0.25 });
    vec![
        Field { name: "known resets", resets: KNOWN, ..PLAIN },
        Field { name: "known resets, power law", resets: KNOWN, power_law: true, ..PLAIN },
        Field { name: "unknown resets", resets: UNKNOWN, ..PLAIN },
        Field { name: "range 0.2 to 4", range: Some([0.2, 4.0]), ..PLAIN },
        Field {
            name: "range, units differ",
            range: Some([0.2, 4.0]),
            cv: 0.5,
            units: 40,
            shape: 4.0,
            ..PLAIN
        },
        Field { name: "gauge", rounding: gauge, ..PLAIN },
        Field { name: "gauge, unknown resets", rounding: gauge, resets: UNKNOWN, ..PLAIN },
    ]
}

#[test]
fn intervals_count_what_was_selected_and_are_wrong_without() {
    for field in [TRUNCATED[0], Field { name: "range", range: Some([0.1, 2.5]), ..PLAIN }] {
        let (found, fitted) = field.coverage(150, true);
        // Three standard errors of 150 samples, and 2 % of the interval's own error of order 1/n.
        let allowed = 100.0 * (3.0 * (0.0475_f64 / 150.0).sqrt() + 0.02);
        assert!(
            fitted > 99.0 && found.iter().all(|held| (held - 95.0).abs() < allowed),
            "{}: {found:?}",
            field.name
        );
        let (bare, _) = field.coverage(150, false);
        assert!(bare.iter().any(|held| *held < 85.0), "{}: {bare:?}", field.name);
    }
}

#[test]
fn a_likelihood_that_stays_flat_leaves_an_end_open() {
    for (field, run, is_open) in [(TRUNCATED[1], 1, true), (TRUNCATED[1], 0, false), (TRUNCATED[2], 3, true)]
    {
        let data = field.sample(run).expect("units enter");
        let found = estimate_units(&data, &Model::default()).expect("fits");
        let cv = found.cv_interval(&data, 0.95).expect("an interval");
        let [alpha, beta] = [0, 1].map(|at| profile_interval(&found.fit, &data, at, 0.95).expect("interval"));
        assert_eq!(cv.high == f64::INFINITY, is_open, "{cv:?}");
        // Slow units say nothing of how fast the others are: no mean rate alpha / beta is too large then.
        assert_eq!(beta.low == 0.0, is_open, "{beta:?}");
        let whole = [alpha.low, alpha.high, beta.high, cv.low];
        assert!(whole.iter().all(|end| end.is_finite() && *end > 0.0), "{whole:?}");
    }
}

#[test]
#[ignore = "minutes to an hour: the table of docs/readings.md"]
fn table_of_coverages_of_field_data() {
    let runs = runs_or(2000);
    let only = std::env::var("ONLY").unwrap_or_default();
    println!("| data | alpha | beta | exponent or cv | with intervals | runs |\n|---|---|---|---|---|---|");
    for field in TRUNCATED.into_iter().chain(others()).filter(|field| field.name.contains(&only)) {
        // A gauge that errs costs a thousand times as much.
        let runs = if field.rounding.is_some() { runs / 10 } else { runs };
        for mends in [true, false] {
            if !mends && field.entered.is_none() && field.range.is_none() {
                continue;
            }
            let (found, fitted) = field.coverage(runs, mends);
            let held = |at: usize| found.get(at).map_or_else(String::new, |held| format!("{held:.1}"));
            let name = if mends { field.name.to_owned() } else { format!("{}, not counted", field.name) };
            println!("| {name} | {} | {} | {} | {fitted:.1} | {runs} |", held(0), held(1), held(2));
        }
    }
}
