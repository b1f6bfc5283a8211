//! How a sum is to be made anew.

use super::rebuild::Rebuild;
use crate::expr::{Expr, ExprId};

/// A formula over the nodes of the old graph.
#[derive(Clone, Debug)]
pub enum Formula {
    /// What has become of an old node.
    Node(ExprId),
    /// A number.
    Number(f64),
    /// Signed terms: `true` subtracts.
    Sum(Vec<(bool, Formula)>),
    /// Factors.
    Product(Vec<Formula>),
}

impl Formula {
    /// Makes it, from the first term or factor to the last.
    pub fn make<'g>(&self, rebuild: &Rebuild<'_, 'g>) -> Expr<'g> {
        match self {
            Self::Node(id) => rebuild.get(*id),
            Self::Number(number) => rebuild.scope.number(*number),
            Self::Sum(terms) => terms.iter().fold(rebuild.scope.zero(), |sum, (negative, term)| {
                let term = term.make(rebuild);
                if *negative { sum - term } else { sum + term }
            }),
            Self::Product(factors) => factors
                .iter()
                .fold(rebuild.scope.number(1.0), |product, factor| product * factor.make(rebuild)),
        }
    }
}
