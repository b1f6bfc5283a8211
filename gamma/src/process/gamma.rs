//! The Gamma process, [CS (21)-(25)]: dW ~ Gamma(shape alpha dLambda, rate beta), of mean alpha dLambda / beta and variance
//! alpha dLambda / beta². In and out: see [`Process`]. Never knows other processes.

mod units;

use rand::RngExt;

use self::units::GammaRate;
use super::definition::{Process, Slice, Term, scatters};
use super::random_effect::RandomEffect;
use crate::random::{LnGamma, Stream};
use crate::special::{
    LARGE_SHAPE, LN_2_PI, digamma, gamma_p, gamma_q, gamma_quantile, gamma_ratio, guarded, ln_gamma,
    ln_gamma_p_slope, ln_less_digamma, ln_ratio, stirling_rest, tetragamma, trigamma, trigamma_rest,
};

/// Steps of Newton's method; 5 to 15 are usual.
const MOST_STEPS: usize = 200;

/// Power of the weight of the matching prior. 1/2 would be the reference prior of the shape; of so few increments as four of
/// shape 0.3 its intervals hold 93 % of lives, with 2 they hold 94 to 96 %. Large shapes need no weight and get none: there flat
/// is exact.
const MATCHING: f64 = 2.0;

/// Parameters: alpha, the shape per unit of exposure, and beta, the rate [1 / unit of wear].
#[derive(Clone, Copy, Debug)]
pub struct Gamma;

impl Process for Gamma {
    fn name(&self) -> &'static str {
        "gamma"
    }

    fn title(&self) -> &'static str {
        "Gamma"
    }

    fn parameters(&self) -> [&'static str; 2] {
        ["alpha", "beta"]
    }

    fn exposure_powers(&self) -> [f64; 2] {
        [1.0, 0.0]
    }

    fn size_powers(&self) -> [f64; 2] {
        [0.0, -1.0]
    }

    fn maximum(&self, exposures: &[f64], wears: &[f64]) -> Option<[f64; 2]> {
        let ln_alpha = profile_ln_alpha(exposures, wears)?;
        let ratio: f64 = exposures.iter().sum::<f64>() / wears.iter().sum::<f64>();
        Some([ln_alpha, ln_alpha + libm::log(ratio)])
    }

    fn ln_mean(&self, logs: [f64; 2]) -> f64 {
        logs[0] - logs[1]
    }

    fn variance(&self, logs: [f64; 2]) -> f64 {
        libm::exp(logs[0] - 2.0 * logs[1])
    }

    fn density(&self, [eta, ln_beta]: [f64; 2], wear: f64) -> Term {
        let a = libm::exp(eta);
        let ln_wear = libm::log(wear);
        let scaled = libm::exp(ln_beta) * wear;
        if a >= LARGE_SHAPE {
            let slope = a * (ln_ratio((scaled - a) / a, scaled / a) + ln_less_digamma(a));
            return Term {
                value: self.ln_density([eta, ln_beta], wear),
                gradient: [slope, a - scaled],
                hessian: [slope - a - trigamma_rest(a), a, -scaled],
            };
        }
        let slope = a * (ln_beta + ln_wear - digamma(a));
        Term {
            value: self.ln_density([eta, ln_beta], wear),
            gradient: [slope, a - scaled],
            hessian: [slope - a * a * trigamma(a), a, -scaled],
        }
    }

    fn ln_density(&self, [eta, ln_beta]: [f64; 2], wear: f64) -> f64 {
        let a = libm::exp(eta);
        if a >= LARGE_SHAPE {
            let scaled = libm::exp(ln_beta) * wear;
            let off = (scaled - a) / a;
            let rest = 0.5 * (eta - LN_2_PI) - stirling_rest(a);
            return a * (ln_ratio(off, scaled / a) - off) + rest - libm::log(wear);
        }
        a * ln_beta - ln_gamma(a) + (a - 1.0) * libm::log(wear) - libm::exp(ln_beta) * wear
    }

    fn density_terms(&self, [eta, ln_beta]: [f64; 2]) -> Option<[f64; 3]> {
        let a = libm::exp(eta);
        Some([a * ln_beta - ln_gamma(a), a - 1.0, libm::exp(ln_beta)])
    }

    /// P(a, x) = P(a + 1, x) + x^a exp(-x) / Gamma(a + 1), Q likewise the other way round: sums that lose no digits.
    fn mean_shortfall(&self, logs: [f64; 2], wear: f64) -> Option<f64> {
        if wear <= 0.0 {
            return Some(0.0);
        }
        let [shape, beta] = logs.map(libm::exp);
        let next = gamma_p(shape + 1.0, beta * wear);
        Some(wear * (next + between_shapes(shape, beta * wear)) - shape / beta * next)
    }

    fn mean_excess(&self, logs: [f64; 2], wear: f64) -> Option<f64> {
        let [shape, beta] = logs.map(libm::exp);
        let mean = shape / beta;
        if wear <= 0.0 {
            return Some(mean - wear);
        }
        let left = gamma_q(shape, beta * wear);
        Some(mean * (left + between_shapes(shape, beta * wear)) - wear * left)
    }

    fn slice(&self, ln_alpha: f64, increments: &[(f64, f64)]) -> Slice {
        let alpha = libm::exp(ln_alpha);
        let (mut shape, mut constant, mut total) = (0.0, 0.0, 0.0);
        for (exposure, wear) in increments {
            let one = alpha * exposure;
            shape += one;
            total += wear;
            constant += (one - 1.0) * libm::log(*wear) - ln_gamma(one);
        }
        Slice { constant, slope: shape, scale: total, power: 1.0 }
    }

    /// D. R. Cox, E. J. Snell (1968): b_r = 1/2 sum K^ri K^jk kappa_ijk with the third derivatives of the log-likelihood,
    /// which are not random in (alpha, -beta), the canonical parameters.
    fn first_order_bias(&self, logs: [f64; 2], exposures: &[f64]) -> Option<[f64; 2]> {
        let [alpha, beta] = logs.map(libm::exp);
        let total: f64 = exposures.iter().sum();
        let curvature: f64 = exposures.iter().map(|l| l * l * trigamma(alpha * l)).sum();
        let skew: f64 = exposures.iter().map(|l| l * l * l * tetragamma(alpha * l)).sum();
        // Information of (alpha, beta) and its inverse.
        let (aa, ab, bb) = (curvature, -total / beta, alpha * total / (beta * beta));
        let determinant = aa * bb - ab * ab;
        let inverse = [[bb / determinant, -ab / determinant], [-ab / determinant, aa / determinant]];
        // kappa_ijk: (a, a, a), (a, b, b) in any order, (b, b, b).
        let (aaa, abb, bbb) = (-skew, -total / (beta * beta), 2.0 * alpha * total / (beta * beta * beta));
        let kappa = |i: usize, j: usize, k: usize| match i + j + k {
            0 => aaa,
            2 => abb,
            3 => bbb,
            _ => 0.0,
        };
        let mut contracted = [0.0; 2];
        for (i, entry) in contracted.iter_mut().enumerate() {
            for (j, row) in inverse.iter().enumerate() {
                for (k, value) in row.iter().enumerate() {
                    *entry += 0.5 * kappa(i, j, k) * value;
                }
            }
        }
        Some([0, 1].map(|r: usize| inverse[r][0] * contracted[0] + inverse[r][1] * contracted[1]))
    }

    fn ln_matching_weight(&self, ln_alpha: f64, increments: &[(f64, f64)]) -> f64 {
        let alpha = libm::exp(ln_alpha);
        let of_shape = |(exposure, _): &(f64, f64)| trigamma_rest(alpha * exposure);
        MATCHING * libm::log(increments.iter().map(of_shape).sum::<f64>() / increments.len() as f64)
    }

    /// S(t) falls as t^-(increments - 1).
    fn increments_for_variance(&self) -> Option<usize> {
        Some(4)
    }

    fn random_effect(&self) -> Option<&'static dyn RandomEffect> {
        Some(&GammaRate)
    }

    /// Wear too small for a double is 0.
    fn draw(&self, logs: [f64; 2], exposure: f64, stream: &mut Stream) -> f64 {
        libm::exp(stream.sample(LnGamma(libm::exp(logs[0]) * exposure)) - logs[1])
    }

    fn cumulative(&self, logs: [f64; 2], exposure: f64, wear: f64) -> f64 {
        let [alpha, beta] = logs.map(libm::exp);
        gamma_p(alpha * exposure, beta * wear)
    }

    /// The part of the whole has a beta law, whatever the rate.
    fn ln_bridge(&self, logs: [f64; 2], [first, second]: [f64; 2], wear: f64, below: f64) -> Option<f64> {
        if below >= wear {
            return Some(0.0);
        }
        let (shape, rest) = (libm::exp(logs[0]) * first, libm::exp(logs[0]) * second);
        Some(libm::log(gamma_ratio(shape, rest, rest * below / (wear - below)).0))
    }

    fn quantile(&self, logs: [f64; 2], exposure: f64, p: f64) -> f64 {
        let [alpha, beta] = logs.map(libm::exp);
        gamma_quantile(alpha * exposure, p) / beta
    }

    fn failure(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        let [alpha, beta] = logs.map(libm::exp);
        gamma_q(alpha * exposure, beta * left)
    }

    fn hazard(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        let [alpha, beta] = logs.map(libm::exp);
        alpha * ln_gamma_p_slope(alpha * exposure, beta * left)
    }

    /// Half a unit of shape more than the mean wear takes: exact but for e^-(beta left).
    fn mean_exposure(&self, logs: [f64; 2], left: f64) -> f64 {
        let [alpha, beta] = logs.map(libm::exp);
        (beta * left + 0.5) / alpha
    }
}

/// ln alpha that solves the profile equation
/// sum dLambda [ln beta + ln dW - psi(alpha dLambda)] = 0, beta = alpha sum dLambda / sum dW, [CS (25)].
///
/// With r = beta dW / (alpha dLambda) - 1, whatever alpha is, the bracket is ln(1 + r) + ln(alpha dLambda) - psi(alpha dLambda), and
/// the sum of dLambda r is 0: it is taken off, as little scatter leaves r² / 2 of ln(1 + r).
///
/// Newton in ln alpha: the left side falls monotonically, because x psi'(x) > 1, and a bracket catches a first step
/// that is too long. None if the increments have no scatter, or are not positive.
fn profile_ln_alpha(lambdas: &[f64], wears: &[f64]) -> Option<f64> {
    let (lambda, wear): (f64, f64) = (lambdas.iter().sum(), wears.iter().sum());
    let rate = wear / lambda;
    // Alpha = mean^2 / variance, per unit of Lambda.
    let scatter: f64 = lambdas.iter().zip(wears).map(|(l, w)| (w - rate * l) * (w - rate * l) / l).sum();
    let mut s = libm::log(rate * rate * lambdas.len() as f64 / scatter);
    if wears.iter().any(|w| *w <= 0.0) || !scatters(scatter, rate * wear) {
        return None;
    }
    let of_scatter = |(l, w): (&f64, &f64)| {
        let off = (w - rate * l) / (rate * l);
        // Of an increment that is next to nothing beside its mean, nothing is left of 1 + off.
        l * (ln_ratio(off, w / (rate * l)) - off)
    };
    let of_scatter: f64 = lambdas.iter().zip(wears).map(of_scatter).sum();
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for _ in 0..MOST_STEPS {
        let alpha = libm::exp(s);
        let (mut value, mut slope) = (of_scatter, 0.0);
        for l in lambdas {
            let a = alpha * l;
            value += l * ln_less_digamma(a);
            slope -= trigamma_rest(a) / alpha;
        }
        if value > 0.0 {
            low = s
        } else {
            high = s
        }
        let next = guarded(s - value / slope, s, (low, high));
        if (next - s).abs() <= 1e-15 * s.abs().max(1.0) {
            return Some(next);
        }
        s = next;
    }
    // Rounding keeps the last digit going: the bracket is as narrow as it gets.
    (high - low < 1e-10).then_some(s)
}

/// P(a, x) - P(a + 1, x).
fn between_shapes(shape: f64, x: f64) -> f64 {
    libm::exp(shape * libm::log(x) - x - ln_gamma(shape + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawn_increments_have_mean_and_variance_of_the_law() {
        // [CS (23)], [CS (24)]: alpha dLambda / beta and alpha dLambda / beta².
        let (alpha, beta, exposure, n) = (3.0, 2.0, 0.7, 20_000);
        let mut stream = Stream::new(9, 0, 0);
        let drawn: Vec<f64> =
            (0..n).map(|_| Gamma.draw([alpha, beta].map(f64::ln), exposure, &mut stream)).collect();
        let mean = drawn.iter().sum::<f64>() / f64::from(n);
        let variance = drawn.iter().map(|wear| (wear - mean) * (wear - mean)).sum::<f64>() / f64::from(n - 1);
        let (shape, law) = (alpha * exposure, alpha * exposure / (beta * beta));
        // Three standard errors of a fixed seed; the fourth central moment is (3 + 6 / shape) times the variance squared.
        assert!((mean - shape / beta).abs() < 3.0 * (law / f64::from(n)).sqrt(), "{mean}");
        assert!(
            (variance - law).abs() < 3.0 * law * ((2.0 + 6.0 / shape) / f64::from(n)).sqrt(),
            "{variance}"
        );
    }

    #[test]
    fn the_profile_equation_has_the_root_of_the_full_likelihood() {
        let increments = [(1.0_f64, 0.8), (0.5, 0.7), (2.0, 2.9), (1.5, 1.1), (0.3, 0.2)];
        let (exposures, wears): (Vec<f64>, Vec<f64>) = increments.into_iter().unzip();
        let logs = Gamma.maximum(&exposures, &wears).expect("scatter");
        let gradient = |k: usize| -> f64 {
            let one = |(exposure, wear): (f64, f64)| {
                Gamma.density([logs[0] + exposure.ln(), logs[1]], wear).gradient[k]
            };
            increments.into_iter().map(one).sum()
        };
        // Both derivatives vanish to rounding of terms of size 10.
        assert!(gradient(0).abs() < 1e-12 && gradient(1).abs() < 1e-12, "{} {}", gradient(0), gradient(1));
    }

    #[test]
    fn increments_without_scatter_have_no_maximum() {
        assert_eq!(Gamma.maximum(&[1.0, 2.0, 1.0], &[1.0, 2.0, 1.0]), None);
    }

    #[test]
    fn first_order_bias_is_that_of_the_textbook_for_equal_spans() {
        // D. E. Giles, H. Feng (2009): bias of the shape a = alpha of n draws is
        // [a psi' - a^2 psi'' - 2] / [2 n (a psi' - 1)^2].
        let (alpha, beta, n) = (2.5, 0.7, 40.0);
        let lambdas = vec![1.0; 40];
        let (one, two) = (trigamma(alpha), tetragamma(alpha));
        let expected = (alpha * one - alpha * alpha * two - 2.0) / (2.0 * n * (alpha * one - 1.0).powi(2));
        let logs = [libm::log(alpha), libm::log(beta)];
        let [found, of_beta] = Gamma.first_order_bias(logs, &lambdas).expect("theory");
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
        // E[beta^] = E[alpha^] n E[1 / sum W] exactly, sum W ~ Gamma(n alpha, beta), independent of alpha^ (Basu).
        let by_basu = (alpha + expected) * n * beta / (n * alpha - 1.0) - beta;
        // Equal to first order: what is left is of order 1/n of it.
        assert!((of_beta / by_basu - 1.0).abs() < 2.0 / n, "{of_beta} {by_basu}");
    }
}
