//! `identify --format json`. SI throughout.

use std::collections::BTreeMap;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use super::common::Ends;
use crate::identify::{Clock, Clocks, Combination, Direction, Estimated, GroupFit, State};

/// Parameters of a mechanism by what was measured of its machine.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct IdentifyAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// The parameters that were sought.
    pub parameters: Vec<ParameterAnswer<'a>>,
    /// Words of --set for those that are estimated, in the units of their bounds.
    pub set: Vec<String>,
    /// Correlations of the estimates, in the order of the parameters; null for those at a bound.
    pub correlations: &'a [Vec<Option<f64>>],
    /// Directions in the space of the parameters, by falling singular value of the scaled sensitivities.
    pub directions: Vec<DirectionAnswer>,
    /// What is known of parameters that are not identified by themselves.
    pub combinations: Vec<CombinationAnswer>,
    /// The readings beside their predictions.
    pub groups: Vec<GroupAnswer<'a>>,
    /// Whether the noise explains the residuals; null where noise is estimated.
    pub misfit: Option<MisfitAnswer>,
    /// Minima that searches came to, the best first.
    pub minima: Vec<MinimumAnswer>,
    /// Degrees of freedom of Student's law behind the intervals; null where all noise is given: the normal law.
    pub degrees_of_freedom: Option<usize>,
    /// Logarithm of the likelihood of independent normal noise.
    pub log_likelihood: f64,
    /// Akaike's criterion; parameters, and noise that is estimated, count.
    pub aic: f64,
    /// Whether the best search came to rest.
    pub converged: bool,
    /// Runs of the model.
    pub runs: u64,
    /// For each joint that was inspected often enough: the clock of the physics beside a power of the revolutions.
    pub clocks: Vec<ClocksAnswer<'a>>,
    /// What is doubtful.
    pub warnings: Vec<IdentifyWarning<'a>>,
}

/// A parameter.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ParameterAnswer<'a> {
    /// Its name.
    name: &'a str,
    /// Its SI unit, 1 if it has none.
    unit: &'a str,
    /// `estimated`, `at_lower_bound`, `at_upper_bound`, `not_identified`.
    state: &'static str,
    /// The estimate; null unless `state` is `estimated`.
    estimate: Option<f64>,
    /// Standard error, by the sensitivities; null where there is no estimate.
    standard_error: Option<f64>,
    /// 95 % interval; an end is null where it lies beyond the bounds.
    interval95: Ends,
    /// Whether the interval is by the profile of the likelihood, since this is no parabola.
    by_profile: bool,
    /// The bounds.
    bounds: Ends,
    /// How far sensitivities by two steps were apart, as a part of them.
    sensitivity_doubt: f64,
}

/// A direction in the space of the parameters, each measured by the width of its bounds (by logarithms where these are positive).
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct DirectionAnswer {
    /// Singular value, in units of the noise per width of the bounds; 0 where it is less than the error of the sensitivities.
    singular_value: f64,
    /// Whether the readings tell it.
    identified: bool,
    /// Parts of the parameters; their squares add up to 1.
    parts: BTreeMap<String, f64>,
}

/// A product of powers, or a sum.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CombinationAnswer {
    /// Powers of a product, or factors of a sum.
    parts: BTreeMap<String, f64>,
    /// Whether it is a product of powers.
    product: bool,
    /// Its value.
    value: f64,
    /// 95 % interval.
    interval95: Ends,
}

/// Readings of a column, or of a joint's wear.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct GroupAnswer<'a> {
    /// The column or the joint.
    name: &'a str,
    /// SI unit.
    unit: &'a str,
    /// Standard deviation of the noise, given or estimated.
    noise: f64,
    /// Whether it was given.
    noise_given: bool,
    /// Root of the mean square of the residuals.
    rms: f64,
    /// Correlation of neighbouring residuals.
    neighbours: f64,
    /// Probability that independent noise hangs together as much (Ljung-Box); null with too few readings.
    white_p: Option<f64>,
    /// So many readings count as one in the errors.
    per_independent: f64,
    /// What `at` counts, with its unit: `t [s]`, `revolutions`.
    clock: &'a str,
    /// When each was read.
    at: &'a [f64],
    /// The readings.
    measured: &'a [f64],
    /// What the model says.
    predicted: &'a [f64],
}

/// Residuals against noise that is given.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MisfitAnswer {
    /// Sum of the squares in units of the noise.
    pub chi_squared: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// Probability that noise alone gives as much.
    pub p: f64,
}

/// A minimum.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MinimumAnswer {
    /// Values of the parameters, in their order.
    pub values: Vec<f64>,
    /// Sum of the squares over that of the best.
    pub over_best: f64,
    /// Searches that ended here.
    pub searches: usize,
}

/// The clock of the physics beside a power law of the revolutions.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ClocksAnswer<'a> {
    /// The joint.
    joint: &'a str,
    /// Wear by the physics, fed back to the clearance.
    physics: ClockAnswer,
    /// Wear by a power of revolutions or time.
    power_law: ClockAnswer,
    /// Exponent of the power law.
    exponent: f64,
    /// Its 95 % interval.
    interval95: Ends,
    /// Exponent of the power law that comes nearest to the path of the physics.
    physics_exponent: f64,
    /// Akaike's criterion of the power law minus that of the physics.
    aic_difference: f64,
    /// What that says.
    verdict: &'static str,
}

/// How likely the readings are by a clock.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ClockAnswer {
    /// Logarithm of the likelihood.
    log_likelihood: f64,
    /// Akaike's criterion.
    aic: f64,
}

/// What is doubtful.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct IdentifyWarning<'a> {
    /// `identify`.
    code: &'static str,
    /// What is doubtful.
    message: &'a str,
}

impl<'a> IdentifyWarning<'a> {
    /// Of a message.
    pub fn new(message: &'a str) -> Self {
        Self { code: "identify", message }
    }
}

impl<'a> ParameterAnswer<'a> {
    /// In SI, by the size of its unit.
    pub fn new(one: &'a Estimated, (size, unit): &'a (f64, String)) -> Self {
        let is_estimated = one.state == State::Estimated;
        let ends = |[lower, upper]: [Option<f64>; 2]| Ends {
            lower: lower.map(|end| end * size),
            upper: upper.map(|end| end * size),
        };
        Self {
            name: &one.free.name,
            unit,
            state: match one.state {
                State::Estimated => "estimated",
                State::AtLower => "at_lower_bound",
                State::AtUpper => "at_upper_bound",
                State::NotIdentified => "not_identified",
            },
            estimate: is_estimated.then_some(one.value * size),
            standard_error: one.error.map(|error| error * size),
            interval95: ends(one.interval),
            by_profile: one.by_profile,
            bounds: ends([Some(one.free.lower), Some(one.free.upper)]),
            sensitivity_doubt: one.doubt,
        }
    }
}

impl From<&Direction> for DirectionAnswer {
    fn from(one: &Direction) -> Self {
        let Direction { singular_value, is_identified, parts } = one;
        Self {
            singular_value: *singular_value,
            identified: *is_identified,
            parts: parts.iter().cloned().collect(),
        }
    }
}

impl CombinationAnswer {
    /// In SI, by the size of each parameter's unit.
    pub fn new(one: &Combination, size: impl Fn(&str) -> f64) -> Self {
        let scale = if one.is_product {
            one.parts.iter().map(|(name, power)| size(name).powf(*power)).product()
        } else {
            1.0
        };
        let part = |(name, part): &(String, f64)| {
            let factor = if one.is_product { *part } else { part / size(name) };
            (name.clone(), factor)
        };
        let [lower, upper] = one.interval.map(|end| Some(end * scale));
        Self {
            parts: one.parts.iter().map(part).collect(),
            product: one.is_product,
            value: one.value * scale,
            interval95: Ends { lower, upper },
        }
    }
}

impl<'a> From<&'a GroupFit> for GroupAnswer<'a> {
    fn from(one: &'a GroupFit) -> Self {
        Self {
            name: &one.name,
            unit: &one.unit,
            noise: one.noise,
            noise_given: one.noise_is_given,
            rms: one.rms,
            neighbours: one.whiteness.neighbours,
            white_p: one.whiteness.p,
            per_independent: one.whiteness.per_independent,
            clock: &one.clock,
            at: &one.at,
            measured: &one.measured,
            predicted: &one.predicted,
        }
    }
}

impl From<Clock> for ClockAnswer {
    fn from(Clock { log_likelihood, aic }: Clock) -> Self {
        Self { log_likelihood, aic }
    }
}

impl<'a> From<&'a Clocks> for ClocksAnswer<'a> {
    fn from(one: &'a Clocks) -> Self {
        let [lower, upper] = one.interval;
        Self {
            joint: &one.joint,
            physics: one.physics.into(),
            power_law: one.power.into(),
            exponent: one.exponent,
            interval95: Ends { lower, upper },
            physics_exponent: one.physics_exponent,
            aic_difference: one.difference(),
            verdict: one.verdict(),
        }
    }
}
