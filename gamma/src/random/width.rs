//! How many streams are drawn from side by side. Never knows what is drawn.

/// Streams side by side: vectors of any processor are a half, a quarter or an eighth of it.
pub(crate) const LANES: usize = 8;

/// A number in each lane.
pub(super) type Numbers = [f64; LANES];
