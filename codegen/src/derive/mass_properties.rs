//! Mass, first and second moments of a body in the frame of its link. Never knows where they come from.

use crate::expr::{Expr, Mat3, Scope, Vec3};

/// Mass, first and second moments about the link's origin, in its frame.
#[derive(Clone, Copy, Debug)]
pub struct MassProperties<'g> {
    /// Mass [kg].
    pub mass: Expr<'g>,
    /// ∫ r dm [kg m].
    pub first: Vec3<'g>,
    /// ∫ r rᵀ dm [kg m²].
    pub second: Mat3<'g>,
}

impl<'g> MassProperties<'g> {
    /// Of a link without mass.
    pub fn none(g: &'g Scope) -> Self {
        Self { mass: g.zero(), first: g.zero_vector(), second: g.matrix([[0.0; 3]; 3]) }
    }

    /// Inertia tensor about the link's origin: `tr(P) 1 - P` [kg m²].
    pub fn inertia(&self) -> Mat3<'g> {
        let second = self.second;
        let mut inertia = -second;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            inertia[i][i] = second[j][j] + second[k][k];
        }
        inertia
    }
}
