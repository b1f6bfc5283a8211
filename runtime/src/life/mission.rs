//! A duty cycle as one fine scale: what a revolution wears on average over segments that run differently, each by a fine scale of
//! its own. In: sources of wear, how much of the revolutions and of the time each has. Out: their mean. Never knows how a
//! segment is computed.
//!
//! Every segment is measured at the wear of the day, and goes on from its own last measurement. Wear adds by the revolution, so
//! that it counts by shares of revolutions; forces and contact are averages over time and count by shares of time.

use thiserror::Error;

use super::source::{JointWear, WearSource, one_by_one};
use crate::wear::ContactMeasure;

/// A segment's fine scale, and how much of the mission it is.
#[derive(Clone, Debug)]
pub struct MissionSegment<F> {
    /// Its name.
    pub name: String,
    /// What its revolutions wear.
    pub source: F,
    /// Share of all revolutions.
    pub revolutions: f64,
    /// Share of all time.
    pub time: f64,
    /// By how much the clearance of each joint differs from that of the first segment, unworn [m].
    pub clearances: Vec<f64>,
}

/// What the segments have worn at one state of wear.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentsMeasured {
    /// Wear W of the joints [m].
    pub wear: Vec<f64>,
    /// What a revolution of each segment wears at each joint.
    pub segments: Vec<Vec<ContactMeasure>>,
}

/// Segments as one fine scale.
#[derive(Clone, Debug)]
#[must_use]
pub struct MissionSource<F> {
    segments: Vec<MissionSegment<F>>,
    /// Part of a revolution in contact below which a segment is refused.
    least_touching: f64,
    measured: Vec<SegmentsMeasured>,
}

/// A segment that cannot be measured.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MissionError<E> {
    /// There is one segment.
    #[error(transparent)]
    Alone(E),
    /// There are several.
    #[error("segment `{segment}`: {error}")]
    Segment {
        /// Its name.
        segment: String,
        /// Why.
        error: E,
    },
    /// Journal and bearing are apart for most of a segment's revolution, which the mean over all would hide.
    #[error(
        "segment `{segment}`: a joint is without contact for {:.0} % of a revolution; sliding wear means nothing there",
        (1.0 - touching) * 100.0
    )]
    ContactLost {
        /// Its name.
        segment: String,
        /// Part of the revolution in contact.
        touching: f64,
    },
}

impl<F> MissionSource<F> {
    /// One source that is all of the time: the same bits as the source.
    pub fn alone(source: F) -> Self {
        let whole = MissionSegment {
            name: String::new(),
            source,
            revolutions: 1.0,
            time: 1.0,
            clearances: Vec::new(),
        };
        Self::new(vec![whole], 0.0)
    }

    /// Of segments whose shares come to 1. With several, each of them must be in contact for at least this part of a revolution.
    pub fn new(segments: Vec<MissionSegment<F>>, least_touching: f64) -> Self {
        Self { segments, least_touching, measured: Vec::new() }
    }

    /// The segments.
    pub fn segments(&self) -> &[MissionSegment<F>] {
        &self.segments
    }

    /// What the segments have worn at every measurement so far; nothing of a single one.
    pub fn measured(&self) -> &[SegmentsMeasured] {
        &self.measured
    }
}

impl<F: WearSource> WearSource for MissionSource<F> {
    type State = Vec<F::State>;
    type Error = MissionError<F::Error>;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, Self::Error> {
        state.resize_with(self.segments.len(), F::State::default);
        if let ([alone], [state]) = (&mut self.segments[..], &mut state[..]) {
            return alone.source.measure(joints, state).map_err(MissionError::Alone);
        }
        let mut all = Vec::with_capacity(self.segments.len());
        for (segment, state) in self.segments.iter_mut().zip(state) {
            let mut own = joints.to_vec();
            for (joint, shift) in own.iter_mut().zip(&segment.clearances).filter(|(_, shift)| **shift != 0.0)
            {
                joint.clearance += shift;
            }
            let name = || segment.name.clone();
            let measured = segment.source.measure(&own, state);
            let measured = measured.map_err(|error| MissionError::Segment { segment: name(), error })?;
            if let Some(lost) = measured.iter().find(|one| one.touching < self.least_touching) {
                return Err(MissionError::ContactLost { segment: name(), touching: lost.touching });
            }
            all.push(measured);
        }
        let mean = |joint: usize| {
            let each = self.segments.iter().zip(&all);
            let each =
                each.filter_map(|(one, measured)| Some((measured.get(joint)?, one.revolutions, one.time)));
            ContactMeasure::mean_by_shares(&each.collect::<Vec<_>>())
        };
        let mean = (0..joints.len()).map(mean).collect();
        let wear = joints.iter().map(|joint| joint.wear).collect();
        self.measured.push(SegmentsMeasured { wear, segments: all });
        Ok(mean)
    }

    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [Self::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, Self::Error> {
        let [alone] = &mut self.segments[..] else {
            return one_by_one(self, joints, states);
        };
        let mut own: Vec<F::State> = states.iter_mut().map(|state| state.pop().unwrap_or_default()).collect();
        let measured = alone.source.measure_each(joints, &mut own).map_err(MissionError::Alone);
        states.iter_mut().zip(own).for_each(|(state, own)| *state = vec![own]);
        measured
    }
}

#[cfg(test)]
mod tests {
    use core::convert::Infallible;

    use super::*;

    /// Wears so much in a revolution, at a clearance of a metre.
    #[derive(Clone, Debug)]
    struct Fixed(f64, f64);

    impl WearSource for Fixed {
        type State = u32;
        type Error = Infallible;

        fn measure(
            &mut self,
            joints: &[JointWear],
            state: &mut u32,
        ) -> Result<Vec<ContactMeasure>, Infallible> {
            *state += 1;
            let of = |joint: &JointWear| ContactMeasure {
                depth: self.0 * joint.clearance,
                mean_force: self.0,
                peak_force: self.0,
                touching: self.1,
                ..ContactMeasure::default()
            };
            Ok(joints.iter().map(of).collect())
        }
    }

    fn segment(depth: f64, revolutions: f64, time: f64) -> MissionSegment<Fixed> {
        let name = depth.to_string();
        MissionSegment { name, source: Fixed(depth, 1.0), revolutions, time, clearances: vec![0.0] }
    }

    const JOINT: JointWear = JointWear { clearance: 1.0, wear: 0.0, profile: None, journal: None };

    #[test]
    fn wear_counts_by_revolutions_and_forces_by_time() {
        let mut source = MissionSource::new(vec![segment(1.0, 0.25, 0.5), segment(3.0, 0.75, 0.5)], 0.5);
        let mut state = Vec::new();
        let mean = source.measure(&[JOINT], &mut state).expect("two segments");
        assert_eq!((mean[0].depth, mean[0].mean_force, mean[0].peak_force), (2.5, 2.0, 3.0));
        // Each goes on from its own measurement.
        assert_eq!(state, [1, 1]);
        assert_eq!(source.measured()[0].segments[1][0].depth, 3.0);
    }

    #[test]
    fn a_segment_may_have_a_clearance_of_its_own() {
        let warm = MissionSegment { clearances: vec![-0.5], ..segment(1.0, 0.5, 0.5) };
        let mut source = MissionSource::new(vec![segment(1.0, 0.5, 0.5), warm], 0.5);
        assert_eq!(source.measure(&[JOINT], &mut Vec::new()).expect("two segments")[0].depth, 0.75);
    }

    #[test]
    fn lost_contact_in_one_segment_is_not_averaged_away() {
        let lost = MissionSegment { source: Fixed(1.0, 0.2), ..segment(2.0, 0.1, 0.1) };
        let mut source = MissionSource::new(vec![segment(1.0, 0.9, 0.9), lost], 0.5);
        let error = source.measure(&[JOINT], &mut Vec::new()).expect_err("no contact");
        assert_eq!(error, MissionError::ContactLost { segment: "2".to_owned(), touching: 0.2 });
    }
}
