//! From the text of a quantity or formula to a [`Formula`] in SI: reading it, the dimension it must have, and
//! whether it is finite. The pieces of a formula are resolved in [`super::term`].

use std::ops::Range;

use super::advice;
use super::resolver::{Reported, Resolver};
use crate::diagnostic::Code;
use crate::model::{Formula, Term};
use crate::source::Span;
use crate::spec::{Dimension, Expression, Form, Literal, Quantity, SyntaxError, Triple, parse_expression};

/// Largest size of a quantity in SI. Equations multiply up to six of them (a density, two radii and three lengths are
/// an inertia), and a double ends at 1e308. Nothing that is built comes near.
const LARGEST: f64 = 1e50;

/// What may occur in a formula, by the place where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    pub(super) tunable: bool,
    pub(super) time: bool,
    pub(super) state: bool,
    /// Whether a pressure may be written as a hardness, whatever place it fills.
    pub(super) hardness: bool,
    /// Names that mean something here alone, with their dimensions.
    pub(super) arguments: &'static [(&'static str, Dimension)],
}

/// Names of the coordinates of a place.
const PLACE: &[(&str, Dimension)] =
    &[("x", Dimension::LENGTH), ("y", Dimension::LENGTH), ("z", Dimension::LENGTH)];

/// Names of what a contact is like.
const CONTACT: &[(&str, Dimension)] =
    &[("pressure", Dimension::of(-1, 1, -2)), ("sliding_speed", Dimension::of(1, 0, -1))];

impl Allowed {
    /// Parameters fixed at generation.
    pub(super) const CONSTANTS: Self =
        Self { tunable: false, time: false, state: false, hardness: false, arguments: &[] };
    /// The value of a parameter that is given in place of the file's: only its use tells what it is.
    pub(super) const GIVEN: Self = Self { hardness: true, ..Self::CONSTANTS };
    /// All parameters.
    pub(super) const PARAMETERS: Self = Self { tunable: true, ..Self::CONSTANTS };
    /// Parameters, inputs and t.
    pub(super) const TIME: Self = Self { time: true, ..Self::PARAMETERS };
    /// Parameters, inputs, t, and all that an instant has: motion, accelerations, forces of joints, states.
    pub(super) const STATE: Self = Self { state: true, ..Self::TIME };
    /// All parameters and the place x, y, z of a point.
    pub(super) const PLACE: Self = Self { arguments: PLACE, ..Self::PARAMETERS };
    /// Parameters, inputs, pressure and sliding speed of a contact.
    pub(super) const CONTACT: Self = Self { arguments: CONTACT, ..Self::TIME };

    pub(super) fn list(self) -> &'static str {
        match (self.time, self.state) {
            (_, true) => {
                "parameters, inputs, t, joints, points, bodies, forces, states, sensors and controllers"
            }
            (true, false) if !self.arguments.is_empty() => {
                "parameters, inputs, `pressure` and `sliding_speed`"
            }
            (true, false) => "parameters, inputs and t",
            (false, false) if !self.arguments.is_empty() => "parameters and the place x, y, z",
            (false, false) => "parameters",
        }
    }
}

/// The text that a formula comes from, for messages.
pub(super) struct Origin<'a> {
    pub(super) quantity: &'a Quantity,
    pub(super) allowed: Allowed,
    pub(super) what: &'a str,
}

/// A piece of that text.
#[derive(Clone, Copy)]
pub(super) struct Here<'a> {
    pub(super) origin: &'a Origin<'a>,
    pub(super) range: &'a Range<usize>,
}

/// A term with its dimension, or nothing if it is wrong and reported.
pub(super) type Resolved = Option<(Term, Dimension)>;

impl Resolver<'_> {
    /// Three formulas of one dimension.
    pub(super) fn triple(
        &mut self,
        triple: &Triple,
        dimension: Dimension,
        allowed: Allowed,
        what: &str,
    ) -> [Formula; 3] {
        let items = &triple.0.value;
        if items.len() != 3 {
            self.wrong_count(triple.0.span, items.len(), "3", what);
            return std::array::from_fn(|_| Formula::number(f64::NAN, dimension));
        }
        std::array::from_fn(|at| self.formula(&items[at], Some(dimension), allowed, what))
    }

    /// The formula that `quantity` means; NaN where it is wrong, which is reported.
    /// `expected` is the dimension it must have, if that is known. `what` names the place: "`radius` of body `crank`".
    pub(super) fn formula(
        &mut self,
        quantity: &Quantity,
        expected: Option<Dimension>,
        allowed: Allowed,
        what: &str,
    ) -> Formula {
        let wrong =
            Formula { span: quantity.span, ..Formula::number(f64::NAN, expected.unwrap_or_default()) };
        let origin = Origin { quantity, allowed, what };
        let Some((term, dimension)) = self.read(&origin, expected) else { return wrong };
        if !self.check_finite(&term, &origin) {
            return wrong;
        }
        self.warn_turns_inside(quantity, what);
        Formula { term, dimension, span: quantity.span }
    }

    fn read(&mut self, origin: &Origin<'_>, expected: Option<Dimension>) -> Resolved {
        let (resolved, bare) = match &origin.quantity.value {
            Literal::Number(value) => ((Term::Number(*value), Dimension::NONE), Some(*value)),
            Literal::Text(text) => {
                let expression = match parse_expression(text, &|word| {
                    self.names.is_name(word) || origin.allowed.arguments.iter().any(|(name, _)| *name == word)
                }) {
                    Ok(expression) => expression,
                    Err(error) => {
                        self.report_syntax(origin, error);
                        return None;
                    }
                };
                self.warn_shadowed(origin, &expression);
                self.check_hardness(origin, &expression, expected)?;
                let bare = bare_number(&expression);
                (self.term(&expression, origin)?, bare)
            }
        };
        let (term, dimension) = resolved;
        let Some(expected) = expected else { return Some((term, dimension)) };
        if dimension == expected || bare == Some(0.0) {
            return Some((term, expected));
        }
        self.report_dimension(origin, bare, dimension, expected);
        None
    }

    fn report_syntax(&mut self, origin: &Origin<'_>, error: SyntaxError) {
        let code = if error.unit { Code::UnknownUnit } else { Code::FormulaSyntax };
        let message = format!("{}: {}", origin.what, error.message);
        let reported = self.refuse(code, self.span_in(origin.quantity, error.range), message);
        error.help.map(|help| reported.help(help));
    }

    fn warn_shadowed(&mut self, origin: &Origin<'_>, expression: &Expression) {
        // A plain quantity has no other reading.
        let plain = expression.quantity().is_some();
        for (unit, range) in expression.shadowed.iter().filter(|_| !plain) {
            let message =
                format!("{}: `{unit}` is read as a unit, not as the `{unit}` of this file", origin.what);
            let span = self.span_in(origin.quantity, range.clone());
            self.refuse(Code::UnitShadowsName, span, message).help(format!(
                "to divide by `{unit}`, put the quantity in brackets: `(2 m)/{unit}`; to be rid of the doubt, rename it"
            ));
        }
    }

    /// A hardness is a pressure that only a hardness can have: a modulus of 120 HB is a slip.
    fn check_hardness(
        &mut self,
        origin: &Origin<'_>,
        expression: &Expression,
        expected: Option<Dimension>,
    ) -> Option<()> {
        let is_pressure = expected == Some(Dimension::of(-1, 1, -2));
        let may_be = origin.allowed.hardness || advice::is_hardness(origin.what);
        let Some(range) = expression.hardness().filter(|_| is_pressure && !may_be) else {
            return Some(());
        };
        let help = advice::like(origin.what, expected?);
        let message = format!("{} is a hardness, but a plain pressure is needed", origin.what);
        self.refuse(Code::UnitMismatch, self.span_in(origin.quantity, range.clone()), message).help(help);
        None
    }

    fn report_dimension(
        &mut self,
        origin: &Origin<'_>,
        bare: Option<f64>,
        found: Dimension,
        expected: Dimension,
    ) {
        let span = origin.quantity.span;
        // Infinity and what is no number need no unit but another value.
        if let Some(number) = bare.filter(|number| expected != Dimension::NONE && number.is_finite()) {
            let message = format!("{} needs a unit: it is {}", origin.what, expected.description());
            let help = advice::missing_unit(origin.what, number, expected);
            self.refuse(Code::MissingUnit, span, message).help(help);
            return;
        }
        let help = match &origin.quantity.value {
            Literal::Text(text) => {
                let turning = self.turns_of(origin.quantity).of;
                let help = advice::mismatch(origin.what, text, (found, turning), expected);
                let read = self.read_again(text);
                let defined = read.and_then(|read| self.defined_in(&[&read]));
                defined.map_or_else(|| help.clone(), |defined| format!("{help}; {defined}"))
            }
            Literal::Number(_) => advice::like(origin.what, expected),
        };
        let (found, needed) = (found.description(), expected.description());
        let message = format!("{} is {found}, but {needed} is needed", origin.what);
        self.refuse(Code::UnitMismatch, span, message).help(help);
    }

    /// Where a range of the text is in the file. Texts with escapes or made by `[repeat]` have one place as a whole.
    pub(super) fn span_in(&self, quantity: &Quantity, range: Range<usize>) -> Span {
        let span = quantity.span;
        let inner = span.start + 1..span.end.saturating_sub(1);
        match &quantity.value {
            Literal::Text(text) if self.source.text.get(inner.clone()) == Some(text.as_str()) => {
                // At the end of the text the closing quote is shown.
                let end = if range.is_empty() { range.end + 1 } else { range.end };
                Span { start: inner.start + range.start, end: inner.start + end }
            }
            _ => span,
        }
    }

    pub(super) fn span_of(&self, here: Here<'_>) -> Span {
        self.span_in(here.origin.quantity, here.range.clone())
    }

    /// Reports a fault in a part of the text.
    pub(super) fn refuse_in(&mut self, here: Here<'_>, code: Code, message: &str) -> Reported<'_> {
        self.refuse(code, self.span_of(here), format!("{}: {message}", here.origin.what))
    }

    /// Reports if a part that depends on nothing but parameters is infinite or not a number, e.g. `t/(2 - 2)`.
    fn check_finite(&mut self, term: &Term, origin: &Origin<'_>) -> bool {
        let mut finite = true;
        term.visit_chosen(&self.values, &mut |part| {
            // Only leaves and what can leave the numbers; sums of finite parts are checked with the whole.
            let check = matches!(
                part,
                Term::Number(_) | Term::Div(..) | Term::Power(..) | Term::Call(..) | Term::Table(..)
            );
            if finite && check && part.value_at(&self.values, None).is_some_and(|value| !value.is_finite()) {
                finite = false;
            }
        });
        let at_start = if finite { term.value_at(&self.values, Some(0.0)) } else { None };
        if finite && at_start.is_none_or(f64::is_finite) {
            let Some(value) = at_start.filter(|value| value.abs() > LARGEST) else { return true };
            let message =
                format!("{} is {value:e} in SI: products of such numbers are infinite", origin.what);
            self.refuse(Code::NotFinite, origin.quantity.span, message)
                .help("check the exponent and the unit: nothing that is built is as large");
            return false;
        }
        let when = if finite && term.value_at(&self.values, None).is_none() { " at t = 0" } else { "" };
        let message = format!("{} is infinite or not a number{when}", origin.what);
        let mut asks_table = false;
        term.visit(&mut |part| asks_table |= matches!(part, Term::Table(..)));
        let help = if asks_table {
            "check whether the rows of its tables reach so far; `outside = \"hold\"` in a table goes on with its last value"
        } else {
            "check divisions by zero and the ranges of sqrt, ln, asin and acos"
        };
        self.refuse(Code::NotFinite, origin.quantity.span, message).help(help);
        false
    }
}

/// The number, if the whole text is a number without a unit.
fn bare_number(expression: &Expression) -> Option<f64> {
    match &expression.form {
        Form::Number { value, bare: true, .. } => Some(*value),
        Form::Neg(inner) => bare_number(inner).map(|value| -value),
        _ => None,
    }
}
