//! How large the noise of each group is. In: residuals. Out: standard deviations. Never knows a model.

use super::problem::Problem;
use super::search::Found;

/// Noise below this part of the spread of the readings is that of arithmetic.
const LEAST: f64 = 1e-12;

impl Problem<'_> {
    /// Before anything is known: what is given, else how far the readings spread.
    pub fn first_noise(&self) -> Vec<f64> {
        let groups = self.readings.groups().iter();
        groups.map(|group| group.noise.unwrap_or_else(|| group.spread())).collect()
    }

    /// What is given, else what residuals show, each group paying its part of the parameters.
    pub fn shown_noise(&self, found: &Found) -> Vec<f64> {
        let part = 1.0 - self.free.len() as f64 / self.readings.len() as f64;
        let groups = self.readings.groups().iter().zip(self.readings.ranges()).zip(&self.noise);
        groups
            .map(|((group, range), noise)| {
                let count = range.len() as f64;
                let squares: f64 = found.residuals.as_slice()[range].iter().map(|r| r * r).sum();
                let shown = noise * libm::sqrt(squares / (count * part));
                group.noise.unwrap_or_else(|| shown.max(LEAST * group.spread()))
            })
            .collect()
    }

    /// Degrees of freedom by which the noise is known; none: it is given.
    pub fn degrees(&self) -> Option<usize> {
        let unknown = self.readings.groups().iter().filter(|group| group.noise.is_none());
        let count: usize = unknown.map(|group| group.values.len()).sum();
        (count > 0).then(|| count.saturating_sub(self.free.len()).max(1))
    }
}
