//! Formulas with names resolved: what the text of a file means, before it becomes a symbolic graph.
//! In: parsed text with resolved names. Out: [`Formula`]. Never knows the graph.

use crate::id::{JointId, ParameterId, PointId};
use crate::source::Span;
use crate::spec::Dimension;

/// A formula in SI with its dimension.
#[derive(Clone, Debug)]
pub struct Formula {
    /// The tree.
    pub term: Term,
    /// Dimension of its value.
    pub dimension: Dimension,
    /// Where it is written.
    pub span: Span,
}

/// A node of a formula. All values in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// A number in SI.
    Number(f64),
    /// A parameter.
    Parameter(ParameterId),
    /// Time [s].
    Time,
    /// Position of a joint coordinate [rad or m].
    JointPosition(JointId, usize),
    /// Speed of a joint coordinate [rad/s or m/s].
    JointSpeed(JointId, usize),
    /// Component (0, 1, 2) of a point's position in W [m].
    PointPosition(PointId, usize),
    /// Component of a point's velocity in W [m/s].
    PointSpeed(PointId, usize),
    /// Coordinate (0, 1, 2) of the place that a surface is an equation of [m].
    Place(usize),
    /// `-a`.
    Neg(Box<Self>),
    /// `a + b`.
    Add(Box<Self>, Box<Self>),
    /// `a - b`.
    Sub(Box<Self>, Box<Self>),
    /// `a * b`.
    Mul(Box<Self>, Box<Self>),
    /// `a / b`.
    Div(Box<Self>, Box<Self>),
    /// `a ^ n`.
    Power(Box<Self>, i32),
    /// A smooth function.
    Call(Function, Vec<Self>),
}

/// The functions a formula may call: all of them smooth on their domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "named as in mathematics")]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
}

impl Formula {
    /// A number without a place in a file.
    pub fn number(value: f64, dimension: Dimension) -> Self {
        Self { term: Term::Number(value), dimension, span: Span::default() }
    }

    /// Value with the given parameter values (SI, all parameters in file order).
    /// `None` if it depends on time, coordinates or speeds.
    pub fn value(&self, parameters: &[f64]) -> Option<f64> {
        self.term.value_at(parameters, None)
    }

    /// Value at time `t` [s] with the given parameter values.
    /// `None` if it depends on coordinates or speeds.
    pub fn value_at_time(&self, parameters: &[f64], t: f64) -> Option<f64> {
        self.term.value_at(parameters, Some(t))
    }

    /// Whether a tunable parameter occurs, by `is_tunable`.
    pub fn depends_on(&self, is_tunable: &dyn Fn(ParameterId) -> bool) -> bool {
        let mut found = false;
        self.term.visit(&mut |term| {
            if let Term::Parameter(id) = term {
                found |= is_tunable(*id);
            }
        });
        found
    }
}

impl Term {
    /// Calls `action` for this term and all below.
    pub fn visit(&self, action: &mut dyn FnMut(&Self)) {
        action(self);
        match self {
            Self::Neg(a) | Self::Power(a, _) => a.visit(action),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) => {
                a.visit(action);
                b.visit(action);
            }
            Self::Call(_, arguments) => arguments.iter().for_each(|a| a.visit(action)),
            _ => {}
        }
    }

    /// Number of terms.
    pub fn size(&self) -> usize {
        let mut size = 0;
        self.visit(&mut |_| size += 1);
        size
    }

    /// Value with these parameters and this time [s], if known.
    pub(in crate::model) fn value_at(&self, p: &[f64], t: Option<f64>) -> Option<f64> {
        Some(match self {
            Self::Number(x) => *x,
            Self::Time => t?,
            Self::Parameter(id) => p[id.index()],
            Self::Neg(a) => -a.value_at(p, t)?,
            Self::Add(a, b) => a.value_at(p, t)? + b.value_at(p, t)?,
            Self::Sub(a, b) => a.value_at(p, t)? - b.value_at(p, t)?,
            Self::Mul(a, b) => a.value_at(p, t)? * b.value_at(p, t)?,
            Self::Div(a, b) => a.value_at(p, t)? / b.value_at(p, t)?,
            Self::Power(a, n) => a.value_at(p, t)?.powi(*n),
            Self::Call(function, arguments) => {
                let x = arguments[0].value_at(p, t)?;
                match function {
                    Function::Sin => x.sin(),
                    Function::Cos => x.cos(),
                    Function::Tan => x.tan(),
                    Function::Asin => x.asin(),
                    Function::Acos => x.acos(),
                    Function::Atan => x.atan(),
                    Function::Atan2 => x.atan2(arguments[1].value_at(p, t)?),
                    Function::Sinh => x.sinh(),
                    Function::Cosh => x.cosh(),
                    Function::Tanh => x.tanh(),
                    Function::Exp => x.exp(),
                    Function::Ln => x.ln(),
                    Function::Sqrt => x.sqrt(),
                }
            }
            _ => return None,
        })
    }
}
