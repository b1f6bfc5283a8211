//! What `predict` answers if it is asked: quantiles, times, missions, dates, the machine.

use linkwear_gamma::life::Band;
use linkwear_gamma::{Answers, Machine, Prediction};
#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use super::super::super::calendar::Calendar;
use super::super::common::{Ends, Quantiles};
use super::parts::{BandsAnswer, PredictiveInterval, finite};

/// Answers to what was asked beyond the usual.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct AskedAnswer {
    /// With `--quantile`: by when a part has failed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub asked_quantiles: Vec<QuantileAnswer>,
    /// With `--reliability-at`: how it stands at these times.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub asked_times: Vec<TimeAnswer>,
    /// With `--mission`: how probable it is to get through.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missions: Vec<MissionAnswer>,
}

/// By when a part has failed.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct QuantileAnswer {
    /// The part, 0 to 1.
    pub p: f64,
    /// The time [time].
    pub time: f64,
    /// Its band at 95 % [time].
    #[serde(flatten)]
    pub band: Ends,
}

/// How it stands at a time.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct TimeAnswer {
    /// The time [time].
    pub time: f64,
    /// Probability of no failure until then.
    pub reliability: f64,
    /// Its band at 95 %.
    #[serde(flatten)]
    pub band: Ends,
    /// Rate of failures of those without [1/time]; null where it has no bound.
    pub hazard: Option<f64>,
    /// Mean of what is left to those without [time]; null where it is not finite or nearly none are left.
    pub mean_residual_life: Option<f64>,
    /// Its band at 95 % [time].
    pub mean_residual_life_band: Option<Ends>,
}

/// How probable it is to get through a mission, for those that begin it.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MissionAnswer {
    /// Begin [time].
    pub from: f64,
    /// End [time].
    pub to: f64,
    /// The probability.
    pub survival: f64,
    /// Its band at 95 %.
    #[serde(flatten)]
    pub band: Ends,
}

/// Days on which times end, as 2026-11-23; null after the year 9999.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct DatesAnswer {
    /// Of the mean.
    pub mean: Option<String>,
    /// Of the quantiles.
    pub quantiles: Quantiles<Option<String>>,
    /// Of the ends of `interval95`.
    pub interval95: DateEnds,
    /// Of the quantiles that were asked for, in their order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub asked_quantiles: Vec<Option<String>>,
}

/// First and last day of an interval.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct DateEnds {
    /// The first.
    pub lower: Option<String>,
    /// The last.
    pub upper: Option<String>,
}

/// The life of a machine, which fails with the first of its joints.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MachineAnswer {
    /// Mean life [time]; null where it is not finite.
    pub mean: Option<f64>,
    /// Standard deviation of the life [time]; null where it is not finite.
    pub std: Option<f64>,
    /// Quantiles of the life [time]; null where so many never fail.
    pub quantiles: Quantiles<Option<f64>>,
    /// Where 95 % of such lives end [time].
    pub interval95: PredictiveInterval,
    /// How far the parameters leave numbers open, at 95 %.
    pub bands: BandsAnswer,
    /// Answers to what else was asked.
    #[serde(flatten)]
    pub asked: AskedAnswer,
    /// The same as dates, with `--from`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dates: Option<DatesAnswer>,
    /// How probable it is that a joint fails first.
    pub first_to_fail: Vec<FirstAnswer>,
}

/// How probable it is that a joint fails first.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FirstAnswer {
    /// The joint: the name of its fit's file.
    pub joint: String,
    /// The probability.
    pub probability: f64,
}

impl From<&Band> for Ends {
    fn from(band: &Band) -> Self {
        Self { lower: finite(band.lower), upper: finite(band.upper) }
    }
}

impl From<&Answers> for AskedAnswer {
    fn from(answers: &Answers) -> Self {
        let quantile =
            |(p, band): &(f64, Band)| QuantileAnswer { p: *p, time: band.value, band: band.into() };
        let time = |at: &linkwear_gamma::AtTime| TimeAnswer {
            time: at.time,
            reliability: at.reliability.value,
            band: (&at.reliability).into(),
            hazard: finite(at.hazard),
            mean_residual_life: at.rest.map(|rest| rest.value),
            mean_residual_life_band: at.rest.as_ref().map(Ends::from),
        };
        let mission = |([from, to], band): &([f64; 2], Band)| MissionAnswer {
            from: *from,
            to: *to,
            survival: band.value,
            band: band.into(),
        };
        Self {
            asked_quantiles: answers.quantiles.iter().map(quantile).collect(),
            asked_times: answers.times.iter().map(time).collect(),
            missions: answers.missions.iter().map(mission).collect(),
        }
    }
}

impl DatesAnswer {
    /// Of a joint's life, if dates are asked for.
    pub fn new(told: &Prediction, calendar: &Calendar) -> Option<Self> {
        let mean = told.moments.as_ref().map(|(moments, _)| moments.mean);
        Self::of(mean, &told.quantiles, told.interval, &told.answers, calendar)
    }

    fn of(
        mean: Option<f64>,
        quantiles: &[Band; 3],
        (lower, upper): (f64, f64),
        answers: &Answers,
        calendar: &Calendar,
    ) -> Option<Self> {
        calendar.is_given().then(|| Self {
            mean: mean.and_then(|mean| calendar.json(mean)),
            quantiles: quantiles.each_ref().map(|band| calendar.json(band.value)).into(),
            interval95: DateEnds { lower: calendar.json(lower), upper: calendar.json(upper) },
            asked_quantiles: answers.quantiles.iter().map(|(_, band)| calendar.json(band.value)).collect(),
        })
    }
}

impl MachineAnswer {
    /// Of a machine whose joints have these names, perhaps with dates.
    pub fn new(names: &[String], life: &Machine, calendar: &Calendar) -> Self {
        let moments = life.moments.as_ref();
        let mean = moments.map(|(moments, _)| moments.mean);
        let first = names.iter().zip(&life.first);
        Self {
            mean,
            std: moments.map(|(moments, _)| moments.std),
            quantiles: life.quantiles.each_ref().map(|band| finite(band.value)).into(),
            interval95: PredictiveInterval {
                lower: finite(life.interval.0),
                upper: finite(life.interval.1),
                kind: life.interval_kind.name(),
            },
            bands: BandsAnswer {
                mean: moments.map(|(_, band)| Ends::from(band)),
                quantiles: life.quantiles.each_ref().map(Ends::from).into(),
            },
            asked: AskedAnswer::from(&life.answers),
            dates: DatesAnswer::of(mean, &life.quantiles, life.interval, &life.answers, calendar),
            first_to_fail: first
                .map(|(joint, probability)| FirstAnswer { joint: joint.clone(), probability: *probability })
                .collect(),
        }
    }
}
