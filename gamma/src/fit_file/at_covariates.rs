//! The estimate at given covariates. In: a fit's file, values. Out: an [`Estimate`], with what the data leave open, or what is wrong.
//! Never knows lives.

use super::definition::{Covariate, FitFile};
use super::error::{FitFileError, WRITE_ONE};
use crate::data::{Increment, Known, Rounding};
use crate::fit::{Model, parameter_sets};
use crate::life::{Estimate, LifeError, ParameterSet, Sample, SeenUnit};
use crate::matrix::Factor;

/// How far parameters may be from the maximum of the increments beside them: digits lost in print, no other fit.
const SAME_MAXIMUM: f64 = 1e-3;

/// How far the log-likelihood may be from its maximum, twice: a tenth of a standard error.
const SAME_LIKELIHOOD: f64 = 1e-2;

/// Increments up to which the parameters are integrated over; of more the normal law of their logarithms is as good, and quicker.
const MOST: usize = 400;
/// The same where units differ, whose number says how well the normal law of the logarithms does, and not that of increments.
const MOST_OF_UNITS: usize = 4000;
/// The same of rounded readings, whose likelihood costs a thousand times as much.
const MOST_ROUNDED: usize = 100;

impl FitFile {
    /// The process where the covariates have these values, one for each: Lambda times the values to the powers b is the
    /// process with other parameters; the uncertainty of the powers goes over to them to first order.
    ///
    /// # Errors
    /// [`FitFileError`] for values that are missing, unknown or not positive, and for a covariance that is none.
    pub fn estimate(&self, values: &[(String, f64)]) -> Result<Estimate, FitFileError> {
        let wrong = |error: LifeError| self.fault("covariance", &error.to_string(), WRITE_ONE);
        let all = self.names().len();
        // Of all parameters those that are no power of a covariate, by their places.
        let first = 2 + usize::from(self.exponent.is_some());
        let after = first + self.covariates.len();
        let places: Vec<usize> = (0..first).chain(after..all).collect();
        let kept = places.len();
        let sized = self.covariance.len() == all && self.covariance.iter().all(|row| row.len() == all);
        if !(self.covariance.is_empty() || sized) {
            let message = format!("`covariance` is not one of {all} parameters");
            return Err(self.fault("covariance", &message, WRITE_ONE));
        }
        let ln_values: Vec<f64> = self.in_order(values)?.into_iter().map(libm::log).collect();
        let powers: Vec<f64> = self.covariates.iter().map(|covariate| covariate.coefficient).collect();
        let factors = self.ln_factors(&powers, &ln_values).map(libm::exp);
        let parameters = [self.parameters[0] * factors[0], self.parameters[1] * factors[1]];
        let estimate = Estimate::new(self.process, parameters, self.exponent).map_err(wrong)?;
        let estimate = match self.cv.filter(|cv| *cv > 0.0) {
            Some(cv) => estimate.differing(cv).map_err(wrong)?,
            None => estimate,
        };
        let estimate = estimate.with_sample(self.sample()?);
        if self.covariance.is_empty() {
            return Ok(estimate);
        }
        // Derivatives of the parameters kept by all of them.
        let mut slopes = vec![vec![0.0; all]; kept];
        for (at, row) in slopes.iter_mut().enumerate() {
            row[places[at]] = factors.get(at).copied().unwrap_or(1.0);
            for ((slope, ln), covariate) in row[first..after].iter_mut().zip(&ln_values).zip(&self.covariates)
            {
                let through = if at < 2 { self.scales(covariate)[at] * parameters[at] } else { 0.0 };
                *slope = through * ln;
            }
        }
        let entry = |i: usize, j: usize| -> f64 {
            let of_row = |k: usize| -> f64 { (0..all).map(|l| self.covariance[k][l] * slopes[j][l]).sum() };
            (0..all).map(|k| slopes[i][k] * of_row(k)).sum()
        };
        let covariance: Vec<Vec<f64>> = (0..kept).map(|i| (0..kept).map(|j| entry(i, j)).collect()).collect();
        estimate.with_covariance(&covariance).map_err(wrong)
    }

    /// Powers of a covariate's factor that the process's parameters are proportional to.
    fn scales(&self, covariate: &Covariate) -> [f64; 2] {
        if covariate.of_size { self.process.size_powers() } else { self.process.exposure_powers() }
    }

    /// Logarithms of what covariates of these powers multiply the process's parameters by.
    fn ln_factors(&self, powers: &[f64], ln_values: &[f64]) -> [f64; 2] {
        let sum = |of_size: bool| -> f64 {
            let own = self.covariates.iter().zip(powers).zip(ln_values);
            own.filter(|((one, _), _)| one.of_size == of_size).map(|((_, power), ln)| power * ln).sum()
        };
        let (rate, size) = (sum(false), sum(true));
        let (rates, sizes) = (self.process.exposure_powers(), self.process.size_powers());
        [0, 1].map(|at: usize| rates[at] * rate + sizes[at] * size)
    }

    fn sample(&self) -> Result<Sample, FitFileError> {
        if self.increments.is_empty() {
            return Ok(Sample::Unknown);
        }
        let is_plain = self.increments.iter().all(Increment::is_plain);
        if self.resolution.is_some() || !self.covariates.is_empty() || self.units_differ() || !is_plain {
            return Ok(Sample::Indirect { increments: self.increments.len() });
        }
        if self.exponent.is_none() {
            let exposures: Vec<f64> = self.increments.iter().map(|one| one.to - one.from).collect();
            let wears: Vec<f64> = self.increments.iter().map(|one| one.wear).collect();
            let maximum = self.process.maximum(&exposures, &wears);
            let same = |(log, own): (&f64, &f64)| (libm::exp(*log) / own - 1.0).abs() < SAME_MAXIMUM;
            if !maximum.is_some_and(|logs| logs.iter().zip(&self.parameters).all(same)) {
                return Err(self.other_increments());
            }
        }
        Ok(Sample::Increments(self.increments.iter().map(|one| [one.from, one.to, one.wear]).collect()))
    }

    fn other_increments(&self) -> FitFileError {
        let message = "`increments` are not those that the parameters were estimated from";
        self.fault("increments", message, WRITE_ONE)
    }

    /// [`Self::estimate`], after covariates or rounded readings with all that up to some hundred increments leave open of the
    /// parameters, [`Sample::Sets`]: some hundred likelihoods, so seconds for a gauge with an error.
    ///
    /// # Errors
    /// [`FitFileError`], also for increments that the parameters were not estimated from.
    pub fn informed(&self, values: &[(String, f64)]) -> Result<Estimate, FitFileError> {
        let estimate = self.estimate(values)?;
        let most = match self.resolution {
            Some(_) => MOST_ROUNDED,
            None if self.units_differ() => MOST_OF_UNITS,
            None => MOST,
        };
        let is_told = matches!(estimate.sample(), Sample::Indirect { increments } if *increments <= most);
        if !is_told || !estimate.is_uncertain() || !self.has_covariates_of_increments() {
            return Ok(estimate);
        }
        let resolution = self.resolution.map(|step| Rounding { step, error: self.gauge.unwrap_or(0.0) });
        let sizes = self.covariates.iter().filter(|covariate| covariate.of_size).count();
        let (power_law, covariates) = (self.exponent.is_some(), self.covariates.len() - sizes);
        let units_differ = self.units_differ();
        let model = Model { process: self.process, power_law, covariates, sizes, resolution, units_differ };
        let mut phi: Vec<f64> = self.parameters.map(libm::log).to_vec();
        phi.extend(self.exponent);
        phi.extend(self.covariates.iter().map(|covariate| covariate.coefficient));
        phi.extend(self.cv.filter(|_| units_differ).map(libm::log));
        let point = model.point(&phi, &self.increments, None);
        let gain = Factor::definite(&point.information).and_then(|factor| factor.distance(&point.gradient));
        if !gain.is_some_and(|gain| gain < SAME_LIKELIHOOD) {
            return Err(self.other_increments());
        }
        let inverse = Factor::definite(&point.information).and_then(|factor| factor.inverse());
        let sets = inverse.and_then(|covariance| parameter_sets(&model, &self.increments, &phi, &covariance));
        let Some(sets) = sets else { return Ok(estimate) };
        let ln_values: Vec<f64> = self.in_order(values)?.into_iter().map(libm::log).collect();
        let first = 2 + usize::from(power_law);
        let at_values = |(mut logs, weight): (Vec<f64>, f64)| {
            let powers: Vec<f64> = logs.drain(first..first + self.covariates.len()).collect();
            let factors = self.ln_factors(&powers, &ln_values);
            logs.iter_mut().zip(factors).for_each(|(log, factor)| *log += factor);
            ParameterSet { logs, weight }
        };
        Ok(estimate.with_sample(Sample::Sets(sets.into_iter().map(at_values).collect())))
    }

    /// What the fit has read of a unit: its readings, its wear and its exposure (before any exponent) at the last of them.
    ///
    /// # Errors
    /// [`FitFileError`] for a fit whose units do not differ, or that has covariates; for an unknown unit.
    pub fn unit(&self, name: &str) -> Result<(SeenUnit, f64, f64), FitFileError> {
        let again = "fit again with --random-effects";
        if self.cv.is_none() {
            let message = "the fit takes all units as alike: it says the same of each";
            return Err(self.fault("process", message, &format!("leave --unit out, or {again}")));
        }
        if !self.covariates.is_empty() {
            let message = "the fit has covariates: what one of its units met is not what comes";
            return Err(self.fault("covariates", message, "leave --unit out, or fit without covariates"));
        }
        let names: Vec<&str> = self.seen.iter().map(|(name, _)| name.as_str()).collect();
        let Some(at) = names.iter().position(|known| *known == name) else {
            let cure = format!("its units are: `{}`", names.join("`, `"));
            return Err(self.fault("unit_names", &format!("the fit has no unit `{name}`"), &cure));
        };
        let is_known = |one: &Increment| one.is_exact() || one.known == Known::Entered { from_new: true };
        let of_unit = || self.increments.iter().filter(|one| one.unit == at);
        if !of_unit().all(is_known) || self.seen[at].1.is_nan() {
            let message = format!(
                "unit `{name}` was replaced, or bounds are known of it, or a level that nobody read: not what it wears"
            );
            // Parts that took its place and have readings are units of their own.
            let first = name.split_once('#').map_or(name, |(first, _)| first);
            let later = names[at + 1..]
                .iter()
                .rev()
                .find(|next| next.strip_prefix(first).is_some_and(|rest| rest.starts_with('#')));
            let cure = match later {
                Some(later) => format!("ask for the part in use, --unit {later}"),
                None => "leave --unit out, and say what the part in use wears: --current W --at EXPOSURE; --current LEVEL alone of one that took its place at a level, without readings".to_owned(),
            };
            return Err(self.fault("unit_names", &message, &cure));
        }
        let own: Vec<&Increment> = of_unit().filter(|one| one.is_growth()).collect();
        let Some(last) = own.last() else {
            return Err(self.fault("increments", &format!("`increments` have none of unit `{name}`"), again));
        };
        let spans = own.iter().map(|one| [one.from, one.to]).collect();
        let unit = SeenUnit { spans, wear: own.iter().map(|one| one.wear).sum() };
        Ok((unit, self.seen[at].1, last.to))
    }

    /// Warnings of covariates that are farther from those of the data than these are from each other, in logarithms, by which powers
    /// go. None of fits whose files do not hold the covariates of their increments.
    pub fn far_covariates(&self, values: &[(String, f64)]) -> Vec<String> {
        if !self.has_covariates_of_increments() {
            return Vec::new();
        }
        let far = |(at, covariate): (usize, &Covariate)| {
            let (name, value) = values.iter().find(|(name, _)| *name == covariate.name)?;
            let seen = self.increments.iter().map(|one| one.ln_covariates[at]);
            let (low, high) =
                seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), ln| (low.min(ln), high.max(ln)));
            let (ln, width) = (libm::log(*value), high - low);
            // The logarithm's last place is no distance.
            let is_far = width.is_finite() && (ln > high + width + 1e-9 || ln < low - width - 1e-9);
            let text = |ln: f64| format!("{:.4}", libm::exp(ln));
            is_far.then(|| {
                let (low, high) = (text(low), text(high));
                format!(
                    "covariate `{name}` = {value} is far outside the data, which have it from {low} to {high}: that its power holds so far is an assumption, which no band covers"
                )
            })
        };
        self.covariates.iter().enumerate().filter_map(far).collect()
    }

    /// Values in the order of the fit's covariates.
    fn in_order(&self, values: &[(String, f64)]) -> Result<Vec<f64>, FitFileError> {
        let fault = |message: String, cure: &str| Err(self.fault("covariates", &message, cure));
        let names: Vec<&str> = self.covariates.iter().map(|covariate| covariate.name.as_str()).collect();
        for (at, (name, value)) in values.iter().enumerate() {
            if values[..at].iter().any(|(before, _)| before == name) {
                return fault(format!("covariate `{name}` is given twice"), "give one");
            }
            if !names.contains(&name.as_str()) {
                let cure = match names.is_empty() {
                    true => "it has none: give no value (leave --covariate out)".to_owned(),
                    false => format!("its covariates are: `{}`", names.join("`, `")),
                };
                return fault(format!("the fit has no covariate `{name}`"), &cure);
            }
            if !(value.is_finite() && *value > 0.0) {
                return fault(format!("covariate `{name}` is {value}"), "give a positive, finite number");
            }
        }
        let mut ordered = Vec::new();
        for name in names {
            let Some((_, value)) = values.iter().find(|(given, _)| given == name) else {
                let cure = format!("add --covariate {name}=VALUE, in the unit of the fit's data");
                return fault(
                    format!("the fit has a covariate `{name}`, and no value of it is given"),
                    &cure,
                );
            };
            ordered.push(*value);
        }
        Ok(ordered)
    }
}
