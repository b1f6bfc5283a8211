//! What a contact remembers: the speed at which its gap closed. In: penetration and its rate, step by step.
//! Out: the impact speed of the running contact. Part of the state of a trajectory: saved and restored with it.
//! Never knows how long a contact lasts or who integrates.

use super::normal::Normal;
use crate::scalar::Scalar;

/// Memory of the current contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct ImpactMemory<T> {
    /// One while the bodies touch, zero while they are apart (a number, so that lanes can hold it).
    pub touching: T,
    /// Speed at which the gap closed [m/s]; zero while apart.
    pub closing_speed: T,
}

impl<T: Scalar> ImpactMemory<T> {
    /// Memory of bodies that are apart.
    pub fn apart() -> Self {
        Self { touching: T::constant(0.0), closing_speed: T::constant(0.0) }
    }

    /// Memory of a contact that began with `closing_speed` [m/s]; zero for one that rests.
    pub fn in_contact(closing_speed: T) -> Self {
        Self { touching: T::constant(1.0), closing_speed }
    }

    /// The memory after a step or event that ended with `penetration` [m]: a new contact remembers
    /// `closing_speed` (see [`crossing_speed`]; at a located onset simply the penetration rate), a
    /// running one keeps what it has, a released one forgets.
    #[inline]
    pub fn updated(self, penetration: T, closing_speed: T) -> Self {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let now = zero.lt(penetration);
        let before = T::constant(0.5).lt(self.touching);
        let speed = T::select(before, self.closing_speed, closing_speed.max(zero));
        Self { touching: T::select(now, one, zero), closing_speed: T::select(now, speed, zero) }
    }

    /// The impact speed v0 [m/s] that a normal law takes now, at least its floor.
    ///
    /// Within the step in which a gap closes nothing is remembered yet; there the present rate counts.
    #[inline]
    pub fn impact_speed(&self, law: &Normal, penetration_rate: T) -> T {
        let before = T::constant(0.5).lt(self.touching);
        law.impact_speed(T::select(before, self.closing_speed, penetration_rate))
    }
}

/// Speed [m/s] at which the gap closed within a step, from penetration [m] and rate [m/s] at both ends:
/// the rate, taken as linear in time, where the penetration, taken as linear too, is zero.
///
/// Needed only by methods that do not locate the onset. If nothing changes, the rate at the end.
#[inline]
pub fn crossing_speed<T: Scalar>(before: (T, T), after: (T, T)) -> T {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let rise = after.0 - before.0;
    let rises = zero.lt(rise);
    let part = -before.0 / T::select(rises, rise, one);
    // Before the step or after it there is no crossing: the nearer end counts.
    let part = T::select(part.lt(zero), zero, part);
    let part = T::select(rises, T::select(one.lt(part), one, part), one);
    before.1 + part * (after.1 - before.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Restitution;

    #[test]
    fn a_contact_remembers_the_speed_it_began_with_until_it_ends() {
        let law = Normal::new(Restitution::LankaraniNikravesh, 0.9, 1.5, 1e-3).unwrap();
        let apart = ImpactMemory::<f64>::apart();
        assert_eq!(apart.updated(-1e-6, 0.3), apart);
        assert_eq!(apart.impact_speed(&law, 0.4), 0.4);
        let hit = apart.updated(1e-9, 0.3);
        assert_eq!(hit, ImpactMemory::in_contact(0.3));
        assert_eq!(hit.updated(1e-6, -0.1), hit);
        assert_eq!(hit.impact_speed(&law, -0.1), 0.3);
        let again = hit.updated(-1e-9, 0.2).updated(1e-9, 0.05);
        assert_eq!(again, ImpactMemory::in_contact(0.05));
    }

    #[test]
    fn resting_contacts_take_the_floor() {
        let law = Normal::new(Restitution::LankaraniNikravesh, 0.9, 1.5, 2e-3).unwrap();
        assert_eq!(ImpactMemory::in_contact(0.0).impact_speed(&law, 5.0), 2e-3);
        // A contact that appears while the bodies part (start of a run) has no closing speed.
        assert_eq!(ImpactMemory::apart().updated(1e-9, -0.2).closing_speed, 0.0);
    }

    #[test]
    fn crossing_speed_lies_where_the_gap_closes() {
        assert_eq!(crossing_speed((-1.0, 4.0), (3.0, 2.0)), 3.5);
        assert_eq!(crossing_speed((-2.0, 1.0), (-1.0, 2.0)), 2.0);
        assert_eq!(crossing_speed((1.0, 1.0), (2.0, 2.0)), 1.0);
        assert_eq!(crossing_speed((1.0, 1.0), (1.0, 7.0)), 7.0);
        assert_eq!(crossing_speed((0.0, 1.0), (1.0, 7.0)), 1.0);
    }
}
