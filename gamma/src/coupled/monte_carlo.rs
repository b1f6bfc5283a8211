//! Many trajectories of one mechanism. In: settings, a way to make fine scales, a draw. Out: lives in the order of
//! their trajectories, the same bits for any number of threads. Never knows how a revolution is computed.

use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use linkwear_runtime::life::{
    Failure, FineScale, IncrementDraw, LifeSettings, LifeState, Outcome, Stop, run_life,
};

/// What to run.
pub struct MonteCarlo<'a> {
    /// The lives.
    pub settings: &'a LifeSettings,
    /// Their randomness.
    pub draw: &'a (dyn IncrementDraw + Sync),
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
    /// The observer said so.
    Cancelled,
    /// A trajectory could not go on.
    Stopped {
        /// Its number; the lowest if several could not.
        trajectory: u64,
        /// Why.
        stop: Stop<E>,
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
    pub failures: Vec<(u64, Failure)>,
    /// How it ended.
    pub ended: Ended<E>,
}

/// How one trajectory ended.
type Result<E> = std::result::Result<Failure, Ended<E>>;

impl MonteCarlo<'_> {
    /// Lives all trajectories. Every thread makes a fine scale of its own with `make`; `observe` hears how many are
    /// done, from whichever thread, and may end the run.
    pub fn run<F: FineScale>(
        &self,
        make: &(dyn Fn() -> F + Sync),
        observe: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Lives<F::Error>
    where
        F::Error: Send,
    {
        let next = AtomicU64::new(self.trajectories.start);
        let done = AtomicU64::new(0);
        let halt = AtomicBool::new(false);
        let results: Mutex<Vec<(u64, Result<F::Error>)>> = Mutex::new(Vec::new());
        let work = || {
            let mut fine = make();
            while !halt.load(Ordering::Relaxed) {
                let trajectory = next.fetch_add(1, Ordering::Relaxed);
                if trajectory >= self.trajectories.end {
                    break;
                }
                let result = self.live(&mut fine, trajectory, &|| {
                    let stop = observe(done.load(Ordering::Relaxed)).is_break();
                    if stop || halt.load(Ordering::Relaxed) {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                });
                halt.fetch_or(result.is_err(), Ordering::Relaxed);
                done.fetch_add(1, Ordering::Relaxed);
                results.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((trajectory, result));
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..self.threads.get() {
                scope.spawn(work);
            }
            work();
        });
        collect(results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner))
    }

    fn live<F: FineScale>(
        &self,
        fine: &mut F,
        trajectory: u64,
        go_on: &dyn Fn() -> ControlFlow<()>,
    ) -> Result<F::Error> {
        let stopped = |stop| Ended::Stopped { trajectory, stop };
        let mut state =
            LifeState::new(self.settings, trajectory).map_err(|error| stopped(Stop::Settings(error)))?;
        match run_life(self.settings, fine, self.draw, &mut state, &mut |_| go_on()) {
            Ok(Outcome::Failed(failure)) => Ok(failure),
            Ok(Outcome::Cancelled) => Err(Ended::Cancelled),
            Ok(Outcome::CycleLimit) => Err(Ended::Survived { trajectory }),
            Err(stop) => Err(stopped(stop)),
        }
    }
}

/// In the order of the trajectories; the first that stopped for a reason of its own says why.
fn collect<E>(mut results: Vec<(u64, Result<E>)>) -> Lives<E> {
    results.sort_by_key(|(trajectory, _)| *trajectory);
    let (mut failures, mut ended) = (Vec::with_capacity(results.len()), Ended::Complete);
    for (trajectory, result) in results {
        match (result, &ended) {
            (Ok(failure), _) => failures.push((trajectory, failure)),
            (Err(why), Ended::Complete | Ended::Cancelled) => ended = why,
            (Err(_), _) => {}
        }
    }
    Lives { failures, ended }
}
