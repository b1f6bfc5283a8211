//! The pieces of a formula: names to ids, dimensions, and what may occur where.

use std::ops::Range;

use super::names::Thing;
use super::quantity::{Origin, Resolved};
use super::resolver::Resolver;
use crate::diagnostic::{Code, Diagnostic};
use crate::id::{JointId, ParameterId};
use crate::model::{Function, Term};
use crate::spec::{Dimension, Expression, Form, Operator};

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

impl Resolver<'_> {
    pub(super) fn term(&mut self, expression: &Expression, origin: &Origin<'_>) -> Resolved {
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
        let Some(model) = self.joint_models.get(id.index()) else {
            return Ok((Term::JointPosition(id, 0), Dimension::NONE));
        };
        let (kind, coordinates) = (model.kind.name, model.coordinates());
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
                0 => format!("a {kind} joint has no scalar coordinates; use points"),
                1 => format!("a {kind} joint has the position `q` and the speed `v`"),
                n => {
                    format!("a {kind} joint has the positions `q1` to `q{n}` and the speeds `v1` to `v{n}`")
                }
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
}
