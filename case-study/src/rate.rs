//! How wear runs by cycles: the mean increment of a cycle by the wear before it. In: a table of what a revolution
//! wears, a definition of wear. Out: [`Cycle`]. Never knows random numbers.
//!
//! With W the largest depth around the bearing, the bin that leads is that of the deterministic life: random wear
//! changes how fast the bearing goes along that life, and hardly the order of its bins.

use linkwear_runtime::life::WearOf;
use linkwear_runtime::wear::{Measure, Profile};

use super::tables::{Definition, Measured};

/// Intervals of a curve over wear.
const INTERVALS: usize = 400;
/// Steps of fourth order within a cycle.
const STEPS: usize = 8;

/// Depth that a revolution adds to W, by W: equal intervals from 0 on.
pub(super) struct Rate {
    spacing: f64,
    values: Vec<f64>,
}

impl Rate {
    /// From a table, up to W = `reach` [m].
    pub fn of(measured: &Measured, definition: Definition, reach: f64) -> Self {
        let spacing = reach / INTERVALS as f64;
        // Without feedback the geometry of the unworn joint stays.
        let place = |index: usize| if definition.gamma > 0.0 { index as f64 * spacing } else { 0.0 };
        let mut worn: Option<Profile> = None;
        let mut values = Vec::with_capacity(INTERVALS + 1);
        for index in 0..=INTERVALS {
            let revolution = measured.table.at(0, place(index));
            let (value, profile) = match (definition.wear, revolution.deposit) {
                (WearOf::Profile(Measure::Maximum), Some(profile)) => {
                    let leads = leading(worn.as_ref().unwrap_or(&profile));
                    (profile.depths()[leads], Some(profile))
                }
                (WearOf::Profile(Measure::Mean), Some(profile)) => (profile.mean(), None),
                _ => (revolution.depth, None),
            };
            if let Some(profile) = profile {
                // Bins of one table always fit.
                match &mut worn {
                    Some(worn) => _ = worn.add_scaled(&profile, spacing / value),
                    None => worn = Some(scaled(profile, spacing / value)),
                }
            }
            values.push(value);
        }
        Self { spacing, values }
    }

    /// Depth per revolution at W [m].
    fn at(&self, wear: f64) -> f64 {
        line(&self.values, wear / self.spacing)
    }

    /// Cycles of so many revolutions.
    pub fn cycle(&self, revolutions: f64) -> Cycle {
        let increment = |from: f64| {
            let step = 1.0 / STEPS as f64;
            let rate = |wear: f64| revolutions * self.at(wear);
            let advance = |wear: f64, _| {
                let k1 = rate(wear);
                let k2 = rate(wear + 0.5 * step * k1);
                let k3 = rate(wear + 0.5 * step * k2);
                let k4 = rate(wear + step * k3);
                wear + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            };
            (0..STEPS).fold(from, advance) - from
        };
        let values = (0..=INTERVALS).map(|index| increment(index as f64 * self.spacing)).collect();
        Cycle { spacing: self.spacing, values }
    }
}

fn scaled(mut profile: Profile, factor: f64) -> Profile {
    profile.scale(factor);
    profile
}

/// The deepest bin.
fn leading(profile: &Profile) -> usize {
    let depths = profile.depths();
    (0..depths.len()).fold(0, |best, bin| if depths[bin] > depths[best] { bin } else { best })
}

/// Value at a place counted in intervals, on straight lines; beyond the ends, that at the end.
fn line(values: &[f64], place: f64) -> f64 {
    let last = values.len() - 1;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the curve")]
    let below = (place.max(0.0) as usize).min(last - 1);
    let part = (place - below as f64).clamp(0.0, 1.0);
    values[below] + part * (values[below + 1] - values[below])
}

/// Mean increment of a cycle by the wear before it.
pub(super) struct Cycle {
    spacing: f64,
    values: Vec<f64>,
}

impl Cycle {
    /// The same mean increment [m] whatever the wear, up to `reach` [m].
    #[cfg(test)]
    pub fn constant(increment: f64, reach: f64) -> Self {
        Self { spacing: reach, values: vec![increment; 2] }
    }

    /// dLambda [m] of a cycle that begins with W [m].
    pub fn mean_increment(&self, wear: f64) -> f64 {
        line(&self.values, wear / self.spacing)
    }

    /// Cycles until the mean path reaches a threshold [m], straight within the last one.
    pub fn mean_life(&self, threshold: f64) -> f64 {
        let (mut wear, mut cycles) = (0.0, 0.0);
        loop {
            let more = self.mean_increment(wear);
            if wear + more >= threshold {
                return cycles + (threshold - wear) / more;
            }
            wear += more;
            cycles += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_grows_with_the_root_of_the_clearance_has_the_life_of_its_closed_form() {
        // dW/dn = k sqrt(c0 + W): n = 2 (sqrt(c0 + W) - sqrt(c0)) / k.
        let (c0, threshold, k) = (10e-6, 80e-6, 1e-12);
        let spacing = 1.4 * threshold / INTERVALS as f64;
        let values = (0..=INTERVALS).map(|i| k * f64::sqrt(c0 + i as f64 * spacing)).collect();
        let rate = Rate { spacing, values };
        let revolutions = 2.0 * (f64::sqrt(c0 + threshold) - f64::sqrt(c0)) / k;
        let cycle = rate.cycle(revolutions / 25.1);
        // Straight lines over 400 intervals are good to 1e-5, straight lines within the last cycle to
        // 0.1 x 0.9 / 2 of the growth in a cycle, 2 %: 1e-3.
        assert!((cycle.mean_life(threshold) - 25.1).abs() < 2e-3, "{}", cycle.mean_life(threshold));
        let first = cycle.mean_increment(0.0);
        let expected = (f64::sqrt(c0) + 0.5 * k * revolutions / 25.1).powi(2) - c0;
        assert!((first / expected - 1.0).abs() < 1e-4, "{first} {expected}");
    }
}
