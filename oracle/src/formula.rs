//! The evaluation of formulas on numbers with two derivatives by time.
//! In: [`Term`]. Out: [`Jet`]. Never knows expression graphs: derivatives come from truncated Taylor
//! arithmetic, not from symbolic rules.

use linkwear_codegen::id::{JointId, PointId};
use linkwear_codegen::model::{Function, Term};

use crate::jet::Jet;
use crate::pieces;

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
    /// Component of the place that a surface is an equation of [m].
    fn place(&self, _: usize) -> Jet {
        Jet::constant(f64::NAN)
    }
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
        Term::Place(k) => state.place(*k),
        // Refused before a model is made.
        Term::BodySpin(..) | Term::ForceValue(..) | Term::Response(_) | Term::State(_) => {
            Jet::constant(f64::NAN)
        }
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
            call(*function, &values)
        }
    }
}

fn call(function: Function, arguments: &[Jet]) -> Jet {
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
        Function::Atan2 => Jet::angle(a, arguments[1]),
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
