//! When turns have settled. In: by how much of their wear turns differ from the ones before. Out: whether the last one counts. Never
//! runs anything.
//!
//! A motion settles by a factor a turn: of some fifty for a tight joint of the case study, of two or three for a loose one. So the
//! difference of two turns tells that of the second from all later ones, once the factor is known.

use super::returning::{Moved, growth};
use super::stability::Left;
use crate::linear::largest_of;
use crate::simulate::TurnState;

/// A turn counts if later ones would differ by no more than what is asked for, although they may differ by so many times what the
/// factor lets expect.
const SAFETY: f64 = 2.0;
/// Where a measurement has seen its factor itself, so many times as much may be left: by the factor of a neighbour a turn may be far off
/// that differs little from the one before by chance, by its own it is not.
const SEEN: f64 = 8.0;
/// A turn that differs by so many times what is asked for is nearly settled: later ones differ by less than that.
const NEARLY: f64 = 10.0;
/// A factor grows by this from one measurement to the next where none was seen: it is looked at every few measurements, ...
const GROWS: f64 = 1.5;
/// ... and is forgotten this fast where smaller ones are seen.
const FORGETS: f64 = 0.25;
/// Where a clearance is another by more than this part, the factor may have grown by this power of that: in the case study it grows with
/// the square of the clearance or the third power.
const FAR: f64 = 0.2;
const FAR_POWER: i32 = 4;

/// Journals that come nearer to where they stood a turn before by this factor are those of a motion that comes back to itself.
const COMES_BACK: f64 = 0.5;
/// The same in a motion of which nothing is known: it begins beside where it goes with much that dies in a turn, and hides a swing by it.
const FIRST_COMES_BACK: f64 = 0.1;
/// What was seen of that counts until a journal has so many times as much room: laws of contact go by it smoothly.
const GROWN: f64 = 1.25;

/// What a life's motion goes on from.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Orbit {
    /// The end of its last turn.
    pub turn: TurnState,
    /// By which factor turns differ less than the ones before, at most 1.
    pub contraction: f64,
    /// How much room journals had [m] when the motion was last seen to be one that a displacement does not take it from; none if never.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tried: Vec<f64>,
    /// Turns that are run after each change of wear before any is looked at: of a swing that has grown out of an unstable motion, whose
    /// turns may be alike long before it has got over that.
    #[cfg_attr(feature = "serde", serde(default))]
    pub lasting: u32,
}

/// The settling of one measurement.
pub(super) struct Settling {
    /// By what part of their wear later turns may differ.
    settled: f64,
    /// The factor known before.
    known: f64,
    /// The largest seen.
    seen: Option<f64>,
    last: Option<f64>,
    /// By how much the last three turns left journals elsewhere than where they began, the last first.
    moved: [Option<Moved>; 3],
    /// What is known of the motion's stability, and whether this measurement needs more.
    tried: Vec<f64>,
    lasting: u32,
}

impl Settling {
    /// Of a motion that goes on from an orbit, where no clearance is more than so many times as large or as small, or begins;
    /// until later turns would differ by no more than this part of their wear.
    pub(super) fn new(from: Option<&Orbit>, far: f64, settled: f64) -> Self {
        let grown = if far > 1.0 + FAR { far.powi(FAR_POWER) } else { 1.0 };
        let known = from.map_or(1.0, |orbit| (grown * orbit.contraction).min(1.0));
        let tried = from.map_or_else(Vec::new, |orbit| orbit.tried.clone());
        let lasting = from.map_or(0, |orbit| orbit.lasting);
        Self { settled, known, seen: None, last: None, moved: [None; 3], tried, lasting }
    }

    /// A turn has left journals elsewhere than where it began by so much.
    pub(super) fn moves(&mut self, by: Moved) {
        self.moved.rotate_right(1);
        self.moved[0] = Some(by);
    }

    /// Whether journals come nearer to where they stood a turn before, by the last turn or by both of the last two: of these the first may
    /// have left offsets where they were by chance.
    fn comes_back(&self) -> bool {
        let enough = if self.tried.is_empty() { FIRST_COMES_BACK } else { COMES_BACK };
        let [now, one_before, two_before] = self.moved;
        let is_less = |before: Option<Moved>, part: f64| {
            before.zip(now).is_some_and(|(before, now)| growth(before, now) < part)
        };
        is_less(one_before, enough) || is_less(two_before, enough * enough)
    }

    /// Whether a turn counts that differs by these parts of its wear from the one before; what is no number has not settled.
    pub(super) fn has_settled(&mut self, differs: impl Iterator<Item = f64>) -> bool {
        let differs = largest_of(differs);
        if let Some(last) = self.last.filter(|last| *last > 0.0) {
            let factor = (differs / last).min(1.0);
            self.seen = Some(self.seen.map_or(factor, |seen| seen.max(factor)));
        }
        self.last = Some(differs);
        let left = if self.seen.is_some() { SEEN * self.settled } else { self.settled };
        differs <= self.settled || SAFETY * self.contraction() * differs <= left
    }

    /// Whether the last turn is nearly settled: it counts alone, where no further one is run to settle.
    pub(super) fn has_nearly_settled(&self) -> bool {
        self.last.is_some_and(|differs| differs <= NEARLY * self.settled)
    }

    /// Whether turns that have settled are those of a motion that was never seen to come back to itself where journals had so much room
    /// [m]. Under a steady load they stand still with nothing but rounding to come back from.
    pub(super) fn shows_nothing(&self, rooms: &[f64], is_steady: impl FnOnce() -> bool) -> bool {
        let grown = |(now, then): (&f64, &f64)| *now > GROWN * then;
        let is_new = self.tried.len() != rooms.len() || rooms.iter().zip(&self.tried).any(grown);
        let agreed = self.seen.is_none() && self.last.is_some_and(|differs| differs <= self.settled);
        is_new && (!self.comes_back() || agreed && is_steady())
    }

    /// It was tried whether the motion comes back to itself with so much room [m]; where it has left, turns settle anew.
    pub(super) fn is_tried(&mut self, rooms: Vec<f64>, left: Option<&Left>) {
        self.tried = rooms;
        if let Some(left) = left {
            (self.known, self.seen, self.last, self.lasting) = (1.0, None, None, left.lasting);
            self.moved = [None; 3];
        }
    }

    /// Turns before any is looked at, after later changes of wear.
    pub(super) const fn lasting(&self) -> u32 {
        self.lasting
    }

    /// With how much room [m] the motion was last seen to come back to itself, where turns have settled that had so much.
    pub(super) fn tried(&self, rooms: Vec<f64>) -> Vec<f64> {
        if self.comes_back() { rooms } else { self.tried_before() }
    }

    /// The same where they have not.
    pub(super) fn tried_before(&self) -> Vec<f64> {
        self.tried.clone()
    }

    /// The factor to go on with.
    pub(super) fn contraction(&self) -> f64 {
        match self.seen {
            Some(seen) => seen.max(FORGETS * self.known),
            None if self.last.is_some() => (GROWS * self.known).min(1.0),
            None => self.known,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(contraction: f64, tried: Vec<f64>) -> Orbit {
        let turn = TurnState { t: 0.0, q: vec![], v: vec![], joints: vec![], memory: vec![] };
        Orbit { turn, contraction, tried, lasting: 0 }
    }

    #[test]
    fn turns_count_once_their_factor_tells_that_later_ones_are_alike() {
        let mut first = Settling::new(None, 1.0, 1e-5);
        // Nothing is known: two turns have to be alike themselves.
        assert!(!first.has_settled([1e-3].into_iter()));
        // By a factor of 0.02, and so do the next ones: 4e-7.
        assert!(first.has_settled([2e-5].into_iter()));
        assert_eq!(first.contraction(), 0.25);
        let from = |contraction| orbit(contraction, vec![]);
        let mut next = Settling::new(Some(&from(0.02)), 1.1, 1e-5);
        // 2 times 0.03 times 1e-4.
        assert!(next.has_settled([1e-4].into_iter()) && next.contraction() == 0.03);
        let mut slow = Settling::new(Some(&from(0.02)), 1.1, 1e-5);
        assert!(!slow.has_settled([1e-3].into_iter()) && !slow.has_settled([5e-4].into_iter()));
        assert_eq!(slow.contraction(), 0.5);
        assert!(!slow.has_nearly_settled());
        // By a half again: nearly settled, and 2 times 0.5 times 9e-5 is more than eight times 1e-5.
        assert!(!slow.has_settled([9e-5].into_iter()) && slow.has_nearly_settled());
        // By the factor that it has seen, eight times as much may be left as by the one of its neighbour.
        assert!(slow.has_settled([3e-5].into_iter()));
        let mut by_neighbour = Settling::new(Some(&from(0.5)), 1.1, 1e-5);
        assert!(!by_neighbour.has_settled([3e-5].into_iter()));
        // From afar, sixteen times as large.
        assert!(!Settling::new(Some(&from(0.02)), 2.0, 1e-5).has_settled([1e-4].into_iter()));
        let mut still = Settling::new(Some(&from(0.5)), 1.1, 1e-5);
        assert!(still.has_settled([0.0].into_iter()) && !still.has_settled([f64::NAN, 0.0].into_iter()));
    }

    #[test]
    fn a_turn_that_left_offsets_by_chance_where_they_were_does_not_hide_that_journals_come_back() {
        let turns = |moved: &[Moved], tried: Vec<f64>| {
            let mut settling = Settling::new(Some(&orbit(1.0, tried)), 1.0, 1e-5);
            moved.iter().for_each(|moved| settling.moves(*moved));
            settling.comes_back()
        };
        // As in the case study: offsets by 100, then back by 10, rates by 20 and by 5.
        let chance = [[0.0156, 111.4], [0.000154, 5.29], [0.00147, 1.08]];
        assert!(turns(&chance, vec![1e-5]) && !turns(&chance[1..], vec![1e-5]));
        // Of a motion of which nothing is known that is not enough.
        assert!(!turns(&chance, vec![]));
        // A swing that grows by 5 % a turn is none that comes back, wherever in its way it is seen.
        let swing = |turn: i32| {
            let (sine, cosine) = (1.3 * f64::from(turn)).sin_cos();
            [cosine, 30.0 * sine].map(|part| 1e-3 * 1.05_f64.powi(turn) * part.abs())
        };
        assert!((0..50).all(|first| !turns(&[first, first + 1, first + 2].map(swing), vec![1e-5])));
    }
}
