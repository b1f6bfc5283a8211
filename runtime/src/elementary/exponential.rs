//! The exponential. Reduction by multiples of ln 2; kernel: the minimax polynomial of FreeBSD's `e_exp.c` (Sun Microsystems, 1993),
//! a rational function of the reduced argument.
#![expect(clippy::excessive_precision, reason = "digits as published")]

use super::{LN2_HIGH, LN2_LOW};
use crate::scalar::Scalar;

/// Adding and subtracting 1.5 * 2^52 rounds |x| < 2^51 to the nearest whole number.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// From here on results are infinite, or zero.
const MOST: f64 = 720.0;
const LEAST: f64 = -760.0;

/// e to the power of `x`.
#[inline]
pub fn exp<T: Scalar>(x: T) -> T {
    let c = T::constant;
    // What is not a number passes both comparisons.
    let x = T::select(c(MOST).lt(x), c(MOST), T::select(x.lt(c(LEAST)), c(LEAST), x));
    let (value, power) = reduced(x);
    // In two powers of two: results reach from 2^-1074 to 2^1024. The first product is exact.
    let half = (power * c(0.5) + c(ROUND)) - c(ROUND);
    value * half.power_of_two() * (power - half).power_of_two()
}

/// The same bits for |x| up to 700, where results are normal numbers, in three quarters of the operations; anything beyond.
#[inline]
pub fn exp_of_moderate<T: Scalar>(x: T) -> T {
    let (value, power) = reduced(x);
    value * power.power_of_two()
}

/// A number from 0.7 to 1.5, and the power of two that it is to be multiplied by.
#[inline]
fn reduced<T: Scalar>(x: T) -> (T, T) {
    let c = T::constant;
    let power = (x * c(core::f64::consts::LOG2_E) + c(ROUND)) - c(ROUND);
    let high = x - power * c(LN2_HIGH);
    let low = power * c(LN2_LOW);
    let r = high - low;
    let t = r * r;
    let p = c(1.666_666_666_666_660_190_37e-1)
        + t * (c(-2.777_777_777_701_559_338_42e-3)
            + t * (c(6.613_756_321_437_934_361_17e-5)
                + t * (c(-1.653_390_220_546_525_153_90e-6) + t * c(4.138_136_797_057_238_460_39e-8))));
    let rest = r - t * p;
    (c(1.0) - ((low - (r * rest) / (c(2.0) - rest)) - high), power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::{Pair, sweep, ulps};

    #[test]
    fn one_ulp_over_the_whole_range() {
        let mut largest: f64 = 0.0;
        sweep(200_000, |unit, sign| {
            // Evenly up to where results are infinite or zero, and close to zero.
            let (wide, small) =
                (if sign < 0.0 { -745.1 * unit } else { 709.7 * unit }, sign * 2_f64.powf(-60.0 * unit));
            for x in [wide, small] {
                largest = largest.max(ulps(exp(x), Pair::exp(x)));
            }
        });
        assert!(largest <= 1.0, "{largest} ulp");
    }

    #[test]
    fn moderate_arguments_have_the_same_bits() {
        sweep(200_000, |unit, sign| {
            for x in [sign * 700.0 * unit, -40.0 * unit, sign * 2_f64.powf(-60.0 * unit)] {
                assert_eq!(exp_of_moderate(x).to_bits(), exp(x).to_bits(), "{x}");
            }
        });
        assert_eq!((exp_of_moderate(0.0), exp_of_moderate(-0.0)), (1.0, 1.0));
    }

    #[test]
    fn special_values() {
        assert_eq!((exp(0.0), exp(-0.0), exp(5e-324)), (1.0, 1.0, 1.0));
        assert_eq!((exp(f64::INFINITY), exp(f64::NEG_INFINITY)), (f64::INFINITY, 0.0));
        assert_eq!(
            (exp(709.79), exp(1e308), exp(-746.0), exp(-1e308)),
            (f64::INFINITY, f64::INFINITY, 0.0, 0.0)
        );
        assert_eq!(exp(-745.0), 5e-324);
        assert!(exp(709.78) < f64::INFINITY);
        assert!(exp(f64::NAN).is_nan());
    }
}
