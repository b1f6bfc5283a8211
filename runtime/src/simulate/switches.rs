//! Locates where a formula changes its piece within an adaptive step, and ends the step there. In: accepted steps. Out: steps that lie
//! on one side. Never knows formulas: conditions are columns, and the side is their sign.
//!
//! A step across a jump mixes both sides, and one across a kink has an order less. So a step in which a condition changes its sign
//! ends before that place, and the next one begins behind it, at the state that the dense output has there: both are so close
//! that what lies between does not count.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use crate::error::RunError;
use crate::integrate::{Adaptive, Method};

/// Accuracy of a place, as a part of the step.
const LOCATED: f64 = 1e-12;
/// Parts of a step at which signs are looked at: what changes twice in between is not seen.
const LOOKS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// How far behind the end of a step the other side may begin, as parts of the step, and in last places of the time at least.
const BEHIND: [(f64, f64); 5] = [(1e-12, 1.0), (1e-11, 4.0), (1e-10, 16.0), (1e-9, 64.0), (1e-8, 256.0)];
/// Shorter parts of a run's tenth are not searched: a force that keeps jumping at rest would hold the run up for ever.
const SHORTEST: f64 = 1e-7;
/// How often a step is taken again: each time the places are as exact as the shorter step.
const RETAKEN: usize = 4;

/// On which side the conditions are at part `at` of the last step.
fn sides<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    method: &Adaptive<M>,
    at: f64,
    between: &mut [f64],
) -> (f64, Vec<bool>) {
    let t = if at == 1.0 { method.t() } else { method.before() + at * (method.t() - method.before()) };
    method.interpolate(t, between);
    (t, sides_at(motion, t, between))
}

fn sides_at(motion: &mut ConstrainedMotion<'_>, t: f64, y: &[f64]) -> Vec<bool> {
    let (q, v, _) = motion.split(y);
    motion.dynamics.evaluator.switches(t, q, v).iter().map(|value| *value < 0.0).collect()
}

/// Ends the last step of `method` where the first condition changes its sign within it.
pub(super) fn stop_at_switch<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    method: &mut Adaptive<M>,
    between: &mut [f64],
) -> Result<(), RunError> {
    if !motion.dynamics.evaluator.has_switches() {
        return Ok(());
    }
    let shortest = 0.1 * SHORTEST * sampler.duration();
    for _ in 0..RETAKEN {
        let (begin, length) = (method.before(), method.t() - method.before());
        if length <= shortest {
            break;
        }
        let (_, known) = sides(motion, method, 0.0, between);
        let mut low = 0.0;
        let Some(mut high) = LOOKS.into_iter().find(|part| {
            let differs = sides(motion, method, *part, between).1 != known;
            low = if differs { low } else { *part };
            differs
        }) else {
            break;
        };
        while high - low > LOCATED {
            let middle = 0.5 * (low + high);
            if sides(motion, method, middle, between).1 == known {
                low = middle;
            } else {
                high = middle;
            }
        }
        let end = begin + low * length;
        // What belongs to the begin of a step is behind it already.
        if end - begin <= 4.0 * f64::EPSILON * end.abs() {
            break;
        }
        method.retake(motion, end)?;
        sampler.closing = None;
    }
    Ok(())
}

/// Puts the begin of the next step, which ends at `stop` at the latest, behind a place that the last one ended at.
pub(super) fn cross<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    method: &mut Adaptive<M>,
    stop: f64,
    between: &mut [f64],
) -> Result<(), RunError> {
    let length = method.t() - method.before();
    if length <= 0.0 || !motion.dynamics.evaluator.has_switches() {
        return Ok(());
    }
    let known = sides_at(motion, method.t(), method.y());
    let end = method.t();
    let mut last: Option<(f64, Vec<bool>)> = None;
    for (part, places) in BEHIND {
        let t = end + (part * length).max(places * (end.next_up() - end));
        if t >= stop {
            break;
        }
        method.interpolate(t, between);
        let sides = sides_at(motion, t, between);
        // Where several conditions change at once but for rounding, it is behind them all.
        if let Some((t, same)) = last.take()
            && same != known
            && same == sides
        {
            method.interpolate(t, between);
            return method.go_on_from(motion, t, between);
        }
        last = Some((t, sides));
    }
    Ok(())
}
