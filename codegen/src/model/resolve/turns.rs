//! Turns that are taken for radians: a rate in Hz or rpm that becomes an angle, or stands beside one, without `2*pi`.

use std::ops::Range;

use super::names::Thing;
use super::resolver::Resolver;
use super::responses::coordinate_of;
use crate::diagnostic::Code;
use crate::id::JointId;
use crate::model::{Coordinate, Formula};
use crate::spec::{Expression, Form, Literal, Operator, Quantity, Turning, parse_expression};

/// Bare numbers this near to pi, 2 pi or a quarter of them stand for it: people write 3.14 and 6.28.
const NEAR_PI: f64 = 2e-3;

/// Turns of a formula, and the place where it takes turns for radians.
#[derive(Default)]
pub(super) struct Turns {
    pub(super) of: Turning,
    misread: Option<Misread>,
}

/// What a formula takes for something that it is not, and where.
#[derive(Debug)]
enum Misread {
    /// Turns, for radians.
    Turns(Range<usize>),
    /// Radians, for the turns that a table is over.
    Angle(Range<usize>, String),
    /// Radians over turns, for a pure number.
    Ratio(Range<usize>),
}

/// A piece of a formula with its turns.
type Piece<'a> = (&'a Expression, Turning);

impl Resolver<'_> {
    /// Turns and angles among the factors of a quantity or formula.
    pub(super) fn turns_of(&self, quantity: &Quantity) -> Turns {
        let Literal::Text(text) = &quantity.value else { return Turns::default() };
        let Ok(expression) = parse_expression(text, &|word| self.names.is_name(word)) else {
            return Turns::default();
        };
        let mut misread = None;
        let of = self.turning(&expression, &mut misread);
        Turns { of, misread }
    }

    fn turning(&self, expression: &Expression, misread: &mut Option<Misread>) -> Turning {
        match &expression.form {
            Form::Number { value, bare: true, .. } if is_pi(*value) => Turning::ANGLE,
            Form::Number { turning, .. } => *turning,
            Form::Name(name) if name == "pi" => Turning::ANGLE,
            Form::Name(name) => self.turning_of_name(name),
            Form::Member(thing, member) => self.turning_of_member(thing, member),
            Form::Neg(inner) => self.turning(inner, misread),
            Form::Power(base, exponent) => self.turning(base, misread).to_power(*exponent),
            Form::Binary(operator, left, right) => {
                let (a, b) = (self.turning(left, misread), self.turning(right, misread));
                match operator {
                    Operator::Mul => a.times(b),
                    Operator::Div => a.times(b.to_power(-1)),
                    Operator::Add | Operator::Sub => self.beside(&[(left, a), (right, b)], misread),
                }
            }
            Form::Call(function, arguments) => {
                let of = arguments.iter().map(|argument| self.turning(argument, misread)).collect::<Vec<_>>();
                let pieces: Vec<Piece<'_>> = arguments.iter().zip(of).collect();
                self.turning_of_call(function, &pieces, misread)
            }
            Form::Compare(_, both) => {
                let pieces = both.each_ref().map(|side| (side, self.turning(side, misread)));
                self.beside(&pieces, misread);
                Turning::default()
            }
        }
    }

    fn turning_of_call(
        &self,
        function: &str,
        pieces: &[Piece<'_>],
        misread: &mut Option<Misread>,
    ) -> Turning {
        let Some((first, of_first)) = pieces.first() else { return Turning::default() };
        if let Some(table) = self.tables.iter().find(|known| known.table.name == function) {
            if of_first.is_turns_beside(table.argument.turning) {
                misread.get_or_insert(Misread::Turns(first.range.clone()));
            } else if table.argument.turning.is_turns_beside(*of_first) {
                misread.get_or_insert(Misread::Angle(first.range.clone(), function.to_owned()));
            }
            self.pure_number(pieces, misread);
            return table.value.turning;
        }
        match function {
            // The first is the comparison, which is looked at by itself.
            "if" => self.beside(&pieces[1..], misread),
            "min" | "max" | "clamp" | "mod" | "smooth_abs" => self.beside(pieces, misread),
            "smooth_sign" | "smooth_step" => {
                self.beside(pieces, misread);
                Turning::default()
            }
            "atan2" => {
                self.beside(pieces, misread);
                Turning::ANGLE
            }
            "abs" => *of_first,
            "asin" | "acos" | "atan" => {
                self.pure_number(pieces, misread);
                Turning::ANGLE
            }
            "sign" | "step" => Turning::default(),
            _ => {
                if matches!(function, "sin" | "cos" | "tan") && of_first.turns > 0 {
                    misread.get_or_insert(Misread::Turns(first.range.clone()));
                }
                self.pure_number(pieces, misread);
                Turning::default()
            }
        }
    }

    /// Turns of what is added, compared or chosen between: none may count turns where another is an angle.
    fn beside(&self, pieces: &[Piece<'_>], misread: &mut Option<Misread>) -> Turning {
        let is_turns = |(_, of): &&Piece<'_>| pieces.iter().any(|(_, other)| of.is_turns_beside(*other));
        if let Some((turns, _)) = pieces.iter().find(is_turns) {
            misread.get_or_insert(Misread::Turns(turns.range.clone()));
            return Turning::ANGLE;
        }
        // The sign of a ratio does not depend on its units.
        let is_number = |(piece, of): &Piece<'_>| *of == Turning::default() && !is_zero(piece);
        if pieces.iter().any(is_number) {
            self.pure_number(pieces, misread);
        }
        pieces.iter().map(|(_, of)| *of).find(|of| *of != Turning::default()).unwrap_or_default()
    }

    /// Radians over turns are off by 2 pi where a pure number is meant. Only measured rates over written ones are told:
    /// `2*pi*f1/f2` and `zeta*omega/f` are right as they are.
    fn pure_number(&self, pieces: &[Piece<'_>], misread: &mut Option<Misread>) {
        let is_ratio = |(piece, of): &&Piece<'_>| of.is_mixed() && self.is_measured(piece) && !has_pi(piece);
        if let Some((ratio, _)) = pieces.iter().find(is_ratio) {
            misread.get_or_insert(Misread::Ratio(ratio.range.clone()));
        }
    }

    fn turning_of_name(&self, name: &str) -> Turning {
        let of = match self.names.find(name) {
            Some((Thing::Parameter(id) | Thing::Input(id), _)) => {
                self.parameters.get(id.index()).map(|parameter| parameter.turning)
            }
            Some((Thing::State(id), _)) => self.state_turning.get(id.index()).copied(),
            Some((Thing::Sensor(at), _)) => self.sensor_turning.get(at).copied(),
            _ => None,
        };
        of.unwrap_or_default()
    }

    /// Motions of joints and bodies that turn are angles; forces and moments are none.
    fn turning_of_member(&self, thing: &str, member: &str) -> Turning {
        let is_angle = match self.names.find(thing) {
            Some((Thing::Joint(id), _)) => self.coordinate_of_member(id, member) == Some(Coordinate::Angle),
            Some((Thing::Body(_), _)) => member.starts_with('w') || member.starts_with("alpha_"),
            _ => false,
        };
        if is_angle { Turning::ANGLE } else { Turning::default() }
    }

    /// The coordinate of which `q`, `v` or `a` of a joint tells.
    fn coordinate_of_member(&self, joint: JointId, member: &str) -> Option<Coordinate> {
        let coordinates = self.joint_models.get(joint.index())?.coordinates();
        let number = member.strip_prefix(['q', 'v', 'a'])?;
        coordinates.get(coordinate_of(number, coordinates.len())?).copied()
    }

    fn is_measured(&self, expression: &Expression) -> bool {
        any(expression, &|form| match form {
            Form::Member(thing, member) => self.turning_of_member(thing, member) == Turning::ANGLE,
            _ => false,
        })
    }

    /// Warns where a formula takes turns for radians.
    pub(super) fn warn_turns_inside(&mut self, quantity: &Quantity, what: &str) {
        match self.turns_of(quantity).misread {
            Some(Misread::Turns(range)) => self.warn_turns(quantity, range, what),
            Some(Misread::Angle(range, table)) => {
                let angle = part(quantity, &range);
                let message = format!(
                    "{what}: the table `{table}` is over turns (Hz, rpm), but `{angle}` is in radians"
                );
                self.refuse(Code::TurnsAsAngle, self.span_in(quantity, range), message).help(format!(
                    "write `{table}(({angle})/(2*pi))`, or give the arguments of the table in rad/s"
                ));
            }
            Some(Misread::Ratio(range)) => {
                let ratio = part(quantity, &range);
                let message = format!("{what}: `{ratio}` is a ratio of radians and turns (Hz, rpm)");
                self.refuse(Code::TurnsAsAngle, self.span_in(quantity, range), message)
                    .help("write `2*pi*` before the rate in Hz or rpm, or give it in rad/s");
            }
            None => {}
        }
    }

    /// Warns if a formula that is an angle counts turns; what is wrong inside is told already, as is a formula that is none.
    pub(super) fn warn_turns_as_angle(&mut self, quantity: &Quantity, formula: &Formula, what: &str) {
        if formula.is_wrong() {
            return;
        }
        let Turns { of, misread } = self.turns_of(quantity);
        if let (Literal::Text(text), true, None) = (&quantity.value, of.turns > 0, misread) {
            self.warn_turns(quantity, 0..text.len(), what);
        }
    }

    /// Warns if one of a list counts turns where those before it are angles, or the other way round. Out: what the list counts.
    pub(super) fn warn_turns_among(&mut self, quantity: &Quantity, before: Turning, what: &str) -> Turning {
        let of = self.turns_of(quantity).of;
        if of.differs_from(before) {
            let message =
                format!("{what}: this counts {}, those before it {}", of.counted(), before.counted());
            self.refuse(Code::TurnsAsAngle, quantity.span, message)
                .help("a turn is 2*pi rad: give all in Hz or rpm, or all in rad/s");
        }
        if before == Turning::default() { of } else { before }
    }

    /// What to say of a value that counts turns for a parameter in radians, or the other way round; and the cure.
    pub(super) fn other_turning(&self, parameter: usize, given: Turning, what: &str) -> Option<[String; 2]> {
        let own = &self.parameters[parameter];
        let unit = own.written.as_ref().map(|(_, unit)| unit.clone()).filter(|unit| !unit.is_empty());
        let unit = unit.unwrap_or_else(|| own.dimension.unit_counting(own.turning));
        own.turning.told_apart(given, what, (&own.name, &unit))
    }

    fn warn_turns(&mut self, quantity: &Quantity, range: Range<usize>, what: &str) {
        let turns = part(quantity, &range).to_owned();
        let message = format!("{what}: `{turns}` counts turns (Hz, rpm), and is read as radians");
        self.refuse(Code::TurnsAsAngle, self.span_in(quantity, range), message)
            .help(format!("write `2*pi*{turns}`, or give the rate in rad/s"));
    }
}

/// A part of a quantity's text.
fn part<'a>(quantity: &'a Quantity, range: &Range<usize>) -> &'a str {
    let Literal::Text(text) = &quantity.value else { return "" };
    text.get(range.clone()).unwrap_or(text)
}

/// Whether a form of some kind is in it.
fn any(expression: &Expression, is: &dyn Fn(&Form) -> bool) -> bool {
    let inside = |one: &Expression| any(one, is);
    is(&expression.form)
        || match &expression.form {
            Form::Number { .. } | Form::Name(_) | Form::Member(..) => false,
            Form::Neg(inner) | Form::Power(inner, _) => inside(inner),
            Form::Binary(_, left, right) => inside(left) || inside(right),
            Form::Call(_, arguments) => arguments.iter().any(inside),
            Form::Compare(_, both) => both.iter().any(inside),
        }
}

fn has_pi(expression: &Expression) -> bool {
    any(expression, &|form| match form {
        Form::Name(name) => name == "pi",
        Form::Number { value, bare: true, .. } => is_pi(*value),
        _ => false,
    })
}

fn is_zero(expression: &Expression) -> bool {
    matches!(expression.form, Form::Number { value, .. } if value == 0.0)
}

fn is_pi(number: f64) -> bool {
    [1.0, 2.0, 4.0].iter().any(|times| (number.abs() / (times * std::f64::consts::PI) - 1.0).abs() < NEAR_PI)
}
