//! The log-likelihood of increments and its derivatives. In: increments, parameters. Out: value, gradient, Hessian. Never
//! knows how it is maximised.

use super::bounds::of_bounds;
use super::model::{Model, Seen, units};
use super::point::{Point, WIDTH};
use super::rounded::{Differing, Laws, least_variance, ln_likelihood};
use super::units::{Added, Total, added, value};
use crate::data::{Increment, Rounding};
use crate::process::Term;

/// Variance that rounding adds to that of an increment, in steps squared: 1/12 for the reading on either side.
const ROUNDING: f64 = 1.0 / 6.0;

impl Model {
    /// Log-likelihood alone.
    pub fn value(&self, phi: &[f64], increments: &[Increment]) -> f64 {
        if let Some(rounding) = self.resolution {
            if self.units_differ {
                let units = Differing::new(self, phi, increments, rounding);
                return units.map_or(f64::NAN, |mut units| units.ln_likelihood(increments, rounding));
            }
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

    /// Variance that the readings at both ends of an increment add to it, in the mean over that of its wear; None of exact readings.
    pub fn hidden(&self, phi: &[f64], increments: &[Increment]) -> Option<f64> {
        let Rounding { step, error } = self.resolution?;
        let variance = |one: &Increment| self.process.variance(self.logs(phi, one));
        let scatter = increments.iter().map(variance).sum::<f64>() / increments.len() as f64;
        Some((ROUNDING * step * step + 2.0 * error * error) / scatter)
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
