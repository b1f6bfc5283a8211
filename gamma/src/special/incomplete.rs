//! The regularised incomplete Gamma functions P and Q and their logarithms. In: shape and x or ln x. Out:
//! probabilities that stay right in both tails. Never knows what the probabilities are of.
//!
//! Three expansions share the plane: for shape >= 1 and x < shape + 1 the power series of P; for shape < 1 and x < 1
//! Gautschi's form of Q, which does not subtract from 1; elsewhere the continued fraction of Q (Legendre, by modified
//! Lentz).

use super::ln_gamma::{ln_1m_exp, ln_gamma, ln_gamma_1p};

/// Terms after which an expansion ends in any case. It takes about 10 sqrt(shape) of them: enough for shape 1e8.
const MOST_TERMS: u32 = 200_000;
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
    if x == f64::INFINITY {
        return (0.0, f64::NEG_INFINITY);
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
        - 0.5 * libm::log(2.0 * core::f64::consts::PI * shape)
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
        if term.abs() <= NEGLIGIBLE * sum.abs() || term == 0.0 {
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
