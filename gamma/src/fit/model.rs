//! The log-likelihood of increments and its derivatives. In: increments, parameters. Out: value, gradient, Hessian. Never
//! knows how it is maximised.
//!
//! Parameters are phi = (logarithms of the process's two, [c], [b..], [s..], [logarithm of the units' coefficient of variation]). An
//! increment's law is that over exposure 1 at u_k = phi_k + power_k ln dLambda + size_power_k ln size, with ln dLambda =
//! ln(to^c - from^c) + sum b ln(covariate), ln size = sum s ln(covariate): the derivatives in phi follow from those in u.

use super::bounds::of_bounds;
use super::point::{Point, WIDTH};
use super::rounded::{Laws, least_variance, ln_likelihood};
use super::units::{Added, Total, added, value};
use crate::data::{Increment, Rounding};
use crate::process::{Gamma, Process, Term};

/// What is estimated: a process, and what Lambda depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// The process.
    pub process: &'static dyn Process,
    /// Estimate c of Lambda = exposure^c; otherwise c = 1.
    pub power_law: bool,
    /// How many covariates of the data multiply Lambda, each as value^b.
    pub covariates: usize,
    /// How many more, after those, multiply the size of increments, each as value^s: [`Process::size_powers`].
    pub sizes: usize,
    /// How the gauge rounds, if it does.
    pub resolution: Option<Rounding>,
    /// Whether units differ, as [`Process::random_effect`] has it; not with a resolution.
    pub units_differ: bool,
}

impl Default for Model {
    /// The Gamma process over the exposure as it is.
    fn default() -> Self {
        Self {
            process: &Gamma,
            power_law: false,
            covariates: 0,
            sizes: 0,
            resolution: None,
            units_differ: false,
        }
    }
}

impl Model {
    /// Number of parameters: 2, and 1 for the exponent, and the covariates, and 1 if units differ.
    pub fn parameters(&self) -> usize {
        2 + usize::from(self.power_law) + self.covariates + self.sizes + usize::from(self.units_differ)
    }

    /// Powers s of the covariates of size among the parameters.
    pub fn size_powers<'a>(&self, phi: &'a [f64]) -> &'a [f64] {
        let first = 2 + usize::from(self.power_law) + self.covariates;
        &phi[first..first + self.sizes]
    }

    /// ln of the factor that covariates put on the size of an increment.
    pub fn ln_size(&self, phi: &[f64], increment: &Increment) -> f64 {
        let values = increment.ln_covariates.iter().skip(self.covariates);
        values.zip(self.size_powers(phi)).map(|(value, s)| s * value).sum()
    }

    /// Logarithms of the process's parameters at an increment's size.
    pub fn sized(&self, phi: &[f64], ln_size: f64) -> [f64; 2] {
        let powers = self.process.size_powers();
        [phi[0] + powers[0] * ln_size, phi[1] + powers[1] * ln_size]
    }

    /// Powers b of the covariates among the parameters.
    pub fn powers<'a>(&self, phi: &'a [f64]) -> &'a [f64] {
        let first = 2 + usize::from(self.power_law);
        &phi[first..first + self.covariates]
    }

    /// A parameter from its entry in phi: exponent and powers stand there as they are, all others by their logarithms.
    pub fn natural(&self, at: usize, phi: f64) -> f64 {
        if self.is_logarithm(at) { libm::exp(phi) } else { phi }
    }

    /// Whether a parameter stands in phi by its logarithm.
    pub fn is_logarithm(&self, at: usize) -> bool {
        at < 2 || (self.units_differ && at + 1 == self.parameters())
    }

    /// ln dLambda of an increment and its derivatives in the parameters from the third on; and its second derivative
    /// in c, the only one there is.
    fn ln_lambda(&self, phi: &[f64], increment: &Increment) -> (f64, Vec<f64>, f64) {
        let mut slopes = Vec::with_capacity(phi.len() - 2);
        let (mut value, mut bend) = (libm::log(increment.to - increment.from), 0.0);
        if self.power_law {
            let c = phi[2];
            let ln_to = libm::log(increment.to);
            (value, bend) = (c * ln_to, 0.0);
            let mut slope = ln_to;
            if increment.from > 0.0 {
                // ln(1 - r), r = (from/to)^c.
                let ratio = libm::log(increment.from / increment.to);
                let rest = -libm::expm1(c * ratio);
                let r = 1.0 - rest;
                value += libm::log(rest);
                slope -= ratio * r / rest;
                bend = -(ratio * ratio) * r / (rest * rest);
            }
            slopes.push(slope);
        }
        for (ln_covariate, b) in increment.ln_covariates.iter().zip(self.powers(phi)) {
            value += b * ln_covariate;
            slopes.push(*ln_covariate);
        }
        (value, slopes, bend)
    }

    /// dLambda of an increment at phi: its shape is alpha times this.
    pub fn lambda(&self, phi: &[f64], increment: &Increment) -> f64 {
        libm::exp(self.ln_lambda(phi, increment).0)
    }

    /// Log-likelihood alone.
    pub fn value(&self, phi: &[f64], increments: &[Increment]) -> f64 {
        if let Some(rounding) = self.resolution {
            let logs = |one: &Increment| self.logs(phi, one);
            return ln_likelihood(Laws { process: self.process, logs: &logs }, increments, rounding);
        }
        let one =
            |increment: &Increment| self.process.density(self.logs(phi, increment), increment.wear).value;
        let exact = increments.iter().filter(|increment| increment.is_exact());
        exact.map(one).sum::<f64>() + self.of_units(phi, increments) + of_bounds(self, phi, increments)
    }

    /// What differences between units add to it.
    pub fn of_units(&self, phi: &[f64], increments: &[Increment]) -> f64 {
        if !self.units_differ {
            return 0.0;
        }
        let of_unit = |unit: &[Increment]| {
            let Seen { exposure, wear, ln_size } = self.seen(phi, unit);
            if exposure == 0.0 {
                return 0.0;
            }
            let [first, second] = self.sized(phi, ln_size);
            value(self.process, &[first, second, phi[phi.len() - 1]], libm::log(exposure), wear)
        };
        units(increments).map(of_unit).sum()
    }

    /// Exposures of the units, as far as their wear is known.
    pub fn exposures(&self, phi: &[f64], increments: &[Increment]) -> Vec<f64> {
        units(increments).map(|unit| self.seen(phi, unit).exposure).filter(|own| *own > 0.0).collect()
    }

    /// What is known exactly of a unit.
    pub fn seen(&self, phi: &[f64], unit: &[Increment]) -> Seen {
        let ln_size = unit.first().map_or(0.0, |one| self.ln_size(phi, one));
        let mut seen = Seen { exposure: 0.0, wear: 0.0, ln_size };
        for one in unit.iter().filter(|one| one.is_exact()) {
            seen.exposure += self.lambda(phi, one);
            seen.wear += seen.wear_of(one.wear, self.ln_size(phi, one));
        }
        seen
    }

    /// Exposure and wear of a unit; `phi` has the units' variation.
    fn total(&self, phi: &[f64], unit: &[Increment]) -> Total {
        let size = phi.len() - 3;
        let unit = unit.iter().filter(|one| one.is_exact());
        let (mut lambda, mut wear) = (0.0, 0.0);
        let (mut slopes, mut bends) = (vec![0.0; size], vec![vec![0.0; size]; size]);
        for one in unit {
            let (ln, of_one, bend) = self.ln_lambda(phi, one);
            let own = libm::exp(ln);
            lambda += own;
            wear += one.wear;
            for i in 0..size {
                slopes[i] += own * of_one[i];
                for j in 0..size {
                    bends[i][j] += own * of_one[i] * of_one[j];
                }
            }
            if self.power_law {
                bends[0][0] += own * bend;
            }
        }
        slopes.iter_mut().for_each(|slope| *slope /= lambda);
        for i in 0..size {
            for j in 0..size {
                bends[i][j] = bends[i][j] / lambda - slopes[i] * slopes[j];
            }
        }
        Total { ln_lambda: libm::log(lambda), slopes, bends, wear }
    }

    /// Logarithms of the parameters of an increment's law, that over exposure 1.
    pub fn logs(&self, phi: &[f64], increment: &Increment) -> [f64; 2] {
        self.scaled(phi, self.ln_lambda(phi, increment).0, increment)
    }

    fn scaled(&self, phi: &[f64], ln_lambda: f64, increment: &Increment) -> [f64; 2] {
        let powers = self.process.exposure_powers();
        let [first, second] = self.sized(phi, self.ln_size(phi, increment));
        [first + powers[0] * ln_lambda, second + powers[1] * ln_lambda]
    }

    /// Value and derivatives of a part of the likelihood that has none in closed form.
    fn differences(&self, of: &dyn Fn(&[f64]) -> f64, phi: &[f64], held: Option<usize>) -> Point {
        // An exponent stays positive.
        let width = |i: usize| if self.power_law && i == 2 { WIDTH * phi[2].min(1.0) } else { WIDTH };
        Point::by_differences(of, phi, &width, held)
    }

    /// ln of the largest variance of an increment over the least that a gauge's readings tell from none: where it is below 0 the
    /// likelihood has no maximum, and its values get dearer with every step towards no scatter.
    pub fn ln_scatter(&self, phi: &[f64], increments: &[Increment]) -> f64 {
        let Some(rounding) = self.resolution else { return f64::INFINITY };
        let variance = |one: &Increment| self.process.variance(self.logs(phi, one));
        let largest = increments.iter().map(variance).fold(0.0, f64::max);
        libm::log(largest / least_variance(rounding))
    }

    /// Value, gradient and information, but for a parameter that is held: its entries may be 0.
    pub fn point(&self, phi: &[f64], increments: &[Increment], held: Option<usize>) -> Point {
        if self.resolution.is_some() {
            return self.differences(&|phi| self.value(phi, increments), phi, held);
        }
        let size = phi.len();
        let mut point =
            Point { value: 0.0, gradient: vec![0.0; size], information: vec![vec![0.0; size]; size] };
        let powers = self.process.exposure_powers();
        let (size_powers, first_size) =
            (self.process.size_powers(), size - usize::from(self.units_differ) - self.sizes);
        for increment in increments.iter().filter(|increment| increment.is_exact()) {
            let (ln_lambda, slopes, bend) = self.ln_lambda(phi, increment);
            let Term { value, gradient, hessian: [first, mixed, second] } =
                self.process.density(self.scaled(phi, ln_lambda, increment), increment.wear);
            // d u / d phi_i: its own parameter, or all through ln dLambda or ln size.
            let slope = |i: usize| match i {
                0 => [1.0, 0.0],
                1 => [0.0, 1.0],
                _ if (first_size..first_size + self.sizes).contains(&i) => {
                    let value = increment.ln_covariates.get(self.covariates + i - first_size);
                    size_powers.map(|power| power * value.copied().unwrap_or(0.0))
                }
                _ => powers.map(|power| power * slopes.get(i - 2).copied().unwrap_or(0.0)),
            };
            point.value += value;
            for i in 0..size {
                let a = slope(i);
                point.gradient[i] += gradient[0] * a[0] + gradient[1] * a[1];
                for j in 0..size {
                    let b = slope(j);
                    let cross = a[0] * b[1] + a[1] * b[0];
                    point.information[i][j] -= first * a[0] * b[0] + mixed * cross + second * a[1] * b[1];
                }
            }
            if self.power_law {
                point.information[2][2] -= (gradient[0] * powers[0] + gradient[1] * powers[1]) * bend;
            }
        }
        if self.units_differ && self.sizes == 0 {
            let seen = units(increments).filter(|unit| unit.iter().any(Increment::is_exact));
            let totals: Vec<Total> = seen.map(|unit| self.total(phi, unit)).collect();
            let Added { value, gradient, information } = added(self.process, phi, &totals);
            point.add(Point { value, gradient, information });
        } else if self.units_differ {
            point.add(self.differences(&|phi| self.of_units(phi, increments), phi, held));
        }
        if !increments.iter().all(Increment::is_plain) {
            point.add(self.differences(&|phi| of_bounds(self, phi, increments), phi, held));
        }
        point
    }
}

/// What is known exactly of a unit: its exposure, and its wear at the size that its first increment has.
pub struct Seen {
    /// Exposure, with exponent and covariates.
    pub exposure: f64,
    /// Wear.
    pub wear: f64,
    /// ln of that size.
    pub ln_size: f64,
}

impl Seen {
    /// Wear of an increment of another size.
    pub fn wear_of(&self, wear: f64, ln_size: f64) -> f64 {
        if ln_size == self.ln_size { wear } else { wear * libm::exp(self.ln_size - ln_size) }
    }
}

/// Units one by one.
pub fn units(increments: &[Increment]) -> impl Iterator<Item = &[Increment]> {
    increments.chunk_by(|one, next| one.unit == next.unit)
}
