//! Estimated parameters of a process with their covariance. In: numbers of a fit. Out: laws for these parameters or others
//! near them. Never knows how they were fitted.

use rand::RngExt;

use crate::error::{LifeError, positive};
use crate::matrix::Factor;
use crate::process::Process;
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
    /// Logarithms of the two parameters, and of the exponent if it was estimated.
    pub logs: Vec<f64>,
    /// Its probability.
    pub weight: f64,
}

/// The parameters of a process and perhaps the exponent of exposure, with the covariance of their logarithms.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    process: &'static dyn Process,
    /// Logarithms of the two parameters, and of the exponent if it was estimated.
    logs: Vec<f64>,
    /// Of the covariance of `logs`; empty if the parameters are taken as known.
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
        Ok(Self { process, logs, factor: Factor::default(), sample: Sample::Unknown })
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

    /// With the covariance of the logarithms of the parameters and of the exponent, if it was estimated.
    ///
    /// # Errors
    /// [`LifeError::Covariance`].
    pub fn with_log_covariance(mut self, covariance: &[Vec<f64>]) -> Result<Self, LifeError> {
        let size = self.logs.len();
        self.factor =
            Factor::covariance(covariance, size).map_err(|reason| LifeError::Covariance { reason, size })?;
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
        self.logs.get(2).map(|log| libm::exp(*log))
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
        self.factor.variance(&padded)
    }

    pub(crate) fn logs(&self) -> &[f64] {
        &self.logs
    }

    pub(crate) fn factor(&self) -> &Factor {
        &self.factor
    }

    /// Logarithms drawn from their normal law; the estimate itself if the parameters are taken as known.
    pub(crate) fn drawn_logs(&self, stream: &mut Stream) -> Vec<f64> {
        let z: Vec<f64> = self.logs.iter().map(|_| stream.sample(StandardNormal)).collect();
        let steps = self.factor.times(&z).into_iter().chain(std::iter::repeat(0.0));
        self.logs.iter().zip(steps).map(|(log, step)| log + step).collect()
    }
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
