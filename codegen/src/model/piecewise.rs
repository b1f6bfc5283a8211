//! Functions of formulas that are put together of pieces, and motion laws, which rest outside their rise: each written once, over
//! numbers or expressions. In: [`Value`]s. Out: values. Branches are choices between two values that are both there.
//!
//! Motion laws: a phase s from 0 to 1 becomes a rise from 0 to 1, with dwells before and after. Sources: R. L. Norton, Cam Design and
//! Manufacturing Handbook, 2nd ed. (2009), chapters 3 and 4 (cycloidal, modified sine, 3-4-5 and 4-5-6-7 polynomials); L. Biagiotti, C.
//! Melchiorri, Trajectory Planning for Automatic Machines and Robots (2008), 3.2 and 3.4 (trapezoidal and double S speed).

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What pieces are made of: numbers, or expressions.
pub trait Value:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A number.
    fn number(self, value: f64) -> Self;
    /// Sine of an angle [rad].
    fn sine(self) -> Self;
    /// Square root.
    fn root(self) -> Self;
    /// The largest whole number that is not above it.
    fn whole(self) -> Self;
    /// `yes` where it is below zero, else `no`.
    fn choose(self, yes: Self, no: Self) -> Self;
    /// The same, where both sides meet so well that no step has to end there.
    fn choose_quietly(self, yes: Self, no: Self) -> Self {
        self.choose(yes, no)
    }
}

impl Value for f64 {
    fn number(self, value: f64) -> Self {
        value
    }

    fn sine(self) -> Self {
        self.sin()
    }

    fn root(self) -> Self {
        self.sqrt()
    }

    fn whole(self) -> Self {
        self.floor()
    }

    fn choose(self, yes: Self, no: Self) -> Self {
        if self < 0.0 { yes } else { no }
    }
}

/// A function with pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Piecewise {
    /// Magnitude.
    Abs,
    /// -1, 0 or 1.
    Sign,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
    /// A value, but no less than the second and no more than the third argument.
    Clamp,
    /// 0 below zero, 1 from there on.
    Step,
    /// The largest whole number that is not above it.
    Floor,
    /// What is left of the first after whole times the second, from 0 on.
    Mod,
    /// A magnitude without its kink.
    SmoothAbs,
    /// A sign without its jump.
    SmoothSign,
    /// A step without its jump.
    SmoothStep,
    /// Rise with a speed that is a trapezoid over time.
    Trapezoid,
    /// Rise with an acceleration of two triangles and a dwell between: the jerk is constant piece by piece.
    SCurve,
    /// Rise with an acceleration that is one sine.
    Cycloidal,
    /// Rise with an acceleration of a quarter, a slow half and a quarter of sines.
    ModifiedSine,
    /// Rise by a polynomial of powers 3 to 5.
    Poly345,
    /// Rise by a polynomial of powers 4 to 7.
    Poly4567,
}

/// Of how many derivatives a function without kinks is sure.
pub const SMOOTH: i32 = 99;

impl Piecewise {
    /// The last derivative that is still continuous: 0 the value itself, -1 it jumps.
    pub const fn continuity(self) -> i32 {
        match self {
            Self::Sign | Self::Step | Self::Floor | Self::Mod => -1,
            Self::Abs | Self::Min | Self::Max | Self::Clamp => 0,
            Self::Trapezoid => 1,
            Self::SmoothStep | Self::SCurve | Self::Cycloidal | Self::ModifiedSine | Self::Poly345 => 2,
            Self::Poly4567 => 3,
            Self::SmoothAbs | Self::SmoothSign => SMOOTH,
        }
    }

    /// As formulas call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Abs => "abs",
            Self::Sign => "sign",
            Self::Min => "min",
            Self::Max => "max",
            Self::Clamp => "clamp",
            Self::Step => "step",
            Self::Floor => "floor",
            Self::Mod => "mod",
            Self::SmoothAbs => "smooth_abs",
            Self::SmoothSign => "smooth_sign",
            Self::SmoothStep => "smooth_step",
            Self::Trapezoid => "trapezoid",
            Self::SCurve => "s_curve",
            Self::Cycloidal => "cycloidal",
            Self::ModifiedSine => "modified_sine",
            Self::Poly345 => "poly345",
            Self::Poly4567 => "poly4567",
        }
    }

    /// Part of the rise in which the speed grows, if the law is given none.
    const RAMP: f64 = 1.0 / 3.0;

    /// Its value; `arguments` as many as it takes.
    pub fn of<V: Value>(self, arguments: &[V]) -> V {
        let x = arguments[0];
        let [zero, one] = [0.0, 1.0].map(|number| x.number(number));
        let argument = |at: usize| arguments.get(at).copied();
        let second = argument(1).unwrap_or(zero);
        match self {
            Self::Abs => x.choose(-x, x),
            Self::Sign => x.choose(-one, (-x).choose(one, zero)),
            Self::Min => smaller(x, second),
            Self::Max => larger(x, second),
            Self::Clamp => smaller(larger(x, second), argument(2).unwrap_or(zero)),
            Self::Step => x.choose(zero, one),
            Self::Floor => x.whole(),
            Self::Mod => x - second * (x / second).whole(),
            Self::SmoothAbs => hypotenuse(x, second),
            Self::SmoothSign => x / hypotenuse(x, second),
            Self::SmoothStep => poly345(limited(x / second + x.number(0.5))),
            Self::Trapezoid | Self::SCurve => {
                let ramp = argument(1).unwrap_or(x.number(Self::RAMP));
                repeated(x, argument(2), |s| self.ramped(s, ramp))
            }
            Self::Cycloidal => repeated(x, argument(1), cycloidal),
            Self::ModifiedSine => repeated(x, argument(1), modified_sine),
            Self::Poly345 => repeated(x, argument(1), poly345),
            Self::Poly4567 => repeated(x, argument(1), poly4567),
        }
    }

    /// Speed that grows in the first `ramp` of the phase, stays, and falls again in the last.
    fn ramped<V: Value>(self, s: V, ramp: V) -> V {
        let [half, one] = [0.5, 1.0].map(|number| s.number(number));
        let speed = one / (one - ramp);
        let part = |u: V| if self == Self::SCurve { eased(u) } else { half * (u * u) };
        let (begin, end) = (ramp * part(limited(s / ramp)), ramp * part(limited((one - s) / ramp)));
        let late = (one - ramp) - end;
        let middle = s - half * ramp;
        speed * (s - ramp).choose(begin, (one - ramp - s).choose(late, middle))
    }
}

fn smaller<V: Value>(a: V, b: V) -> V {
    (b - a).choose(b, a)
}

fn larger<V: Value>(a: V, b: V) -> V {
    (a - b).choose(b, a)
}

/// Within 0 and 1.
fn limited<V: Value>(s: V) -> V {
    smaller(larger(s, s.number(0.0)), s.number(1.0))
}

fn hypotenuse<V: Value>(x: V, width: V) -> V {
    (x * x + width * width).root()
}

/// A law with its dwells; with a `period` of the phase it goes on from there one higher, again and again.
fn repeated<V: Value>(s: V, period: Option<V>, law: impl Fn(V) -> V) -> V {
    let Some(period) = period else { return law(limited(s)) };
    let round = (s / period).whole();
    round + law(limited(s - round * period))
}

/// Way in a ramp of acceleration that grows and falls evenly, to half the ramp at its end.
fn eased<V: Value>(u: V) -> V {
    let [half, two_thirds, one] = [0.5, 2.0 / 3.0, 1.0].map(|number| u.number(number));
    let left = one - u;
    let late = (u - half) + two_thirds * (left * left * left);
    (u - half).choose(two_thirds * (u * u * u), late)
}

fn poly345<V: Value>(s: V) -> V {
    let [c3, c4, c5] = [10.0, -15.0, 6.0].map(|number| s.number(number));
    s * s * s * (c3 + s * (c4 + s * c5))
}

fn poly4567<V: Value>(s: V) -> V {
    let [c4, c5, c6, c7] = [35.0, -84.0, 70.0, -20.0].map(|number| s.number(number));
    let square = s * s;
    square * square * (c4 + s * (c5 + s * (c6 + s * c7)))
}

fn cycloidal<V: Value>(s: V) -> V {
    let turn = s.number(2.0 * PI);
    s - (turn * s).sine() / turn
}

/// Norton, table 3-2: quarters of a sine of half the length at both ends, a half sine between.
fn modified_sine<V: Value>(s: V) -> V {
    let c = |number: f64| s.number(number);
    let angle = c(PI) * s;
    let fast = c(0.25) * (c(4.0) * angle).sine();
    let slow = c(2.0) - c(2.25) * ((c(PI) + c(4.0) * angle) / c(3.0)).sine();
    let middle_or_end = (c(0.875) - s).choose(c(4.0) - fast, slow);
    (angle + (s - c(0.125)).choose(-fast, middle_or_end)) / c(4.0 + PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(law: Piecewise, s: f64) -> f64 {
        law.of(&[s])
    }

    /// Largest first and second derivative over the rise, by differences.
    fn peaks(of: Piecewise) -> [f64; 2] {
        let (n, h) = (4000, 1e-4);
        (0..=n).map(|k| f64::from(k) / f64::from(n)).fold([0.0_f64; 2], |[v, a], s| {
            let [before, here, after] = [s - h, s, s + h].map(|s| law(of, s));
            [v.max((after - before) / (2.0 * h)), a.max((after - 2.0 * here + before) / (h * h))]
        })
    }

    const RISES: [Piecewise; 6] = [
        Piecewise::Trapezoid,
        Piecewise::SCurve,
        Piecewise::Cycloidal,
        Piecewise::ModifiedSine,
        Piecewise::Poly345,
        Piecewise::Poly4567,
    ];

    #[test]
    fn peaks_are_the_published_ones() {
        // Norton 2009, table 3-3; trapezoid and double S with ramps of a third: 1/(1 - a), 1/(a (1 - a)), twice that.
        for (of, speed, acceleration) in [
            (Piecewise::Trapezoid, 1.5, 4.5),
            (Piecewise::SCurve, 1.5, 9.0),
            (Piecewise::Cycloidal, 2.0, 2.0 * PI),
            (Piecewise::ModifiedSine, 1.760, 5.528),
            (Piecewise::Poly345, 1.875, 5.774),
            // Norton prints 7.526; the largest value of his polynomial's second derivative is 7.513.
            (Piecewise::Poly4567, 2.188, 7.513),
        ] {
            let [v, a] = peaks(of);
            // Printed to four digits; differences over 2e-4 of the phase round peaks off by less.
            assert!((v - speed).abs() < 1e-3, "{of:?}: speed {v}");
            assert!((a - acceleration).abs() < 5e-3, "{of:?}: acceleration {a}");
        }
    }

    #[test]
    fn laws_rise_from_zero_to_one_by_half_in_the_middle_and_rest_outside() {
        for of in RISES {
            for (s, value) in [(-0.3, 0.0), (0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (7.0, 1.0)] {
                // A few roundings of numbers about one.
                assert!((law(of, s) - value).abs() < 1e-15, "{of:?} at {s}: {}", law(of, s));
            }
        }
    }

    #[test]
    fn pieces_meet_with_as_many_derivatives_as_told() {
        for of in RISES {
            for s in [0.0, 0.125, 1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0, 5.0 / 6.0, 0.875, 1.0] {
                // Second differences on both sides of a joint differ by h times the third derivative, up to 200 here; a jump of
                // the speed would be seen in the first ones.
                let h = 1e-3;
                let second = |at: f64| (law(of, at + h) - 2.0 * law(of, at) + law(of, at - h)) / (h * h);
                let first = |at: f64| (law(of, at + h) - law(of, at - h)) / (2.0 * h);
                assert!((first(s + h) - first(s - h)).abs() < 20.0 * h, "{of:?} at {s}");
                if of.continuity() > 1 {
                    assert!((second(s + h) - second(s - h)).abs() < 0.5, "{of:?} at {s}");
                }
            }
        }
    }

    #[test]
    fn a_period_adds_a_rise_each_time() {
        for of in [Piecewise::Cycloidal, Piecewise::ModifiedSine, Piecewise::Poly345, Piecewise::Poly4567] {
            for (s, round) in [(-3.7, -2.0), (0.4, 0.0), (2.2, 1.0), (4.9, 2.0)] {
                let value = of.of(&[s, 2.0]);
                // The same phase after a whole period, but for the rounding of the sum.
                assert!((value - round - law(of, s - 2.0 * round)).abs() < 1e-14, "{of:?} at {s}: {value}");
            }
        }
    }

    #[test]
    fn pieces_are_what_their_names_say() {
        let of = |function: Piecewise, arguments: &[f64]| function.of(arguments);
        assert_eq!([-2.0, 0.0, 3.0].map(|x| of(Piecewise::Abs, &[x])), [2.0, 0.0, 3.0]);
        assert_eq!([-2.0, 0.0, 3.0].map(|x| of(Piecewise::Sign, &[x])), [-1.0, 0.0, 1.0]);
        assert_eq!([-2.0, 0.0, 3.0].map(|x| of(Piecewise::Step, &[x])), [0.0, 1.0, 1.0]);
        assert_eq!([of(Piecewise::Min, &[2.0, 3.0]), of(Piecewise::Min, &[3.0, 2.0])], [2.0; 2]);
        assert_eq!([of(Piecewise::Max, &[2.0, 3.0]), of(Piecewise::Max, &[3.0, 2.0])], [3.0; 2]);
        assert_eq!([-2.0, 0.3, 3.0].map(|x| of(Piecewise::Clamp, &[x, -1.0, 1.0])), [-1.0, 0.3, 1.0]);
        assert_eq!([-0.5, 0.5, 2.5].map(|x| of(Piecewise::Mod, &[x, 2.0])), [1.5, 0.5, 0.5]);
        assert_eq!([3.0, -3.0].map(|x| of(Piecewise::SmoothAbs, &[x, 4.0])), [5.0; 2]);
        assert_eq!([3.0, -3.0].map(|x| of(Piecewise::SmoothSign, &[x, 4.0])), [0.6, -0.6]);
        assert_eq!([-2.0, 0.0, 2.0].map(|x| of(Piecewise::SmoothStep, &[x, 4.0])), [0.0, 0.5, 1.0]);
    }
}
