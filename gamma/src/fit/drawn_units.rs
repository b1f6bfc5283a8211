//! By how much the likelihood falls to the coefficient of variation that units were drawn with, of few units whose wear jumps. In:
//! parameters, data alike. Out: critical falls. Never knows how ends of intervals are sought.
//!
//! The law of few units takes totals as normal. Those of few jumps are skew, and where so few units may show no difference at all the
//! fall then exceeds that law's critical value in 8 to 11 % of samples in place of 5 (docs/units-that-differ.md). Here data are drawn
//! at the very coefficient of variation that is tested, the other parameters at their best (the hybrid resampling of C.-S. Chuang,
//! T. L. Lai, Statistica Sinica 10 (2000) 1), as where a gauge hides the scatter.

use super::bootstrap::{draw, own_seed};
use super::estimate::Fit;
use super::heterogeneity::estimate_units;
use super::maximise::maximise;
use super::model::Model;
use crate::data::Observations;

/// Units up to which data are drawn: of fifteen the law of few units holds in 93.7 % and more.
const MOST_UNITS: usize = 12;
/// Increments up to which they are: each drawn sample takes some 20 us an increment.
const MOST_INCREMENTS: usize = 200;
/// Of the degrees of freedom between units, what skew totals leave of them at most where data are drawn. Of shape 2 and ten readings
/// 0.95 are left, and the law of few units holds in 94 % and more.
const SKEW: f64 = 0.9;
/// Data drawn for a critical value: at 95 % the tenth of them, so that the test has its level exactly.
const DRAWN: u64 = 199;
/// Seed of drawn data, beside the data they are compared with.
const SEED: u64 = 18;

/// Whether the law of few units, which counts `units` of `count`, is too far from that of these data.
pub fn is_skew(units: f64, observations: &Observations, model: &Model) -> bool {
    let count = observations.units.len();
    let is_small = count <= MOST_UNITS && observations.increments.len() <= MOST_INCREMENTS;
    let is_exact = model.resolution.is_none() && !observations.has_bounds();
    is_small && is_exact && units - 1.0 < SKEW * (count as f64 - 1.0)
}

/// Data drawn from parameters in which units differ, and their likelihood there.
pub struct DrawnUnits<'a> {
    observations: &'a Observations,
    tested: Fit,
    seed: u64,
}

impl<'a> DrawnUnits<'a> {
    /// From parameters of a model in which units differ.
    pub fn new(model: &Model, phi: Vec<f64>, observations: &'a Observations) -> Self {
        let increments = &observations.increments;
        let count = increments.iter().filter(|one| one.is_growth()).count();
        let tested = Fit { model: *model, phi, covariance: vec![], log_likelihood: 0.0, increments: count };
        Self { observations, tested, seed: own_seed(SEED, increments) }
    }

    /// Twice the fall in data of this number.
    fn fall(&self, number: u64) -> Option<f64> {
        let Fit { model, phi, .. } = &self.tested;
        let increments = draw(&self.tested, &self.observations.increments, self.seed, number);
        let drawn = Observations { units: self.observations.units.clone(), increments };
        let top = estimate_units(&drawn, model).ok()?.fit.log_likelihood;
        let (_, point) = maximise(model, &drawn.increments, phi, Some(phi.len() - 1)).ok()?;
        Some(2.0 * (top - point.value))
    }

    /// The fall that is exceeded with probability 1 - `level`; None where too few of the drawn data have one.
    pub fn critical(&self, level: f64) -> Option<f64> {
        let mut falls: Vec<f64> = (0..DRAWN).filter_map(|number| self.fall(number)).collect();
        falls.sort_by(|a, b| b.total_cmp(a));
        let beyond = Self::beyond(level, falls.len());
        falls.get(beyond.checked_sub(1)?).copied()
    }

    /// Whether a fall is no larger than the critical one, by as few data as tell it.
    pub fn allows(&self, own: f64, level: f64) -> bool {
        let (mut drawn, mut beyond) = (0, 0);
        for fall in (0..DRAWN).filter_map(|number| self.fall(number)) {
            drawn += 1;
            beyond += usize::from(fall >= own);
            if beyond >= Self::beyond(level, DRAWN as usize) {
                return true;
            }
        }
        beyond > 0 && beyond >= Self::beyond(level, drawn)
    }

    /// How many of so many drawn data fall as far as is critical; the data at hand count among them.
    fn beyond(level: f64, drawn: usize) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most some ten")]
        let beyond = libm::floor((1.0 - level) * (drawn + 1) as f64 + 1e-9) as usize;
        beyond
    }
}
