//! The natural logarithm. Reduction to significands about 1; kernel: the minimax polynomial of FreeBSD's `e_log.c` (Sun Microsystems,
//! 1993) in f / (2 + f).
#![expect(clippy::excessive_precision, reason = "digits as published")]

use super::{LN2_HIGH, LN2_LOW};
use crate::scalar::Scalar;

/// Factor that makes subnormal numbers normal, 2^54, and its logarithm to the base 2.
const LIFT: f64 = 18_014_398_509_481_984.0;
const LIFTED_BY: f64 = 54.0;
/// The least positive number.
const LEAST: f64 = 5e-324;

/// Natural logarithm of `x`: -infinity at zero, no number below.
#[inline]
pub fn ln<T: Scalar>(x: T) -> T {
    let c = T::constant;
    let is_small = x.lt(c(f64::MIN_POSITIVE));
    let (significand, exponent) = T::select(is_small, x * c(LIFT), x).split_exponent();
    let exponent = T::select(is_small, exponent - c(LIFTED_BY), exponent);
    let is_low = significand.lt(c(core::f64::consts::SQRT_2));
    let f = T::select(is_low, significand, significand * c(0.5)) - c(1.0);
    let exponent = T::select(is_low, exponent, exponent + c(1.0));
    let s = f / (c(2.0) + f);
    let z = s * s;
    let w = z * z;
    let even = w
        * (c(3.999_999_999_940_941_908e-1)
            + w * (c(2.222_219_843_214_978_396e-1) + w * c(1.531_383_769_920_937_332e-1)));
    let odd = z
        * (c(6.666_666_666_666_735_130e-1)
            + w * (c(2.857_142_874_366_239_149e-1)
                + w * (c(1.818_357_216_161_805_012e-1) + w * c(1.479_819_860_511_658_591e-1))));
    let half_square = c(0.5) * f * f;
    let rest = s * (half_square + (even + odd)) + exponent * c(LN2_LOW);
    let value = exponent * c(LN2_HIGH) - ((half_square - rest) - f);
    // Infinite, or no number: as it came.
    let value = T::select(x.lt(c(f64::INFINITY)), value, x);
    let beyond = T::select(x.lt(c(0.0)), c(f64::NAN), c(f64::NEG_INFINITY));
    T::select(x.lt(c(LEAST)), beyond, value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::{Pair, sweep, ulps};

    #[test]
    fn one_ulp_over_the_whole_range() {
        let mut largest: f64 = 0.0;
        sweep(100_000, |unit, sign| {
            // Evenly in the exponent, subnormal numbers included; about 1; and close to 1.
            let wide = 2_f64.powf(if sign < 0.0 { -1073.0 * unit } else { 1023.9 * unit });
            for x in [wide, 0.5 + 1.5 * unit, 1.0 + sign * 2_f64.powf(-52.0 * unit - 1.0)] {
                largest = largest.max(ulps(ln(x), Pair::ln(x)));
            }
        });
        assert!(largest <= 1.0, "{largest} ulp");
    }

    #[test]
    fn special_values() {
        assert_eq!((ln(1.0), ln(f64::INFINITY)), (0.0, f64::INFINITY));
        assert_eq!((ln(0.0), ln(-0.0)), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        assert!([-5e-324, -1.0, f64::NEG_INFINITY, f64::NAN].map(ln).iter().all(|value| value.is_nan()));
    }
}
