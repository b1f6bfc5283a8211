//! The terms of a PID controller, continuous or from sample to sample. In: its formulas. Out: what it puts out, what its states do.
//! Never knows where names stand.
//!
//! Anti-windup by back-calculation, the filtered derivative and its backward difference: K. J. Astrom, T. Hagglund, Advanced PID
//! Control, ISA 2006, 3.3, 3.5 and 13.3.

use super::super::piecewise::Piecewise;
use crate::model::{Function, Term};

/// Formulas of one controller.
pub(super) struct Pid {
    pub(super) measured: Term,
    pub(super) setpoint: Term,
    pub(super) proportional: Option<Term>,
    pub(super) integral: Option<Term>,
    /// Gain and time constant of the filter.
    pub(super) derivative: Option<(Term, Term)>,
    /// Parts of the setpoint that gains see: proportional, derivative.
    pub(super) weights: [Term; 2],
    pub(super) feedforward: Option<Term>,
    pub(super) limits: [Option<Term>; 2],
    /// Time in which the integral gives way.
    pub(super) tracking: Option<Term>,
    /// From sample to sample; nothing of a continuous one.
    pub(super) sample_time: Option<f64>,
}

/// What it does, over the values of its states.
pub(super) struct Action {
    /// What it puts out.
    pub(super) output: Term,
    /// What the integral does: its rate, or its next value.
    pub(super) integral: Option<Term>,
    /// The same of the filter of the derivative.
    pub(super) filtered: Option<Term>,
}

impl Pid {
    /// With the values of its integral and its filter, as far as it has them.
    pub(super) fn action(self, [integral, filtered]: [Option<Term>; 2]) -> Action {
        let Self { measured: y, setpoint: r, sample_time: h, .. } = self;
        let [b, c] = self.weights;
        let seen = |weight| minus(times(weight, r.clone()), y.clone());
        let mut parts: Vec<Term> = Vec::new();
        parts.extend(self.proportional.map(|gain| times(gain, seen(b))));
        parts.extend(integral.clone());
        let mut filter = None;
        if let (Some((gain, lag)), Some(known)) = (self.derivative, filtered) {
            // Backward difference: the filter of the next sample is that of the error of this one.
            let span = h.map_or_else(|| lag.clone(), |h| plus(lag.clone(), Term::Number(h)));
            let slope = over(minus(seen(c), known.clone()), span);
            parts.push(times(gain, slope.clone()));
            filter = Some(step(known, slope, h));
        }
        parts.extend(self.feedforward);
        let wish = parts.into_iter().reduce(plus).unwrap_or(Term::Number(0.0));
        let output = limited(wish.clone(), self.limits);
        let integral = integral.zip(self.integral).map(|(known, gain)| {
            let rate = times(gain, minus(r, y));
            let rate = match self.tracking {
                Some(tracking) => plus(rate, over(minus(output.clone(), wish), tracking)),
                None => rate,
            };
            step(known, rate, h)
        });
        Action { output, integral, filtered: filter }
    }
}

/// The rate of a state, or what it is a sample later.
fn step(known: Term, rate: Term, h: Option<f64>) -> Term {
    match h {
        Some(h) => plus(known, times(Term::Number(h), rate)),
        None => rate,
    }
}

/// No less than the first limit and no more than the second.
pub(super) fn limited(value: Term, [lower, upper]: [Option<Term>; 2]) -> Term {
    let below = upper.into_iter().fold(value, |value, limit| call(Piecewise::Min, [value, limit]));
    lower.into_iter().fold(below, |value, limit| call(Piecewise::Max, [value, limit]))
}

fn plus(a: Term, b: Term) -> Term {
    Term::Add(Box::new(a), Box::new(b))
}

fn minus(a: Term, b: Term) -> Term {
    Term::Sub(Box::new(a), Box::new(b))
}

fn times(a: Term, b: Term) -> Term {
    Term::Mul(Box::new(a), Box::new(b))
}

pub(super) fn over(a: Term, b: Term) -> Term {
    Term::Div(Box::new(a), Box::new(b))
}

pub(super) fn call(function: Piecewise, arguments: [Term; 2]) -> Term {
    Term::Call(Function::Piecewise(function), arguments.into())
}
