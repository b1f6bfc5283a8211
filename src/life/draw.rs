//! The random lives of a study. In: a plan, sources of wear. Out: lives, and what uncertain parameters do to their mean.
//! Never knows where wear is from.

use std::error::Error as StdError;
use std::num::NonZero;
use std::ops::Range;
use std::sync::atomic::Ordering;

use linkwear_gamma::monte_carlo::{Ended, GammaDraw, Heard, Lives, MonteCarlo, Scale};
use linkwear_runtime::Watch;
use linkwear_runtime::life::FailureEvent;

use super::counted::{CountedEnds, parts};
use super::error::{Cause, LifeError};
use super::journal::{Batch, KnownLives, LifeJournal};
use super::paths::{FOLLOWED, Follower};
use super::result::LifeResult;
use super::run::Plan;
use super::study::Coupling;

/// Lives for each of the four shifts that tell what uncertain parameters do to the mean. Shifts share their random
/// numbers, so few are enough; with the dynamics at every step each is dear.
const SHIFTED_BY_TABLE: u64 = 200;
const SHIFTED_BY_DYNAMICS: u64 = 4;

/// Ends of lives by their numbers.
type Numbered = Vec<(u64, FailureEvent)>;

/// Lives to draw.
struct Part<'a> {
    batch: Batch,
    /// All that are to be drawn.
    all: Range<u64>,
    /// Those to draw now.
    lives: Range<u64>,
    /// Whether the journal keeps them: lives that are not listed are as fast lived again as read.
    is_kept: bool,
    /// Who hears of their cycles.
    follower: Option<&'a Follower>,
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
        self.watch.begin("lives");
        let failed =
            |(cause, lives): (Cause, Numbered)| LifeError { lives, ..self.error(cause, &result.cycles) };
        // Shards agree on what they tell: it goes by the lives of all.
        let is_listed = count <= self.study.listed;
        let all = self.study.shard.map_or(0..count, |shard| shard.numbers(count));
        let length = (all.end - all.start) as f64;
        let (mut counted, mut lives) = (CountedEnds::default(), Vec::new());
        let known = self.journal.map(LifeJournal::paths).unwrap_or_default();
        let follower = Follower::new(result.end.cycles, known);
        // By a table lives are as fast lived once more as followed: none is lived otherwise because someone looks.
        let is_followed = self.coupling == Coupling::Full;
        // More than are listed go in parts of as many, which are counted and forgotten.
        for part in parts(all.clone(), self.study.listed) {
            let [start, share] =
                [part.start - all.start, part.end - part.start].map(|lives| lives as f64 / length);
            let watch = |done: f64| self.watch.report(start + share * done);
            let follower = is_followed.then_some(&follower);
            let part = Part { batch: 0, all: all.clone(), lives: part, is_kept: is_listed, follower };
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
        let mut by_fits = |shifted: &GammaDraw| {
            batch += 1;
            let few = count.min(few);
            let (all, is_kept) = (0..few, few <= self.study.listed);
            let part = Part { batch, lives: all.clone(), all, is_kept, follower: None };
            let lives = self.draw_by((scale, threads), shifted, part, self.between)?;
            Ok(lives.iter().map(|(_, end)| end.cycles).sum::<f64>() / lives.len() as f64)
        };
        // Of shards the first asks for all.
        let is_asked = self.study.shard.is_none_or(|shard| shard.index == 1);
        let by_fits = if is_asked { process.uncertainty(&mut by_fits) } else { Ok(None) };
        let by_fits = by_fits.map_err(|(cause, _)| failed((cause, lives.clone())))?;
        // One life has no statistics: the budget stays that of the mean path.
        if count > 1 {
            result.parameter_error = by_fits;
        }
        let followed = all.start..all.end.min(FOLLOWED);
        if !is_followed && !followed.is_empty() {
            let follower = Some(&follower);
            let part = Part { batch: 0, lives: followed.clone(), all: followed, is_kept: false, follower };
            self.draw_by((scale, threads), &process.draw(), part, self.between).map_err(failed)?;
        }
        result.paths = Some(follower.finish());
        result.counted = (!is_listed).then_some(counted);
        result.lives = lives.into_iter().map(|(_, end)| end).collect();
        let missing = self.missing_threads.load(Ordering::Relaxed);
        if missing > 0 {
            let (given, of) = (threads.get() - missing, threads);
            let note =
                format!("the system gave {given} of {of} threads: the lives are the same, and took longer");
            result.thread_note = Some(note);
        }
        Ok(())
    }

    /// Lives by these draws; with an error those that were finished.
    fn draw_by<S: Clone + Default, E: StdError + Send + Sync + 'static>(
        &self,
        (scale, threads): (Scale<'_, S, E>, NonZero<usize>),
        draw: &GammaDraw,
        Part { batch, all, lives, is_kept, follower }: Part<'_>,
        watch: Watch<'_>,
    ) -> Result<Numbered, (Cause, Numbered)> {
        let mut settings = self.settings.clone();
        settings.keep_cycles = false;
        let done = lives.start - all.start;
        let run = MonteCarlo { settings: &settings, draw, trajectories: lives, threads };
        let none = KnownLives::new();
        let journal = self.journal.filter(|_| is_kept);
        let known = journal.and_then(|journal| journal.lives(batch)).unwrap_or(&none);
        let keep = |ends: &[(u64, FailureEvent)]| {
            if let Some(journal) = journal {
                let path = |(number, _): &(u64, FailureEvent)| Some((*number, follower?.path(*number)?));
                journal.keep_lives(batch, &ends.iter().filter_map(path).collect::<Vec<_>>(), ends);
            }
        };
        let hear = |number: u64, cycle: u64, wear: &[f64]| {
            follower.iter().for_each(|follower| follower.hear(number, cycle, wear));
        };
        let heard: Option<Heard<'_>> = if follower.is_some() { Some(&hear) } else { None };
        let Lives { failures, ended, missing_threads } = run.go_on_heard(known, (&keep, heard), scale, watch);
        self.missing_threads.fetch_max(missing_threads, Ordering::Relaxed);
        let lives = Some((failures.len() + usize::try_from(done).unwrap_or(0), all.end - all.start));
        let cause = match ended {
            Ended::Complete => return Ok(failures),
            Ended::Cancelled => Cause::Interrupted { trajectory: None, lives },
            Ended::Stopped { trajectory, stop } => match self.cause(stop, Some(trajectory)) {
                Cause::Interrupted { trajectory, .. } => Cause::Interrupted { trajectory, lives },
                cause => cause,
            },
            Ended::Panicked { trajectory, message } => Cause::Panicked { trajectory, message },
            Ended::Survived { trajectory } => {
                Cause::CycleLimit { trajectory: Some(trajectory), cycles: settings.most_cycles, pace: None }
            }
        };
        Err((cause, failures))
    }
}
