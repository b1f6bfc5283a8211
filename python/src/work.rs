//! Long work beside the interpreter: the global lock is free, Ctrl-C is heard, progress is told. In: work. Out: its result, or the
//! exception that ended it.

use std::io;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use linkwear_runtime::Watch;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often Ctrl-C and progress are looked at: soon enough for a person.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of the thread that works, as that of a program.
const STACK: usize = 8 << 20;

/// Work that asks a watch now and then: it ends soon after Ctrl-C. `progress` is called with the part that is done.
pub fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(Watch<'_>) -> T + Send,
) -> PyResult<T> {
    let (stop, part) = (AtomicBool::new(false), AtomicU64::new(0));
    let watch = |done: f64| {
        part.store(done.to_bits(), Ordering::Relaxed);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    py.detach(|| {
        scope(|scope| {
            let (end, ended) = channel::<()>();
            let worker = Builder::new().stack_size(STACK).spawn_scoped(scope, || {
                // Dropped when the work ends, however it does.
                let _end = end;
                work(Watch::new(&watch))
            });
            let worker = worker.map_err(no_thread)?;
            let mut raised = None;
            while ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                let looked = Python::attach(|py| {
                    py.check_signals()?;
                    let done = f64::from_bits(part.load(Ordering::Relaxed));
                    progress.map_or(Ok(()), |progress| progress.call1(py, (done,)).map(drop))
                });
                if let Err(error) = looked {
                    stop.store(true, Ordering::Relaxed);
                    raised.get_or_insert(error);
                }
            }
            let result = worker.join().map_err(|_| PyRuntimeError::new_err("the library panicked: a bug"));
            raised.map_or(result, Err)
        })
    })
}

/// Work that cannot be asked to end: after Ctrl-C it is left alone, and its result is dropped.
pub fn abandoned<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    py.detach(|| {
        let (hand_over, handed) = channel();
        let worker = Builder::new().stack_size(STACK).spawn(move || drop(hand_over.send(work())));
        worker.map_err(no_thread)?;
        loop {
            match handed.recv_timeout(LOOK) {
                Ok(result) => return Ok(result),
                Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("the library panicked: a bug"));
                }
            }
        }
    })
}

fn no_thread(error: io::Error) -> PyErr {
    PyRuntimeError::new_err(format!("the system gives no thread: {error}"))
}
