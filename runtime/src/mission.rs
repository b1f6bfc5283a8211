//! Duty cycles as a mechanism describes them: segments with their own parameters and factors. In: the generator's tables.
//! Out: [`MissionInfo`]. Never knows what a segment wears.

use crate::tables::{MissionRow, SegmentRow};
use crate::text::Text;

/// A duty cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionInfo {
    /// Name in the file.
    pub name: Text,
    /// Whether amounts are durations in a given order; else they are shares of the operating time.
    pub ordered: bool,
    /// Its segments, in the order of the file.
    pub segments: Vec<SegmentInfo>,
    /// The same in half as many bins, where the segments are bins of a measured series; else empty.
    pub coarser: Vec<SegmentInfo>,
}

/// A part of a duty cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentInfo {
    /// Name in the file.
    pub name: Text,
    /// How much of it: the share of the operating time, or the duration [s].
    pub amount: f64,
    /// Parameters and inputs that differ from those of the mechanism: index and value in SI.
    pub values: Vec<(usize, f64)>,
    /// Factors on friction and on wear, for every joint with clearance.
    pub factors: Vec<(f64, f64)>,
}

impl MissionInfo {
    pub(crate) fn from_row(&(name, ordered, segments, coarser): &MissionRow) -> Self {
        let all = |rows: &[SegmentRow]| rows.iter().map(SegmentInfo::from_row).collect();
        Self { name: name.into(), ordered, segments: all(segments), coarser: all(coarser) }
    }
}

impl SegmentInfo {
    fn from_row(&(name, amount, values, factors): &SegmentRow) -> Self {
        Self { name: name.into(), amount, values: values.to_vec(), factors: factors.to_vec() }
    }

    /// The parameters in this segment, of those of the mechanism [SI]; what it does not have is left out.
    pub fn parameters(&self, whole: &[f64]) -> Vec<f64> {
        let mut own = whole.to_vec();
        for (index, value) in &self.values {
            if let Some(parameter) = own.get_mut(*index) {
                *parameter = *value;
            }
        }
        own
    }
}
