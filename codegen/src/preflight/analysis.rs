//! What is known of a mechanism's freedoms. Never knows how it was found.

/// A constraint row that says nothing new.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundant {
    /// The cut joint it belongs to.
    pub joint: String,
    /// What it would forbid.
    pub row: String,
    /// Why it is not needed.
    pub reason: String,
}

/// Freedoms, redundancies, and what cannot be known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Analysis {
    /// Coordinates before drivers take freedoms away (4 for a quaternion).
    pub coordinates: usize,
    /// Speeds before drivers take freedoms away, those of modes included.
    pub speeds: usize,
    /// Modal coordinates of flexible bodies.
    pub modes: usize,
    /// Constraint rows before redundant ones are dropped.
    pub constraint_rows: usize,
    /// Rows that are independent in general positions.
    pub independent_rows: usize,
    /// Combinations of rows that no motion changes, whatever lengths are: what holds a plane linkage in its plane.
    pub unmoved_rows: usize,
    /// Speeds less independent rows, with flexible bodies taken as rigid: the true number of freedoms.
    pub mobility: usize,
    /// The Grübler-Kutzbach count, which knows no special geometry.
    pub grubler: i64,
    /// Driven joints.
    pub drivers: Vec<String>,
    /// Freedoms that move nothing but the body named.
    pub idle: Vec<String>,
    /// Rows dropped.
    pub redundant: Vec<Redundant>,
    /// Wrench components (`R1.Fx`) that redundant constraints leave undetermined.
    pub non_unique: Vec<String>,
    /// Cut joints, where loops are closed.
    pub cuts: Vec<String>,
}
