//! Sine and cosine without branches, generic over the scalar, so that every back end and every lane
//! gives the same bits. In: an angle [rad]. Out: (sine, cosine).
//!
//! Error at most 1 ulp for |x| <= 1e6; beyond that it grows with |x|, and past about 1e9 the result
//! has no correct digits (generated angles stay far below). Infinite input gives NaN.
//!
//! Reduction after Cody and Waite with plain products: pi/2 is split into words of 33 bits, so that a
//! whole number below 2^20 times a word is exact. Kernels: the minimax polynomials of FreeBSD's
//! `k_sin.c` and `k_cos.c` (Sun Microsystems, 1993), which accept the low part of the reduced angle.
#![expect(clippy::excessive_precision, reason = "digits as published")]

use crate::scalar::{ROUND, Scalar};

const TWO_OVER_PI: f64 = core::f64::consts::FRAC_2_PI;
/// First 33 bits of pi/2.
const PIO2_1: f64 = 1.570_796_326_734_125_614_17;
/// Second 33 bits of pi/2.
const PIO2_2: f64 = 6.077_100_506_303_965_976_60e-11;
/// Third 33 bits of pi/2.
const PIO2_3: f64 = 2.022_266_248_711_166_455_80e-21;
/// What is left of pi/2.
const PIO2_TAIL: f64 = 8.478_427_660_368_899_569_97e-32;

/// Sine and cosine of `x` [rad]; see the module for the error bound.
#[inline(always)]
pub fn sin_cos<T: Scalar>(x: T) -> (T, T) {
    let c = T::constant;
    let turns = (x * c(TWO_OVER_PI) + c(ROUND)) - c(ROUND);
    let (high, low) = reduce(x, turns);
    let (sine, cosine) = (kernel_sin(high, low), kernel_cos(high, low));
    // The quadrant, one of -2, -1, 0, 1, 2 (ties of the rounding go to even: both +-2 mean half a turn).
    let quadrant = turns - c(4.0) * ((turns * c(0.25) + c(ROUND)) - c(ROUND));
    let odd = (quadrant.abs() - c(1.0)).abs().lt(c(0.5));
    let sine_sign = T::select((quadrant - c(0.5)).abs().lt(c(1.0)), c(1.0), c(-1.0));
    let cosine_sign = T::select((quadrant + c(0.5)).abs().lt(c(1.0)), c(1.0), c(-1.0));
    // Both choices before both products: compilers make no branch of two that belong together, and vectors of several angles.
    let (first, second) = (T::select(odd, cosine, sine), T::select(odd, sine, cosine));
    (sine_sign * first, cosine_sign * second)
}

/// `x - turns * pi/2` as an unevaluated sum of a number in about [-pi/4, pi/4] and its low part.
#[inline(always)]
fn reduce<T: Scalar>(x: T, turns: T) -> (T, T) {
    let c = T::constant;
    // Exact: both are multiples of the same power of two and nearly equal.
    let first = x - turns * c(PIO2_1);
    let second_word = turns * c(PIO2_2);
    let second = first - second_word;
    let second_lost = (first - second) - second_word;
    let third_word = turns * c(PIO2_3);
    let third = second - third_word;
    let third_lost = (second - third) - third_word;
    let rest = (second_lost + third_lost) - turns * c(PIO2_TAIL);
    let high = third + rest;
    (high, (third - high) + rest)
}

#[inline(always)]
fn kernel_sin<T: Scalar>(x: T, low: T) -> T {
    let c = T::constant;
    let z = x * x;
    let w = z * z;
    let r = c(8.333_333_333_322_489_461_24e-3)
        + z * (c(-1.984_126_982_985_794_931_34e-4) + z * c(2.755_731_370_707_006_767_89e-6))
        + z * w * (c(-2.505_076_025_340_686_341_95e-8) + z * c(1.589_690_995_211_550_102_21e-10));
    let v = z * x;
    x - ((z * (c(0.5) * low - v * r) - low) - v * c(-1.666_666_666_666_663_243_48e-1))
}

#[inline(always)]
fn kernel_cos<T: Scalar>(x: T, low: T) -> T {
    let c = T::constant;
    let z = x * x;
    let w = z * z;
    let r = z
        * (c(4.166_666_666_666_660_190_37e-2)
            + z * (c(-1.388_888_888_887_410_957_49e-3) + z * c(2.480_158_728_947_672_941_78e-5)))
        + w * w
            * (c(-2.755_731_435_139_066_330_35e-7)
                + z * (c(2.087_572_321_298_174_827_90e-9) + z * c(-1.135_964_755_778_819_482_65e-11)));
    let half = c(0.5) * z;
    let rough = c(1.0) - half;
    rough + (((c(1.0) - rough) - half) + (z * r - x * low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::{Pair, exact_product, ulps};

    /// Taylor series of sine and cosine in double-double after an exact reduction with 4 words of pi/2.
    fn oracle(x: f64) -> (Pair, Pair) {
        let k = (x * TWO_OVER_PI).round();
        let mut r = Pair(x, 0.0);
        for word in [PIO2_1, PIO2_2, PIO2_3, PIO2_TAIL] {
            let p = exact_product(-k, word);
            r = r.plus(p);
        }
        let z = r.times(Pair(-r.0, -r.1));
        let (s, c) = (Pair::alternate_series(r, z, 1.0), Pair::alternate_series(Pair(1.0, 0.0), z, 0.0));
        let minus = |p: Pair| Pair(-p.0, -p.1);
        match (k as i64).rem_euclid(4) {
            0 => (s, c),
            1 => (c, minus(s)),
            2 => (minus(s), minus(c)),
            _ => (minus(c), s),
        }
    }

    fn worst(x: f64) -> f64 {
        let ((s, c), (exact_s, exact_c)) = (sin_cos(x), oracle(x));
        ulps(s, exact_s).max(ulps(c, exact_c))
    }

    #[test]
    fn one_ulp_on_a_dense_sweep_to_a_million() {
        let mut state = 1_u64;
        let mut largest: f64 = 0.0;
        for i in 0..400_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let unit = (state >> 11) as f64 / 9_007_199_254_740_992.0;
            // Half of them uniform, half of them uniform in the exponent down to 1e-8.
            let x = if i % 2 == 0 { 1e6 * unit } else { 10_f64.powf(14.0 * unit - 8.0) };
            largest = largest.max(worst(x)).max(worst(-x));
        }
        assert!(largest <= 1.0, "{largest} ulp");
    }

    #[test]
    fn one_ulp_beside_every_multiple_of_half_pi_to_a_million() {
        let mut largest: f64 = 0.0;
        for k in 1..=636_619_u32 {
            let x = f64::from(k) * std::f64::consts::FRAC_PI_2;
            for x in [f64::from_bits(x.to_bits() - 1), x, f64::from_bits(x.to_bits() + 1)] {
                largest = largest.max(worst(x));
            }
        }
        assert!(largest <= 1.0, "{largest} ulp");
    }

    #[test]
    fn zero_and_ties_of_the_rounding_are_exact() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        for k in -40..40 {
            // Quarter turns land on both +2 and -2 quadrants.
            let x = f64::from(k) * std::f64::consts::PI;
            let (_, cosine) = sin_cos(x);
            assert_eq!(cosine, if k % 2 == 0 { 1.0 } else { -1.0 });
        }
    }

    #[test]
    fn infinite_and_undefined_angles_give_nan() {
        for x in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let (s, c) = sin_cos(x);
            assert!(s.is_nan() && c.is_nan());
        }
    }

    #[test]
    fn bits_are_pinned() {
        // Any change of an operation's order shows here; generated code relies on these bits.
        let (s, c) = sin_cos(1.0);
        assert_eq!((s, c), (0.841_470_984_807_896_5, 0.540_302_305_868_139_8));
        let (s, c) = sin_cos(-123_456.789);
        assert_eq!((s, c), (0.998_664_082_343_224_6, 0.051_672_532_718_701_38));
    }
}
