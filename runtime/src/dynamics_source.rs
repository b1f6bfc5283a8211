//! The fine scale of a life by the equations of motion themselves. In: a mechanism, how a revolution is run.
//! Out: what one settled revolution wears at a given state of wear. Never knows cycles, draws or thresholds.

use crate::description::Description;
use crate::dynamics::SINGULAR_PIVOT;
use crate::error::RunError;
use crate::life::{JointLife, JointWear, SettingsError, WearSource};
use crate::simulate::{Integrator, RunWarning, TurnMeasures, TurnRunner, TurnState};
use crate::system::System;
use crate::watch::Watch;
use crate::wear::ContactMeasure;

/// How revolutions are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevolutionSettings {
    /// The method.
    pub integrator: Integrator,
    /// Turns after each change of wear before one is measured.
    pub settle: u32,
    /// Turns whose mean is taken, at least 1. One is enough for a periodic motion; one that chatters needs 20 or more.
    pub average: u32,
}

impl Default for RevolutionSettings {
    /// Runge-Kutta of order 4 at 20 µs (error of the wear integral of the case study 5e-9), 4 turns to settle.
    fn default() -> Self {
        Self { integrator: Integrator::Rk4 { step: 2e-5 }, settle: 4, average: 1 }
    }
}

/// Revolutions of one mechanism.
#[must_use]
pub struct DynamicsSource<'a> {
    runner: TurnRunner<'a>,
    description: &'a Description,
    start: TurnState,
    /// Indices of the wearing joints among those with clearance, with their clearance at the start [m].
    wearing: Vec<(usize, f64)>,
    settings: RevolutionSettings,
    watch: Watch<'a>,
    warnings: Vec<RunWarning>,
}

impl<'a> DynamicsSource<'a> {
    /// Starts at t = 0 with unworn joints.
    ///
    /// # Errors
    /// If parameters or the method make no sense, or nothing turns, or there is no consistent start.
    pub fn new(
        system: &'a dyn System<f64>,
        description: &'a Description,
        parameters: &[f64],
        settings: RevolutionSettings,
    ) -> Result<Self, RunError> {
        let mut runner =
            TurnRunner::new(system, description, parameters, settings.integrator, SINGULAR_PIVOT)?;
        let clearances = runner.clearances();
        let wearing = (0..clearances.len()).filter(|at| description.contacts[*at].wear.is_some());
        let wearing = wearing.map(|at| (at, clearances[at])).collect();
        let start = runner.state();
        Ok(Self { runner, description, start, wearing, settings, watch: Watch::NONE, warnings: Vec::new() })
    }

    /// Hears of the finished part of every measurement; when it breaks, the measurement ends with
    /// [`RunError::Interrupted`].
    pub fn watched_by(mut self, watch: Watch<'a>) -> Self {
        self.watch = watch;
        self
    }

    /// The wearing joints as the mechanism describes them, for [`crate::life::LifeSettings::new`]; none if nothing
    /// wears.
    ///
    /// # Errors
    /// If a number of a joint is out of range.
    pub fn joints(&self) -> Result<Vec<JointLife>, SettingsError> {
        let of = |(at, clearance): &(usize, f64)| {
            JointLife::of_contact(&self.description.contacts[*at], *clearance).transpose()
        };
        self.wearing.iter().filter_map(of).collect()
    }

    /// Goes on after measurements of another source, which doubted this: it is not told again.
    pub fn known(&mut self, warnings: &[RunWarning]) {
        self.warnings = warnings.to_vec();
    }

    /// What was doubtful in the runs so far, the first of each kind.
    pub fn warnings(&self) -> &[RunWarning] {
        &self.warnings
    }

    /// Settles, then measures turn by turn.
    fn turns(&mut self) -> Result<Vec<TurnMeasures>, RunError> {
        let (settle, average) = (f64::from(self.settings.settle), self.settings.average.max(1));
        let total = settle + f64::from(average);
        self.runner.settle(self.settings.settle, self.watch.piece(0.0, settle / total))?;
        let turn = |index: u32| {
            let done = settle + f64::from(index);
            self.runner.measure(self.watch.piece(done / total, (done + 1.0) / total))
        };
        (0..average).map(turn).collect()
    }

    fn note(&mut self, turns: &[TurnMeasures]) {
        for warning in turns.iter().flat_map(|turn| &turn.warnings) {
            // Told once a kind: the figures change from turn to turn.
            let same =
                |known: &RunWarning| core::mem::discriminant(known) == core::mem::discriminant(warning);
            if !self.warnings.iter().any(same) {
                self.warnings.push(warning.clone());
            }
        }
    }
}

impl WearSource for DynamicsSource<'_> {
    type State = Option<TurnState>;
    type Error = RunError;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, RunError> {
        self.runner.restore(state.as_ref().unwrap_or(&self.start))?;
        for ((at, unworn), joint) in self.wearing.iter().zip(joints) {
            self.runner.set_worn(*at, joint.clearance - unworn, joint.profile.clone())?;
        }
        let turns = self.turns()?;
        *state = Some(self.runner.state());
        self.note(&turns);
        let of = |(at, _): &(usize, f64)| {
            ContactMeasure::mean(&turns.iter().map(|turn| &turn.joints[*at]).collect::<Vec<_>>())
        };
        Ok(self.wearing.iter().map(of).collect())
    }
}
