//! A wear coefficient that is not the same in every state of the contact: a factor on it, as straight-line steps that generated code
//! writes down. In: pressure, sliding speed, parameters and inputs. Out: the factor. Never knows units or names.

use crate::scalar::Scalar;

/// One value of a factor, from earlier ones by their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A number.
    Number(f64),
    /// What is handed in, by its number: 0 the mean contact pressure [Pa], 1 the sliding speed [m/s], never negative, then parameters
    /// and inputs.
    Given(usize),
    /// `-a`.
    Neg(usize),
    /// Square root.
    Sqrt(usize),
    /// Sine.
    Sin(usize),
    /// Cosine.
    Cos(usize),
    /// e to the power.
    Exp(usize),
    /// Natural logarithm.
    Ln(usize),
    /// The largest whole number that is not above it.
    Floor(usize),
    /// `a + b`.
    Add(usize, usize),
    /// `a - b`.
    Sub(usize, usize),
    /// `a * b`.
    Mul(usize, usize),
    /// `a / b`.
    Div(usize, usize),
    /// `atan2(a, b)`.
    Atan2(usize, usize),
    /// The second where the first is below zero, else the third.
    Select(usize, usize, usize),
}

/// Most steps of a factor: tables have about a dozen a row.
pub const MOST_STEPS: usize = 1024;

/// Most parameters and inputs that a factor may read.
pub const MOST_LIVE: usize = 3;

/// The last value of steps: no more than [`MOST_STEPS`], each of earlier ones; one without steps. A factor below zero is no number.
#[inline]
pub fn factor<T: Scalar>(steps: &[Step], given: &[T]) -> T {
    let c = T::constant;
    let mut values = [c(1.0); MOST_STEPS];
    for (at, step) in steps.iter().enumerate().take(MOST_STEPS) {
        let v = |index: usize| values[index];
        values[at] = match *step {
            Step::Number(value) => c(value),
            Step::Given(index) => given[index],
            Step::Neg(a) => -v(a),
            Step::Sqrt(a) => v(a).sqrt(),
            Step::Sin(a) => v(a).sin_cos().0,
            Step::Cos(a) => v(a).sin_cos().1,
            Step::Exp(a) => v(a).exp(),
            Step::Ln(a) => v(a).ln(),
            Step::Floor(a) => v(a).floor(),
            Step::Add(a, b) => v(a) + v(b),
            Step::Sub(a, b) => v(a) - v(b),
            Step::Mul(a, b) => v(a) * v(b),
            Step::Div(a, b) => v(a) / v(b),
            Step::Atan2(a, b) => v(a).atan2(v(b)),
            Step::Select(a, yes, no) => T::select(v(a).lt(c(0.0)), v(yes), v(no)),
        };
    }
    let last = values[steps.len().clamp(1, MOST_STEPS) - 1];
    T::select(last.lt(c(0.0)), last.sqrt(), last)
}

/// Whether steps are such as [`factor`] takes, with so many values handed in.
pub fn is_sound(steps: &[Step], given: usize) -> bool {
    let known = |(at, step): (usize, &Step)| match *step {
        Step::Number(_) => true,
        Step::Given(index) => index < given,
        Step::Neg(a)
        | Step::Sqrt(a)
        | Step::Sin(a)
        | Step::Cos(a)
        | Step::Exp(a)
        | Step::Ln(a)
        | Step::Floor(a) => a < at,
        Step::Add(a, b) | Step::Sub(a, b) | Step::Mul(a, b) | Step::Div(a, b) | Step::Atan2(a, b) => {
            a < at && b < at
        }
        Step::Select(a, yes, no) => a < at && yes < at && no < at,
    };
    !steps.is_empty() && steps.len() <= MOST_STEPS && steps.iter().enumerate().all(known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_taken_one_after_the_other() {
        // 1 + (p/1e6)^2 where v < 2, else 3.
        let steps = [
            Step::Given(0),
            Step::Number(1e6),
            Step::Div(0, 1),
            Step::Mul(2, 2),
            Step::Number(1.0),
            Step::Add(4, 3),
            Step::Given(1),
            Step::Number(2.0),
            Step::Sub(6, 7),
            Step::Number(3.0),
            Step::Select(8, 5, 9),
        ];
        assert!(is_sound(&steps, 2) && !is_sound(&steps, 1) && !is_sound(&[], 2));
        assert_eq!(factor(&steps, &[2e6, 1.0]), 5.0);
        assert_eq!(factor(&steps, &[2e6, 2.0]), 3.0);
    }

    #[test]
    fn what_is_below_zero_is_no_number() {
        assert!(factor(&[Step::Number(-1.0)], &[0.0, 0.0]).is_nan());
        assert!(!is_sound(&[Step::Neg(0)], 2), "of itself");
    }
}
