//! Laws that change while a mechanism stands at a state: parameters, wear. In: the state, the change and what takes it back.
//! Out: contacts before the change, if the mechanism can go on from the state. Never knows steps.

use crate::assemble::{State, check_clearances};
use crate::clearance_joint::ContactState;
use crate::error::SetupError;
use crate::evaluate::{CLOSED, Evaluator};

/// A driver may jump by this much with a parameter [rad, m, rad/s, m/s].
const SAME_LAW: f64 = 1e-9;

/// Changes laws at a state; `undo` takes that back where the mechanism does not bear it. The contacts before, for journals to
/// follow their surfaces.
pub(super) fn change<'a>(
    evaluator: &mut Evaluator<'a>,
    (t, state): (f64, &State),
    arm: f64,
    change: impl FnOnce(&mut Evaluator<'a>) -> Result<(), SetupError>,
    undo: impl FnOnce(&mut Evaluator<'a>),
) -> Result<Vec<ContactState>, SetupError> {
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let before = evaluator.clearances().contacts().to_vec();
    let laws = evaluator.prescribed(t).to_vec();
    change(evaluator)?;
    if let Err(error) = laws_go_on(evaluator, (t, state), &laws, arm) {
        undo(evaluator);
        // Who sets a time without its state has opened the loops before: no value of a parameter closes them then.
        let was_open = open_loop(evaluator, (t, state), arm);
        return Err(was_open.map_or(error, |(joint, open)| SetupError::NotOnLoops { joint, open, t }));
    }
    Ok(before)
}

/// Whether the mechanism can go on at a state with laws that have changed.
fn laws_go_on(
    evaluator: &mut Evaluator<'_>,
    (t, state): (f64, &State),
    laws: &[f64],
    arm: f64,
) -> Result<(), SetupError> {
    let now = evaluator.prescribed(t).to_vec();
    for (driver, (now, before)) in now.chunks_exact(3).zip(laws.chunks_exact(3)).enumerate() {
        for (now, before) in now.iter().zip(before).take(2) {
            let jump = (now - before).abs();
            // What is not a number is no law.
            let same = jump <= SAME_LAW * before.abs().max(1.0);
            if !same {
                let what = format!("the driver of {}", evaluator.description().drivers[driver].joint);
                return Err(SetupError::Jump { what, jump });
            }
        }
    }
    if let Some((joint, jump)) = open_loop(evaluator, (t, state), arm) {
        return Err(SetupError::Jump { what: format!("joint {joint}"), jump });
    }
    check_clearances(evaluator, t, state)
}

/// The joint where loops are open at a state, and how far [m or rad].
fn open_loop(evaluator: &mut Evaluator<'_>, (t, state): (f64, &State), arm: f64) -> Option<(String, f64)> {
    evaluator.closure(t, &state.q, &state.v);
    let open = evaluator.loop_error();
    let closed = open.part(arm) <= CLOSED;
    (!closed).then(|| (evaluator.joint_of_row(open.worst), open.metres.max(open.radians)))
}
