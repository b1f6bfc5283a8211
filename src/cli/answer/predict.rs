//! `predict --format json`.

mod asked;
mod parts;

use linkwear_gamma::life::{Band, Contribution, ErrorBudget};
use linkwear_gamma::{Machine, Prediction};
#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use self::asked::{AskedAnswer, DatesAnswer, MachineAnswer};
use self::parts::{BandsAnswer, PredictiveInterval, finite};
use super::super::calendar::Calendar;
use super::common::{Ends, Quantiles};
use super::life::Sources;

/// The remaining life of one joint. Times are in the unit of the exposure of the fit, divided by `--rate`, from the present; wear
/// is in the unit of the fit.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PredictAnswer<'a> {
    /// What it rests on: `fit`, `fit and inspections`, ..
    pub from: &'a str,
    /// Wear at failure [unit of wear].
    pub threshold: f64,
    /// Wear now [unit of wear].
    pub current: f64,
    /// Mean life [time]; null where it is not finite.
    pub mean: Option<f64>,
    /// Standard deviation of the life [time]; null where it is not finite.
    pub std: Option<f64>,
    /// Coefficient of variation of the life; null where it is not finite.
    pub cov: Option<f64>,
    /// Mean of the life rounded up to whole units of time [time].
    pub mean_whole_cycles: Option<f64>,
    /// Standard deviation of the same [time].
    pub std_whole_cycles: Option<f64>,
    /// Quantiles of the life [time]; null where so many never fail.
    pub quantiles: Quantiles<Option<f64>>,
    /// Where 95 % of such lives end [time].
    pub interval95: PredictiveInterval,
    /// How far the parameters leave numbers open, at 95 %.
    pub bands: BandsAnswer,
    /// Probability to live longer.
    pub reliability: Vec<ReliabilityAnswer>,
    /// Rate of failures of those that live.
    pub hazard: Vec<HazardAnswer>,
    /// Answers to what else was asked.
    #[serde(flatten)]
    pub asked: AskedAnswer,
    /// The same as dates, with `--from`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dates: Option<DatesAnswer>,
    /// The machine, with `--also`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub machine: Option<MachineAnswer>,
    /// How far off the mean may be; null where it is not finite.
    pub budget: Option<BudgetAnswer>,
    /// What is doubtful.
    pub warnings: Vec<&'a String>,
}

/// Probability to live longer.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ReliabilityAnswer {
    /// Than this [time].
    pub time: f64,
    /// The probability, 0 to 1.
    pub reliability: f64,
    /// Lower end of its band at 95 %.
    pub lower: f64,
    /// Upper end of its band at 95 %.
    pub upper: f64,
}

/// Rate of failures of those that live.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct HazardAnswer {
    /// At this time [time].
    pub time: f64,
    /// The rate [1/time]; null where it has no bound.
    pub hazard: Option<f64>,
}

/// How far off the mean may be: half-widths at 95 % by their source, and of all together.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct BudgetAnswer {
    #[serde(flatten)]
    pub sources: Sources<ContributionAnswer>,
    /// Of all together [time]; null if one is unknown.
    pub total: Option<f64>,
}

/// What a source of error contributes.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ContributionAnswer {
    /// Half-width at 95 % [time]; null if it is unknown.
    pub half_width: Option<f64>,
    /// `random`; `bound`, of unknown sign; `none`, does not arise; `unknown`.
    pub kind: &'static str,
    /// Why it does not arise, or is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<&'static str>,
}

impl<'a> PredictAnswer<'a> {
    /// Of a joint, perhaps of its machine, perhaps with dates.
    pub fn new(told: &'a Prediction, machine: Option<(&[String], &'a Machine)>, calendar: &Calendar) -> Self {
        let moments = told.moments.as_ref();
        let course = told.course.iter();
        Self {
            from: &told.from,
            threshold: told.threshold,
            current: told.current,
            mean: moments.map(|(moments, _)| moments.mean),
            std: moments.map(|(moments, _)| moments.std),
            cov: moments.map(|(moments, _)| moments.cov()),
            mean_whole_cycles: told.whole.map(|whole| whole.mean),
            std_whole_cycles: told.whole.map(|whole| whole.std),
            quantiles: told.quantiles.each_ref().map(|band| finite(band.value)).into(),
            interval95: PredictiveInterval {
                lower: finite(told.interval.0),
                upper: finite(told.interval.1),
                kind: told.interval_kind.name(),
            },
            bands: BandsAnswer {
                mean: moments.map(|(_, band)| Ends::from(band)),
                quantiles: told.quantiles.each_ref().map(Ends::from).into(),
            },
            reliability: course
                .clone()
                .map(|(time, Band { value, lower, upper }, _)| ReliabilityAnswer {
                    time: *time,
                    reliability: *value,
                    lower: *lower,
                    upper: *upper,
                })
                .collect(),
            hazard: course
                .map(|(time, _, hazard)| HazardAnswer { time: *time, hazard: finite(*hazard) })
                .collect(),
            asked: AskedAnswer::from(&told.answers),
            dates: DatesAnswer::new(told, calendar),
            machine: machine.map(|(names, life)| MachineAnswer::new(names, life, calendar)),
            budget: told.budget.as_ref().map(BudgetAnswer::from),
            warnings: told
                .warnings
                .iter()
                .chain(machine.iter().flat_map(|(_, life)| &life.warnings))
                .collect(),
        }
    }
}

impl From<&ErrorBudget> for BudgetAnswer {
    fn from(budget: &ErrorBudget) -> Self {
        let of = |part: Contribution| {
            let (kind, reason) = match part {
                Contribution::Random(_) => ("random", None),
                Contribution::Bound(_) => ("bound", None),
                Contribution::None(reason) => ("none", Some(reason)),
                Contribution::Unknown(reason) => ("unknown", Some(reason)),
            };
            ContributionAnswer { half_width: Some(part.half_width()), kind, reason }
        };
        Self { sources: Sources::of(budget, of), total: budget.known_total() }
    }
}
