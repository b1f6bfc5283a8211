//! How far a long run is: a bar on a terminal, plain lines elsewhere, always on stderr; and Ctrl-C.

use std::io::{IsTerminal, stderr};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use linkwear_runtime::Watch;

static STOP: AtomicBool = AtomicBool::new(false);

/// Does long work under a watch that shows a bar and stops it at Ctrl-C; a second Ctrl-C ends the process.
pub fn watched<T>(work: impl FnOnce(Watch<'_>) -> T) -> T {
    // It fails only if a handler is set already: then that one serves.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    });
    let progress = Mutex::new(Progress::new());
    let result = work(Watch::new(&|part| {
        progress.lock().unwrap_or_else(PoisonError::into_inner).set(part);
        go_on(part)
    }));
    progress.into_inner().unwrap_or_else(PoisonError::into_inner).finish();
    result
}

/// What a [`Watch`] without a bar calls: goes on until Ctrl-C.
pub fn go_on(_: f64) -> ControlFlow<()> {
    if stop_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Whether Ctrl-C was pressed.
pub fn stop_requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// Work shorter than this shows nothing.
const QUIET: Duration = Duration::from_millis(500);
/// Plain lines are no closer than this.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// Progress of one run.
struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
    last_line: Instant,
}

impl Progress {
    /// Starts; shows nothing yet.
    fn new() -> Self {
        let now = Instant::now();
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(1000);
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left  (Ctrl-C stops)");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Self { bar, start: now, last_line: now }
    }

    /// Shows how far it is, `fraction` in 0..1.
    fn set(&mut self, fraction: f64) {
        if self.start.elapsed() < QUIET {
            return;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 1000")]
        let thousandths = (fraction.clamp(0.0, 1.0) * 1000.0) as u64;
        if let Some(bar) = &self.bar {
            bar.set_position(thousandths);
        } else if self.last_line.elapsed() >= BETWEEN_LINES {
            self.last_line = Instant::now();
            eprintln!("{:.1} %", fraction * 100.0);
        }
    }

    /// Takes the bar away.
    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
