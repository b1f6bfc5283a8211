//! Whether journals come back to where they stood a turn before. In: where they stand between turns. Out: by how much a turn has left them
//! elsewhere, and by which factor that is more than of the turn before. Runs no turn, never knows what turns wear.
//!
//! A turn's wear does not tell it: a small swing about a place changes wear with its square, so that turns agree to 1e-6 while journals
//! swing by a hundredth of their clearance, the more from turn to turn.

use crate::simulate::{Place, TurnRunner};

/// Where all journals stand between two turns.
#[derive(Clone, Debug)]
pub(super) struct Stand(Vec<Place>);

/// How far journals stand from where they stood: offsets [radial clearances], rates [radial clearances/s].
pub(super) type Moved = [f64; 2];

impl Stand {
    /// Those of a runner.
    pub fn of(runner: &mut TurnRunner<'_>) -> Self {
        Self(runner.journals())
    }

    /// How far that is from another.
    pub fn from(&self, before: &Self) -> Moved {
        let apart = |of: fn(&Place) -> f64| {
            let each = self.0.iter().zip(&before.0);
            libm::sqrt(each.map(|(now, then)| ((of(now) - of(then)) / now.clearance).powi(2)).sum())
        };
        [apart(|place| place.offset), apart(|place| place.rate)]
    }
}

/// By which factor one way is longer than the one before: of offsets or of rates, whichever is more. Seen once a turn, a swing that nothing
/// damps is at any part of its way: offsets may be less by chance, but then rates are more.
pub(super) fn growth(before: Moved, now: Moved) -> f64 {
    let factor = |(now, before): (f64, f64)| if now == 0.0 { 0.0 } else { now / before };
    now.into_iter().zip(before).map(factor).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swing_that_nothing_damps_never_seems_to_come_back() {
        let place = |offset, rate| Place { offset, rate, clearance: 1e-5 };
        // A swing of two axes, sixty times as fast as a radian a second, seen at every part of it.
        for degrees in 0..360 {
            for step in [1, 37, 90, 143, 290] {
                let [first, second, third] = [0, 1, 2].map(|turn| {
                    let angle = f64::from(degrees + turn * step).to_radians();
                    let along = |size: f64, late: f64| {
                        let (sine, cosine) = (angle - late).sin_cos();
                        place(size * cosine, -60.0 * size * sine)
                    };
                    Stand(vec![along(1e-7, 0.0), along(4e-8, 0.9)])
                });
                let factor = growth(second.from(&first), third.from(&second));
                // Rounding of cosines.
                assert!(factor >= 1.0 - 1e-9, "{degrees} {step} {factor}");
            }
        }
        assert_eq!(growth([1.0, 2.0], [0.0, 0.0]), 0.0);
        assert_eq!(growth([0.0, 0.0], [1.0, 0.0]), f64::INFINITY);
    }
}
