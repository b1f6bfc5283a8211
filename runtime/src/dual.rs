//! Dual numbers: a value and one directional derivative, carried through every [`Scalar`] operation.
//! In: values with seeds. Out: values with exact derivatives. Serves tests of derivatives and
//! linearisation; never used by the integrators.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::scalar::Scalar;

/// `value + derivative * epsilon` with `epsilon² = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T> {
    /// The value.
    pub value: T,
    /// Its derivative along the seeded direction.
    pub derivative: T,
}

impl<T: Scalar> Dual<T> {
    /// A value whose derivative along the direction is `derivative`.
    #[inline]
    pub fn new(value: T, derivative: T) -> Self {
        Self { value, derivative }
    }

    /// The variable of differentiation: derivative one.
    #[inline]
    pub fn variable(value: T) -> Self {
        Self::new(value, T::constant(1.0))
    }
}

impl<T: Scalar> Add for Dual<T> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.derivative + other.derivative)
    }
}

impl<T: Scalar> Sub for Dual<T> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.derivative - other.derivative)
    }
}

impl<T: Scalar> Mul for Dual<T> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(self.value * other.value, self.derivative * other.value + self.value * other.derivative)
    }
}

impl<T: Scalar> Div for Dual<T> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        Self::new(quotient, (self.derivative - quotient * other.derivative) / other.value)
    }
}

impl<T: Scalar> Neg for Dual<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.value, -self.derivative)
    }
}

impl<T: Scalar> Scalar for Dual<T> {
    type Mask = T::Mask;

    #[inline]
    fn constant(value: f64) -> Self {
        Self::new(T::constant(value), T::constant(0.0))
    }

    #[inline]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        let slope = self.derivative.mul_add(factor.value, summand.derivative);
        Self::new(
            self.value.mul_add(factor.value, summand.value),
            self.value.mul_add(factor.derivative, slope),
        )
    }

    /// The derivative at zero is infinite (or NaN for a zero seed), as it is.
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::new(root, self.derivative / (root + root))
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (Self::new(sine, cosine * self.derivative), Self::new(cosine, -(sine * self.derivative)))
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        Self::new(value, value * self.derivative)
    }

    #[inline]
    fn ln(self) -> Self {
        Self::new(self.value.ln(), self.derivative / self.value)
    }

    #[inline]
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let numerator = self.derivative * x.value - self.value * x.derivative;
        Self::new(self.value.atan2(x.value), numerator / square)
    }

    /// At zero the derivative is that of `+x`.
    #[inline]
    fn abs(self) -> Self {
        let negative = self.value.lt(T::constant(0.0));
        Self::new(self.value.abs(), T::select(negative, -self.derivative, self.derivative))
    }

    /// Where both are equal the derivative is that of `self`.
    #[inline]
    fn max(self, other: Self) -> Self {
        let smaller = self.value.lt(other.value);
        Self::select(smaller, other, self)
    }

    #[inline]
    fn lt(self, other: Self) -> Self::Mask {
        self.value.lt(other.value)
    }

    #[inline]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self::new(T::select(mask, yes.value, no.value), T::select(mask, yes.derivative, no.derivative))
    }

    #[inline]
    fn floor(self) -> Self {
        Self::new(self.value.floor(), T::constant(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type D = Dual<f64>;

    /// Every operation at once, smooth near the points used.
    fn everything<T: Scalar>(x: T) -> T {
        let (s, c) = x.sin_cos();
        let a = (x * x + T::constant(1.0)).sqrt() / (c + T::constant(3.0));
        let b = (-(s * x)).exp() + (x + T::constant(2.0)).ln();
        let d = s.atan2(c + T::constant(2.0)) - a.mul_add(b, x).abs();
        d.max(T::constant(-1e3)) * a
    }

    #[test]
    fn derivative_agrees_with_central_differences() {
        for i in -10..=10 {
            let x = 0.13 * f64::from(i) + 0.017;
            let h = 1e-5;
            let difference = (everything(x + h) - everything(x - h)) / (2.0 * h);
            let exact = everything(D::variable(x)).derivative;
            // Central differences: h² f'''/6 (about 1e-10 here) plus rounding eps/h (1e-11).
            assert!((difference - exact).abs() < 1e-8, "{x}: {difference} {exact}");
        }
    }

    #[test]
    fn value_has_the_bits_of_the_plain_scalar() {
        for i in 0..100 {
            let x = 0.071 * f64::from(i) - 1.9;
            assert_eq!(everything(D::variable(x)).value.to_bits(), everything(x).to_bits());
        }
    }

    #[test]
    fn nesting_gives_second_derivatives() {
        let x = Dual::new(D::variable(0.7), D::constant(1.0));
        let (sine, _) = x.sin_cos();
        assert_eq!(sine.derivative.derivative, -f64::sin_cos(0.7).0);
    }

    #[test]
    fn whole_numbers_below_are_exact_and_do_not_change() {
        for x in
            [-3.0, -2.5, -1e-300, 0.0, 0.499_999_999_999_999_94, 0.5, 1.0 - f64::EPSILON, 7.0, 1e9 + 0.75]
        {
            assert_eq!(Scalar::floor(x), x.floor(), "{x}");
            assert_eq!(D::variable(x).floor(), D::new(x.floor(), 0.0));
        }
    }

    #[test]
    fn selection_takes_the_derivative_of_the_chosen_side() {
        let (x, y) = (D::new(1.0, 5.0), D::new(2.0, 7.0));
        assert_eq!(x.max(y).derivative, 7.0);
        assert_eq!(y.max(x).derivative, 7.0);
        assert_eq!((-x).abs().derivative, 5.0);
    }
}
