//! The contract with code that evaluates several trajectories side by side, a lane each: the derivative of a flat state with the
//! laws of contact in the middle, in one call. Every lane has the bits that its trajectory has alone.
//! Never knows how long steps are, nor where machine code comes from.

use crate::clearance_joint::{Clearance, ContactState, Response};
use crate::contact::{ImpactMemory, Support};
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH, Entry, Sizes};

/// Numbers that are integrated with a state for every mechanism: work supplied and work dissipated [J].
pub const WORKS: usize = 2;

/// Numbers that are integrated with a state for every joint with clearance: wear integral [J], depth by the contact area [m],
/// integral of the normal force [N s], energy lost in damping and friction [J].
pub const TOTALS: usize = 4;

/// Numbers per joint with clearance that laws want besides its motion: how far it is worn [m], on top of its clearance;
/// stiffness K there [N/m^n]; whether it touches (1) and the speed at which its gap closed [m/s], as in [`ImpactMemory`].
pub const CONTACT_MEMORY: usize = 4;

/// Numbers per joint with clearance that tell what a contact is like, besides the rates of its totals: offset (3) [m], penetration
/// [m], its rate [m/s], sliding speed [m/s], energy stored [J], wrench as [`crate::CONTACT_WRENCH`].
pub const CONTACT_ANSWER: usize = 7 + CONTACT_WRENCH;

impl Sizes {
    /// Length of a flat state: coordinates, speeds, works, totals of every joint with clearance.
    pub const fn flat_state(&self) -> usize {
        self.coordinates + self.speeds + WORKS + TOTALS * self.contacts
    }

    /// Length of the question of [`Bundle::derivative`].
    pub const fn bundle_question(&self) -> usize {
        self.input(Entry::Contacts) + CONTACT_MEMORY * self.contacts
    }

    /// Length of its answer.
    pub const fn bundle_answer(&self) -> usize {
        self.flat_state() + self.rows + self.drivers + self.rows + CONTACT_ANSWER * self.contacts
    }
}

/// Equations of `N` trajectories of one mechanism. No wear by bearing angle.
pub trait Bundle<const N: usize> {
    /// The layout, and the length of the scratch slice.
    fn sizes(&self) -> Sizes;

    /// In: as [`Entry::Contacts`], then [`CONTACT_MEMORY`] numbers of every joint with clearance. Out: the derivative of the
    /// flat state; multipliers, drive forces, loop pivots; [`CONTACT_ANSWER`] numbers of every joint with clearance. Does not
    /// allocate.
    ///
    /// # Panics
    /// If a slice is shorter than [`Sizes`] says.
    fn derivative(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]);

    /// Evaluates an entry, as [`crate::System::evaluate`].
    ///
    /// # Panics
    /// As [`Self::derivative`].
    fn evaluate(&self, entry: Entry, input: &[[f64; N]], output: &mut [[f64; N]], workspace: &mut [[f64; N]]);
}

/// What a round bearing answers to a motion, by the numbers that a question has of it.
#[inline(always)]
pub fn round_response<T: Scalar>(
    joint: &Clearance,
    motion: &[T; CONTACT_MOTION],
    [worn, stiffness, touching, closing_speed]: [T; CONTACT_MEMORY],
) -> Response<T> {
    let clearance = motion[CONTACT_MOTION - 1] + worn;
    let memory = ImpactMemory { touching, closing_speed };
    joint.respond(motion, |offset| Support::round(offset, clearance), (clearance, stiffness), &memory)
}

/// What a response adds to the totals of its joint in a second.
#[inline(always)]
pub fn total_rates<T: Scalar>(response: &Response<T>) -> [T; TOTALS] {
    [response.wear_power, response.depth_rate, response.normal_force, response.loss]
}

/// What the contact is like, besides.
#[inline(always)]
pub fn contact_answer<T: Scalar>(
    joint: &Clearance,
    motion: &[T; CONTACT_MOTION],
    response: &Response<T>,
) -> [T; CONTACT_ANSWER] {
    let [x, y, z] = joint.offset(motion);
    let Response { penetration, penetration_rate, sliding_speed, elastic_energy, .. } = *response;
    let [fx, fy, fz, mx, my, mz] = response.wrench;
    [x, y, z, penetration, penetration_rate, sliding_speed, elastic_energy, fx, fy, fz, mx, my, mz]
}

/// The contact as laws tell it alone, by both of its answers; `before`: at another instant of the same wear.
pub(crate) fn contact_state(
    before: &ContactState,
    rates: [f64; TOTALS],
    answer: [f64; CONTACT_ANSWER],
) -> ContactState {
    let [wear_power, depth_rate, normal_force, loss] = rates;
    let [x, y, z, penetration, penetration_rate, sliding_speed, elastic_energy, wrench @ ..] = answer;
    ContactState {
        offset: [x, y, z],
        clearance: before.clearance,
        gap: -penetration,
        penetration_rate,
        normal_force,
        stiffness: before.stiffness,
        sliding_speed,
        elastic_energy,
        loss,
        wear_power,
        depth_rate,
        wrench,
    }
}
