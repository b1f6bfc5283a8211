//! How far a long run is: a bar on a terminal, plain lines elsewhere, always on stderr; and Ctrl-C with its
//! like, SIGTERM and SIGHUP.

use std::io::{IsTerminal, stderr};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::remark::remark;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use linkwear_runtime::Watch;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Whether nobody would look at [`STOP`]: then a signal ends the process.
static UNHEARD: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

static STOP: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| {
    let stop = Arc::new(AtomicBool::new(false));
    let hang_up = (!ignores_hang_up()).then_some(HANG_UP).flatten();
    for signal in [SIGINT, SIGTERM].into_iter().chain(hang_up) {
        // In this order: the second one of them ends the process. A system that refuses ends it by the first.
        let _ = flag::register_conditional_default(signal, Arc::clone(&UNHEARD))
            .and_then(|_| flag::register_conditional_shutdown(signal, 1, Arc::clone(&stop)))
            .and_then(|_| flag::register(signal, Arc::clone(&stop)));
    }
    stop
});

/// The terminal has gone.
#[cfg(unix)]
const HANG_UP: Option<i32> = Some(signal_hook::consts::SIGHUP);
#[cfg(not(unix))]
const HANG_UP: Option<i32> = None;

/// Whether the run was started to outlive its terminal (`nohup`): the first bit of the ignored signals.
fn ignores_hang_up() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let bits = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    bits.is_some_and(|bits| bits & 1 == 1)
}

/// Does long work under a watch that shows a bar and stops it at Ctrl-C, SIGTERM or SIGHUP; a second one of them ends
/// the process. `stage` is what the work begins with, in a word; it may say others as it goes on.
pub fn watched<T>(stage: &'static str, work: impl FnOnce(Watch<'_>) -> T) -> T {
    LazyLock::force(&STOP);
    UNHEARD.store(false, Ordering::Relaxed);
    let progress = Mutex::new(Progress::new(stage));
    let shown = || progress.lock().unwrap_or_else(PoisonError::into_inner);
    // Calls left before the next look. Threads may count a call twice or not at all: a step is shorter than a lock.
    let left = AtomicU32::new(0);
    let hear = |part| {
        match left.load(Ordering::Relaxed) {
            0 => left.store(shown().set(part), Ordering::Relaxed),
            calls => left.store(calls - 1, Ordering::Relaxed),
        }
        go_on(part)
    };
    let begin = |stage| {
        shown().begin(stage);
        left.store(0, Ordering::Relaxed);
    };
    let result = work(Watch::new(&hear).with_stages(&begin));
    progress.into_inner().unwrap_or_else(PoisonError::into_inner).finish();
    result
}

/// What a [`Watch`] without a bar calls: goes on until Ctrl-C or its like.
pub fn go_on(_: f64) -> ControlFlow<()> {
    if stop_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Whether Ctrl-C was pressed, or the system asked to end.
pub fn stop_requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// While it lives, the first signal that would end the process does not.
pub(crate) struct Held {
    /// Whether signals end it again afterwards; else they are for who asks [`stop_requested`].
    ends: bool,
}

impl Held {
    pub fn new() -> Self {
        let is_first = LazyLock::get(&STOP).is_none();
        LazyLock::force(&STOP);
        Self { ends: UNHEARD.swap(false, Ordering::Relaxed) || is_first }
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        if self.ends {
            UNHEARD.store(true, Ordering::Relaxed);
        }
    }
}

/// Work shorter than this shows nothing.
const QUIET: Duration = Duration::from_millis(500);
/// The clock is looked at about so often: steps of a run are much shorter.
const LOOK: Duration = Duration::from_millis(5);
/// Calls without a look at the clock, at most.
const MOST_CALLS: u32 = 16;
/// Plain lines are no closer than this.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// A plain line of a stage after so long in it: two digits at least, so that a slow run can be told from one that stands still.
fn line(stage: &str, fraction: f64, elapsed: Duration) -> String {
    let percent = fraction * 100.0;
    let small = if percent > 0.0 { percent.clamp(1e-6, 1.0) } else { 1.0 };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and 7")]
    let digits = (1.0 - small.log10().floor()) as usize;
    let rest = Duration::try_from_secs_f64(elapsed.as_secs_f64() * (1.0 / fraction - 1.0));
    let rest = rest.map_or_else(|_| String::new(), |rest| format!(", about {} left", HumanDuration(rest)));
    format!("{stage} {percent:.digits$} %{rest}")
}

/// Progress of one run.
struct Progress {
    bar: Option<ProgressBar>,
    stage: &'static str,
    /// When the stage began.
    start: Instant,
    last_line: Instant,
    last_look: Instant,
    /// Calls without a look at the clock.
    calls: u32,
}

impl Progress {
    /// Starts; shows nothing yet.
    fn new(stage: &'static str) -> Self {
        let now = Instant::now();
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(1000);
            let style =
                ProgressStyle::with_template("{msg} {bar:40} {percent:>3} %  {eta} left  (Ctrl-C stops)");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())).with_message(stage)
        });
        Self { bar, stage, start: now, last_line: now, last_look: now, calls: 0 }
    }

    /// Another stage, which counts from 0 again.
    fn begin(&mut self, stage: &'static str) {
        if self.stage == stage {
            return;
        }
        (self.stage, self.start) = (stage, Instant::now());
        if let Some(bar) = &self.bar {
            bar.set_message(stage);
            bar.set_position(0);
            bar.reset_eta();
        }
    }

    /// Shows how far it is, `fraction` in 0..1. How many calls may go by before the next.
    fn set(&mut self, fraction: f64) -> u32 {
        let now = Instant::now();
        let seldom = now.duration_since(self.last_look) >= LOOK;
        self.calls = if seldom { self.calls / 2 } else { (2 * self.calls + 1).min(MOST_CALLS) };
        self.last_look = now;
        if now.duration_since(self.start) < QUIET {
            return self.calls;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 1000")]
        let thousandths = (fraction.clamp(0.0, 1.0) * 1000.0) as u64;
        if let Some(bar) = &self.bar {
            bar.set_position(thousandths);
        } else if self.last_line.elapsed() >= BETWEEN_LINES {
            self.last_line = Instant::now();
            remark(&line(self.stage, fraction, self.start.elapsed()));
        }
        self.calls
    }

    /// Takes the bar away.
    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_and_how_long_still() {
        let after = Duration::from_secs(10);
        assert_eq!(line("table", 0.25, after), "table 25.0 %, about 30 seconds left");
        assert_eq!(line("lives", 0.000_123, after), "lives 0.012 %, about 23 hours left");
        assert_eq!(line("run", 0.0, after), "run 0.0 %");
    }

    #[test]
    fn another_stage_counts_from_its_own_begin() {
        let mut progress = Progress::new("table");
        let began = progress.start;
        progress.begin("table");
        assert_eq!(progress.start, began);
        progress.begin("lives");
        assert!(progress.stage == "lives" && progress.start > began);
    }
}
