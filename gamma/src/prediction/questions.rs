//! What can be asked of a remaining life, and its answers with their bands. In: a law of life. Out: numbers.
//! Never knows where the law is from.

use crate::error::{LifeError, non_negative, probability};
use crate::inspection::Mixture;
use crate::life::{Band, FirstPassage, Lifetime, Scale, Survived};

/// What is asked beyond the usual. Times run from the present, in the unit of the exposure's rate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Questions {
    /// For how long the joint has gone on without failing, unseen, since its wear was known: all answers are from the end of that
    /// time on.
    pub survived: f64,
    /// Parts that have failed: 0.01 asks for B1.
    pub quantiles: Vec<f64>,
    /// Times at which reliability, hazard and the mean residual life are asked.
    pub times: Vec<f64>,
    /// Missions, from begin to end: how probable it is to get through one, for a joint that begins it.
    pub missions: Vec<[f64; 2]>,
}

/// The answers, in the order asked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answers {
    /// The part that has failed, and by when.
    pub quantiles: Vec<(f64, Band)>,
    /// At the times asked.
    pub times: Vec<AtTime>,
    /// Begin and end of a mission, and the probability to get through.
    pub missions: Vec<([f64; 2], Band)>,
}

/// How a joint stands at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct AtTime {
    /// The time.
    pub time: f64,
    /// Probability of no failure until then.
    pub reliability: Band,
    /// Failures per unit of time among those without.
    pub hazard: f64,
    /// Mean of what is left to those without; None where it is not finite, or fewer than 1e-12 are left.
    pub rest: Option<Band>,
}

/// A time, infinite where there is none: part of the lives never end, or end beyond all numbers.
pub(super) fn open(time: Result<f64, LifeError>) -> Result<f64, LifeError> {
    match time {
        Err(LifeError::Never { .. } | LifeError::Endless { .. }) => Ok(f64::INFINITY),
        time => time,
    }
}

/// The time by which the part `p` has failed with its band, which nobody has asked for: infinite where there is none.
pub(super) fn usual_quantile(
    life: &dyn Lifetime,
    p: f64,
    band: &dyn Fn(Ask, f64) -> Result<Band, LifeError>,
) -> Result<Band, LifeError> {
    let value = open(life.quantile(p))?;
    if value.is_finite() {
        band(Ask::Quantile(p), value)
    } else {
        Ok(Band { value, lower: value, upper: value })
    }
}

/// What a reader has to know of lives that may not end; none where all but a small part do.
pub(super) fn never_warning(life: &dyn Lifetime, part: f64) -> Option<String> {
    let ever = life.ever();
    (ever <= 1.0 - part).then(|| {
        format!(
            "the part {ever:.4} ever fails, as drifts of units may be below zero: later quantiles do not exist, and ends of intervals are open"
        )
    })
}

/// One question.
#[derive(Clone, Copy)]
pub(super) enum Ask {
    Mean,
    Quantile(f64),
    Reliability(f64),
    /// Mean of what is left after a time.
    Rest(f64),
    Mission([f64; 2]),
}

impl Ask {
    /// Its answer by a law.
    pub(super) fn by(self, life: &dyn Lifetime) -> Result<f64, LifeError> {
        match self {
            Self::Mean => Ok(life.moments()?.mean),
            Self::Quantile(p) => life.quantile(p),
            Self::Reliability(t) => Ok(life.reliability(t)),
            Self::Rest(t) => Survived::new(life, t)?.mean(),
            Self::Mission([from, to]) => Ok(Survived::new(life, from)?.reliability(to - from)),
        }
    }

    /// The same where there may be no time by which so many have failed: it is infinite then.
    pub(super) fn open(self, life: &dyn Lifetime) -> Result<f64, LifeError> {
        open(self.by(life))
    }

    pub(super) fn scale(self) -> Scale {
        match self {
            Self::Reliability(_) | Self::Mission(_) => Scale::Logit,
            Self::Mean | Self::Quantile(_) | Self::Rest(_) => Scale::Log,
        }
    }

    /// The same by the laws that a mixture is of, around the mixture's own `value`: how far the parameters leave it open to joints
    /// that have survived for a time.
    pub(super) fn of(
        self,
        mixture: &dyn Mixture,
        survived: f64,
        value: f64,
        level: f64,
    ) -> Result<Band, LifeError> {
        let one = |life: &FirstPassage| {
            let alive = life.reliability(survived);
            // A law that leaves nobody alive has no weight; what it would answer does not matter.
            let Ok(rest) = Survived::new(life, survived) else { return Ok((value, 0.0)) };
            match self.open(&rest) {
                Err(LifeError::NoneSurvives { .. }) => Ok((value, 0.0)),
                answer => Ok((answer?, alive)),
            }
        };
        mixture.credible(value, level, &one)
    }
}

impl Questions {
    /// Refuses what cannot be asked.
    pub(super) fn check(&self) -> Result<(), LifeError> {
        for p in &self.quantiles {
            probability(*p)?;
        }
        for t in &self.times {
            non_negative("a time that is asked for", *t)?;
        }
        for [from, to] in self.missions.iter().copied() {
            non_negative("the begin of a mission", from)?;
            // Not a number is no later end.
            if !(to > from && to.is_finite()) {
                return Err(LifeError::Span { from, to });
            }
        }
        Ok(())
    }

    /// The answers of a law, with bands made by `band` around them.
    pub(super) fn answers(
        &self,
        life: &dyn Lifetime,
        band: &dyn Fn(Ask, f64) -> Result<Band, LifeError>,
    ) -> Result<Answers, LifeError> {
        let told = |ask: Ask| {
            let value = ask.by(life)?;
            band(ask, value)
        };
        let mut answers = Answers::default();
        for p in self.quantiles.iter().copied() {
            answers.quantiles.push((p, told(Ask::Quantile(p))?));
        }
        for time in self.times.iter().copied() {
            answers.times.push(AtTime {
                time,
                reliability: told(Ask::Reliability(time))?,
                hazard: life.hazard(time),
                rest: told(Ask::Rest(time)).ok(),
            });
        }
        for mission in self.missions.iter().copied() {
            answers.missions.push((mission, told(Ask::Mission(mission))?));
        }
        Ok(answers)
    }
}
