//! A prediction: everything that is told about the remaining life of one joint. In: an estimate, the joint's state, perhaps
//! readings. Out: numbers with their bands and error budget. Never knows files or terminals.

mod interval;
mod machine;
mod questions;
#[cfg(test)]
mod tests;

use crate::error::LifeError;
use crate::inspection::{
    Effort, History, InspectionError, Mixture, Particles, Posterior, Prior, UnitPosterior,
};
use crate::life::{
    Band, Bands, Contribution, ErrorBudget, Estimate, Lifetime, Method, Moments, OperatingState, Survived,
    WithError,
};

pub use interval::IntervalKind;
use interval::{ends, interval_warning, predictive_law};
pub use machine::{Machine, Member};
pub use questions::{Answers, AtTime, Questions};
use questions::{Ask, never_warning, open, usual_quantile};

/// Times at which reliability is given, from now until all but [`TAIL`] have failed.
const TIMES: usize = 41;
const TAIL: f64 = 1e-3;

/// Uncertainty of the parameters is part of the law itself.
const WITHIN: Contribution = Contribution::None("parameters are integrated over; the law contains them");

/// The remaining life of one joint; times in the unit of the exposure's rate, from the present.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// What it rests on: `fit`, `fit and inspections`, ..
    pub from: String,
    /// Wear now.
    pub current: f64,
    /// Wear at failure.
    pub threshold: f64,
    /// Mean and standard deviation, the mean with its band; None where they are not finite, and a warning says so.
    pub moments: Option<(Moments, Band)>,
    /// The same of the time rounded up to whole units.
    pub whole: Option<Moments>,
    /// 10 %, 50 %, 90 % of the life, with what the parameters leave open; infinite where so many never fail.
    pub quantiles: [Band; 3],
    /// Ends of the interval that holds the life with probability [`Prediction::LEVEL`]; the upper one is infinite where more than its
    /// part never fails.
    pub interval: (f64, f64),
    /// How it takes the parameters.
    pub interval_kind: IntervalKind,
    /// Time, reliability with its band, hazard.
    pub course: Vec<(f64, Band, f64)>,
    /// To what else was asked.
    pub answers: Answers,
    /// Of the mean.
    pub budget: Option<ErrorBudget>,
    /// What its reader has to know.
    pub warnings: Vec<String>,
}

impl Prediction {
    /// Probability of every interval and band.
    pub const LEVEL: f64 = 0.95;

    /// From a fit alone; `method` makes the bands.
    ///
    /// # Errors
    /// [`LifeError`].
    pub fn by_fit(
        estimate: &Estimate,
        state: &OperatingState,
        method: Method,
        questions: &Questions,
    ) -> Result<Self, LifeError> {
        let life = state.life(estimate)?;
        let bands = Bands::new(estimate, state, Self::LEVEL, method)?;
        let mut answer = Self::ask((&life, state), "fit", questions, &|ask, _| {
            bands.band(ask.scale(), &|life| ask.open(&Survived::new(life, questions.survived)?))
        })?;
        let (law, kind) = predictive_law(estimate, state)?;
        answer.interval = ends(&Survived::new(&*law, questions.survived)?)?;
        answer.interval_kind = kind;
        answer.warnings.extend(interval_warning(estimate, kind));
        let known = Contribution::None("the fit gives no covariance");
        answer.complete(Contribution::None("closed form"), (!estimate.is_uncertain()).then_some(known));
        Ok(answer)
    }

    /// After exact readings; the last one is the present, `state` gives threshold and rate.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn after(
        history: &History,
        prior: &Prior,
        state: &OperatingState,
        questions: &Questions,
    ) -> Result<Self, InspectionError> {
        let last = history.last();
        let now = state.clone().worn(last.wear, state.rate() * last.time)?;
        let from = match prior {
            Prior::Flat { .. } | Prior::Matching { .. } => "inspections alone",
            Prior::Catalogue { .. } => "catalogue and inspections",
            Prior::Fit(_) => "fit and inspections",
        };
        let posterior: Box<dyn Mixture> = match prior {
            Prior::Fit(fit) if fit.units_differ() => Box::new(UnitPosterior::update(history, fit, state)?),
            _ => Box::new(Posterior::update(history, prior, state)?),
        };
        let mut answer = Self::ask((&*posterior, &now), from, questions, &|ask, value| {
            ask.of(&*posterior, questions.survived, value, Self::LEVEL)
        })?;
        answer.complete(Contribution::None("closed forms, quadrature over parameters"), Some(WITHIN));
        Ok(answer)
    }

    /// After readings with a normal error of standard deviation `gauge` \[unit of wear\]; the last one is the present, `state`
    /// gives threshold and rate.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn after_gauge(
        history: &History,
        prior: &Estimate,
        state: &OperatingState,
        gauge: f64,
        effort: Effort,
        questions: &Questions,
    ) -> Result<Self, InspectionError> {
        let particles = Particles::follow(history, prior, state, gauge, effort)?;
        let from = "fit and inspections with gauge error";
        let mut answer = Self::ask((&particles, state), from, questions, &|ask, value| {
            ask.of(&particles, questions.survived, value, Self::LEVEL)
        })?;
        answer.current = particles.wear().0;
        let mean = answer.moments.map_or(f64::NAN, |(moments, _)| moments.mean);
        let error = WithError { value: mean, error: particles.mean_error() };
        answer.complete(ErrorBudget::monte_carlo(error), Some(WITHIN));
        if particles.failed_already() > 0.0 {
            answer.warnings.push(format!(
                "with probability {:.2} the joint had failed at the last reading: the answer is for one that had not",
                particles.failed_already()
            ));
        }
        Ok(answer)
    }

    fn ask(
        (life, state): (&dyn Lifetime, &OperatingState),
        from: &str,
        questions: &Questions,
        band: &dyn Fn(Ask, f64) -> Result<Band, LifeError>,
    ) -> Result<Self, LifeError> {
        questions.check()?;
        let life = &Survived::new(life, questions.survived)?;
        let mut warnings = Vec::new();
        let (moments, whole) = match (life.moments(), life.whole_cycles()) {
            (Ok(moments), Ok(whole)) => (Some((moments, band(Ask::Mean, moments.mean)?)), Some(whole)),
            (Err(error), _) | (_, Err(error)) => {
                warnings.push(error.to_string());
                (None, None)
            }
        };
        warnings.extend(never_warning(life, TAIL));
        let quantile = |p: f64| usual_quantile(life, p, band);
        let quantiles = [quantile(0.1)?, quantile(0.5)?, quantile(0.9)?];
        // So far out there may be no number; the course then ends with the last that has been told.
        let told = quantiles.iter().rev().map(|band| band.value);
        let known = std::iter::once(open(life.quantile(1.0 - TAIL))?).chain(told);
        let end = known.into_iter().find(|end| end.is_finite()).unwrap_or(life.typical());
        let mut course = Vec::with_capacity(TIMES);
        for k in 0..TIMES {
            let t = end * k as f64 / (TIMES - 1) as f64;
            course.push((t, band(Ask::Reliability(t), life.reliability(t))?, life.hazard(t)));
        }
        Ok(Self {
            from: from.to_owned(),
            current: state.current(),
            threshold: state.threshold(),
            moments,
            whole,
            quantiles,
            interval: ends(life)?,
            // The law of a posterior contains the parameters; of a fit it is set by its caller.
            interval_kind: IntervalKind::Predictive,
            course,
            answers: questions.answers(life, band)?,
            budget: None,
            warnings,
        })
    }

    /// Adds the budget of the mean. `parameters`: None takes the band of the mean.
    fn complete(&mut self, monte_carlo: Contribution, parameters: Option<Contribution>) {
        self.budget = self.moments.map(|(_, band)| ErrorBudget {
            monte_carlo,
            table: Contribution::None("exposure is a formula"),
            settling: None,
            averaging: None,
            parameters: parameters.unwrap_or_else(|| ErrorBudget::parameters(band)),
        });
    }
}
