//! After how many turns drives and forces repeat themselves. In: a mechanism at its start. Out: [`Recurrence`]. Runs no turn.
//!
//! A turn that wears as the one before tells nothing where loads change over many turns: a force that pauses for four turns wears four
//! turns alike. So the laws are asked first: what accelerations they would give, turn by turn, at the same parts of each turn, were
//! everything free where it is at the start. What is alike there for every turn leaves it to the motion alone to settle.

use crate::error::RunError;
use crate::simulate::TurnRunner;

/// Turns that are looked at: loads of a shift at a turn a second are seen to repeat, and it takes milliseconds.
const TURNS: usize = 400;
/// Parts of each turn that are looked at, ...
const PHASES: usize = 24;
/// ... from here on, in parts of their distance: not at a turn's ends and simple parts of it, where laws like to jump and drives to rest.
const FIRST: f64 = 0.371;
/// Accelerations are alike that differ by this part of the largest of their kind, ...
const ALIKE: f64 = 1e-6;
/// ... by so many times what rounding of the time does, ...
const ROUNDING: f64 = 100.0;
/// ... or by this part of the largest of all: what is nothing but rounding beside others.
const NOTHING: f64 = 1e-12;
/// Laws that never repeat do so nearly, where a beat is nearly a whole number of turns: if this part of what they vary by is left. The
/// mean over such a beat has all but a second order of that.
const NEARLY: f64 = 0.02;
/// Fewer turns tell nothing.
const FEWEST: usize = 8;

/// After how many turns laws repeat themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Recurrence {
    /// Turns before, which are not yet like later ones.
    pub after: u32,
    /// Turns after which they repeat.
    pub every: u32,
}

impl Recurrence {
    /// Of laws that are alike in every turn.
    pub const EACH: Self = Self { after: 0, every: 1 };

    /// Of a mechanism, whose runner is where it begins.
    ///
    /// # Errors
    /// [`RunError::NeverAlike`] if laws do not repeat in the turns that are looked at.
    pub fn of(runner: &mut TurnRunner<'_>) -> Result<Self, RunError> {
        let mut part = FIRST / PHASES as f64;
        let mut times = Vec::new();
        let mut last = runner.t();
        while times.len() <= TURNS * PHASES {
            // One that stops ends its life with its turns; who runs them says so.
            let Ok(next) = runner.part_of_turn(last, part) else { break };
            times.push(next);
            (last, part) = (next, 1.0 / PHASES as f64);
        }
        if times.len() <= FEWEST * PHASES {
            return Ok(Self::EACH);
        }
        let laws = Laws::of(runner, &times);
        laws.recurrence().ok_or_else(|| RunError::NeverAlike {
            turns: laws.turns.len(),
            what: "drives or forces that depend on the time do not repeat".to_owned(),
        })
    }
}

/// What laws give, turn by turn.
struct Laws {
    /// Of each turn its duration, then accelerations at its parts.
    turns: Vec<Vec<f64>>,
    /// By how much numbers may differ and be alike.
    slack: Vec<f64>,
}

impl Laws {
    /// By times at which the driver is at the same parts of its turns. They are sharp where it moves; ends of turns, where it may rest, are
    /// not.
    fn of(runner: &mut TurnRunner<'_>, times: &[f64]) -> Self {
        let forwards = runner.speeds().to_vec();
        let backwards: Vec<f64> = forwards.iter().map(|speed| -speed).collect();
        let mut of_turn = |times: &[f64], later: f64| {
            let mut values = vec![times[PHASES] - times[0]];
            for (phase, t) in times[..PHASES].iter().enumerate() {
                // Forces that act one way alone are met by speeds of both.
                let speeds = if phase % 2 == 0 { &forwards } else { &backwards };
                values.extend_from_slice(runner.accelerations_at(t + later, speeds));
            }
            values
        };
        let count = (times.len() - 1) / PHASES;
        let turns: Vec<Vec<f64>> =
            (0..count).map(|turn| of_turn(&times[turn * PHASES..][..=PHASES], 0.0)).collect();
        // A time as late as the last has so many places.
        let rounding = 4.0 * f64::EPSILON * times[times.len() - 1].abs();
        let beside = of_turn(&times[..=PHASES], rounding);
        let kinds = (beside.len() - 1) / PHASES;
        let largest = |kind: usize| {
            let of_turn = |turn: &Vec<f64>| {
                turn[1..].iter().skip(kind).step_by(kinds).fold(0.0_f64, |most, value| most.max(value.abs()))
            };
            turns.iter().map(of_turn).filter(|most| most.is_finite()).fold(0.0, f64::max)
        };
        let sizes: Vec<f64> = (0..kinds).map(largest).collect();
        let all = sizes.iter().copied().fold(0.0, f64::max);
        let slack = (0..beside.len()).map(|place| {
            let rounded = ROUNDING * (beside[place] - turns[0][place]).abs();
            match place.checked_sub(1) {
                None => ALIKE * turns[0][0] + ROUNDING * rounding,
                Some(place) => (ALIKE * sizes[place % kinds]).max(NOTHING * all) + rounded,
            }
        });
        Self { slack: slack.collect(), turns }
    }

    /// By how much two turns differ at most, in parts of what may be alike.
    fn differ(&self, a: usize, b: usize) -> f64 {
        self.apart(&self.turns[a], &self.turns[b])
    }

    /// The same of numbers as turns have them; what is no number in both is the same.
    fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        let numbers = a.iter().zip(b).zip(&self.slack);
        numbers.fold(0.0_f64, |most, ((a, b), slack)| {
            let off = (a - b).abs() / slack;
            match (a.is_finite(), b.is_finite()) {
                (true, true) => most.max(if off.is_nan() { 0.0 } else { off }),
                (false, false) => most,
                _ => f64::INFINITY,
            }
        })
    }

    fn recurrence(&self) -> Option<Recurrence> {
        let count = self.turns.len();
        // From the last turn backwards, how many are alike after each number of turns; two such times at least.
        let mut best: Option<(usize, usize)> = None;
        for every in 1..=count / 2 {
            let unlike = (0..count - every).rev().find(|turn| self.differ(*turn, turn + every) > 1.0);
            let after = unlike.map_or(0, |turn| turn + 1);
            // As many turns are alike at least as come before.
            let fits = after + 2 * every <= count && 2 * after <= count;
            if fits && best.is_none_or(|(known, _)| after < known) {
                best = Some((after, every));
            }
            if best.is_some_and(|(after, _)| after == 0) {
                break;
            }
        }
        let (after, every) = best.or_else(|| Some((0, self.beat()?)))?;
        Some(Recurrence { after: u32::try_from(after).ok()?, every: u32::try_from(every).ok()? })
    }

    /// After how many turns all are nearly alike, beside what they vary by.
    fn beat(&self) -> Option<usize> {
        let count = self.turns.len();
        let varies = (1..count).map(|turn| self.differ(0, turn)).fold(0.0, f64::max);
        let is_near =
            |every: &usize| (0..count - every).all(|turn| self.differ(turn, turn + every) <= NEARLY * varies);
        // What goes one way slowly is nearly alike, too, but not on the whole.
        let half = |turns: &[Vec<f64>]| -> Vec<f64> {
            (0..self.slack.len())
                .map(|place| turns.iter().map(|turn| turn[place]).sum::<f64>() / turns.len() as f64)
                .collect()
        };
        let (first, second) = self.turns.split_at(count / 2);
        if self.apart(&half(first), &half(second)) > NEARLY * varies {
            return None;
        }
        // Four such beats at least: what comes and goes once is none.
        (2..=count / 4).find(is_near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws(of_turn: impl Fn(usize) -> f64) -> Option<Recurrence> {
        let turns: Vec<Vec<f64>> = (0..TURNS).map(|turn| vec![1.0, of_turn(turn), 3.0]).collect();
        Laws { turns, slack: vec![1e-6; 3] }.recurrence()
    }

    #[test]
    fn laws_repeat_at_once_after_some_turns_or_never() {
        let of = |after, every| Some(Recurrence { after, every });
        assert_eq!(laws(|_| 2.0), of(0, 1));
        assert_eq!(laws(|turn| if turn % 8 < 4 { 0.0 } else { 30.0 }), of(0, 8));
        assert_eq!(laws(|turn| if turn < 60 { 0.0 } else { 30.0 }), of(60, 1));
        assert_eq!(laws(|turn| (-0.1 * turn as f64).exp() + (turn % 3) as f64), of(125, 3));
        // A beat that is no whole number of turns comes back nearly.
        let beat = laws(|turn| (2.0_f64.sqrt() * turn as f64).sin()).expect("a beat");
        assert!(beat.after == 0 && beat.every > 1, "{beat:?}");
        assert_eq!(laws(|turn| 0.01 * turn as f64), None);
        assert_eq!(laws(|turn| 0.01 * turn as f64 + (turn % 5) as f64), None);
        assert_eq!(laws(|turn| (-0.0025 * turn as f64).exp()), None);
        // A pause that comes once.
        assert_eq!(laws(|turn| if (150..390).contains(&turn) { 1.0 } else { 0.0 }), None);
        assert_eq!(laws(|turn| if turn == 5 { f64::NAN } else { 1.0 }), of(6, 1));
    }
}
