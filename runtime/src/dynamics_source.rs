//! The fine scale of a life by the equations of motion themselves. In: a mechanism, how a revolution is run.
//! Out: what one settled revolution wears at a given state of wear. Never knows cycles, draws or thresholds.

mod settling;
mod steadiness;

use crate::bundle::Bundle;
use crate::description::Description;
use crate::dynamics::SINGULAR_PIVOT;
use crate::error::RunError;
use crate::life::{JointLife, JointWear, SettingsError, WearOf, WearSource};
use crate::linear::largest_of;
use crate::simulate::{Integrator, RunWarning, TurnMeasures, TurnQueue, TurnRunner, TurnState, WholeSteps};
use crate::system::System;
use crate::watch::Watch;
use crate::wear::ContactMeasure;
pub use settling::Orbit;
use settling::Settling;
pub use steadiness::Steadiness;

/// How revolutions are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevolutionSettings {
    /// The method.
    pub integrator: Integrator,
    /// Turns after each change of wear before one is measured. Nothing: until later turns would wear alike.
    pub settle: Option<u32>,
    /// Turns whose mean is taken, at least 1. One is enough for a periodic motion; one that chatters needs 20 or more.
    pub average: u32,
}

impl Default for RevolutionSettings {
    /// Adaptive Runge-Kutta, until later turns would wear alike.
    ///
    /// The wear of a revolution is off by 1e-6 to 1e-5 of itself then in the case study, the more the looser the joint has
    /// become; its life by 3e-6 of itself.
    fn default() -> Self {
        Self { integrator: Integrator::Rk43 { tolerance: 1e-6, max_step: None }, settle: None, average: 1 }
    }
}

/// A motion that has not settled after so many turns is taken as one that never does, ...
const MOST_TO_SETTLE: u32 = 4;
/// ... and the mean of so many is taken that its standard error is this part of it: many measurements of a life average out what
/// is left, and the budget tells it; ...
const SCATTERED: f64 = 1e-3;
/// ... or of so many turns.
const MOST_TO_AVERAGE: usize = 20;

/// Revolutions of one mechanism.
#[must_use]
pub struct DynamicsSource<'a> {
    runner: TurnRunner<'a>,
    description: &'a Description,
    start: TurnState,
    /// Indices of the wearing joints among those with clearance, with their clearance at the start [m].
    wearing: Vec<(usize, f64)>,
    settings: RevolutionSettings,
    /// Where turns are run, if not by the runner: elsewhere, or in whole steps.
    queue: Option<TurnQueue>,
    whole: Option<WholeSteps<'a>>,
    watch: Watch<'a>,
    warnings: Vec<RunWarning>,
    steadiness: Vec<Steadiness>,
    /// The first measurements of a life that begins with unworn joints.
    beginning: Vec<Known>,
}

/// A measurement that will be asked for again: every life begins with the same.
struct Known {
    joints: Vec<JointWear>,
    from: Option<Orbit>,
    measured: Vec<ContactMeasure>,
    steadiness: Vec<Steadiness>,
    state: Option<Orbit>,
}

/// So many are kept: those of a first cycle, in steps as long as it.
const MOST_KNOWN: usize = 4;

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
        let (warnings, steadiness) = (Vec::new(), Vec::new());
        let (queue, whole, watch) = (None, None, Watch::NONE);
        Ok(Self {
            runner,
            description,
            start,
            wearing,
            settings,
            queue,
            whole,
            watch,
            warnings,
            steadiness,
            beginning: Vec::new(),
        })
    }

    /// How long a revolution lasts [s]; nothing where the first three last differently.
    pub fn seconds_per_revolution(&mut self) -> Option<f64> {
        self.runner.seconds_per_turn()
    }

    /// How steady the turns of the last measurement were, per wearing joint.
    pub fn steadiness(&self) -> &[Steadiness] {
        &self.steadiness
    }

    /// Has its turns run in whole steps of machine code of the same mechanism, in the same bits.
    pub fn in_whole_steps(self, bundle: &'a dyn Bundle<1>) -> Self {
        Self { whole: Some(WholeSteps::new(bundle, &self.runner)), ..self }
    }

    /// Has its turns run side by side with those of others, in the same bits: the queue is that of a bundle of the same mechanism.
    pub fn through(self, queue: TurnQueue) -> Self {
        Self { queue: Some(queue), ..self }
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
            JointLife::of_joint(self.description, *at, *clearance).transpose()
        };
        self.wearing.iter().filter_map(of).collect()
    }

    /// The wearing joints as they are at the start.
    pub fn unworn(&self) -> Vec<JointWear> {
        let joint = |(_, clearance): &(usize, f64)| JointWear {
            clearance: *clearance,
            wear: 0.0,
            profile: None,
            journal: None,
        };
        self.wearing.iter().map(joint).collect()
    }

    /// Goes on after measurements of another source, which doubted this: it is not told again.
    pub fn known(&mut self, warnings: &[RunWarning]) {
        self.warnings = warnings.to_vec();
    }

    /// What was doubtful in the runs so far, the first of each kind.
    pub fn warnings(&self) -> &[RunWarning] {
        &self.warnings
    }

    /// Settles, then measures turn by turn; the last that settled comes first, if there is one.
    fn turns(
        &mut self,
        settling: &mut Settling,
    ) -> Result<(Option<TurnMeasures>, Vec<TurnMeasures>), RunError> {
        let average = self.settings.average.max(1);
        let Some(settle) = self.settings.settle else { return self.turns_alike(average, settling) };
        let part = f64::from(settle) / f64::from(settle + average);
        let settled = self.run(settle, (0.0, part))?.pop();
        Ok((settled, self.run(average, (part, 1.0))?))
    }

    /// The same until a turn wears as later ones would: it is the first that is measured.
    fn turns_alike(
        &mut self,
        average: u32,
        settling: &mut Settling,
    ) -> Result<(Option<TurnMeasures>, Vec<TurnMeasures>), RunError> {
        // Nobody knows how many there will be: every turn is half of what is left.
        let mut done = 0.5;
        let mut last = self.run(1, (0.0, done))?.pop();
        for _ in 1..MOST_TO_SETTLE {
            let next = 0.5 * (1.0 + done);
            let mut turns = self.run(1, (done, next))?;
            done = next;
            let differs = last.iter().zip(&turns).map(|(last, now)| self.differs(last, now));
            if settling.has_settled(differs) {
                turns.extend(self.run(average - 1, (done, 1.0))?);
                return Ok((last, turns));
            }
            last = turns.pop();
        }
        let mut turns = self.run(average, (done, 0.5 * (1.0 + done)))?;
        while turns.len() < MOST_TO_AVERAGE && !self.is_mean_known(&turns) {
            done = 0.5 * (1.0 + done);
            turns.extend(self.run(1, (done, 0.5 * (1.0 + done)))?);
        }
        Ok((last, turns))
    }

    /// Whether the wear of all joints scatters little in the mean of these turns.
    fn is_mean_known(&self, turns: &[TurnMeasures]) -> bool {
        self.wearing.iter().all(|(at, _)| {
            let wears: Vec<f64> = turns.iter().map(|turn| self.wear(*at, turn)).collect();
            Steadiness::of(None, &wears).scatter.is_some_and(|scatter| scatter <= SCATTERED)
        })
    }

    /// Runs turns, from one part of a measurement to another.
    fn run(&mut self, turns: u32, (from, to): (f64, f64)) -> Result<Vec<TurnMeasures>, RunError> {
        let one = |watch| match (&self.queue, &mut self.whole) {
            (Some(queue), _) => queue.measure(&mut self.runner, watch),
            (None, Some(whole)) => whole.measure(&mut self.runner, watch),
            (None, None) => self.runner.measure(watch),
        };
        self.watch.piece(from, to).pieces(turns).map(one).collect()
    }

    /// By how much of its wear a turn differs from the one before, of the joint where that is most.
    fn differs(&self, last: &TurnMeasures, now: &TurnMeasures) -> f64 {
        let part = |(at, _): &(usize, f64)| {
            let (last, now) = (self.wear(*at, last), self.wear(*at, now));
            // What does not wear at all is settled.
            if now == last { 0.0 } else { ((now - last) / now).abs() }
        };
        largest_of(self.wearing.iter().map(part))
    }

    /// W per turn [m] of a wearing joint.
    fn wear(&self, at: usize, turn: &TurnMeasures) -> f64 {
        let wear = self.description.contacts[at].wear.as_ref();
        wear.map_or(0.0, |wear| WearOf::described(wear).of(&turn.joints[at]))
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
    type State = Option<Orbit>;
    type Error = RunError;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, RunError> {
        let is_known = |known: &&Known| known.from == *state && known.joints == joints;
        if let Some(known) = self.beginning.iter().find(is_known) {
            state.clone_from(&known.state);
            self.steadiness.clone_from(&known.steadiness);
            return Ok(known.measured.clone());
        }
        let from = state.clone();
        self.runner.restore(from.as_ref().map_or(&self.start, |orbit| &orbit.turn))?;
        let mut settling = Settling::new(from.as_ref());
        for ((at, unworn), joint) in self.wearing.iter().zip(joints) {
            let surfaces = [joint.profile.clone(), joint.journal.clone()];
            self.runner.set_worn_pair(*at, joint.clearance - unworn, surfaces)?;
        }
        let (settled, turns) = self.turns(&mut settling)?;
        *state = Some(Orbit { turn: self.runner.state(), contraction: settling.contraction() });
        self.note(&turns);
        let steady = |(at, _): &(usize, f64)| {
            let wears: Vec<f64> = turns.iter().map(|turn| self.wear(*at, turn)).collect();
            Steadiness::of(settled.as_ref().map(|turn| self.wear(*at, turn)), &wears)
        };
        self.steadiness = self.wearing.iter().map(steady).collect();
        let of = |(at, _): &(usize, f64)| {
            ContactMeasure::mean(&turns.iter().map(|turn| &turn.joints[*at]).collect::<Vec<_>>())
        };
        let measured: Vec<_> = self.wearing.iter().map(of).collect();
        let begins = from.is_none() || self.beginning.iter().any(|known| known.state == from);
        if begins && self.beginning.len() < MOST_KNOWN {
            let (joints, steadiness) = (joints.to_vec(), self.steadiness.clone());
            let (measured, state) = (measured.clone(), state.clone());
            self.beginning.push(Known { joints, from, measured, steadiness, state });
        }
        Ok(measured)
    }
}
