//! Gamma processes whose rates differ by a Gamma law (J. Lawless, M. Crowder, Lifetime Data Anal. 10 (2004) 213): beta of a unit
//! ~ Gamma(shape 1 / cv², mean beta), so that wear over an exposure has a closed density and beta times wear is a quotient of
//! Gamma numbers.

use rand::RngExt;

use super::super::random_effect::{RandomEffect, RandomLaw};
use crate::random::{LnGamma, Stream};
use crate::special::{
    LARGE_SHAPE, LN_2_PI, gamma_ratio, ln_gamma, ln_gamma_ratio_below, ln_ratio, ln_rising, stirling_rest,
};

/// The rate beta differs.
#[derive(Clone, Copy, Debug)]
pub struct GammaRate;

impl RandomEffect for GammaRate {
    fn parameter(&self) -> &'static str {
        "beta"
    }

    fn law(&self) -> &'static str {
        "gamma"
    }

    fn numbers(&self, logs: [f64; 2], cv: f64) -> RandomLaw {
        let (mean, shape) = (libm::exp(logs[1]), 1.0 / (cv * cv));
        RandomLaw { shape: Some(shape), rate: Some(shape / mean), mean, std: cv * mean }
    }

    fn ln_density(&self, [eta, ln_beta]: [f64; 2], cv: f64, wear: f64) -> f64 {
        let (a, base) = (libm::exp(eta), 1.0 / (cv * cv));
        if a >= LARGE_SHAPE {
            let (all, x) = (a + base, libm::exp(ln_beta) * wear);
            let off = (x - a) / (x + base);
            // Of ln Gamma(base) as of the others: what Stirling's series leaves of it.
            let of_base = match base < LARGE_SHAPE {
                true => ln_gamma(base) - ((base - 0.5) * libm::log(base) - base + 0.5 * LN_2_PI),
                false => stirling_rest(base),
            };
            let rests = stirling_rest(all) - stirling_rest(a) - of_base;
            // The leading terms of both logarithms cancel.
            let exponent = a * ln_ratio(off * base / a, x * (all / a) / (x + base))
                + base * ln_ratio(-off, all / (x + base));
            return exponent + 0.5 * (libm::log(a / all * base) - LN_2_PI) + rests - libm::log(wear);
        }
        a * ln_beta - ln_gamma(a) + (a - 1.0) * libm::log(wear) + ln_rising(base, a)
            - (a + base) * libm::log1p(libm::exp(ln_beta) * wear / base)
    }

    fn tails(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> (f64, f64) {
        let [alpha, beta] = logs.map(libm::exp);
        gamma_ratio(alpha * exposure, 1.0 / (cv * cv), beta * wear)
    }

    fn ln_survival(&self, logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> f64 {
        let [alpha, beta] = logs.map(libm::exp);
        ln_gamma_ratio_below(alpha * exposure, 1.0 / (cv * cv), beta * left)
    }

    fn after(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> Option<([f64; 2], f64)> {
        let [alpha, beta] = logs.map(libm::exp);
        let shape = 1.0 / (cv * cv);
        let (shape, rate) = (shape + alpha * exposure, shape / beta + wear);
        Some(([logs[0], libm::log(shape / rate)], 1.0 / libm::sqrt(shape)))
    }

    /// Places are the logarithm of beta over its mean, in units of cv.
    fn place(&self, logs: [f64; 2], cv: f64, place: f64) -> Option<([f64; 2], f64)> {
        let (shape, ln) = (1.0 / (cv * cv), cv * place);
        let constant = if shape < LARGE_SHAPE {
            shape * libm::log(shape) - shape - ln_gamma(shape) + libm::log(cv)
        } else {
            // Stirling's series: the difference of large numbers has no digits left.
            -0.5 * LN_2_PI - 1.0 / (12.0 * shape)
        };
        Some(([logs[0], logs[1] + ln], constant + shape * (ln - libm::expm1(ln))))
    }

    fn place_of(&self, logs: [f64; 2], cv: f64, own: [f64; 2]) -> f64 {
        (own[1] - logs[1]) / cv
    }

    /// The score is [(r - a)² - a] / 2, r = beta times wear of shape a; less its part along r - a it has the variance (a² + a) / 2.
    fn excess(&self, logs: [f64; 2]) -> f64 {
        libm::exp(-logs[0])
    }

    fn draw(&self, logs: [f64; 2], cv: f64, stream: &mut Stream) -> [f64; 2] {
        let shape = 1.0 / (cv * cv);
        [logs[0], logs[1] + stream.sample(LnGamma(shape)) - libm::log(shape)]
    }
}
