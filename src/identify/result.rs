//! What was identified. In: nothing. Out: types. Never knows how it was found.

use super::free::Free;
use super::residuals::Whiteness;

/// Whether a parameter has a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It has, with an error.
    Estimated,
    /// The best value would lie below its lower bound.
    AtLower,
    /// The best value would lie above its upper bound.
    AtUpper,
    /// The interval is as wide as the bounds: the readings say no more than these.
    NotIdentified,
}

/// A parameter, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimated {
    /// The parameter.
    pub free: Free,
    /// Where the search came to rest; an estimate if `state` says so.
    pub value: f64,
    /// Whether it is an estimate.
    pub state: State,
    /// Standard error, by the sensitivities.
    pub error: Option<f64>,
    /// 95 % interval; no end where it lies beyond the bounds.
    pub interval: [Option<f64>; 2],
    /// Whether the interval is by the profile of the likelihood: by the standard error it would be wrong.
    pub by_profile: bool,
    /// How far sensitivities by two steps were apart, as a part of them.
    pub doubt: f64,
}

/// A direction in the space of the parameters, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Singular value of the sensitivities, in units of the noise per width of the bounds.
    pub singular_value: f64,
    /// Whether the readings tell it.
    pub is_identified: bool,
    /// Parameters with their parts of it, the squares of which add up to 1.
    pub parts: Vec<(String, f64)>,
}

/// What is known of parameters that are not identified by themselves: a product of powers, or, of those that go by their value, a sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Parameters with their powers, or factors.
    pub parts: Vec<(String, f64)>,
    /// Whether it is a product of powers.
    pub is_product: bool,
    /// Its value, in the units of the parameters.
    pub value: f64,
    /// 95 % interval.
    pub interval: [f64; 2],
}

/// A group of readings beside its prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupFit {
    /// What was read.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// What `at` counts, with its unit.
    pub clock: String,
    /// When.
    pub at: Vec<f64>,
    /// The readings.
    pub measured: Vec<f64>,
    /// What the model says.
    pub predicted: Vec<f64>,
    /// Standard deviation of the noise, given or estimated.
    pub noise: f64,
    /// Whether it was given.
    pub noise_is_given: bool,
    /// Root of the mean square of the residuals.
    pub rms: f64,
    /// Whether the residuals are noise.
    pub whiteness: Whiteness,
}

/// Residuals against noise that is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// Sum of their squares, in units of the noise.
    pub chi_squared: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// Probability that noise alone gives as much.
    pub p: f64,
}

/// A minimum that searches came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Sum of the squares over that of the best.
    pub over_best: f64,
    /// Searches that ended here.
    pub searches: usize,
}

/// All that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// The parameters, in their order.
    pub parameters: Vec<Estimated>,
    /// Correlations of the parameters that no bound holds; none of others.
    pub correlations: Vec<Vec<Option<f64>>>,
    /// By falling singular value.
    pub directions: Vec<Direction>,
    /// What is known of parameters that are not identified.
    pub combinations: Vec<Combination>,
    /// The readings.
    pub groups: Vec<GroupFit>,
    /// Where all noise is given.
    pub misfit: Option<Misfit>,
    /// Minima, the best first.
    pub minima: Vec<Minimum>,
    /// Degrees of freedom of Student's law; none: the normal law, as all noise is given.
    pub degrees: Option<usize>,
    /// Logarithm of the likelihood of independent normal noise.
    pub log_likelihood: f64,
    /// Akaike's criterion: parameters, and noise that is estimated, count.
    pub aic: f64,
    /// Whether the best search came to rest.
    pub converged: bool,
    /// Runs of the model.
    pub runs: u64,
    /// What is doubtful.
    pub warnings: Vec<String>,
}

impl Identified {
    /// Values of all parameters.
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|one| one.value).collect()
    }

    /// Words of `--set` for the parameters that are estimated, each rounded by less than a thousandth of its error.
    pub fn set_words(&self) -> Vec<String> {
        let estimated = self.parameters.iter().filter(|one| one.state == State::Estimated);
        estimated.map(|one| format!("{}={}", one.free.name, one.free.written(one.rounded()))).collect()
    }
}

impl Estimated {
    fn rounded(&self) -> f64 {
        let digits = libm::log10(self.value.abs() / self.error.unwrap_or(0.0)) + 4.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 4 and 16")]
        let digits = if digits.is_finite() { digits.ceil().clamp(4.0, 16.0) as usize } else { 16 };
        format!("{:.*e}", digits - 1, self.value).parse().unwrap_or(self.value)
    }
}
