//! How far loops and their speeds may stay open, and how far their factors are trusted: one set of numbers for every projection.
//! In: how regular a position is. Out: residuals. Never closes anything.

use crate::scalar::Scalar;

/// Loops are closed up to this part of the longest lever arm, or of a radian. Projection leaves 1e-14; redundant rows
/// that a mechanism meets up to the rounding of its drawing follow with the conditioning of the position.
pub const CLOSED: f64 = 1e-7;
/// Residual of the kept rows [m, rad] after a projection; large coordinates add their own rounding.
pub const POSITION_TOLERANCE: f64 = 1e-14;

/// Residual of the kept rows' speeds after a projection, per unit of the largest speed (at least 1).
pub const SPEED_TOLERANCE: f64 = 1e-13;

/// Newton that makes no more progress below this residual [m, rad] has met rounding, not an open loop.
pub(crate) const SETTLED: f64 = 1e-11;

/// Corrections that the normal equations may be trusted with: ratio of pivots, about 1e-4 in singular values.
pub(crate) const TRUSTED_PIVOT: f64 = 1e-8;
/// Residual of positions up to which nothing is moved, by the largest coordinate.
pub(crate) fn position_tolerance<T: Scalar>(strictness: T, largest: T) -> T {
    // Rounding of a coordinate moves the loop by about its last place times an arm of a metre.
    let rounding = T::constant(f64::EPSILON) * largest.max(T::constant(1.0));
    let own = T::constant(POSITION_TOLERANCE) * strictness;
    own.max(T::constant(0.5) * rounding) + rounding * strictness
}

/// Residual of speeds up to which nothing is moved, by the largest speed and what it is for small ones.
pub(crate) fn speed_tolerance<T: Scalar>(least: T, largest: T) -> T {
    least * largest.max(T::constant(1.0))
}

/// Residuals of positions and speeds up to which nothing is moved, by the largest coordinate and speed.
#[cfg(feature = "std")]
pub(crate) fn tolerances<T: Scalar>(strictness: T, coordinate: T, speed: T) -> (T, T) {
    let (_, least) = untouched(strictness);
    (position_tolerance(strictness, coordinate), speed_tolerance(least, speed))
}

/// Residuals of positions and speeds up to which nothing is moved, whatever the coordinates' own size.
pub(crate) fn untouched<T: Scalar>(regularity: T) -> (T, T) {
    let speed = T::constant(SPEED_TOLERANCE) * regularity;
    (T::constant(POSITION_TOLERANCE) * regularity, speed.max(T::constant(0.5 * f64::EPSILON)))
}
