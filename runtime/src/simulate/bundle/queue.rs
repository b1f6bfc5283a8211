//! Turns asked for from other threads. In: requests, from as many threads as there are lives at a time. Out: answers, the same
//! bits whichever lanes were free. Never knows what the turns are for.
//!
//! A life goes on when its turn is done: each is lived on a thread of its own, which sleeps while its turn runs in a lane.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, TryRecvError, channel, sync_channel};
use std::time::Duration;

use super::{LOOKS_EVERY, TurnBundle, TurnOutcome};
use crate::error::RunError;
use crate::simulate::turns::{TurnMeasures, TurnRunner, TurnState};
use crate::watch::Watch;

/// How long a thread sleeps before it asks whether its turn is still wanted.
const ASKED_EVERY: Duration = Duration::from_millis(100);

/// Where turns are asked for.
#[derive(Clone, Debug)]
pub struct TurnQueue(Sender<Request>);

/// What was asked for there.
#[derive(Debug)]
pub struct TurnRequests(Receiver<Request>);

#[derive(Debug)]
struct Request {
    from: TurnState,
    looked_at: Option<Vec<f64>>,
    answer: SyncSender<TurnOutcome>,
    is_unwanted: Arc<AtomicBool>,
}

/// A queue, and its end for a [`TurnBundle`].
pub fn turn_queue() -> (TurnQueue, TurnRequests) {
    let (sender, receiver) = channel();
    (TurnQueue(sender), TurnRequests(receiver))
}

impl TurnQueue {
    /// As [`TurnRunner::measure`], in a lane. What cannot be run there, the runner runs.
    ///
    /// # Errors
    /// As [`TurnRunner::measure`].
    pub fn measure(&self, runner: &mut TurnRunner<'_>, watch: Watch<'_>) -> Result<TurnMeasures, RunError> {
        let from = runner.state();
        let t = from.t;
        let looked_at = runner.looks();
        let is_unwanted = Arc::new(AtomicBool::new(false));
        let (answer, answered) = sync_channel(1);
        let request =
            Request { from, looked_at: looked_at.clone(), answer, is_unwanted: Arc::clone(&is_unwanted) };
        if self.0.send(request).is_err() {
            return runner.measure(watch);
        }
        loop {
            match answered.recv_timeout(ASKED_EVERY) {
                Ok(TurnOutcome::Done(done)) => {
                    let (measures, state) = *done;
                    runner.go_on(&state, looked_at)?;
                    return Ok(measures);
                }
                Err(RecvTimeoutError::Timeout) if watch.report(0.0).is_break() => {
                    is_unwanted.store(true, Ordering::Relaxed);
                    return Err(RunError::Interrupted { t });
                }
                Err(RecvTimeoutError::Timeout) => {}
                Ok(TurnOutcome::Alone) | Err(RecvTimeoutError::Disconnected) => return runner.measure(watch),
            }
        }
    }
}

impl<const N: usize> TurnBundle<'_, N> {
    /// Runs what is asked for until nobody can ask any more.
    pub fn serve(&mut self, TurnRequests(requests): TurnRequests) {
        let mut asked: [Option<Request>; N] = std::array::from_fn(|_| None);
        let mut steps = 0;
        loop {
            while let Some(lane) = self.free_lane() {
                let request = if self.is_idle() {
                    let Ok(request) = requests.recv() else { return };
                    request
                } else {
                    match requests.try_recv() {
                        Ok(request) => request,
                        Err(TryRecvError::Empty | TryRecvError::Disconnected) => break,
                    }
                };
                match self.begin(lane, &request.from, request.looked_at.clone()) {
                    Ok(true) => asked[lane] = Some(request),
                    // Who runs it alone hears why it cannot begin.
                    Ok(false) | Err(_) => answer(request, TurnOutcome::Alone),
                }
            }
            self.step(&mut |lane, outcome| {
                if let Some(request) = asked[lane].take() {
                    answer(request, outcome);
                }
            });
            steps += 1;
            if steps % LOOKS_EVERY == 0 {
                for (lane, request) in asked.iter_mut().enumerate() {
                    if request.as_ref().is_some_and(|request| request.is_unwanted.load(Ordering::Relaxed)) {
                        *request = None;
                        self.cancel(lane);
                    }
                }
            }
        }
    }
}

/// Who does not wait any more does not hear it.
fn answer(request: Request, outcome: TurnOutcome) {
    let _ = request.answer.send(outcome);
}
