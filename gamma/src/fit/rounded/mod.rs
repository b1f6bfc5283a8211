//! Likelihood of readings that are the nearest multiple of a gauge's step, perhaps with a normal error before. In: increments of
//! readings, parameters. Out: its logarithm, and transforms for the goodness of fit. Never knows how it is maximised.
//!
//! Neighbouring increments share the rounding error of the reading between them, so a unit's readings are taken together:
//! its true wear is a Markov chain that passes through the windows of its readings, [r - R/2, r + R/2], with an error wider by
//! five of its standard deviations on either side. Each window is divided evenly; within a part wear counts as spread evenly. The
//! chance to go from a part to a part is then an exact second difference of the integral of the distribution function, however
//! singular the density is: no mass is lost or gained. With an error each part is weighed by the chance of the reading from it.
//! A reading at exposure 0 is exact; a later first reading may be anywhere in its window.
//!
//! Where the density hardly changes over the windows, their parts are not needed: it tilts the wear within a window by an
//! exponential, and the mean of an exponential over a window is known.

mod chain;
mod kernel;
mod nodes;
mod units;
mod window;

use rand::RngExt;
use rand::distr::Open01;
use rustc_hash::FxHashSet;

use crate::data::{Increment, Rounding};
use crate::random::Stream;

pub use self::chain::Chain;
use self::kernel::Kernel;
pub use self::kernel::Laws;
pub use self::units::Differing;
use self::window::Window;
pub use self::window::least_variance;

/// Products of a mass and a chance that an integral of the law costs as much as: some 0.3 us.
const INTEGRAL: usize = 600;
/// Such products that a likelihood may take: a seventh of a second, and an estimate with its intervals takes some three hundred
/// likelihoods.
const MOST_PRODUCTS: usize = 300_000_000;

/// Log-likelihood of the readings, per unit of wear as that of exact ones: probabilities over steps.
pub fn ln_likelihood(laws: Laws<'_>, increments: &[Increment], rounding: Rounding) -> f64 {
    Chain::new(rounding).ln_likelihood(laws, increments)
}

/// Probability integral transforms of the readings, each given those before it, spread evenly over its step.
pub fn transforms(
    laws: Laws<'_>,
    increments: &[Increment],
    rounding: Rounding,
    stream: &mut Stream,
) -> Vec<f64> {
    let mut transforms = Vec::with_capacity(increments.len());
    Chain::new(rounding).follow(laws, increments, &mut |chance, below| {
        transforms.push(below() + chance * stream.sample::<f64, _>(Open01));
    });
    transforms
}

/// Readings whose windows have to be taken part by part.
pub struct Windows {
    /// How many there are.
    pub count: usize,
    /// How many there may be of their kind.
    pub most: usize,
}

/// Readings over whose windows the law is not even; each is followed for so many parameters of its unit.
pub fn windows(laws: Laws<'_>, increments: &[Increment], rounding: Rounding, places: usize) -> Windows {
    let window = Window::new(rounding);
    let (mut count, mut known) = (0, FxHashSet::default());
    for increment in increments {
        let kernel = Kernel::new(laws, increment, rounding, &window);
        if kernel.even().is_none() {
            count += 1;
            known.insert(kernel.key());
        }
    }
    let all = places * (count * window.parts * window.parts + known.len() * window.parts * INTEGRAL);
    // Of the same mixture of equal and different ones.
    let most =
        if all > MOST_PRODUCTS { count as f64 * (MOST_PRODUCTS as f64 / all as f64) } else { f64::MAX };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    Windows { count, most: most as usize }
}

#[cfg(test)]
mod tests;
