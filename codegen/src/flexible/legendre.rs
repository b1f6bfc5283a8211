//! Legendre polynomials on [-1, 1], their integrals, and Gauss's quadrature.

use std::sync::OnceLock;

/// P_0 to P_n at `s`.
pub fn legendre(n: usize, s: f64) -> Vec<f64> {
    let mut values = vec![1.0, s];
    for j in 2..=n {
        let k = j as f64;
        values.push(((2.0 * k - 1.0) * s * values[j - 1] - (k - 1.0) * values[j - 2]) / k);
    }
    values.truncate(n + 1);
    values
}

/// ∫ P_j from -1 to s; 0 at both ends but for j = 0. `p` holds P_0 to at least P_{j+1}.
pub fn integral(p: &[f64], j: usize) -> f64 {
    match j {
        0 => 1.0 + p[1],
        _ => (p[j + 1] - p[j - 1]) / (2 * j + 1) as f64,
    }
}

/// The integral of [`integral`]; 0 at both ends but for j = 0 and 1. `p` holds P_0 to at least P_{j+2}.
pub fn double_integral(p: &[f64], j: usize) -> f64 {
    match j {
        0 => (1.0 + p[1]) * (1.0 + p[1]) / 2.0,
        1 => (p[1] * p[1] * p[1] - 3.0 * p[1] - 2.0) / 6.0,
        _ => {
            let above = (p[j + 2] - p[j]) / (2 * j + 3) as f64;
            let below = (p[j] - p[j - 2]) / (2 * j - 1) as f64;
            (above - below) / (2 * j + 1) as f64
        }
    }
}

/// Most points of a quadrature rule.
const MOST_POINTS: usize = 32;

/// Points and weights on [-1, 1] of the rule with n points (1 to [`MOST_POINTS`]), exact for polynomials up to degree
/// 2n - 1; exactly symmetric.
pub fn gauss(n: usize) -> &'static [(f64, f64)] {
    &rule(n).points
}

struct Rule {
    /// As they were found, for the next rule.
    roots: Vec<f64>,
    /// Points and weights.
    points: Vec<(f64, f64)>,
}

fn rule(degree: usize) -> &'static Rule {
    static RULES: [OnceLock<Rule>; MOST_POINTS] = [const { OnceLock::new() }; MOST_POINTS];
    RULES[degree - 1].get_or_init(|| Rule::new(degree))
}

impl Rule {
    /// By bisection between the roots of the polynomial before: plain arithmetic, the same bits on every machine.
    fn new(degree: usize) -> Self {
        let before: &[f64] = if degree > 1 { &rule(degree - 1).roots } else { &[] };
        let ends = [&[-1.0], before, &[1.0]].concat();
        let of = |(i, pair): (usize, &[f64])| {
            // In the middle bisection would go through all small numbers there are.
            if 2 * i + 1 == degree { 0.0 } else { root(degree, pair[0], pair[1]) }
        };
        let roots: Vec<f64> = ends.windows(2).enumerate().map(of).collect();
        let symmetric = |i: usize| (roots[i] - roots[degree - 1 - i]) / 2.0;
        let points = (0..degree).map(symmetric).map(|s| (s, weight(degree, s))).collect();
        Self { roots, points }
    }
}

/// P_{n-1} and P_n at `s`, by the recurrence of [`legendre`].
fn last_two(n: usize, s: f64) -> [f64; 2] {
    (2..=n).fold([1.0, s], |[before, now], j| {
        let k = j as f64;
        [now, ((2.0 * k - 1.0) * s * now - (k - 1.0) * before) / k]
    })
}

/// Half the width of what is left when [`root`] begins to ask for every value.
const NEAR: f64 = 1e-13;

fn root(degree: usize, mut low: f64, mut high: f64) -> f64 {
    let value = |s: f64| last_two(degree, s)[1];
    let rising = value(high) > 0.0;
    let is_above = |s: f64| (value(s) > 0.0) == rising;
    let near = newton(degree, low, high);
    // Further from it than rounding reaches, the sign is known: it is the only root here.
    let is_known = !is_above(near - NEAR) && is_above(near + NEAR);
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return middle;
        }
        let above = if is_known && (middle - near).abs() > NEAR { middle > near } else { is_above(middle) };
        if above { high = middle } else { low = middle }
    }
}

/// The root between two numbers, good to some last places, or anything.
fn newton(degree: usize, low: f64, high: f64) -> f64 {
    (0..6).fold(f64::midpoint(low, high), |s, _| {
        let [before, now] = last_two(degree, s);
        (s - now * (1.0 - s * s) / (degree as f64 * (before - s * now))).clamp(low, high)
    })
}

fn weight(n: usize, s: f64) -> f64 {
    let p = legendre(n, s);
    // (1 - s²) P_n' = n (P_{n-1} - s P_n); P_n is 0 here but for rounding.
    let slope = n as f64 * (p[n - 1] - s * p[n]) / (1.0 - s * s);
    2.0 / ((1.0 - s * s) * slope * slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_is_exact_up_to_its_degree() {
        for n in 1..=20 {
            let rule = gauss(n);
            for power in 0..2 * n {
                let sum: f64 = rule.iter().map(|(s, w)| w * s.powi(power as i32)).sum();
                let exact = if power % 2 == 0 { 2.0 / (power + 1) as f64 } else { 0.0 };
                // Weights sum to 2 and each is good to a few units in the last place.
                assert!((sum - exact).abs() < 1e-14, "{n} points, s^{power}: {sum} {exact}");
            }
        }
    }

    #[test]
    fn integrals_agree_with_quadrature() {
        let rule = gauss(12);
        for j in 0..8 {
            for end in [-0.7, 0.1, 0.9, 1.0] {
                let over = |f: &dyn Fn(f64) -> f64| -> f64 {
                    let half = (end + 1.0) / 2.0;
                    rule.iter().map(|(s, w)| w * half * f(half * (s + 1.0) - 1.0)).sum()
                };
                let p = legendre(j + 2, end);
                // A dozen terms below 1: rounding.
                assert!((over(&|s| legendre(j, s)[j]) - integral(&p, j)).abs() < 1e-15);
                let once = over(&|s| integral(&legendre(j + 1, s), j));
                assert!((once - double_integral(&p, j)).abs() < 1e-15);
            }
        }
    }
}
