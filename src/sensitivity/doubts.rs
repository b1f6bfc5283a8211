//! What is told of derivatives, and how far they can be trusted. In: measured points. Out: [`Derived`]. Never knows how they were made.

use super::measured::{Point, Wear};
use super::result::{Derived, JointSensitivity};
use super::varied::Variant;

/// The first, the last and every second point in between.
pub(super) fn every_second(points: &[Point]) -> Vec<Point> {
    let is_kept = |(place, _): &(usize, &Point)| place.is_multiple_of(2) || place + 1 == points.len();
    points.iter().enumerate().filter(is_kept).map(|(_, point)| point.clone()).collect()
}

/// The same points with what fewer steps wear, as far as that is known; nothing if it is known of none.
pub(super) fn coarser(points: &[Point]) -> Option<Vec<Point>> {
    let coarse = |point: &Point| Point {
        wear: point.coarse.clone().unwrap_or_else(|| point.wear.clone()),
        ..point.clone()
    };
    let is_known = points.iter().any(|point| point.coarse.is_some());
    is_known.then(|| points.iter().map(coarse).collect())
}

/// Wear of a revolution at a joint of the unworn mechanism.
pub(super) fn joint_sensitivity(base: &Variant, point: &Point, joint: usize) -> JointSensitivity {
    let slopes =
        |wear: &Wear, which: usize| wear.slopes.iter().map(|slopes| slopes[which]).collect::<Vec<f64>>();
    let derived = |which: usize| {
        let by = slopes(&point.wear[joint], which);
        let coarse = point.coarse.as_ref().map(|coarse| slopes(&coarse[joint], which));
        let doubts = doubts(&by, coarse.as_deref());
        Derived { value: point.wear[joint].values[which], by, doubts }
    };
    JointSensitivity { joint: base.joints[joint].joint.clone(), wear_integral: derived(0), depth: derived(1) }
}

/// By how much derivatives differ from coarser ones.
pub(super) fn doubts(fine: &[f64], coarse: Option<&[f64]>) -> Vec<f64> {
    let coarse = |at: usize| coarse.map_or(f64::NAN, |coarse| coarse[at]);
    fine.iter().enumerate().map(|(at, fine)| (fine - coarse(at)).abs()).collect()
}
