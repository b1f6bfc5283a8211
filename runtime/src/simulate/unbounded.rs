//! Columns at states where the loops have lost rank. In: columns as the rows give them. Out: as the motion passes through
//! them, and which of them grow without bounds there. Never knows steps.

use super::motion::ConstrainedMotion;
use super::warning::RunWarning;
use crate::description::Channel;

/// What a run met at such states.
#[derive(Clone, Debug, Default)]
pub(super) struct Unbounded {
    /// When it was there first [s].
    first: f64,
    /// For every generated column, whether it was without bounds.
    columns: Vec<bool>,
}

impl Unbounded {
    /// Puts the limits of the motion in place of the columns that depend on forces; `columns` are those of the last forward
    /// dynamics at the state.
    pub(super) fn take_limits(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        channels: &[Channel],
        columns: &mut [f64],
    ) {
        if !motion.dynamics.is_rank_lost() {
            return;
        }
        let of_forces = columns_of_forces(motion, (t, q, v), columns);
        let mut unbounded = vec![false; columns.len()];
        match motion.dynamics.columns_beside(t, q, v) {
            Some(limit) => {
                // Moments are compared with moments, forces with forces.
                let size = |unit: &str| {
                    let same = of_forces.iter().filter(|place| channels[**place].unit == unit);
                    same.fold(0.0_f64, |most, place| most.max(limit.size(*place)))
                };
                for place in &of_forces {
                    columns[*place] = limit.column(*place);
                    unbounded[*place] = limit.is_unbounded(*place, size(&channels[*place].unit));
                }
            }
            // A dead point, or rest: nothing tells how the motion goes on.
            None => of_forces.iter().for_each(|place| unbounded[*place] = true),
        }
        if self.columns.is_empty() && unbounded.contains(&true) {
            (self.first, self.columns) = (t, vec![false; columns.len()]);
        }
        self.columns.iter_mut().zip(unbounded).for_each(|(known, now)| *known |= now);
    }

    /// The warning of the run, if there is one.
    pub(super) fn warning(&self, channels: &[Channel]) -> Option<RunWarning> {
        let names = channels.iter().zip(&self.columns).filter(|(_, unbounded)| **unbounded);
        let columns: Vec<_> = names.map(|(channel, _)| channel.name.to_string()).collect();
        (!columns.is_empty()).then_some(RunWarning::ForcesUnbounded { t: self.first, columns })
    }
}

/// The columns that other multipliers and drive forces would change.
fn columns_of_forces(
    motion: &mut ConstrainedMotion<'_>,
    (t, q, v): (f64, &[f64], &[f64]),
    columns: &[f64],
) -> Vec<usize> {
    let evaluator = &mut motion.dynamics.evaluator;
    let output = evaluator.forward_mut();
    let forward = output.to_vec();
    for (place, force) in output.iter_mut().enumerate().skip(v.len()) {
        // Different for each, so that none take each other away.
        *force = 2.0 * *force + 1.0 + place as f64;
    }
    let other = evaluator.observe(t, q, v);
    let places = (0..columns.len()).filter(|place| other[*place] != columns[*place]).collect();
    evaluator.forward_mut().copy_from_slice(&forward);
    places
}
