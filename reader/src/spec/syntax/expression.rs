//! A formula in pieces, each with its place in the text.

use std::ops::Range;

use crate::spec::dimension::Dimension;
use crate::spec::turning::Turning;

/// An operator between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "named as in arithmetic")]
pub enum Operator {
    Add,
    Sub,
    Mul,
    Div,
}

/// A comparison of two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    Greater,
    /// `>=`
    AtLeast,
}

/// What a piece of a formula is.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A number in SI; `bare` without a unit.
    Number {
        /// Value in SI.
        value: f64,
        /// Its dimension.
        dimension: Dimension,
        /// Turns and angles in its unit.
        turning: Turning,
        /// No unit is written.
        bare: bool,
        /// The unit counts hardness.
        hardness: bool,
    },
    /// A parameter, `t` or `pi`.
    Name(String),
    /// `R4.q`.
    Member(String, String),
    /// `-a`.
    Neg(Box<Expression>),
    /// `a + b` and the like.
    Binary(Operator, Box<Expression>, Box<Expression>),
    /// `a ^ n`.
    Power(Box<Expression>, i32),
    /// `sin(a)`.
    Call(String, Vec<Expression>),
    /// `a < b`, the first argument of `if`.
    Compare(Relation, Box<[Expression; 2]>),
}

/// A piece of a formula and its place in the text, in bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// What it is.
    pub form: Form,
    /// Where it stands.
    pub range: Range<usize>,
    /// Units that are names of the file too, hence perhaps misread; only at the root.
    pub shadowed: Vec<(String, Range<usize>)>,
}

impl Expression {
    /// Value in SI and dimension, if the whole is one quantity, perhaps with a sign.
    pub fn quantity(&self) -> Option<(f64, Dimension)> {
        match &self.form {
            Form::Number { value, dimension, .. } => Some((*value, *dimension)),
            Form::Neg(inner) => inner.quantity().map(|(value, dimension)| (-value, dimension)),
            _ => None,
        }
    }
}

impl Expression {
    /// Where a hardness is written in it, as `120 HB`.
    pub fn hardness(&self) -> Option<&Range<usize>> {
        match &self.form {
            Form::Number { hardness, .. } => hardness.then_some(&self.range),
            Form::Name(_) | Form::Member(..) => None,
            Form::Neg(inner) | Form::Power(inner, _) => inner.hardness(),
            Form::Binary(_, left, right) => left.hardness().or_else(|| right.hardness()),
            Form::Call(_, arguments) => arguments.iter().find_map(Self::hardness),
            Form::Compare(_, both) => both.iter().find_map(Self::hardness),
        }
    }
}

/// Why a formula cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Where [bytes of the text].
    pub range: Range<usize>,
    /// The fault is in a unit.
    pub unit: bool,
}

pub(super) fn fault(message: impl Into<String>, range: Range<usize>) -> SyntaxError {
    SyntaxError { message: message.into(), help: None, range, unit: false }
}

impl SyntaxError {
    pub(super) fn advise(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}
