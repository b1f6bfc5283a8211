//! How many digits rounding costs: forward dynamics in double precision against the same operations in arithmetic of 31 digits.

mod support;
mod truth;

use std::ops::{Add, Div, Mul, Neg, Sub};

use linkwear_codegen::compile::Compiled;
use linkwear_runtime::{CONTACT_WRENCH, Entry, Scalar, System, assemble};
use nalgebra::DMatrix;
use support::random::Random;
use support::{compile_source, compiled, evaluate, in_data};
use truth::reached;

/// An unevaluated sum of two doubles, 31 digits (T. J. Dekker, Numer. Math. 18 (1971) 224).
#[derive(Clone, Copy)]
struct Wide(f64, f64);

/// A sum and its rounding.
fn two_sum(a: f64, b: f64) -> Wide {
    let sum = a + b;
    let part = sum - a;
    Wide(sum, (a - (sum - part)) + (b - part))
}

impl Wide {
    /// Of a number and a much smaller one.
    fn normal(a: f64, b: f64) -> Self {
        let sum = a + b;
        Self(sum, b - (sum - a))
    }

    /// Halved ten times, so that series are short.
    fn small(self) -> Self {
        Self(self.0 / 1024.0, self.1 / 1024.0)
    }

    fn over(self, divisor: i32) -> Self {
        self / Self::constant(f64::from(divisor))
    }
}

impl Add for Wide {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.0, other.0), two_sum(self.1, other.1));
        let first = Self::normal(high.0, high.1 + low.0);
        Self::normal(first.0, first.1 + low.1)
    }
}

impl Sub for Wide {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Wide {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rounding = f64::mul_add(self.0, other.0, -product);
        Self::normal(product, rounding + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div for Wide {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = Self(self.0 / other.0, 0.0);
        let second = Self((self - other * first).0 / other.0, 0.0);
        let third = Self((self - other * first - other * second).0 / other.0, 0.0);
        first + second + third
    }
}

impl Neg for Wide {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Scalar for Wide {
    type Mask = bool;

    fn constant(value: f64) -> Self {
        Self(value, 0.0)
    }

    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }

    /// By Newton's method from 16 digits.
    fn sqrt(self) -> Self {
        let root = Self::constant(self.0.sqrt());
        if self.0 > 0.0 { (root + self / root) * Self::constant(0.5) } else { root }
    }

    /// The series of a thousandth of the angle, doubled ten times; angles here are of a few turns.
    fn sin_cos(self) -> (Self, Self) {
        let (angle, one) = (self.small(), Self::constant(1.0));
        let square = angle * angle;
        // The last terms are below 1e-36.
        let series = |first: i32| {
            (0..7).rev().map(|k| first + 2 * k).fold(one, |sum, at| one - square.over(at * (at + 1)) * sum)
        };
        let (mut sine, mut cosine) = (series(2) * angle, series(1));
        for _ in 0..10 {
            (sine, cosine) = (Self::constant(2.0) * sine * cosine, cosine * cosine - sine * sine);
        }
        (sine, cosine)
    }

    /// Likewise, squared ten times; powers here are of some tens.
    fn exp(self) -> Self {
        let (power, one) = (self.small(), Self::constant(1.0));
        let series = (1..=14).rev().fold(one, |sum, at| one + power.over(at) * sum);
        (0..10).fold(series, |value, _| value * value)
    }

    /// By Newton's method, as the next.
    fn ln(self) -> Self {
        let first = Self::constant(self.0.ln());
        first + (self / first.exp() - Self::constant(1.0))
    }

    fn atan2(self, x: Self) -> Self {
        let first = Self::constant(self.0.atan2(x.0));
        let (sine, cosine) = first.sin_cos();
        first + (self * cosine - x * sine) / (x * cosine + self * sine)
    }

    fn abs(self) -> Self {
        if self.0 < 0.0 { -self } else { self }
    }

    fn max(self, other: Self) -> Self {
        if other.lt(self) { self } else { other }
    }

    fn lt(self, other: Self) -> bool {
        (self - other).0 < 0.0
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

/// Of the loop Jacobian, whose last columns of the closures' answer it is.
fn condition(closure: &[f64], rows: usize, speeds: usize) -> f64 {
    if rows == 0 {
        return 1.0;
    }
    let jacobian = DMatrix::from_row_slice(rows, speeds, &closure[closure.len() - rows * speeds..]);
    let values = jacobian.singular_values();
    values.max() / values.min()
}

/// Largest error of accelerations, multipliers and drive forces, beside the largest number of the answer, over 20 states whose
/// loops are well conditioned; and how many such states there were.
fn worst(compiled: &Compiled) -> (f64, usize) {
    let system = compiled.interpreter();
    let sizes = System::<f64>::sizes(&system);
    let parameters = compiled.parameters();
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut worst, mut states) = (0.0_f64, 0);
    for at in 0..200 {
        if states == 20 {
            break;
        }
        let t = 0.0137 * f64::from(at);
        let Ok(mut state) = assemble(&system, compiled.description(), &parameters, t) else { continue };
        // Beside closed positions, what is lost to rounding is the same. What nothing drives is set in motion.
        let push = if sizes.drivers == 0 { 1.0 } else { 1e-3 };
        state.q.iter_mut().for_each(|place| *place += 1e-3 * random.next());
        state.v.iter_mut().for_each(|speed| *speed += push * random.next());
        let wrenches = (0..CONTACT_WRENCH * sizes.contacts).map(|_| 10.0 * random.next());
        let base = [parameters.as_slice(), &[t], &state.q, &state.v].concat();
        let closure = evaluate::<f64>(&system, Entry::Closure, &base);
        if condition(&closure, sizes.rows, sizes.speeds) > 1e6 {
            continue;
        }
        states += 1;
        let input: Vec<f64> = base.into_iter().chain(wrenches).collect();
        let found = evaluate::<f64>(&system, Entry::ForwardDynamics, &input);
        let wide: Vec<Wide> = input.iter().map(|value| Wide::constant(*value)).collect();
        let exact = evaluate(&system, Entry::ForwardDynamics, &wide);
        let asked = sizes.speeds + sizes.rows + sizes.drivers;
        let (found, exact) = (&found[..asked], &exact[..asked]);
        let size = found.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let off = |(x, y): (&f64, &Wide)| (*y - Wide::constant(*x)).0.abs() / size;
        worst =
            found.iter().zip(exact).map(off).fold(worst, |worst, off| if off <= worst { worst } else { off });
    }
    (worst, states)
}

#[test]
fn functions_have_far_more_digits_than_a_double() {
    let one = Wide::constant(1.0);
    for at in 1..40 {
        let x = Wide::constant(0.17 * f64::from(at));
        let (sine, cosine) = x.sin_cos();
        let defects = [
            sine * sine + cosine * cosine - one,
            sine.atan2(cosine).sin_cos().0 - sine,
            x.exp() * (-x).exp() - one,
            x.exp().ln() / x - one,
            x.sqrt() * x.sqrt() / x - one,
            one / x * x - one,
        ];
        for (which, defect) in defects.into_iter().enumerate() {
            // Roundings of 1e-32, which ten doublings or squarings make some thousand times as large.
            assert!(defect.0.abs() < 1e-27, "{which} at {at}: {:e}", defect.0);
        }
    }
}

#[test]
fn forward_dynamics_loses_few_digits() {
    for name in [
        "andrews",
        "bennett",
        "bricard",
        "flyball",
        "four_bar",
        "n_four_bar_2",
        "pendulum",
        "rssr",
        "rssr_ball_wear",
        "rssr_flexible",
        "rssr_rigid",
        "six_bar",
        "slider_crank",
        "slider_crank_clearance",
        "spatial_slider_crank",
    ] {
        is_exact(name, &compiled(name, &[], None));
    }
    for name in ["delta", "stewart"] {
        is_exact(name, &compile_source(&in_data(name), &[], None));
    }
}

fn is_exact(name: &str, compiled: &Compiled) {
    let (error, states) = worst(compiled);
    assert_eq!(states, 20, "{name}");
    // A condition of 1e4 on roundings of 1e-16.
    reached(&format!("{name}, rounding"), "forward dynamics beside 31 digits, of the largest", error, 1e-12);
}
