//! The threads of a study: they share its work and tell together how far it is. In: items and what to do with each.
//! Out: results in the order of the items, whatever the number of threads. Never knows what the work is.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use linkwear_runtime::Watch;

/// Threads under one watch.
pub(super) struct Workers<'w> {
    threads: usize,
    watch: Watch<'w>,
    total: f64,
    done: Mutex<f64>,
}

impl<'w> Workers<'w> {
    /// `total`: all the work, in the units of [`Self::piece`].
    pub fn new(threads: usize, watch: Watch<'w>, total: f64) -> Self {
        Self { threads, watch, total, done: Mutex::new(0.0) }
    }

    /// Does the work of every item; the first free thread takes the next one.
    ///
    /// # Errors
    /// That of the first item that has one.
    pub fn each<T: Sync, R: Send, E: Send>(
        &self,
        items: &[T],
        work: impl Fn(&T) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let next = AtomicUsize::new(0);
        let results = Mutex::new(Vec::with_capacity(items.len()));
        let take = || {
            let at = next.fetch_add(1, Ordering::Relaxed);
            Some((at, items.get(at)?))
        };
        let share = || {
            while let Some((at, item)) = take() {
                let result = work(item);
                lock(&results).push((at, result));
            }
        };
        thread::scope(|scope| {
            for _ in 1..self.threads.clamp(1, items.len().max(1)) {
                // Without a further thread those that there are do its work.
                if thread::Builder::new().spawn_scoped(scope, share).is_err() {
                    break;
                }
            }
            share();
        });
        let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
        results.sort_by_key(|(at, _)| *at);
        results.into_iter().map(|(_, result)| result).collect()
    }

    /// Does work that is so much of the whole, under a watch for that piece.
    pub fn piece<R>(&self, work: f64, action: impl FnOnce(Watch<'_>) -> R) -> R {
        let told = Mutex::new(0.0);
        let hear = |part: f64| {
            let mut told = lock(&told);
            let more = (part - *told).max(0.0);
            *told += more;
            self.add(more * work)
        };
        let result = action(Watch::new(&hear));
        // Nothing is left that could be stopped.
        let _ = hear(1.0);
        result
    }

    fn add(&self, work: f64) -> ControlFlow<()> {
        let mut done = lock(&self.done);
        *done += work;
        // What is left is only estimated before.
        self.watch.report((*done / self.total).min(0.999))
    }
}

fn lock<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_the_items_on_any_number_of_threads() {
        let items: Vec<u64> = (0..20).collect();
        for threads in [1, 2, 5] {
            let workers = Workers::new(threads, Watch::NONE, 1.0);
            let squares = workers.each(&items, |i| Ok::<_, ()>(i * i));
            assert_eq!(squares, Ok(items.iter().map(|i| i * i).collect()));
            let failed = workers.each(&items, |i| if *i < 7 { Ok(()) } else { Err(*i) });
            assert_eq!(failed, Err(7));
            assert_eq!(workers.each(&[], |(): &()| Ok::<_, ()>(())), Ok(Vec::new()));
        }
    }

    #[test]
    fn progress_rises_and_never_reaches_the_end_before_the_study_does() {
        let seen = Mutex::new(Vec::new());
        let hear = |part| {
            seen.lock().unwrap().push(part);
            ControlFlow::Continue(())
        };
        let workers = Workers::new(1, Watch::new(&hear), 4.0);
        workers.piece(2.0, |watch| {
            assert!(watch.report(0.5).is_continue());
            // Asks whether to stop, and tells nothing new.
            assert!(watch.piece(0.0, 0.0).report(0.9).is_continue());
        });
        (0..2).for_each(|_| workers.piece(2.0, |_| ()));
        assert_eq!(*seen.lock().unwrap(), [0.25, 0.25, 0.5, 0.999, 0.999]);
    }
}
