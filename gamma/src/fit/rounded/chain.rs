//! Along the readings of a unit, window by window. In: laws of increments, readings. Out: the chance of each reading given those
//! before it. Never knows where laws are from.

use rustc_hash::FxHashMap;

use super::kernel::{By, Kernel, Known, Laws};
use super::window::{Even, Place, Window};
use crate::data::{self, Increment, Rounding};

/// What is known of laws is kept for all readings that share them, of whichever unit.
pub struct Chain {
    rounding: Rounding,
    window: Window,
    /// What is known by law and difference of readings.
    followed: FxHashMap<[u64; 3], Followed>,
    known_laws: FxHashMap<[u64; 2], Known>,
    /// Logarithms of wear, by difference of readings, where chances are found by densities.
    logarithms: Option<FxHashMap<u64, Vec<f64>>>,
}

/// What is known of one law and one difference of readings.
struct Followed {
    /// The density, where it hardly changes.
    even: Option<Even>,
    /// Chances to go from a part to a part, once they were asked for; ...
    chances: Option<Vec<f64>>,
    /// ... and from wear that is known exactly.
    after_exact: Option<Vec<f64>>,
}

impl Chain {
    pub fn new(rounding: Rounding) -> Self {
        let window = Window::new(rounding);
        Self {
            rounding,
            window,
            followed: FxHashMap::default(),
            known_laws: FxHashMap::default(),
            logarithms: None,
        }
    }

    /// The same for many laws: chances are found by densities where these are smooth, good to 1e-9.
    pub fn of_many_laws(rounding: Rounding) -> Self {
        Self { logarithms: Some(FxHashMap::default()), ..Self::new(rounding) }
    }

    /// The gauge's step.
    pub fn step(&self) -> f64 {
        self.rounding.step
    }

    /// Log-likelihood of the readings, per unit of wear.
    pub fn ln_likelihood(&mut self, laws: Laws<'_>, increments: &[Increment]) -> f64 {
        let (mut sum, step) = (0.0, self.rounding.step);
        self.follow(laws, increments, &mut |chance, _| sum += libm::log(chance / step));
        sum
    }

    /// Goes along the units; `seen` gets the chance of each reading given those before it, and that of a smaller one.
    pub fn follow(
        &mut self,
        laws: Laws<'_>,
        increments: &[Increment],
        seen: &mut dyn FnMut(f64, &dyn Fn() -> f64),
    ) {
        let Self { rounding, window, followed, known_laws, logarithms } = self;
        let (rounding, window) = (*rounding, &*window);
        let (step, part, parts) = (rounding.step, window.part, window.parts);
        let mut place = Place::Exact;
        let mut before: Option<&Increment> = None;
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
            let kernel = Kernel::new(laws, increment, rounding, window);
            let new = || Followed { even: kernel.even(), chances: None, after_exact: None };
            let own = followed.entry(kernel.key()).or_insert_with(new);
            if let Some(even) = own.even {
                let (chance, next) = even.follow(&place, window);
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
            let by = logarithms.as_mut().map_or(By::Integrals, By::Densities);
            let next: Vec<f64> = match &masses {
                None => own.after_exact.get_or_insert_with(|| kernel.after_exact(known, by)).clone(),
                Some(masses) => {
                    let chances = own.chances.get_or_insert_with(|| kernel.chances(known, by));
                    passed(masses, chances)
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
                under
                    + next.iter().zip(&window.chances).map(|(mass, [_, smaller])| mass * smaller).sum::<f64>()
            };
            seen(chance, &below);
            place = Place::Parts(weighed.into_iter().map(|mass| mass / chance).collect());
        }
    }
}

/// Sums that are kept side by side in registers.
const BLOCK: usize = 8;

/// Masses of the parts of the next window, from those of the one before and the chances of all differences of parts: each summed up in the
/// order of the parts before.
fn passed(masses: &[f64], chances: &[f64]) -> Vec<f64> {
    let parts = masses.len();
    let mut next = vec![0.0; parts];
    // The last difference to a part comes first.
    let from = |i: usize| &chances[parts - 1 - i..];
    let mut blocks = next.chunks_exact_mut(BLOCK);
    let mut first = 0;
    for block in &mut blocks {
        let mut sums = [0.0; BLOCK];
        for (i, mass) in masses.iter().enumerate() {
            for (sum, chance) in sums.iter_mut().zip(&from(i)[first..first + BLOCK]) {
                *sum += mass * chance;
            }
        }
        block.copy_from_slice(&sums);
        first += BLOCK;
    }
    for (at, sum) in (first..).zip(blocks.into_remainder()) {
        *sum = masses.iter().enumerate().map(|(i, mass)| mass * from(i)[at]).sum();
    }
    next
}
