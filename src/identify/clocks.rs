//! By which clock wear goes: that of the physics, whose exposure has its feedback, or a power of the revolutions. In: inspections with
//! what the physics predicts. Out: both likelihoods, the exponent. Never knows mechanisms.

use linkwear_runtime::Watch;

use super::errors::{IdentifyError, ModelFault};
use super::free::Free;
use super::problem::Model;
use super::readings::{Group, Readings};
use super::result::GroupFit;
use super::starts::{IdentifySettings, identify};

/// A clock and how likely the readings are by it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Logarithm of the likelihood.
    pub log_likelihood: f64,
    /// Akaike's criterion.
    pub aic: f64,
}

/// The clock of the physics beside a power law W = a n^c.
#[derive(Clone, Debug, PartialEq)]
pub struct Clocks {
    /// The joint.
    pub joint: String,
    /// By the physics.
    pub physics: Clock,
    /// By the power law.
    pub power: Clock,
    /// Exponent c of the power law.
    pub exponent: f64,
    /// Its 95 % interval.
    pub interval: [Option<f64>; 2],
    /// The power law that comes nearest to the path of the physics has this exponent.
    pub physics_exponent: f64,
}

/// Criteria that differ by less do not tell two models apart (Burnham & Anderson 2002, 2.6).
const APART: f64 = 2.0;

/// W = a (n / n_last)^c.
struct PowerLaw<'a>(&'a [f64]);

impl Model for PowerLaw<'_> {
    fn predict(&self, values: &[f64], _: Watch<'_>) -> Result<Vec<f64>, ModelFault> {
        let last = self.0.last().copied().unwrap_or(1.0);
        let wear = |at: &f64| if *at > 0.0 { values[0] * libm::pow(at / last, values[1]) } else { 0.0 };
        Ok(self.0.iter().map(wear).collect())
    }
}

impl Clocks {
    /// Of inspections of a joint to which the physics was fitted with so many parameters; none of fewer than five readings, of which
    /// nothing would be left.
    ///
    /// # Errors
    /// [`IdentifyError`].
    pub fn of(fit: &GroupFit, parameters: usize) -> Result<Option<Self>, IdentifyError> {
        const LEAST: usize = 5;
        let largest = fit.measured.iter().copied().fold(0.0, f64::max);
        if fit.at.len() < LEAST || largest <= 0.0 {
            return Ok(None);
        }
        let noise = fit.noise_is_given.then_some(fit.noise);
        let power = power_law(fit, fit.measured.clone(), noise, largest)?;
        let physics = power_law(fit, fit.predicted.clone(), Some(fit.noise), largest)?;
        let estimated = usize::from(!fit.noise_is_given);
        let squares: f64 = fit.measured.iter().zip(&fit.predicted).map(|(a, b)| (a - b).powi(2)).sum();
        let likelihood = log_likelihood(squares, fit.measured.len(), noise);
        let exponent = &power.parameters[1];
        Ok(Some(Self {
            joint: fit.name.clone(),
            physics: Clock {
                log_likelihood: likelihood,
                aic: 2.0 * ((parameters + estimated) as f64 - likelihood),
            },
            power: Clock { log_likelihood: power.log_likelihood, aic: power.aic },
            exponent: exponent.value,
            interval: exponent.interval,
            physics_exponent: physics.parameters[1].value,
        }))
    }

    /// Criterion of the power law minus that of the physics: positive for the physics.
    pub fn difference(&self) -> f64 {
        self.power.aic - self.physics.aic
    }

    /// In a sentence.
    pub fn verdict(&self) -> &'static str {
        let difference = self.difference();
        if difference.abs() < APART {
            "the readings cannot tell the two apart"
        } else if difference > 0.0 {
            "the readings are for the physics"
        } else {
            "the readings are for the power law: the physics lacks something, or has parameters that the readings do not pay for"
        }
    }
}

fn log_likelihood(squares: f64, count: usize, noise: Option<f64>) -> f64 {
    let count = count as f64;
    let noise = noise.unwrap_or_else(|| libm::sqrt(squares / count));
    let scale = noise * libm::sqrt(2.0 * std::f64::consts::PI);
    -count * libm::log(scale) - 0.5 * squares / (noise * noise)
}

fn power_law(
    fit: &GroupFit,
    values: Vec<f64>,
    noise: Option<f64>,
    largest: f64,
) -> Result<super::result::Identified, IdentifyError> {
    let free = |name: &str, lower: f64, upper: f64| Free {
        name: name.to_owned(),
        lower,
        upper,
        unit: String::new(),
    };
    let frees = [free("a", 0.1 * largest, 10.0 * largest), free("c", 0.05, 20.0)];
    let group = Group {
        name: fit.name.clone(),
        unit: fit.unit.clone(),
        noise,
        clock: fit.clock.clone(),
        at: fit.at.clone(),
        values,
    };
    let settings = IdentifySettings { starts: 2, ..IdentifySettings::default() };
    identify(&frees, &Readings::new(vec![group])?, &PowerLaw(&fit.at), &settings, Watch::NONE)
}
