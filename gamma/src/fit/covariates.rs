//! A fit at given values of its covariates. In: a fit with covariates, their values. Out: the fit without them that
//! holds there. Never knows data.

use super::{Fit, FitError};

impl Fit {
    /// The process where the covariates have these values, in the order of [`Fit::covariates`]: a fit without
    /// covariates. Lambda times the values to the powers b is alpha times the same; the uncertainty of the powers goes
    /// over to alpha to first order in ln alpha + sum b ln value.
    ///
    /// # Errors
    /// [`FitError::Covariates`] if another number of values is given than the fit has covariates, or one is not positive
    /// and finite, or the covariance has another size than the parameters. An empty covariance stays empty.
    pub fn at(&self, values: &[f64]) -> Result<Self, FitError> {
        let (all, kept) = (self.parameters(), self.parameters() - self.covariates.len());
        let sized = self.covariance.is_empty()
            || self.covariance.len() == all && self.covariance.iter().all(|row| row.len() == all);
        let valid = values.iter().all(|value| value.is_finite() && *value > 0.0);
        if values.len() != self.covariates.len() || !valid || !sized {
            return Err(FitError::Covariates { covariates: self.covariates.len(), given: values.len() });
        }
        let ln_values: Vec<f64> = values.iter().map(|value| libm::log(*value)).collect();
        let powers = self.covariates.iter().map(|covariate| covariate.coefficient);
        let factor = libm::exp(powers.zip(&ln_values).map(|(power, ln)| power * ln).sum());
        let alpha = self.alpha * factor;
        // Derivatives of the parameters kept by all of them.
        let mut slopes = vec![vec![0.0; all]; kept];
        for (at, row) in slopes.iter_mut().enumerate() {
            row[at] = 1.0;
        }
        slopes[0][0] = factor;
        for (slope, ln) in slopes[0][kept..].iter_mut().zip(&ln_values) {
            *slope = alpha * ln;
        }
        let entry = |i: usize, j: usize| -> f64 {
            let of_row = |k: usize| -> f64 { (0..all).map(|l| self.covariance[k][l] * slopes[j][l]).sum() };
            (0..all).map(|k| slopes[i][k] * of_row(k)).sum()
        };
        let size = if self.covariance.is_empty() { 0 } else { kept };
        let covariance = (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect();
        Ok(Self { alpha, covariance, covariates: Vec::new(), ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Covariate, Model, estimate};
    use super::*;
    use crate::data::{Gauge, Observations, Reading};

    /// Two loads, ten units each, wear 1.5 times as fast at the second load, and some scatter.
    fn readings(unit_of_load: f64) -> Vec<Reading> {
        let scatter =
            |unit: usize, step: usize| 1.0 + 0.3 * (((7 * unit + 5 * step) % 11) as f64 / 5.0 - 1.0);
        let mut readings = Vec::new();
        for unit in 0..20 {
            let (load, pace) = if unit % 2 == 0 { (2.0, 1.0) } else { (5.0, 1.5) };
            let mut wear = 0.0;
            for step in 0..6 {
                readings.push(Reading {
                    unit: unit.to_string(),
                    exposure: step as f64,
                    wear,
                    covariates: vec![load / unit_of_load],
                    row: readings.len() + 2,
                });
                wear += pace * scatter(unit, step);
            }
        }
        readings
    }

    fn fitted(unit_of_load: f64) -> Fit {
        let data = Observations::new(&readings(unit_of_load), false, Gauge::Exact).expect("growing wear");
        let model = Model { covariates: 1, ..Model::default() };
        estimate(&data, &model).expect("a maximum").fit(&data, &["load".to_owned()], "um", "h")
    }

    #[test]
    fn a_fit_at_a_load_does_not_depend_on_the_unit_of_the_load() {
        // With the load counted in units of 3, a load of 3 is 1: there alpha itself and its covariance hold.
        let (plain, scaled) = (fitted(1.0).at(&[3.0]).expect("one value"), fitted(3.0));
        assert!((plain.alpha / scaled.alpha - 1.0).abs() < 1e-9, "{} {}", plain.alpha, scaled.alpha);
        for i in 0..2 {
            for j in 0..2 {
                let (one, other) = (plain.covariance[i][j], scaled.covariance[i][j]);
                // Both maxima are found to 1e-10; the change of variables is linear in ln alpha, so exact.
                assert!((one / other - 1.0).abs() < 1e-7, "{i} {j}: {one} {other}");
            }
        }
        assert!(plain.covariates.is_empty() && plain.covariance.len() == 2);
        let one = scaled.at(&[1.0]).expect("one value");
        assert_eq!((one.alpha, one.covariance[0][0]), (scaled.alpha, scaled.covariance[0][0]));
    }

    #[test]
    fn values_that_do_not_match_the_covariates_are_refused() {
        let fit = Fit {
            alpha: 2.0,
            beta: 1.0,
            covariates: vec![Covariate { name: "load".to_owned(), coefficient: 0.5 }],
            ..Fit::default()
        };
        assert!((fit.at(&[4.0]).expect("one value").alpha - 4.0).abs() < 1e-14);
        for values in [&[][..], &[1.0, 2.0], &[-1.0], &[f64::NAN]] {
            assert!(matches!(fit.at(values), Err(FitError::Covariates { covariates: 1, .. })), "{values:?}");
        }
        let wrong = Fit { covariance: vec![vec![1.0]], ..fit };
        assert!(wrong.at(&[1.0]).is_err());
    }
}
