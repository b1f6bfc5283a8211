//! One scalar constraint of a cut. Never knows how it is derived.

use crate::expr::{Expr, Vec3};

/// One scalar constraint of a cut.
pub struct Row<'g> {
    /// What it forbids, for people.
    pub meaning: String,
    /// Residual in rad (else in m).
    pub angular: bool,
    /// Position residual.
    pub residual: Expr<'g>,
    /// Moment of the unit wrench on the child about its joint point, common frame.
    pub moment: Vec3<'g>,
    /// Force of the unit wrench on the child, common frame.
    pub force: Vec3<'g>,
    /// Velocity residual.
    pub rate: Expr<'g>,
    /// Acceleration residual for the accelerations that `Motion` was built with.
    pub bias: Expr<'g>,
}
