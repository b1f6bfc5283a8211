//! What is told of derivatives, and how far they can be trusted. In: measured points. Out: [`Derived`]. Never knows how they were made.

use super::measured::{Point, Wear};
use super::result::{Derived, JointSensitivity};
use super::varied::Variant;

/// The first, the last and every second point in between.
pub(super) fn every_second(points: &[Point]) -> Vec<Point> {
    let is_kept = |(place, _): &(usize, &Point)| place.is_multiple_of(2) || place + 1 == points.len();
    points.iter().enumerate().filter(is_kept).map(|(_, point)| point.clone()).collect()
}

/// The points but for one, for each of those between the ends.
pub(super) fn without_each(points: &[Point]) -> impl Iterator<Item = Vec<Point>> {
    let inner = 1..points.len().saturating_sub(1);
    inner.map(|out| [&points[..out], &points[out + 1..]].concat())
}

/// Part of the difference between a life by all points and one by fewer that is left to the former: curves between points are of
/// order 2 at least.
const HALVED: f64 = 1.0 / 3.0;

/// How far derivatives may be off by what curves between points miss: by the difference to every second point, in which errors of
/// neighbours may cancel, or by the differences to those without one of them, as if they were of either sign by chance. A point whose
/// own derivative is off by chance changes the whole by as much as it is missed: of that nothing is halved.
pub(super) fn doubts_of_points(fine: &[f64], by_half: &[f64], without: &[Vec<f64>]) -> Vec<f64> {
    let doubt = |at: usize| {
        let squares = without.iter().map(|one| (fine[at] - one[at]) * (fine[at] - one[at])).sum::<f64>();
        (HALVED * (fine[at] - by_half[at]).abs()).max(squares.sqrt())
    };
    (0..fine.len()).map(doubt).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_neighbours_that_cancel_in_every_second_point_are_seen_without_each() {
        let doubts = doubts_of_points(&[1.0, 1.0], &[1.0, 1.6], &[vec![1.3, 1.0], vec![0.6, 1.0]]);
        // sqrt(0.3² + 0.4²) = 0.5, and a third of 0.6.
        assert!((doubts[0] - 0.5).abs() < 1e-15 && (doubts[1] - 0.2).abs() < 1e-15, "{doubts:?}");
    }

    #[test]
    fn errors_of_single_points_are_covered() {
        // Twelve points, each off by an error of its own, under the trapezoidal rule: what is told beside what is true.
        let mut seed = 1_u64;
        let mut error = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        let whole = |points: &[(f64, f64)]| -> f64 {
            points.windows(2).map(|two| 0.5 * (two[0].1 + two[1].1) * (two[1].0 - two[0].0)).sum()
        };
        let (mut told, mut is) = (0.0, 0.0);
        for _ in 0..200 {
            let points: Vec<(f64, f64)> = (0..12).map(|at| (f64::from(at), error())).collect();
            let second: Vec<(f64, f64)> =
                (0..12).filter(|at| at % 2 == 0 || *at == 11).map(|at| points[at]).collect();
            let without: Vec<Vec<f64>> =
                (1..11).map(|out| vec![whole(&[&points[..out], &points[out + 1..]].concat())]).collect();
            let fine = whole(&points);
            told += doubts_of_points(&[fine], &[whole(&second)], &without)[0].powi(2);
            is += fine * fine;
        }
        // By two hundred draws the ratio of squares is known to a tenth.
        assert!(told > 0.9 * is && told < 4.0 * is, "{told} {is}");
    }
}
