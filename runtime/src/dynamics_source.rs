//! The fine scale of a life by the equations of motion themselves. In: a mechanism, how a revolution is run.
//! Out: what one settled revolution wears at a given state of wear. Never knows cycles, draws or thresholds.

mod beginning;
mod leaving;
mod measuring;
mod recurrence;
mod returning;
mod settings;
mod settling;
mod side_by_side;
mod slow_states;
mod stability;
mod steadiness;
mod wearing;

use crate::bundle::Bundle;
use crate::description::Description;
use crate::dynamics::SINGULAR_PIVOT;
use crate::error::RunError;
use crate::life::{JointLife, JointWear, SettingsError, WearSource};
use crate::simulate::{
    LaneTurns, RunWarning, TurnMeasures, TurnQueue, TurnRunner, TurnState, WholeSteps, WideBundle,
};
use crate::system::System;
use crate::watch::Watch;
use crate::wear::ContactMeasure;
use beginning::{Beginning, Known};
use leaving::leaves;
use measuring::{Done, Measuring};
use recurrence::Recurrence;
use returning::Stand;
pub use settings::RevolutionSettings;
pub use settling::Orbit;
use settling::Settling;
use side_by_side::{Begun, SideBySide};
use slow_states::SlowStates;
pub use steadiness::Steadiness;
use wearing::Wearing;

/// Revolutions of one mechanism.
#[must_use]
pub struct DynamicsSource<'a> {
    system: &'a dyn System<f64>,
    runner: TurnRunner<'a>,
    start: TurnState,
    wearing: Wearing<'a>,
    settings: RevolutionSettings,
    /// After how many turns drives and forces repeat, once that was asked: so many are measured as one.
    recurrence: Option<Recurrence>,
    slow: SlowStates,
    /// Where turns are run, if not by the runner: elsewhere, or in whole steps.
    queue: Option<TurnQueue>,
    whole: Option<WholeSteps<'a>>,
    /// Where turns of several measurements are run, and its lanes once they are used.
    bundle: Option<WideBundle<'a>>,
    lanes: Option<Box<dyn LaneTurns<'a> + 'a>>,
    watch: Watch<'a>,
    warnings: Vec<RunWarning>,
    /// Of the last measurement, or of the last ones that were made together.
    steadiness: Vec<Vec<Steadiness>>,
    /// The first measurements of a life that begins with unworn joints.
    beginning: Beginning,
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
        let wearing = Wearing::new(description, &runner.clearances());
        let start = runner.state();
        let slow = SlowStates::new(&runner);
        let (warnings, steadiness, beginning) = (Vec::new(), Vec::new(), Beginning::default());
        Ok(Self {
            system,
            runner,
            start,
            wearing,
            settings,
            recurrence: None,
            slow,
            queue: None,
            whole: None,
            bundle: None,
            lanes: None,
            watch: Watch::NONE,
            warnings,
            steadiness,
            beginning,
        })
    }

    /// How long a revolution lasts [s]; nothing where the first three last differently.
    ///
    /// # Errors
    /// [`RunError::TurnsNotReached`] if there are none.
    pub fn seconds_per_revolution(&mut self) -> Result<Option<f64>, RunError> {
        self.runner.seconds_per_turn()
    }

    /// After how many turns drives and forces repeat: so many are measured as one.
    ///
    /// # Errors
    /// [`RunError::NeverAlike`] if they do not.
    pub fn turns_to_repeat(&mut self) -> Result<u32, RunError> {
        Ok(self.recurrence()?.every)
    }

    /// How steady the turns of the last measurement were, per wearing joint.
    pub fn steadiness(&self) -> &[Steadiness] {
        self.steadiness.last().map_or(&[], Vec::as_slice)
    }

    /// The same of each of the last measurements, where they were made together.
    pub fn steadiness_of_each(&self) -> &[Vec<Steadiness>] {
        &self.steadiness
    }

    /// Has its turns run in whole steps of machine code of the same mechanism, in the same bits.
    pub fn in_whole_steps(self, bundle: &'a dyn Bundle<1>) -> Self {
        Self { whole: Some(WholeSteps::new(bundle, &self.runner)), ..self }
    }

    /// Has the turns of measurements that are asked for together run side by side, in the same bits: in a bundle of the same mechanism.
    pub fn side_by_side(self, bundle: WideBundle<'a>) -> Self {
        Self { bundle: Some(bundle), ..self }
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
        self.wearing.lives()
    }

    /// The wearing joints as they are at the start.
    pub fn unworn(&self) -> Vec<JointWear> {
        self.wearing.unworn()
    }

    /// Goes on after measurements of another source, which doubted this: it is not told again.
    pub fn known(&mut self, warnings: &[RunWarning]) {
        self.warnings = warnings.to_vec();
    }

    /// What was doubtful in the runs so far, the first of each kind.
    pub fn warnings(&self) -> &[RunWarning] {
        &self.warnings
    }

    /// Sets the joints, to go on from an orbit or to begin.
    fn begin(&mut self, joints: &[JointWear], from: Option<&Orbit>) -> Result<Measuring, RunError> {
        let recurrence = self.recurrence()?;
        self.runner.restore(from.map_or(&self.start, |orbit| &orbit.turn))?;
        self.slow.forget();
        let (mut far, mut is_new) = (1.0_f64, false);
        for ((at, unworn), joint) in self.wearing.joints.iter().zip(joints) {
            let surfaces = [joint.profile.clone(), joint.journal.clone()];
            let worn = joint.clearance - unworn;
            self.runner.set_worn_pair(*at, worn, surfaces)?;
            let known = from.and_then(|orbit| orbit.turn.joints.get(*at));
            is_new |= known.is_some_and(|known| {
                known.worn != worn || known.profile != joint.profile || known.journal != joint.journal
            });
            let before = known.map_or(0.0, |joint| joint.worn);
            let ratio = (unworn + worn) / (unworn + before);
            far = far.max(ratio).max(1.0 / ratio);
        }
        // A swing that lasts has nothing to get over where no surface is another.
        let lasting = |orbit: &Orbit| if is_new { recurrence.every * orbit.lasting } else { 0 };
        for _ in 0..from.map_or(recurrence.after, lasting) {
            self.one_turn((0.0, 0.0))?;
        }
        if from.is_none() && recurrence.after > 0 {
            self.runner.rest_journals();
        }
        let settling = Settling::new(from, far, self.settings.settled());
        let begins = (Stand::of(&mut self.runner), self.wearing.rooms(joints));
        Ok(Measuring::new(&self.settings, settling, begins, recurrence.every))
    }

    /// After how many turns drives and forces repeat; who says how turns are to be measured is not asked.
    fn recurrence(&mut self) -> Result<Recurrence, RunError> {
        let is_told = self.settings.settle.is_some() || self.settings.average > 1;
        let known = match self.recurrence {
            Some(known) => known,
            None if is_told => Recurrence::EACH,
            None => {
                self.runner.restore(&self.start)?;
                Recurrence::of(&mut self.runner)?
            }
        };
        self.recurrence = Some(known);
        Ok(known)
    }

    /// Runs so many turns as one, as a part of a measurement, as drives and forces need to repeat.
    fn turn(&mut self, (from, to): (f64, f64)) -> Result<TurnMeasures, RunError> {
        let every = self.recurrence()?.every;
        if every == 1 {
            return self.one_turn((from, to));
        }
        let part = |turn: u32| from + (to - from) * f64::from(turn) / f64::from(every);
        let turns = (0..every).map(|turn| self.one_turn((part(turn), part(turn + 1))));
        Ok(TurnMeasures::mean(turns.collect::<Result<_, _>>()?))
    }

    /// Runs one turn.
    fn one_turn(&mut self, (from, to): (f64, f64)) -> Result<TurnMeasures, RunError> {
        let watch = self.watch.piece(from, to);
        match (&self.queue, &mut self.whole) {
            (Some(queue), _) => queue.measure(&mut self.runner, watch),
            (None, Some(whole)) => whole.measure(&mut self.runner, watch),
            (None, None) => self.runner.measure(watch),
        }
    }

    /// The lanes, if there are any.
    fn take_lanes(&mut self) -> Result<Option<Box<dyn LaneTurns<'a> + 'a>>, RunError> {
        // Lanes run a turn after the other, which all count.
        if !self.slow.is_empty() || self.recurrence()?.every > 1 {
            return Ok(None);
        }
        if let (None, Some(bundle)) = (&self.lanes, self.bundle) {
            let (system, description) = (self.system, self.wearing.description);
            let integrator = self.settings.integrator;
            let parameters = self.runner.parameters();
            let runner = || TurnRunner::new(system, description, parameters, integrator, SINGULAR_PIVOT);
            self.lanes = Some(bundle.turns(&runner)?);
        }
        Ok(self.lanes.take())
    }

    /// Runs all turns of one measurement, from where it has begun.
    fn one_after_the_other(&mut self, one: &mut Begun) -> Result<(), RunError> {
        self.runner.restore(&one.at)?;
        self.all_turns(&mut one.measuring)?;
        one.at = self.runner.state();
        Ok(())
    }

    /// Runs turns until a measurement is done.
    fn all_turns(&mut self, measuring: &mut Measuring) -> Result<(), RunError> {
        loop {
            self.slow.begin(&self.runner);
            let turn = self.turn(measuring.next())?;
            let waits = self.settings.settle.is_none() && !self.slow.is_empty();
            if waits && !self.slow.have_settled(&mut self.runner, self.settings.settled())? {
                measuring.pass(Stand::of(&mut self.runner));
                continue;
            }
            let is_done = measuring.take(turn, Stand::of(&mut self.runner), &self.wearing);
            let is_open = is_done && measuring.shows_nothing(&self.wearing);
            if is_done && !(is_open && leaves(&mut self.runner, measuring, self.watch)?) {
                return Ok(());
            }
        }
    }

    /// What a measurement has come to; its state is where the next one goes on.
    fn end(&mut self, done: Done, state: &mut Option<Orbit>) -> Vec<ContactMeasure> {
        *state = Some(done.orbit);
        self.note(done.doubts.iter().chain(done.turns.iter().flat_map(|turn| &turn.warnings)));
        self.steadiness.push(done.steadiness);
        done.measured
    }

    fn note<'w>(&mut self, warnings: impl Iterator<Item = &'w RunWarning>) {
        for warning in warnings {
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
        if let Some(known) = self.beginning.find(joints, state.as_ref()) {
            state.clone_from(&known.state);
            self.steadiness.clone_from(&known.steadiness);
            return Ok(known.measured.clone());
        }
        let from = state.clone();
        let mut measuring = self.begin(joints, from.as_ref())?;
        self.all_turns(&mut measuring)?;
        self.steadiness.clear();
        let done = measuring.end(self.runner.state(), &self.wearing);
        let measured = self.end(done, state);
        if self.beginning.wants(from.as_ref()) {
            let (joints, steadiness) = (joints.to_vec(), self.steadiness.clone());
            let (measured, state) = (measured.clone(), state.clone());
            self.beginning.keep(Known { joints, from, measured, steadiness, state });
        }
        Ok(measured)
    }

    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [Self::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, RunError> {
        let mut begun = Vec::with_capacity(joints.len());
        for (joints, state) in joints.iter().zip(&*states) {
            let measuring = self.begin(joints, state.as_ref())?;
            begun.push(Begun { measuring, at: self.runner.state(), looked_at: None });
        }
        match self.take_lanes()? {
            Some(mut lanes) => {
                let Self { runner, wearing, watch, .. } = self;
                let done = SideBySide { runner, wearing, watch: *watch }.run(&mut *lanes, &mut begun);
                self.lanes = Some(lanes);
                done?;
            }
            None => begun.iter_mut().try_for_each(|one| self.one_after_the_other(one))?,
        }
        self.steadiness.clear();
        let each = begun.into_iter().zip(states);
        Ok(each.map(|(one, state)| self.end(one.measuring.end(one.at, &self.wearing), state)).collect())
    }
}
