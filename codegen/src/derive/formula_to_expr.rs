//! Formulas of the file become expressions of the graph.
//! In: [`crate::model::Formula`]. Out: [`Expr`]. Never knows how coordinates are computed: a closure says.

use crate::expr::{Expr, Vec3};
use crate::model::{Formula, Function, Term, Value};

/// Values of parameters and time as expressions: numbers for what is folded, symbols for what stays.
#[derive(Clone, Debug)]
pub struct Inputs<'g> {
    /// One per parameter of the file, then one per input.
    pub parameters: Vec<Expr<'g>>,
    /// Inputs that drives follow, with their first and second rates in time.
    pub rates: Vec<[Expr<'g>; 3]>,
    /// Time [s].
    pub time: Expr<'g>,
}

impl<'g> Inputs<'g> {
    /// A formula over parameters and time.
    pub fn lower(&self, formula: &Formula) -> Expr<'g> {
        self.lower_with(formula, &|_| self.time.scope().zero())
    }

    /// The number of a parameter that is one; not a number if it is not.
    pub fn number(&self, parameter: usize) -> f64 {
        self.parameters[parameter].as_number().unwrap_or(f64::NAN)
    }

    /// Total derivative in time of what is over parameters, time, inputs and their first rates.
    pub fn rate(&self, of: Expr<'g>) -> Expr<'g> {
        let by_inputs =
            self.rates.iter().flat_map(|[input, first, second]| [(input, first), (first, second)]);
        by_inputs.fold(of.derivative(self.time), |sum, (input, rate)| sum + of.derivative(*input) * *rate)
    }

    /// A vector of formulas over parameters and time.
    pub fn lower3(&self, formulas: &[Formula; 3]) -> Vec3<'g> {
        Vec3::from_fn(|i| self.lower(&formulas[i]))
    }

    /// A formula that may read coordinates and speeds, which `state` looks up.
    pub fn lower_with(&self, formula: &Formula, state: &dyn Fn(&Term) -> Expr<'g>) -> Expr<'g> {
        self.term(&formula.term, state)
    }

    fn term(&self, term: &Term, state: &dyn Fn(&Term) -> Expr<'g>) -> Expr<'g> {
        let value = |term: &Term| self.term(term, state);
        match term {
            Term::Number(number) => self.time.scope().number(*number),
            Term::Parameter(id) => self.parameters[id.index()],
            Term::Time => self.time,
            Term::Neg(a) => -value(a),
            Term::Add(a, b) => value(a) + value(b),
            Term::Sub(a, b) => value(a) - value(b),
            Term::Mul(a, b) => value(a) * value(b),
            Term::Div(a, b) => value(a) / value(b),
            Term::Power(a, n) => value(a).powi(*n),
            Term::Table(table, of) => {
                let x = value(of);
                x.scope().note_row(table.row(x));
                table.of(x)
            }
            Term::Choice(parts) => {
                let [below, yes, no] = &**parts;
                value(below).below_zero(value(yes), value(no))
            }
            Term::Call(function, arguments) => {
                let arguments: Vec<Expr<'g>> = arguments.iter().map(value).collect();
                call(*function, &arguments)
            }
            Term::JointPosition(..)
            | Term::JointSpeed(..)
            | Term::PointPosition(..)
            | Term::Place(_)
            | Term::BodySpin(..)
            | Term::ForceValue(..)
            | Term::Response(_)
            | Term::State(_)
            | Term::PointSpeed(..) => state(term),
        }
    }
}

impl Value for Expr<'_> {
    fn number(self, value: f64) -> Self {
        self.scope().number(value)
    }

    fn sine(self) -> Self {
        self.sin()
    }

    fn root(self) -> Self {
        self.sqrt()
    }

    fn whole(self) -> Self {
        self.floor()
    }

    fn choose(self, yes: Self, no: Self) -> Self {
        self.below_zero(yes, no)
    }

    fn choose_quietly(self, yes: Self, no: Self) -> Self {
        self.keep_quiet();
        self.below_zero(yes, no)
    }
}

/// Functions of the file in terms of the graph's few.
fn call<'g>(function: Function, arguments: &[Expr<'g>]) -> Expr<'g> {
    let x = arguments[0];
    let one = x.scope().number(1.0);
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.sin() / x.cos(),
        Function::Asin => x.atan2((one - x.square()).sqrt()),
        Function::Acos => (one - x.square()).sqrt().atan2(x),
        Function::Atan => x.atan2(one),
        Function::Atan2 => x.atan2(arguments[1]),
        Function::Sinh => 0.5 * (x.exp() - x.exp().recip()),
        Function::Cosh => 0.5 * (x.exp() + x.exp().recip()),
        // Stays finite for large |x|.
        Function::Tanh => one - 2.0 / ((2.0 * x).exp() + one),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sqrt => x.sqrt(),
        Function::Piecewise(function) => function.of(arguments),
    }
}
