//! Where a journal wears its bearing. In: depth by bearing angle, wear by the direction of the journal's offset.
//! Out: depth by bearing angle. Never knows forces.
//!
//! A journal that points in a direction touches where its centre meets the bearing first (see the penetration of [`super::Grid`]),
//! and wears there: edges go before a hole grows.

use core::f64::consts::FRAC_PI_2;

use super::profile::Profile;
use super::reach::{LANES, weights};

/// A minimum counts as shared by places this part of the depth of a bin's circular segment above it: small against
/// the segment, so that an unworn bearing is worn where the journal points.
const SHARED: f64 = 1.0 / 8.0;
/// Wear is taken away in pieces that deepen no bin by more than this part of that depth, so that edges go before a hole grows.
const PIECE: f64 = 0.25;
/// Upper limit on the number of pieces of one wear step.
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
        let mut left = 1.0;
        while left > 0.0 {
            bearing.begin(&self.depths);
            for (direction, depth) in by_direction.iter().enumerate().filter(|(_, depth)| **depth != 0.0) {
                bearing.share(direction, factor * depth);
            }
            let part = bearing.piece(left);
            self.depths.iter_mut().enumerate().for_each(|(bin, depth)| *depth += part * bearing.gained(bin));
            left -= part;
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
    /// Bins within a quarter turn to one side of a direction.
    quarter: usize,
    /// Clearance with the depth of every bin [m].
    gaps: Vec<f64>,
    /// Of the bins within a quarter turn of a direction.
    near: Vec<Near>,
    /// What bins have gained [m].
    gains: Vec<f64>,
}

/// Bins one after the other, four at a time, so that compilers use vectors.
#[derive(Clone, Copy)]
struct Near {
    /// 1/cos of the angles between them and the direction; infinite where they are farther than a quarter turn.
    inverse_cosines: [f64; LANES],
    /// How far the journal's centre gets in the direction until it touches there [m].
    reaches: [f64; LANES],
    /// What each of them has of the wear in that direction.
    weights: [f64; LANES],
}

impl Bearing {
    fn new(profile: &Profile, clearance: f64) -> Self {
        let (bins, width) = (profile.depths.len(), profile.bin_angle());
        let quarter = (FRAC_PI_2 / width - 1e-9).floor() as usize;
        let inverse_cosine = |step: usize| {
            if step > 2 * quarter {
                return f64::INFINITY;
            }
            1.0 / libm::cos(step.abs_diff(quarter) as f64 * width)
        };
        let near = |chunk: usize| Near {
            inverse_cosines: core::array::from_fn(|lane| inverse_cosine(LANES * chunk + lane)),
            reaches: [f64::INFINITY; LANES],
            weights: [0.0; LANES],
        };
        let segment = clearance * (1.0 - libm::cos(width));
        Self {
            clearance,
            bins,
            segment,
            per_shared: 1.0 / (SHARED * segment),
            quarter,
            // A few more, so that no four are cut short.
            gaps: vec![0.0; 2 * bins + LANES],
            near: (0..(2 * quarter + 1).div_ceil(LANES)).map(near).collect(),
            gains: vec![0.0; 2 * bins + LANES],
        }
    }

    /// Begins wear at these depths [m].
    fn begin(&mut self, depths: &[f64]) {
        let depths = depths.iter().cycle();
        self.gaps.iter_mut().zip(depths).for_each(|(gap, depth)| *gap = self.clearance + depth);
        self.gains.fill(0.0);
    }

    /// Spreads an amount over the bins that the journal touches when it points in a direction.
    fn share(&mut self, direction: usize, amount: f64) {
        let first = (direction + self.bins - self.quarter) % self.bins;
        let (gaps, _) = self.gaps[first..].as_chunks::<LANES>();
        let mut least = [f64::INFINITY; LANES];
        for (near, gaps) in self.near.iter_mut().zip(gaps) {
            near.reaches = core::array::from_fn(|lane| gaps[lane] * near.inverse_cosines[lane]);
            least = core::array::from_fn(|lane| nearer(least[lane], near.reaches[lane]));
        }
        let nearest = least.into_iter().fold(f64::INFINITY, nearer);
        let mut sum = 0.0;
        for near in &mut self.near {
            let below = near.reaches.map(|reach| (nearest - reach) * self.per_shared);
            near.weights = weights(below).unwrap_or([0.0; LANES]);
            near.weights.iter().for_each(|weight| sum += weight);
        }
        let share = amount / sum;
        let (gains, _) = self.gains[first..].as_chunks_mut::<LANES>();
        for (gains, near) in gains.iter_mut().zip(&self.near) {
            *gains = core::array::from_fn(|lane| gains[lane] + share * near.weights[lane]);
        }
    }

    /// How much of what bins would gain is one piece, if this much of the whole is left: pieces that follow are as large, if they may be.
    fn piece(&self, left: f64) -> f64 {
        let most = (0..self.bins).fold(0.0_f64, |most, bin| most.max(self.gained(bin).abs()));
        let pieces = (left * most / (PIECE * self.segment)).ceil().max(1.0).min((left * MOST_PIECES).ceil());
        left / pieces
    }

    /// What a bin has gained since the begin [m].
    fn gained(&self, bin: usize) -> f64 {
        self.gains[bin] + self.gains[bin + self.bins]
    }
}

/// The smaller of two numbers.
fn nearer(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
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
