//! What is worn off a joint by angle: bush, journal, or both. In: profiles, how far the journal has turned. Out: depth of both together
//! at any place of the bearing, its mean and bounds. Never knows where the journal is.

use super::profile::Profile;

/// What is worn off a joint: bush, journal, or both. The gap at a bearing angle is the clearance, the depth of the bush there, and
/// that of the journal at the place of it that has come there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surfaces<'p> {
    bush: Option<&'p Profile>,
    journal: Option<(&'p Profile, f64)>,
    extent: Extent,
}

/// What profiles of a joint are like all round. It stays as it is while nothing wears, wherever the journal has turned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    mean: f64,
    least: f64,
    most: f64,
}

impl Extent {
    /// Of the depths of a bush and of a journal, each if it is kept.
    pub fn of(bush: Option<&Profile>, journal: Option<&Profile>) -> Self {
        let each = || [bush, journal].into_iter().flatten();
        let sum = |of: fn(&Profile) -> f64| each().map(of).fold(0.0, |sum, depth| sum + depth);
        Self { mean: sum(Profile::mean), least: sum(Profile::minimum), most: sum(Profile::maximum) }
    }
}

impl<'p> From<&'p Profile> for Surfaces<'p> {
    fn from(bush: &'p Profile) -> Self {
        Self::new(Extent::of(Some(bush), None), Some(bush), None)
    }
}

impl<'p> Surfaces<'p> {
    /// Depth of the bush by bearing angle; that of the journal by its own angle, and how far it has turned in the bearing [rad];
    /// and the extent of both.
    pub fn new(extent: Extent, bush: Option<&'p Profile>, journal: Option<(&'p Profile, f64)>) -> Self {
        Self { bush, journal, extent }
    }

    /// Whether nothing is worn.
    pub fn are_round(&self) -> bool {
        self.bush.is_none() && self.journal.is_none()
    }

    /// Whether the journal is worn by its own angle.
    pub(super) fn turn(&self) -> bool {
        self.journal.is_some()
    }

    /// Depths of both, over the circumference [m].
    pub fn mean(&self) -> f64 {
        self.extent.mean
    }

    /// No more than the smallest depth of both together [m].
    pub(super) fn minimum(&self) -> f64 {
        self.extent.least
    }

    /// No less than the largest depth of both together [m].
    pub(super) fn maximum(&self) -> f64 {
        self.extent.most
    }

    /// Depths of both together in bins of the bearing one after the other, counted on past the last, by the middles of all;
    /// with the slopes of the journal's [m/rad].
    #[inline(always)]
    pub(super) fn at<const N: usize>(&self, middles: &[f64], place: usize) -> ([f64; N], [f64; N]) {
        let bins = middles.len();
        let bin = |i: usize| if place + i < bins { place + i } else { place + i - bins };
        let mut depths = self.bush.map_or([0.0; N], |bush| {
            let all = bush.depths();
            let together = all.get(place..).and_then(|rest| rest.first_chunk().copied());
            together.unwrap_or_else(|| core::array::from_fn(|i| all[bin(i)]))
        });
        let mut slopes = [0.0; N];
        if let Some((journal, turned)) = self.journal {
            for i in 0..N {
                let (depth, slope) = journal.at(middles[bin(i)] - turned);
                (depths[i], slopes[i]) = (depths[i] + depth, slope);
            }
        }
        (depths, slopes)
    }
}
