//! Living: the table, the mean path, the random lives. In: a plan. Out: what became of it, or why it stopped with
//! what there was.

use std::fmt::Display;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use linkwear_gamma::monte_carlo::{Ended, GammaDraw, Lives, MonteCarlo, Scale};
use linkwear_runtime::life::{
    CycleRecord, DEFAULT_POINTS, FailureEvent, IncrementModel, LifeError, LifeOutcome, LifeState,
    MeanIncrement, TableReport, WearSource, WearTable, run_life,
};
use linkwear_runtime::{RunError, System, TurnState};

use super::super::arguments::Coupling;
use super::super::arguments::Format;
use super::super::failure::Failure;
use super::folder::Folder;
use super::output::{cycle_entry, cycles_table};
use super::{Plan, failed};
use linkwear::progress::{Progress, stop_requested};

/// Lives for each of the four shifts that tell what uncertain parameters do to the mean. Shifts share their random
/// numbers, so few are enough; with the dynamics at every step each is dear.
const SHIFTED_BY_TABLE: u64 = 200;
const SHIFTED_BY_DYNAMICS: u64 = 4;

/// Runs with a fine scale that was made for it.
type Body<'b> = &'b mut dyn FnMut(&mut dyn WearSource<State = Option<TurnState>, Error = RunError>);
/// Makes a system for one more thread.
type Lend<'l> = &'l (dyn Fn() -> Option<Box<dyn System<f64>>> + Sync);

/// A life and what it was made from.
pub struct Lived<'p> {
    pub plan: &'p Plan<'p>,
    /// FailureEvent of the mean path.
    pub end: FailureEvent,
    pub cycles: Vec<CycleRecord>,
    /// Estimated error of the mean path by its wear steps [cycles].
    pub step_error: f64,
    pub warnings: Vec<String>,
    pub table: Option<TableReport>,
    pub measurements: u64,
    /// Random lives, in the order of their numbers.
    pub lives: Vec<FailureEvent>,
    /// Standard error of the mean of the random lives by the covariances of fits, if there are any [cycles].
    pub parameter_error: Option<f64>,
}

/// Why there is no whole answer, with the cycles of the mean path there were.
pub struct Stopped {
    failure: Box<Failure>,
    joints: Vec<String>,
    cycles: Vec<CycleRecord>,
}

impl Stopped {
    fn of(plan: &Plan<'_>, message: &str, cycles: &[CycleRecord]) -> Self {
        let failure = Box::new(failed(plan.arguments, message, ""));
        Self { failure, joints: plan.names(), cycles: cycles.to_vec() }
    }

    /// Keeps the cycles: in the folder, else on stdout with the error.
    pub fn keep(self, folder: Option<&Folder>, format: Format) -> Failure {
        let Failure::Life { file, message, .. } = *self.failure else { return *self.failure };
        let count = self.cycles.len();
        let mut help = match count {
            0 => String::new(),
            count => format!("{count} cycles were completed before"),
        };
        let mut cycles = Vec::new();
        match folder.map(|folder| folder.write_cycles(&self.joints, &self.cycles)) {
            Some(Ok(path)) if count > 0 => help.push_str(&format!("; they are in `{}`", path.display())),
            Some(Err(failure)) => return failure,
            Some(Ok(_)) => {}
            None => {
                cycles = self.cycles.iter().map(|cycle| cycle_entry(&self.joints, cycle)).collect();
                if format == Format::Text && count > 0 {
                    // A reader who has gone away cannot be told.
                    let _ = super::print(&cycles_table(&self.joints, &self.cycles));
                }
            }
        }
        Failure::Life { file, message, help, cycles }
    }
}

impl Plan<'_> {
    pub fn names(&self) -> Vec<String> {
        self.settings.joints.iter().map(|joint| joint.joint.clone()).collect()
    }
}

impl<'p> Lived<'p> {
    pub fn of(plan: &'p Plan<'p>, system: &dyn System<f64>, lend: Lend<'_>) -> Result<Self, Stopped> {
        let progress = Mutex::new(Progress::new());
        let lived = Self::with(plan, system, lend, &|part| {
            progress.lock().unwrap_or_else(PoisonError::into_inner).set(part);
        });
        progress.lock().unwrap_or_else(PoisonError::into_inner).finish();
        lived
    }

    fn with(
        plan: &'p Plan<'p>,
        system: &dyn System<f64>,
        lend: Lend<'_>,
        show: &(dyn Fn(f64) + Sync),
    ) -> Result<Self, Stopped> {
        let stopped = |message: &str| Stopped::of(plan, message, &[]);
        let mut fine = plan.fine(system).map_err(|error| stopped(&error.to_string()))?;
        let mut lived = match plan.coupling {
            Coupling::Table => {
                let table =
                    WearTable::measure(&plan.settings, &mut fine, DEFAULT_POINTS, &mut |part| show(part));
                let mut table = table.map_err(|stop| stopped(&stop.to_string()))?;
                let mut lived = Self::mean_path(plan, &mut table, &|_| {})?;
                lived.draw(
                    &|lend| {
                        lend(&mut table.clone());
                        Ok(())
                    },
                    show,
                )?;
                lived.measurements = table.report().measurements as u64;
                lived.table = Some(table.report().clone());
                lived
            }
            Coupling::Full => {
                let mut lived = Self::mean_path(plan, &mut fine, show)?;
                lived.draw(&|body| Self::dynamics(plan, lend, body), show)?;
                lived
            }
        };
        lived.warnings.splice(0..0, fine.warnings().iter().map(ToString::to_string));
        Ok(lived)
    }

    /// Revolutions of a system of its own.
    fn dynamics(plan: &Plan<'_>, lend: Lend<'_>, body: Body<'_>) -> Result<(), RunError> {
        // It could be made for the mean path: so it can again.
        let Some(system) = lend() else { return Err(RunError::Interrupted { t: 0.0 }) };
        body(&mut plan.fine(&*system)?);
        Ok(())
    }

    /// The life in which every increment is its mean.
    fn mean_path<F: WearSource>(plan: &'p Plan<'p>, fine: &mut F, show: &dyn Fn(f64)) -> Result<Self, Stopped>
    where
        F::Error: Display,
    {
        let state = LifeState::new(&plan.settings, 0);
        let mut state = state.map_err(|error| Stopped::of(plan, &error.to_string(), &[]))?;
        let mean = plan.process.as_ref().map(super::process::Process::mean);
        let draw: &dyn IncrementModel = mean.as_ref().map_or(&MeanIncrement, |mean| mean);
        let outcome = run_life(&plan.settings, fine, draw, &mut state, &mut |cycle| {
            show(cycle.used.min(1.0));
            go_on()
        });
        let end = match outcome {
            Ok(LifeOutcome::Failed(end)) => end,
            Ok(LifeOutcome::Cancelled) => return Err(Stopped::of(plan, "stopped on request", &state.cycles)),
            Ok(LifeOutcome::CycleLimit) => {
                let message = format!("no joint has failed after {} cycles", plan.settings.most_cycles);
                return Err(Stopped::of(plan, &message, &state.cycles));
            }
            Err(stop) => return Err(Stopped::of(plan, &stop.to_string(), &state.cycles)),
        };
        let names = plan.names();
        let warning = |known: &linkwear_runtime::life::JointWarning| {
            format!("{}, cycle {}: {}", names[known.joint], known.cycle, known.warning)
        };
        Ok(Self {
            plan,
            end,
            step_error: state.joints[end.joint].error,
            warnings: state
                .warnings
                .iter()
                .map(warning)
                .chain(plan.process.iter().flat_map(|process| process.warnings.clone()))
                .collect(),
            cycles: state.cycles,
            table: None,
            measurements: state.measurements,
            lives: Vec::new(),
            parameter_error: None,
        })
    }

    /// The random lives, and what uncertain parameters do to their mean.
    fn draw<S: Clone + Default, E: Send + Display>(
        &mut self,
        scale: Scale<'_, S, E>,
        show: &(dyn Fn(f64) + Sync),
    ) -> Result<(), Stopped> {
        let (Some(process), Some(count)) = (&self.plan.process, self.plan.trajectories) else {
            return Ok(());
        };
        self.lives = self.draw_by(scale, &process.draw(), count, show)?;
        let few = match self.plan.coupling {
            Coupling::Table => SHIFTED_BY_TABLE,
            Coupling::Full => SHIFTED_BY_DYNAMICS,
        };
        self.parameter_error = process.uncertainty(&mut |shifted| {
            let lives = self.draw_by(scale, shifted, count.min(few), &|_| {})?;
            Ok(lives.iter().map(|end| end.cycles).sum::<f64>() / lives.len() as f64)
        })?;
        Ok(())
    }

    /// Lives by these draws.
    fn draw_by<S: Clone + Default, E: Send + Display>(
        &self,
        scale: Scale<'_, S, E>,
        draw: &GammaDraw,
        count: u64,
        show: &(dyn Fn(f64) + Sync),
    ) -> Result<Vec<FailureEvent>, Stopped> {
        let plan = self.plan;
        let mut settings = plan.settings.clone();
        settings.keep_cycles = false;
        let run = MonteCarlo { settings: &settings, draw, trajectories: 0..count, threads: plan.threads };
        let Lives { failures, ended } = run.run(scale, &|done| {
            show(done as f64 / count as f64);
            go_on()
        });
        let done = failures.len();
        let message = match ended {
            Ended::Complete => return Ok(failures.into_iter().map(|(_, end)| end).collect()),
            Ended::Cancelled => format!("stopped on request after {done} of {count} lives"),
            Ended::Stopped { trajectory, stop: LifeError::Fine { .. } } if stop_requested() => {
                format!("stopped on request in life {trajectory}, after {done} of {count} lives")
            }
            Ended::Stopped { trajectory, stop } => format!("life {trajectory}: {stop}"),
            Ended::Survived { trajectory } => {
                format!("life {trajectory}: no joint has failed after {} cycles", settings.most_cycles)
            }
        };
        Err(Stopped::of(plan, &message, &self.cycles))
    }
}

fn go_on() -> ControlFlow<()> {
    if stop_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
