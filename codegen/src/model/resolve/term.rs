//! The pieces of a formula: names to ids, dimensions, and what may occur where.

use super::names::Thing;
use super::quantity::{Here, Origin, Resolved};
use super::resolver::{Reported, Resolver};
use super::responses::{Member, coordinate_of};
use crate::diagnostic::{Code, Diagnostic};
use crate::id::{JointId, ParameterId};
use crate::model::Term;
use crate::spec::{Dimension, Expression, Form, Operator};

impl Resolver<'_> {
    pub(super) fn term(&mut self, expression: &Expression, origin: &Origin<'_>) -> Resolved {
        let here = Here { origin, range: &expression.range };
        match &expression.form {
            Form::Number { value, dimension, .. } => Some((Term::Number(*value), *dimension)),
            Form::Name(name) => self.name(name, here),
            Form::Member(thing, member) => self.member(thing, member, here),
            Form::Neg(inner) => {
                let (term, dimension) = self.term(inner, origin)?;
                Some((Term::Neg(Box::new(term)), dimension))
            }
            Form::Power(base, exponent) => {
                let (term, dimension) = self.term(base, origin)?;
                let dimension = self.exponents(dimension.to_power(*exponent), here)?;
                Some((Term::Power(Box::new(term), *exponent), dimension))
            }
            Form::Binary(operator, left, right) => self.binary(*operator, [left, right], here),
            Form::Call(function, arguments) => self.call(function, arguments, here),
            Form::Compare(..) => {
                self.refuse_in(here, Code::FormulaSyntax, "a comparison is no quantity")
                    .help("comparisons choose: `if(a < b, then, else)`");
                None
            }
        }
    }

    fn exponents(&mut self, dimension: Option<Dimension>, here: Here<'_>) -> Option<Dimension> {
        if dimension.is_none() {
            self.refuse_in(here, Code::UnitMismatch, "no quantity has such a power of a unit");
        }
        dimension
    }

    fn binary(&mut self, operator: Operator, sides: [&Expression; 2], here: Here<'_>) -> Resolved {
        // Both sides first, so that faults of both are found.
        let [a, b] = sides.map(|side| self.term(side, here.origin));
        let ((a, of_a), (b, of_b)) = (a?, b?);
        let (a, b) = (Box::new(a), Box::new(b));
        match operator {
            Operator::Add | Operator::Sub => {
                if of_a != of_b {
                    let verb = if operator == Operator::Add { "added to" } else { "taken from" };
                    let message = format!("{} cannot be {verb} {}", of_b.description(), of_a.description());
                    let help = self.one_kind(&sides);
                    self.refuse_in(here, Code::UnitMismatch, &message).help(help);
                    return None;
                }
                let term = if operator == Operator::Add { Term::Add(a, b) } else { Term::Sub(a, b) };
                Some((term, of_a))
            }
            Operator::Mul => Some((Term::Mul(a, b), self.exponents(of_a.times(of_b), here)?)),
            Operator::Div => Some((Term::Div(a, b), self.exponents(of_a.over(of_b), here)?)),
        }
    }

    fn name(&mut self, name: &str, here: Here<'_>) -> Resolved {
        let allowed = here.origin.allowed;
        if name == "pi" {
            return Some((Term::Number(std::f64::consts::PI), Dimension::NONE));
        }
        if name == "t" {
            if !allowed.time {
                self.refuse_not_allowed(here, "the time");
                return None;
            }
            return Some((Term::Time, Dimension::TIME));
        }
        if let Some(at) = allowed.arguments.iter().position(|(known, _)| *known == name) {
            return self.argument(name, (at, allowed.arguments[at].1), here);
        }
        match self.names.find(name) {
            Some((Thing::Parameter(id) | Thing::Input(id), _)) => self.parameter_term(id, here),
            Some((Thing::State(id), _)) if allowed.state => {
                // One whose start is wrong has no dimension; it is reported there.
                let dimension = self.states.get(id.index())?.as_ref()?.dimension;
                Some((Term::State(id), dimension))
            }
            Some((Thing::Sensor(at), _)) if allowed.state => self.sensor_term(name, at, here),
            Some((Thing::Controller(at), _)) if allowed.state => self.controller_term(name, at, here),
            Some((thing, span)) => {
                let message = format!("`{name}` is {}, not a number", thing.a());
                let help = match thing {
                    Thing::Point(_) => format!("write `{name}.x`, `{name}.y` or `{name}.z` for a coordinate"),
                    Thing::Joint(_) => format!("write `{name}.q` for the position, `{name}.v` for the speed"),
                    Thing::Body(_) => format!("write `{name}.wz` for a component of its angular velocity"),
                    _ => format!("a formula can use {}", allowed.list()),
                };
                self.refuse_in(here, Code::WrongKindOfName, &message).also(span, "").help(help);
                None
            }
            None if self.names.is_lost(name) => None,
            None if self.names.is_foreseen(name) => {
                let message = format!("`{name}` is not a parameter");
                let help = format!("here a formula can use {}", allowed.list());
                self.refuse_in(here, Code::WrongKindOfName, &message).help(help);
                None
            }
            None => {
                let known = self
                    .names
                    .known(|thing| {
                        matches!(
                            thing,
                            Thing::Parameter(_)
                                | Thing::Input(_)
                                | Thing::State(_)
                                | Thing::Sensor(_)
                                | Thing::Controller(_)
                        )
                    })
                    .chain(["t", "pi"])
                    .chain(allowed.arguments.iter().map(|(name, _)| *name));
                let mut fault = self.unknown(name, "unknown parameter", here).did_you_mean(name, known);
                if fault.help.is_empty() {
                    let list = allowed.list();
                    fault = fault.help(format!("define it in [parameters]; a formula here can use {list}"));
                }
                self.report(fault);
                None
            }
        }
    }

    fn argument(&mut self, name: &str, (at, dimension): (usize, Dimension), here: Here<'_>) -> Resolved {
        if let Some((thing, span)) = self.names.find(name) {
            let message = format!("`{name}` is {} here, and {} of this file", meaning(dimension), thing.a());
            self.refuse_in(here, Code::ConflictingKeys, &message)
                .also(span, "declared here")
                .help(format!("rename that of the file: in this formula `{name}` is {}", meaning(dimension)));
            return None;
        }
        Some((Term::Place(at), dimension))
    }

    /// A name that nothing has.
    fn unknown(&self, name: &str, label: &str, here: Here<'_>) -> Diagnostic {
        let message = format!("{}: `{name}` does not exist", here.origin.what);
        Diagnostic::new(Code::UnknownName, message).at(self.span_of(here), label)
    }

    fn refuse_not_allowed(&mut self, here: Here<'_>, what: &str) -> Reported<'_> {
        let message = format!("{what} cannot be used here");
        let help = format!("here a formula can use {}", here.origin.allowed.list());
        self.refuse_in(here, Code::NotAllowedHere, &message).help(help)
    }

    fn parameter_term(&mut self, id: ParameterId, here: Here<'_>) -> Resolved {
        self.used[id.index()] = true;
        let parameter = &self.parameters[id.index()];
        if parameter.input && !here.origin.allowed.time {
            let (what, declared) = (format!("the input `{}`", parameter.name), parameter.span);
            self.refuse_not_allowed(here, &what).also(declared, "declared here");
            return None;
        }
        let (dimension, declared) = (parameter.dimension, parameter.span);
        let written_out = self.written_out[id.index()].clone();
        if !here.origin.allowed.tunable && (parameter.tunable || written_out.is_some()) {
            let why = if parameter.tunable { "is tunable" } else { "follows from a tunable parameter" };
            let message =
                format!("`{}` {why}, but this must be fixed when code is generated", parameter.name);
            self.refuse_in(here, Code::TunableNotAllowed, &message)
                .also(declared, "declared here")
                .help("take `tunable = true` away, or use another parameter here");
            return None;
        }
        // A parameter that is wrong itself is reported there.
        if self.values[id.index()].is_nan() {
            return None;
        }
        Some((written_out.unwrap_or(Term::Parameter(id)), dimension))
    }

    fn member(&mut self, thing: &str, member: &str, here: Here<'_>) -> Resolved {
        if !here.origin.allowed.state {
            self.refuse_not_allowed(here, &format!("`{thing}.{member}`"));
            return None;
        }
        let resolved = match self.names.find(thing) {
            Some((Thing::Joint(id), _)) => self.joint_member(id, member),
            Some((Thing::Point(id), _)) => {
                let letter = member.strip_prefix('v').unwrap_or(member);
                let component = ["x", "y", "z"].iter().position(|name| letter == *name);
                match (component, member.starts_with('v')) {
                    (Some(axis), false) => Ok((Term::PointPosition(id, axis), Dimension::LENGTH)),
                    (Some(axis), true) => Ok((Term::PointSpeed(id, axis), Dimension::of(1, 0, -1))),
                    (None, _) => Self::point_response(id, member).ok_or_else(|| {
                        "a point has `x`, `y`, `z`, the speeds `vx`, `vy`, `vz` and the accelerations `ax`, `ay`, `az`".to_owned()
                    }),
                }
            }
            Some((Thing::Body(id), _)) => Self::body_member(id, member),
            Some((Thing::Force(id), _)) => self.force_member(id, member)?,
            Some((Thing::Controller(at), _)) => self.controller_member(at, member)?,
            Some((other, _)) => Err(format!("a {} has no members in formulas", other.what())),
            None if self.names.is_lost(thing) => return None,
            None => {
                let known = self.names.known(|thing| {
                    matches!(
                        thing,
                        Thing::Joint(_)
                            | Thing::Point(_)
                            | Thing::Body(_)
                            | Thing::Force(_)
                            | Thing::Controller(_)
                    )
                });
                let mut fault =
                    self.unknown(thing, "unknown joint, point or body", here).did_you_mean(thing, known);
                if fault.help.is_empty() {
                    fault = fault.help("name a joint of [joints], a point of [points] or a body of [bodies]");
                }
                self.report(fault);
                return None;
            }
        };
        match resolved {
            Ok(resolved) => Some(resolved),
            Err(help) => {
                let message = format!("`{thing}` has no `{member}`");
                self.refuse_in(here, Code::UnknownMember, &message).help(help);
                None
            }
        }
    }

    fn joint_member(&self, id: JointId, member: &str) -> Member {
        // A joint whose kind is wrong has none here; it is reported there.
        let Some(model) = self.joint_models.get(id.index()) else {
            return Ok((Term::JointPosition(id, 0), Dimension::NONE));
        };
        let (kind, coordinates) = (model.kind.name, model.coordinates());
        let (letter, number) = member.split_at(usize::from(member.starts_with(['q', 'v'])));
        let position = coordinate_of(number, coordinates.len());
        match (letter, position.and_then(|at| Some((at, coordinates.get(at)?)))) {
            ("q", Some((at, coordinate))) => Ok((Term::JointPosition(id, at), coordinate.dimension())),
            ("v", Some((at, coordinate))) => Ok((Term::JointSpeed(id, at), coordinate.speed())),
            _ => self.joint_response(id, member, &coordinates).unwrap_or_else(|| {
                let own = match coordinates.len() {
                    0 => "no scalar coordinates; use points, or".to_owned(),
                    1 => "the position `q`, the speed `v`, the acceleration `a`,".to_owned(),
                    n => format!("the positions `q1` to `q{n}`, the speeds `v1`, the accelerations `a1`,"),
                };
                Err(format!(
                    "a {kind} joint has {own} the force `Fx`, `Fy`, `Fz` and the moment `Mx`, `My`, `Mz`"
                ))
            }),
        }
    }
}

/// What an argument of a formula is, by its dimension.
fn meaning(dimension: Dimension) -> &'static str {
    if dimension == Dimension::LENGTH { "a coordinate of the place" } else { "a quantity of the contact" }
}
