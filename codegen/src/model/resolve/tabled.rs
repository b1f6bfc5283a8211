//! A table as formulas call it.

use std::sync::Arc;

use crate::model::DataTable;
use crate::spec::Dimension;

/// A table, and the dimensions of its argument and value.
pub(super) struct Tabled {
    pub(super) table: Arc<DataTable>,
    pub(super) argument: Dimension,
    pub(super) value: Dimension,
}
