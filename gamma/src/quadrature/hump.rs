//! Points and weights for an integral over a line of a function with one hump, known by its logarithm.
//! In: ln f. Out: abscissae with ln weights. Never knows what is integrated.
//!
//! Trapezoid rule in s, x = mode + 2 sigma sinh(s): it converges exponentially for analytic functions, and reaches far
//! exponential tails in few steps.

/// Step in s: relative error 1e-10 for a normal hump, 1e-5 for one with a long exponential tail.
const STEP: f64 = 0.2;
/// ln f below its maximum where the rule ends.
const DEPTH: f64 = 27.0;
/// Points at most on either side.
const LONGEST: usize = 120;

/// Where a hump is and how wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hump {
    pub mode: f64,
    pub sigma: f64,
    pub top: f64,
}

impl Hump {
    /// ln of the integral by Laplace's method.
    pub fn ln_area(&self) -> f64 {
        self.top + libm::log(self.sigma) + 0.5 * libm::log(2.0 * std::f64::consts::PI)
    }

    /// Finds the hump of `ln_f` uphill from `start` with first steps of `step`. None if it still rises at `limit`.
    pub fn find(ln_f: &dyn Fn(f64) -> f64, start: f64, step: f64, limit: f64) -> Option<Self> {
        let (mut x, mut top, mut step) = (start, ln_f(start), step);
        // Uphill with growing steps, then halving: no derivative, no bracket needed.
        while step > 1e-4 {
            let (left, right) = (ln_f(x - step), ln_f(x + step));
            if right > top && right >= left {
                (x, top) = (x + step, right);
                step *= 1.6;
            } else if left > top {
                (x, top) = (x - step, left);
                step *= 1.6;
            } else {
                // A parabola through the three is exact near the top.
                let bend = left - 2.0 * top + right;
                let shift = if bend < 0.0 { 0.5 * step * (left - right) / bend } else { 0.0 };
                let value = ln_f(x + shift);
                if value > top {
                    (x, top) = (x + shift, value);
                }
                step *= 0.25;
            }
            if (x - start).abs() > limit {
                return None;
            }
        }
        Some(Self { mode: x, sigma: width(ln_f, x, top), top })
    }

    /// The rule: (x, ln weight), ascending in x.
    pub fn points(&self, ln_f: &dyn Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let scale = 2.0 * self.sigma;
        let mut points = vec![(self.mode, libm::log(scale * STEP))];
        for direction in [-1.0, 1.0] {
            for k in 1..=LONGEST {
                let s = direction * STEP * k as f64;
                let x = self.mode + scale * libm::sinh(s);
                let weight = libm::log(scale * STEP * libm::cosh(s));
                // The factor cosh s counts: it widens the tail.
                if ln_f(x) + libm::log(libm::cosh(s)) < self.top - DEPTH {
                    break;
                }
                points.push((x, weight));
            }
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }
}

/// Distance from the mode to the nearer of the points half a unit below the top: sigma of a normal hump. The nearer,
/// because the step must resolve the steeper side; sinh reaches the other.
fn width(ln_f: &dyn Fn(f64) -> f64, mode: f64, top: f64) -> f64 {
    let side = |direction: f64| {
        let below = |d: f64| ln_f(mode + direction * d) < top - 0.5;
        let mut far = 1e-3;
        while below(far) && far > 1e-9 {
            far *= 0.5;
        }
        while !below(far) && far < 1e3 {
            far *= 2.0;
        }
        let mut near = 0.5 * far;
        for _ in 0..6 {
            let middle = 0.5 * (near + far);
            if below(middle) { far = middle } else { near = middle }
        }
        0.5 * (near + far)
    };
    side(-1.0).min(side(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::ln_gamma;

    fn ln_integral(ln_f: &dyn Fn(f64) -> f64, start: f64) -> f64 {
        let hump = Hump::find(ln_f, start, 1.0, 1e3).expect("a hump");
        hump.points(ln_f).into_iter().map(|(x, weight)| (ln_f(x) + weight).exp()).sum::<f64>().ln()
    }

    #[test]
    fn known_integrals_of_normal_and_skewed_humps() {
        let normal = |x: f64| -0.5 * ((x - 3.0) / 0.01).powi(2);
        let expected = 0.5 * (2.0 * std::f64::consts::PI).ln() + 0.01_f64.ln();
        // The step's 1e-10, times ten.
        assert!((ln_integral(&normal, 0.0) - expected).abs() < 1e-9);
        // Integral of exp(a u - e^u) = Gamma(a): a tail of slope a on the left. a = 0.05 reaches 540 units out.
        for (a, tolerance) in [(0.05, 1e-4), (0.5, 1e-5), (3.0, 1e-5), (100.0, 1e-7)] {
            let skewed = |u: f64| a * u - u.exp();
            let miss = ln_integral(&skewed, 1.0) - ln_gamma(a);
            assert!(miss.abs() < tolerance, "{a}: {miss:.2e}");
        }
    }

    #[test]
    fn a_slope_without_top_is_none() {
        assert_eq!(Hump::find(&|x| x, 0.0, 1.0, 30.0), None);
    }
}
