//! The log-likelihood of increments and its derivatives. In: increments, parameters. Out: value, gradient, Hessian. Never
//! knows how it is maximised.
//!
//! Parameters are phi = (logarithms of the process's two, [c], [b..], [logarithm of the units' coefficient of variation]). An increment's law is that over exposure 1 at
//! u_k = phi_k + power_k ln dLambda, with ln dLambda = ln(to^c - from^c) + sum b ln(covariate): the derivatives in phi follow
//! from those in u.

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
    /// How the gauge rounds, if it does.
    pub resolution: Option<Rounding>,
    /// Whether units differ, as [`Process::random_effect`] has it; not with a resolution.
    pub units_differ: bool,
}

impl Default for Model {
    /// The Gamma process over the exposure as it is.
    fn default() -> Self {
        Self { process: &Gamma, power_law: false, covariates: 0, resolution: None, units_differ: false }
    }
}

/// Value and derivatives at one point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Log-likelihood.
    pub value: f64,
    /// Its gradient in phi.
    pub gradient: Vec<f64>,
    /// Its Hessian in phi, negated: the observed information.
    pub information: Vec<Vec<f64>>,
}

impl Model {
    /// Number of parameters: 2, and 1 for the exponent, and the covariates, and 1 if units differ.
    pub fn parameters(&self) -> usize {
        2 + usize::from(self.power_law) + self.covariates + usize::from(self.units_differ)
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
        increments.iter().map(one).sum::<f64>() + self.of_units(phi, increments)
    }

    /// What differences between units add to it.
    pub fn of_units(&self, phi: &[f64], increments: &[Increment]) -> f64 {
        if !self.units_differ {
            return 0.0;
        }
        let of_unit = |(unit, lambda): (&[Increment], f64)| {
            let wear = unit.iter().map(|one| one.wear).sum();
            value(self.process, phi, libm::log(lambda), wear)
        };
        units(increments).zip(self.exposures(phi, increments)).map(of_unit).sum()
    }

    /// Exposures of the units.
    pub fn exposures(&self, phi: &[f64], increments: &[Increment]) -> Vec<f64> {
        units(increments).map(|unit| unit.iter().map(|one| self.lambda(phi, one)).sum()).collect()
    }

    /// Exposure and wear of a unit; `phi` has the units' variation.
    fn total(&self, phi: &[f64], unit: &[Increment]) -> Total {
        let size = phi.len() - 3;
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
        self.scaled(phi, self.ln_lambda(phi, increment).0)
    }

    fn scaled(&self, phi: &[f64], ln_lambda: f64) -> [f64; 2] {
        let powers = self.process.exposure_powers();
        [phi[0] + powers[0] * ln_lambda, phi[1] + powers[1] * ln_lambda]
    }

    /// Value and derivatives of a likelihood of rounded readings, by central differences of order 4, mixed ones of order 2: ample
    /// for Newton's method and for standard errors.
    fn point_of_rounded(&self, phi: &[f64], increments: &[Increment], held: Option<usize>) -> Point {
        const H: f64 = 2e-3;
        let size = phi.len();
        // An exponent stays positive.
        let width = |i: usize| if self.power_law && i == 2 { H * phi[2].min(1.0) } else { H };
        let at = |moves: &[(usize, f64)]| {
            let mut moved = phi.to_vec();
            for (i, by) in moves {
                moved[*i] += by * width(*i);
            }
            self.value(&moved, increments)
        };
        let value = at(&[]);
        let mut point = Point { value, gradient: vec![0.0; size], information: vec![vec![0.0; size]; size] };
        let is_free = |i: &usize| held != Some(*i);
        for i in (0..size).filter(is_free) {
            let [far_down, down, up, far_up] = [-2.0, -1.0, 1.0, 2.0].map(|by| at(&[(i, by)]));
            point.gradient[i] = (8.0 * (up - down) - (far_up - far_down)) / (12.0 * width(i));
            point.information[i][i] =
                -(16.0 * (up + down) - 30.0 * value - (far_up + far_down)) / (12.0 * width(i) * width(i));
            for j in (0..i).filter(is_free) {
                let corner = |a: f64, b: f64| at(&[(i, a), (j, b)]);
                let mixed = corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0);
                point.information[i][j] = -mixed / (4.0 * width(i) * width(j));
                point.information[j][i] = point.information[i][j];
            }
        }
        point
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
            return self.point_of_rounded(phi, increments, held);
        }
        let size = phi.len();
        let mut point =
            Point { value: 0.0, gradient: vec![0.0; size], information: vec![vec![0.0; size]; size] };
        let powers = self.process.exposure_powers();
        for increment in increments {
            let (ln_lambda, slopes, bend) = self.ln_lambda(phi, increment);
            let Term { value, gradient, hessian: [first, mixed, second] } =
                self.process.density(self.scaled(phi, ln_lambda), increment.wear);
            // d u / d phi_i: its own parameter, or all through ln dLambda.
            let slope = |i: usize| match i {
                0 => [1.0, 0.0],
                1 => [0.0, 1.0],
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
        if self.units_differ {
            let totals: Vec<Total> = units(increments).map(|unit| self.total(phi, unit)).collect();
            let Added { value, gradient, information } = added(self.process, phi, &totals);
            point.value += value;
            point.gradient.iter_mut().zip(gradient).for_each(|(entry, more)| *entry += more);
            let entries = point.information.iter_mut().flatten();
            entries.zip(information.into_iter().flatten()).for_each(|(entry, more)| *entry += more);
        }
        point
    }
}

/// Units one by one.
fn units(increments: &[Increment]) -> impl Iterator<Item = &[Increment]> {
    increments.chunk_by(|one, next| one.unit == next.unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::PROCESSES;

    fn sample(wear: f64, from: f64, to: f64, ln_load: f64) -> Increment {
        Increment { unit: 0, from, to, wear, ln_covariates: vec![ln_load], row: 0 }
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        for process in PROCESSES {
            derivatives_of(process);
        }
    }

    fn derivatives_of(process: &'static dyn Process) {
        for units_differ in [false, true] {
            let model = Model { process, power_law: true, covariates: 1, units_differ, ..Model::default() };
            derivatives_of_model(&model, &[0.7, 0.9, 0.8, 0.5, -0.9][..model.parameters()]);
        }
    }

    fn derivatives_of_model(model: &Model, phi: &[f64]) {
        let process = model.process;
        let data = [sample(0.8, 0.0, 2.0, 0.3), sample(1.7, 2.0, 5.0, -0.4)];
        let here = model.point(phi, &data, None);
        assert!((here.value - model.value(phi, &data)).abs() < 1e-14);
        let step = 1e-5;
        for i in 0..phi.len() {
            let moved = |by: f64| {
                let mut phi = phi.to_vec();
                phi[i] += by;
                model.point(&phi, &data, None)
            };
            let (up, down) = (moved(step), moved(-step));
            // Central differences: error step^2 and eps / step, both about 1e-10; the censored term's curvature 1e-6.
            let slope = (up.value - down.value) / (2.0 * step);
            assert!((slope - here.gradient[i]).abs() < 1e-8, "{process:?} {i}: {slope} {}", here.gradient[i]);
            for j in 0..phi.len() {
                let bend = -(up.gradient[j] - down.gradient[j]) / (2.0 * step);
                assert!(
                    (bend - here.information[i][j]).abs() < 2e-6,
                    "{i} {j}: {bend} {}",
                    here.information[i][j]
                );
            }
        }
    }
}
