//! How wear runs by cycles: the mean increment of a cycle by the wear before it. In: a table of what a revolution
//! wears, a definition of wear. Out: [`Curve`]. Never knows random numbers.
//!
//! With W the largest depth around the bearing, the bin that leads is that of the deterministic life: random wear
//! changes how fast the bearing goes along that life, and hardly the order of its bins.

use linkwear_runtime::life::WearOf;

use super::tables::Measured;

/// Intervals of a curve over wear.
const INTERVALS: usize = 400;
/// Steps of fourth order within a cycle.
const STEPS: usize = 8;

/// What is added to W, by the W before [m]: equal intervals from 0 on, straight lines between, its ends beyond them.
pub(super) struct Curve {
    spacing: f64,
    values: Vec<f64>,
}

impl Curve {
    /// What a revolution adds, up to the threshold; without feedback the geometry of the unworn joint stays.
    pub fn of_revolution(measured: &Measured, wear: WearOf, feedback: bool) -> Self {
        let spacing = measured.threshold() / INTERVALS as f64;
        let mut worn: Vec<f64> = Vec::new();
        let value = |index: usize| {
            let place = if feedback { index as f64 * spacing } else { 0.0 };
            let revolution = measured.table.at(0, place);
            let (WearOf::Profile(_), Some(profile)) = (wear, revolution.deposit) else {
                return revolution.depth;
            };
            let depths = profile.depths();
            let value = depths[deepest(if worn.is_empty() { depths } else { &worn })];
            worn.resize(depths.len(), 0.0);
            worn.iter_mut().zip(depths).for_each(|(sum, depth)| *sum += spacing / value * depth);
            value
        };
        Self { spacing, values: (0..=INTERVALS).map(value).collect() }
    }

    /// The same for cycles of so many revolutions.
    pub fn of_cycle(&self, revolutions: f64) -> Self {
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
        Self { spacing: self.spacing, values }
    }

    /// The same increment [m] whatever the wear, up to `reach` [m].
    #[cfg(test)]
    pub fn constant(increment: f64, reach: f64) -> Self {
        Self { spacing: reach, values: vec![increment; 2] }
    }

    /// Increment at W [m].
    pub fn at(&self, wear: f64) -> f64 {
        let place = wear / self.spacing;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the curve")]
        let below = (place.max(0.0) as usize).min(self.values.len() - 2);
        let part = (place - below as f64).clamp(0.0, 1.0);
        self.values[below] + part * (self.values[below + 1] - self.values[below])
    }
}

/// The bin of the largest depth, the first of equal ones.
fn deepest(depths: &[f64]) -> usize {
    (0..depths.len()).fold(0, |best, bin| if depths[bin] > depths[best] { bin } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_grows_with_the_root_of_the_clearance_has_the_increments_of_its_closed_form() {
        // dW/dn = k sqrt(c0 + W): sqrt(c0 + W) grows by k/2 per revolution.
        let (c0, threshold, k) = (10e-6, 80e-6, 1e-12);
        let spacing = 1.4 * threshold / INTERVALS as f64;
        let values = (0..=INTERVALS).map(|i| k * f64::sqrt(c0 + i as f64 * spacing)).collect();
        // 25.1 cycles until the threshold.
        let revolutions = 2.0 * (f64::sqrt(c0 + threshold) - f64::sqrt(c0)) / k / 25.1;
        let cycle = Curve { spacing, values }.of_cycle(revolutions);
        for wear in [0.0, 20e-6, 70e-6] {
            let expected = (f64::sqrt(c0 + wear) + 0.5 * k * revolutions).powi(2) - (c0 + wear);
            // Straight lines over 400 intervals.
            assert!((cycle.at(wear) / expected - 1.0).abs() < 1e-4, "{} {expected}", cycle.at(wear));
        }
    }
}
