//! Journals that touch follow a bearing whose surface has moved: by wear, or by another clearance. In: contacts before.
//! Out: a state that is as deep in contact as it was, and moves along the surface as it did.

use crate::assemble::{State, place_moving};
use crate::clearance_joint::ContactState;
use crate::evaluate::Evaluator;
use crate::scalar::dot;
use crate::system::CONTACT_MOTION;

/// Moves every journal that touched so that its penetration is what it was, and lets it go on with the angular speed about the
/// bearing's centre that it had; the contacts must have been evaluated with the new surface. Where no surface has moved, or loops
/// do not let it, nothing changes.
///
/// A journal put down at rest would ring: the first turn of the case study then wears ten times further from what it settles to.
pub(super) fn follow(evaluator: &mut Evaluator<'_>, t: f64, state: &mut State, before: &[ContactState]) {
    let now = evaluator.clearances().contacts();
    let moved: Vec<bool> =
        before.iter().zip(now).map(|(before, now)| before.gap < 0.0 && before.gap != now.gap).collect();
    if !moved.contains(&true) {
        return;
    }
    let target = |(joint, (touch, moved)): (usize, (&ContactState, &bool))| {
        if !moved {
            return touch.offset;
        }
        let normal = touch.normal();
        let distance = evaluator.clearances().distance(joint, normal, touch.penetration());
        normal.map(|component| distance * component)
    };
    let targets: Vec<[f64; 3]> = before.iter().zip(&moved).enumerate().map(target).collect();
    let motions = evaluator.contact_motion(t, &state.q, &state.v);
    let each = before.iter().zip(motions.as_chunks::<CONTACT_MOTION>().0).zip(&targets);
    let rates: Vec<[f64; 3]> = each
        .map(|((touch, motion), target)| turned_on(touch, [motion[3], motion[4], motion[5]], *target))
        .collect();
    let targets: Vec<_> = targets.into_iter().map(Some).collect();
    let _ = place_moving(evaluator, t, state, (&targets, &rates));
}

/// Rate [m/s] of an offset that was another one: the same towards the surface, and the same angular speed.
fn turned_on(before: &ContactState, rate: [f64; 3], offset: [f64; 3]) -> [f64; 3] {
    let normal = before.normal();
    let along = dot(rate, normal);
    let distance = dot(before.offset, normal);
    let larger = if distance > 0.0 { dot(offset, normal) / distance } else { 1.0 };
    std::array::from_fn(|axis| {
        let towards = along * normal[axis];
        towards + larger * (rate[axis] - towards)
    })
}
