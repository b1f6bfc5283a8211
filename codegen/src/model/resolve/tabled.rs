//! A table as formulas call it.

use std::sync::Arc;

use crate::model::DataTable;
use crate::spec::{Dimension, Turning};

/// What a column is of: its dimension, and whether it counts turns or radians.
#[derive(Clone, Copy)]
pub(super) struct Counted {
    pub(super) dimension: Dimension,
    pub(super) turning: Turning,
}

/// A table, and what its argument and value are of.
pub(super) struct Tabled {
    pub(super) table: Arc<DataTable>,
    pub(super) argument: Counted,
    pub(super) value: Counted,
}
