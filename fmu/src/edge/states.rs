//! States that are kept, put back and turned into bytes.
#![expect(unsafe_code, reason = "symbols of the standard, pointers of a caller")]

use std::ffi::c_void;
use std::ptr;

use super::caller::{Status, missing, read, room, write};
use super::registry::{handle, with};
use crate::fault::Fault;
use crate::instance::kept::Kept;

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
