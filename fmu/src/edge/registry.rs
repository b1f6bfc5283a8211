//! Instances by number. In: handles of a caller, which are never followed. Out: the instance, or that there is none.
#![expect(unsafe_code, reason = "an instance goes from thread to thread")]

use std::collections::BTreeMap;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::sync::{Arc, Mutex, PoisonError};

use super::caller::{Log, Status};
use crate::fault::Fault;
use crate::instance::Instance;
use crate::instance::kept::Kept;

/// An instance with what its caller keeps in it.
pub struct Held {
    pub instance: Instance,
    pub log: Log,
    /// States by number.
    pub kept: BTreeMap<usize, Kept>,
    pub next: usize,
}

// SAFETY: what keeps an instance from other threads are references to the equations of its unit, which are machine code or
// tapes that nobody writes to any more and that live as long as the process. The mutex lets in one thread at a time.
unsafe impl Send for Held {}

type Shared = Arc<Mutex<Held>>;

static INSTANCES: Mutex<(usize, BTreeMap<usize, Shared>)> = Mutex::new((0, BTreeMap::new()));

/// Takes an instance in. Its handle.
pub fn enter(instance: Instance, log: Log) -> *mut c_void {
    let held = Held { instance, log, kept: BTreeMap::new(), next: 1 };
    let mut all = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner);
    all.0 += 1;
    let number = all.0;
    all.1.insert(number, Arc::new(Mutex::new(held)));
    handle(number)
}

/// Lets an instance go.
pub fn leave(handle: *mut c_void) {
    let gone = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).1.remove(&handle.addr());
    // Dropped without holding up the others.
    drop(gone);
}

/// A number that looks like a pointer.
pub fn handle(number: usize) -> *mut c_void {
    ptr::without_provenance_mut(number)
}

/// Does something with an instance; a fault goes to its messages.
pub fn with(handle: *mut c_void, work: impl FnOnce(&mut Held) -> Result<(), Fault>) -> Status {
    let found = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).1.get(&handle.addr()).cloned();
    let Some(found) = found else { return Status::Error };
    let (outcome, log) = {
        // A callback that calls back into its own instance would wait for itself.
        let Ok(mut held) = found.try_lock().or_else(|error| match error {
            std::sync::TryLockError::Poisoned(poisoned) => Ok(poisoned.into_inner()),
            std::sync::TryLockError::WouldBlock => Err(()),
        }) else {
            return Status::Error;
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| work(&mut held)));
        (outcome, held.log)
    };
    match outcome {
        Ok(Ok(())) => Status::Ok,
        Ok(Err(Fault(reason))) => {
            log.tell(Status::Error, "logStatusError", &reason);
            Status::Error
        }
        Err(_) => {
            log.tell(Status::Error, "logStatusError", "a mistake in linkwear itself: please report it");
            Status::Error
        }
    }
}
