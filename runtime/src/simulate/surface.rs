//! Journals that touch follow a bearing whose surface has moved: by wear, or by another clearance. In: contacts before.
//! Out: a state that is as deep in contact as it was.

use crate::assemble::{State, place};
use crate::clearance_joint::ContactState;
use crate::evaluate::Evaluator;

/// Moves every journal that touched so that its penetration is what it was, at rest in its bearing; the contacts must have
/// been evaluated with the new surface. Where no surface has moved, or loops do not let it, nothing changes.
pub(super) fn follow(evaluator: &mut Evaluator<'_>, t: f64, state: &mut State, before: &[ContactState]) {
    let now = evaluator.clearances().contacts();
    let moved: Vec<bool> =
        before.iter().zip(now).map(|(before, now)| before.gap < 0.0 && before.gap != now.gap).collect();
    if !moved.contains(&true) {
        return;
    }
    let target = |(joint, (touch, moved)): (usize, (&ContactState, &bool))| {
        if !moved {
            return Some(touch.offset);
        }
        let normal = touch.normal();
        let distance = evaluator.clearances().distance(joint, normal, touch.penetration());
        Some(normal.map(|component| distance * component))
    };
    let targets: Vec<_> = before.iter().zip(&moved).enumerate().map(target).collect();
    let _ = place(evaluator, t, state, &targets);
}
