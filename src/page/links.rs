//! Force elements between two places. In: places. Out: corners of a line. Never knows forces.

use serde::Serialize;

/// A force element between two places.
#[derive(Debug, Serialize)]
pub struct Link {
    /// Whether it is a coil; else a straight line.
    pub coiled: bool,
    /// Which body, nothing for the ground; where on it.
    pub sides: [(Option<usize>, [f64; 3]); 2],
}

/// Turns of a spring that is drawn.
const COILS: usize = 6;
/// Parts of its length where it is straight, at each end.
const STRAIGHT: f64 = 0.15;

impl Link {
    /// Corners of its picture between two places of a drawing; a coil goes `wide` to both sides of its middle line.
    pub fn corners(&self, [from, to]: [[f64; 2]; 2], wide: f64) -> Vec<[f64; 2]> {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        if !self.coiled || length == 0.0 {
            return vec![from, to];
        }
        let across = [-along[1] / length * wide, along[0] / length * wide];
        let place = |part: f64, out: f64| [0, 1].map(|i| from[i] + part * along[i] + out * across[i]);
        let bends = 2 * COILS;
        #[allow(clippy::cast_precision_loss, reason = "small whole numbers")]
        let bend = |at: usize| {
            let part = STRAIGHT + (1.0 - 2.0 * STRAIGHT) * (at as f64 + 0.5) / bends as f64;
            place(part, if at.is_multiple_of(2) { 1.0 } else { -1.0 })
        };
        let mut corners = vec![from, place(STRAIGHT, 0.0)];
        corners.extend((0..bends).map(bend));
        corners.extend([place(1.0 - STRAIGHT, 0.0), to]);
        corners
    }
}
