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
    /// Largest error of the energy balance so far, the most that a step added to it [J], and the passage in which it did.
    energy: (f64, f64, Option<f64>),
}

impl Passages {
    /// Notes how regular the state at the end of a step is, if it is `rough`, and the energy error so far [J].
    pub(super) fn note(&mut self, t: f64, (rough, regularity): (bool, f64), energy_error: f64) {
        self.since = if rough { 0 } else { self.since.saturating_add(1) };
        self.deepest = match self.deepest {
            known if !rough => known.filter(|_| self.since <= AFTERMATH),
            Some(known) if known.1 <= regularity => Some(known),
            _ => Some((t, regularity)),
        };
        let passage = self.deepest.map(|(t, _)| t);
        let (known, most, _) = self.energy;
        let added = energy_error - known;
        if added > most {
            self.energy = (energy_error, added, passage);
        } else {
            self.energy.0 = energy_error;
        }
    }

    /// Names the singular position, if the run failed on its way through one.
    pub(super) fn explain(&self, integrator: Integrator, error: RunError) -> RunError {
        let position = match &error {
            RunError::EnergyLost { .. } => self.energy.2,
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
        passages.note(1.0, (true, 1e-2), 0.0);
        passages.note(2.0, (true, 1e-4), 0.1);
        passages.note(3.0, (true, 1e-3), 0.1);
        passages.note(4.0, (false, 0.5), 0.9);
        // Long after, in another one: what was lost there is less.
        (0..=AFTERMATH).for_each(|step| passages.note(5.0 + f64::from(step), (false, 0.5), 0.9));
        passages.note(50.0, (true, 1e-3), 1.0);
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
        passages.note(1.0, (true, 1e-4), 0.0);
        (0..=AFTERMATH).for_each(|step| passages.note(2.0 + f64::from(step), (false, 0.5), 0.0));
        passages.note(20.0, (false, 0.5), 1.0);
        assert_eq!(passages.explain(FIXED, LOST), LOST);
        let failed = RunError::NewtonFailed { t: 20.0, step: 1e-3, correction: 1.0 };
        assert_eq!(passages.explain(FIXED, failed.clone()), failed);
    }
}
