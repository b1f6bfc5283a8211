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
}

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
