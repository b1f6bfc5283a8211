//! Parameter studies: a mechanism at many points, what runs and lives come to at each. In: [`Points`], quantities by name.
//! Out: [`StudyResult`]. Never touches terminals, and no file but the [`StudyJournal`] and the parts of its shards.
//!
//! A row depends on its point alone: neither threads nor shards, nor the order in which points are run, change a bit of it.

mod axis;
mod cases;
mod error;
mod journal;
mod part;
mod points;
mod quantity;
mod result;
mod run;
mod set_anyway;

pub use axis::{Axis, AxisError, written};
pub use cases::Cases;
pub(crate) use cases::Last;
pub use error::StudyError;
pub use journal::StudyJournal;
pub use part::{StudyPart, merge};
pub use points::{Points, PointsError};
pub use quantity::{Needs, Quantity, STATISTICS, listed, named, quantities, turn_key};
pub use result::{Kind, PointError, Row, StudyColumn, StudyFacts, StudyResult};
pub(crate) use run::Fault;
pub use run::{LIFE_FAILED, RUN_FAILED, Study};
