//! The singular position behind a run that cannot go on. In: how regular the states of a run were, and its error. Out: the
//! error with the position's time and what to do, or as it was. Never integrates.

use super::settings::Integrator;
use crate::error::RunError;

/// Steps after a passage that still belong to it: generalised-alpha damps a jolt by 0.8 a step or faster, to a tenth in these.
const AFTERMATH: u32 = 10;

/// What a run met of nearly singular positions.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Passages {
    /// Time and regularity of the most singular state on the present way through one.
    deepest: Option<(f64, f64)>,
    /// Steps since a state was nearly singular.
    since: u32,
    /// The passage in which a step added most to the error of the energy balance.
    costliest: Option<f64>,
}

impl Passages {
    /// Notes how regular the state at the end of a step is, if it is `rough`, and whether the step added more to the error of the
    /// energy balance than any before.
    pub(super) fn note(&mut self, t: f64, (rough, regularity): (bool, f64), is_costliest: bool) {
        self.since = if rough { 0 } else { self.since.saturating_add(1) };
        self.deepest = match self.deepest {
            known if !rough => known.filter(|_| self.since <= AFTERMATH),
            Some(known) if known.1 <= regularity => Some(known),
            _ => Some((t, regularity)),
        };
        if is_costliest {
            self.costliest = self.deepest.map(|(t, _)| t);
        }
    }

    /// Whether the last passage is so long ago that a step is none of its own.
    pub(super) fn are_over(&self) -> bool {
        self.deepest.is_none()
    }

    /// Notes steps in regular positions, with no passage before; whether one of them is the costliest.
    pub(super) fn note_regular(&mut self, steps: u32, is_costliest: bool) {
        self.since = self.since.saturating_add(steps);
        if is_costliest {
            self.costliest = None;
        }
    }

    /// Names the singular position, if the run failed on its way through one.
    pub(super) fn explain(&self, integrator: Integrator, error: RunError) -> RunError {
        let position = match &error {
            RunError::EnergyLost { .. } => self.costliest,
            RunError::StepTooSmall { .. }
            | RunError::LostAssembly { .. }
            | RunError::BranchChange { .. }
            | RunError::NonFinite { .. }
            | RunError::TurnsUnclear { .. }
            | RunError::NoProgress { .. }
            | RunError::NewtonFailed { .. } => self.deepest.map(|(t, _)| t),
            _ => None,
        };
        let Some(t) = position else { return error };
        let is_adaptive = integrator.tolerance().is_some();
        RunError::InSingularPosition { t, is_adaptive, cause: Box::new(error) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIXED: Integrator = Integrator::Rk4 { step: 1e-3 };
    const LOST: RunError = RunError::EnergyLost { t: 9.0, error: 1.0, throughput: 2.0 };

    #[test]
    fn lost_energy_is_put_down_to_the_passage_in_which_it_was_lost() {
        let mut passages = Passages::default();
        passages.note(1.0, (true, 1e-2), false);
        passages.note(2.0, (true, 1e-4), true);
        passages.note(3.0, (true, 1e-3), false);
        passages.note(4.0, (false, 0.5), true);
        // Long after, in another one: what was lost there is less.
        (0..=AFTERMATH).for_each(|step| passages.note(5.0 + f64::from(step), (false, 0.5), false));
        passages.note(50.0, (true, 1e-3), false);
        let error = passages.explain(FIXED, LOST);
        let RunError::InSingularPosition { t: 2.0, is_adaptive: false, cause } = &error else {
            panic!("{error}")
        };
        assert_eq!(**cause, LOST);
        assert!(error.to_string().contains("dopri5"), "{error}");
    }

    #[test]
    fn what_fails_in_regular_positions_stays_as_it_is() {
        let mut passages = Passages::default();
        passages.note(1.0, (true, 1e-4), false);
        (0..=AFTERMATH).for_each(|step| passages.note(2.0 + f64::from(step), (false, 0.5), false));
        passages.note(20.0, (false, 0.5), true);
        assert_eq!(passages.explain(FIXED, LOST), LOST);
        let failed = RunError::NewtonFailed { t: 20.0, step: 1e-3, correction: 1.0 };
        assert_eq!(passages.explain(FIXED, failed.clone()), failed);
    }
}
