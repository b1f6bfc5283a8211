//! Named values of a run.

use super::Formula;

/// A formula with a name and a column.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Name in the file.
    pub name: String,
    /// Its value, over all that forces may depend on.
    pub value: Formula,
}
