//! The angle of a vector: its smaller component over the larger one, reduced to beside 0, 1/2 or 1 by the tangent of a difference,
//! as an unevaluated sum of two. Kernel: the minimax polynomial of FreeBSD's `s_atan.c` (Sun Microsystems, 1993).
#![expect(clippy::excessive_precision, reason = "digits as published")]

use crate::scalar::Scalar;

/// Angles as the sum of two: atan(1/2), pi/4, pi/2, pi.
const ATAN_HALF: (f64, f64) = (4.636_476_090_008_060_935_15e-1, 2.269_877_745_296_168_709_24e-17);
const EIGHTH: (f64, f64) = (core::f64::consts::FRAC_PI_4, 3.061_616_997_868_383_017_93e-17);
const QUARTER: (f64, f64) = (core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766_035_87e-17);
const HALF: (f64, f64) = (core::f64::consts::PI, 1.224_646_799_147_353_207_17e-16);

/// Tangents at which the reduction changes.
const LOW: f64 = 0.4375;
const HIGH: f64 = 0.6875;
/// Below 2^-27 the angle is its tangent.
const TINY: f64 = 7.450_580_596_923_828_125e-9;
/// 2^27 + 1 splits a number into halves whose products are exact.
const SPLIT: f64 = 134_217_729.0;
/// Beyond 2^900 and 2^-800 exact products would not be numbers; what brings them back, 2^-200 and 2^300.
const LARGE: f64 = 8.452_712_498_170_644e270;
const SMALL: f64 = 1.499_696_813_895_631_2e-241;
const DOWN: f64 = 6.223_015_277_861_142e-61;
const UP: f64 = 2.037_035_976_334_486e90;

/// Angle of the vector (`x`, `y`) from -pi to pi [rad]; zeros count by their signs, as IEEE 754 has it.
#[inline]
pub fn atan2<T: Scalar>(y: T, x: T) -> T {
    let c = T::constant;
    let (rise, run) = (y.abs(), x.abs());
    let is_steep = run.lt(rise);
    let (near, far) = comparable(T::select(is_steep, run, rise), T::select(is_steep, rise, run));
    let (high, low) = first_octant(near, far);
    let (steep_high, steep_low) = less(QUARTER, (high, low));
    let (high, low) = (T::select(is_steep, steep_high, high), T::select(is_steep, steep_low, low));
    let (back_high, back_low) = less(HALF, (high, low));
    let is_back = c(1.0).with_sign_of(x).lt(c(0.0));
    T::select(is_back, back_high + back_low, high + low).with_sign_of(y)
}

/// Both magnitudes by a common factor such that the larger one is a number far from all limits; what is not a number stays.
#[inline(always)]
fn comparable<T: Scalar>(near: T, far: T) -> (T, T) {
    let c = T::constant;
    let (is_infinite, is_zero) = (c(f64::MAX).lt(far), far.lt(c(5e-324)));
    let near = T::select(is_infinite, T::select(c(f64::MAX).lt(near), c(1.0), near * c(0.0)), near);
    let far = T::select(is_infinite, c(1.0), T::select(is_zero, c(1.0), far));
    let up = T::select(far.lt(c(SMALL)), c(UP), c(1.0));
    let factor = T::select(c(LARGE).lt(far), c(DOWN), up);
    (near * factor, far * factor)
}

/// atan(near / far) for 0 <= near <= far, as the sum of two.
#[inline(always)]
fn first_octant<T: Scalar>(near: T, far: T) -> (T, T) {
    let c = T::constant;
    let (is_low, is_middle) = (near.lt(c(LOW) * far), near.lt(c(HIGH) * far));
    let choose = |low: T, middle: T, high: T| T::select(is_low, low, T::select(is_middle, middle, high));
    // Differences of nearly equal numbers are exact; sums bring along what they lose.
    let twice = c(2.0) * far;
    let (middle, sum) = (twice + near, far + near);
    let numerator = choose(near, c(2.0) * near - far, near - far);
    let denominator = choose(far, middle, sum);
    let lost = choose(c(0.0), (twice - middle) + near, (far - sum) + near);
    let u = numerator / denominator;
    let (product, product_low) = exact_product(u, denominator);
    let u_low = (((numerator - product) - product_low) - u * lost) / denominator;
    let z = u * u;
    let rest = (u_low - u_low * z) - u * kernel(z);
    let base = choose(c(0.0), c(ATAN_HALF.0), c(EIGHTH.0));
    let base_low = choose(c(0.0), c(ATAN_HALF.1), c(EIGHTH.1));
    let high = base + u;
    let low = ((base - high) + u) + (base_low + rest);
    (high, T::select(near.lt(c(TINY) * far), c(0.0), low))
}

/// 1 - atan(u) / u, by u².
#[inline(always)]
fn kernel<T: Scalar>(z: T) -> T {
    let c = T::constant;
    let w = z * z;
    let odd = z
        * (c(3.333_333_333_333_293_180_27e-1)
            + w * (c(1.428_571_427_250_346_637_11e-1)
                + w * (c(9.090_887_133_436_506_561_96e-2)
                    + w * (c(6.661_073_137_387_531_206_69e-2)
                        + w * (c(4.976_877_994_615_932_360_17e-2)
                            + w * c(1.628_582_011_536_578_236_23e-2))))));
    let even = w
        * (c(-1.999_999_999_987_648_324_76e-1)
            + w * (c(-1.111_111_040_546_235_578_80e-1)
                + w * (c(-7.691_876_205_044_829_994_95e-2)
                    + w * (c(-5.833_570_133_790_573_486_45e-2) + w * c(-3.653_157_274_421_691_552_70e-2)))));
    odd + even
}

/// A product as the sum of two, without an operation that rounds once (Dekker).
#[inline(always)]
fn exact_product<T: Scalar>(a: T, b: T) -> (T, T) {
    let halves = |x: T| {
        let scaled = T::constant(SPLIT) * x;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let ((a_high, a_low), (b_high, b_low)) = (halves(a), halves(b));
    let product = a * b;
    (product, (((a_high * b_high - product) + a_high * b_low) + a_low * b_high) + a_low * b_low)
}

/// An angle less a smaller one, each the sum of two.
#[inline(always)]
fn less<T: Scalar>((from, from_low): (f64, f64), (high, low): (T, T)) -> (T, T) {
    let from = T::constant(from);
    let difference = from - high;
    (difference, ((from - difference) - high) + (T::constant(from_low) - low))
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;
    use crate::pair::{Pair, sweep, ulps};

    #[test]
    fn one_ulp_in_all_directions_and_at_all_lengths() {
        let mut largest: f64 = 0.0;
        sweep(100_000, |unit, sign| {
            // Evenly by angle, by the exponent of the tangent, and beside its changes.
            let angle = sign * PI * unit;
            let length = 2_f64.powf(1000.0 * (2.0 * unit - 1.0));
            let tangent = 2_f64.powf(sign * 60.0 * unit);
            let points = [
                (length * angle.sin(), length * angle.cos()),
                (-sign * tangent, sign),
                (LOW * (1.0 + 1e-3 * (unit - 0.5)), 1.0),
                (-1.0, sign * HIGH * (1.0 + 1e-3 * (unit - 0.5))),
                (1.0 - 1e-8 * unit, -1.0),
            ];
            for (y, x) in points {
                largest = largest.max(ulps(atan2(y, x), Pair::atan2(y, x)));
            }
        });
        assert!(largest <= 1.0, "{largest} ulp");
    }

    #[test]
    fn special_values() {
        let (inf, max) = (f64::INFINITY, f64::MAX);
        let exact = [
            (0.0, 1.0, 0.0),
            (0.0, 0.0, 0.0),
            (0.0, -0.0, PI),
            (0.0, -1.0, PI),
            (1.0, 0.0, FRAC_PI_2),
            (1.0, -0.0, FRAC_PI_2),
            (inf, 1.0, FRAC_PI_2),
            (inf, -1.0, FRAC_PI_2),
            (1.0, inf, 0.0),
            (1.0, -inf, PI),
            (inf, inf, FRAC_PI_4),
            (inf, -inf, 3.0 * FRAC_PI_4),
            (max, max, FRAC_PI_4),
            (5e-324, 5e-324, FRAC_PI_4),
            (5e-324, 1.0, 5e-324),
            (5e-324, max, 0.0),
            (max, 5e-324, FRAC_PI_2),
            (1e-310, 1e-2, 1e-310 / 1e-2),
            (1.0, 1.0, FRAC_PI_4),
            (1.0, -1.0, 3.0 * FRAC_PI_4),
        ];
        for (y, x, angle) in exact {
            assert_eq!(atan2(y, x).to_bits(), angle.to_bits(), "{y} {x}");
            assert_eq!(atan2(-y, x).to_bits(), (-angle).to_bits(), "{} {x}", -y);
        }
        for (y, x) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, inf), (inf, f64::NAN), (f64::NAN, 0.0)] {
            assert!(atan2(y, x).is_nan() && atan2(-y, -x).is_nan(), "{y} {x}");
        }
    }
}
