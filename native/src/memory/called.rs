//! Functions that machine code calls: the runtime's, lane by lane, on addresses. Out: where they lie.
#![expect(unsafe_code, reason = "machine code hands over addresses; see the top of the crate")]

use linkwear_runtime::Scalar;

use crate::straight::graph::Function;

/// Where a function for `LANES` lanes lies.
pub(crate) fn address<const LANES: usize>(function: Function) -> usize {
    match function {
        Function::Exp => exp::<LANES> as *const () as usize,
        Function::Ln => ln::<LANES> as *const () as usize,
        Function::Atan2 => atan2::<LANES> as *const () as usize,
        Function::MulAdd => mul_add::<LANES> as *const () as usize,
    }
}

/// # Safety
/// `result` and every argument are addresses of `LANES` numbers, the result apart from the arguments.
unsafe fn apply<const LANES: usize, const ARGUMENTS: usize>(
    result: *mut [f64; LANES],
    arguments: [*const [f64; LANES]; ARGUMENTS],
    function: impl Fn([f64; ARGUMENTS]) -> f64,
) {
    // SAFETY: by the contract above.
    let arguments = arguments.map(|argument| unsafe { *argument });
    let values = std::array::from_fn(|lane| function(arguments.map(|argument| argument[lane])));
    // SAFETY: by the contract above.
    unsafe { *result = values };
}

/// The functions, by a calling convention.
macro_rules! called_by {
    ($convention:literal) => {
        unsafe extern $convention fn exp<const N: usize>(result: *mut [f64; N], a: *const [f64; N]) {
            // SAFETY: only machine code calls this, with addresses of whole values (invariant 5 of the crate).
            unsafe { apply(result, [a], |[a]| Scalar::exp(a)) }
        }

        unsafe extern $convention fn ln<const N: usize>(result: *mut [f64; N], a: *const [f64; N]) {
            // SAFETY: as for `exp`.
            unsafe { apply(result, [a], |[a]| Scalar::ln(a)) }
        }

        unsafe extern $convention fn atan2<const N: usize>(
            result: *mut [f64; N],
            a: *const [f64; N],
            b: *const [f64; N],
        ) {
            // SAFETY: as for `exp`.
            unsafe { apply(result, [a, b], |[a, b]| Scalar::atan2(a, b)) }
        }

        unsafe extern $convention fn mul_add<const N: usize>(
            result: *mut [f64; N],
            a: *const [f64; N],
            b: *const [f64; N],
            c: *const [f64; N],
        ) {
            // SAFETY: as for `exp`.
            unsafe { apply(result, [a, b, c], |[a, b, c]| Scalar::mul_add(a, b, c)) }
        }
    };
}

// The same convention on every system.
#[cfg(target_arch = "x86_64")]
called_by!("sysv64");
#[cfg(not(target_arch = "x86_64"))]
called_by!("C");
