//! Running the points. In: a study. Out: its rows, or that it was stopped. Never knows what is done with them.

use std::any::Any;
use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, available_parallelism};

use linkwear_codegen::limits::THREADS;
use linkwear_runtime::{Run, RunError, SampledSignals, Settings, Watch, simulate, simulate_with_inputs};
use serde_json::{Map, Value, json};

use super::cases::{Cases, Last};
use super::error::{StudyError, check_signals};
use super::journal::StudyJournal;
use super::points::Points;
use super::quantity::{Needs, Quantity};
use super::result::{Kind, PointError, Row, StudyColumn, StudyFacts, StudyResult};
use super::set_anyway::set_anyway;
use crate::journal::Identity;
use crate::life::{LifeError, LifeStudy};
use crate::mechanism::{LoadError, Mechanism};
use crate::provenance::Provenance;
use crate::shard::Shard;

/// What is asked at which points of a mechanism.
#[derive(Clone, Debug)]
pub struct Study<'m> {
    /// The mechanism at any point.
    pub cases: &'m Cases,
    /// The points.
    pub points: &'m Points,
    /// What is asked.
    pub of: Vec<Quantity>,
    /// How a run is made, where one is needed.
    pub settings: Settings,
    /// Inputs over time, the same at every point; those without samples have the values of the point.
    pub signals: Option<&'m SampledSignals>,
    /// How a life is lived, where one is needed; its mechanism gives place to that of the point. All points have the same seed: they
    /// share their random numbers, so that what differs between them is not chance.
    pub life: LifeStudy<'m>,
    /// Options of a run as results tell them.
    pub run_options: Value,
    /// The part of the points that is run here. None: all.
    pub shard: Option<Shard>,
    /// Threads that share the points. None: one per core.
    pub threads: Option<NonZero<usize>>,
}

/// The point was not run to its end: somebody stops the study.
struct Stopped;

/// Why nothing became of a point.
pub(crate) enum Fault {
    Load(LoadError),
    Run(RunError),
    Life(LifeError),
    /// A bug.
    Panicked(String),
}

impl Study<'_> {
    /// Whether what varies and what is asked go with the inputs over time; [`Self::run`] asks it too.
    ///
    /// # Errors
    /// [`StudyError::GivenOverTime`], [`StudyError::LifeOverTime`].
    pub fn check(&self) -> Result<(), StudyError> {
        self.signals.map_or(Ok(()), |signals| check_signals(signals, (self.cases, self.points, &self.of)))
    }

    /// Runs all points, or those of the shard.
    ///
    /// # Errors
    /// [`StudyError::Interrupted`], and those of [`Self::check`].
    pub fn run(&self, watch: Watch<'_>) -> Result<StudyResult, StudyError> {
        self.check()?;
        self.run_with(None, watch)
    }

    /// The same, going on from what a journal has, with the same bits as a run that was never interrupted.
    ///
    /// # Errors
    /// As [`Self::run`], and [`StudyError::Journal`].
    pub fn run_kept(&self, journal: &StudyJournal, watch: Watch<'_>) -> Result<StudyResult, StudyError> {
        self.check()?;
        journal.begin(self.identity(self.shard))?;
        let result = self.run_with(Some(journal), watch);
        if result.is_ok() {
            journal.finish();
        }
        journal.failure().map_or(result, |error| Err(error.into()))
    }

    fn run_with(&self, journal: Option<&StudyJournal>, watch: Watch<'_>) -> Result<StudyResult, StudyError> {
        let all = self.shard.map_or(0..self.points.count(), |shard| shard.numbers(self.points.count()));
        let of = all.end - all.start;
        let known: BTreeMap<u64, Row> = journal
            .map(|journal| journal.rows().range(all.clone()).map(|(at, row)| (*at, row.clone())).collect())
            .unwrap_or_default();
        let left: Vec<u64> = all.filter(|point| !known.contains_key(point)).collect();
        let threads = self.threads.or_else(|| available_parallelism().ok()).map_or(1, NonZero::get);
        let threads = threads.min(THREADS.most).min(left.len()).max(1);
        let (next, halt) = (AtomicUsize::new(0), AtomicBool::new(false));
        let done = AtomicU64::new(known.len() as u64);
        // The part of the point that each thread is at.
        let parts: Vec<AtomicU64> = (0..threads).map(|_| AtomicU64::new(0)).collect();
        let rows = Mutex::new(known);
        let part_done = || {
            let within = parts.iter().map(|part| f64::from_bits(part.load(Ordering::Relaxed))).sum::<f64>();
            ((done.load(Ordering::Relaxed) as f64 + within) / of.max(1) as f64).min(1.0)
        };
        // Who has said once that it shall stop is not asked again: a run that was stopped must not pass for one that failed.
        let go_on = || {
            let is_over = halt.load(Ordering::Relaxed)
                || watch.report(part_done()).is_break()
                || journal.is_some_and(StudyJournal::has_failed);
            if !is_over {
                return ControlFlow::Continue(());
            }
            halt.store(true, Ordering::Relaxed);
            ControlFlow::Break(())
        };
        let work = |thread: usize| {
            let mut last = None;
            while let Some(point) = left.get(next.fetch_add(1, Ordering::Relaxed)) {
                let hear = |part: f64| {
                    parts[thread].store(part.to_bits(), Ordering::Relaxed);
                    go_on()
                };
                let row = if go_on().is_break() {
                    Err(Stopped)
                } else {
                    self.row(*point, &mut last, Watch::new(&hear))
                };
                parts[thread].store(0, Ordering::Relaxed);
                let Ok(row) = row else { return halt.store(true, Ordering::Relaxed) };
                if let Some(journal) = journal {
                    journal.keep(*point, &row);
                }
                rows.lock().unwrap_or_else(PoisonError::into_inner).insert(*point, row);
                done.fetch_add(1, Ordering::Relaxed);
            }
        };
        std::thread::scope(|scope| {
            // A system that gives no more threads gives time: the rows are the same.
            let work = &work;
            let _ = (1..threads)
                .take_while(|thread| {
                    let thread = *thread;
                    Builder::new().spawn_scoped(scope, move || work(thread)).is_ok()
                })
                .count();
            work(0);
        });
        let rows = rows.into_inner().unwrap_or_else(PoisonError::into_inner);
        if (rows.len() as u64) < of {
            return Err(StudyError::Interrupted { done: rows.len() as u64, of });
        }
        Ok(StudyResult { facts: self.facts(), rows: rows.into_values().collect() })
    }

    fn needs(&self, needs: Needs) -> bool {
        self.of.iter().any(|quantity| quantity.needs() == needs)
    }

    /// What becomes of a point.
    fn row(&self, point: u64, last: &mut Last, watch: Watch<'_>) -> Result<Row, Stopped> {
        let given = self.points.values(point);
        let parameters = self.cases.in_si(&given);
        // What a panic leaves is not looked at again: what was compiled last is compiled anew.
        let found = catch_unwind(AssertUnwindSafe(|| self.results(&given, last, watch)));
        let found = found.unwrap_or_else(|panic| {
            *last = None;
            Err(Fault::Panicked(said(&*panic)))
        });
        match found {
            Ok((results, warnings)) => Ok(Row { parameters, results, error: None, warnings }),
            Err(_) if watch.report(0.0).is_break() => Err(Stopped),
            Err(fault) => {
                // Compiled for this point alone, a mechanism that cannot run tells more of its reason.
                let fault = match (&fault, self.cases.alone(&given)) {
                    (Fault::Run(_) | Fault::Life(_), Err(error)) => Fault::Load(error),
                    _ => fault,
                };
                let results = vec![None; self.of.len()];
                Ok(Row { parameters, results, error: Some(fault.told()), warnings: Vec::new() })
            }
        }
    }

    fn results(
        &self,
        given: &[(String, String)],
        last: &mut Last,
        watch: Watch<'_>,
    ) -> Result<(Vec<Option<f64>>, Vec<String>), Fault> {
        /// A run takes about this part of a life.
        const RUN: f64 = 0.05;
        let mechanism = self.cases.at(given, last).map_err(Fault::Load)?;
        let (needs_run, needs_life) = (self.needs(Needs::Run), self.needs(Needs::Life));
        let share = match (needs_run, needs_life) {
            (true, true) => RUN,
            (true, false) => 1.0,
            (false, _) => 0.0,
        };
        let run = needs_run.then(|| self.simulated(&mechanism, watch.piece(0.0, share))).transpose()?;
        let life =
            LifeStudy { mechanism: &mechanism, threads: Some(NonZero::<usize>::MIN), ..self.life.clone() };
        let anyway = if needs_life { set_anyway(&life, self.points) } else { Vec::new() };
        let life = needs_life.then(|| life.run_watched(watch.piece(share, 1.0))).transpose();
        let life = life.map_err(Fault::Life)?;
        let mut warnings: Vec<String> =
            run.iter().flat_map(|run| &run.warnings).map(ToString::to_string).collect();
        warnings.extend(anyway);
        warnings.extend(life.iter().flat_map(|life| life.warnings.clone()));
        let told = life.map(|life| (life.numbers(life.statistics().as_ref()), life));
        let value = |quantity: &Quantity| match quantity.needs() {
            Needs::Run => quantity.of_run(run.as_ref()?, &mechanism.description),
            Needs::Life => told.as_ref().and_then(|(numbers, life)| quantity.of_life(life, numbers)),
        };
        Ok((self.of.iter().map(value).collect(), warnings))
    }

    fn simulated(&self, mechanism: &Mechanism, watch: Watch<'_>) -> Result<Run, Fault> {
        let Mechanism { description, parameters, .. } = mechanism;
        let system = mechanism.system();
        let run = match self.signals {
            Some(signals) => {
                simulate_with_inputs(&*system, description, parameters, signals, &self.settings, watch)
            }
            None => simulate(&*system, description, parameters, &self.settings, watch),
        };
        let mut run = run.map_err(Fault::Run)?;
        run.stopped.take().map_or(Ok(run), |error| Err(Fault::Run(error)))
    }

    /// What is told with the rows.
    pub fn facts(&self) -> StudyFacts {
        let result = |quantity: &Quantity| StudyColumn {
            name: quantity.name.clone(),
            unit: quantity.unit.clone(),
            kind: Kind::Result,
        };
        let error = StudyColumn { name: "error".to_owned(), unit: String::new(), kind: Kind::Error };
        let mut columns = self.cases.parameters().to_vec();
        columns.extend(self.of.iter().map(result));
        columns.push(error);
        let name = self.cases.base().description.name.to_string();
        StudyFacts { name, columns, provenance: self.provenance() }
    }

    fn provenance(&self) -> Provenance {
        let axes = self.points.axes().iter();
        let vary: Map<_, _> = axes.map(|axis| (axis.name.clone(), json!(axis.written))).collect();
        let mut options = Map::new();
        options.insert("vary".to_owned(), vary.into());
        if self.points.is_sample() {
            options.insert("sample".to_owned(), json!(format!("sobol:{}", self.points.count())));
        }
        let names: Vec<&str> = self.of.iter().map(|quantity| &*quantity.name).collect();
        options.insert("of".to_owned(), json!(names));
        if self.needs(Needs::Run) {
            options.insert("run".to_owned(), present(&self.run_options));
        }
        if self.needs(Needs::Life) {
            options.insert("life".to_owned(), present(&self.life.options(self.life.coupling())));
        }
        let is_random = self.points.is_sample() || self.needs(Needs::Life);
        self.cases.base().provenance(is_random.then_some(self.life.seed), Value::Object(options))
    }

    /// All that decides the rows, in words that a difference is told by.
    pub(super) fn identity(&self, shard: Option<Shard>) -> Identity {
        let mut entries = LifeStudy { shard, ..self.life.clone() }.identity(self.life.coupling());
        for axis in self.points.axes() {
            entries.insert(format!("what {} varies over", axis.name), json!(axis.written));
        }
        let names: Vec<&str> = self.of.iter().map(|quantity| &*quantity.name).collect();
        let own = [
            ("the sample", json!(self.points.is_sample().then(|| self.points.count()))),
            (
                "the order of what varies",
                json!(self.points.axes().iter().map(|axis| &*axis.name).collect::<Vec<_>>()),
            ),
            ("what is asked", json!(names)),
            ("the options of runs", self.run_options.clone()),
            ("the options of lives", self.life.options(self.life.coupling())),
        ];
        entries.extend(own.map(|(name, value)| (name.to_owned(), value)));
        entries
    }
}

/// What a panic says of itself.
fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// Options that are given.
fn present(options: &Value) -> Value {
    let given = options.as_object().into_iter().flatten().filter(|(_, value)| !value.is_null());
    given.map(|(name, value)| (name.clone(), value.clone())).collect::<Map<_, _>>().into()
}

impl Fault {
    pub(crate) fn told(self) -> PointError {
        let plain =
            |code: &str, message: String| PointError { code: code.to_owned(), message, help: String::new() };
        match self {
            Self::Load(LoadError::Mechanism(diagnostics)) => {
                let first = diagnostics.entries().into_iter().next();
                first.map_or_else(
                    || plain(RUN_FAILED, diagnostics.to_string()),
                    |first| PointError {
                        code: first.code.to_owned(),
                        message: first.message,
                        help: first.help,
                    },
                )
            }
            Self::Load(error) => plain(RUN_FAILED, error.to_string()),
            Self::Run(error) => plain(RUN_FAILED, error.to_string()),
            Self::Life(error) => plain(LIFE_FAILED, error.to_string()),
            Self::Panicked(message) => plain(RUN_FAILED, format!("the program is at fault here: {message}")),
        }
    }
}

/// Code of a run that came to nothing, as `simulate` has it.
pub const RUN_FAILED: &str = "C0008";
/// Code of a life that came to nothing, as `life` has it.
pub const LIFE_FAILED: &str = "C0010";
