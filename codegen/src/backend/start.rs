//! What generated code can begin with where nothing can be assembled. Never knows how it was found.

/// A consistent start at t = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Coordinates and speeds.
    pub state: Vec<f64>,
    /// Natural size of the motion along every speed.
    pub sizes: Vec<f64>,
}
