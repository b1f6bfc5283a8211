//! Coordinates and speeds of a mechanism at an instant.

/// Coordinates and speeds of the free motions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Free coordinates.
    pub q: Vec<f64>,
    /// Free speeds.
    pub v: Vec<f64>,
}
