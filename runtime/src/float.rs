//! `f64` as a [`Scalar`]. In: numbers. Out: numbers, the same bits on every machine.
//! Never uses the platform's mathematics library: sine and cosine are [`crate::sin_cos`], the other
//! transcendental functions those of [`crate::elementary`], and nothing is contracted to a fused operation.

use crate::elementary::{atan2, exp, ln};
use crate::scalar::Scalar;
use crate::sincos::sin_cos;

/// 1.5 * 2^52: whole numbers added to it are its lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// 2^52: its significand is free for whole numbers.
const WHOLE: f64 = 4_503_599_627_370_496.0;
/// Bits of the significand.
const SIGNIFICAND: u64 = (1 << 52) - 1;

impl Scalar for f64 {
    type Mask = bool;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        libm::fma(self, factor, summand)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // Both are correctly rounded, so the feature does not change bits.
        #[cfg(feature = "std")]
        return Self::sqrt(self);
        #[cfg(not(feature = "std"))]
        return libm::sqrt(self);
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos(self)
    }

    #[inline]
    fn exp(self) -> Self {
        exp(self)
    }

    #[inline]
    fn ln(self) -> Self {
        ln(self)
    }

    #[inline]
    fn atan2(self, x: Self) -> Self {
        atan2(self, x)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // Not `f64::max`, whose choice between the two zeros is left open.
        if self < other { other } else { self }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn with_sign_of(self, other: Self) -> Self {
        self.copysign(other)
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        // The sum has the biased exponent as its lowest bits.
        Self::from_bits((self + (ROUND + 1023.0)).to_bits() << 52)
    }

    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = self.to_bits();
        let significand = Self::from_bits(bits & SIGNIFICAND | 1.0_f64.to_bits());
        (significand, Self::from_bits(bits >> 52 | WHOLE.to_bits()) - (WHOLE + 1023.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;

    /// By comparisons alone, as scalars do it that know nothing of bits.
    fn plain(value: f64) -> Dual<f64> {
        Dual::new(value, 0.0)
    }

    #[test]
    fn signs_are_those_of_plain_arithmetic() {
        for size in [0.0, 1.5, -2.0, f64::INFINITY] {
            for other in [0.0, -0.0, 5e-324, -5e-324, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
                let value = plain(size).with_sign_of(plain(other)).value;
                assert_eq!(value.to_bits(), Scalar::with_sign_of(size, other).to_bits(), "{size} {other}");
            }
        }
    }

    #[test]
    fn powers_of_two_and_exponents_are_those_of_plain_arithmetic() {
        for power in -1022..=1023 {
            let number = f64::from(power);
            let value = number.power_of_two();
            assert_eq!(value, plain(number).power_of_two().value);
            assert_eq!(value, libm::scalbn(1.0, power));
            for significand in [1.0, 1.0 + f64::EPSILON, 1.5, 2.0 - f64::EPSILON] {
                let split = (value * significand).split_exponent();
                assert_eq!(split, (significand, number));
                let (a, b) = plain(value * significand).split_exponent();
                assert_eq!((a.value, b.value), split);
            }
        }
    }
}
