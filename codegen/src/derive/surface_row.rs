//! The row of a joint that holds the place of a point: `f(p) = 0`, with p seen from a point of the parent.
//! In: relative motion across the cut. Out: a [`Row`]. Never knows the tree.
//!
//! With `n` the gradient of f and H its second derivative, both in the parent's frame: the velocity residual is `n . p'`, the
//! acceleration residual `n . p'' + p' . H p'`. All of them are exact off the surface too.

use crate::expr::{Expr, Vec3};
use crate::model::{Surface, Term};

use super::geometry::Geometry;
use super::relative_motion::RelativeMotion;
use super::row::{Bias, Row};

/// The row of a surface, for relative motion at the child's point in the frame of the parent's link.
pub fn surface_row<'g>(geometry: &Geometry<'g>, motion: &RelativeMotion<'g>, surface: &Surface) -> Row<'g> {
    let g = geometry.g;
    // Axes of the equation: those of W at the reference pose.
    let own = g.matrix(geometry.linkage.frame(motion.parent.link).0);
    let symbols = Vec3(["x", "y", "z"].map(|name| g.symbol(name)));
    let of = |term: &Term| match term {
        Term::Place(axis) => symbols[*axis],
        _ => g.zero(),
    };
    let value = geometry.inputs.lower_with(&surface.equation, &of);
    let gradient = symbols.map(|symbol| value.derivative(symbol));
    let curvature = gradient.0.map(|slope| symbols.map(|symbol| slope.derivative(symbol)));
    let place = own * motion.distance;
    let at = |expression: Expr<'g>| expression.with(&[0, 1, 2].map(|i| (symbols[i], place[i])));
    let normal = own.transpose() * gradient.map(at);
    let speed = own * motion.slide;
    let bent = Vec3(curvature.map(|row| row.map(at).dot(speed)));
    let turning = 2.0 * motion.parent_omega.cross(motion.slide);
    let bias = normal.dot(motion.acceleration - turning) + bent.dot(speed);
    Row {
        meaning: "place of the point on the surface".to_owned(),
        angular: false,
        residual: at(value),
        moment: g.zero_vector(),
        force: normal,
        rate: normal.dot(motion.slide),
        bias: Bias { whole: bias, closed: bias },
    }
}
