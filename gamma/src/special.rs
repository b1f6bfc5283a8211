//! Special functions of the Gamma law. In and out: numbers. Never knows wear.

pub use statrs::function::gamma::{digamma, ln_gamma};

/// Trigamma function psi'(x), x > 0: recurrence to x >= 12, then the asymptotic series in Bernoulli numbers.
pub fn trigamma(x: f64) -> f64 {
    let (mut x, mut sum) = (x, 0.0);
    while x < 12.0 {
        sum += 1.0 / (x * x);
        x += 1.0;
    }
    let r = 1.0 / (x * x);
    let series = 1.0 / 6.0
        - r * (1.0 / 30.0 - r * (1.0 / 42.0 - r * (1.0 / 30.0 - r * (5.0 / 66.0 - r * 691.0 / 2730.0))));
    sum + 1.0 / x + 0.5 * r + r / x * series
}

/// Lower regularised incomplete gamma function P(shape, x): the probability that Gamma(shape, 1) is at most x.
pub fn gamma_p(shape: f64, x: f64) -> f64 {
    if x <= 0.0 { 0.0 } else { statrs::function::gamma::gamma_lr(shape, x) }
}

/// Upper regularised incomplete gamma function Q(shape, x) = 1 - P.
pub fn gamma_q(shape: f64, x: f64) -> f64 {
    if x <= 0.0 { 1.0 } else { statrs::function::gamma::gamma_ur(shape, x) }
}
