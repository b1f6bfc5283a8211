//! The fine scale of a life by the equations of motion themselves. In: a mechanism, how a revolution is run.
//! Out: what one settled revolution wears at a given state of wear. Never knows cycles, draws or thresholds.

use std::ops::ControlFlow;

use crate::description::Description;
use crate::dynamics::SINGULAR_PIVOT;
use crate::error::RunError;
use crate::life::{JointLife, JointWear, RevolutionWear, SettingsError, WearSource};
use crate::simulate::{Integrator, RunWarning, TurnMeasure, TurnMeasures, TurnRunner, TurnState};
use crate::system::System;
use crate::wear::{Observed, Profile};

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
pub struct DynamicsSource<'a> {
    runner: TurnRunner<'a>,
    description: &'a Description,
    start: TurnState,
    /// Indices of the wearing joints among those with clearance, with their clearance at the start [m].
    wearing: Vec<(usize, f64)>,
    settings: RevolutionSettings,
    stop: Option<&'a (dyn Fn() -> bool + Sync)>,
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
        Ok(Self { runner, description, start, wearing, settings, stop: None, warnings: Vec::new() })
    }

    /// Asked between steps; when it says yes, the measurement ends with [`RunError::Interrupted`].
    #[must_use]
    pub fn stopped_by(mut self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        self.stop = Some(stop);
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

    /// What was doubtful in the runs so far, the first of each kind.
    #[must_use]
    pub fn warnings(&self) -> &[RunWarning] {
        &self.warnings
    }

    /// Settles, then measures turn by turn.
    fn turns(&mut self) -> Result<Vec<TurnMeasures>, RunError> {
        let stop = self.stop;
        let mut go_on = |_: f64| {
            if stop.is_some_and(|stop| stop()) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        self.runner.settle(self.settings.settle, &mut go_on)?;
        (0..self.settings.average.max(1)).map(|_| self.runner.measure(&mut go_on)).collect()
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
    ) -> Result<Vec<RevolutionWear>, RunError> {
        self.runner.restore(state.as_ref().unwrap_or(&self.start))?;
        for ((at, unworn), joint) in self.wearing.iter().zip(joints) {
            self.runner.set_worn(*at, joint.clearance - unworn, joint.profile.clone())?;
        }
        let turns = self.turns()?;
        *state = Some(self.runner.state());
        self.note(&turns);
        let of =
            |(at, _): &(usize, f64)| mean(&turns.iter().map(|turn| &turn.joints[*at]).collect::<Vec<_>>());
        Ok(self.wearing.iter().map(of).collect())
    }
}

/// The mean of turns of one joint; extremes are those of all turns.
fn mean(turns: &[&TurnMeasure]) -> RevolutionWear {
    let count = turns.len() as f64;
    let mean = |of: fn(&TurnMeasure) -> f64| turns.iter().map(|turn| of(turn)).sum::<f64>() / count;
    RevolutionWear {
        wear_integral: mean(|turn| turn.wear_integral_J),
        depth: mean(|turn| turn.depth_m),
        profile: mean_profile(turns),
        mean_force: mean(|turn| turn.mean_normal_force_N),
        peak_force: turns.iter().map(|turn| turn.peak_normal_force_N).fold(0.0, f64::max),
        contact_losses: mean(|turn| turn.contact_losses as f64),
        separated: mean(|turn| 1.0 - turn.touching_part),
        observed: extremes(turns),
    }
}

fn mean_profile(turns: &[&TurnMeasure]) -> Option<Profile> {
    let (first, rest) = turns.split_first()?;
    let mut sum = first.deposit.clone()?;
    let mut add = |depths: &[f64], factor: f64| {
        let fits = sum.add_depths(depths, factor);
        debug_assert!(fits, "turns of one joint have profiles of one width");
    };
    for turn in rest {
        add(turn.deposit.as_ref().map_or(&[], |deposit| deposit.depths()), 1.0);
    }
    let count = turns.len() as f64;
    Profile::try_from(sum.depths().iter().map(|depth| depth / count).collect::<Vec<_>>()).ok()
}

fn extremes(turns: &[&TurnMeasure]) -> Observed {
    let seen = turns.iter().map(|turn| turn.observed.expect("a joint that wears is observed"));
    let larger = |a: Observed, b: Observed| Observed {
        pressure: a.pressure.max(b.pressure),
        pressure_speed: a.pressure_speed.max(b.pressure_speed),
        hertz_half_width: a.hertz_half_width.max(b.hertz_half_width),
        penetration: a.penetration.max(b.penetration),
        ..a
    };
    seen.reduce(larger).expect("at least one turn is measured")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(depth: f64, peak: f64) -> TurnMeasure {
        let mut observed = Observed::nothing(1e-5, 1e-2);
        observed.pressure = peak;
        TurnMeasure {
            turn: 1,
            joint: 0,
            wear_integral_J: 2.0 * depth,
            depth_m: depth,
            mean_normal_force_N: 1.0,
            peak_normal_force_N: peak,
            contact_losses: 3,
            touching_part: 1.0,
            loss_J: 0.0,
            deposit: Profile::try_from(vec![depth; 4]).ok(),
            observed: Some(observed),
        }
    }

    #[test]
    fn turns_give_their_mean_and_the_largest_of_their_extremes() {
        let wear = mean(&[&turn(1.0, 5.0), &turn(3.0, 4.0)]);
        assert_eq!((wear.depth, wear.wear_integral, wear.contact_losses), (2.0, 4.0, 3.0));
        assert_eq!((wear.peak_force, wear.observed.pressure), (5.0, 5.0));
        assert_eq!(wear.profile.expect("a profile").depths(), [2.0; 4]);
    }
}
