//! Fig. 5: wear around the bearing at three cycles; the clearance opens by the largest depth. In: tables of what a
//! revolution wears. Out: [`Around`]. Never knows how it is drawn.
//!
//! A cycle stands for as many revolutions as make the finest model's largest depth reach the threshold after the
//! life of the paper's ground truth; the same number serves all models. They go on beyond the threshold.

use std::f64::consts::PI;

use linkwear_runtime::Watch;
use linkwear_runtime::life::{LifeState, MeanIncrement, WearStep, run_life};
use linkwear_runtime::wear::Profile;
use serde::Serialize;

use super::error::StudyError;
use super::model::JOINT;
use super::tables::{DEEPEST, FINEST, Measured, Tables};

/// Cycles of the paper's Fig. 5.
pub const CYCLES: [u64; 3] = [10, 20, 30];
/// Local maxima below this part of the largest depth are no peaks.
const LOWEST_PEAK: f64 = 0.1;
/// Wear of two models further apart than this does not belong to one peak [deg].
const SAME_PEAK: f64 = 30.0;
/// Factor on the threshold, large enough that no joint fails within 30 cycles.
const BEYOND: f64 = 10.0;

/// Fig. 5.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Around {
    /// Revolutions that a cycle stands for.
    pub revolutions_per_cycle: f64,
    /// Rigid coupler, no feedback.
    pub deterministic: WornBearing,
    /// Flexible coupler, feedback.
    pub proposed: WornBearing,
    /// The same with half the time step, more points and shorter wear steps.
    pub finest: WornBearing,
}

/// Wear of one model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WornBearing {
    /// Bearing angles of the depths [deg].
    pub angles: Vec<f64>,
    /// At every one of [`CYCLES`].
    pub snapshots: Vec<Snapshot>,
}

/// Wear after some cycles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Snapshot {
    /// The cycle.
    pub cycle: u64,
    /// Depth by bearing angle [m].
    pub depths: Vec<f64>,
    /// Largest depth [m].
    pub maximum: f64,
    /// Mean depth [m].
    pub mean: f64,
    /// Local maxima, the deepest first.
    pub peaks: Vec<Peak>,
}

/// A local maximum of the depth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// Bearing angle [deg], -180 to 180.
    pub angle: f64,
    /// Depth [m].
    pub depth: f64,
}

impl WornBearing {
    fn of(snapshots: Vec<Snapshot>) -> Self {
        Self {
            angles: snapshots.first().map_or_else(Vec::new, |first| angles(first.depths.len())),
            snapshots,
        }
    }
}

impl Snapshot {
    /// The deepest peak within 30 deg of an angle [deg].
    pub fn peak_near(&self, angle: f64) -> Option<Peak> {
        self.peaks.iter().find(|peak| turned(peak.angle - angle).abs() <= SAME_PEAK).copied()
    }

    /// Where the worn volume within 30 deg of an angle has its centre [deg]: unlike a peak, it does not jump between
    /// the bins of a flat top.
    pub fn centre_near(&self, angle: f64) -> f64 {
        let offsets = angles(self.depths.len()).into_iter().map(|at| turned(at - angle));
        let near = offsets.zip(&self.depths).filter(|(offset, _)| offset.abs() <= SAME_PEAK);
        let add = |(moment, sum), (offset, depth): (f64, &f64)| (moment + offset * depth, sum + depth);
        let (moment, sum) = near.fold((0.0, 0.0), add);
        if sum > 0.0 { turned(angle + moment / sum) } else { angle }
    }
}

/// An angle [deg] brought to -180 to 180.
pub fn turned(angle: f64) -> f64 {
    (angle + 180.0).rem_euclid(360.0) - 180.0
}

/// Lives through the wear of the three models.
pub(super) fn around(tables: &Tables<'_>) -> Result<Around, StudyError> {
    let revolutions_per_cycle = tables.revolutions_per_cycle(DEEPEST)?;
    let no_profile = || StudyError::Missing { kind: "profile of joint", name: JOINT.into() };
    let first = tables.rigid.table.at(0, 0.0).deposit.ok_or_else(no_profile)?;
    // Without feedback every revolution wears as the first.
    let multiplied = CYCLES.map(|cycle| snapshot(cycle, &first, cycle as f64 * revolutions_per_cycle));
    Ok(Around {
        revolutions_per_cycle,
        deterministic: WornBearing::of(multiplied.to_vec()),
        proposed: worn(tables.flexible, WearStep::TABLE, revolutions_per_cycle)?,
        finest: worn(tables.finest, FINEST, revolutions_per_cycle)?,
    })
}

/// Depths at [`CYCLES`] of a life in which the clearance opens by the largest depth.
fn worn(measured: &Measured, step: WearStep, revolutions: f64) -> Result<WornBearing, StudyError> {
    let mut settings = measured.life(DEEPEST, step);
    settings.keep_cycles = false;
    for joint in &mut settings.joints {
        joint.revolutions_per_cycle = revolutions;
        joint.threshold *= BEYOND;
    }
    let mut state = LifeState::new(&settings, 0)?;
    let mut snapshots = Vec::new();
    for cycle in CYCLES {
        settings.most_cycles = cycle;
        run_life(&settings, &mut measured.table.clone(), &MeanIncrement, &mut state, Watch::NONE)?;
        let profile = state.joints.first().and_then(|joint| joint.profile.clone());
        snapshots.extend(profile.map(|profile| snapshot(cycle, &profile, 1.0)));
    }
    Ok(WornBearing::of(snapshots))
}

fn angles(bins: usize) -> Vec<f64> {
    (0..bins).map(|bin| (bin as f64 + 0.5) * 360.0 / bins as f64 - 180.0).collect()
}

fn snapshot(cycle: u64, profile: &Profile, factor: f64) -> Snapshot {
    let depths: Vec<f64> = profile.depths().iter().map(|depth| factor * depth).collect();
    Snapshot {
        cycle,
        maximum: factor * profile.maximum(),
        mean: factor * profile.mean(),
        peaks: peaks(&depths),
        depths,
    }
}

/// Local maxima around the circle, each by the parabola through its bin and the two beside it; the deepest first.
fn peaks(depths: &[f64]) -> Vec<Peak> {
    let count = depths.len();
    let at = |bin: usize| depths[bin % count];
    let largest = depths.iter().fold(0.0, |a: f64, b| a.max(*b));
    let mut found = Vec::new();
    for bin in 0..count {
        let (before, here, after) = (at(bin + count - 1), at(bin), at(bin + 1));
        // A plateau counts once, at its left end.
        if here > before && here >= after && here > LOWEST_PEAK * largest {
            let shift = 0.5 * (before - after) / (before - 2.0 * here + after);
            let angle = (bin as f64 + 0.5 + shift) * 2.0 * PI / count as f64 - PI;
            found.push(Peak {
                angle: turned(angle.to_degrees()),
                depth: here - 0.25 * (before - after) * shift,
            });
        }
    }
    found.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_are_found_between_bins_and_across_the_seam() {
        let hill = |angle: f64, centre: f64| (1.0 - (turned(angle - centre) / 40.0).powi(2)).max(0.0);
        let depths: Vec<f64> =
            angles(72).iter().map(|angle| 2.0 * hill(*angle, 178.5) + hill(*angle, -33.3)).collect();
        let found = peaks(&depths);
        assert_eq!(found.len(), 2);
        // Parabolas are met exactly, but for rounding.
        assert!((found[0].angle - 178.5).abs() < 1e-9 && (found[0].depth - 2.0).abs() < 1e-12, "{found:?}");
        assert!((found[1].angle + 33.3).abs() < 1e-9 && (found[1].depth - 1.0).abs() < 1e-12);
    }

    #[test]
    fn peaks_and_centres_are_found_around_the_circle_and_far_ones_are_not() {
        let peaks = vec![Peak { angle: 179.0, depth: 2.0 }, Peak { angle: 0.0, depth: 1.0 }];
        let snapshot = Snapshot { cycle: 10, depths: Vec::new(), maximum: 2.0, mean: 1.0, peaks };
        assert_eq!(snapshot.peak_near(-178.0).map(|peak| peak.angle), Some(179.0));
        assert_eq!(snapshot.peak_near(90.0), None);
        // Bins of 10 deg at 165, 175 and -175 deg with depths 1, 2, 3: (1 x 165 + 2 x 175 + 3 x 185)/6.
        let mut depths = vec![0.0; 36];
        (depths[34], depths[35], depths[0]) = (1.0, 2.0, 3.0);
        let snapshot = Snapshot { depths, ..snapshot };
        // One division and a few roundings of angles.
        assert!((snapshot.centre_near(175.0) - (1070.0 / 6.0)).abs() < 1e-12);
    }
}
