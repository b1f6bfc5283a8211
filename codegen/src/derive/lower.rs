//! Formulas of the file become expressions of the graph.
//! In: [`crate::model::Formula`]. Out: [`ExprId`]. Never knows how coordinates are computed: a closure says.

use crate::expr::{ExprId, Scope, Vec3};
use crate::model::{Formula, Function, Term};

/// Values of parameters and time as expressions: numbers for what is folded, symbols for what stays.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// One per parameter of the file.
    pub parameters: Vec<ExprId>,
    /// Time [s].
    pub time: ExprId,
}

impl Inputs {
    /// A formula over parameters and time.
    pub fn lower(&self, g: &Scope, formula: &Formula) -> ExprId {
        self.lower_with(g, formula, &mut |g, _| g.zero())
    }

    /// A vector of formulas over parameters and time.
    pub fn lower3(&self, g: &Scope, formulas: &[Formula; 3]) -> Vec3 {
        [0, 1, 2].map(|i| self.lower(g, &formulas[i]))
    }

    /// A formula that may read coordinates and speeds, which `state` looks up.
    pub fn lower_with(
        &self,
        g: &Scope,
        formula: &Formula,
        state: &mut dyn FnMut(&Scope, &Term) -> ExprId,
    ) -> ExprId {
        self.term(g, &formula.term, state)
    }

    fn term(&self, g: &Scope, term: &Term, state: &mut dyn FnMut(&Scope, &Term) -> ExprId) -> ExprId {
        match term {
            Term::Number(value) => g.constant(*value),
            Term::Parameter(id) => self.parameters[id.index()],
            Term::Time => self.time,
            Term::Neg(a) => {
                let a = self.term(g, a, state);
                g.neg(a)
            }
            Term::Add(a, b) => self.pair(g, a, b, state, Scope::add),
            Term::Sub(a, b) => self.pair(g, a, b, state, Scope::sub),
            Term::Mul(a, b) => self.pair(g, a, b, state, Scope::mul),
            Term::Div(a, b) => self.pair(g, a, b, state, Scope::div),
            Term::Power(a, n) => {
                let a = self.term(g, a, state);
                g.power(a, *n)
            }
            Term::Call(function, arguments) => {
                let arguments: Vec<ExprId> = arguments.iter().map(|a| self.term(g, a, state)).collect();
                call(g, *function, &arguments)
            }
            Term::JointPosition(..)
            | Term::JointSpeed(..)
            | Term::PointPosition(..)
            | Term::PointSpeed(..) => state(g, term),
        }
    }

    fn pair(
        &self,
        g: &Scope,
        a: &Term,
        b: &Term,
        state: &mut dyn FnMut(&Scope, &Term) -> ExprId,
        operation: fn(&Scope, ExprId, ExprId) -> ExprId,
    ) -> ExprId {
        let a = self.term(g, a, state);
        let b = self.term(g, b, state);
        operation(g, a, b)
    }
}

/// Functions of the file in terms of the graph's few.
fn call(g: &Scope, function: Function, arguments: &[ExprId]) -> ExprId {
    let x = arguments[0];
    let one = g.one();
    match function {
        Function::Sin => g.sin(x),
        Function::Cos => g.cos(x),
        Function::Tan => {
            let (sine, cosine) = (g.sin(x), g.cos(x));
            g.div(sine, cosine)
        }
        Function::Asin => {
            let other = cathetus(g, x);
            g.atan2(x, other)
        }
        Function::Acos => {
            let other = cathetus(g, x);
            g.atan2(other, x)
        }
        Function::Atan => g.atan2(x, one),
        Function::Atan2 => g.atan2(x, arguments[1]),
        Function::Sinh => hyperbolic(g, x, Scope::sub),
        Function::Cosh => hyperbolic(g, x, Scope::add),
        Function::Tanh => {
            // 1 - 2 / (exp(2 x) + 1) stays finite for large |x|.
            let two = g.constant(2.0);
            let doubled = g.mul(two, x);
            let grown = g.exp(doubled);
            let denominator = g.add(grown, one);
            let quotient = g.div(two, denominator);
            g.sub(one, quotient)
        }
        Function::Exp => g.exp(x),
        Function::Ln => g.ln(x),
        Function::Sqrt => g.sqrt(x),
    }
}

/// `sqrt(1 - x²)`.
fn cathetus(g: &Scope, x: ExprId) -> ExprId {
    let one = g.one();
    let square = g.square(x);
    let rest = g.sub(one, square);
    g.sqrt(rest)
}

fn hyperbolic(g: &Scope, x: ExprId, join: fn(&Scope, ExprId, ExprId) -> ExprId) -> ExprId {
    let up = g.exp(x);
    let down = g.reciprocal(up);
    let both = join(g, up, down);
    let half = g.constant(0.5);
    g.mul(half, both)
}
