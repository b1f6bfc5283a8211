//! Motion: model exchange, and steps of co-simulation.
#![expect(unsafe_code, reason = "symbols of the standard, pointers of a caller")]

use std::ffi::c_void;

use super::caller::{Status, missing, put, read, write};
use super::registry::with;

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: *mut c_void,
    again: *mut bool,
    terminate: *mut bool,
    nominals: *mut bool,
    values: *mut bool,
    has_next: *mut bool,
    next: *mut f64,
) -> Status {
    with(instance, |held| {
        let moved = held.instance.update_discrete()?;
        for (place, value) in
            [(again, false), (terminate, false), (nominals, false), (values, moved), (has_next, false)]
        {
            // SAFETY: the standard has a caller give places for all of them; null is left alone.
            unsafe { put(place, value) };
        }
        // SAFETY: as above.
        unsafe { put(next, 0.0) };
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3CompletedIntegratorStep(
    instance: *mut c_void,
    _no_set_before: bool,
    enter_event_mode: *mut bool,
    terminate: *mut bool,
) -> Status {
    with(instance, |held| {
        let open = held.instance.completed_step()?;
        // SAFETY: the standard has a caller give a place; null is left alone.
        unsafe { put(enter_event_mode, open) };
        // SAFETY: as above.
        unsafe { put(terminate, false) };
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetTime(instance: *mut c_void, t: f64) -> Status {
    with(instance, |held| held.instance.set_time(t))
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetContinuousStates(
    instance: *mut c_void,
    states: *const f64,
    count: usize,
) -> Status {
    // SAFETY: the standard has a caller give null, or so many values as it says.
    let states = unsafe { read(states, count) };
    with(instance, |held| held.instance.set_states(states.ok_or_else(missing)?))
}

/// Exports functions that write as many numbers as the caller has room for.
macro_rules! numbers {
    ($($name:ident => $method:ident;)+) => {
        $(
            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name(instance: *mut c_void, values: *mut f64, count: usize) -> Status {
                // SAFETY: the standard has a caller give null, or room for so many values as it says.
                let values = unsafe { write(values, count) };
                with(instance, |held| held.instance.$method(values.ok_or_else(missing)?))
            }
        )+
    };
}

numbers! {
    fmi3GetContinuousStates => states;
    fmi3GetContinuousStateDerivatives => derivatives;
    fmi3GetNominalsOfContinuousStates => nominals;
    fmi3GetEventIndicators => indicators;
}

/// Exports functions that count.
macro_rules! counts {
    ($($name:ident => $method:ident;)+) => {
        $(
            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name(instance: *mut c_void, count: *mut usize) -> Status {
                with(instance, |held| {
                    // SAFETY: the standard has a caller give null, or a place for a number.
                    let written = unsafe { put(count, held.instance.$method()) };
                    if written { Ok(()) } else { Err(missing()) }
                })
            }
        )+
    };
}

counts! {
    fmi3GetNumberOfEventIndicators => indicator_count;
    fmi3GetNumberOfContinuousStates => state_count;
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    from: f64,
    length: f64,
    _no_set_before: bool,
    event_handling: *mut bool,
    terminate: *mut bool,
    early_return: *mut bool,
    last: *mut f64,
) -> Status {
    with(instance, |held| {
        let outcome = held.instance.step(from, length);
        for event in held.instance.take_events() {
            if held.log.verbose {
                held.log.tell(Status::Ok, "logEvents", &event);
            }
        }
        let reached = outcome?;
        for place in [event_handling, terminate, early_return] {
            // SAFETY: the standard has a caller give places for all of them; null is left alone.
            unsafe { put(place, false) };
        }
        // SAFETY: as above.
        unsafe { put(last, reached) };
        Ok(())
    })
}
