//! A mission in the result of a life. Never knows how it was found.

use serde::{Deserialize, Serialize};

/// How a life was used.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MissionResult {
    /// Name of the mission.
    pub name: String,
    /// How long a mission lasts [s], if its segments have durations.
    pub seconds: Option<f64>,
    /// Its segments.
    pub segments: Vec<SegmentResult>,
    /// By how much of itself the mean path's life is another in half as many bins, where the mission is a measured series.
    pub binning: Option<f64>,
}

/// A segment's part in a life.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct SegmentResult {
    /// Its name.
    pub name: String,
    /// Share of the time.
    pub time: f64,
    /// Share of the revolutions.
    pub revolutions: f64,
    /// Parameters and inputs that it sets, in SI.
    pub set: Vec<(String, f64)>,
    /// Duration [s], if the mission has durations.
    pub duration: Option<f64>,
    /// How long a revolution lasts [s], if all last equally long.
    pub seconds_per_revolution: Option<f64>,
    /// Share of the wear of each joint on the mean path.
    pub wear: Vec<f64>,
    /// The mean path's life if the machine ran in this segment only; nothing where the mission's life does not tell it: with
    /// `profile = true`, and where another joint would fail first, further on than that life has gone.
    pub alone: Option<AloneResult>,
}

/// A life in one segment only.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct AloneResult {
    /// Index of the joint that fails first.
    pub joint: usize,
    /// Cycles.
    pub cycles: f64,
}
