//! Many trajectories of one mechanism. In: settings, a way to make fine scales, a draw. Out: lives in the order of
//! their trajectories, the same bits for any number of threads. Never knows how a revolution is computed.

use std::any::Any;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::Builder;

use linkwear_runtime::Watch;
use linkwear_runtime::life::{
    FailureEvent, IncrementModel, LifeError, LifeOutcome, LifeSettings, LifeState, WearSource, run_life,
};

/// What to run.
pub struct MonteCarlo<'a> {
    /// The lives.
    pub settings: &'a LifeSettings,
    /// Their randomness.
    pub draw: &'a (dyn IncrementModel + Sync),
    /// Numbers of the trajectories.
    pub trajectories: Range<u64>,
    /// Threads that share the work.
    pub threads: NonZero<usize>,
}

/// Why there are no more lives.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended<E> {
    /// All were lived.
    Complete,
    /// The watch said so.
    Cancelled,
    /// A trajectory could not go on.
    Stopped {
        /// Its number; the lowest if several could not.
        trajectory: u64,
        /// Why.
        stop: LifeError<E>,
    },
    /// Its thread panicked: a bug, of the caller's or of this library.
    Panicked {
        /// The trajectory at hand; the lowest if several did.
        trajectory: u64,
        /// What the panic said.
        message: String,
    },
    /// A trajectory did not fail within the cycles that the settings allow.
    Survived {
        /// Its number; the lowest if several did.
        trajectory: u64,
    },
}

/// Lives of trajectories.
#[derive(Clone, Debug, PartialEq)]
pub struct Lives<E> {
    /// Trajectory and life, by rising number. All of the range if complete, else those that were finished.
    pub failures: Vec<(u64, FailureEvent)>,
    /// How it ended.
    pub ended: Ended<E>,
    /// Threads that the system did not give; the lives are the same.
    pub missing_threads: usize,
}

/// Creates a fine scale for one thread and passes it to the callback. Errors are those of creating it. The callback
/// lets a fine scale borrow from what is created with it, as revolutions borrow a system.
pub type Scale<'a, S, E> = &'a (
        dyn Fn(&mut dyn FnMut(&mut dyn WearSource<State = S, Error = E>)) -> std::result::Result<(), E> + Sync
    );

/// How one trajectory ended.
type Result<E> = std::result::Result<FailureEvent, Ended<E>>;

impl MonteCarlo<'_> {
    /// Lives all trajectories. Every thread asks `scale` for a fine scale of its own; `watch` hears which part of
    /// the lives is done, from whichever thread, and may end the run.
    pub fn run<S: Clone + Default, E: Send>(&self, scale: Scale<'_, S, E>, watch: Watch<'_>) -> Lives<E> {
        self.go_on(&BTreeMap::new(), &|_, _| (), scale, watch)
    }

    /// As [`Self::run`], after some lives are known already. `keep` hears of every further one as soon as it is
    /// finished, from whichever thread.
    pub fn go_on<S: Clone + Default, E: Send>(
        &self,
        known: &BTreeMap<u64, FailureEvent>,
        keep: &(dyn Fn(u64, FailureEvent) + Sync),
        scale: Scale<'_, S, E>,
        watch: Watch<'_>,
    ) -> Lives<E> {
        let known = known.range(self.trajectories.clone()).map(|(number, end)| (*number, Ok(*end)));
        let known: Vec<(u64, Result<E>)> = known.collect();
        let is_known: Vec<u64> = known.iter().map(|(number, _)| *number).collect();
        let left = (self.trajectories.end - self.trajectories.start).saturating_sub(known.len() as u64);
        let next = AtomicU64::new(self.trajectories.start);
        let done = AtomicU64::new(known.len() as u64);
        let halt = AtomicBool::new(false);
        let results = Mutex::new(known);
        let ended = |trajectory, result: Result<E>| {
            if let Ok(end) = &result {
                keep(trajectory, *end);
            }
            halt.fetch_or(result.is_err(), Ordering::Relaxed);
            done.fetch_add(1, Ordering::Relaxed);
            results.lock().unwrap_or_else(PoisonError::into_inner).push((trajectory, result));
        };
        let count = (self.trajectories.end - self.trajectories.start) as f64;
        let go_on = |_: f64| {
            let part = done.load(Ordering::Relaxed) as f64 / count;
            let stop = watch.report(part).is_break() || halt.load(Ordering::Relaxed);
            if stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let live_all = |at: &Cell<u64>| {
            let made = scale(&mut |mut fine| {
                while !halt.load(Ordering::Relaxed) {
                    let trajectory = next.fetch_add(1, Ordering::Relaxed);
                    if trajectory >= self.trajectories.end {
                        break;
                    }
                    at.set(trajectory);
                    if is_known.binary_search(&trajectory).is_err() {
                        ended(trajectory, self.live(&mut fine, trajectory, Watch::new(&go_on)));
                    }
                }
            });
            if let Err(error) = made {
                let trajectory = self.trajectories.start;
                let stop = LifeError::Fine { cycle: 1, error };
                ended(trajectory, Err(Ended::Stopped { trajectory, stop }));
            }
        };
        let work = || {
            let at = Cell::new(self.trajectories.start);
            // What a panic leaves is not looked at again: the results are those of whole lives.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| live_all(&at))) {
                let (trajectory, message) = (at.get(), said(&*panic));
                ended(trajectory, Err(Ended::Panicked { trajectory, message }));
            }
        };
        let wanted = self.threads.get().min(usize::try_from(left).unwrap_or(usize::MAX)).max(1);
        let missing_threads = std::thread::scope(|scope| {
            // A system that gives no more threads gives time: the lives are the same.
            let spawned =
                (1..wanted).take_while(|_| Builder::new().spawn_scoped(scope, work).is_ok()).count();
            work();
            wanted - 1 - spawned
        });
        let (failures, ended) = collect(results.into_inner().unwrap_or_else(PoisonError::into_inner));
        Lives { failures, ended, missing_threads }
    }

    fn live<F: WearSource>(&self, fine: &mut F, trajectory: u64, watch: Watch<'_>) -> Result<F::Error> {
        let stopped = |stop| Ended::Stopped { trajectory, stop };
        let mut state =
            LifeState::new(self.settings, trajectory).map_err(|error| stopped(LifeError::Settings(error)))?;
        match run_life(self.settings, fine, self.draw, &mut state, watch) {
            Ok(LifeOutcome::Failed(failure)) => Ok(failure),
            Ok(LifeOutcome::Cancelled) => Err(Ended::Cancelled),
            Ok(LifeOutcome::CycleLimit) => Err(Ended::Survived { trajectory }),
            Err(stop) => Err(stopped(stop)),
        }
    }
}

/// In the order of the trajectories; the first that stopped for a reason of its own says why.
fn collect<E>(mut results: Vec<(u64, Result<E>)>) -> (Vec<(u64, FailureEvent)>, Ended<E>) {
    results.sort_by_key(|(trajectory, _)| *trajectory);
    let (mut failures, mut ended) = (Vec::with_capacity(results.len()), Ended::Complete);
    for (trajectory, result) in results {
        match (result, &ended) {
            (Ok(failure), _) => failures.push((trajectory, failure)),
            (Err(why), Ended::Complete | Ended::Cancelled) => ended = why,
            (Err(_), _) => {}
        }
    }
    (failures, ended)
}

/// What a panic says.
fn said(panic: &(dyn Any + Send)) -> String {
    let text =
        panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no text").to_owned()
}
