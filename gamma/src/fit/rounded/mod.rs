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

mod kernel;
mod window;

use std::collections::{HashMap, HashSet};

use rand::RngExt;
use rand::distr::Open01;

use crate::data::{self, Increment, Rounding};
use crate::random::Stream;

pub use self::kernel::Laws;
use self::kernel::{Kernel, Known};
pub use self::window::least_variance;
use self::window::{Place, Window};

/// Products of a mass and a chance that an integral of the law costs as much as: some 0.3 us.
const INTEGRAL: usize = 600;
/// Such products that a likelihood may take: a seventh of a second, and an estimate with its intervals takes some three hundred
/// likelihoods.
const MOST_PRODUCTS: usize = 300_000_000;

/// Log-likelihood of the readings, per unit of wear as that of exact ones: probabilities over steps.
pub fn ln_likelihood(laws: Laws<'_>, increments: &[Increment], rounding: Rounding) -> f64 {
    let mut sum = 0.0;
    follow(laws, increments, rounding, &mut |chance, _| sum += libm::log(chance / rounding.step));
    sum
}

/// Probability integral transforms of the readings, each given those before it, spread evenly over its step.
pub fn transforms(
    laws: Laws<'_>,
    increments: &[Increment],
    rounding: Rounding,
    stream: &mut Stream,
) -> Vec<f64> {
    let mut transforms = Vec::with_capacity(increments.len());
    follow(laws, increments, rounding, &mut |chance, below| {
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

/// Readings over whose windows the law is not even.
pub fn windows(laws: Laws<'_>, increments: &[Increment], rounding: Rounding) -> Windows {
    let window = Window::new(rounding);
    let (mut count, mut known) = (0, HashSet::new());
    for increment in increments {
        let kernel = Kernel::new(laws, increment, rounding, &window);
        if kernel.even().is_none() {
            count += 1;
            known.insert(kernel.key());
        }
    }
    let all = count * window.parts * window.parts + known.len() * window.parts * INTEGRAL;
    // Of the same mixture of equal and different ones.
    let most =
        if all > MOST_PRODUCTS { count as f64 * (MOST_PRODUCTS as f64 / all as f64) } else { f64::MAX };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    Windows { count, most: most as usize }
}

/// Goes along the units; `seen` gets the chance of each reading given those before it, and that of a smaller one.
fn follow(
    laws: Laws<'_>,
    increments: &[Increment],
    rounding: Rounding,
    seen: &mut dyn FnMut(f64, &dyn Fn() -> f64),
) {
    let window = Window::new(rounding);
    let (step, part, parts) = (rounding.step, window.part, window.parts);
    let mut place = Place::Exact;
    let mut before: Option<&Increment> = None;
    let mut followed: HashMap<[u64; 3], Vec<f64>> = HashMap::new();
    let mut known_laws: HashMap<[u64; 2], Known> = HashMap::new();
    for increment in increments {
        if before.is_none_or(|last| last.unit != increment.unit || last.to != increment.from) {
            place = if increment.from > 0.0 { Place::Tilted(0.0) } else { Place::Exact };
        }
        match increment.known {
            data::Known::FromLevel => place = Place::Exact,
            data::Known::Anew => place = Place::Tilted(0.0),
            _ => {}
        }
        before = Some(increment);
        let kernel = Kernel::new(laws, increment, rounding, &window);
        if let Some(even) = kernel.even() {
            let (chance, next) = even.follow(&place, &window);
            // The distribution function is as straight as the density is even.
            seen(step * chance, &|| kernel.below(kernel.middle - 0.5 * step));
            place = next;
            continue;
        }
        let masses = match place {
            Place::Exact => None,
            Place::Tilted(tilt) => Some(window.tilted(tilt)),
            Place::Parts(masses) => Some(masses),
        };
        let known = known_laws.entry(kernel.law()).or_default();
        let next: Vec<f64> = match &masses {
            None => kernel.after_exact(known),
            Some(masses) => {
                let chances = followed.entry(kernel.key()).or_insert_with(|| kernel.chances(known));
                // Part by part of the window before: sums side by side, each in the order of the parts.
                let mut next = vec![0.0; parts];
                for (i, mass) in masses.iter().enumerate() {
                    for (into, chance) in next.iter_mut().zip(&chances[parts - 1 - i..]) {
                        *into += mass * chance;
                    }
                }
                next
            }
        };
        let weighed: Vec<f64> =
            next.iter().zip(&window.chances).map(|(mass, [here, _])| mass * here).collect();
        let chance: f64 = weighed.iter().sum();
        let below = || {
            let under: f64 = match &masses {
                None => kernel.below(kernel.wear(0) - 0.5 * parts as f64 * part),
                Some(masses) => {
                    let one = |(i, mass): (usize, &f64)| {
                        let k = -(i as isize);
                        mass * (kernel.shortfall(k) - kernel.shortfall(k - 1)) / part
                    };
                    masses.iter().enumerate().map(one).sum()
                }
            };
            under + next.iter().zip(&window.chances).map(|(mass, [_, smaller])| mass * smaller).sum::<f64>()
        };
        seen(chance, &below);
        place = Place::Parts(weighed.into_iter().map(|mass| mass / chance).collect());
    }
}

#[cfg(test)]
mod tests;
