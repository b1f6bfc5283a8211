//! The log-likelihood of Gamma increments and its derivatives. In: increments, parameters. Out: value, gradient,
//! Hessian. Never knows how it is maximised.
//!
//! Parameters are phi = (ln alpha, ln beta, [c], [b..]): shape of an increment a = alpha dLambda, with
//! ln dLambda = ln(to^c - from^c) + sum b ln(covariate). With eta = ln a everything follows from derivatives in eta.

use crate::data::Increment;
use crate::special::{digamma, ln_gamma, ln_gamma_p_of_ln, trigamma};

/// What of the model is estimated beside alpha and beta.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Model {
    /// Estimate c of Lambda = exposure^c; otherwise c = 1.
    pub power_law: bool,
    /// How many covariates of the data multiply Lambda, each as value^b.
    pub covariates: usize,
    /// Step of the gauge: an increment of 0 is then taken as "less than this".
    pub resolution: Option<f64>,
}

/// Value and derivatives at one point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Log-likelihood.
    pub value: f64,
    /// Its gradient in phi.
    pub gradient: Vec<f64>,
    /// Its Hessian in phi, negated: the observed information.
    pub information: Vec<Vec<f64>>,
}

impl Model {
    /// Number of parameters: 2, and 1 for the exponent, and the covariates.
    pub fn parameters(&self) -> usize {
        2 + usize::from(self.power_law) + self.covariates
    }

    /// Exponent of Lambda at phi.
    pub fn exponent(&self, phi: &[f64]) -> f64 {
        if self.power_law { phi[2] } else { 1.0 }
    }

    /// ln dLambda of an increment and its derivatives in the parameters from the third on; and its second derivative
    /// in c, the only one there is.
    fn ln_lambda(&self, phi: &[f64], increment: &Increment) -> (f64, Vec<f64>, f64) {
        let mut slopes = Vec::with_capacity(phi.len() - 2);
        let (mut value, mut bend) = (libm::log(increment.to - increment.from), 0.0);
        if self.power_law {
            let c = phi[2];
            let ln_to = libm::log(increment.to);
            (value, bend) = (c * ln_to, 0.0);
            let mut slope = ln_to;
            if increment.from > 0.0 {
                // ln(1 - r), r = (from/to)^c.
                let ratio = libm::log(increment.from / increment.to);
                let rest = -libm::expm1(c * ratio);
                let r = 1.0 - rest;
                value += libm::log(rest);
                slope -= ratio * r / rest;
                bend = -(ratio * ratio) * r / (rest * rest);
            }
            slopes.push(slope);
        }
        for (ln_covariate, b) in increment.ln_covariates.iter().zip(&phi[phi.len() - self.covariates..]) {
            value += b * ln_covariate;
            slopes.push(*ln_covariate);
        }
        (value, slopes, bend)
    }

    /// dLambda of an increment at phi: its shape is alpha times this.
    pub fn lambda(&self, phi: &[f64], increment: &Increment) -> f64 {
        libm::exp(self.ln_lambda(phi, increment).0)
    }

    /// Log-likelihood alone.
    pub fn value(&self, phi: &[f64], increments: &[Increment]) -> f64 {
        increments
            .iter()
            .map(|increment| self.term(phi, increment, self.ln_lambda(phi, increment).0).value)
            .sum()
    }

    fn term(&self, phi: &[f64], increment: &Increment, ln_lambda: f64) -> Term {
        let eta = phi[0] + ln_lambda;
        match self.resolution {
            Some(step) if increment.wear == 0.0 => Term::censored(eta, phi[1], libm::log(step)),
            _ => Term::exact(eta, phi[1], increment.wear),
        }
    }

    /// Value, gradient and information.
    pub fn point(&self, phi: &[f64], increments: &[Increment]) -> Point {
        let size = phi.len();
        let mut point =
            Point { value: 0.0, gradient: vec![0.0; size], information: vec![vec![0.0; size]; size] };
        for increment in increments {
            let (ln_lambda, slopes, bend) = self.ln_lambda(phi, increment);
            let term = self.term(phi, increment, ln_lambda);
            // d eta / d phi: 1, 0, slopes.
            let slope = |at: usize| match at {
                0 => 1.0,
                1 => 0.0,
                _ => slopes[at - 2],
            };
            point.value += term.value;
            for i in 0..size {
                point.gradient[i] += term.eta * slope(i);
                for j in 0..size {
                    point.information[i][j] -= term.eta_eta * slope(i) * slope(j);
                }
            }
            point.gradient[1] += term.rate;
            point.information[1][1] -= term.rate_rate;
            for i in (0..size).filter(|i| *i != 1) {
                point.information[i][1] -= term.eta_rate * slope(i);
                point.information[1][i] -= term.eta_rate * slope(i);
            }
            if self.power_law {
                point.information[2][2] -= term.eta * bend;
            }
        }
        point
    }
}

/// One increment's share and its derivatives in eta = ln shape and ln beta.
struct Term {
    value: f64,
    eta: f64,
    rate: f64,
    eta_eta: f64,
    eta_rate: f64,
    rate_rate: f64,
}

impl Term {
    /// [CS (25)]: the density of Gamma(a, beta) at wear.
    fn exact(eta: f64, ln_beta: f64, wear: f64) -> Self {
        let a = libm::exp(eta);
        let ln_wear = libm::log(wear);
        let scaled = libm::exp(ln_beta) * wear;
        let slope = a * (ln_beta + ln_wear - digamma(a));
        Self {
            value: a * ln_beta - ln_gamma(a) + (a - 1.0) * ln_wear - scaled,
            eta: slope,
            rate: a - scaled,
            eta_eta: slope - a * a * trigamma(a),
            eta_rate: a,
            rate_rate: -scaled,
        }
    }

    /// ln P(a, beta step): the probability of less than one step of the gauge.
    fn censored(eta: f64, ln_beta: f64, ln_step: f64) -> Self {
        // The derivative of P in its shape has no closed form: central differences of order 4. With
        // ln P good to 1e-15 they are good to 1e-12 and 1e-8, ample for Newton's method and for standard errors.
        const H: f64 = 1e-3;
        let ln_x = ln_beta + ln_step;
        let at = |step: f64| ln_gamma_p_of_ln(libm::exp(eta + step), ln_x);
        let (value, a) = (at(0.0), libm::exp(eta));
        let (up, down, up_2, down_2) = (at(H), at(-H), at(2.0 * H), at(-2.0 * H));
        let slope = (8.0 * (up - down) - (up_2 - down_2)) / (12.0 * H);
        let x = libm::exp(ln_x);
        let rate = libm::exp(a * ln_x - x - ln_gamma(a) - value);
        Self {
            value,
            eta: slope,
            rate,
            eta_eta: (16.0 * (up + down) - 30.0 * value - (up_2 + down_2)) / (12.0 * H * H),
            eta_rate: rate * (a * (ln_x - digamma(a)) - slope),
            rate_rate: rate * (a - x - rate),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(wear: f64, from: f64, to: f64, ln_load: f64) -> Increment {
        Increment { unit: 0, from, to, wear, ln_covariates: vec![ln_load], row: 0 }
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        let model = Model { power_law: true, covariates: 1, resolution: Some(0.1) };
        let data = [sample(0.8, 0.0, 2.0, 0.3), sample(1.7, 2.0, 5.0, -0.4), sample(0.0, 5.0, 5.5, 1.1)];
        let phi = [0.7, 0.9, 0.8, 0.5];
        let here = model.point(&phi, &data);
        assert!((here.value - model.value(&phi, &data)).abs() < 1e-14);
        let step = 1e-5;
        for i in 0..4 {
            let moved = |by: f64| {
                let mut phi = phi;
                phi[i] += by;
                model.point(&phi, &data)
            };
            let (up, down) = (moved(step), moved(-step));
            // Central differences: error step^2 and eps / step, both about 1e-10; the censored term's curvature 1e-6.
            let slope = (up.value - down.value) / (2.0 * step);
            assert!((slope - here.gradient[i]).abs() < 1e-8, "{i}: {slope} {}", here.gradient[i]);
            for j in 0..4 {
                let bend = -(up.gradient[j] - down.gradient[j]) / (2.0 * step);
                assert!(
                    (bend - here.information[i][j]).abs() < 2e-6,
                    "{i} {j}: {bend} {}",
                    here.information[i][j]
                );
            }
        }
    }
}
