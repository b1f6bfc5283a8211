//! Controllers that act at sampled times: a step ends at each sample, what they hold changes there, and the next step begins behind
//! it. In: a time and a state. Out: the state behind it. Never knows their laws: those are columns.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use crate::error::RunError;

/// Lets the controllers act that a run begins with.
pub(super) fn begin(motion: &mut ConstrainedMotion<'_>, t: f64, state: &mut [f64]) -> Result<(), RunError> {
    act(motion, None, t, state).map(drop)
}

/// Lets the controllers act that are due where a step from `from` ends; whether any was.
pub(super) fn act_behind(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    (from, t): (f64, f64),
    state: &mut [f64],
) -> Result<bool, RunError> {
    let acted = motion.dynamics.evaluator.has_samplers() && act(motion, Some(from), t, state)?;
    if acted {
        // Columns jump here: both sides count among their extremes.
        sampler.look(motion, (t, state), None)?;
    }
    Ok(acted)
}

/// One after the other, in the order of the file: each sees what those before it have just put out.
fn act(
    motion: &mut ConstrainedMotion<'_>,
    from: Option<f64>,
    t: f64,
    state: &mut [f64],
) -> Result<bool, RunError> {
    let mut acted = false;
    for sampler in 0..motion.dynamics.evaluator.samplers() {
        if !motion.dynamics.evaluator.acts(sampler, from, t) {
            continue;
        }
        let (q, v) = motion.split_mut(state);
        let aside = motion.dynamics.aside();
        let held = motion.dynamics.accelerate(t, q, v).and_then(|()| {
            let held = motion.dynamics.evaluator.hold(sampler, (t, q), v);
            held.map_err(|what| RunError::NonFinite { t, what })
        });
        motion.dynamics.resume(aside);
        held?;
        acted = true;
    }
    Ok(acted)
}
