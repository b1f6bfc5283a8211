//! The joints that wear, among those with clearance. In: turns. Out: what they wear there. Never runs one.

use super::steadiness::Steadiness;
use crate::description::Description;
use crate::life::{JointLife, JointWear, SettingsError, WearOf};
use crate::linear::largest_of;
use crate::simulate::TurnMeasures;
use crate::wear::ContactMeasure;

/// A load whose peak is no larger than so many times its mean holds a journal where it is; any other moves it, so that what grows shows
/// in turns that differ.
const STEADY: f64 = 1.1;

/// The joints of a mechanism that wear.
pub(super) struct Wearing<'a> {
    /// That of the mechanism.
    pub description: &'a Description,
    /// Their indices among those with clearance, with their clearance at the start [m].
    pub joints: Vec<(usize, f64)>,
}

impl<'a> Wearing<'a> {
    /// Of a mechanism with these clearances [m] at the start.
    pub fn new(description: &'a Description, clearances: &[f64]) -> Self {
        let joints = (0..clearances.len()).filter(|at| description.contacts[*at].wear.is_some());
        Self { description, joints: joints.map(|at| (at, clearances[at])).collect() }
    }

    /// As the mechanism describes them.
    pub fn lives(&self) -> Result<Vec<JointLife>, SettingsError> {
        let of = |(at, clearance): &(usize, f64)| {
            JointLife::of_joint(self.description, *at, *clearance).transpose()
        };
        self.joints.iter().filter_map(of).collect()
    }

    /// As they are at the start.
    pub fn unworn(&self) -> Vec<JointWear> {
        let joint = |(_, clearance): &(usize, f64)| JointWear {
            clearance: *clearance,
            wear: 0.0,
            profile: None,
            journal: None,
        };
        self.joints.iter().map(joint).collect()
    }

    /// How much room their journals have, by these joints [m].
    pub fn rooms(&self, joints: &[JointWear]) -> Vec<f64> {
        self.joints.iter().zip(joints).map(|((_, unworn), joint)| room(*unworn, joint)).collect()
    }

    /// By how much of its wear a turn differs from the one before, of the joint where that is most.
    pub fn differs(&self, last: &TurnMeasures, now: &TurnMeasures) -> f64 {
        let part = |(at, _): &(usize, f64)| {
            let (last, now) = (self.wear(*at, last), self.wear(*at, now));
            // What does not wear at all is settled.
            if now == last { 0.0 } else { ((now - last) / now).abs() }
        };
        largest_of(self.joints.iter().map(part))
    }

    /// Whether a journal is loaded steadily in a turn.
    pub fn has_steady_load(&self, turn: &TurnMeasures) -> bool {
        let is_steady = |measure: &ContactMeasure| {
            measure.mean_force > 0.0 && measure.peak_force <= STEADY * measure.mean_force
        };
        self.joints.iter().any(|(at, _)| is_steady(&turn.joints[*at]))
    }

    /// How steady turns are, joint by joint, beside one before them.
    pub fn steadiness(
        &self,
        before: Option<&TurnMeasures>,
        turns: &[TurnMeasures],
    ) -> impl Iterator<Item = Steadiness> {
        self.joints.iter().map(move |(at, _)| {
            Steadiness::of_alike(before.map(|turn| self.wear(*at, turn)), &self.wears(*at, turns))
        })
    }

    /// Whether the mean of turns is known to this part of itself, as if they had nothing to do with one another.
    pub fn is_known_to(&self, part: f64, turns: &[TurnMeasures]) -> bool {
        self.joints.iter().all(|(at, _)| {
            Steadiness::of(None, &self.wears(*at, turns)).scatter.is_some_and(|scatter| scatter <= part)
        })
    }

    /// The mean of turns, joint by joint.
    pub fn mean(&self, turns: &[TurnMeasures]) -> Vec<ContactMeasure> {
        let of = |(at, _): &(usize, f64)| {
            ContactMeasure::mean(&turns.iter().map(|turn| &turn.joints[*at]).collect::<Vec<_>>())
        };
        self.joints.iter().map(of).collect()
    }

    /// W [m] of every turn of a wearing joint.
    fn wears(&self, at: usize, turns: &[TurnMeasures]) -> Vec<f64> {
        turns.iter().map(|turn| self.wear(at, turn)).collect()
    }

    /// W per turn [m] of a wearing joint.
    fn wear(&self, at: usize, turn: &TurnMeasures) -> f64 {
        let wear = self.description.contacts[at].wear.as_ref();
        wear.map_or(0.0, |wear| WearOf::described(wear).of(&turn.joints[at]))
    }
}

/// How much room a journal has [m]: its clearance. Wear that is kept by angle opens the gap beside that; any other opens nothing but the
/// clearance, by its feedback.
fn room(unworn: f64, joint: &JointWear) -> f64 {
    let by_angle = joint.profile.is_some() || joint.journal.is_some();
    if by_angle { joint.clearance.max(unworn + joint.wear) } else { joint.clearance }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wear::Profile;

    #[test]
    fn wear_that_opens_no_gap_gives_a_journal_no_room() {
        let unworn = 1e-5;
        let joint = |clearance, profile| JointWear { clearance, wear: 3e-5, profile, journal: None };
        // By no feedback, and by all of it.
        assert_eq!(room(unworn, &joint(unworn, None)), unworn);
        assert_eq!(room(unworn, &joint(4e-5, None)), 4e-5);
        let profile = Profile::unworn(36).expect("bins");
        assert_eq!(room(unworn, &joint(unworn, Some(profile))), unworn + 3e-5);
    }
}
