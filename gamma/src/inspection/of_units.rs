//! One unit after exact readings, where units differ. In: readings, an estimate whose units differ, the state of the unit. Out: sets of
//! parameters weighed by the readings, each with the law of this unit; a [`Lifetime`] mixed from them. Never knows files.
//!
//! Given the parameters that units share, the law of the unit's own is closed, so only those are drawn: from the normal law of
//! their logarithms, or as the fit's data leave them.

use super::credible::Mixture;
use super::error::InspectionError;
use super::history::History;
use crate::error::LifeError;
use crate::life::{Estimate, FirstPassage, Lifetime, OperatingState, Sample, SeenUnit, mixed_hazard};
use crate::random::Stream;

/// Sets drawn where the estimate brings none.
const DRAWN: usize = 2000;
const SEED: u64 = 0;
/// Weight, beside the largest, below which a set is left out: thousands of them are less than 1e-6 of all.
const NEGLIGIBLE: f64 = 1e-10;
/// Sets of equal weight that the answer is worth at least.
const FEWEST: f64 = 50.0;

/// The unit as its readings leave it.
#[derive(Debug)]
pub struct UnitPosterior {
    lives: Vec<(f64, FirstPassage)>,
}

impl UnitPosterior {
    /// After the readings of `history`; `state` gives threshold and exposure per unit of time, the last reading the present.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn update(
        history: &History,
        prior: &Estimate,
        state: &OperatingState,
    ) -> Result<Self, InspectionError> {
        let last = history.last();
        let now = state.clone().worn(last.wear, state.rate() * last.time)?;
        let increments = history.increments(state.rate());
        let wear = increments.iter().map(|one| one[2]).sum();
        let seen = SeenUnit { spans: increments.iter().map(|one| [one[0], one[1]]).collect(), wear };
        let unit = prior.clone().of_unit(seen);
        let sets: Vec<(Vec<f64>, f64)> = match prior.sample() {
            Sample::Sets(sets) => sets.iter().map(|set| (set.logs.clone(), set.weight)).collect(),
            _ if prior.is_uncertain() => {
                (0..DRAWN).map(|at| (prior.drawn_logs(&mut Stream::new(SEED, at as u64, 0)), 1.0)).collect()
            }
            _ => vec![(prior.logs().to_vec(), 1.0)],
        };
        let count = sets.len() as f64;
        let weighed = sets.into_iter().map(|(logs, weight)| {
            let ln = libm::log(weight) + prior.ln_likelihood(&logs, &increments);
            (logs, ln)
        });
        let weighed: Vec<(Vec<f64>, f64)> = weighed.filter(|(_, ln)| ln.is_finite()).collect();
        let top = weighed.iter().map(|(_, ln)| *ln).fold(f64::NEG_INFINITY, f64::max);
        let mut lives = Vec::new();
        for (logs, ln) in weighed {
            let weight = libm::exp(ln - top);
            if weight > NEGLIGIBLE {
                lives.push((weight, now.life_by(&unit, &logs)?));
            }
        }
        let all: f64 = lives.iter().map(|(weight, _)| weight).sum();
        lives.iter_mut().for_each(|(weight, _)| *weight /= all);
        let worth = 1.0 / lives.iter().map(|(weight, _)| weight * weight).sum::<f64>();
        let enough = worth >= FEWEST.min(count);
        if !enough {
            let (distinct, row) = (lives.len(), history.readings().len());
            return Err(InspectionError::Contradiction { distinct, row });
        }
        Ok(Self { lives })
    }

    fn mean(&self, of: impl Fn(&FirstPassage) -> f64) -> f64 {
        self.lives.iter().map(|(weight, life)| weight * of(life)).sum()
    }
}

impl Lifetime for UnitPosterior {
    fn accuracy(&self) -> f64 {
        1e-7
    }

    fn reliability(&self, t: f64) -> f64 {
        self.mean(|life| life.reliability(t))
    }

    fn failed(&self, t: f64) -> f64 {
        self.mean(|life| life.failed(t))
    }

    fn typical(&self) -> f64 {
        self.mean(Lifetime::typical)
    }

    fn ever(&self) -> f64 {
        self.mean(Lifetime::ever)
    }

    fn finite_moments(&self) -> Result<(), LifeError> {
        self.lives.first().map_or(Ok(()), |(_, life)| life.finite_moments())
    }

    fn hazard(&self, t: f64) -> f64 {
        mixed_hazard(self.lives.iter().map(|(weight, life)| (weight * life.reliability(t), life.hazard(t))))
    }
}

impl Mixture for UnitPosterior {
    fn parts(&self) -> Vec<(f64, &FirstPassage)> {
        self.lives.iter().map(|(weight, life)| (*weight, life)).collect()
    }
}
