//! Controllers that act at sampled times.

use std::ops::Range;

/// What becomes of some states at each multiple of a time, all at once.
#[derive(Clone, Debug)]
pub struct Sampler {
    /// From sample to sample [s].
    pub sample_time: f64,
    /// Which of the mechanism's states.
    pub states: Range<usize>,
}
