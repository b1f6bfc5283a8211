//! From the text of a quantity or formula to a [`Formula`] in SI: names, dimensions, and what may occur where.

use std::ops::Range;

use super::Resolver;
use super::names::Thing;
use crate::diagnostic::{Code, Diagnostic};
use crate::id::{JointId, ParameterId};
use crate::model::{Formula, Function, Term};
use crate::source::Span;
use crate::spec::{Dimension, Expression, Form, Literal, Operator, Quantity, SyntaxError, parse_expression};

/// What may occur in a formula, by the place where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    tunable: bool,
    time: bool,
    state: bool,
}

impl Allowed {
    /// Parameters fixed at generation.
    pub(super) const CONSTANTS: Self = Self { tunable: false, time: false, state: false };
    /// All parameters.
    pub(super) const PARAMETERS: Self = Self { tunable: true, time: false, state: false };
    /// Parameters and t.
    pub(super) const TIME: Self = Self { tunable: true, time: true, state: false };
    /// Parameters, t, joint coordinates, points, and their speeds.
    pub(super) const STATE: Self = Self { tunable: true, time: true, state: true };

    fn list(self) -> &'static str {
        match (self.time, self.state) {
            (_, true) => "parameters, t, joint coordinates and points",
            (true, false) => "parameters and t",
            (false, false) => "parameters",
        }
    }
}

const FUNCTIONS: &[(&str, Function)] = &[
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("asin", Function::Asin),
    ("acos", Function::Acos),
    ("atan", Function::Atan),
    ("atan2", Function::Atan2),
    ("sinh", Function::Sinh),
    ("cosh", Function::Cosh),
    ("tanh", Function::Tanh),
    ("exp", Function::Exp),
    ("ln", Function::Ln),
    ("sqrt", Function::Sqrt),
];

/// The text that a formula comes from, for messages.
pub(super) struct Origin<'a> {
    quantity: &'a Quantity,
    allowed: Allowed,
    what: &'a str,
}

/// A term with its dimension, or nothing if it is wrong and reported.
type Resolved = Option<(Term, Dimension)>;

impl Resolver<'_> {
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
        Formula { term, dimension, span: quantity.span }
    }

    fn read(&mut self, origin: &Origin<'_>, expected: Option<Dimension>) -> Resolved {
        let (resolved, bare) = match &origin.quantity.value {
            Literal::Number(value) => ((Term::Number(*value), Dimension::NONE), Some(*value)),
            Literal::Text(text) => {
                let expression = match parse_expression(text, &|word| self.names.is_name(word)) {
                    Ok(expression) => expression,
                    Err(error) => {
                        self.report_syntax(origin, error);
                        return None;
                    }
                };
                self.warn_shadowed(origin, &expression);
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
        let diagnostic = Diagnostic::new(code, message).at(self.span_in(origin.quantity, error.range), "");
        self.report(match error.help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
    }

    fn warn_shadowed(&mut self, origin: &Origin<'_>, expression: &Expression) {
        // A plain quantity has no other reading.
        let plain = expression.quantity().is_some();
        for (unit, range) in expression.shadowed.iter().filter(|_| !plain) {
            let message =
                format!("{}: `{unit}` is read as a unit, not as the `{unit}` of this file", origin.what);
            let span = self.span_in(origin.quantity, range.clone());
            self.report(Diagnostic::new(Code::UnitShadowsName, message).at(span, "").help(format!(
                "to divide by `{unit}`, put the quantity in brackets: `(2 m)/{unit}`; to be rid of the doubt, rename it"
            )));
        }
    }

    fn report_dimension(
        &mut self,
        origin: &Origin<'_>,
        bare: Option<f64>,
        found: Dimension,
        expected: Dimension,
    ) {
        let span = origin.quantity.span;
        let diagnostic = match bare {
            Some(number) if expected != Dimension::NONE => {
                let message = format!("{} needs a unit: it is {}", origin.what, expected.description());
                Diagnostic::new(Code::MissingUnit, message).at(span, "").help(format!(
                    "write \"{number} {}\", or any other unit of it, for example \"{}\"",
                    expected.si_unit(),
                    expected.example()
                ))
            }
            _ => {
                let message = format!(
                    "{} is {}, but {} is needed",
                    origin.what,
                    found.description(),
                    expected.description()
                );
                Diagnostic::new(Code::UnitMismatch, message)
                    .at(span, "")
                    .help(format!("write something like \"{}\"", expected.example()))
            }
        };
        self.report(diagnostic);
    }

    /// Where a range of the text is in the file. Texts with escapes or made by `[repeat]` have one place as a whole.
    fn span_in(&self, quantity: &Quantity, range: Range<usize>) -> Span {
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

    fn fault(&mut self, origin: &Origin<'_>, range: &Range<usize>, code: Code, message: &str) -> Diagnostic {
        let span = self.span_in(origin.quantity, range.clone());
        Diagnostic::new(code, format!("{}: {message}", origin.what)).at(span, "")
    }

    fn term(&mut self, expression: &Expression, origin: &Origin<'_>) -> Resolved {
        match &expression.form {
            Form::Number { value, dimension, .. } => Some((Term::Number(*value), *dimension)),
            Form::Name(name) => self.name(name, expression, origin),
            Form::Member(thing, member) => self.member(thing, member, expression, origin),
            Form::Neg(inner) => {
                let (term, dimension) = self.term(inner, origin)?;
                Some((Term::Neg(Box::new(term)), dimension))
            }
            Form::Power(base, exponent) => {
                let (term, dimension) = self.term(base, origin)?;
                let dimension = self.exponents(dimension.to_power(*exponent), expression, origin)?;
                Some((Term::Power(Box::new(term), *exponent), dimension))
            }
            Form::Binary(operator, left, right) => self.binary(*operator, left, right, expression, origin),
            Form::Call(function, arguments) => self.call(function, arguments, expression, origin),
        }
    }

    fn exponents(
        &mut self,
        dimension: Option<Dimension>,
        expression: &Expression,
        origin: &Origin<'_>,
    ) -> Option<Dimension> {
        if dimension.is_none() {
            let message = "no quantity has such a power of a unit";
            let fault = self.fault(origin, &expression.range, Code::UnitMismatch, message);
            self.report(fault);
        }
        dimension
    }

    fn binary(
        &mut self,
        operator: Operator,
        left: &Expression,
        right: &Expression,
        whole: &Expression,
        origin: &Origin<'_>,
    ) -> Resolved {
        // Both sides first, so that faults of both are found.
        let (a, b) = (self.term(left, origin), self.term(right, origin));
        let ((a, of_a), (b, of_b)) = (a?, b?);
        let (a, b) = (Box::new(a), Box::new(b));
        match operator {
            Operator::Add | Operator::Sub => {
                if of_a != of_b {
                    let verb = if operator == Operator::Add { "added to" } else { "taken from" };
                    let message = format!("{} cannot be {verb} {}", of_b.description(), of_a.description());
                    let fault = self.fault(origin, &whole.range, Code::UnitMismatch, &message);
                    self.report(fault);
                    return None;
                }
                let term = if operator == Operator::Add { Term::Add(a, b) } else { Term::Sub(a, b) };
                Some((term, of_a))
            }
            Operator::Mul => Some((Term::Mul(a, b), self.exponents(of_a.times(of_b), whole, origin)?)),
            Operator::Div => Some((Term::Div(a, b), self.exponents(of_a.over(of_b), whole, origin)?)),
        }
    }

    fn name(&mut self, name: &str, expression: &Expression, origin: &Origin<'_>) -> Resolved {
        let range = &expression.range;
        if name == "pi" {
            return Some((Term::Number(std::f64::consts::PI), Dimension::NONE));
        }
        if name == "t" {
            if !origin.allowed.time {
                let fault = self.not_allowed(origin, range, "the time");
                self.report(fault);
                return None;
            }
            return Some((Term::Time, Dimension::TIME));
        }
        match self.names.find(name) {
            Some((Thing::Parameter(id), _)) => self.parameter_term(id, range, origin),
            Some((thing, span)) => {
                let message = format!("`{name}` is a {}, not a number", thing.what());
                let help = match thing {
                    Thing::Point(_) => format!("write `{name}.x`, `{name}.y` or `{name}.z` for a coordinate"),
                    Thing::Joint(_) => format!("write `{name}.q` for the position, `{name}.v` for the speed"),
                    _ => format!("a formula can use {}", origin.allowed.list()),
                };
                let fault =
                    self.fault(origin, range, Code::WrongKindOfName, &message).also(span, "").help(help);
                self.report(fault);
                None
            }
            None if self.names.is_lost(name) => None,
            None if self.names.is_foreseen(name) => {
                let message = format!("`{name}` is not a parameter");
                let help = format!("here a formula can use {}", origin.allowed.list());
                let fault = self.fault(origin, range, Code::WrongKindOfName, &message).help(help);
                self.report(fault);
                None
            }
            None => {
                let known = self.names.known(|thing| matches!(thing, Thing::Parameter(_))).chain(["t", "pi"]);
                let span = self.span_in(origin.quantity, range.clone());
                let message = format!("{}: `{name}` does not exist", origin.what);
                let mut fault = Diagnostic::new(Code::UnknownName, message)
                    .at(span, "unknown parameter")
                    .did_you_mean(name, known);
                if fault.help.is_empty() {
                    fault = fault.help(format!(
                        "define it in [parameters]; a formula here can use {}",
                        origin.allowed.list()
                    ));
                }
                self.report(fault);
                None
            }
        }
    }

    fn not_allowed(&mut self, origin: &Origin<'_>, range: &Range<usize>, what: &str) -> Diagnostic {
        let message = format!("{what} cannot be used here");
        let help = format!("here a formula can use {}", origin.allowed.list());
        self.fault(origin, range, Code::NotAllowedHere, &message).help(help)
    }

    fn parameter_term(&mut self, id: ParameterId, range: &Range<usize>, origin: &Origin<'_>) -> Resolved {
        self.used[id.index()] = true;
        let parameter = &self.parameters[id.index()];
        let (dimension, declared) = (parameter.dimension, parameter.span);
        let written_out = self.written_out[id.index()].clone();
        if !origin.allowed.tunable && (parameter.tunable || written_out.is_some()) {
            let message = if parameter.tunable {
                format!("`{}` is tunable, but this must be fixed when code is generated", parameter.name)
            } else {
                format!(
                    "`{}` follows from a tunable parameter, but this must be fixed when code is generated",
                    parameter.name
                )
            };
            let fault = self
                .fault(origin, range, Code::TunableNotAllowed, &message)
                .also(declared, "declared here")
                .help("take `tunable = true` away, or use another parameter here");
            self.report(fault);
            return None;
        }
        // A parameter that is wrong itself is reported there.
        if self.values[id.index()].is_nan() {
            return None;
        }
        Some((written_out.unwrap_or(Term::Parameter(id)), dimension))
    }

    fn member(
        &mut self,
        thing: &str,
        member: &str,
        expression: &Expression,
        origin: &Origin<'_>,
    ) -> Resolved {
        let range = &expression.range;
        if !origin.allowed.state {
            let fault = self.not_allowed(origin, range, &format!("`{thing}.{member}`"));
            self.report(fault);
            return None;
        }
        let resolved = match self.names.find(thing) {
            Some((Thing::Joint(id), _)) => self.joint_member(id, member),
            Some((Thing::Point(id), _)) => {
                let component = ["x", "y", "z"]
                    .iter()
                    .position(|name| member.strip_prefix('v').unwrap_or(member) == *name);
                match (component, member.starts_with('v')) {
                    (Some(axis), false) => Ok((Term::PointPosition(id, axis), Dimension::LENGTH)),
                    (Some(axis), true) => Ok((Term::PointSpeed(id, axis), Dimension::of(1, 0, -1))),
                    (None, _) => Err("a point has `x`, `y`, `z` and the speeds `vx`, `vy`, `vz`".to_owned()),
                }
            }
            Some((other, _)) => Err(format!("a {} has no members in formulas", other.what())),
            None if self.names.is_lost(thing) => return None,
            None => {
                let known = self.names.known(|thing| matches!(thing, Thing::Joint(_) | Thing::Point(_)));
                let span = self.span_in(origin.quantity, range.clone());
                let message = format!("{}: `{thing}` does not exist", origin.what);
                let fault = Diagnostic::new(Code::UnknownName, message)
                    .at(span, "unknown joint or point")
                    .did_you_mean(thing, known);
                self.report(fault);
                return None;
            }
        };
        let fault = match resolved {
            Ok(resolved) => return Some(resolved),
            Err(help) => {
                let message = format!("`{thing}` has no `{member}`");
                self.fault(origin, range, Code::UnknownMember, &message).help(help)
            }
        };
        self.report(fault);
        None
    }

    fn joint_member(&self, id: JointId, member: &str) -> Result<(Term, Dimension), String> {
        // A joint whose kind is wrong has none here; it is reported there.
        let Some(kind) = self.joint_kinds.get(id.index()) else {
            return Ok((Term::JointPosition(id, 0), Dimension::NONE));
        };
        let coordinates = kind.coordinates();
        let (letter, number) = member.split_at(usize::from(member.starts_with(['q', 'v'])));
        let position = match number.parse::<usize>() {
            Ok(number) if coordinates.len() > 1 => number.checked_sub(1),
            Ok(1) => Some(0),
            Err(_) if number.is_empty() && coordinates.len() == 1 => Some(0),
            _ => None,
        };
        match (letter, position.and_then(|at| Some((at, coordinates.get(at)?)))) {
            ("q", Some((at, coordinate))) => Ok((Term::JointPosition(id, at), coordinate.dimension())),
            ("v", Some((at, coordinate))) => Ok((Term::JointSpeed(id, at), coordinate.speed())),
            _ => Err(match coordinates.len() {
                0 => format!("a {} joint has no scalar coordinates; use points", kind.name()),
                1 => format!("a {} joint has the position `q` and the speed `v`", kind.name()),
                n => format!(
                    "a {} joint has the positions `q1` to `q{n}` and the speeds `v1` to `v{n}`",
                    kind.name()
                ),
            }),
        }
    }

    fn call(
        &mut self,
        name: &str,
        arguments: &[Expression],
        whole: &Expression,
        origin: &Origin<'_>,
    ) -> Resolved {
        let Some((_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
            let list = FUNCTIONS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            let fault = self
                .fault(origin, &whole.range, Code::UnknownFunction, &format!("there is no function `{name}`"))
                .did_you_mean(name, FUNCTIONS.iter().map(|(name, _)| *name))
                .help(format!("functions are {list}: all are smooth, so that motions have accelerations"));
            self.report(fault);
            return None;
        };
        let resolved: Vec<Resolved> = arguments.iter().map(|argument| self.term(argument, origin)).collect();
        let needed = if *function == Function::Atan2 { 2 } else { 1 };
        if arguments.len() != needed {
            let message = format!(
                "`{name}` takes {needed} argument{}, not {}",
                if needed == 1 { "" } else { "s" },
                arguments.len()
            );
            let fault = self.fault(origin, &whole.range, Code::UnknownFunction, &message);
            self.report(fault);
            return None;
        }
        let (terms, dimensions): (Vec<Term>, Vec<Dimension>) =
            resolved.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
        let dimension = match function {
            Function::Sqrt => dimensions[0].root(),
            Function::Atan2 => (dimensions[0] == dimensions[1]).then_some(Dimension::NONE),
            _ => (dimensions[0] == Dimension::NONE).then_some(Dimension::NONE),
        };
        let Some(dimension) = dimension else {
            let found = dimensions.iter().map(|d| d.description()).collect::<Vec<_>>().join(" and ");
            let need = match function {
                Function::Sqrt => "needs even powers of the units",
                Function::Atan2 => "needs two quantities of one dimension",
                _ => "needs a pure number or an angle",
            };
            let fault = self.fault(
                origin,
                &whole.range,
                Code::UnitMismatch,
                &format!("`{name}` {need}, not {found}"),
            );
            self.report(fault);
            return None;
        };
        Some((Term::Call(*function, terms), dimension))
    }

    /// Reports if a part that depends on nothing but parameters is infinite or not a number, e.g. `t/(2 - 2)`.
    fn check_finite(&mut self, term: &Term, origin: &Origin<'_>) -> bool {
        let mut finite = true;
        term.visit(&mut |part| {
            // Only leaves and what can leave the numbers; sums of finite parts are checked with the whole.
            let check = matches!(part, Term::Number(_) | Term::Div(..) | Term::Power(..) | Term::Call(..));
            if finite && check && part.value_at(&self.values, None).is_some_and(|value| !value.is_finite()) {
                finite = false;
            }
        });
        let at_start = if finite { term.value_at(&self.values, Some(0.0)) } else { None };
        if finite && at_start.is_none_or(f64::is_finite) {
            return true;
        }
        let when = if finite && term.value_at(&self.values, None).is_none() { " at t = 0" } else { "" };
        let message = format!("{} is infinite or not a number{when}", origin.what);
        self.report(
            Diagnostic::new(Code::NotFinite, message)
                .at(origin.quantity.span, "")
                .help("check divisions by zero and the ranges of sqrt, ln, asin and acos"),
        );
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
