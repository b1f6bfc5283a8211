//! Named values of a run.

use super::Formula;
use crate::spec::Turning;

/// A formula with a name and a column.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Name in the file.
    pub name: String,
    /// Its value, over all that forces may depend on.
    pub value: Formula,
    /// Whether it counts turns or radians, as far as the formula tells.
    pub turning: Turning,
}
