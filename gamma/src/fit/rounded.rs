//! Likelihood of readings that are the nearest multiple of a gauge's step, perhaps with a normal error before. In: increments of
//! readings, parameters. Out: its logarithm, and transforms for the goodness of fit. Never knows how it is maximised.
//!
//! Neighbouring increments share the rounding error of the reading between them, so a unit's readings are taken together:
//! its true wear is a Markov chain that passes through the windows of its readings, [r - R/2, r + R/2], with an error wider by
//! five of its standard deviations on either side. Each window is divided evenly; within a part wear counts as spread evenly. The
//! chance to go from a part to a part is then an exact second difference of the integral of the distribution function, however
//! singular the density is: no mass is lost or gained. With an error each part is weighed by the chance of the reading from it.
//! A reading at exposure 0 is exact; a later first reading may be anywhere in its window.

use std::collections::HashMap;

use rand::RngExt;
use rand::distr::Open01;

use crate::data::{Increment, Rounding};
use crate::process::Process;
use crate::random::Stream;
use crate::special::normal_cdf;

/// Standard deviations of the error beyond which no reading lies: 6e-7 of them do.
const REACH: f64 = 5.0;
/// Parts of a step, or of a standard deviation of the error, whichever is larger: spreading wear evenly over one adds a variance of (R / PARTS)² / 12 to that of the rounding, R² / 12; at
/// shape 0.3, where half of all wear lies near 0, it changes the chance of a reading by up to 2 %.
const PARTS: usize = 16;
/// Change of the logarithm of the density from part to part below which its values give the chances: differences of
/// integrals would lose their digits there, and Simpson's rule has an error of some 1e-9.
const SMOOTH: f64 = 0.02;
/// Change of the logarithm of the density over all parts below which a parabola through three values has the others: the cubic
/// term is below 1e-8. A fine gauge has a difference of its own for nearly every increment, which would cost 33 values each.
const NEARLY_EVEN: f64 = 2e-3;

/// The law of increments: a process, with the logarithms of its parameters over exposure 1 for each.
#[derive(Clone, Copy)]
pub struct Laws<'a> {
    pub process: &'a dyn Process,
    pub logs: &'a dyn Fn(&Increment) -> [f64; 2],
}

/// Log-likelihood of the readings, per unit of wear as that of exact ones: probabilities over steps.
pub fn ln_likelihood(laws: Laws<'_>, increments: &[Increment], rounding: Rounding) -> f64 {
    let mut sum = 0.0;
    follow(laws, increments, rounding, &mut |chance, _| sum += libm::log(chance / rounding.step));
    sum
}

/// Probability integral transforms of the readings, each given those before it, spread evenly over its step.
pub fn transforms(
    laws: Laws<'_>,
    increments: &[Increment],
    rounding: Rounding,
    stream: &mut Stream,
) -> Vec<f64> {
    let mut transforms = Vec::with_capacity(increments.len());
    follow(laws, increments, rounding, &mut |chance, below| {
        transforms.push(below() + chance * stream.sample::<f64, _>(Open01));
    });
    transforms
}

/// Where true wear may lie around a reading, in even parts.
struct Window {
    part: f64,
    parts: usize,
    /// Chance of each part to give the reading, and a smaller one.
    chances: Vec<[f64; 2]>,
}

impl Window {
    fn new(Rounding { step, error }: Rounding) -> Self {
        if error == 0.0 {
            return Self { part: step / PARTS as f64, parts: PARTS, chances: vec![[1.0, 0.0]; PARTS] };
        }
        let part = libm::hypot(step, error) / PARTS as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most some hundred")]
        let parts = ((step + 2.0 * REACH * error) / part).ceil() as usize;
        let chance = |k: usize| {
            let off = (k as f64 + 0.5 - 0.5 * parts as f64) * part;
            let [below, above] = [-0.5, 0.5].map(|side| normal_cdf((side * step - off) / error));
            [above - below, below]
        };
        Self { part, parts, chances: (0..parts).map(chance).collect() }
    }

    /// Before the increments of a unit whose first reading was not exact.
    fn first(&self) -> Vec<f64> {
        let all: f64 = self.chances.iter().map(|[here, _]| here).sum();
        self.chances.iter().map(|[here, _]| here / all).collect()
    }
}

/// Increments over one exposure whose readings differ by `steps` steps.
struct Kernel<'a> {
    process: &'a dyn Process,
    logs: [f64; 2],
    part: f64,
    parts: usize,
    /// Wear between the middles of both windows.
    middle: f64,
}

impl Kernel<'_> {
    fn wear(&self, k: isize) -> f64 {
        self.middle + k as f64 * self.part
    }

    fn below(&self, wear: f64) -> f64 {
        if wear > 0.0 { self.process.cumulative(self.logs, 1.0, wear) } else { 0.0 }
    }

    /// Integral of the distribution function up to `wear`, or of what is left of it beyond: [lower, upper].
    fn integrals(&self, wear: f64) -> [f64; 2] {
        self.process.mean_excess(self.logs, wear).unwrap_or([f64::NAN; 2])
    }

    /// Chances of all differences of parts, from -(parts - 1) on.
    fn chances(&self) -> Vec<f64> {
        let last = self.parts as isize;
        let density = |k: isize| {
            if self.wear(k) > 0.0 { self.process.density(self.logs, self.wear(k)).value } else { f64::NAN }
        };
        let [low, middle, high] = [-last, 0, last].map(density);
        if [low, high].into_iter().all(|end| (end - middle).abs() < NEARLY_EVEN) {
            let (slope, bend) = (0.5 * (high - low), 0.5 * (high + low) - middle);
            let at = |k: isize| {
                let x = k as f64 / last as f64;
                self.part * libm::exp(middle + (slope + bend * x) * x)
            };
            return (1 - last..last).map(at).collect();
        }
        let ends = [-last, last - 1].map(|k| (density(k + 1) - density(k)).abs());
        if ends.into_iter().all(|change| change < SMOOTH) {
            let values: Vec<f64> = (-last..=last).map(|k| libm::exp(density(k))).collect();
            return values
                .windows(3)
                .map(|v| self.part * (v[1] + (v[0] - 2.0 * v[1] + v[2]) / 12.0))
                .collect();
        }
        // The integral that is small there keeps the digits of its differences.
        let values: Vec<[f64; 2]> = (-last..=last).map(|k| self.integrals(self.wear(k))).collect();
        let chance = |v: &[[f64; 2]]| {
            let side = usize::from(v[1][1] < v[1][0]);
            ((v[0][side] - 2.0 * v[1][side] + v[2][side]) / self.part).max(0.0)
        };
        values.windows(3).map(chance).collect()
    }
}

/// Goes along the units; `seen` gets the chance of each reading given those before it, and that of a smaller one.
fn follow(
    laws: Laws<'_>,
    increments: &[Increment],
    rounding: Rounding,
    seen: &mut dyn FnMut(f64, &dyn Fn() -> f64),
) {
    let window = Window::new(rounding);
    let (step, part, parts) = (rounding.step, window.part, window.parts);
    // Masses of the parts of the window before; None: known exactly.
    let mut masses: Option<Vec<f64>> = None;
    let mut before: Option<&Increment> = None;
    // Equal spans have equal chances.
    let mut known: HashMap<[u64; 3], Vec<f64>> = HashMap::new();
    for increment in increments {
        if before.is_none_or(|last| last.unit != increment.unit || last.to != increment.from) {
            masses = (increment.from > 0.0).then(|| window.first());
        }
        before = Some(increment);
        let (process, logs) = (laws.process, (laws.logs)(increment));
        let middle = libm::round(increment.wear / step) * step;
        let kernel = Kernel { process, logs, part, parts, middle };
        let edge = kernel.wear(0) - 0.5 * parts as f64 * part;
        let next: Vec<f64> = match &masses {
            None => {
                let tail = |wear: f64| {
                    if wear > 0.0 { process.failure(logs, 1.0, wear) } else { 1.0 }
                };
                let is_upper = kernel.below(kernel.wear(0)) > 0.5;
                let at = |k: usize| edge + k as f64 * part;
                (0..parts)
                    .map(|k| match is_upper {
                        true => tail(at(k)) - tail(at(k + 1)),
                        false => kernel.below(at(k + 1)) - kernel.below(at(k)),
                    })
                    .collect()
            }
            Some(masses) => {
                let key = [logs[0], logs[1], middle].map(f64::to_bits);
                let chances = known.entry(key).or_insert_with(|| kernel.chances());
                let into = |j: usize| -> f64 {
                    masses.iter().enumerate().map(|(i, mass)| mass * chances[parts - 1 + j - i]).sum()
                };
                (0..parts).map(into).collect()
            }
        };
        let weighed: Vec<f64> =
            next.iter().zip(&window.chances).map(|(mass, [here, _])| mass * here).collect();
        let chance: f64 = weighed.iter().sum();
        let below = || {
            let under: f64 = match &masses {
                None => kernel.below(edge),
                Some(masses) => {
                    let lower = |k: isize| kernel.integrals(kernel.wear(k))[0];
                    let one = |(i, mass): (usize, &f64)| {
                        mass * (lower(-(i as isize)) - lower(-1 - i as isize)) / part
                    };
                    masses.iter().enumerate().map(one).sum()
                }
            };
            under + next.iter().zip(&window.chances).map(|(mass, [_, smaller])| mass * smaller).sum::<f64>()
        };
        seen(chance, &below);
        masses = Some(weighed.into_iter().map(|mass| mass / chance).collect());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::Gamma;

    fn laws(logs: &dyn Fn(&Increment) -> [f64; 2]) -> Laws<'_> {
        Laws { process: &Gamma, logs }
    }

    fn chain(wears: &[f64], from: f64) -> Vec<Increment> {
        let one = |(at, wear): (usize, &f64)| Increment {
            unit: 0,
            from: from + at as f64,
            to: from + at as f64 + 1.0,
            wear: *wear,
            ln_covariates: vec![],
            row: 0,
        };
        wears.iter().enumerate().map(one).collect()
    }

    /// Probability of two readings by sums over a fine grid of true wear, from distribution functions alone.
    fn by_grid(logs: [f64; 2], wears: [f64; 2], step: f64, is_exact: bool) -> f64 {
        let parts = 400;
        let part = step / f64::from(parts);
        let below = |wear: f64| if wear > 0.0 { Gamma.cumulative(logs, 1.0, wear) } else { 0.0 };
        let place = |k: i32| (f64::from(k) + 0.5) * part - 0.5 * step;
        let starts: Vec<f64> = if is_exact { vec![0.0] } else { (0..parts).map(place).collect() };
        let mut sum = 0.0;
        for j in 0..parts {
            let middle = wears[0] + place(j);
            let into: f64 = starts
                .iter()
                .map(|start| below(middle + 0.5 * part - start) - below(middle - 0.5 * part - start))
                .sum();
            let last = wears[0] + wears[1];
            let out = below(last + 0.5 * step - middle) - below(last - 0.5 * step - middle);
            sum += into / starts.len() as f64 * out;
        }
        sum
    }

    #[test]
    fn two_readings_that_share_a_rounding_have_the_probability_of_a_fine_grid() {
        for (alpha, beta) in [(2.0_f64, 1.5_f64), (0.3_f64, 0.4_f64), (20.0, 9.0)] {
            let logs = [alpha.ln(), beta.ln()];
            for wears in [[1.0, 2.0], [0.0, 1.0], [3.0, 0.0], [2.0, 3.0]] {
                for from in [0.0, 1.0] {
                    let found = ln_likelihood(laws(&|_| logs), &chain(&wears, from), Rounding::to(1.0)).exp();
                    let expected = by_grid(logs, wears, 1.0, from == 0.0);
                    if expected < 1e-4 {
                        // Far tails: what spreading adds to a variance counts there, and no reading is there.
                        continue;
                    }
                    // Parts of a sixteenth: largest where the density is singular.
                    assert!(
                        (found / expected - 1.0).abs() < 0.02,
                        "{alpha} {wears:?} {from}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_fine_gauge_gives_the_likelihood_of_exact_readings() {
        let data = chain(&[1.25, 0.5, 2.0, 0.75], 0.0);
        let logs = [0.4, 0.2];
        let exact: f64 = data.iter().map(|one| Gamma.density(logs, one.wear).value).sum();
        for step in [1e-2, 1e-4, 1e-6] {
            let rounded = ln_likelihood(laws(&|_| logs), &data, Rounding::to(step));
            // Second order in the step; differences of probabilities of 1e-7 at the finest, for the exact start.
            assert!((rounded - exact).abs() < 2.0 * step * step + 1e-8, "{step}: {rounded} {exact}");
        }
    }

    #[test]
    fn transforms_of_rounded_readings_are_those_of_the_exact_ones_for_a_fine_gauge() {
        let data = chain(&[1.25, 0.5], 0.0);
        let found = transforms(laws(&|_| [0.4, 0.2]), &data, Rounding::to(1e-3), &mut Stream::new(1, 0, 0));
        for (u, one) in found.iter().zip(&data) {
            // The width of a step.
            assert!((u - Gamma.cumulative([0.4, 0.2], 1.0, one.wear)).abs() < 1e-3, "{u}");
        }
    }

    /// Probability of two readings with an error before rounding, after an exact start, by sums over a fine grid of true wear.
    fn by_grid_with_error(logs: [f64; 2], wears: [f64; 2], Rounding { step, error }: Rounding) -> f64 {
        let part = 0.01;
        let below = |wear: f64| if wear > 0.0 { Gamma.cumulative(logs, 1.0, wear) } else { 0.0 };
        let law: Vec<f64> =
            (0..1500).map(|k| below(f64::from(k + 1) * part) - below(f64::from(k) * part)).collect();
        let read = |wear: f64, reading: f64| {
            let [low, high] = [-0.5, 0.5].map(|side| normal_cdf((reading + side * step - wear) / error));
            high - low
        };
        let mut sum = 0.0;
        for (i, first) in law.iter().enumerate() {
            let first = first * read((i as f64 + 0.5) * part, wears[0]);
            for (j, second) in law.iter().enumerate().take_while(|_| first > 1e-12) {
                sum += first * second * read((i + j + 1) as f64 * part, wears[0] + wears[1]);
            }
        }
        sum
    }

    #[test]
    fn readings_with_an_error_before_rounding_have_the_probability_of_a_fine_grid() {
        let logs = [2.0_f64.ln(), 1.5_f64.ln()];
        for rounding in [Rounding { step: 0.5, error: 0.2 }, Rounding { step: 0.25, error: 0.5 }] {
            for wears in [[1.0, 2.0], [0.5, -0.5], [2.5, 0.0]] {
                let found = ln_likelihood(laws(&|_| logs), &chain(&wears, 0.0), rounding).exp();
                let expected = by_grid_with_error(logs, wears, rounding) / (rounding.step * rounding.step);
                // Parts of a sixteenth, and a reading far from any wear that there is.
                assert!((found / expected - 1.0).abs() < 0.01, "{rounding:?} {wears:?}: {found} {expected}");
            }
        }
    }

    #[test]
    fn an_error_far_below_the_step_changes_nothing() {
        let data = chain(&[1.0, 0.0, 3.0], 0.0);
        let value = |error| ln_likelihood(laws(&|_| [0.4, 0.2]), &data, Rounding { step: 1.0, error });
        // Parts move with the window: a sixteenth of a step.
        assert!((value(1e-3) - value(0.0)).abs() < 5e-3, "{} {}", value(1e-3), value(0.0));
    }
}
