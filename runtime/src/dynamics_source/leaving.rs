//! Measurements whose turns agree for want of anything that would take them apart. In: one that is done. Out: whether it has to be made
//! again, elsewhere. Never looks at what turns wear.

use super::measuring::Measuring;
use super::returning::Stand;
use super::stability;
use crate::error::RunError;
use crate::simulate::TurnRunner;
use crate::watch::Watch;

/// Whether a measurement has to be made again whose turns agree for want of anything that would take them apart: the runner, at the end
/// of its last turn, is then where the motion goes.
pub(super) fn leaves(
    runner: &mut TurnRunner<'_>,
    measuring: &mut Measuring,
    watch: Watch<'_>,
) -> Result<bool, RunError> {
    let (from, _) = measuring.next();
    let left = stability::leave(runner, measuring.every(), watch.piece(from, from))?;
    let has_left = left.is_some();
    measuring.is_tried(left, Stand::of(runner));
    Ok(has_left)
}
