//! The random lives of a study. In: a plan, sources of wear. Out: lives, and what uncertain parameters do to their mean.
//! Never knows where wear is from.

use std::error::Error as StdError;
use std::num::NonZero;
use std::ops::Range;
use std::sync::atomic::Ordering;

use linkwear_gamma::monte_carlo::{Ended, GammaDraw, Lives, MonteCarlo, Scale};
use linkwear_runtime::Watch;
use linkwear_runtime::life::FailureEvent;

use super::counted::{CountedEnds, parts};
use super::error::{Cause, LifeError};
use super::journal::{Batch, KnownLives};
use super::result::LifeResult;
use super::run::Plan;
use super::study::Coupling;

/// Lives for each of the four shifts that tell what uncertain parameters do to the mean. Shifts share their random
/// numbers, so few are enough; with the dynamics at every step each is dear.
const SHIFTED_BY_TABLE: u64 = 200;
const SHIFTED_BY_DYNAMICS: u64 = 4;

/// Ends of lives by their numbers.
type Numbered = Vec<(u64, FailureEvent)>;

/// Lives to draw: which of them, of how many in all.
struct Part {
    batch: Batch,
    lives: Range<u64>,
    of: u64,
}

impl Plan<'_> {
    /// The random lives, and what uncertain parameters do to their mean.
    pub(super) fn draw<S: Clone + Default, E: StdError + Send + Sync + 'static>(
        &self,
        result: &mut LifeResult,
        scale: Scale<'_, S, E>,
        threads: NonZero<usize>,
    ) -> Result<(), LifeError> {
        let (Some(process), Some(count)) = (&self.process, self.trajectories) else { return Ok(()) };
        let failed =
            |(cause, lives): (Cause, Numbered)| LifeError { lives, ..self.error(cause, &result.cycles) };
        let is_listed = count <= self.study.listed;
        let (mut counted, mut lives) = (CountedEnds::default(), Vec::new());
        // More than are listed go in parts of as many, which are counted and forgotten.
        for part in parts(count, self.study.listed) {
            let [start, length] =
                [part.start, part.end - part.start].map(|lives| lives as f64 / count as f64);
            let watch = |done: f64| self.watch.report(start + length * done);
            let first = self.study.first;
            let lives_of_part = first.saturating_add(part.start)..first.saturating_add(part.end);
            let part = Part { batch: 0, lives: lives_of_part, of: count };
            lives =
                self.draw_by((scale, threads), &process.draw(), part, Watch::new(&watch)).map_err(failed)?;
            if !is_listed {
                let all = lives.drain(..).try_for_each(|(_, end)| counted.add(&end));
                let cause = |error| Cause::Wear { trajectory: None, error: Box::new(error) };
                all.map_err(|error| self.error(cause(error), &result.cycles))?;
            }
        }
        let few = match self.coupling {
            Coupling::Table => SHIFTED_BY_TABLE,
            Coupling::Full => SHIFTED_BY_DYNAMICS,
        };
        let mut batch = 0;
        let by_fits = process.uncertainty(&mut |shifted| {
            batch += 1;
            let few = count.min(few);
            let part = Part { batch, lives: 0..few, of: few };
            let lives = self.draw_by((scale, threads), shifted, part, self.between)?;
            Ok(lives.iter().map(|(_, end)| end.cycles).sum::<f64>() / lives.len() as f64)
        });
        let by_fits = by_fits.map_err(|(cause, _)| failed((cause, lives.clone())))?;
        // One life has no statistics: the budget stays that of the mean path.
        if count > 1 {
            result.parameter_error = by_fits;
        }
        result.counted = (!is_listed).then_some(counted);
        result.lives = lives.into_iter().map(|(_, end)| end).collect();
        let missing = self.missing_threads.load(Ordering::Relaxed);
        if missing > 0 {
            let (given, of) = (threads.get() - missing, threads);
            result.warnings.push(format!(
                "the system gave {given} of {of} threads: the lives are the same, and took longer"
            ));
        }
        Ok(())
    }

    /// Lives by these draws; with an error those that were finished.
    fn draw_by<S: Clone + Default, E: StdError + Send + Sync + 'static>(
        &self,
        (scale, threads): (Scale<'_, S, E>, NonZero<usize>),
        draw: &GammaDraw,
        Part { batch, lives, of }: Part,
        watch: Watch<'_>,
    ) -> Result<Numbered, (Cause, Numbered)> {
        let mut settings = self.settings.clone();
        settings.keep_cycles = false;
        let done = lives.start.saturating_sub(self.study.first);
        let run = MonteCarlo { settings: &settings, draw, trajectories: lives, threads };
        let none = KnownLives::new();
        let known = self.journal.and_then(|journal| journal.lives(batch)).unwrap_or(&none);
        let keep = |ends: &[(u64, FailureEvent)]| {
            // Lives that are not listed are as fast lived again as read.
            if let Some(journal) = self.journal.filter(|_| of <= self.study.listed) {
                journal.keep_lives(batch, ends);
            }
        };
        let Lives { failures, ended, missing_threads } = run.go_on(known, &keep, scale, watch);
        self.missing_threads.fetch_max(missing_threads, Ordering::Relaxed);
        let lives = Some((failures.len() + usize::try_from(done).unwrap_or(0), of));
        let cause = match ended {
            Ended::Complete => return Ok(failures),
            Ended::Cancelled => Cause::Interrupted { trajectory: None, lives },
            Ended::Stopped { trajectory, stop } => match self.cause(stop, Some(trajectory)) {
                Cause::Interrupted { trajectory, .. } => Cause::Interrupted { trajectory, lives },
                cause => cause,
            },
            Ended::Panicked { trajectory, message } => Cause::Panicked { trajectory, message },
            Ended::Survived { trajectory } => {
                Cause::CycleLimit { trajectory: Some(trajectory), cycles: settings.most_cycles }
            }
        };
        Err((cause, failures))
    }
}
