//! The parametric bootstrap. In: an estimate, a seed. Out: estimates of data drawn from it, and with them intervals
//! and p-values. Never knows files.
//!
//! P-values of goodness of fit come from here and not from tables: the parameters were estimated from the same data,
//! and the tables of Kolmogorov would then call bad fits good.

use rand::RngExt;

use super::estimate::{Estimate, estimate_increments};
use super::goodness::goodness;
use super::interval::Interval;
use crate::data::{Increment, Observations};
use crate::random::{LnGamma, Stream};

/// Replicates of an estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Bootstrap {
    /// (alpha, beta, [c], [b..]) of each replicate that could be fitted.
    pub estimates: Vec<Vec<f64>>,
    /// Kolmogorov-Smirnov distance of each, against its own estimate.
    pub kolmogorov_smirnov: Vec<f64>,
    /// Anderson-Darling distance of each, against its own estimate.
    pub anderson_darling: Vec<f64>,
    /// Replicates without a maximum.
    pub failed: usize,
}

/// Draws data from the estimate, with the spans, covariates and gauge of the observations, and estimates again.
/// Replicate r draws from [`Stream::new`]`(seed, r, 0)`, increment i at cycle i.
pub fn bootstrap(
    estimate: &Estimate,
    observations: &Observations,
    replicates: usize,
    seed: u64,
) -> Bootstrap {
    let mut own = Bootstrap {
        estimates: Vec::new(),
        kolmogorov_smirnov: Vec::new(),
        anderson_darling: Vec::new(),
        failed: 0,
    };
    for replicate in 0..replicates as u64 {
        let increments = draw(estimate, &observations.increments, seed, replicate);
        match estimate_increments(&increments, &estimate.model, Some(&estimate.phi)) {
            Ok(again) => {
                let fit = goodness(&again, &increments, seed ^ replicate);
                own.estimates.push(again.parameters());
                own.kolmogorov_smirnov.push(fit.kolmogorov_smirnov);
                own.anderson_darling.push(fit.anderson_darling);
            }
            Err(_) => own.failed += 1,
        }
    }
    own
}

/// One data set of the estimated process.
pub(super) fn draw(estimate: &Estimate, like: &[Increment], seed: u64, replicate: u64) -> Vec<Increment> {
    let mut stream = Stream::new(seed, replicate, 0);
    let ln_beta = estimate.phi[1];
    let drawn = like.iter().enumerate().map(|(at, increment)| {
        let ln_wear = stream.at(at as u64).sample(LnGamma(estimate.shape(increment))) - ln_beta;
        // A gauge says 0 below its step; a wear too small for a double is as small as a double gets.
        let wear = match estimate.model.resolution {
            Some(step) if ln_wear < libm::log(step) => 0.0,
            _ => libm::exp(ln_wear).max(f64::MIN_POSITIVE),
        };
        Increment { wear, ..increment.clone() }
    });
    drawn.collect()
}

impl Bootstrap {
    /// The interval between the quantiles (1 -+ `level`) / 2 of the replicates' parameter `index`; none without
    /// replicates.
    pub fn interval(&self, index: usize, level: f64) -> Option<Interval> {
        let mut values: Vec<f64> = self.estimates.iter().map(|estimate| estimate[index]).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)? as f64;
        let quantile = |p: f64| {
            let place = p * last;
            let (below, above) = (values[place.floor() as usize], values[place.ceil() as usize]);
            below + (above - below) * place.fract()
        };
        Some(Interval { low: quantile(0.5 - 0.5 * level), high: quantile(0.5 + 0.5 * level) })
    }

    /// Mean of the replicates' parameter `index`; none without replicates.
    pub fn mean(&self, index: usize) -> Option<f64> {
        let count = self.estimates.len();
        (count > 0).then(|| self.estimates.iter().map(|estimate| estimate[index]).sum::<f64>() / count as f64)
    }

    /// Probability of a distance at least as large, (1 + number of them) / (1 + replicates).
    pub fn p_value(replicated: &[f64], seen: f64) -> f64 {
        let above = replicated.iter().filter(|value| **value >= seen).count();
        (1 + above) as f64 / (1 + replicated.len()) as f64
    }
}
