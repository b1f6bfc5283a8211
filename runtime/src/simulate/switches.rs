//! Locates where a formula changes its piece within an adaptive step, and ends the step there. In: accepted steps. Out: steps that lie
//! on one side. Never knows formulas: conditions are columns, and the side is their sign; of tables it is the row
//! that their arguments have passed.
//!
//! A step across a jump mixes both sides, and one across a kink has an order less. So a step in which a condition changes its sign,
//! or a table passes a row, ends before that place, and the next one begins behind it, at the state that the dense output has there:
//! both are so close that what lies between does not count. Where time alone decides, the place is known before the step.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use crate::error::RunError;
use crate::integrate::{Adaptive, Method};
use crate::linear::combine;

/// Accuracy of a place, as a part of the step.
const LOCATED: f64 = 1e-12;
/// Parts of a step at which sides are looked at: what changes twice in between is not seen.
const LOOKS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// How far behind the end of a step the other side may begin, as parts of the step, and in last places of the time at least.
const BEHIND: [(f64, f64); 5] = [(1e-12, 1.0), (1e-11, 4.0), (1e-10, 16.0), (1e-9, 64.0), (1e-8, 256.0)];
/// Shorter parts of a run's tenth are not searched: a force that keeps jumping at rest would hold the run up for ever.
const SHORTEST: f64 = 1e-7;
/// How often a step is taken again: each time the places are as exact as the shorter step.
const RETAKEN: usize = 4;
/// Part of a piece that its first step takes at most, where it might take it all: stages at simple parts of a piece see nothing of
/// what swings in it a whole number of times. The golden section is as far from all of them as can be.
const WITHIN_PIECE: f64 = 0.382;
/// Parts of the way from row to row. An argument that is nearer to a row than this where a step begins may rest there and pass it
/// to and fro by rounding; a kink so near the begin is left to the error of the step.
const AT_ROW: f64 = 1e-3;

/// On which side of what changes pieces a state is.
struct Sides {
    /// Of every condition, whether it is below zero.
    below: Vec<bool>,
    /// Of every table, how many rows its argument has passed.
    rows: Vec<f64>,
}

impl Sides {
    fn at(motion: &mut ConstrainedMotion<'_>, t: f64, y: &[f64]) -> Self {
        let (q, v, _) = motion.split(y);
        let [conditions, rows] = motion.dynamics.evaluator.pieces(t, q, v);
        Self { below: conditions.iter().map(|value| *value < 0.0).collect(), rows: rows.to_vec() }
    }

    /// Whether the same pieces hold, to the last place.
    fn are_those_of(&self, other: &Self) -> bool {
        let same_row = |(a, b): (&f64, &f64)| a.floor() == b.floor();
        self.below == other.below && self.rows.iter().zip(&other.rows).all(same_row)
    }

    /// Whether another piece begins on the way to here from the begin of a step.
    fn are_beyond(&self, begin: &Self) -> bool {
        let passed = |(from, to): (&f64, &f64)| {
            let row = to.floor();
            row > (from + AT_ROW).floor() || row < (from - AT_ROW).floor()
        };
        self.below != begin.below || begin.rows.iter().zip(&self.rows).any(passed)
    }
}

/// On which side conditions and tables are at part `at` of the last step.
fn sides<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    method: &Adaptive<M>,
    at: f64,
    between: &mut [f64],
) -> Sides {
    let t = if at == 1.0 { method.t() } else { method.before() + at * (method.t() - method.before()) };
    method.interpolate(t, between);
    Sides::at(motion, t, between)
}

/// Where the next step ends at the latest: where time alone makes another piece begin, whatever the state does until then. Such a
/// place is known before a step that would leap over it, or be refused for it again and again. `stop`: the latest end by other
/// reasons.
pub(super) fn stop_in_time<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    method: &mut Adaptive<M>,
    stop: f64,
    between: &mut [f64],
) -> f64 {
    if !motion.dynamics.evaluator.has_switches() {
        return stop;
    }
    let (begin, (length, _)) = (method.t(), method.control().propose(stop));
    let known = Sides::at(motion, begin, method.y());
    let mut there = |part: f64, moves: bool| {
        combine(between, method.y(), if moves { part * length } else { 0.0 }, method.slope());
        Sides::at(motion, begin + part * length, between)
    };
    // What time alone decides changes once, and is found at the end; what changes back before is left to the step.
    let Some((low, high)) = first_change(&known, &[1.0], |part| there(part, false)) else { return stop };
    let is_of_time = !there(low, true).are_beyond(&known) && there(high, true).are_beyond(&known);
    let end = begin + low * length;
    if !is_of_time || is_at(begin, end) {
        return stop;
    }
    // No step has ended where this one begins: a piece does.
    let spans_piece = method.before() == begin && there(high, false).below != known.below;
    if spans_piece { begin + WITHIN_PIECE * (end - begin) } else { end }
}

/// The part of a step at which another piece begins first, from below and above, if that is seen at one of these parts of it.
fn first_change(known: &Sides, looks: &[f64], mut sides: impl FnMut(f64) -> Sides) -> Option<(f64, f64)> {
    let mut low = 0.0;
    let mut high = looks.iter().copied().find(|part| {
        let differs = sides(*part).are_beyond(known);
        low = if differs { low } else { *part };
        differs
    })?;
    while high - low > LOCATED {
        let middle = 0.5 * (low + high);
        if sides(middle).are_beyond(known) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some((low, high))
}

/// Whether a place belongs to the begin of a step: what begins there is behind it already.
fn is_at(begin: f64, place: f64) -> bool {
    place - begin <= 4.0 * f64::EPSILON * place.abs()
}

/// Ends the last step of `method` where the first condition changes its sign within it, or a table passes its first row; whether it
/// was shortened.
pub(super) fn stop_at_switch<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    method: &mut Adaptive<M>,
    between: &mut [f64],
) -> Result<bool, RunError> {
    let mut is_shortened = false;
    if !motion.dynamics.evaluator.has_switches() {
        return Ok(is_shortened);
    }
    let shortest = 0.1 * SHORTEST * sampler.duration();
    for _ in 0..RETAKEN {
        let (begin, length) = (method.before(), method.t() - method.before());
        if length <= shortest {
            break;
        }
        let known = sides(motion, method, 0.0, between);
        let Some((low, _)) = first_change(&known, &LOOKS, |part| sides(motion, method, part, between)) else {
            break;
        };
        let end = begin + low * length;
        if is_at(begin, end) {
            break;
        }
        method.retake(motion, end)?;
        sampler.closing = None;
        is_shortened = true;
    }
    Ok(is_shortened)
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
    let known = Sides::at(motion, method.t(), method.y());
    let end = method.t();
    let mut last: Option<(f64, Sides)> = None;
    for (part, places) in BEHIND {
        let t = end + (part * length).max(places * (end.next_up() - end));
        if t >= stop {
            break;
        }
        method.interpolate(t, between);
        let sides = Sides::at(motion, t, between);
        // Where several conditions change at once but for rounding, it is behind them all.
        if let Some((t, same)) = last.take()
            && !same.are_those_of(&known)
            && same.are_those_of(&sides)
        {
            method.interpolate(t, between);
            return method.go_on_from(motion, t, between);
        }
        last = Some((t, sides));
    }
    Ok(())
}
