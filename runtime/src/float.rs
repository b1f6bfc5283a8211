//! `f64` as a [`Scalar`]. In: numbers. Out: numbers, the same bits on every machine.
//! Never uses the platform's mathematics library: sine and cosine are [`crate::sin_cos`], the other
//! transcendental functions come from the `libm` crate, and nothing is contracted to a fused operation.

use crate::scalar::Scalar;
use crate::sincos::sin_cos;

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
        libm::exp(self)
    }

    #[inline]
    fn ln(self) -> Self {
        libm::log(self)
    }

    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
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
}
