//! Living: the table, the mean path, the random lives. In: a study. Out: what became of it, or why it stopped with the
//! cycles there were.

use std::convert::Infallible;
use std::error::Error as StdError;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread::available_parallelism;

use linkwear_codegen::limits;
use linkwear_runtime::life::{
    CycleRecord, DEFAULT_POINTS, IncrementModel, JointLife, LifeError as Stop, LifeOutcome, LifeSettings,
    LifeState, MeanIncrement, MissionError, MissionSource, WearSource, WearStep, WearTable, run_life,
};
use linkwear_runtime::{DynamicsSource, Orbit, RunError, System, Watch};

use super::bins;
use super::error::{Cause, LifeError};
use super::journal::LifeJournal;
use super::mission::Duty;
use super::mission_result::MissionResult;
use super::pace::Pace;
use super::process::Process;
use super::result::{LifeResult, WornPair};
use super::source::{KeptSource, Log};
use super::steady::TurnErrors;
use super::study::{Coupling, LifeStudy};

/// Runs with a source of wear that was made for it.
pub(super) type Body<'b, E = MissionError<RunError>, S = Vec<Option<Orbit>>> =
    &'b mut dyn FnMut(&mut dyn WearSource<State = S, Error = E>);

impl LifeStudy<'_> {
    /// Lives.
    ///
    /// # Errors
    /// With the cycles that were completed, if the mechanism cannot live or one of its lives does not end.
    pub fn run(&self) -> Result<LifeResult, LifeError> {
        self.run_watched(Watch::NONE)
    }

    /// As [`Self::run`]. `watch` hears the finished part of the table, the mean path and the random lives, one after the
    /// other, and may stop them.
    ///
    /// # Errors
    /// As [`Self::run`], and [`Cause::Interrupted`].
    pub fn run_watched(&self, watch: Watch<'_>) -> Result<LifeResult, LifeError> {
        self.run_with(None, watch)
    }

    /// As [`Self::run_watched`], going on from what a journal has, with the same bits as a run that was never
    /// interrupted. The journal keeps every measurement and every random life as soon as it is finished. More
    /// random lives than those of the run before go on from it; everything else that decides numbers must be the same.
    ///
    /// # Errors
    /// As [`Self::run_watched`], and [`Cause::Journal`].
    pub fn run_kept(&self, journal: &LifeJournal, watch: Watch<'_>) -> Result<LifeResult, LifeError> {
        let result = self.run_with(Some(journal), watch);
        match (journal.failure(), result) {
            (Some(error), Err(stopped)) => Err(LifeError { cause: Box::new(error.into()), ..stopped }),
            (Some(error), Ok(_)) => Err(Cause::from(error).into()),
            (None, result) => result,
        }
    }

    fn run_with(&self, journal: Option<&LifeJournal>, watch: Watch<'_>) -> Result<LifeResult, LifeError> {
        let may_go_on = |flow: ControlFlow<()>| {
            if journal.is_some_and(LifeJournal::has_failed) { ControlFlow::Break(()) } else { flow }
        };
        let [last, next] = [0.0_f64, FIRST].map(|part| AtomicU64::new(part.to_bits()));
        let tell = |part: f64| {
            let before = f64::from_bits(last.swap(part.to_bits(), Ordering::Relaxed));
            next.store((2.0 * part - before).clamp(part, 1.0).to_bits(), Ordering::Relaxed);
            may_go_on(watch.report(part))
        };
        // Within a revolution a part of what the next report will probably add.
        let ask = |part: f64| {
            let [last, next] = [&last, &next].map(|part| f64::from_bits(part.load(Ordering::Relaxed)));
            may_go_on(watch.report(last + part * (next - last)))
        };
        let begin = |stage| watch.begin(stage);
        let (told, between) = (Watch::new(&tell).with_stages(&begin), Watch::new(&ask));
        self.wears()?;
        let system = self.mechanism.system();
        let duty = Duty::new(self, &*system)?;
        let code = self.machine_code();
        let sources = code.run(duty.sources(&*system, self.revolutions, between)?);
        let mut plan = Plan::new(self, &duty, joints(&sources)?, journal, (told, between))?;
        if let Some(journal) = journal {
            journal.begin(self.identity(plan.coupling)).map_err(Cause::from)?;
        }
        let log = Log::new(journal);
        let mut source = KeptSource::new(&duty, sources, &log);
        let mut result = match plan.coupling {
            Coupling::Table => plan.by_table(&mut source),
            Coupling::Full => plan.by_dynamics(&mut source),
        }?;
        self.judge_binning((&mut result, &duty), &*system, &log, (journal, told, between))?;
        result.turn_errors = source.turn_errors(result.end.joint);
        result.warnings.splice(0..0, source.warnings());
        result.warnings.splice(0..0, self.set_in_vain());
        Ok(result)
    }

    /// Whether there is anything to live.
    pub(super) fn wears(&self) -> Result<(), Cause> {
        let mut contacts = self.mechanism.description.contacts.iter();
        if contacts.any(|contact| contact.wear.is_some()) { Ok(()) } else { Err(Cause::NoWear) }
    }
}

/// The wearing joints, as they are in the first of these sources.
pub(super) fn joints(sources: &[DynamicsSource<'_>]) -> Result<Vec<JointLife>, Cause> {
    Ok(sources.first().map_or(Ok(Vec::new()), DynamicsSource::joints)?)
}

/// What the first report is taken to tell: that of a table. A life by the dynamics is asked after more work than that.
const FIRST: f64 = 1.0 / DEFAULT_POINTS as f64;

/// Missions of a life below which the order of segments within one is told to matter: it changes less than one of them.
const FEW_MISSIONS: f64 = 20.0;

/// What to live, and how.
pub(super) struct Plan<'s> {
    pub(super) study: &'s LifeStudy<'s>,
    duty: &'s Duty,
    pub settings: LifeSettings,
    pub coupling: Coupling,
    pub(super) process: Option<Process>,
    pub(super) journal: Option<&'s LifeJournal>,
    /// Random lives; none for the mean path alone.
    pub trajectories: Option<u64>,
    pub threads: NonZero<usize>,
    /// Those of them that the system did not give.
    pub(super) missing_threads: AtomicUsize,
    pub(super) watch: Watch<'s>,
    /// For work between two reports.
    pub(super) between: Watch<'s>,
}

impl<'s> Plan<'s> {
    pub fn new(
        study: &'s LifeStudy<'s>,
        duty: &'s Duty,
        joints: Vec<JointLife>,
        journal: Option<&'s LifeJournal>,
        (watch, between): (Watch<'s>, Watch<'s>),
    ) -> Result<Self, Cause> {
        let mut settings = LifeSettings::new(joints);
        if !study.feedback {
            settings = settings.without_feedback();
        }
        let coupling = study.coupling();
        settings.step = match coupling {
            Coupling::Table => WearStep::TABLE,
            Coupling::Full => WearStep::FULL,
        };
        let process = Process::new(study, &study.mechanism.description)?;
        let trajectories = process.as_ref().and_then(|_| study.trajectories.count(coupling));
        if trajectories.is_none() && study.shared_factor.is_some() {
            return Err(Cause::NoRandomLives);
        }
        if trajectories.is_none() && study.shard.is_some() {
            return Err(Cause::NothingToShare);
        }
        let threads = study.threads.or_else(|| available_parallelism().ok()).unwrap_or(NonZero::<usize>::MIN);
        let threads = threads.min(NonZero::new(limits::THREADS.most).unwrap_or(threads));
        Ok(Self {
            study,
            duty,
            settings,
            coupling,
            process,
            journal,
            trajectories,
            threads,
            missing_threads: AtomicUsize::new(0),
            watch,
            between,
        })
    }

    fn by_table(&mut self, source: &mut KeptSource<'_>) -> Result<LifeResult, LifeError> {
        self.watch.begin("table");
        let mut table = self.table(source)?;
        let mut result = self.mean_path(&mut table, self.between)?;
        result.measurements = table.report().measurements as u64;
        result.table = Some(table.report().clone());
        self.know_process(&mut result);
        self.know_mission(&mut result, source)?;
        let scale = |body: Body<'_, Infallible, ()>| {
            body(&mut table.clone());
            Ok(())
        };
        self.draw(&mut result, &scale, self.threads)?;
        Ok(result)
    }

    fn table(&self, source: &mut KeptSource<'_>) -> Result<WearTable, LifeError> {
        let measured = WearTable::measure(&self.settings, source, DEFAULT_POINTS, self.watch);
        measured.map_err(|error| self.error(self.cause(error, None), &[]))
    }

    fn by_dynamics(&mut self, source: &mut KeptSource<'_>) -> Result<LifeResult, LifeError> {
        self.watch.begin("mean path");
        let mut result = self.mean_path(source, self.watch)?;
        self.know_process(&mut result);
        self.know_mission(&mut result, source)?;
        match self.lanes() {
            Some(lanes) => self.draw_in_lanes(&mut result, &lanes)?,
            None => {
                let scale = |body: Body<'_>| {
                    let system = self.study.mechanism.system();
                    body(&mut self.source(&*system, &|source| source)?);
                    Ok(())
                };
                self.draw(&mut result, &scale, self.threads)?;
            }
        }
        Ok(result)
    }

    /// Revolutions of all segments by a system, for a random life.
    pub(super) fn source<'r>(
        &'r self,
        system: &'r dyn System<f64>,
        by: &dyn Fn(DynamicsSource<'r>) -> DynamicsSource<'r>,
    ) -> Result<MissionSource<DynamicsSource<'r>>, MissionError<RunError>> {
        let sources = self.duty.sources(system, self.study.revolutions, self.between)?;
        Ok(self.duty.compose(sources.into_iter().map(by).collect()))
    }

    /// What the mission has made of the mean path.
    fn know_mission(&self, result: &mut LifeResult, source: &KeptSource<'_>) -> Result<(), LifeError> {
        result.seconds_per_revolution = self.duty.seconds_per_revolution();
        result.mission = MissionResult::new(self.duty, &self.settings, result, source.measured());
        let Some(missions) = result.missions() else { return Ok(()) };
        if missions < 1.0 {
            return Err(self.error(Cause::MissionOutlastsLife { missions }, &result.cycles));
        }
        if missions < FEW_MISSIONS && self.duty.setups.len() > 1 {
            result.warnings.push(format!(
                "the mean path has {missions:.1} missions: their segments count by their shares, and the order within a mission can \
                 change the life by up to one mission, {:.1} % of it",
                100.0 / missions
            ));
        }
        Ok(())
    }

    /// Length of the mean path alone [cycles].
    pub(super) fn mean_end(&self, source: &mut KeptSource<'_>) -> Result<f64, LifeError> {
        let path = match self.coupling {
            Coupling::Table => self.mean_path(&mut self.table(source)?, self.between),
            Coupling::Full => self.mean_path(source, self.watch),
        };
        path.map(|path| path.end.cycles)
    }

    /// Once the mean path has told what the first cycle wears.
    fn know_process(&mut self, result: &mut LifeResult) {
        if let Some(process) = &mut self.process {
            process.know(&result.cycles);
            result.process = Some(process.joints.clone());
        }
    }

    /// The life in which every increment is its mean.
    fn mean_path<S: WearSource>(&self, source: &mut S, watch: Watch<'_>) -> Result<LifeResult, LifeError>
    where
        S::Error: StdError + Send + Sync + 'static,
    {
        let state = LifeState::new(&self.settings, 0);
        let mut state = state.map_err(|error| self.error(error.into(), &[]))?;
        let mean = self.process.as_ref().map(Process::mean);
        let increments: &dyn IncrementModel = mean.as_ref().map_or(&MeanIncrement, |mean| mean);
        let outcome = run_life(&self.settings, source, increments, &mut state, watch);
        let end = match outcome {
            Ok(LifeOutcome::Failed(end)) => Ok(end),
            Ok(LifeOutcome::Cancelled) => Err(Cause::Interrupted { trajectory: None, lives: None }),
            Ok(LifeOutcome::CycleLimit) => {
                let wears = state.joints.iter().map(|joint| joint.wear / state.cycle as f64);
                let pace = Pace::of(&self.settings.joints, wears);
                Err(Cause::CycleLimit { trajectory: None, cycles: state.cycle, pace })
            }
            Err(error) => Err(self.cause(error, None)),
        };
        let end = end.map_err(|cause| self.error(cause, &state.cycles))?;
        let name = |joint: usize| &self.settings.joints[joint].joint;
        let warnings = state.warnings.iter();
        let known =
            warnings.map(|known| format!("{}, cycle {}: {}", name(known.joint), known.cycle, known.warning));
        let coarse = self.settings.joints.iter().zip(&state.joints).filter_map(bins::too_coarse);
        let warnings = known.chain(coarse).collect();
        let by_fit = |process: &Process| process.uncertainty_of_mean_path(end.joint, end.cycles);
        let joints = self.settings.joints.iter().zip(&state.joints);
        let worn = joints.filter_map(|(joint, state)| {
            let (joint, bush) = (joint.joint.clone(), state.profile.clone());
            Some(WornPair { joint, bush, journal: state.journal.clone()? })
        });
        let worn = worn.collect();
        Ok(LifeResult {
            joints: self.settings.joints.clone(),
            coupling: self.coupling,
            end,
            step_error: state.joints[end.joint].error,
            cycles: state.cycles,
            lives: Vec::new(),
            counted: None,
            paths: None,
            process: self.process.as_ref().map(|process| process.joints.clone()),
            table: None,
            measurements: state.measurements,
            warnings,
            thread_note: None,
            parameter_error: self.process.as_ref().and_then(by_fit),
            turn_errors: TurnErrors { settling: None, averaging: None },
            seconds_per_revolution: None,
            worn,
            mission: None,
        })
    }

    pub(super) fn error(&self, cause: Cause, cycles: &[CycleRecord]) -> LifeError {
        let joints = self.settings.joints.iter().map(|joint| joint.joint.clone()).collect();
        LifeError { cause: Box::new(cause), joints, cycles: cycles.to_vec(), lives: Vec::new() }
    }

    /// Whatever a fine scale says that was asked to stop, it was stopped.
    pub(super) fn cause<E: StdError + Send + Sync + 'static>(
        &self,
        error: Stop<E>,
        trajectory: Option<u64>,
    ) -> Cause {
        let is_stopped = matches!(error, Stop::Fine { .. }) && self.between.report(0.0).is_break();
        if is_stopped || matches!(error, Stop::Interrupted) {
            return Cause::Interrupted { trajectory, lives: None };
        }
        Cause::Wear { trajectory, error: Box::new(error) }
    }
}
