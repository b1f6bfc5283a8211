//! Formulas with names resolved: what the text of a file means, before it becomes a symbolic graph.
//! In: parsed text with resolved names. Out: [`Formula`]. Never knows the graph.

use std::sync::Arc;

use super::piecewise::{Piecewise, SMOOTH};
use super::response::Response;
use super::table::DataTable;
use crate::id::{BodyId, ForceId, JointId, ParameterId, PointId, StateId};
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
    /// Component of a body's angular velocity in W [rad/s].
    BodySpin(BodyId, usize),
    /// Value of a force element, by its place among [`crate::spec::Told::columns`].
    ForceValue(ForceId, usize),
    /// What only the solution of the instant tells.
    Response(Response),
    /// A state variable of the file's own.
    State(StateId),
    /// Argument of the formula: a coordinate (0, 1, 2) of the place that a surface is an equation of [m]; pressure [Pa] or sliding
    /// speed [m/s] of a contact.
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
    /// A function.
    Call(Function, Vec<Self>),
    /// The second where the first is below zero, else the third.
    Choice(Box<[Self; 3]>),
    /// Value of a table.
    Table(Arc<DataTable>, Box<Self>),
}

/// The functions a formula may call: smooth on their domain but for the last, which have pieces.
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
    Piecewise(Piecewise),
}

impl Formula {
    /// A number without a place in a file.
    pub fn number(value: f64, dimension: Dimension) -> Self {
        Self { term: Term::Number(value), dimension, span: Span::default() }
    }

    /// Whether it stands for one that is wrong, which is reported: it is no number then.
    pub(crate) fn is_wrong(&self) -> bool {
        matches!(self.term, Term::Number(value) if value.is_nan())
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

    /// Whether it asks for accelerations or forces of joints.
    pub fn asks_for_responses(&self) -> bool {
        let mut found = false;
        self.term.visit(&mut |term| found |= matches!(term, Term::Response(_)));
        found
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
            Self::Neg(a) | Self::Power(a, _) | Self::Table(_, a) => a.visit(action),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) => {
                a.visit(action);
                b.visit(action);
            }
            Self::Call(_, arguments) => arguments.iter().for_each(|a| a.visit(action)),
            Self::Choice(parts) => parts.iter().for_each(|a| a.visit(action)),
            _ => {}
        }
    }

    /// The same with numbers for its arguments.
    pub(in crate::model) fn with_arguments(&self, values: &[f64]) -> Self {
        let of = |term: &Self| term.with_arguments(values);
        let boxed = |term: &Self| Box::new(of(term));
        match self {
            Self::Place(at) => Self::Number(values.get(*at).copied().unwrap_or(f64::NAN)),
            Self::Neg(a) => Self::Neg(boxed(a)),
            Self::Add(a, b) => Self::Add(boxed(a), boxed(b)),
            Self::Sub(a, b) => Self::Sub(boxed(a), boxed(b)),
            Self::Mul(a, b) => Self::Mul(boxed(a), boxed(b)),
            Self::Div(a, b) => Self::Div(boxed(a), boxed(b)),
            Self::Power(a, n) => Self::Power(boxed(a), *n),
            Self::Table(table, a) => Self::Table(table.clone(), boxed(a)),
            Self::Choice(parts) => Self::Choice(Box::new([of(&parts[0]), of(&parts[1]), of(&parts[2])])),
            Self::Call(function, arguments) => Self::Call(*function, arguments.iter().map(of).collect()),
            _ => self.clone(),
        }
    }

    /// The same, but of choices that are known with these parameters only the side that is taken.
    pub(in crate::model) fn visit_chosen(&self, p: &[f64], action: &mut dyn FnMut(&Self)) {
        action(self);
        match self {
            Self::Neg(a) | Self::Power(a, _) | Self::Table(_, a) => a.visit_chosen(p, action),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) => {
                a.visit_chosen(p, action);
                b.visit_chosen(p, action);
            }
            Self::Call(_, arguments) => arguments.iter().for_each(|a| a.visit_chosen(p, action)),
            Self::Choice(parts) => {
                let [below, yes, no] = &**parts;
                below.visit_chosen(p, action);
                match below.value_at(p, None) {
                    Some(below) if below < 0.0 => yes.visit_chosen(p, action),
                    Some(_) => no.visit_chosen(p, action),
                    // Which side counts is decided at run time: what is wrong with one may never be asked for.
                    None => {}
                }
            }
            _ => {}
        }
    }

    /// The last derivative by time that is continuous for sure, and the function that is least so; `moves` says which leaves
    /// change with time.
    pub(in crate::model) fn continuity(&self, moves: &dyn Fn(&Self) -> bool) -> (i32, &'static str) {
        let least = |parts: &[&Self]| {
            let all = parts.iter().map(|part| part.continuity(moves));
            all.min_by_key(|(order, _)| *order).unwrap_or((SMOOTH, ""))
        };
        let is_moving = |part: &Self| {
            let mut found = false;
            part.visit(&mut |leaf| found |= moves(leaf));
            found
        };
        match self {
            Self::Neg(a) | Self::Power(a, _) => a.continuity(moves),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) => least(&[a, b]),
            Self::Call(function, arguments) => {
                let inner = least(&arguments.iter().collect::<Vec<_>>());
                match function {
                    Function::Piecewise(own)
                        if own.continuity() < inner.0 && arguments.iter().any(is_moving) =>
                    {
                        (own.continuity(), own.name())
                    }
                    _ => inner,
                }
            }
            Self::Table(table, of) => {
                let inner = of.continuity(moves);
                if table.continuity() < inner.0 && is_moving(of) {
                    (table.continuity(), table.kind())
                } else {
                    inner
                }
            }
            Self::Choice(parts) if is_moving(&parts[0]) => (-1, "if"),
            Self::Choice(parts) => least(&[&parts[1], &parts[2]]),
            _ => (SMOOTH, ""),
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
            Self::Table(table, of) => table.of(of.value_at(p, t)?),
            Self::Choice(parts) => {
                let [below, yes, no] = &**parts;
                let side = if below.value_at(p, t)? < 0.0 { yes } else { no };
                side.value_at(p, t)?
            }
            Self::Call(Function::Piecewise(function), arguments) => {
                let values: Option<Vec<f64>> = arguments.iter().map(|a| a.value_at(p, t)).collect();
                function.of(&values?)
            }
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
                    Function::Piecewise(function) => function.of(&[x]),
                }
            }
            _ => return None,
        })
    }
}
