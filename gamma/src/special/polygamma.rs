//! Derivatives of ln Gamma. In: x > 0. Out: psi, psi', psi''. Never knows wear.
//!
//! Recurrence to x >= 12, then the asymptotic series in Bernoulli numbers (Abramowitz & Stegun 6.3.18, 6.4.12, 6.4.13),
//! whose first term left out is below 1e-16 of the value there.

/// From here on the series are used.
const LARGE: f64 = 12.0;

/// Digamma function psi(x) = d ln Gamma(x) / dx, x > 0.
pub fn digamma(x: f64) -> f64 {
    let (mut x, mut sum) = (x, 0.0);
    while x < LARGE {
        sum -= 1.0 / x;
        x += 1.0;
    }
    let r = 1.0 / (x * x);
    sum + libm::log(x) - 0.5 / x - r * digamma_series(r)
}

fn digamma_series(r: f64) -> f64 {
    1.0 / 12.0
        - r * (1.0 / 120.0
            - r * (1.0 / 252.0 - r * (1.0 / 240.0 - r * (1.0 / 132.0 - r * (691.0 / 32_760.0 - r / 12.0)))))
}

/// ln x - psi(x), which goes to 1 / (2 x), without the difference of large numbers.
pub fn ln_less_digamma(x: f64) -> f64 {
    if x < LARGE {
        return libm::log(x) - digamma(x);
    }
    let r = 1.0 / (x * x);
    0.5 / x + r * digamma_series(r)
}

/// Trigamma function psi'(x), x > 0.
pub fn trigamma(x: f64) -> f64 {
    let (mut x, mut sum) = (x, 0.0);
    while x < LARGE {
        sum += 1.0 / (x * x);
        x += 1.0;
    }
    let r = 1.0 / (x * x);
    sum + 1.0 / x + 0.5 * r + r / x * trigamma_series(r)
}

fn trigamma_series(r: f64) -> f64 {
    1.0 / 6.0 - r * (1.0 / 30.0 - r * (1.0 / 42.0 - r * (1.0 / 30.0 - r * (5.0 / 66.0 - r * 691.0 / 2730.0))))
}

/// x² psi'(x) - x, which goes to 1/2, without the difference of large numbers.
pub fn trigamma_rest(x: f64) -> f64 {
    if x < LARGE {
        return x * x * trigamma(x) - x;
    }
    0.5 + trigamma_series(1.0 / (x * x)) / x
}

/// Tetragamma function psi''(x), x > 0.
pub fn tetragamma(x: f64) -> f64 {
    let (mut x, mut sum) = (x, 0.0);
    while x < LARGE {
        sum -= 2.0 / (x * x * x);
        x += 1.0;
    }
    let r = 1.0 / (x * x);
    sum - r * (1.0 + 1.0 / x + r * (0.5 - r * (1.0 / 6.0 - r * (1.0 / 6.0 - r * 0.3))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digamma_has_the_values_of_the_tables() {
        // Abramowitz & Stegun, table 6.1 (x = 1, 1.5, 2) and 6.3 (x = 10, 50), to their ten digits; psi(1/2) = -gamma - 2 ln 2.
        let table = [
            (1.0, -0.577_215_664_9),
            (1.5, 0.036_489_974_0),
            (2.0, 0.422_784_335_1),
            (10.0, 2.251_752_589_1),
            (50.0, 3.901_989_673_4),
        ];
        for (x, expected) in table {
            assert!((digamma(x) - expected).abs() < 5.1e-11, "{x}: {}", digamma(x));
        }
        let half = -crate::special::EULER - 2.0 * core::f64::consts::LN_2;
        assert!((digamma(0.5) - half).abs() < 2e-15, "{}", digamma(0.5));
        // psi(x + 1) = psi(x) + 1 / x, where one side uses the series and the other the recurrence.
        for x in [1e-8, 0.3, 11.5, 11.999] {
            assert!((digamma(x + 1.0) - digamma(x) - 1.0 / x).abs() < 4e-15 * (1.0 / x).max(3.0), "{x}");
        }
    }

    #[test]
    fn what_is_left_of_large_numbers_has_all_digits() {
        // Where recurrence ends both ways have 14 digits of numbers of size 3 and 12.
        for x in [0.3, 11.9, 12.0, 40.0] {
            assert!((ln_less_digamma(x) - (libm::log(x) - digamma(x))).abs() < 2e-15, "{x}");
            assert!((trigamma_rest(x) - (x * x * trigamma(x) - x)).abs() < 1e-13, "{x}");
        }
        // The terms that come next are 1e-28 and 1e-14 of these.
        assert!((ln_less_digamma(1e14) * 2e14 - 1.0).abs() < 4e-15);
        assert!((trigamma_rest(1e14) - 0.5).abs() < 4e-15);
    }

    #[test]
    fn tetragamma_agrees_with_known_values() {
        // psi''(1) = -2 zeta(3).
        assert!((tetragamma(1.0) + 2.0 * 1.202_056_903_159_594_3).abs() < 1e-13);
        let step = 1e-5;
        let difference = (trigamma(3.7 + step) - trigamma(3.7 - step)) / (2.0 * step);
        assert!((tetragamma(3.7) - difference).abs() < 1e-9);
    }
}
