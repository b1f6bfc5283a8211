//! The one scalar trait that generated code and hand-written laws are generic over.
//! In: nothing. Out: `Scalar`, implemented for `f64` here; lanes and dual numbers implement it too.
//! Never knows mechanisms. Every function is deterministic: same input, same bits, on every machine.

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
impl Scalar for f64 {
    type Mask = bool;
    fn constant(v: f64) -> f64 { v }
    fn mul_add(self, a: f64, b: f64) -> f64 { self * a + b }
    fn sqrt(self) -> f64 { f64::sqrt(self) }
    fn sin_cos(self) -> (f64, f64) { f64::sin_cos(self) }
    fn exp(self) -> f64 { f64::exp(self) }
    fn ln(self) -> f64 { f64::ln(self) }
    fn atan2(self, x: f64) -> f64 { f64::atan2(self, x) }
    fn abs(self) -> f64 { f64::abs(self) }
    fn max(self, o: f64) -> f64 { f64::max(self, o) }
    fn lt(self, o: f64) -> bool { self < o }
    fn select(m: bool, a: f64, b: f64) -> f64 { if m { a } else { b } }
}
