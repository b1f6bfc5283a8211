//! What drives and forces do at other times and with other values of a file's own states than the present ones. In: a runner.
//! Out: accelerations. Moves nothing.

use super::TurnRunner;
use crate::assemble::rest_under_way;
use crate::description::VALUE;
use crate::error::RunError;
use crate::simulate::schedule::Schedule;

impl TurnRunner<'_> {
    /// When the driver has made a part of a turn from a time [s] on.
    ///
    /// # Errors
    /// [`RunError::TurnsNotReached`] if it does not.
    pub(crate) fn part_of_turn(&mut self, from: f64, part: f64) -> Result<f64, RunError> {
        Schedule::part_of_turn(&mut self.motion.dynamics.evaluator, from, part)
    }

    /// Present time [s].
    pub(crate) const fn t(&self) -> f64 {
        self.t
    }

    /// Places, among the free speeds, of the values of states that the file has of its own.
    pub(crate) fn own_states(&self) -> Vec<usize> {
        let speeds = &self.motion.dynamics.evaluator.description().speeds;
        (0..speeds.len()).filter(|place| speeds[*place].name.ends_with(VALUE)).collect()
    }

    /// Name of a free speed.
    pub(crate) fn name_of_speed(&self, place: usize) -> &str {
        let name = &self.motion.dynamics.evaluator.description().speeds[place].name;
        name.strip_suffix(VALUE).unwrap_or(name)
    }

    /// A free speed.
    pub(crate) fn speed(&self, place: usize) -> f64 {
        self.state.v[place]
    }

    /// Sets free speeds.
    pub(crate) fn set_speeds(&mut self, values: &[(usize, f64)]) {
        values.iter().for_each(|(place, value)| self.state.v[*place] = *value);
    }

    /// Puts journals where the loads that hold now press them, moving with those: nothing damps one that swings because loads have
    /// changed at once.
    pub(crate) fn rest_journals(&mut self) {
        if let Some(state) = rest_under_way(&mut self.motion.dynamics.evaluator, self.t, &self.state) {
            self.state = state;
            self.motion.learn_sizes(self.t, &self.state);
        }
    }

    /// Accelerations of the free speeds that would hold at a time [s], if all free coordinates were where they are now, and all free
    /// speeds these.
    pub(crate) fn accelerations_at(&mut self, t: f64, speeds: &[f64]) -> &[f64] {
        self.motion.dynamics.evaluator.forward(t, &self.state.q, speeds).accelerations
    }

    /// The free speeds.
    pub(crate) fn speeds(&self) -> &[f64] {
        &self.state.v
    }
}
