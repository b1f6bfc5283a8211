//! Laws of contact as a step wants them: answers to motions as flat numbers, and back. In: motions, memories. Out: wrenches, rates,
//! what a contact is like. Never knows steps.

use super::TOTALS;
use super::places::{CONTACT_ANSWER, CONTACT_MEMORY};
use crate::clearance_joint::{Clearance, ContactState, Response};
use crate::contact::{ImpactMemory, Support};
use crate::scalar::Scalar;
use crate::system::CONTACT_MOTION;

/// What a round bearing answers to a motion, by the numbers that a question has of it.
pub(super) fn round_response<T: Scalar>(
    joint: &Clearance,
    motion: &[T; CONTACT_MOTION],
    [worn, stiffness, touching, closing_speed]: [T; CONTACT_MEMORY],
) -> Response<T> {
    let clearance = motion[CONTACT_MOTION - 1] + worn;
    let memory = ImpactMemory { touching, closing_speed };
    joint.respond(motion, |offset| Support::round(offset, clearance), (clearance, stiffness), &memory)
}

/// What a response adds to the totals of its joint in a second.
pub(super) fn total_rates<T: Scalar>(response: &Response<T>) -> [T; TOTALS] {
    [response.wear_power, response.depth_rate, response.normal_force, response.loss]
}

/// What the contact is like, besides.
pub(super) fn contact_answer<T: Scalar>(
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
    let response = Response {
        penetration,
        penetration_rate,
        normal_force,
        sliding_speed,
        elastic_energy,
        loss,
        wear_power,
        depth_rate,
        // Of wear by angle alone, which runs one trajectory at a time.
        wear_factor: None,
        wrench,
    };
    ContactState::of(([x, y, z], before.turned), (before.clearance, before.stiffness), &response)
}
