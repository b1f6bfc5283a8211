//! Goodness of fit. In: a fit and its data. Out: distances of the probability integral transform from uniform,
//! pairs for a quantile plot, an asymptotic p-value. Exact p-values need the bootstrap.

use super::estimate::Fit;
use super::model::units;
use super::rounded::{Differing, Laws, transforms};
use crate::data::{Increment, Known};
use crate::process::{Process, RandomEffect};
use crate::random::Stream;
use crate::special::rising_root;

/// How far the data are from the fitted law.
#[derive(Clone, Debug, PartialEq)]
pub struct Goodness {
    /// Kolmogorov and Smirnov: the largest distance of the two distribution functions.
    pub kolmogorov_smirnov: f64,
    /// Anderson and Darling's A^2.
    pub anderson_darling: f64,
    /// Probability integral transforms of the increments, sorted.
    pub transforms: Vec<f64>,
    /// The same in the order of the increments.
    pub in_order: Vec<f64>,
    /// Pairs (expected, seen) of wear increments: expected is the quantile of the increment's own law at the plotting
    /// position (rank - 1/2) / n.
    pub quantiles: Vec<(f64, f64)>,
}

/// Coefficients of ln p, or of ln(1 - p), by powers of A², up to an A² each (R. B. D'Agostino, M. A. Stephens, Goodness-of-Fit
/// Techniques, 1986, table 4.9), for a normal law with both parameters estimated.
const TAILS: [(f64, bool, [f64; 3]); 4] = [
    (0.2, false, [-13.436, 101.14, -223.73]),
    (0.34, false, [-8.318, 42.796, -59.938]),
    (0.6, true, [0.9177, -4.279, -1.38]),
    (f64::INFINITY, true, [1.2937, -5.709, 0.0186]),
];
/// Largest A² the last parabola is for; beyond it p is below 1e-30.
const LARGEST: f64 = 13.0;

impl Goodness {
    /// Probability of an A² at least as large if the fitted process is true, from the law for a normal sample with both
    /// parameters estimated. That of a Gamma sample is close: its 5 % point is 0.752 for large shapes, as there, and
    /// 0.786 for shape 1 (ibid., table 4.21), where this gives 4 %. Increments far below shape 1 make it too small by more;
    /// the bootstrap has no such limits.
    pub fn asymptotic_p(&self) -> f64 {
        let n = self.transforms.len() as f64;
        let distance = self.anderson_darling * (1.0 + 0.75 / n + 2.25 / (n * n));
        let distance = distance.clamp(0.0, LARGEST);
        let row = TAILS.iter().find(|(end, ..)| distance < *end);
        row.map_or(0.0, |(_, is_upper, [a, b, c])| {
            let part = libm::exp(a + distance * (b + distance * c));
            if *is_upper { part } else { 1.0 - part }
        })
    }
}

/// Transforms each increment whose wear is known by its own law; where units differ by its law given those of the unit before; the
/// first of a unit that entered below a limit by its law given that; of rounded readings each by its law given those before, spread
/// evenly over its step with the seed's numbers. Increments with bounds are passed over, and what they tell of those after them.
pub fn goodness(fit: &Fit, increments: &[Increment], seed: u64) -> Goodness {
    let process = fit.model.process;
    let mut stream = Stream::new(seed, u64::MAX, 0);
    let seen = of_units(fit, increments);
    let transforms = match fit.model.resolution {
        Some(rounding) if fit.model.units_differ => {
            let units = Differing::new(&fit.model, &fit.phi, increments, rounding);
            units.map_or_else(Vec::new, |mut units| units.transforms(increments, rounding, &mut stream))
        }
        Some(rounding) => {
            let logs = |one: &Increment| fit.model.logs(&fit.phi, one);
            transforms(Laws { process, logs: &logs }, increments, rounding, &mut stream)
        }
        None => seen.iter().map(SeenIncrement::transform).collect(),
    };
    // Positions in the sorted transforms say which quantile each increment is held against.
    let in_order = transforms.clone();
    let mut seen: Vec<(f64, SeenIncrement)> = transforms.into_iter().zip(seen).collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let transforms: Vec<f64> = seen.iter().map(|(u, ..)| *u).collect();
    let n = transforms.len() as f64;
    let position = |at: usize| (at as f64 + 0.5) / n;
    let quantiles = seen.iter().enumerate();
    Goodness {
        kolmogorov_smirnov: kolmogorov_smirnov(&transforms),
        anderson_darling: anderson_darling(&transforms),
        quantiles: quantiles.map(|(at, (_, one))| (one.quantile(position(at)), one.wear)).collect(),
        transforms,
        in_order,
    }
}

/// An increment and its law given what has been read of its unit.
struct SeenIncrement {
    law: UnitLaw,
    lambda: f64,
    wear: f64,
    /// What the law's wear is to be multiplied by.
    size: f64,
    /// Wear that its unit entered below at its end.
    limit: Option<f64>,
}

impl SeenIncrement {
    fn entering(&self) -> f64 {
        self.limit.map_or(1.0, |limit| self.law.below(self.lambda, limit / self.size))
    }

    fn transform(&self) -> f64 {
        self.law.below(self.lambda, self.wear / self.size) / self.entering()
    }

    fn quantile(&self, p: f64) -> f64 {
        self.law.quantile(self.lambda, p * self.entering()) * self.size
    }
}

/// The law of an increment of a unit, given what has been read of it.
#[derive(Clone, Copy)]
struct UnitLaw {
    process: &'static dyn Process,
    logs: [f64; 2],
    /// Coefficient of variation of the unit's own parameter; 0 where it is known.
    cv: f64,
}

impl UnitLaw {
    fn effect(&self) -> Option<&'static dyn RandomEffect> {
        self.process.random_effect().filter(|_| self.cv > 0.0)
    }

    fn below(self, lambda: f64, wear: f64) -> f64 {
        match self.effect() {
            Some(effect) => effect.tails(self.logs, self.cv, lambda, wear).0,
            None => self.process.cumulative(self.logs, lambda, wear),
        }
    }

    fn quantile(self, lambda: f64, p: f64) -> f64 {
        let Some(effect) = self.effect() else { return self.process.quantile(self.logs, lambda, p) };
        let tails = |wear: f64| effect.tails(self.logs, self.cv, lambda, wear);
        let miss = |wear: f64| {
            let (below, above) = tails(wear);
            if p <= 0.5 { below - p } else { (1.0 - p) - above }
        };
        // Wear that may fall is looked for on the side of 0 where it lies.
        if tails(0.0).0 > p {
            return -rising_root(&|fall| -miss(-fall), self.process.quantile(self.logs, lambda, p).abs());
        }
        rising_root(&miss, self.process.quantile(self.logs, lambda, 0.5).abs())
    }
}

/// Each increment and its law given those of its unit before.
fn of_units(fit: &Fit, increments: &[Increment]) -> Vec<SeenIncrement> {
    let mut found = Vec::with_capacity(increments.len());
    for unit in units(increments) {
        let ln_size = |one: &Increment| fit.model.ln_size(&fit.phi, one);
        // Sizes are those beside the unit's first where units differ, else each has its own law.
        let cv = fit.cv().unwrap_or(0.0);
        let first = fit.model.seen(&fit.phi, &unit[..1]);
        let logs = |one: &Increment| if cv > 0.0 { first.ln_size } else { ln_size(one) };
        let mut law = UnitLaw { process: fit.model.process, logs: fit.logs(), cv };
        let entry = unit.iter().find(|one| one.known == Known::Entered { from_new: true });
        let mut is_sized = false;
        for one in unit.iter().filter(|one| one.is_exact()) {
            if cv == 0.0 || !is_sized {
                law.logs = fit.model.sized(&fit.phi, logs(one));
                is_sized = true;
            }
            let (lambda, size) =
                (fit.lambda(one), if cv > 0.0 { 1.0 / first.wear_of(1.0, ln_size(one)) } else { 1.0 });
            let limit = entry.filter(|entry| one.from == 0.0 && one.to == entry.to).map(|entry| entry.wear);
            if one.is_plain() {
                found.push(SeenIncrement { law, lambda, wear: one.wear, size, limit });
            }
            if let Some((logs, cv)) =
                law.effect().and_then(|effect| effect.after(law.logs, law.cv, lambda, one.wear / size))
            {
                law = UnitLaw { logs, cv, ..law };
            }
        }
    }
    found
}

fn kolmogorov_smirnov(sorted: &[f64]) -> f64 {
    let n = sorted.len() as f64;
    let distance = |(at, u): (usize, &f64)| (u - at as f64 / n).abs().max((u - (at + 1) as f64 / n).abs());
    sorted.iter().enumerate().map(distance).fold(0.0, f64::max)
}

fn anderson_darling(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    // Away from 0 and 1, where one rounded transform would decide alone.
    let ln = |u: f64| libm::log(u.max(1e-300));
    let sum: f64 = (0..n)
        .map(|at| (2 * at + 1) as f64 * (ln(sorted[at]) + ln((1.0 - sorted[n - 1 - at]).max(1e-17))))
        .sum();
    -(n as f64) - sum / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evenly_spaced_transforms_are_closest_to_uniform() {
        let even: Vec<f64> = (0..10).map(|at| (f64::from(at) + 0.5) / 10.0).collect();
        assert!((kolmogorov_smirnov(&even) - 0.05).abs() < 1e-15);
        let squared: Vec<f64> = even.iter().map(|u| u * u).collect();
        assert!(anderson_darling(&even) < 0.2 && anderson_darling(&squared) > 1.0);
    }

    #[test]
    fn one_transform_gives_the_distance_by_hand() {
        // n = 1, u = 0.25: D = 0.75; A^2 = -1 - ln 0.25 - ln 0.75.
        assert_eq!(kolmogorov_smirnov(&[0.25]), 0.75);
        let expected = -1.0 - 0.25_f64.ln() - 0.75_f64.ln();
        assert!((anderson_darling(&[0.25]) - expected).abs() < 1e-15);
    }
}
