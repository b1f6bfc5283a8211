//! An instance from its making to its end, and its modes.
#![expect(unsafe_code, reason = "symbols of the standard, pointers of a caller")]

use std::ffi::{c_char, c_void};
use std::panic::catch_unwind;
use std::path::Path;
use std::ptr;

use super::caller::{Log, LogMessage, Status, missing, text};
use super::registry::{enter, leave, with};
use crate::instance::{Instance, Interface, Times};
use crate::loaded::Loaded;

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
