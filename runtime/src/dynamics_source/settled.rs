//! How steady turns are, and whether one is enough. In: what turns wear, how far clearances have changed. Out: [`Steadiness`], and
//! [`Settled`], which a life keeps. Never runs anything.

use crate::life::JointWear;
use crate::simulate::TurnState;

/// Turns that wear alike but for this part of it have settled: a motion settles by a constant factor each turn (of 500 in the
/// case study), so that the next one differs by far less.
pub(super) const SETTLED: f64 = 1e-5;
/// How much more than the last comparison lets expect a turn may be off.
const MARGIN: f64 = 2.0;
/// Measurements by one turn between two comparisons.
const MOST_TRUSTED: u32 = 3;
/// What is left of the largest drift so far, from comparison to comparison.
const KEPT: f64 = 0.5;

/// How steady the turns were that a revolution was measured by, of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Steadiness {
    /// What the revolution adds to W [m].
    pub wear: f64,
    /// By how much of it the revolution differs from the last turn that settled, or is expected to; nothing if none did.
    pub drift: Option<f64>,
    /// Standard error of the mean over the turns measured, as a part of it: by their scatter, or for a single one by its
    /// difference from the turn before, which has the scatter of two. Nothing if there is one turn in all.
    pub scatter: Option<f64>,
}

impl Steadiness {
    /// From W per turn [m] of the last turn that settled, and of those measured.
    pub(super) fn of(before: Option<f64>, turns: &[f64]) -> Self {
        let count = turns.len() as f64;
        let wear = turns.iter().sum::<f64>() / count;
        // What does not wear at all is steady.
        let part = |of: f64| if of == 0.0 { 0.0 } else { of / wear };
        let drift = before.map(|before| part(wear - before));
        let squares: f64 = turns.iter().map(|turn| (turn - wear) * (turn - wear)).sum();
        let scatter = match turns.len() {
            1 => drift.map(single),
            _ => Some(part(libm::sqrt(squares / (count * (count - 1.0))))),
        };
        Self { wear, drift, scatter }
    }

    /// Of a single turn that is expected to be off by so much.
    pub(super) fn expected(wear: f64, drift: f64) -> Self {
        Self { wear, drift: Some(drift), scatter: Some(single(drift)) }
    }
}

/// Scatter of one turn, by its difference from another.
fn single(drift: f64) -> f64 {
    drift.abs() * core::f64::consts::FRAC_1_SQRT_2
}

/// Where a motion has settled, and how fast it settles: what a life goes on from.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Settled {
    /// The end of its last turn.
    pub turn: TurnState,
    /// Clearances [m] of the wearing joints in it.
    clearances: Vec<f64>,
    /// By how much of its wear the first turn differed from the second, for a change of a clearance by its whole size; nothing
    /// where turns were not compared.
    drift: Option<f64>,
    /// Measurements by one turn since.
    trusted: u32,
}

impl Settled {
    /// How far a single turn is expected to be off after a change to these joints; nothing if one is not enough.
    pub(super) fn expects(&self, joints: &[JointWear]) -> Option<f64> {
        let has_profile = joints.iter().any(|joint| joint.profile.is_some());
        let expected = MARGIN * self.drift? * self.change(joints);
        (!has_profile && self.trusted < MOST_TRUSTED && expected <= SETTLED).then_some(expected)
    }

    /// Largest change of a clearance, as a part of it.
    fn change(&self, joints: &[JointWear]) -> f64 {
        let each = joints.iter().zip(&self.clearances);
        each.fold(0.0, |most, (joint, before)| f64::max(most, (joint.clearance / before - 1.0).abs()))
    }

    /// After one turn more that was enough.
    pub(super) fn trusted(before: &Self, turn: TurnState, joints: &[JointWear]) -> Self {
        let trusted = before.trusted + 1;
        Self { turn, clearances: clearances(joints), drift: before.drift, trusted }
    }

    /// After turns that were compared.
    pub(super) fn compared(
        before: Option<&Self>,
        turn: TurnState,
        joints: &[JointWear],
        steadiness: &[Steadiness],
    ) -> Self {
        let most = steadiness.iter().try_fold(0.0, |most, one| Some(f64::max(most, one.drift?.abs())));
        let drift = before.and_then(|before| {
            let now = most.map(|most| most / before.change(joints)).filter(|drift| drift.is_finite());
            let known = before.drift.map(|drift| KEPT * drift);
            now.map(|now| known.map_or(now, |known| now.max(known)))
        });
        Self { turn, clearances: clearances(joints), drift, trusted: 0 }
    }
}

fn clearances(joints: &[JointWear]) -> Vec<f64> {
    joints.iter().map(|joint| joint.clearance).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_that_differ_say_how_far_their_mean_may_be_off() {
        // 2, 3 and 4: mean 3, standard deviation 1.
        let three = Steadiness::of(Some(2.7), &[2.0, 3.0, 4.0]);
        assert_eq!(three.wear, 3.0);
        assert!((three.drift.expect("a turn before") - 0.1).abs() < 1e-15);
        assert!((three.scatter.expect("three turns") - 1.0 / 3.0_f64.sqrt() / 3.0).abs() < 1e-15);
        let one = Steadiness::of(Some(2.0), &[4.0]);
        assert_eq!(one.drift, Some(0.5));
        assert!((one.scatter.expect("two turns") - 0.5 / 2.0_f64.sqrt()).abs() < 1e-15);
        let alone = Steadiness::of(None, &[4.0]);
        assert_eq!((alone.drift, alone.scatter), (None, None));
        let still = Steadiness { wear: 0.0, drift: Some(0.0), scatter: Some(0.0) };
        assert_eq!(Steadiness::of(Some(0.0), &[0.0, 0.0]), still);
    }

    #[test]
    fn one_turn_is_enough_where_comparisons_show_it() {
        let joint = |clearance| [JointWear { clearance, wear: 0.0, profile: None }];
        let turn = TurnState { t: 0.0, q: vec![], v: vec![], joints: vec![], memory: vec![] };
        let drifted = |drift| [Steadiness { wear: 1.0, drift: Some(drift), scatter: None }];
        let first = Settled::compared(None, turn.clone(), &joint(1.0), &drifted(1e-7));
        assert_eq!(first.expects(&joint(1.1)), None, "nobody knows what a change does");
        let second = Settled::compared(Some(&first), turn.clone(), &joint(1.1), &drifted(-2e-6));
        // A tenth more gave 2e-6, so a twentieth gives half, and twice that is expected.
        let expected = second.expects(&joint(1.1 * 1.05)).expect("one is enough");
        assert!((expected - 2e-6).abs() < 1e-12, "{expected}");
        assert_eq!(second.expects(&joint(1.1 * 1.6)), None, "a change that large is off by more");
        let mut now = second;
        for _ in 0..MOST_TRUSTED {
            assert!(now.expects(&joint(1.1)).is_some());
            now = Settled::trusted(&now, turn.clone(), &joint(1.1));
        }
        assert_eq!(now.expects(&joint(1.1)), None, "from time to time it is seen again");
    }
}
