//! What one look at a part is worth. In: the part's state, costs, the time of the look. Out: expected costs with and without
//! it. Never knows where the state comes from.
//!
//! The part in use ends, at failure or in time, and another takes its place, which costs g per unit of time from then on,
//! whatever happens before. So a unit of time that the part in use lasts saves g: without a look it is replaced at the age T of
//! the least
//!
//! ```text
//! V(T) = (c_p - g t_p) S(T) + (c_f - g t_f) F(T) - g int_0^T S dt
//! ```
//!
//! since standstills t_p and t_f put the next part off, too; with a look at time u one knows the wear then and plans on from
//! there; the worth of the look is what the expectation of that is below, before the look's own cost.

use super::condition::known_by_its_wear;
use super::costs::Costs;
use super::error::PlanError;
use super::mean_use::{MeanUse, ages};
use super::search::least;
use crate::error::positive;
use crate::life::{Clock, Estimate, FirstPassage, Law, LifeError, Lifetime, OperatingState};

/// Accuracy of an integral over reliability, as a part of the time; costs are told to four digits.
const ACCURACY: f64 = 1e-8;
/// Wear at the look is told apart at even steps of the logit of its probability. Costs are smooth in it, but for where the part is replaced
/// at once: the sum is good to a part in 1e4 of what the look is worth. Middles of even parts of the probability see too little of
/// the tails, where that comes from: of 64 parts it was up to a tenth too large.
const STEPS: i32 = 64;
/// How far from 0 that logit is taken, in so many steps either way: 4e-9 of the probability are beyond.
const FARTHEST: f64 = 20.0;
/// Halvings that tell from which wear on the part is replaced at once.
const HALVINGS: u32 = 20;
/// Ages tried, by their probability of failure.
const TRIED: usize = 40;
/// The last of them.
const LATEST: f64 = 1e-4;

/// A part in use.
#[derive(Clone, Debug)]
pub struct InUse {
    /// Law of its wear.
    pub law: Law,
    /// How exposure runs.
    pub clock: Clock,
    /// Wear at failure.
    pub failure: f64,
    /// Wear now.
    pub current: f64,
    /// Time now, on the clock.
    pub now: f64,
}

impl InUse {
    /// Of an estimate, in a state.
    ///
    /// # Errors
    /// [`LifeError`], if a parameter leaves the range of numbers.
    pub fn of(estimate: &Estimate, state: &OperatingState) -> Result<Self, LifeError> {
        let (law, clock) = state.wear(estimate)?;
        let now = state.exposure() / state.rate();
        Ok(Self { law, clock, failure: state.threshold(), current: state.current(), now })
    }
}

/// Expected costs of the part in use, each beside what the time it lasts saves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worth {
    /// Without the look.
    pub without: f64,
    /// When it is replaced then, from now \[time\]; None if at failure only.
    pub replace_after: Option<f64>,
    /// With the look, before its own cost.
    pub with: f64,
    /// Probability that it fails before the look.
    pub fails_before: f64,
    /// Probability that the look shows that it has to be replaced at once.
    pub replaced_at_once: f64,
}

impl Worth {
    /// The most that a look may cost.
    pub fn value(&self) -> f64 {
        self.without - self.with
    }
}

/// What the end of the part in use costs, beside what its standstill saves: below zero where that is more.
#[derive(Clone, Copy)]
struct Ends {
    /// At a replacement in time.
    preventive: f64,
    /// At a failure; less than the other where the standstill is long and failures cost little.
    failure: f64,
}

impl Ends {
    fn new(costs: &Costs, rate: f64) -> Self {
        Self {
            preventive: costs.preventive - rate * costs.preventive_time,
            failure: costs.failure - rate * costs.failure_time,
        }
    }
}

/// What a look at time `at` from now is worth, if time costs `rate` in the long run (that of [`super::best_age`], say).
///
/// # Errors
/// [`PlanError::Life`].
pub fn worth_of_a_look(part: &InUse, costs: &Costs, rate: f64, at: f64) -> Result<Worth, PlanError> {
    positive("the time of the look", at)?;
    positive("the cost per unit of time", rate)?;
    known_by_its_wear(&part.law)?;
    let life =
        |current: f64, now: f64| FirstPassage::from(part.law, part.clock.clone(), part.failure, current, now);
    let now = life(part.current, part.now)?;
    let ends = Ends::new(costs, rate);
    let (without, replace_after) = cheapest(&now, ends, rate)?;
    let used = MeanUse::new(&now, ACCURACY).until(at);
    let (fails_before, alive) = (now.failed(at), now.reliability(at));
    let gained = now.exposure(at);
    // What a part costs from the look on, whose wear is not exceeded by the part `p` of those that get there.
    let from = |p: f64| -> Result<f64, PlanError> {
        let worn = part.current + part.law.quantile(gained, alive * p);
        let on = if worn < part.failure {
            cheapest(&life(worn, part.now + at)?, ends, rate)?.0
        } else {
            ends.preventive.min(ends.failure)
        };
        Ok(on.min(ends.preventive))
    };
    let (mut sum, mut weights) = (0.0, 0.0);
    for k in -STEPS..=STEPS {
        let odds = libm::exp(FARTHEST * f64::from(k) / f64::from(STEPS));
        let weight = odds / ((1.0 + odds) * (1.0 + odds));
        sum += weight * from(odds / (1.0 + odds))?;
        weights += weight;
    }
    let after = alive * sum / weights;
    // The more it has worn the more it costs: the least worn that is replaced at once.
    let (mut stays, mut goes) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (stays + goes);
        *(if from(middle)? >= ends.preventive { &mut goes } else { &mut stays }) = middle;
    }
    // None where no halving came upon one.
    let at_once = if goes < 1.0 { alive * (1.0 - goes) } else { 0.0 };
    let with = ends.failure * fails_before - rate * used + after;
    // Whoever looks need not act on it, and need not wait for the look to replace the part.
    Ok(Worth { without, replace_after, with: with.min(without), fails_before, replaced_at_once: at_once })
}

/// The least expected cost of a part from here on, and when it is replaced.
fn cheapest(life: &dyn Lifetime, ends: Ends, rate: f64) -> Result<(f64, Option<f64>), PlanError> {
    let mut tried = vec![0.0];
    tried.extend(ages(life, LATEST, TRIED)?);
    let mut used = MeanUse::new(life, ACCURACY);
    let mut value = |age: f64| {
        ends.preventive * life.reliability(age) + ends.failure * life.failed(age) - rate * used.until(age)
    };
    let (age, least_value) = least(&tried, &mut value);
    let never = ends.failure - rate * life.moments()?.mean;
    Ok(if never <= least_value { (never, None) } else { (least_value, Some(age)) })
}
