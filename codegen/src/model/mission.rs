//! Duty cycles, resolved.

use crate::id::ParameterId;

/// A duty cycle.
#[derive(Clone, Debug)]
pub struct Mission {
    /// Name in the file.
    pub name: String,
    /// Whether amounts are durations in order; else they are shares of the operating time.
    pub ordered: bool,
    /// Its segments in the order of the file.
    pub segments: Vec<Segment>,
    /// Those of a measured series in half as many bins; else none.
    pub coarser: Vec<Segment>,
}

/// A part of a duty cycle.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Name in the file.
    pub name: String,
    /// Share of the operating time, or duration [s].
    pub amount: f64,
    /// Tunable parameters and inputs with their values in SI.
    pub values: Vec<(ParameterId, f64)>,
    /// Factors on friction and on wear.
    pub factors: (f64, f64),
    /// The same of single joints, in their place.
    pub of_joints: Vec<(String, (f64, f64))>,
}

impl Segment {
    /// Factors on friction and on wear of a joint.
    pub fn factors_of(&self, joint: &str) -> (f64, f64) {
        let own = self.of_joints.iter().find(|(name, _)| name == joint);
        own.map_or(self.factors, |(_, factors)| *factors)
    }
}
