//! A small generator (xorshift), so that states repeat. It needs nothing, so that tests of other crates take it by its path.

/// Its state, which is never 0.
pub struct Random(pub u64);

impl Random {
    /// A number between -1 and 1.
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
