//! Estimated parameters of a process with their covariance. In: numbers of a fit. Out: laws for these parameters or others
//! near them. Never knows how they were fitted.

use rand::RngExt;

use super::law::Law;
use crate::error::{LifeError, positive};
use crate::matrix::Factor;
use crate::process::{Process, Reference, sheared};
use crate::random::{StandardNormal, Stream};

/// What is known of the data an estimate was made from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Sample {
    /// Nothing.
    #[default]
    Unknown,
    /// Increments: exposure before (without an exponent), exposure after, wear.
    Increments(Vec<[f64; 3]>),
    /// Data whose law is not that of the process alone (covariates, a gauge's step), as what they leave open of the
    /// parameters: sets whose weights sum to 1.
    Sets(Vec<ParameterSet>),
    /// There were data, but the covariance has to stand for them.
    Indirect {
        /// How many increments.
        increments: usize,
    },
}

/// Parameters of a process as data may have come from.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterSet {
    /// Logarithms, as those of the estimate.
    pub logs: Vec<f64>,
    /// Its probability.
    pub weight: f64,
}

/// What has been read of one unit: what the law of its own parameter follows from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeenUnit {
    /// Exposures, before any exponent, that its readings lie between.
    pub spans: Vec<[f64; 2]>,
    /// Wear over all of them.
    pub wear: f64,
}

/// The parameters of a process, perhaps the exponent of exposure and how units differ, with the covariance of their logarithms.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    process: &'static dyn Process,
    /// Logarithms of the two parameters, of the exponent if it was estimated, of the units' coefficient of variation if they
    /// differ.
    logs: Vec<f64>,
    units_differ: bool,
    /// The unit that is asked for; none: one of which nothing has been read.
    unit: Option<SeenUnit>,
    /// Where the logarithms of the parameters are told that are normal; exposure 1 without an exponent.
    reference: Reference,
    /// Of the covariance of these; empty if the parameters are taken as known.
    factor: Factor,
    sample: Sample,
}

impl Estimate {
    /// Parameters taken as known exactly, in the order of [`Process::parameters`]. `exponent`: None for exposure that
    /// counts as it is.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn new(
        process: &'static dyn Process,
        parameters: [f64; 2],
        exponent: Option<f64>,
    ) -> Result<Self, LifeError> {
        let mut logs = Vec::new();
        for (name, value) in process.parameters().into_iter().zip(parameters) {
            logs.push(libm::log(positive(name, value)?));
        }
        if let Some(exponent) = exponent {
            logs.push(libm::log(positive("the exponent", exponent)?));
        }
        let (reference, factor, sample) = (Reference::default(), Factor::default(), Sample::Unknown);
        Ok(Self { process, logs, units_differ: false, unit: None, reference, factor, sample })
    }

    /// With units that differ, as [`Process::random_effect`] has it; `cv` is the coefficient of variation. Before a covariance is
    /// given.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`]; [`LifeError::NoRandomEffect`].
    pub fn differing(mut self, cv: f64) -> Result<Self, LifeError> {
        self.process.random_effect().ok_or(LifeError::NoRandomEffect { process: self.process.title() })?;
        self.logs.push(libm::log(positive("the coefficient of variation of units", cv)?));
        self.units_differ = true;
        Ok(self)
    }

    /// Of a unit that has been read, where units differ; of one in service, not of a new one of its kind.
    pub fn of_unit(self, unit: SeenUnit) -> Self {
        Self { unit: Some(unit), ..self }
    }

    /// The same estimate about a unit of which nothing has been read.
    pub fn of_new_unit(self) -> Self {
        Self { unit: None, ..self }
    }

    /// Coefficient of variation of what differs between units; None if they do not.
    pub fn cv(&self) -> Option<f64> {
        self.logs.last().filter(|_| self.units_differ).map(|log| libm::exp(*log))
    }

    /// Whether units differ.
    pub fn units_differ(&self) -> bool {
        self.units_differ
    }

    /// With the covariance of the parameters themselves, as a fit prints it. It is taken over to the logarithms to first
    /// order: divided by the parameters, cov(ln a, ln b) = cov(a, b) / (a b).
    ///
    /// # Errors
    /// [`LifeError::Covariance`].
    pub fn with_covariance(self, covariance: &[Vec<f64>]) -> Result<Self, LifeError> {
        let values: Vec<f64> = self.logs.iter().map(|log| libm::exp(*log)).collect();
        let scale = |(i, row): (usize, &Vec<f64>)| {
            row.iter()
                .zip(&values)
                .map(|(entry, value)| entry / (values.get(i).unwrap_or(value) * value))
                .collect()
        };
        let sized = covariance.iter().all(|row| row.len() == values.len());
        let scaled: Vec<Vec<f64>> =
            if sized { covariance.iter().enumerate().map(scale).collect() } else { Vec::new() };
        self.with_log_covariance(&scaled)
    }

    /// With the covariance of the logarithms of the parameters and of the exponent, if it was estimated. With an exponent the logarithms
    /// that are normal are those at the exposure where the mean wear and the exponent are not correlated: the middle of the data,
    /// the same in every unit of exposure, which the parameters over exposure 1 are not.
    ///
    /// # Errors
    /// [`LifeError::Covariance`].
    pub fn with_log_covariance(mut self, covariance: &[Vec<f64>]) -> Result<Self, LifeError> {
        let size = self.logs.len();
        let factor = |covariance: &[Vec<f64>]| {
            Factor::covariance(covariance, size).map_err(|reason| LifeError::Covariance { reason, size })
        };
        self.factor = factor(covariance)?;
        self.reference = Reference::default();
        if let Some(exponent) = self.exponent() {
            let mean = |logs: [f64; 2]| self.process.ln_mean(logs);
            let slopes = [mean([1.0, 0.0]), mean([0.0, 1.0])].map(|at| at - mean([0.0, 0.0]));
            let shared = slopes[0] * covariance[2][0] + slopes[1] * covariance[2][1];
            self.reference = Reference::at(self.process, -shared / (exponent * covariance[2][2]));
            let slopes = self.reference.slopes().map(|slope| slope * exponent);
            self.factor = factor(&sheared(covariance, slopes))?;
        }
        Ok(self)
    }

    /// With the data it was made from.
    pub fn with_sample(self, sample: Sample) -> Self {
        Self { sample, ..self }
    }

    /// The data it was made from.
    pub fn sample(&self) -> &Sample {
        &self.sample
    }

    /// The process.
    pub fn process(&self) -> &'static dyn Process {
        self.process
    }

    /// The parameters, in the order of [`Process::parameters`].
    pub fn parameters(&self) -> [f64; 2] {
        [libm::exp(self.logs[0]), libm::exp(self.logs[1])]
    }

    /// Exponent of exposure, if one was estimated.
    pub fn exponent(&self) -> Option<f64> {
        exponent_of(&self.logs, self.units_differ)
    }

    /// The law of wear at these logarithms, of the unit that is asked for.
    pub(crate) fn law_at(&self, logs: &[f64]) -> Result<Law, LifeError> {
        let (common, effect) = ([logs[0], logs[1]], self.process.random_effect());
        let (Some(effect), Some(ln_cv), true) = (effect, logs.last(), self.units_differ) else {
            return Law::from_logs(self.process, common);
        };
        let cv = libm::exp(*ln_cv);
        let Some(SeenUnit { spans, wear }) = &self.unit else {
            return Law::of_units(self.process, common, cv);
        };
        let exponent = exponent_of(logs, true).unwrap_or(1.0);
        let exposure: f64 =
            spans.iter().map(|[from, to]| libm::pow(*to, exponent) - libm::pow(*from, exponent)).sum();
        let (own, cv) = effect.after(common, cv, exposure, *wear).ok_or(LifeError::UnitStandsStill)?;
        Law::of_units(self.process, own, cv)
    }

    /// ln density of readings of the unit, given these logarithms, but for what does not depend on its own parameter.
    pub(crate) fn ln_likelihood(&self, logs: &[f64], increments: &[[f64; 3]]) -> f64 {
        let Some(effect) = self.process.random_effect().filter(|_| self.units_differ) else {
            return f64::NAN;
        };
        let exponent = exponent_of(logs, true).unwrap_or(1.0);
        let powers = self.process.exposure_powers();
        let at = |exposure: f64| {
            let ln = libm::log(exposure);
            [logs[0] + powers[0] * ln, logs[1] + powers[1] * ln]
        };
        let (mut all, mut total, mut value) = (0.0, 0.0, 0.0);
        for [from, to, wear] in increments {
            let exposure = libm::pow(*to, exponent) - libm::pow(*from, exponent);
            value += self.process.ln_density(at(exposure), *wear);
            all += exposure;
            total += wear;
        }
        let cv = libm::exp(logs[logs.len() - 1]);
        value + effect.ln_density(at(all), cv, total) - self.process.ln_density(at(all), total)
    }

    /// Logarithms of the parameters of one unit and of the exponent, drawn: where units differ, of one of them.
    pub(crate) fn drawn_unit(&self, stream: &mut Stream) -> Vec<f64> {
        let mut logs = self.drawn_logs(stream);
        if let (Some(effect), true) = (self.process.random_effect(), self.units_differ) {
            let cv = logs.pop().map_or(0.0, libm::exp);
            let own = effect.draw([logs[0], logs[1]], cv, stream);
            logs[..2].copy_from_slice(&own);
        }
        logs
    }

    /// Whether a covariance is known.
    pub fn is_uncertain(&self) -> bool {
        !self.factor.is_empty()
    }

    /// Variance of a value to first order, from its derivatives by the logarithms of the parameters and of the exponent; 0
    /// if the parameters are taken as known. Derivatives left out count as 0.
    pub fn variance(&self, gradient: &[f64]) -> f64 {
        let mut padded = gradient.to_vec();
        padded.resize(self.logs.len(), 0.0);
        // By ln exponent, the parameters at the reference held.
        if let Some(exponent) = self.exponent() {
            let slopes = self.reference.slopes();
            padded[2] -= exponent * (slopes[0] * padded[0] + slopes[1] * padded[1]);
        }
        self.factor.variance(&padded)
    }

    pub(crate) fn logs(&self) -> &[f64] {
        &self.logs
    }

    pub(crate) fn factor(&self) -> &Factor {
        &self.factor
    }

    /// Where the parameters are told that are normal.
    pub(crate) fn reference(&self) -> &Reference {
        &self.reference
    }

    /// Logarithms at the reference.
    pub(crate) fn logs_at_reference(&self) -> Vec<f64> {
        let mut logs = self.logs.clone();
        if let Some(exponent) = self.exponent() {
            self.reference.taken(&mut logs, exponent);
        }
        logs
    }

    /// Logarithms that are so far from those of the estimate, at the reference.
    pub(crate) fn logs_off_by(&self, steps: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let mut logs: Vec<f64> = self.logs.iter().zip(steps).map(|(log, step)| log + step).collect();
        if let (Some(own), Some(exponent)) = (self.exponent(), exponent_of(&logs, self.units_differ)) {
            self.reference.back(&mut logs, exponent - own);
        }
        logs
    }

    /// Logarithms drawn from their normal law; the estimate itself if the parameters are taken as known.
    pub(crate) fn drawn_logs(&self, stream: &mut Stream) -> Vec<f64> {
        let z: Vec<f64> = self.logs.iter().map(|_| stream.sample(StandardNormal)).collect();
        self.logs_off_by(self.factor.times(&z).into_iter().chain(std::iter::repeat(0.0)))
    }
}

/// Exponent of exposure among logarithms, if it was estimated.
pub(crate) fn exponent_of(logs: &[f64], units_differ: bool) -> Option<f64> {
    let own = logs.len() - usize::from(units_differ);
    logs[..own].get(2).map(|log| libm::exp(*log))
}

#[cfg(test)]
mod tests {
    use super::super::state::OperatingState;
    use super::*;
    use crate::process::Gamma;

    #[test]
    fn covariance_goes_over_to_logarithms() {
        let estimate = Estimate::new(&Gamma, [2.0, 4.0], None).expect("valid");
        let uncertain = estimate.with_covariance(&[vec![0.04, 0.04], vec![0.04, 0.16]]).expect("valid");
        // Standard deviations 0.2 of 2 and 0.4 of 4: 0.1 in the logarithm.
        assert!((uncertain.factor.variance(&[1.0, 0.0]) - 0.01).abs() < 1e-15);
        assert!((uncertain.factor.variance(&[0.0, 1.0]) - 0.01).abs() < 1e-15);
        // Correlation 0.5: variance of the difference 0.01 + 0.01 - 2 * 0.005.
        assert!((uncertain.factor.variance(&[1.0, -1.0]) - 0.01).abs() < 1e-15);
        assert!((uncertain.variance(&[1.0]) - 0.01).abs() < 1e-15);
        assert_eq!(Estimate::new(&Gamma, [2.0, 4.0], None).expect("valid").variance(&[1.0, 1.0]), 0.0);
        let distance = uncertain.factor.distance(&[0.1, 0.1]).expect("full rank");
        // d' C^-1 d with C = 0.01 [[1, .5], [.5, 1]]: 1/0.75 (1 + 1 - 1).
        assert!((distance - 4.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn matrices_that_are_no_covariance_are_refused() {
        let estimate = || Estimate::new(&Gamma, [2.0, 4.0], None).expect("valid");
        let cases = [
            vec![vec![1.0, 2.0], vec![2.0, 1.0]],
            vec![vec![-1.0, 0.0], vec![0.0, 1.0]],
            vec![vec![1.0, 0.5], vec![0.1, 1.0]],
            vec![vec![1.0, f64::NAN], vec![f64::NAN, 1.0]],
            vec![vec![1.0]],
        ];
        for case in cases {
            let error = estimate().with_covariance(&case).expect_err("no covariance");
            assert!(matches!(error, LifeError::Covariance { size: 2, .. }), "{error}");
        }
    }

    #[test]
    fn parameters_that_are_not_positive_are_named() {
        let error = Estimate::new(&Gamma, [-1.0, 4.0], None).expect_err("negative");
        assert_eq!(error, LifeError::NotPositive { what: "alpha", value: -1.0 });
        assert!(Estimate::new(&Gamma, [1.0, f64::NAN], None).is_err());
        assert!(Estimate::new(&Gamma, [1.0, 1.0], Some(0.0)).is_err());
        assert!(OperatingState::new(3.0).expect("valid").worn(1.0, -0.5).is_err());
    }
}
