//! Functions of the standard that do something.
#![expect(unsafe_code, reason = "symbols of the standard, pointers of a caller")]

use std::ffi::{c_char, c_void};
use std::panic::catch_unwind;
use std::path::Path;
use std::ptr;

use super::caller::{Log, LogMessage, Status, put, read, room, text, write};
use super::registry::{enter, handle, leave, with};
use crate::fault::Fault;
use crate::instance::kept::Kept;
use crate::instance::{Instance, Interface, Times};
use crate::loaded::Loaded;

fn missing() -> Fault {
    Fault("a pointer is null".to_owned())
}

/// What an instance is made with.
struct Wanted {
    token: *const c_char,
    resources: *const c_char,
    interface: Interface,
    log: Log,
}

/// Makes an instance. Null, and a message, if there is none to be had.
///
/// # Safety
/// Both texts are null or end with a zero.
unsafe fn instantiate(wanted: Wanted) -> *mut c_void {
    let Wanted { token, resources, interface, log } = wanted;
    // SAFETY: by the contract of this function.
    let token = unsafe { text(token) };
    // SAFETY: by the contract of this function.
    let resources = unsafe { text(resources) };
    let made = catch_unwind(|| {
        let folder = resources.ok_or("there is no path of resources")?;
        let loaded = Loaded::from_resources(Path::new(folder))?;
        if token != Some(&*loaded.unit.instantiation_token) {
            return Err("the instantiation token is that of another unit".to_owned());
        }
        Ok((Instance::new(loaded, interface), loaded))
    });
    match made {
        Ok(Ok((instance, loaded))) => {
            if let (Some(reason), true) = (&loaded.refusal, log.verbose) {
                log.tell(Status::Ok, "logEvents", &format!("the equations are interpreted: {reason}"));
            }
            enter(instance, log)
        }
        Ok(Err(reason)) => {
            log.tell(Status::Error, "logStatusError", &reason);
            ptr::null_mut()
        }
        Err(_) => {
            log.tell(Status::Error, "logStatusError", "a mistake in linkwear itself: please report it");
            ptr::null_mut()
        }
    }
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    logging: bool,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    with(instance, |held| {
        if count > 0 && categories.is_null() {
            return Err(missing());
        }
        held.log.verbose = logging;
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    verbose: bool,
    environment: *mut c_void,
    message: LogMessage,
) -> *mut c_void {
    let log = Log { environment, message, verbose };
    // SAFETY: the standard has a caller give texts that end with a zero, or null.
    unsafe { instantiate(Wanted { token, resources, interface: Interface::ModelExchange, log }) }
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    verbose: bool,
    events: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    message: LogMessage,
    _intermediate_update: *const c_void,
) -> *mut c_void {
    let log = Log { environment, message, verbose };
    // SAFETY: the standard has a caller give texts that end with a zero, or null.
    unsafe { instantiate(Wanted { token, resources, interface: Interface::CoSimulation { events }, log }) }
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    leave(instance);
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    has_tolerance: bool,
    tolerance: f64,
    start: f64,
    has_stop: bool,
    stop: f64,
) -> Status {
    let times =
        Times { start, stop: has_stop.then_some(stop), tolerance: has_tolerance.then_some(tolerance) };
    with(instance, |held| held.instance.enter_initialization(times))
}

/// Exports functions of an instance alone.
macro_rules! of_instance {
    ($($name:ident => $method:ident;)+) => {
        $(
            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void) -> Status {
                with(instance, |held| held.instance.$method())
            }
        )+
    };
}

of_instance! {
    fmi3ExitInitializationMode => exit_initialization;
    fmi3EnterEventMode => enter_event_mode;
    fmi3EnterStepMode => enter_step_mode;
    fmi3EnterContinuousTimeMode => enter_continuous_time;
    fmi3Terminate => terminate;
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3Reset(instance: *mut c_void) -> Status {
    with(instance, |held| {
        held.instance.reset();
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3EvaluateDiscreteStates(instance: *mut c_void) -> Status {
    with(instance, |_| Ok(()))
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    variables: *const u32,
    count: usize,
    values: *mut f64,
    values_count: usize,
) -> Status {
    // SAFETY: the standard has a caller give null, or so many values as it says.
    let variables = unsafe { read(variables, count) };
    // SAFETY: as above.
    let values = unsafe { write(values, values_count) };
    with(instance, |held| held.instance.get(variables.ok_or_else(missing)?, values.ok_or_else(missing)?))
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    variables: *const u32,
    count: usize,
    values: *const f64,
    values_count: usize,
) -> Status {
    // SAFETY: the standard has a caller give null, or so many values as it says.
    let variables = unsafe { read(variables, count) };
    // SAFETY: as above.
    let values = unsafe { read(values, values_count) };
    with(instance, |held| held.instance.set(variables.ok_or_else(missing)?, values.ok_or_else(missing)?))
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, state: *mut *mut c_void) -> Status {
    // SAFETY: the standard has a caller give null, or a place for a state.
    let place = unsafe { room(state) };
    with(instance, |held| {
        let place = place.ok_or_else(missing)?;
        let kept = held.instance.keep();
        // A state that exists is taken over, as the standard has it.
        let known = held.kept.get_mut(&place.addr());
        match known {
            Some(known) => *known = kept,
            None => {
                held.kept.insert(held.next, kept);
                *place = handle(held.next);
                held.next += 1;
            }
        }
        Ok(())
    })
}

fn no_state() -> Fault {
    Fault("there is no such state of this instance".to_owned())
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetFMUState(instance: *mut c_void, state: *mut c_void) -> Status {
    with(instance, |held| {
        let kept = held.kept.get(&state.addr()).ok_or_else(no_state)?;
        held.instance.put_back(kept)
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeFMUState(instance: *mut c_void, state: *mut *mut c_void) -> Status {
    // SAFETY: the standard has a caller give null, or the place of a state.
    let place = unsafe { room(state) };
    with(instance, |held| {
        // Null where a state is expected is no mistake.
        let Some(place) = place else { return Ok(()) };
        if !place.is_null() {
            held.kept.remove(&place.addr()).ok_or_else(no_state)?;
        }
        *place = ptr::null_mut();
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut c_void,
    state: *mut c_void,
    size: *mut usize,
) -> Status {
    // SAFETY: the standard has a caller give null, or a place for the size.
    let place = unsafe { room(size) };
    with(instance, |held| {
        let kept = held.kept.get(&state.addr()).ok_or_else(no_state)?;
        *place.ok_or_else(missing)? = kept.to_bytes().len();
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the standard has a caller give null, or so many bytes as it says.
    let written = unsafe { write(bytes, size) };
    with(instance, |held| {
        let kept = held.kept.get(&state.addr()).ok_or_else(no_state)?.to_bytes();
        let written = written.ok_or_else(missing)?.get_mut(..kept.len());
        written
            .ok_or_else(|| Fault("there is too little room for the state".to_owned()))?
            .copy_from_slice(&kept);
        Ok(())
    })
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> Status {
    // SAFETY: the standard has a caller give null, or so many bytes as it says.
    let bytes = unsafe { read(bytes, size) };
    // SAFETY: the standard has a caller give null, or a place for a state.
    let place = unsafe { room(state) };
    with(instance, |held| {
        let place = place.ok_or_else(missing)?;
        let kept =
            Kept::from_bytes(bytes.ok_or_else(missing)?).map_err(|damage| Fault(damage.to_string()))?;
        held.kept.insert(held.next, kept);
        *place = handle(held.next);
        held.next += 1;
        Ok(())
    })
}

/// Exports both ways of differentiating.
macro_rules! derivatives {
    ($($name:ident => $method:ident;)+) => {
        $(
            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name(
                instance: *mut c_void,
                unknowns: *const u32,
                unknown_count: usize,
                knowns: *const u32,
                known_count: usize,
                seed: *const f64,
                seed_count: usize,
                sensitivity: *mut f64,
                sensitivity_count: usize,
            ) -> Status {
                // SAFETY: the standard has a caller give null, or so many values as it says.
                let unknowns = unsafe { read(unknowns, unknown_count) };
                // SAFETY: as above.
                let knowns = unsafe { read(knowns, known_count) };
                // SAFETY: as above.
                let seed = unsafe { read(seed, seed_count) };
                // SAFETY: as above.
                let sensitivity = unsafe { write(sensitivity, sensitivity_count) };
                with(instance, |held| {
                    let variables = (unknowns.ok_or_else(missing)?, knowns.ok_or_else(missing)?);
                    let sensitivity = sensitivity.ok_or_else(missing)?;
                    held.instance.$method(variables, seed.ok_or_else(missing)?, sensitivity)
                })
            }
        )+
    };
}

derivatives! {
    fmi3GetDirectionalDerivative => directional;
    fmi3GetAdjointDerivative => adjoint;
}

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
