//! Functions of the standard for what these units do not have: other types than numbers, clocks, structural parameters, scheduled
//! execution. They touch nothing of the caller's and say that they are not supported.
#![expect(unsafe_code, reason = "symbols of the standard")]

use std::ffi::{c_char, c_void};

use super::caller::Status;
use super::registry::with;
use crate::fault::Fault;

/// Exports functions that are not supported; those whose second number is a count of variables have an answer for none.
macro_rules! unsupported {
    ($($name:ident($($argument:ident: $Type:ty),*) $because:literal;)+) => {
        $(
            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void $(, $argument: $Type)*) -> Status {
                $(let _ = $argument;)*
                with(instance, |_| Err(Fault(concat!(stringify!($name), " is not supported: ", $because).to_owned())))
            }
        )+
    };
}

/// Exports functions for values of a type that no variable has.
macro_rules! without_variables {
    ($($get:ident $set:ident $Type:ty;)+) => {
        $(
            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            extern "C" fn $get(instance: *mut c_void, _: *const u32, count: usize, _: *mut $Type, _: usize) -> Status {
                none_of(instance, stringify!($get), count)
            }

            // SAFETY: no other symbol of this library is called so.
            #[unsafe(no_mangle)]
            extern "C" fn $set(instance: *mut c_void, _: *const u32, count: usize, _: *const $Type, _: usize) -> Status {
                none_of(instance, stringify!($set), count)
            }
        )+
    };
}

/// Asking for no variables is no mistake.
fn none_of(instance: *mut c_void, name: &str, count: usize) -> Status {
    with(instance, |_| match count {
        0 => Ok(()),
        _ => Err(Fault(format!("{name}: no variable of this unit has this type"))),
    })
}

without_variables! {
    fmi3GetFloat32 fmi3SetFloat32 f32;
    fmi3GetInt8 fmi3SetInt8 i8;
    fmi3GetUInt8 fmi3SetUInt8 u8;
    fmi3GetInt16 fmi3SetInt16 i16;
    fmi3GetUInt16 fmi3SetUInt16 u16;
    fmi3GetInt32 fmi3SetInt32 i32;
    fmi3GetUInt32 fmi3SetUInt32 u32;
    fmi3GetInt64 fmi3SetInt64 i64;
    fmi3GetUInt64 fmi3SetUInt64 u64;
    fmi3GetBoolean fmi3SetBoolean bool;
    fmi3GetString fmi3SetString *const c_char;
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetBinary(
    instance: *mut c_void,
    _: *const u32,
    count: usize,
    _: *mut usize,
    _: *mut *const u8,
    _: usize,
) -> Status {
    none_of(instance, "fmi3GetBinary", count)
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetBinary(
    instance: *mut c_void,
    _: *const u32,
    count: usize,
    _: *const usize,
    _: *const *const u8,
    _: usize,
) -> Status {
    none_of(instance, "fmi3SetBinary", count)
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetClock(instance: *mut c_void, _: *const u32, count: usize, _: *mut bool) -> Status {
    none_of(instance, "fmi3GetClock", count)
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetClock(instance: *mut c_void, _: *const u32, count: usize, _: *const bool) -> Status {
    none_of(instance, "fmi3SetClock", count)
}

unsupported! {
    fmi3GetNumberOfVariableDependencies(variable: u32, count: *mut usize) "dependencies do not change";
    fmi3GetVariableDependencies(
        dependent: u32, elements: *mut usize, independents: *mut u32, others: *mut usize, kinds: *mut i32, count: usize
    ) "dependencies do not change";
    fmi3EnterConfigurationMode() "there are no structural parameters";
    fmi3ExitConfigurationMode() "there are no structural parameters";
    fmi3GetIntervalDecimal(variables: *const u32, count: usize, intervals: *mut f64, qualifiers: *mut i32)
        "there are no clocks";
    fmi3GetIntervalFraction(
        variables: *const u32, count: usize, counters: *mut u64, resolutions: *mut u64, qualifiers: *mut i32
    ) "there are no clocks";
    fmi3GetShiftDecimal(variables: *const u32, count: usize, shifts: *mut f64) "there are no clocks";
    fmi3GetShiftFraction(variables: *const u32, count: usize, counters: *mut u64, resolutions: *mut u64)
        "there are no clocks";
    fmi3SetIntervalDecimal(variables: *const u32, count: usize, intervals: *const f64) "there are no clocks";
    fmi3SetIntervalFraction(variables: *const u32, count: usize, counters: *const u64, resolutions: *const u64)
        "there are no clocks";
    fmi3SetShiftDecimal(variables: *const u32, count: usize, shifts: *const f64) "there are no clocks";
    fmi3SetShiftFraction(variables: *const u32, count: usize, counters: *const u64, resolutions: *const u64)
        "there are no clocks";
    fmi3GetOutputDerivatives(
        variables: *const u32, count: usize, orders: *const i32, values: *mut f64, values_count: usize
    ) "columns have no derivatives by time here";
    fmi3ActivateModelPartition(clock: u32, t: f64) "it belongs to scheduled execution";
}

// SAFETY: no other symbol of this library is called so.
#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution(
    _: *const c_char,
    _: *const c_char,
    _: *const c_char,
    _: bool,
    _: bool,
    _: *mut c_void,
    _: *const c_void,
    _: *const c_void,
    _: *const c_void,
    _: *const c_void,
) -> *mut c_void {
    std::ptr::null_mut()
}
