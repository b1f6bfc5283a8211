//! What a caller hands over, and what is handed back: slices, texts, messages. The types of the standard.
#![expect(unsafe_code, reason = "pointers of a caller")]

use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr::NonNull;
use std::slice;

use crate::fault::Fault;

/// `fmi3Status`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(dead_code, reason = "all that the standard has")]
pub enum Status {
    Ok,
    Warning,
    Discard,
    Error,
    Fatal,
}

/// `fmi3LogMessageCallback`.
pub type LogMessage = Option<
    unsafe extern "C" fn(*mut c_void, status: Status, category: *const c_char, message: *const c_char),
>;

/// Where messages go.
#[derive(Clone, Copy)]
pub struct Log {
    pub environment: *mut c_void,
    pub message: LogMessage,
    /// Whether events are told, too.
    pub verbose: bool,
}

// SAFETY: the address is never followed here; it goes back to its caller's callback, from the thread that calls.
unsafe impl Send for Log {}

impl Log {
    /// Tells a message.
    pub fn tell(&self, status: Status, category: &str, message: &str) {
        let Some(call) = self.message else { return };
        // A text of a mechanism cannot end early: a zero within it is left out.
        let text = |text: &str| CString::new(text.replace('\0', "")).unwrap_or_default();
        let (category, message) = (text(category), text(message));
        // SAFETY: the caller gave the function for this, with its environment; both texts end with a zero and live longer than
        // the call.
        unsafe { call(self.environment, status, category.as_ptr(), message.as_ptr()) }
    }
}

/// So many values of a caller; none if there are none.
///
/// # Safety
/// `values` is null or points to `count` values that nobody changes while the result lives.
pub unsafe fn read<'a, T>(values: *const T, count: usize) -> Option<&'a [T]> {
    match NonNull::new(values.cast_mut()) {
        _ if count == 0 => Some(&[]),
        None => None,
        Some(_) if !values.is_aligned() || count > isize::MAX as usize / size_of::<T>().max(1) => None,
        // SAFETY: by the contract of this function; not null, aligned, no longer than memory.
        Some(_) => Some(unsafe { slice::from_raw_parts(values, count) }),
    }
}

/// Room of a caller for so many values.
///
/// # Safety
/// `values` is null or points to `count` initialised values that nobody else touches while the result lives.
pub unsafe fn write<'a, T>(values: *mut T, count: usize) -> Option<&'a mut [T]> {
    match NonNull::new(values) {
        _ if count == 0 => Some(&mut []),
        None => None,
        Some(_) if !values.is_aligned() || count > isize::MAX as usize / size_of::<T>().max(1) => None,
        // SAFETY: by the contract of this function; not null, aligned, no longer than memory.
        Some(_) => Some(unsafe { slice::from_raw_parts_mut(values, count) }),
    }
}

/// Room of a caller for one value.
///
/// # Safety
/// `place` is null or points to an initialised value that nobody else touches while the result lives.
pub unsafe fn room<'a, T>(place: *mut T) -> Option<&'a mut T> {
    // SAFETY: by the contract of this function.
    unsafe { write(place, 1) }?.first_mut()
}

/// What is told of a null pointer.
pub fn missing() -> Fault {
    Fault("a pointer is null".to_owned())
}

/// A text of a caller; none if it is null or no UTF-8.
///
/// # Safety
/// `text` is null or points to bytes that end with a zero and do not change while the result lives.
pub unsafe fn text<'a>(text: *const c_char) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: by the contract of this function; not null.
    unsafe { CStr::from_ptr(text) }.to_str().ok()
}

/// Puts a value where a caller wants it; nothing if it wants none. Whether there was a place.
///
/// # Safety
/// `place` is null or may be written to.
pub unsafe fn put<T>(place: *mut T, value: T) -> bool {
    if place.is_null() || !place.is_aligned() {
        return false;
    }
    // SAFETY: by the contract of this function; not null, aligned.
    unsafe { place.write(value) };
    true
}
