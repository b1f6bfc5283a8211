//! How far a study is: the finished work of all its jobs, told to a [`Watch`].

use std::ops::ControlFlow;
use std::sync::Mutex;

use linkwear_runtime::Watch;

/// Adds up finished work from all threads.
pub(super) struct Progress<'a> {
    watch: Watch<'a>,
    total: f64,
    sum: Mutex<f64>,
}

impl<'a> Progress<'a> {
    /// `total`: all the work, in the units of [`Self::done`].
    pub fn new(watch: Watch<'a>, total: f64) -> Self {
        Self { watch, total, sum: Mutex::new(0.0) }
    }

    /// So much more work is done.
    pub fn done(&self, work: f64) {
        let _ = self.add(work);
    }

    fn add(&self, work: f64) -> ControlFlow<()> {
        let mut sum = self.sum.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        *sum += work;
        // What is left is only estimated before.
        self.watch.report((*sum / self.total).min(0.999))
    }

    /// Whether to go on.
    pub fn go_on(&self) -> ControlFlow<()> {
        self.add(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_never_reaches_the_end_before_the_study_does() {
        let seen = Mutex::new(Vec::new());
        let hear = |part| {
            seen.lock().unwrap().push(part);
            ControlFlow::Continue(())
        };
        let progress = Progress::new(Watch::new(&hear), 4.0);
        (0..3).for_each(|_| progress.done(2.0));
        assert_eq!(*seen.lock().unwrap(), [0.5, 0.999, 0.999]);
    }
}
