//! When a run begins to record, when it ends, and where a turn ends. In: settings and the drivers' laws.
//! Out: times [s].

use super::settings::{Settings, Span};
use crate::error::{RunError, SetupError};
use crate::evaluate::Evaluator;
use crate::scalar::Scalar;

/// Times of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Schedule {
    /// Where the run begins.
    pub begin: f64,
    /// First sample, after settling.
    pub start: f64,
    /// End and last sample.
    pub end: f64,
    /// Number of samples.
    pub samples: usize,
}

impl Schedule {
    pub(super) fn new(
        evaluator: &mut Evaluator<'_>,
        settings: &Settings,
        begin: f64,
    ) -> Result<Self, RunError> {
        let start = end_of(evaluator, begin, settings.settle)?;
        let end = end_of(evaluator, start, settings.span)?;
        Ok(Self { begin, start, end, samples: settings.samples })
    }

    /// Refuses a run that goes on where its inputs are not known.
    pub(super) fn check_covered(&self, (first, last): (f64, f64)) -> Result<(), RunError> {
        // Times written with twelve digits mean the same time.
        let slack = 1e-11 * (self.end - self.begin);
        if first <= self.begin + slack && self.end - slack <= last {
            return Ok(());
        }
        Err(SetupError::InputsEnd { first, last, begin: self.begin, end: self.end }.into())
    }

    /// One turn of the turn driver from `begin`, without samples.
    pub(super) fn turn(evaluator: &mut Evaluator<'_>, begin: f64) -> Result<Self, RunError> {
        let end = Self::part_of_turn(evaluator, begin, 1.0)?;
        Ok(Self { begin, start: begin, end, samples: 0 })
    }

    /// When the turn driver has made a part of a turn from `begin` on.
    pub(super) fn part_of_turn(
        evaluator: &mut Evaluator<'_>,
        begin: f64,
        part: f64,
    ) -> Result<f64, RunError> {
        end_of_turns(evaluator, begin, part, LONGEST_SEARCH)
    }

    /// End of the turn that begins at `from`; nothing beyond the end of the run. If a sample or the end is due
    /// there but for rounding, it is that time: no step of a last bit is left over.
    pub(super) fn end_of_turn(&self, evaluator: &mut Evaluator<'_>, from: f64) -> Option<f64> {
        let slack = 1e-11 * self.end.abs();
        let time = end_of_turns(evaluator, from, 1.0, self.end + slack).ok()?;
        if (time - self.end).abs() <= slack {
            return Some(self.end);
        }
        if self.samples > 1 {
            let last = (self.samples - 1) as f64;
            let nearest = self.time(((time - self.start) / (self.end - self.start) * last).round() as usize);
            if (time - nearest).abs() <= slack {
                return Some(nearest);
            }
        }
        (time < self.end).then_some(time)
    }

    /// Time of sample `index`; the ends are exact.
    pub(super) fn time(&self, index: usize) -> f64 {
        let last = self.samples.saturating_sub(1).max(1);
        if index >= last {
            self.end
        } else {
            self.start + (self.end - self.start) * (index as f64 / last as f64)
        }
    }
}

/// Number of equal steps; a hair of slack keeps a span that is a multiple of the step from one step more.
pub(super) fn steps_between(from: f64, to: f64, longest: f64) -> u64 {
    (((to - from) / longest) * (1.0 - 1e-9)).ceil().max(1.0) as u64
}

fn end_of(evaluator: &mut Evaluator<'_>, from: f64, span: Span) -> Result<f64, RunError> {
    match span {
        Span::Time(seconds) => Ok(from + seconds),
        Span::Turns(turns) => end_of_turns(evaluator, from, turns, LONGEST_SEARCH),
    }
}

/// Longest search for the end of a turn [s], and how many strides it may take: in all, or for each turn, of which
/// one at even speed takes fifty.
const LONGEST_SEARCH: f64 = 1e9;
const MOST_STRIDES: f64 = 2e6;
const STRIDES_PER_TURN: f64 = 120.0;

/// First time after `from` at which the driver has made `turns` turns, in either direction.
fn end_of_turns(evaluator: &mut Evaluator<'_>, from: f64, turns: f64, limit: f64) -> Result<f64, RunError> {
    let driver = evaluator.description().turn_driver.ok_or(RunError::NoTurns)?;
    let mut law = |t: f64| {
        let values = evaluator.prescribed(t);
        (values[3 * driver], values[3 * driver + 1], values[3 * driver + 2])
    };
    const TURN: f64 = 2.0 * std::f64::consts::PI;
    let (first, _, _) = law(from);
    let (mut t, mut most) = (from, 0.0_f64);
    if turns == 0.0 {
        return Ok(from);
    }
    for _ in 0..MOST_STRIDES.max(STRIDES_PER_TURN * turns) as u64 {
        let (angle, speed, acceleration) = law(t);
        if !angle.is_finite() {
            return Err(RunError::NonFinite { t, what: "position of the turning driver".to_owned() });
        }
        // A stride of at most about a fiftieth of a turn, by speed or by acceleration.
        let by_speed = 0.02 * TURN / speed.abs();
        let by_acceleration = Scalar::sqrt(0.04 * TURN / acceleration.abs());
        let stride = by_speed.min(by_acceleration).min(1e-2 * (1.0 + t - from));
        let next = t + stride;
        let reached = (law(next).0 - first).abs();
        if reached >= TURN * turns {
            return Ok(bisect(|t| (law(t).0 - first).abs() - TURN * turns, t, next));
        }
        most = most.max(reached);
        t = next;
        if t > limit {
            break;
        }
    }
    Err(RunError::TurnsNotReached { wanted: turns, reached: most / TURN, t })
}

/// The place where `f` gets from below zero to zero or above, to the last bit.
fn bisect(mut f: impl FnMut(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle) >= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    // Rounding of the angle may put the nearer end on the wrong side of zero.
    if f(low).abs() < f(high).abs() { low } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_hit_both_ends_exactly() {
        let schedule = Schedule { begin: 0.0, start: 0.1, end: 0.7, samples: 7 };
        assert_eq!(schedule.time(0), 0.1);
        assert_eq!(schedule.time(6), 0.7);
        // One rounding of a number below 1.
        assert!((schedule.time(3) - 0.4).abs() < 2e-16);
    }

    #[test]
    fn a_root_is_found_to_the_last_bit() {
        assert_eq!(bisect(|x| x * x - 0.25, 0.0, 3.0), 0.5);
    }
}
