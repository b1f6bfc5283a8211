//! Values of variables, and their derivatives by each other.
#![expect(unsafe_code, reason = "symbols of the standard, pointers of a caller")]

use std::ffi::c_void;

use super::caller::{Status, missing, read, write};
use super::registry::with;

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
