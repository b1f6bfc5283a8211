//! How the jobs of a study share the processors.
//! In: jobs. Out: their results in the order of the jobs, whatever the number of threads. Never knows what they do.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// A piece of work that may run in any thread.
pub(super) type Job<'j, T> = Box<dyn FnOnce() -> T + Send + 'j>;

/// Runs jobs on so many threads; the first free thread takes the next job. Results come in the order of the jobs.
pub(super) fn run_all<T: Send>(threads: usize, jobs: Vec<Job<'_, T>>) -> Vec<T> {
    let count = jobs.len();
    let waiting: Vec<Mutex<Option<Job<'_, T>>>> = jobs.into_iter().map(|job| Mutex::new(Some(job))).collect();
    let results: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(index) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|index| *index < count) {
            let job = waiting[index].lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
            let result = job.map(|job| job());
            *results[index].lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = result;
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads.clamp(1, count.max(1)) {
            scope.spawn(work);
        }
        work();
    });
    let taken = results
        .into_iter()
        .map(|result| result.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()));
    taken
        .map(|result| result.expect("every job was run: a panic in one has come through the scope"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_the_jobs_on_any_number_of_threads() {
        for threads in [1, 2, 5] {
            let jobs = (0..20_u64).map(|i| Box::new(move || i * i) as Job<'_, u64>).collect();
            assert_eq!(run_all(threads, jobs), (0..20).map(|i| i * i).collect::<Vec<_>>());
        }
        assert_eq!(run_all::<u8>(2, Vec::new()), Vec::<u8>::new());
    }
}
