//! A factor on a wear coefficient as steps of the runtime. In: its formula. Out: [`Step`]s. Never knows contacts.

use std::collections::HashMap;

use linkwear_runtime::wear::Step;

use crate::expr::{Binary, Expr, ExprId, Node, Scope, Unary};
use crate::model::{Term, WearFactor};

use super::formula_to_expr::Inputs;

/// The steps of a factor; none if it has a function that steps do not have.
pub fn steps(inputs: &Inputs<'_>, wear: &WearFactor) -> Vec<Step> {
    let scope = Scope::new();
    let given: Vec<Expr<'_>> =
        (0..2 + wear.live.len()).map(|at| scope.symbol(format!("given{at}"))).collect();
    let parameter = |at: usize| match wear.live.iter().position(|id| id.index() == at) {
        Some(place) => given[2 + place],
        None => scope.number(inputs.number(at)),
    };
    let own = Inputs {
        parameters: (0..inputs.parameters.len()).map(parameter).collect(),
        rates: Vec::new(),
        time: scope.zero(),
    };
    let factor = own.lower_with(&wear.formula, &|term| match term {
        Term::Place(at) => given[*at],
        _ => scope.zero(),
    });
    let nodes = scope.nodes(&[factor.id()]);
    let places: HashMap<ExprId, usize> = nodes.iter().enumerate().map(|(at, (id, _))| (*id, at)).collect();
    nodes.iter().map(|(_, node)| step(*node, &|id| places[&id])).collect::<Option<_>>().unwrap_or_default()
}

fn step(node: Node, at: &dyn Fn(ExprId) -> usize) -> Option<Step> {
    Some(match node {
        Node::Constant(bits) => Step::Number(f64::from_bits(bits)),
        Node::Symbol(symbol) => Step::Given(symbol.index()),
        Node::Unary(function, a) => {
            let step = match function {
                Unary::Neg => Step::Neg,
                Unary::Sqrt => Step::Sqrt,
                Unary::Sin => Step::Sin,
                Unary::Cos => Step::Cos,
                Unary::Exp => Step::Exp,
                Unary::Ln => Step::Ln,
                Unary::Floor => Step::Floor,
                Unary::LogCoefficient(_) => return None,
            };
            step(at(a))
        }
        Node::Binary(function, a, b) => {
            let step = match function {
                Binary::Add => Step::Add,
                Binary::Sub => Step::Sub,
                Binary::Mul => Step::Mul,
                Binary::Div => Step::Div,
                Binary::Atan2 => Step::Atan2,
                Binary::AngleOverSine => return None,
            };
            step(at(a), at(b))
        }
        Node::Select(a, yes, no) => Step::Select(at(a), at(yes), at(no)),
    })
}
