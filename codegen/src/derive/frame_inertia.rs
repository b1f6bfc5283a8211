//! Inertia that the floating frame of a flexible body has when the modes are eliminated.
//! In: [`Reduced`], modal coordinates. Out: expressions. Never knows the tree.

use crate::expr::{Expr, Mat3, Scope};
use crate::flexible::Reduced;

/// About the origin of the floating frame, in that frame: force `(even 1 + translation) a + couplingᵀ alpha`, moment
/// `coupling a + inertia alpha`.
#[derive(Clone, Copy, Debug)]
pub struct FrameInertia<'g> {
    /// Mass that all directions have [kg].
    pub even: Expr<'g>,
    /// What directions differ in [kg].
    pub translation: Mat3<'g>,
    /// [kg m].
    pub coupling: Mat3<'g>,
    /// [kg m²].
    pub inertia: Mat3<'g>,
}

impl<'g> FrameInertia<'g> {
    /// For modal coordinates `q`.
    pub fn new(g: &'g Scope, reduced: &Reduced, q: &[Expr<'g>]) -> Self {
        let diagonal = [0, 1, 2].map(|i| reduced.translation[i][i]);
        // The entry that most directions share: what is zero after it is taken out costs nothing.
        let shared = |entry: f64| diagonal.iter().filter(|other| **other == entry).count();
        let even = diagonal
            .into_iter()
            .fold(diagonal[0], |best, entry| if shared(entry) > shared(best) { entry } else { best });
        let mut uneven = reduced.translation;
        (0..3).for_each(|i| uneven[i][i] -= even);
        let coupling = g.matrix(reduced.coupling) + g.weighted_matrices(&reduced.coupling_by, q);
        let mut inertia = g.matrix(reduced.inertia) + g.weighted_matrices(&reduced.inertia_by, q);
        for (k, row) in reduced.inertia_by_products.iter().enumerate() {
            for (l, coefficient) in row.iter().enumerate() {
                inertia += g.weighted_matrices(&[*coefficient], &[q[k] * q[l]]);
            }
        }
        // One triangle, mirrored, so that it is symmetric to the bit.
        let inertia = Mat3::from_fn(|i, j| inertia[i.min(j)][i.max(j)]);
        Self { even: g.number(even), translation: g.matrix(uneven), coupling, inertia }
    }
}
