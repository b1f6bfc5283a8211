//! One scalar constraint of a cut. Never knows how it is derived.

use crate::expr::{Expr, Vec3};

/// Acceleration residual of a row for the accelerations that `Motion` was built with.
#[derive(Clone, Copy)]
pub struct Bias<'g> {
    /// At any state. Near a singular position the accelerations have its errors multiplied, so mechanisms that nothing drives, which
    /// pass such positions, need this form.
    pub whole: Expr<'g>,
    /// At closed states: without relative velocities that the rows forbid. Of these a run has what its projections leave, rounding or
    /// a small part of the tolerance.
    pub closed: Expr<'g>,
}

impl<'g> Bias<'g> {
    pub fn of(self, closed: bool) -> Expr<'g> {
        if closed { self.closed } else { self.whole }
    }
}

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
    /// Acceleration residual.
    pub bias: Bias<'g>,
}
