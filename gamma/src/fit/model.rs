//! What is estimated, and the laws of increments by it. In: increments, parameters. Out: logarithms of the parameters of each law. Never
//! knows the likelihood.
//!
//! Parameters are phi = (logarithms of the process's two, [c], [b..], [s..], [logarithm of the units' coefficient of variation]). An
//! increment's law is that over exposure 1 at u_k = phi_k + power_k ln dLambda + size_power_k ln size, with ln dLambda =
//! ln(to^c - from^c) + sum b ln(covariate), ln size = sum s ln(covariate): the derivatives in phi follow from those in u.

use crate::data::{Increment, Rounding};
use crate::process::{Gamma, Process};

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
    /// Whether units differ, as [`Process::random_effect`] has it.
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
    pub(super) fn ln_lambda(&self, phi: &[f64], increment: &Increment) -> (f64, Vec<f64>, f64) {
        // Room is taken where there are any.
        let mut slopes = Vec::new();
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

    /// Logarithms of the parameters of an increment's law, that over exposure 1.
    pub fn logs(&self, phi: &[f64], increment: &Increment) -> [f64; 2] {
        self.scaled(phi, self.ln_lambda(phi, increment).0, increment)
    }

    pub(super) fn scaled(&self, phi: &[f64], ln_lambda: f64, increment: &Increment) -> [f64; 2] {
        let powers = self.process.exposure_powers();
        let [first, second] = self.sized(phi, self.ln_size(phi, increment));
        [first + powers[0] * ln_lambda, second + powers[1] * ln_lambda]
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
