//! Angles over the steps of a run. In: steps, and states within them. Out: turns, or that they are unclear. Never records anything.

use super::Sampler;
use crate::error::RunError;
use crate::simulate::angles::Angles;
use crate::simulate::half_turn;
use crate::simulate::motion::ConstrainedMotion;

/// Halvings of a step to follow an angle: a step of a thousand turns that begin and end at rest takes twelve.
const MOST_HALVINGS: usize = 30;

/// Writes the state at a time within the last step.
type Between<'a> = &'a dyn Fn(f64, &mut [f64]);

impl Sampler<'_> {
    /// Follows angles over a step that ends in `state`, before anything within it is sampled; `between`: writes
    /// the state at a time within the step, if the method can.
    ///
    /// # Errors
    /// [`RunError::TurnsUnclear`], [`RunError::AngleJumps`], or what the mechanism reports.
    pub(in crate::simulate) fn follow_angles(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
        between: Option<Between<'_>>,
    ) -> Result<(), RunError> {
        if self.angles.is_empty() {
            return Ok(());
        }
        self.angles.begin_step();
        let mut inner = std::mem::take(&mut self.inner);
        // The step's end, and the times that have to be looked at before it.
        let (mut pending, mut last) = ([t; MOST_HALVINGS + 1], 0);
        loop {
            let next = pending[last];
            match between {
                Some(interpolate) if next < t => {
                    inner.resize(state.len(), 0.0);
                    interpolate(next, &mut inner);
                    self.observe_aside(motion, next, &inner)?;
                }
                _ => self.observe_aside(motion, next, state)?,
            }
            if let Err(angle) = self.angles.note(next, &self.values) {
                let from = self.angles.known_until().unwrap_or(next);
                if between.is_none() || last == MOST_HALVINGS {
                    let angle = self.columns.channels[angle].name.to_string();
                    return Err(RunError::TurnsUnclear { t, step: next - from, angle });
                }
                last += 1;
                pending[last] = 0.5 * (from + next);
            } else if last > 0 {
                last -= 1;
            } else {
                break;
            }
        }
        self.inner = inner;
        let begin = &self.reached;
        let straight = |time: f64, mixed: &mut [f64]| {
            let part = (time - begin.0) / (t - begin.0);
            for ((mixed, from), to) in mixed.iter_mut().zip(&begin.1).zip(state) {
                *mixed = from + part * (to - from);
            }
        };
        let within = between.unwrap_or(&straight);
        for crossing in self.angles.crossings() {
            let name = &self.columns.channels[crossing.place].name;
            half_turn::check(motion, &self.angles, &crossing, (within, state.len()), name)?;
        }
        Ok(())
    }

    /// Whether angles are followed.
    pub(in crate::simulate) fn watches_angles(&self) -> bool {
        !self.angles.is_empty()
    }

    /// Follows angles although no rows are recorded.
    pub(in crate::simulate) fn watch_angles(&mut self) {
        self.angles = Angles::new(&self.columns.channels);
    }
}
