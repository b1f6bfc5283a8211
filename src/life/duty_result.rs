//! What a mission makes of a life: the part that each segment has in the wear, how long the machine would live in it alone. In: what the
//! segments have worn along the mean path. Out: [`MissionResult`]. Never runs the equations.

use linkwear_runtime::Watch;
use linkwear_runtime::life::{
    LifeOutcome, LifeSettings, LifeState, MeanIncrement, SegmentsMeasured, WearStep, WearTable, run_life,
};
use linkwear_runtime::wear::ContactMeasure;

use super::mission::Duty;
use super::mission_result::{AloneResult, MissionResult, SegmentResult};
use super::result::LifeResult;

/// Wear of the last measurement beyond which a life alone is not told from it, as a part of the threshold.
const COVERED: f64 = 0.95;

impl MissionResult {
    /// Of a mean path; `measured` is what its segments have worn on the way.
    pub(super) fn new(
        duty: &Duty,
        settings: &LifeSettings,
        result: &LifeResult,
        measured: &[SegmentsMeasured],
    ) -> Option<Self> {
        let name = duty.name.clone()?;
        let path = Path::new(duty, settings, result, measured);
        let segment = |(at, setup): (usize, &super::mission::Setup)| SegmentResult {
            name: setup.name.clone(),
            time: setup.time,
            revolutions: setup.revolutions,
            set: setup.set.clone(),
            duration: setup.duration,
            seconds_per_revolution: setup.seconds,
            wear: (0..settings.joints.len()).map(|joint| path.share(at, joint)).collect(),
            alone: path.alone(at),
        };
        let segments = duty.setups.iter().enumerate().map(segment).collect();
        Some(Self { name, seconds: duty.seconds(), segments, binning: None })
    }
}

/// The mean path with what each segment wears along it.
struct Path<'a> {
    duty: &'a Duty,
    settings: &'a LifeSettings,
    result: &'a LifeResult,
    /// In the order of the wear of the joint that leads.
    points: Vec<&'a SegmentsMeasured>,
}

impl<'a> Path<'a> {
    fn new(
        duty: &'a Duty,
        settings: &'a LifeSettings,
        result: &'a LifeResult,
        measured: &'a [SegmentsMeasured],
    ) -> Self {
        let mut path = Self { duty, settings, result, points: Vec::new() };
        let Some(first) = measured.first() else { return path };
        let pace = |joint: &usize| path.gain(first, *joint) / settings.joints[*joint].threshold;
        let lead = (0..settings.joints.len()).max_by(|a, b| pace(a).total_cmp(&pace(b))).unwrap_or(0);
        // With several joints a table ends with each of them unworn beside the others.
        let has_others = result.table.as_ref().is_some_and(|table| table.others.is_some());
        let last = if has_others { settings.joints.len() } else { 0 };
        let mut points: Vec<&SegmentsMeasured> =
            measured[..measured.len().saturating_sub(last)].iter().collect();
        points.sort_by(|a, b| a.wear[lead].total_cmp(&b.wear[lead]));
        // Of several at one place the last was measured nearest to the path.
        for point in points {
            if path.points.last().is_some_and(|known| known.wear[lead] == point.wear[lead]) {
                path.points.pop();
            }
            path.points.push(point);
        }
        path
    }

    /// W that a revolution of the mission adds to a joint [m].
    fn gain(&self, point: &SegmentsMeasured, joint: usize) -> f64 {
        (0..self.duty.setups.len()).map(|segment| self.part(point, segment, joint)).sum()
    }

    /// A segment's part of it.
    fn part(&self, point: &SegmentsMeasured, segment: usize, joint: usize) -> f64 {
        let of = self.settings.joints[joint].wear;
        self.duty.setups[segment].revolutions * of.of(&point.segments[segment][joint])
    }

    /// Share of a segment in the wear of a joint, the mean over its wear until the life ends.
    fn share(&self, segment: usize, joint: usize) -> f64 {
        if self.duty.setups.len() == 1 {
            return 1.0;
        }
        let end = self.result.cycles.last().map_or(0.0, |cycle| cycle.joints[joint].wear);
        let share = |point: &&SegmentsMeasured| {
            let whole = self.gain(point, joint);
            let part = if whole > 0.0 { self.part(point, segment, joint) / whole } else { 0.0 };
            (point.wear[joint], part)
        };
        let mut shares: Vec<(f64, f64)> = self.points.iter().map(share).collect();
        shares.sort_by(|a, b| a.0.total_cmp(&b.0));
        mean_until(&shares, end)
    }

    /// The life in a segment only: by a table of what it has worn at the wears of the mission's mean path.
    fn alone(&self, segment: usize) -> Option<AloneResult> {
        if self.duty.setups.len() == 1 {
            return Some(AloneResult { joint: self.result.end.joint, cycles: self.result.end.cycles });
        }
        let points = self.points.iter().map(|point| (point.wear.clone(), point.segments[segment].clone()));
        let points: Vec<(Vec<f64>, Vec<ContactMeasure>)> = points.collect();
        let mut settings = self.settings.clone();
        (settings.step, settings.keep_cycles) = (WearStep::TABLE, false);
        let mut table = WearTable::of_points(&settings, points).ok()?;
        let mut state = LifeState::new(&settings, 0).ok()?;
        let outcome = run_life(&settings, &mut table, &MeanIncrement, &mut state, Watch::NONE).ok()?;
        let LifeOutcome::Failed(end) = outcome else { return None };
        let worn = self.points.iter().map(|point| point.wear[end.joint]).fold(0.0, f64::max);
        let is_covered = worn >= COVERED * settings.joints[end.joint].threshold;
        // Without feedback nothing changes along a life.
        let is_constant = self.points.len() == 1;
        (is_covered || is_constant).then_some(AloneResult { joint: end.joint, cycles: end.cycles })
    }
}

/// Mean over x from 0 to an end of what is linear between points and constant beyond them.
fn mean_until(points: &[(f64, f64)], end: f64) -> f64 {
    let Some((_, first)) = points.first() else { return 0.0 };
    let Some((_, last)) = points.last() else { return 0.0 };
    if points.len() == 1 || end <= 0.0 {
        return *first;
    }
    let (mut sum, mut from) = (0.0, (0.0, *first));
    for to in points.iter().filter(|point| point.0 > 0.0) {
        let width = to.0.min(end) - from.0;
        if width > 0.0 {
            let there = from.1 + (to.1 - from.1) * width / (to.0 - from.0);
            sum += 0.5 * width * (from.1 + there);
        }
        from = *to;
        if to.0 >= end {
            return sum / end;
        }
    }
    (sum + (end - from.0) * last) / end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_ends_where_it_is_told_to() {
        let line = [(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)];
        for (end, mean) in [(1.0, 0.5), (2.0, 1.0), (3.0, 1.5)] {
            assert!((mean_until(&line, end) - mean).abs() < 1e-15, "until {end}");
        }
        // Beyond the last point: 4.5 of the line and 3 of the constant, over 4.
        assert!((mean_until(&line, 4.0) - 7.5 / 4.0).abs() < 1e-15);
        assert_eq!(mean_until(&[(0.0, 0.7)], 5.0), 0.7);
    }
}
