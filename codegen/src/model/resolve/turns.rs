//! Turns that are taken for radians: a rate in Hz or rpm that becomes an angle without `2*pi`.

use std::ops::Range;

use super::names::Thing;
use super::resolver::Resolver;
use crate::diagnostic::Code;
use crate::spec::{Expression, Form, Literal, Operator, Quantity, Turning, parse_expression};

/// Bare numbers this near to pi, 2 pi or a quarter of them stand for it: people write 3.14 and 6.28.
const NEAR_PI: f64 = 2e-3;

/// Turns of a formula, and the place where it takes turns for radians.
#[derive(Default)]
pub(super) struct Turns {
    pub(super) of: Turning,
    misread: Option<Range<usize>>,
}

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

    fn turning(&self, expression: &Expression, misread: &mut Option<Range<usize>>) -> Turning {
        match &expression.form {
            Form::Number { value, bare: true, .. } if is_pi(*value) => Turning::ANGLE,
            Form::Number { turning, .. } => *turning,
            Form::Name(name) if name == "pi" => Turning::ANGLE,
            Form::Name(name) => match self.names.find(name) {
                Some((Thing::Parameter(id) | Thing::Input(id), _)) => {
                    self.turning.get(id.index()).copied().unwrap_or_default()
                }
                _ => Turning::default(),
            },
            Form::Member(joint, _) => self.turning_of_joint(joint),
            Form::Neg(inner) => self.turning(inner, misread),
            Form::Power(base, exponent) => self.turning(base, misread).to_power(*exponent),
            Form::Binary(operator, left, right) => {
                let (a, b) = (self.turning(left, misread), self.turning(right, misread));
                match operator {
                    Operator::Mul => a.times(b),
                    Operator::Div => a.times(b.to_power(-1)),
                    Operator::Add | Operator::Sub => {
                        let wrong = if a.is_turns_beside(b) { Some(left) } else { Some(right) };
                        let wrong = wrong.filter(|_| a.is_turns_beside(b) || b.is_turns_beside(a));
                        if let Some(wrong) = wrong {
                            misread.get_or_insert(wrong.range.clone());
                            return Turning::ANGLE;
                        }
                        if a == Turning::default() { b } else { a }
                    }
                }
            }
            Form::Call(function, arguments) => {
                let inner: Vec<Turning> =
                    arguments.iter().map(|argument| self.turning(argument, misread)).collect();
                let of_an_angle = matches!(function.as_str(), "sin" | "cos" | "tan");
                if let (true, Some(argument)) =
                    (of_an_angle && inner.iter().any(|t| t.turns > 0), arguments.first())
                {
                    misread.get_or_insert(argument.range.clone());
                }
                let of = |place: usize| inner.get(place).copied().unwrap_or_default();
                match function.as_str() {
                    "asin" | "acos" | "atan" | "atan2" => Turning::ANGLE,
                    "abs" | "min" | "max" | "clamp" | "mod" | "smooth_abs" => of(0),
                    "if" => of(1),
                    _ => Turning::default(),
                }
            }
            Form::Compare(_, both) => {
                both.iter().for_each(|side| {
                    self.turning(side, misread);
                });
                Turning::default()
            }
        }
    }

    /// Positions and speeds of joints that turn are angles.
    fn turning_of_joint(&self, name: &str) -> Turning {
        let Some((Thing::Joint(id), _)) = self.names.find(name) else { return Turning::default() };
        let turns = self.joint_models.get(id.index()).is_some_and(|model| {
            let coordinates = model.coordinates();
            !coordinates.is_empty()
                && coordinates.iter().all(|is| is.dimension() == crate::spec::Dimension::NONE)
        });
        if turns { Turning::ANGLE } else { Turning::default() }
    }

    /// Warns where a formula adds turns to an angle, or takes the sine of turns.
    pub(super) fn warn_turns_inside(&mut self, quantity: &Quantity, what: &str) {
        if let Some(range) = self.turns_of(quantity).misread {
            self.warn_turns(quantity, range, what);
        }
    }

    /// Warns if a formula that is an angle counts turns; what is wrong inside is told already.
    pub(super) fn warn_turns_as_angle(&mut self, quantity: &Quantity, what: &str) {
        let Turns { of, misread } = self.turns_of(quantity);
        if let (Literal::Text(text), true, None) = (&quantity.value, of.turns > 0, misread) {
            self.warn_turns(quantity, 0..text.len(), what);
        }
    }

    fn warn_turns(&mut self, quantity: &Quantity, range: Range<usize>, what: &str) {
        let Literal::Text(text) = &quantity.value else { return };
        let turns = text.get(range.clone()).unwrap_or(text);
        let message = format!("{what}: `{turns}` counts turns (Hz, rpm), and is read as radians");
        self.refuse(Code::TurnsAsAngle, self.span_in(quantity, range), message)
            .help(format!("write `2*pi*{turns}`, or give the rate in rad/s"));
    }
}

fn is_pi(number: f64) -> bool {
    [1.0, 2.0, 4.0].iter().any(|times| (number.abs() / (times * std::f64::consts::PI) - 1.0).abs() < NEAR_PI)
}
