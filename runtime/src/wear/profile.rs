//! Depth of wear around a bearing or a journal. In: wear increments, each at an angle with a half-width.
//! Out: depth and slope at any angle, mean and maximum. Part of the state of a trajectory: saved and restored with it.
//! Never knows forces.
//!
//! The circumference is cut into equal bins that begin at -pi. A bin holds the mean depth over its angles,
//! so the sum is conserved whatever the arc. Between the middles of bins the depth is a monotone cubic:
//! continuously differentiable, and never outside the two depths it connects (no negative depth).
//!
//! In `f64` only: to look something up by an angle is not an operation of lanes. What a profile does to a contact
//! enters the lanes as a penetration with its gradient, see [`crate::contact::Support`].

use core::f64::consts::PI;

use thiserror::Error;

use super::feedback::Measure;

/// Bins unless told otherwise: 5 degrees each.
pub const DEFAULT_BINS: usize = 72;

/// Half-width of a contact in bins from which on its bins tell how deep it is.
const RESOLVED: f64 = 2.0;

/// Depths [m] on equal parts of the circumference.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Vec<f64>", into = "Vec<f64>"))]
pub struct Profile {
    pub(super) depths: Vec<f64>,
}

/// Depths that make no profile.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ProfileError {
    /// Fewer bins than an interpolation around the circle needs.
    #[error("a wear profile has {found} bins; it needs {} or more", Profile::FEWEST_BINS)]
    TooFewBins {
        /// Number given.
        found: usize,
    },
    /// A depth is not a finite number.
    #[error("depth {value} in bin {bin} of a wear profile; it must be finite")]
    Depth {
        /// Its bin, counted from 0.
        bin: usize,
        /// Its value [m].
        value: f64,
    },
}

impl TryFrom<Vec<f64>> for Profile {
    type Error = ProfileError;

    fn try_from(depths: Vec<f64>) -> Result<Self, ProfileError> {
        if depths.len() < Self::FEWEST_BINS {
            return Err(ProfileError::TooFewBins { found: depths.len() });
        }
        if let Some((bin, value)) = depths.iter().enumerate().find(|(_, depth)| !depth.is_finite()) {
            return Err(ProfileError::Depth { bin, value: *value });
        }
        Ok(Self { depths })
    }
}

impl From<Profile> for Vec<f64> {
    fn from(profile: Profile) -> Self {
        profile.depths
    }
}

impl Profile {
    /// The fewest bins of a profile.
    pub const FEWEST_BINS: usize = 4;

    /// An unworn circumference.
    ///
    /// # Errors
    /// If there are too few bins.
    pub fn unworn(bins: usize) -> Result<Self, ProfileError> {
        Self::try_from(vec![0.0; bins])
    }

    /// Mean depth of every bin [m]; bin i covers -pi + [i, i + 1) 2 pi/N.
    pub fn depths(&self) -> &[f64] {
        &self.depths
    }

    /// Angle covered by a bin [rad].
    pub fn bin_angle(&self) -> f64 {
        2.0 * PI / self.depths.len() as f64
    }

    /// Angle of the middle of a bin [rad].
    pub fn middle(&self, bin: usize) -> f64 {
        (bin as f64 + 0.5) * self.bin_angle() - PI
    }

    /// Mean depth over the circumference [m].
    pub fn mean(&self) -> f64 {
        Measure::Mean.of(&self.depths)
    }

    /// Depth of the bin that is least deep [m].
    pub fn minimum(&self) -> f64 {
        self.depths.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Depth of the deepest bin [m].
    pub fn maximum(&self) -> f64 {
        Measure::Maximum.of(&self.depths)
    }

    /// By how much the deepest place may be deeper than the mean of its bin [m], where contacts have a half-width [rad], zero if
    /// unknown. As its neighbours tell: an eighth of the second difference, by which a parabola rises within half a bin. Where
    /// contacts are as narrow as a bin neighbours tell nothing: there all that is worn off deeper than beside the contact may be worn by one
    /// that stays at its place, as a half ellipse.
    pub fn deeper_within_bin(&self, half_width: f64) -> f64 {
        let (count, most) = (self.depths.len(), self.maximum());
        let deepest = self.depths.iter().position(|depth| *depth == most).unwrap_or(0);
        // Counted from a whole turn before, so that no place is below zero.
        let depth = |place: usize| self.depths[place % count];
        let by_neighbours = (2.0 * most - depth(deepest + 1) - depth(deepest + count - 1)) / 8.0;
        if !self.is_narrow(half_width) {
            return by_neighbours;
        }
        let reach = half_width / self.bin_angle();
        let touched = ((2.0 * reach).ceil() as usize + 1).min(count - 2);
        let peak = |first: usize| {
            let beside = f64::max(depth(first + count - 1), depth(first + touched));
            let above: f64 = (first..first + touched).map(|place| depth(place) - beside).sum();
            beside + 2.0 * above / (PI * reach)
        };
        // Every way in which the contact may lie about the deepest bin.
        let peaks = (0..touched).map(|before| peak(deepest + count - before));
        peaks.fold(most + by_neighbours, f64::max) - most
    }

    /// Whether a contact of a half-width [rad] is so narrow that bins do not tell how deep it is.
    pub fn is_narrow(&self, half_width: f64) -> bool {
        half_width > 0.0 && half_width < RESOLVED * self.bin_angle()
    }

    /// Adds `amount` [m rad], the integral of the depth over the angle, around `angle` [rad], spread over
    /// `half_width` [rad] to both sides like the pressure of Hertz (a half ellipse); zero width goes into
    /// one bin, more than half a turn counts as half a turn. Angles count modulo a turn.
    ///
    /// The amount per time is k/H F_n |v_t| / (r L): volume over radius and length.
    pub fn deposit(&mut self, angle: f64, half_width: f64, amount: f64) {
        let count = self.depths.len();
        let width = self.bin_angle();
        let centre = self.bins_from_start(angle);
        let reach = half_width.clamp(0.0, PI) / width;
        // Not a number (a lost state): the profile keeps what it has.
        if !(centre.is_finite() && reach.is_finite() && amount.is_finite()) {
            return;
        }
        let depth = amount / width;
        if reach == 0.0 {
            self.depths[centre as usize % count] += depth;
            return;
        }
        let first = (centre - reach).floor();
        let last = (centre + reach).ceil().max(first + 1.0);
        let mut below = 0.0;
        for step in 1..=(last - first) as usize {
            let edge = first + step as f64;
            // The last share is what is left, so that shares add up to one.
            let up_to = if edge >= last { 1.0 } else { half_ellipse_below((edge - centre) / reach) };
            let bin = (edge - 1.0).rem_euclid(count as f64) as usize % count;
            self.depths[bin] += depth * (up_to - below);
            below = up_to;
        }
    }

    /// Multiplies every depth by a factor: the jump from the turns that were run to those they stand for.
    pub fn scale(&mut self, factor: f64) {
        for depth in &mut self.depths {
            *depth *= factor;
        }
    }

    /// Adds another profile with the same bins, times a factor; says whether the bins fit (if not,
    /// nothing changes).
    pub fn add_scaled(&mut self, other: &Self, factor: f64) -> bool {
        self.add_depths(&other.depths, factor)
    }

    /// Adds a depth [m] to every bin, times a factor; says whether the bins fit (if not, nothing changes).
    pub fn add_depths(&mut self, depths: &[f64], factor: f64) -> bool {
        let fits = self.depths.len() == depths.len();
        if fits {
            for (depth, more) in self.depths.iter_mut().zip(depths) {
                *depth += factor * more;
            }
        }
        fits
    }

    /// Depth [m] and its slope [m/rad] at an angle [rad], counted modulo a turn.
    pub fn at(&self, angle: f64) -> (f64, f64) {
        let count = self.depths.len();
        let place = self.bins_from_start(angle) - 0.5;
        if !place.is_finite() {
            return (f64::NAN, f64::NAN);
        }
        let part = place - place.floor();
        let left = place.floor().rem_euclid(count as f64) as usize % count;
        let depth = |offset: usize| self.depths[(left + count - 1 + offset) % count];
        let (before, from, to, after) = (depth(0), depth(1), depth(2), depth(3));
        let rise = to - from;
        let (m0, m1) = (limited_slope(from - before, rise), limited_slope(rise, after - to));
        // Cubic Hermite with slopes per bin.
        let (a, b) = (m0 + m1 - 2.0 * rise, 3.0 * rise - 2.0 * m0 - m1);
        let value = ((a * part + b) * part + m0) * part + from;
        let slope = (3.0 * a * part + 2.0 * b) * part + m0;
        (value, slope / self.bin_angle())
    }

    /// Place of an angle in bins, in [0, N].
    fn bins_from_start(&self, angle: f64) -> f64 {
        ((angle + PI) / self.bin_angle()).rem_euclid(self.depths.len() as f64)
    }
}

/// Share of a half ellipse over [-1, 1] that lies below x.
fn half_ellipse_below(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + (x * libm::sqrt(1.0 - x * x) + libm::asin(x)) / PI
}

/// Slope at a point from the rises on both sides: harmonic mean, zero at a peak. Keeps the cubic monotone
/// between points (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304).
fn limited_slope(before: f64, after: f64) -> f64 {
    let product = before * after;
    if product > 0.0 { 2.0 * product / (before + after) } else { 0.0 }
}

/// Worn in one bin alone, to a depth [m].
#[cfg(test)]
pub(super) fn peak(bins: usize, at: usize, depth: f64) -> Profile {
    let mut depths = vec![0.0; bins];
    depths[at] = depth;
    Profile { depths }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn integral(profile: &Profile) -> f64 {
        profile.depths().iter().sum::<f64>() * profile.bin_angle()
    }

    #[test]
    fn a_narrow_deposit_fills_its_bin_and_a_wide_one_is_even_on_both_sides() {
        let mut profile = Profile::unworn(72).unwrap();
        profile.deposit(profile.middle(10), 0.0, 1.0);
        assert_eq!(profile.depths()[10], 1.0 / profile.bin_angle());
        let mut profile = Profile::unworn(72).unwrap();
        profile.deposit(profile.middle(3), 2.2 * profile.bin_angle(), 1.0);
        let depths = profile.depths();
        let worn: Vec<usize> = (0..72).filter(|bin| depths[*bin] != 0.0).collect();
        assert_eq!(worn, [1, 2, 3, 4, 5]);
        // The middle lies off by the rounding of pi over a bin, 5e-15; shares change by half of that.
        let unit = 1e-14 / profile.bin_angle();
        assert!((depths[1] - depths[5]).abs() < unit && (depths[2] - depths[4]).abs() < unit);
        assert!(depths[3] > depths[2] && depths[2] > depths[1]);
    }

    #[test]
    fn an_arc_across_the_seam_is_the_same_arc_elsewhere_turned() {
        let (mut seam, mut inside) = (Profile::unworn(72).unwrap(), Profile::unworn(72).unwrap());
        let width = seam.bin_angle();
        seam.deposit(PI - 0.3 * width, 2.0 * width, 1e-6);
        inside.deposit(PI - 10.3 * width, 2.0 * width, 1e-6);
        for bin in 0..72 {
            let turned = inside.depths()[(bin + 62) % 72];
            // The angles differ by rounding, 4e-16/width of a bin.
            assert!((seam.depths()[bin] - turned).abs() < 1e-13 * 1e-6 / width, "{bin}");
        }
        let mut again = Profile::unworn(72).unwrap();
        again.deposit(-PI - 0.3 * width, 2.0 * width, 1e-6);
        assert!((again.depths()[0] - seam.depths()[0]).abs() < 1e-13 * 1e-6 / width);
    }

    #[test]
    fn a_half_ellipse_has_its_shares() {
        assert_eq!(
            (half_ellipse_below(-1.0), half_ellipse_below(0.0), half_ellipse_below(2.0)),
            (0.0, 0.5, 1.0)
        );
        // 1/2 + (sqrt(3)/4 + pi/6)/pi.
        let expected = 0.5 + (f64::sqrt(3.0) / 4.0 + PI / 6.0) / PI;
        assert!((half_ellipse_below(0.5) - expected).abs() < 2e-16);
    }

    #[test]
    fn mean_and_maximum_are_those_of_the_bins() {
        let profile = Profile::try_from(vec![1.0, 2.0, 6.0, 3.0]).unwrap();
        assert_eq!((profile.mean(), profile.maximum()), (3.0, 6.0));
        // In the middle of a bin the depth is that of the bin; at a peak it is level.
        let (depth, slope) = profile.at(profile.middle(2));
        assert!((depth - 6.0).abs() < 1e-14 && slope.abs() < 1e-13);
    }

    #[test]
    fn a_place_as_narrow_as_a_bin_may_be_deeper_than_its_bin() {
        // Alone in its bin: a quarter deeper. A cosine in bins of 5 degrees: (5 degrees)² / 8.
        assert_eq!(peak(72, 0, 4e-6).deeper_within_bin(0.0), 1e-6);
        let depth = |bin: u32| 1.0 + (f64::from(bin) * 5.0_f64.to_radians()).cos();
        let wide = Profile::try_from((0..72).map(depth).collect::<Vec<_>>()).unwrap();
        let expected = 5.0_f64.to_radians().powi(2) / 8.0;
        // Of the next order: (5 degrees)² / 12 of it.
        assert!((wide.deeper_within_bin(0.5) / expected - 1.0).abs() < 1e-3);
        assert_eq!(Profile::unworn(72).unwrap().deeper_within_bin(0.0), 0.0);
    }

    #[test]
    fn a_contact_that_stays_may_be_as_deep_as_its_half_ellipse_wherever_it_lies_and_one_that_goes_round_no_deeper()
     {
        for bins in [8, 36, 72, 720] {
            let mut round = Profile::unworn(bins).unwrap();
            let bin = round.bin_angle();
            for reach in [1e-3, 0.1, 0.5, 0.99, 1.4, 1.9] {
                for off in [0.0, 0.2, 0.5, 0.77] {
                    // Half a turn is all that wears: fewer bins are not wide enough for it.
                    if bins == 8 && reach > 1.0 {
                        continue;
                    }
                    let mut profile = Profile::unworn(bins).unwrap();
                    profile.deposit(PI + (off - 1.0) * bin, reach * bin, 1.0);
                    let deepest = 2.0 / (PI * reach * bin);
                    let told = profile.maximum() + profile.deeper_within_bin(reach * bin);
                    // Neighbours may tell an eighth more.
                    assert!(
                        told > 0.999 * deepest && told < 1.15 * deepest,
                        "{bins} {reach} {off}: {told} {deepest}"
                    );
                }
            }
            for place in 0..4 * bins {
                round.deposit(f64::from(place as u32) * bin / 4.0, 0.1 * bin, 1.0);
            }
            assert!(round.deeper_within_bin(0.1 * bin) < 1e-9 * round.maximum());
            assert!(!round.is_narrow(0.0) && !round.is_narrow(2.5 * bin));
        }
    }

    #[test]
    fn profiles_that_make_no_sense_are_refused() {
        assert_eq!(Profile::unworn(3), Err(ProfileError::TooFewBins { found: 3 }));
        let error = Profile::try_from(vec![0.0, f64::INFINITY, 0.0, 0.0]).unwrap_err();
        assert_eq!(error, ProfileError::Depth { bin: 1, value: f64::INFINITY });
    }

    #[test]
    fn lost_numbers_change_nothing() {
        let mut profile = Profile::unworn(8).unwrap();
        profile.deposit(f64::NAN, 0.1, 1.0);
        profile.deposit(0.0, f64::NAN, 1.0);
        profile.deposit(0.0, 0.1, f64::INFINITY);
        assert_eq!(profile, Profile::unworn(8).unwrap());
        assert!(profile.at(f64::NAN).0.is_nan());
    }

    #[test]
    fn profiles_add_up_and_scale() {
        let mut sum = Profile::try_from(vec![1.0, 2.0, 3.0, 4.0]).unwrap();
        let other = Profile::try_from(vec![1.0, 0.0, 1.0, 0.0]).unwrap();
        assert!(sum.add_scaled(&other, 10.0));
        assert_eq!(sum.depths(), [11.0, 2.0, 13.0, 4.0]);
        sum.scale(0.5);
        assert_eq!(sum.depths(), [5.5, 1.0, 6.5, 2.0]);
        assert!(!sum.add_scaled(&Profile::unworn(5).unwrap(), 1.0));
    }

    proptest! {
        #[test]
        fn deposits_are_conserved(
            bins in 4..200_usize, deposits in prop::collection::vec((-20.0..20.0_f64, 0.0..4.0_f64, 0.0..1e-6_f64), 1..20),
        ) {
            let mut profile = Profile::unworn(bins).unwrap();
            let mut total = 0.0;
            for (angle, half_width, amount) in deposits {
                profile.deposit(angle, half_width, amount);
                total += amount;
            }
            // Up to 200 bins and 20 deposits, each sum rounds once.
            prop_assert!((integral(&profile) - total).abs() <= 1e-14 * total);
            prop_assert!(profile.depths().iter().all(|depth| *depth >= 0.0));
            prop_assert!((profile.mean() * 2.0 * PI - total).abs() <= 1e-14 * total);
        }

        #[test]
        fn depth_between_bins_stays_between_their_depths_and_is_periodic(
            depths in prop::collection::vec(0.0..1.0_f64, 4..40), angle in -PI..PI,
        ) {
            let profile = Profile::try_from(depths).unwrap();
            let count = profile.depths().len();
            let (value, slope) = profile.at(angle);
            let place = (angle + PI) / profile.bin_angle() - 0.5;
            let left = place.floor().rem_euclid(count as f64) as usize % count;
            let (a, b) = (profile.depths()[left], profile.depths()[(left + 1) % count]);
            // Rounding of a cubic with coefficients below six.
            prop_assert!(value >= a.min(b) - 4e-15 && value <= a.max(b) + 4e-15);
            let (again, again_slope) = profile.at(angle + 2.0 * PI);
            // The angle differs by rounding, 1e-15, times the largest slope, three bins' rise per bin.
            prop_assert!((value - again).abs() < 1e-13 && (slope - again_slope).abs() < 1e-11);
        }
    }
}
