//! The regularised incomplete Gamma functions P and Q and their logarithms. In: shape and x or ln x. Out:
//! probabilities that stay right in both tails. Never knows what the probabilities are of.
//!
//! Four expansions share the plane: for shape >= 1 and x < shape + 1 the power series of P; for shape < 1 and x < 1
//! Gautschi's form of Q, which does not subtract from 1; for large shapes and x near them Temme's uniform expansion;
//! elsewhere the continued fraction of Q (Legendre, by modified Lentz).

use core::f64::consts::PI;

use super::ln_gamma::{ln_1m_exp, ln_gamma, ln_gamma_1p};
use super::normal::normal_mills;

/// Terms after which an expansion ends in any case. It takes about 10 sqrt(shape) of them below [`LARGE`].
const MOST_TERMS: u32 = 200_000;
/// Shape from which on the uniform expansion holds to the last digits with the two terms it has here: the third is below
/// 1e-3 / shape^2.5 of the whole. Series and fraction would take more terms than this allows from shape 4e8 on.
const LARGE: f64 = 3e4;
/// The same for its slope.
const LARGE_FOR_SLOPES: f64 = 1e6;
/// How far x may be from the shape there, as a part of the shape: the coefficients below hold to 2e-17. Farther out series
/// and fraction take some hundred terms.
const NEAR: f64 = 0.29;
/// Relative size of a term that no longer counts.
const NEGLIGIBLE: f64 = 1.1e-16;

/// P(shape, x): the probability that Gamma(shape, 1) is at most x. `shape` > 0.
pub fn gamma_p(shape: f64, x: f64) -> f64 {
    libm::exp(ln_gamma_p(shape, x))
}

/// Q(shape, x) = 1 - P(shape, x), without subtracting from 1 where that would lose digits.
pub fn gamma_q(shape: f64, x: f64) -> f64 {
    libm::exp(ln_gamma_q(shape, x))
}

/// ln P(shape, x); minus infinity for x <= 0.
pub fn ln_gamma_p(shape: f64, x: f64) -> f64 {
    if x <= 0.0 { f64::NEG_INFINITY } else { ln_both(shape, x, libm::log(x)).0 }
}

/// ln Q(shape, x); 0 for x <= 0.
pub fn ln_gamma_q(shape: f64, x: f64) -> f64 {
    if x <= 0.0 { 0.0 } else { ln_both(shape, x, libm::log(x)).1 }
}

/// ln P(shape, exp(ln_x)), also where x itself underflows: the law of ln G for shapes far below 1.
pub fn ln_gamma_p_of_ln(shape: f64, ln_x: f64) -> f64 {
    ln_both(shape, libm::exp(ln_x), ln_x).0
}

/// ln P and ln Q; x = exp(ln_x), which may have underflowed to 0.
pub(super) fn ln_both(shape: f64, x: f64, ln_x: f64) -> (f64, f64) {
    if shape.is_nan() || ln_x.is_nan() || shape <= 0.0 {
        return (f64::NAN, f64::NAN);
    }
    if ln_x == f64::NEG_INFINITY {
        return (f64::NEG_INFINITY, 0.0);
    }
    if shape == f64::INFINITY {
        return if x < shape { (f64::NEG_INFINITY, 0.0) } else { (f64::NAN, f64::NAN) };
    }
    if x == f64::INFINITY {
        return (0.0, f64::NEG_INFINITY);
    }
    if let Some(expansion) = Uniform::at(shape, x, ln_x) {
        return expansion.ln_both();
    }
    let head = ln_head(shape, x, ln_x);
    if shape < 1.0 && x < 1.0 {
        let q = upper_small(shape, x, ln_x);
        let ln_p = if q < 0.5 { libm::log1p(-q) } else { head + libm::log(power_series(shape, x)) };
        return (ln_p, if q < 0.5 { libm::log(q) } else { ln_1m_exp(ln_p) });
    }
    if shape >= 1.0 && x < shape + 1.0 {
        let ln_p = (head + libm::log(power_series(shape, x))).min(0.0);
        (ln_p, ln_1m_exp(ln_p))
    } else {
        let ln_q = (head + libm::log(shape * fraction(shape, x))).min(0.0);
        (ln_1m_exp(ln_q), ln_q)
    }
}

/// The uniform expansion of N. M. Temme, SIAM J. Math. Anal. 10 (1979) 757: with lambda = x / a, eta of the sign of
/// lambda - 1, eta²/2 = lambda - 1 - ln lambda, and z = eta sqrt(a),
/// Q(a, x) = Phi(-z) + phi(z) [C0(eta) + C1(eta) / a] / sqrt(a).
pub(super) struct Uniform {
    shape: f64,
    eta: f64,
    ln_lambda: f64,
}

/// Coefficients of C0 and C1 by powers of eta (A. R. DiDonato, A. H. Morris, ACM TOMS 12 (1986) 377).
const C0: [f64; 15] = [
    -1.0 / 3.0,
    1.0 / 12.0,
    -0.014_814_814_814_814_815,
    0.001_157_407_407_407_407_4,
    0.000_352_733_686_067_019_4,
    -0.000_178_755_144_032_921_8,
    3.919_263_178_522_438e-5,
    -2.185_448_510_679_992_2e-6,
    -1.854_062_210_715_16e-6,
    8.296_711_340_953_086e-7,
    -1.766_595_273_682_607_9e-7,
    6.707_853_543_401_498e-9,
    1.026_180_978_424_030_8e-8,
    -4.382_036_018_453_353e-9,
    9.147_699_582_236_79e-10,
];
const C1: [f64; 8] = [
    -0.001_851_851_851_851_852,
    -0.003_472_222_222_222_222,
    0.002_645_502_645_502_645_5,
    -0.000_990_226_337_448_559_7,
    0.000_205_761_316_872_427_98,
    -4.018_775_720_164_609e-7,
    -1.809_855_033_448_997_8e-5,
    7.649_160_916_081_11e-6,
];

fn polynomial(coefficients: &[f64], at: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * at + coefficient)
}

impl Uniform {
    /// None where the expansion is not for.
    pub(super) fn at(shape: f64, x: f64, ln_x: f64) -> Option<Self> {
        Self::from(LARGE, shape, x, ln_x)
    }

    /// None where its slope is not to be had from it.
    pub(super) fn for_slope(shape: f64, x: f64, ln_x: f64) -> Option<Self> {
        Self::from(LARGE_FOR_SLOPES, shape, x, ln_x)
    }

    fn from(least: f64, shape: f64, x: f64, ln_x: f64) -> Option<Self> {
        if !(shape >= least && (x - shape).abs() <= NEAR * shape) {
            return None;
        }
        let mu = (x - shape) / shape;
        let eta = libm::copysign(libm::sqrt(2.0 * excess(mu, ln_x - libm::log(shape))), mu);
        Some(Self { shape, eta, ln_lambda: libm::log1p(mu) })
    }

    fn z(&self) -> f64 {
        self.eta * libm::sqrt(self.shape)
    }

    /// What the sum adds to Mills' ratio.
    fn correction(&self) -> f64 {
        (polynomial(&C0, self.eta) + polynomial(&C1, self.eta) / self.shape) / libm::sqrt(self.shape)
    }

    /// ln of the smaller of P and Q by its ratio to the normal density; the other from it.
    fn ln_both(&self) -> (f64, f64) {
        let (z, correction) = (self.z(), self.correction());
        let ln_density = -0.5 * (z * z + libm::log(2.0 * PI));
        if z >= 0.0 {
            let ln_q = ln_density + libm::log(normal_mills(z) + correction);
            (ln_1m_exp(ln_q), ln_q)
        } else {
            let ln_p = ln_density + libm::log(normal_mills(-z) - correction);
            (ln_p, ln_1m_exp(ln_p))
        }
    }

    /// -d ln P / d shape at fixed x, from d(z²/2)/da = -ln lambda. Relative accuracy 1e-12.
    pub(super) fn slope(&self) -> f64 {
        let (z, root, correction) = (self.z(), libm::sqrt(self.shape), self.correction());
        let ratio = if self.eta == 0.0 { 1.0 } else { self.ln_lambda / self.eta };
        let z_slope = -ratio / root;
        let eta_slope = z_slope / root - 0.5 * self.eta / self.shape;
        // C0' to first order of what is itself a correction of order 1 / shape.
        let bend = (C0[1] + 2.0 * C0[2] * self.eta) * eta_slope / root - 0.5 * correction / self.shape;
        let falling = bend - z_slope + self.ln_lambda * correction;
        if z < 0.0 {
            return falling / (normal_mills(-z) - correction);
        }
        let ln_density = -0.5 * (z * z + libm::log(2.0 * PI));
        falling * libm::exp(ln_density - self.ln_both().0)
    }
}

/// ln [x^shape e^-x / Gamma(shape + 1)]. At large shapes by Stirling around x = shape, where the plain form cancels.
fn ln_head(shape: f64, x: f64, ln_x: f64) -> f64 {
    if shape < 10.0 {
        return shape * ln_x - x - ln_gamma_1p(shape);
    }
    if x == 0.0 {
        return shape * ln_x - ln_gamma(shape + 1.0);
    }
    let r = 1.0 / (shape * shape);
    let stirling = (1.0 / 12.0
        - r * (1.0 / 360.0
            - r * (1.0 / 1260.0 - r * (1.0 / 1680.0 - r * (1.0 / 1188.0 - r * 691.0 / 360_360.0)))))
        / shape;
    -shape * excess((x - shape) / shape, ln_x - libm::log(shape))
        - 0.5 * libm::log(2.0 * PI * shape)
        - stirling
}

/// t - ln(1 + t), with the logarithm given for large t.
fn excess(t: f64, ln_1p: f64) -> f64 {
    if t.abs() > 0.5 {
        return t - ln_1p;
    }
    // ln(1 + t) = 2 atanh(s), s = t / (2 + t), and t - 2 s = s t.
    let s = t / (2.0 + t);
    let square = s * s;
    let (mut power, mut sum, mut odd) = (s * square, 0.0, 3.0);
    loop {
        let term = power / odd;
        sum += term;
        // What is not a number ends too.
        if term.is_nan() || term.abs() <= NEGLIGIBLE * sum.abs() {
            return s * t - 2.0 * sum;
        }
        power *= square;
        odd += 2.0;
    }
}

/// Sum of x^n / ((shape + 1) .. (shape + n)).
fn power_series(shape: f64, x: f64) -> f64 {
    let (mut term, mut sum, mut divisor) = (1.0, 1.0, shape);
    for _ in 0..MOST_TERMS {
        divisor += 1.0;
        term *= x / divisor;
        sum += term;
        if term <= NEGLIGIBLE * sum {
            break;
        }
    }
    sum
}

/// The continued fraction of Gamma(shape, x) / (x^shape e^-x).
fn fraction(shape: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let mut b = x + 1.0 - shape;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut value = d;
    for n in 1..MOST_TERMS {
        let n = f64::from(n);
        let a = -n * (n - shape);
        b += 2.0;
        d = a * d + b;
        c = b + a / c;
        d = 1.0 / if d.abs() < TINY { TINY } else { d };
        c = if c.abs() < TINY { TINY } else { c };
        let factor = c * d;
        value *= factor;
        if (factor - 1.0).abs() <= 2.0 * NEGLIGIBLE {
            break;
        }
    }
    value
}

/// Q for shape < 1 and x < 1, W. Gautschi, ACM TOMS 5 (1979) 466: [1 - x^a / Gamma(1 + a)] and the rest of the series.
fn upper_small(shape: f64, x: f64, ln_x: f64) -> f64 {
    let exponent = shape * ln_x - ln_gamma_1p(shape);
    let (mut power, mut sum) = (1.0, 0.0);
    for n in 1..30 {
        let n = f64::from(n);
        power *= -x / n;
        let term = power / (shape + n);
        sum += term;
        if term.abs() <= NEGLIGIBLE * sum.abs() {
            break;
        }
    }
    -libm::expm1(exponent) - libm::exp(exponent) * shape * sum
}
