//! Columns at states where the loops have lost rank. In: columns as the rows give them. Out: as the motion passes through
//! them, which of them grow without bounds there, and which nothing tells. Never knows steps.

use super::motion::ConstrainedMotion;
use super::warning::RunWarning;
use crate::description::Channel;

/// What a run met at such states.
#[derive(Clone, Debug, Default)]
pub(super) struct Unbounded {
    /// Columns that were without bounds where the motion passes through.
    growing: Met,
    /// Columns that nothing tells where it does not: at a dead point, or at rest.
    unknown: Met,
}

/// Columns that have shown something.
#[derive(Clone, Debug, Default)]
struct Met {
    /// When one did first [s].
    first: f64,
    /// For every generated column, whether it did.
    columns: Vec<bool>,
}

impl Met {
    fn note(&mut self, t: f64, now: Vec<bool>) {
        if self.columns.is_empty() && now.contains(&true) {
            (self.first, self.columns) = (t, vec![false; now.len()]);
        }
        self.columns.iter_mut().zip(now).for_each(|(known, now)| *known |= now);
    }

    /// When, and the names, if there was one.
    fn told(&self, channels: &[Channel]) -> Option<(f64, Vec<String>)> {
        let met = channels.iter().zip(&self.columns).filter(|(_, met)| **met);
        let names: Vec<_> = met.map(|(channel, _)| channel.name.to_string()).collect();
        (!names.is_empty()).then_some((self.first, names))
    }
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
        let mut found = vec![false; columns.len()];
        match motion.dynamics.columns_beside(t, q, v) {
            Some(limit) => {
                // Moments are compared with moments, forces with forces.
                let size = |unit: &str| {
                    let same = of_forces.iter().filter(|place| channels[**place].unit == unit);
                    same.fold(0.0_f64, |most, place| most.max(limit.size(*place)))
                };
                for place in &of_forces {
                    columns[*place] = limit.column(*place);
                    found[*place] = limit.is_unbounded(*place, size(&channels[*place].unit));
                }
                self.growing.note(t, found);
            }
            // A dead point, or rest: there are no states of the motion on both sides.
            None => {
                of_forces.iter().for_each(|place| found[*place] = true);
                self.unknown.note(t, found);
            }
        }
    }

    /// The warnings of the run.
    pub(super) fn warnings(&self, channels: &[Channel]) -> impl Iterator<Item = RunWarning> {
        let growing = self.growing.told(channels);
        let unknown = self.unknown.told(channels);
        let growing = growing.map(|(t, columns)| RunWarning::ForcesUnbounded { t, columns });
        growing.into_iter().chain(unknown.map(|(t, columns)| RunWarning::ForcesUnknown { t, columns }))
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
