//! One operation of the graph and what it reads. Never knows the graph.

use linkwear_tape::{Binary, Unary};

use crate::id::{ExprId, SymbolId};

/// A node. Constants hold the bits of an f64, so that nodes can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Node {
    /// A number.
    Constant(u64),
    /// An input.
    Symbol(SymbolId),
    /// A function of one value.
    Unary(Unary, ExprId),
    /// A function of two values.
    Binary(Binary, ExprId, ExprId),
    /// The second where the first is below zero, else the third.
    Select(ExprId, ExprId, ExprId),
}

impl Node {
    /// The nodes that it is computed from.
    pub fn children(self) -> impl Iterator<Item = ExprId> {
        let (first, second, third) = match self {
            Self::Constant(_) | Self::Symbol(_) => (None, None, None),
            Self::Unary(_, a) => (Some(a), None, None),
            Self::Binary(_, a, b) => (Some(a), Some(b), None),
            Self::Select(a, yes, no) => (Some(a), Some(yes), Some(no)),
        };
        first.into_iter().chain(second).chain(third)
    }

    /// Shows the nodes that it is computed from, in their order.
    #[inline]
    pub fn each_child(self, mut show: impl FnMut(ExprId)) {
        match self {
            Self::Constant(_) | Self::Symbol(_) => {}
            Self::Unary(_, a) => show(a),
            Self::Binary(_, a, b) => {
                show(a);
                show(b);
            }
            Self::Select(a, yes, no) => {
                show(a);
                show(yes);
                show(no);
            }
        }
    }

    /// The same of other nodes in the places of those that it is computed from.
    #[inline]
    pub fn of(self, mut other: impl FnMut(ExprId) -> ExprId) -> Self {
        match self {
            Self::Constant(_) | Self::Symbol(_) => self,
            Self::Unary(op, a) => Self::Unary(op, other(a)),
            Self::Binary(op, a, b) => Self::Binary(op, other(a), other(b)),
            Self::Select(a, yes, no) => Self::Select(other(a), other(yes), other(no)),
        }
    }
}
