//! What is read of a unit, and what became of the part. Never knows increments.

/// One reading of one unit (specimen).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Name of the unit.
    pub unit: String,
    /// Exposure, or Lambda itself, in the data's own unit.
    pub exposure: f64,
    /// Wear, in the data's own unit; or its bound.
    pub wear: f64,
    /// Covariates such as load, in the data's own units; of the interval that ends at this reading.
    pub covariates: Vec<f64>,
    /// Row of the source, as its errors shall name it.
    pub row: usize,
    /// Whether wear was read, or a bound of it.
    pub seen: Seen,
    /// What was done to the part after this reading, if anything.
    pub reset: Option<Reset>,
    /// The unit is among the data only because its wear at its first reading was below this, if so.
    pub entered_below: Option<f64>,
}

/// What a reading says of wear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seen {
    /// Its value.
    #[default]
    Exact,
    /// The bound was reached by then: failed, or beyond the gauge's range.
    AtLeast,
    /// It was below the bound: the gauge shows nothing yet.
    Below,
}

/// What is done to a part after a reading. Levels are of wear; None: not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reset {
    /// Another part takes its place: age and wear begin anew, wear at this level.
    Replaced(Option<f64>),
    /// The same part is worked on, such as reground: wear is set to this level, age goes on.
    Reground(Option<f64>),
}
