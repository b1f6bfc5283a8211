//! What kinds of force elements tell of themselves, for columns and formulas. In: link motion. Out: the values of
//! [`Told::columns`]. Never knows names.

use crate::expr::Expr;
use crate::model::Force;
use crate::spec::Told;

use super::line::{Line, Taut};
use super::motion::Motion;
use super::mount::Mount;

/// The values of an element's columns, in their order.
pub fn force_values<'g>(element: &Force, motion: &Motion<'g>) -> Vec<Expr<'g>> {
    match element.kind.told {
        Told::Nothing => Vec::new(),
        Told::Pull => pull(element, motion),
        Told::Wrench => Mount::new(element, motion).in_ground(motion).into_iter().flatten().collect(),
    }
}

fn pull<'g>(element: &Force, motion: &Motion<'g>) -> Vec<Expr<'g>> {
    let line = Line::new(element, motion);
    let taut = Taut::new(element, motion, &line);
    vec![taut.force, line.length]
}
