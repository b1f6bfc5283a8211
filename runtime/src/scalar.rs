//! The one scalar trait that generated code and hand-written laws are generic over.
//! Out: `Scalar`, implemented for `f64` here; lanes and dual numbers implement it too.
//! Beside it scalar and cross product. Never knows mechanisms. Every function is deterministic: same input, same bits, on every machine.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A real number as generated code sees it: arithmetic, a few smooth functions, and branch-free choice.
///
/// Angles are in rad. No method panics; domain errors give NaN.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Result of a comparison, one truth value per lane.
    type Mask: Copy;

    /// The scalar that holds `value` (in every lane, with zero derivative).
    fn constant(value: f64) -> Self;
    /// `self * factor + summand` with one rounding where the target has it; never emitted by default.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle [rad], the runtime's own polynomial.
    fn sin_cos(self) -> (Self, Self);
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Angle of the vector (`x`, `self`) in (-pi, pi] [rad].
    fn atan2(self, x: Self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The larger of two values.
    fn max(self, other: Self) -> Self;
    /// Whether `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `yes` where `mask` holds, else `no`; both are evaluated.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The largest whole number that is not above it, exact below 2^51. Its derivative is zero, as between its jumps.
    #[inline]
    fn floor(self) -> Self {
        let c = Self::constant;
        let nearest = (self + c(ROUND)) - c(ROUND);
        Self::select(self.lt(nearest), nearest - c(1.0), nearest)
    }

    /// The magnitude of `self` with the sign of `other`, zeros included; of `other` without one, as it comes.
    #[inline]
    fn with_sign_of(self, other: Self) -> Self {
        let (zero, size) = (Self::constant(0.0), self.abs());
        let inverse = Self::constant(1.0) / other;
        let is_below = Self::select(inverse.lt(zero), Self::constant(-1.0), other);
        Self::select(is_below.lt(zero), -size, size)
    }

    /// 2 to the power of `self`, a whole number from -1022 to 1023; anything, if it is no such number.
    #[inline]
    fn power_of_two(self) -> Self {
        let c = Self::constant;
        let (mut rest, mut power) = (self + c(1022.0), c(f64::MIN_POSITIVE));
        for bit in (0..=10).rev() {
            // In two factors: 2^1024 is no number.
            let (part, root) = (f64::from(1_u32 << bit), power_of_two_at(1 << bit >> 1));
            let factor = if bit == 0 { 2.0 } else { root };
            let twice = if bit == 0 { 1.0 } else { root };
            let is_left = rest.lt(c(part));
            power = Self::select(is_left, power, power * c(factor) * c(twice));
            rest = Self::select(is_left, rest, rest - c(part));
        }
        power
    }

    /// A significand in [1, 2) and the exponent of the power of two that it is multiplied by, of a positive normal number;
    /// anything, if it is no such number.
    #[inline]
    fn split_exponent(self) -> (Self, Self) {
        let c = Self::constant;
        let (mut significand, mut exponent) = (self, c(0.0));
        for part in (0..10).rev().map(|bit| 1_i32 << bit) {
            let (power, inverse) = (power_of_two_at(part), power_of_two_at(-part));
            let is_below = significand.lt(c(power));
            significand = Self::select(is_below, significand, significand * c(inverse));
            exponent = Self::select(is_below, exponent, exponent + c(f64::from(part)));
            let is_small = significand.lt(c(power_of_two_at(1 - part)));
            significand = Self::select(is_small, significand * c(power), significand);
            exponent = Self::select(is_small, exponent - c(f64::from(part)), exponent);
        }
        (significand, exponent)
    }
}

/// 2 to a power from -1022 to 1023.
fn power_of_two_at(power: i32) -> f64 {
    f64::from_bits(u64::from((power + 1023).unsigned_abs()) << 52)
}

/// Adding and subtracting 1.5 * 2^52 rounds |x| < 2^51 to the nearest whole number, ties to even.
pub(crate) const ROUND: f64 = 6_755_399_441_055_744.0;

/// Scalar product.
#[inline(always)]
pub(crate) fn dot<T: Scalar, const N: usize>(a: [T; N], b: [T; N]) -> T {
    (1..N).fold(a[0] * b[0], |sum, i| sum + a[i] * b[i])
}

/// Vector product.
#[inline(always)]
pub(crate) fn cross<T: Scalar>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
