//! Numbers with two derivatives by time, and the evaluation of formulas on them.
//! In: [`Term`]. Out: [`Jet`]. Never knows expression graphs: derivatives come from truncated Taylor
//! arithmetic, not from symbolic rules.

use crate::pieces;
use std::ops::{Add, Div, Mul, Neg, Sub};

use linkwear_codegen::id::{JointId, PointId};
use linkwear_codegen::model::{Function, Term};

/// A value and its first and second derivative by t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivative [1/s].
    pub first: f64,
    /// Second derivative [1/s²].
    pub second: f64,
}

impl Jet {
    /// A number that does not change.
    pub const fn constant(value: f64) -> Self {
        Self { value, first: 0.0, second: 0.0 }
    }

    /// Time itself.
    pub const fn time(t: f64) -> Self {
        Self { value: t, first: 1.0, second: 0.0 }
    }

    /// `f(self)` from `f`, `f'` and `f''` at the value.
    pub(crate) fn chain(self, value: f64, slope: f64, curvature: f64) -> Self {
        let first = slope * self.first;
        Self { value, first, second: curvature * self.first * self.first + slope * self.second }
    }

    fn power(self, n: i32) -> Self {
        let (x, m) = (self.value, f64::from(n));
        let slope = if n == 0 { 0.0 } else { m * x.powi(n - 1) };
        let curvature = if n == 0 || n == 1 { 0.0 } else { m * (m - 1.0) * x.powi(n - 2) };
        self.chain(x.powi(n), slope, curvature)
    }

    fn call(function: Function, arguments: &[Self]) -> Self {
        let a = arguments[0];
        let x = a.value;
        match function {
            Function::Sin => a.chain(x.sin(), x.cos(), -x.sin()),
            Function::Cos => a.chain(x.cos(), -x.sin(), -x.cos()),
            Function::Tan => {
                let slope = 1.0 + x.tan().powi(2);
                a.chain(x.tan(), slope, 2.0 * x.tan() * slope)
            }
            Function::Asin => {
                let rest = 1.0 - x * x;
                a.chain(x.asin(), rest.powf(-0.5), x * rest.powf(-1.5))
            }
            Function::Acos => {
                let rest = 1.0 - x * x;
                a.chain(x.acos(), -rest.powf(-0.5), -x * rest.powf(-1.5))
            }
            Function::Atan => {
                let slope = 1.0 / (1.0 + x * x);
                a.chain(x.atan(), slope, -2.0 * x * slope * slope)
            }
            Function::Atan2 => Self::angle(a, arguments[1]),
            Function::Sinh => a.chain(x.sinh(), x.cosh(), x.sinh()),
            Function::Cosh => a.chain(x.cosh(), x.sinh(), x.cosh()),
            Function::Tanh => {
                let slope = 1.0 - x.tanh().powi(2);
                a.chain(x.tanh(), slope, -2.0 * x.tanh() * slope)
            }
            Function::Exp => a.chain(x.exp(), x.exp(), x.exp()),
            Function::Ln => a.chain(x.ln(), 1.0 / x, -1.0 / (x * x)),
            Function::Sqrt => a.chain(x.sqrt(), 0.5 / x.sqrt(), -0.25 / (x * x.sqrt())),
            Function::Piecewise(function) => pieces::call(function, arguments),
        }
    }

    /// Angle of the vector (`x`, `y`): its rate is (x ẏ - y ẋ) / (x² + y²).
    fn angle(y: Self, x: Self) -> Self {
        let r2 = x * x + y * y;
        let turn = x.value * y.first - y.value * x.first;
        let turn_rate = x.value * y.second - y.value * x.second;
        Self {
            value: y.value.atan2(x.value),
            first: turn / r2.value,
            second: turn_rate / r2.value - turn * r2.first / (r2.value * r2.value),
        }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { value: self.value + b.value, first: self.first + b.first, second: self.second + b.second }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, first: -self.first, second: -self.second }
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self {
            value: self.value * b.value,
            first: self.first * b.value + self.value * b.first,
            second: self.second * b.value + 2.0 * self.first * b.first + self.value * b.second,
        }
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        self * b.power(-1)
    }
}

/// What a formula may ask of the present state.
pub trait State {
    /// Position of a joint coordinate [rad or m].
    fn joint_position(&self, joint: JointId, coordinate: usize) -> f64;
    /// Speed of a joint coordinate [rad/s or m/s].
    fn joint_speed(&self, joint: JointId, coordinate: usize) -> f64;
    /// Component of a point's position in W [m].
    fn point_position(&self, point: PointId, component: usize) -> f64;
    /// Component of a point's velocity in W [m/s].
    fn point_speed(&self, point: PointId, component: usize) -> f64;
}

/// Evaluates `term` at time `t` with `parameters` (all of them, file order). What it asks of `state`
/// counts as constant in time, so derivatives are meant for motion laws, which do not ask.
pub fn evaluate(term: &Term, parameters: &[f64], t: f64, state: &dyn State) -> Jet {
    let down = |a: &Term| evaluate(a, parameters, t, state);
    match term {
        Term::Number(x) => Jet::constant(*x),
        Term::Parameter(id) => Jet::constant(parameters[id.index()]),
        Term::Time => Jet::time(t),
        Term::JointPosition(joint, k) => Jet::constant(state.joint_position(*joint, *k)),
        Term::JointSpeed(joint, k) => Jet::constant(state.joint_speed(*joint, *k)),
        Term::PointPosition(point, k) => Jet::constant(state.point_position(*point, *k)),
        Term::PointSpeed(point, k) => Jet::constant(state.point_speed(*point, *k)),
        Term::Place(_) => unreachable!("only surfaces ask, whose joints the oracle does not know"),
        Term::Neg(a) => -down(a),
        Term::Add(a, b) => down(a) + down(b),
        Term::Sub(a, b) => down(a) - down(b),
        Term::Mul(a, b) => down(a) * down(b),
        Term::Div(a, b) => down(a) / down(b),
        Term::Power(a, n) => down(a).power(*n),
        Term::Table(table, of) => pieces::table(table, down(of)),
        Term::Choice(parts) => {
            let [below, yes, no] = &**parts;
            if down(below).value < 0.0 { down(yes) } else { down(no) }
        }
        Term::Call(function, arguments) => {
            let values: Vec<Jet> = arguments.iter().map(down).collect();
            Jet::call(*function, &values)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Nowhere;
    impl State for Nowhere {
        fn joint_position(&self, _: JointId, _: usize) -> f64 {
            f64::NAN
        }
        fn joint_speed(&self, _: JointId, _: usize) -> f64 {
            f64::NAN
        }
        fn point_position(&self, _: PointId, _: usize) -> f64 {
            f64::NAN
        }
        fn point_speed(&self, _: PointId, _: usize) -> f64 {
            f64::NAN
        }
    }

    const ALL: [Function; 13] = [
        Function::Sin,
        Function::Cos,
        Function::Tan,
        Function::Asin,
        Function::Acos,
        Function::Atan,
        Function::Atan2,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Exp,
        Function::Ln,
        Function::Sqrt,
    ];

    /// `f(0.3 + 0.2 t + 0.1 t³) / (1 + t²) - t^2`, with 2 - t as second argument.
    fn sample(function: Function) -> Term {
        let number = |x| Box::new(Term::Number(x));
        let t = || Box::new(Term::Time);
        let inner = Term::Add(
            Box::new(Term::Add(number(0.3), Box::new(Term::Mul(number(0.2), t())))),
            Box::new(Term::Mul(number(0.1), Box::new(Term::Power(t(), 3)))),
        );
        let call = Term::Call(function, vec![inner, Term::Sub(number(2.0), t())]);
        let quotient =
            Term::Div(Box::new(call), Box::new(Term::Add(number(1.0), Box::new(Term::Power(t(), 2)))));
        Term::Sub(Box::new(quotient), Box::new(Term::Power(t(), 2)))
    }

    #[test]
    fn derivatives_of_every_function_agree_with_central_differences() {
        for function in ALL {
            let term = sample(function);
            let at = |t: f64| evaluate(&term, &[], t, &Nowhere);
            let (t, h) = (0.4, 1e-5);
            let jet = at(t);
            // Central difference of a value with third derivative of order 10: h² * 10 / 6 and eps / h.
            let first = (at(t + h).value - at(t - h).value) / (2.0 * h);
            let second = (at(t + h).first - at(t - h).first) / (2.0 * h);
            assert!((jet.first - first).abs() < 1e-8, "{function:?}: {} {first}", jet.first);
            assert!((jet.second - second).abs() < 1e-8, "{function:?}: {} {second}", jet.second);
        }
    }
}
