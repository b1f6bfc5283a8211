//! Where a journal wears its bearing. In: depth by bearing angle, wear by the direction of the journal's offset.
//! Out: depth by bearing angle. Never knows forces.
//!
//! A journal that points in a direction touches where its centre meets the bearing first (see the penetration of [`super::Grid`]),
//! and wears there: edges go before a hole grows.

use core::f64::consts::FRAC_PI_2;

use super::profile::Profile;
use super::reach::NOTHING;
use crate::scalar::Scalar;

/// A minimum counts as shared by places this part of the depth of a bin's circular segment above it: small against
/// the segment, so that an unworn bearing is worn where the journal points.
const SHARED: f64 = 1.0 / 8.0;
/// Wear is taken away in pieces of at most this part of that depth, so that edges go before a hole grows.
const PIECE: f64 = 0.25;
/// Upper limit on the number of sub-steps of one wear step.
const MOST_PIECES: f64 = 4096.0;

impl Profile {
    /// Takes away wear that is given by the direction of the journal's offset, mean depths [m] of the bins, times a
    /// factor: where the journal touches when it points there. Says whether the bins fit (if not, nothing changes).
    pub fn wear_in(&mut self, by_direction: &[f64], factor: f64, clearance: f64) -> bool {
        if self.depths.len() != by_direction.len() {
            return false;
        }
        // Not a number (a lost measurement): the profile keeps what it has.
        if !(by_direction.iter().all(|depth| depth.is_finite()) && factor.is_finite()) {
            return true;
        }
        let mut bearing = Bearing::new(self, clearance);
        let most = by_direction.iter().fold(0.0_f64, |most, depth| most.max((factor * depth).abs()));
        let pieces = (most / (PIECE * bearing.segment)).ceil().clamp(1.0, MOST_PIECES);
        let amounts: Vec<f64> = by_direction.iter().map(|depth| factor * depth / pieces).collect();
        for _ in 0..pieces as usize {
            bearing.begin(&self.depths);
            for (direction, amount) in amounts.iter().enumerate().filter(|(_, amount)| **amount != 0.0) {
                bearing.share(direction, *amount);
            }
            self.depths.iter_mut().enumerate().for_each(|(bin, depth)| *depth += bearing.gained(bin));
        }
        true
    }
}

/// A bearing cut into bins. The bins within a quarter turn of a direction stand one after the other, those past the last once more
/// behind it.
struct Bearing {
    clearance: f64,
    bins: usize,
    /// Depth [m] of the circular segment of the centre's path that a bin covers.
    segment: f64,
    /// Over how far [m] beyond the nearest place others have a share: one over it.
    per_shared: f64,
    /// 1/cos of the angles between a direction and the bins within a quarter turn of it.
    inverse_cosines: Vec<f64>,
    /// Clearance with the depth of every bin [m].
    gaps: Vec<f64>,
    /// How far the journal's centre gets in a direction until it touches in each of the bins near it [m].
    reaches: Vec<f64>,
    /// What each of them has of the wear in that direction, and what bins have gained [m].
    weights: Vec<f64>,
    gains: Vec<f64>,
}

impl Bearing {
    fn new(profile: &Profile, clearance: f64) -> Self {
        let (bins, width) = (profile.depths.len(), profile.bin_angle());
        let quarter = (FRAC_PI_2 / width - 1e-9).floor() as usize;
        let inverse_cosine = |step: usize| 1.0 / libm::cos(step.abs_diff(quarter) as f64 * width);
        let inverse_cosines: Vec<f64> = (0..=2 * quarter).map(inverse_cosine).collect();
        let segment = clearance * (1.0 - libm::cos(width));
        Self {
            clearance,
            bins,
            segment,
            per_shared: 1.0 / (SHARED * segment),
            gaps: vec![0.0; 2 * bins],
            reaches: vec![0.0; inverse_cosines.len()],
            weights: vec![0.0; inverse_cosines.len()],
            gains: vec![0.0; 2 * bins],
            inverse_cosines,
        }
    }

    /// Begins a piece of wear at these depths [m].
    fn begin(&mut self, depths: &[f64]) {
        let depths = depths.iter().chain(depths);
        self.gaps.iter_mut().zip(depths).for_each(|(gap, depth)| *gap = self.clearance + depth);
        self.gains.fill(0.0);
    }

    /// Spreads an amount over the bins that the journal touches when it points in a direction.
    fn share(&mut self, direction: usize, amount: f64) {
        let first = (direction + self.bins - self.inverse_cosines.len() / 2) % self.bins;
        for ((reach, gap), inverse) in
            self.reaches.iter_mut().zip(&self.gaps[first..]).zip(&self.inverse_cosines)
        {
            *reach = gap * inverse;
        }
        let nearest = self.reaches.iter().copied().fold(f64::INFINITY, f64::min);
        let mut sum = 0.0;
        for (weight, reach) in self.weights.iter_mut().zip(&self.reaches) {
            let below = (nearest - reach) * self.per_shared;
            *weight = if below > -NOTHING { Scalar::exp(below) } else { 0.0 };
            sum += *weight;
        }
        let share = amount / sum;
        for (gain, weight) in self.gains[first..].iter_mut().zip(&self.weights) {
            *gain += share * weight;
        }
    }

    /// What a bin has gained since the begin of the piece [m].
    fn gained(&self, bin: usize) -> f64 {
        self.gains[bin] + self.gains[bin + self.bins]
    }
}

#[cfg(test)]
mod tests {
    use super::super::profile::peak;
    use super::*;

    const CLEARANCE: f64 = 1e-5;

    #[test]
    fn little_wear_of_an_unworn_bearing_stays_where_the_journal_points() {
        let mut worn = Profile::unworn(72).expect("bins");
        let by_direction = peak(72, 10, 1e-9);
        assert!(worn.wear_in(by_direction.depths(), 1.0, CLEARANCE));
        // exp(-8) = 3e-4 to either side; less as the middle wears.
        assert!((worn.depths()[10] / 1e-9 - 1.0).abs() < 1e-3, "{:?}", worn.depths());
    }

    #[test]
    fn much_wear_in_one_direction_makes_room_for_the_journal_and_keeps_its_volume() {
        let mut worn = Profile::unworn(72).expect("bins");
        let by_direction = peak(72, 40, 2e-5);
        assert!(worn.wear_in(by_direction.depths(), 0.5, CLEARANCE));
        let sum: f64 = worn.depths().iter().sum();
        // 72 bins and some thousand pieces round.
        assert!((sum / 1e-5 - 1.0).abs() < 1e-10, "{sum}");
        // The journal, moved by d, touches all over an arc: h = (c + d) cos - c, d the depth in the middle, to a
        // piece of wear and the shared minimum, some hundredths of a micrometre.
        let far = worn.depths()[40];
        for offset in 0..4 {
            let expected = (CLEARANCE + far) * (5.0 * offset as f64).to_radians().cos() - CLEARANCE;
            for bin in [40 - offset, 40 + offset] {
                let depth = worn.depths()[bin];
                assert!((depth - expected.max(0.0)).abs() < 3e-8, "{bin}: {depth:e} {expected:e}");
            }
        }
    }

    #[test]
    fn bins_that_do_not_fit_change_nothing() {
        let mut worn = Profile::unworn(8).expect("bins");
        assert!(!worn.wear_in(&[1e-6; 9], 1.0, CLEARANCE));
        assert!(worn.wear_in(&[f64::NAN; 8], 1.0, CLEARANCE));
        assert_eq!(worn, Profile::unworn(8).expect("bins"));
    }
}
