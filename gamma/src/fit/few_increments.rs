//! How much larger than chi-square the likelihood's fall is after few increments: M. S. Bartlett's factor (Proc. R. Soc. A 160
//! (1937) 268). In: a fit of exact readings. Out: the factor of one of its parameters. Never knows ends of intervals.
//!
//! Twice the fall of the log-likelihood to the true value of a parameter has, but for terms of order 1 / n², the chi-square law times
//! its own mean (D. N. Lawley, Biometrika 43 (1956) 295). Of six increments and three parameters that mean is 2.3, so that
//! intervals by chi-square hold the truth in 84 % in place of 95 (docs/remaining-life.md). The mean is that of data drawn from the
//! fit (D. M. Rocke, J. Am. Stat. Assoc. 84 (1989) 598): scale does not change it, and shape hardly.

use super::bootstrap::{draw, own_seed};
use super::estimate::{Fit, estimate_increments};
use super::maximise::maximise;
use crate::data::Observations;

/// Increments a parameter up to which data are drawn: of more, intervals by chi-square hold the truth in 93 % and more.
const MOST: usize = 8;
/// Data drawn: they tell the mean to a sixteenth, which changes a coverage of 95 % by 0.7.
const DRAWN: u64 = 500;
/// Seed of drawn data, beside the data they are drawn for.
const SEED: u64 = 27;

/// The factor of parameter `index` of [`Fit::parameters`]; 1 where chi-square does, and where data cannot be drawn: of units that
/// differ, of rounded readings and of bounds, whose laws are others.
pub fn bartlett(fit: &Fit, observations: &Observations, index: usize) -> f64 {
    let is_few = fit.increments <= MOST * fit.model.parameters();
    let is_exact = fit.model.resolution.is_none() && !fit.model.units_differ && observations.is_plain();
    if !(is_few && is_exact) {
        return 1.0;
    }
    let like = &observations.increments;
    let seed = own_seed(SEED, like);
    let fall = |number: u64| {
        let drawn = draw(fit, like, seed, number);
        let top = estimate_increments(&drawn, &fit.model, Some(&fit.phi)).ok()?.log_likelihood;
        let (_, held) = maximise(&fit.model, &drawn, &fit.phi, Some(index)).ok()?;
        // Rounding alone makes it negative.
        Some((2.0 * (top - held.value)).max(0.0))
    };
    let falls: Vec<f64> = (0..DRAWN).filter_map(fall).collect();
    let mean = falls.iter().sum::<f64>() / falls.len() as f64;
    // Never below chi-square: it is too small after few increments, and none is drawn where no data have a maximum.
    mean.max(1.0)
}
