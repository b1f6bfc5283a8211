//! What a recorder needs to go on where no run does: beyond its end, with other laws, from a state that was kept.

use super::Sampler;
use crate::clearance_joint::{Clearances, ContactState};
use crate::error::RunError;
use crate::simulate::guard::Guard;
use crate::simulate::motion::ConstrainedMotion;

impl Sampler<'_> {
    /// Goes on beyond the end, up to another.
    pub(in crate::simulate) fn extend(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (t, state): (f64, &[f64]),
        end: f64,
    ) {
        self.schedule.end = end;
        self.watch_from(motion, (t, state));
        self.find_turn_end(motion);
    }

    /// A step ends here that was not meant to: the motion goes on otherwise.
    pub(in crate::simulate) fn cut(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        self.closing = None;
        self.angles.cut(t);
        self.step_done(motion, t, state)
    }

    /// Judges balance and progress from a state on, whatever went before.
    pub(in crate::simulate) fn watch_from(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (t, state): (f64, &[f64]),
    ) {
        let tried = self.statistics.steps + self.statistics.rejected;
        self.guard = Guard::new((t, self.schedule.end), tried);
        let energies = motion.energies(t, state);
        motion.energy_scale = motion.energy_scale.max(energies.kinetic);
        self.ledger.balance.go_on_from(&energies);
        self.judge_from(motion, t, state);
        self.reached.0 = t;
        self.reached.1.copy_from_slice(state);
    }

    /// Contacts at the end of the last step.
    pub(in crate::simulate) fn contacts(&self) -> &[ContactState] {
        self.follower.as_ref().map_or(&[], |follower| &follower.contacts)
    }

    /// As [`crate::simulate::contacts::Follower::watched`].
    pub(in crate::simulate) fn watched(&self, clearances: &Clearances) -> impl Iterator<Item = f64> {
        self.follower.iter().flat_map(|follower| follower.watched(clearances))
    }

    /// Whether a step that ends at `t` [s], after so many tried, changes nothing but what is added up.
    pub(in crate::simulate) fn is_idle(&self, t: f64, tried: u64) -> bool {
        self.angles.is_empty() && self.passages.are_over() && !self.guard.is_due(t, tried)
    }

    /// Takes over steps in which nothing happened, the last of which ended in `state`; what was added up is in the ledger already.
    pub(in crate::simulate) fn take_over(
        &mut self,
        motion: &ConstrainedMotion<'_>,
        (t, state): (f64, &[f64]),
        (steps, added): (u32, f64),
        contact: impl Fn(usize, &ContactState) -> ContactState,
    ) {
        self.statistics.steps += u64::from(steps);
        self.passages.note_regular(steps, added < self.ledger.balance.added);
        if let Some(follower) = &mut self.follower {
            follower.take_over(motion, (t, state), contact);
        }
        self.reached.0 = t;
        self.reached.1.copy_from_slice(state);
    }

    /// What of it decides on steps to come, beside the motion: numbers in one order.
    pub(in crate::simulate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        visit(&mut self.reached.0);
        self.reached.1.iter_mut().chain(&mut self.values).for_each(&mut *visit);
        let mut turn_end = self.turn_end.unwrap_or(f64::INFINITY);
        visit(&mut turn_end);
        self.turn_end = turn_end.is_finite().then_some(turn_end);
        let mut closing = self.closing.map_or(-1.0, |joint| joint as f64);
        visit(&mut closing);
        self.closing = (closing >= 0.0).then_some(closing as usize);
        visit(&mut self.schedule.end);
        if let Some(follower) = &mut self.follower {
            visit(&mut follower.turn_begin);
        }
    }

    /// After memory was put back that may be of another time.
    pub(in crate::simulate) fn resume(&mut self, motion: &mut ConstrainedMotion<'_>) {
        let (t, state) = std::mem::take(&mut self.reached);
        if let Some(follower) = &mut self.follower {
            follower.resume(motion, t, &state);
        }
        self.reached.1 = state.clone();
        self.watch_from(motion, (t, &state));
    }
}
