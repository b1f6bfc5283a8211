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

use super::side_by_side::{Heard, SideBySide};
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

/// Lives that a thread takes at a time where they are lived side by side: some milliseconds.
const BLOCK: usize = 512;

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

/// Hears of lives, each with its number.
pub type Keep<'a> = &'a (dyn Fn(&[(u64, FailureEvent)]) + Sync);

/// How one trajectory ended.
type Result<E> = std::result::Result<FailureEvent, Ended<E>>;

impl MonteCarlo<'_> {
    /// Lives all trajectories. Every thread asks `scale` for a fine scale of its own; `watch` hears which part of
    /// the lives is done, from whichever thread, and may end the run.
    pub fn run<S: Clone + Default, E: Send>(&self, scale: Scale<'_, S, E>, watch: Watch<'_>) -> Lives<E> {
        self.go_on(&BTreeMap::new(), &|_| (), scale, watch)
    }

    /// As [`Self::run`], after some lives are known already. `keep` hears of all further ones as soon as they are
    /// finished, from whichever thread: one by one, or some hundred together where each takes microseconds.
    pub fn go_on<S: Clone + Default, E: Send>(
        &self,
        known: &BTreeMap<u64, FailureEvent>,
        keep: Keep<'_>,
        scale: Scale<'_, S, E>,
        watch: Watch<'_>,
    ) -> Lives<E> {
        self.go_on_heard(known, (keep, None), scale, watch)
    }

    /// As [`Self::go_on`]; `heard` hears of the cycles of further lives, those of a life before `keep` hears of its end. It changes no
    /// bit.
    pub fn go_on_heard<S: Clone + Default, E: Send>(
        &self,
        known: &BTreeMap<u64, FailureEvent>,
        (keep, heard): (Keep<'_>, Option<Heard<'_>>),
        scale: Scale<'_, S, E>,
        watch: Watch<'_>,
    ) -> Lives<E> {
        let known: Vec<(u64, FailureEvent)> =
            known.range(self.trajectories.clone()).map(|(number, end)| (*number, *end)).collect();
        let is_known: Vec<u64> = known.iter().map(|(number, _)| *number).collect();
        let all = self.trajectories.end.saturating_sub(self.trajectories.start);
        let left = all.saturating_sub(known.len() as u64);
        let next = AtomicU64::new(self.trajectories.start);
        let done = AtomicU64::new(known.len() as u64);
        let halt = AtomicBool::new(false);
        let mut failures = known;
        failures.reserve_exact(usize::try_from(left).unwrap_or(0));
        let (failures, stops) = (Mutex::new(failures), Mutex::new(Vec::new()));
        let failed = |ends: &[(u64, FailureEvent)]| {
            keep(ends);
            done.fetch_add(ends.len() as u64, Ordering::Relaxed);
            failures.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(ends);
        };
        let stopped = |trajectory: u64, why: Ended<E>| {
            halt.store(true, Ordering::Relaxed);
            stops.lock().unwrap_or_else(PoisonError::into_inner).push((trajectory, why));
        };
        let count = all as f64;
        let go_on = |_: f64| {
            let part = done.load(Ordering::Relaxed) as f64 / count;
            let stop = watch.report(part).is_break() || halt.load(Ordering::Relaxed);
            if stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        // The next numbers, without those that are known.
        let take = |most: u64| {
            let from = next.fetch_add(most, Ordering::Relaxed);
            let numbers = from..from.saturating_add(most).min(self.trajectories.end);
            let is_new = |number: &u64| is_known.binary_search(number).is_err();
            (!numbers.is_empty()).then(|| numbers.filter(is_new))
        };
        let live_all = |at: &Cell<u64>| {
            let made = scale(&mut |mut fine| {
                let one =
                    |fine: &mut _, trajectory| match self.live(fine, trajectory, (Watch::new(&go_on), heard))
                    {
                        Ok(end) => failed(&[(trajectory, end)]),
                        Err(why) => stopped(trajectory, why),
                    };
                let Some(flow) = fine.flow(self.settings) else {
                    while !halt.load(Ordering::Relaxed) {
                        let Some(numbers) = take(1) else { break };
                        numbers.for_each(|trajectory| {
                            at.set(trajectory);
                            one(&mut fine, trajectory);
                        });
                    }
                    return;
                };
                let mut lanes = SideBySide::new(self.settings, flow, (self.draw, heard));
                let (mut ends, mut others) = (Vec::with_capacity(BLOCK), Vec::with_capacity(BLOCK));
                while let Some(numbers) = take(BLOCK as u64) {
                    if go_on(0.0).is_break() {
                        let first = numbers.min().unwrap_or(self.trajectories.start);
                        return stopped(first, Ended::Cancelled);
                    }
                    lanes.live(
                        &mut numbers.inspect(|number| at.set(*number)),
                        &mut |number, end| match end {
                            Some(end) => ends.push((number, end)),
                            None => others.push(number),
                        },
                    );
                    failed(&ends);
                    others.iter().for_each(|trajectory| one(&mut fine, *trajectory));
                    ends.clear();
                    others.clear();
                }
            });
            if let Err(error) = made {
                let trajectory = self.trajectories.start;
                let stop = LifeError::Fine { cycle: 1, error };
                stopped(trajectory, Ended::Stopped { trajectory, stop });
            }
        };
        let work = || {
            let at = Cell::new(self.trajectories.start);
            // What a panic leaves is not looked at again: the results are those of whole lives.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| live_all(&at))) {
                let (trajectory, message) = (at.get(), said(&*panic));
                stopped(trajectory, Ended::Panicked { trajectory, message });
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
        let mut failures = failures.into_inner().unwrap_or_else(PoisonError::into_inner);
        by_number(&mut failures);
        let ended = first(stops.into_inner().unwrap_or_else(PoisonError::into_inner));
        Lives { failures, ended, missing_threads }
    }

    fn live<F: WearSource>(
        &self,
        fine: &mut F,
        trajectory: u64,
        (watch, heard): (Watch<'_>, Option<Heard<'_>>),
    ) -> Result<F::Error> {
        let stopped = |stop| Ended::Stopped { trajectory, stop };
        let heard_of;
        let settings = if heard.is_some() {
            heard_of = LifeSettings { keep_cycles: true, ..self.settings.clone() };
            &heard_of
        } else {
            self.settings
        };
        let mut state =
            LifeState::new(settings, trajectory).map_err(|error| stopped(LifeError::Settings(error)))?;
        match run_life(settings, fine, self.draw, &mut state, watch) {
            Ok(LifeOutcome::Failed(failure)) => {
                if let Some(heard) = heard {
                    for record in &state.cycles {
                        let wear: Vec<f64> = record.joints.iter().map(|joint| joint.wear).collect();
                        heard(trajectory, record.cycle, &wear);
                    }
                }
                Ok(failure)
            }
            Ok(LifeOutcome::Cancelled) => Err(Ended::Cancelled),
            Ok(LifeOutcome::CycleLimit) => Err(Ended::Survived { trajectory }),
            Err(stop) => Err(stopped(stop)),
        }
    }
}

/// Sorts lives by their numbers. Apart, because what is generic is compiled by the crate that calls it.
fn by_number(lives: &mut [(u64, FailureEvent)]) {
    lives.sort_unstable_by_key(|(trajectory, _)| *trajectory);
}

/// The first that stopped for a reason of its own says why.
fn first<E>(mut stops: Vec<(u64, Ended<E>)>) -> Ended<E> {
    stops.sort_by_key(|(trajectory, why)| (matches!(why, Ended::Cancelled), *trajectory));
    stops.into_iter().next().map_or(Ended::Complete, |(_, why)| why)
}

/// What a panic says.
fn said(panic: &(dyn Any + Send)) -> String {
    let text =
        panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no text").to_owned()
}
