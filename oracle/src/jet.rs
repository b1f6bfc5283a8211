//! Numbers with two derivatives by time: truncated Taylor arithmetic.
//! In: numbers. Out: [`Jet`]. Never knows formulas.

use std::ops::{Add, Div, Mul, Neg, Sub};

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

    pub(crate) fn power(self, n: i32) -> Self {
        let (x, m) = (self.value, f64::from(n));
        let slope = if n == 0 { 0.0 } else { m * x.powi(n - 1) };
        let curvature = if n == 0 || n == 1 { 0.0 } else { m * (m - 1.0) * x.powi(n - 2) };
        self.chain(x.powi(n), slope, curvature)
    }

    /// Angle of the vector (`x`, `y`): its rate is (x ẏ - y ẋ) / (x² + y²).
    pub(crate) fn angle(y: Self, x: Self) -> Self {
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
