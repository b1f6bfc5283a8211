//! The life of a mechanism whose joints wear: one mean path, random lives by their Gamma processes, statistics with
//! errors. In: a [`Mechanism`](crate::mechanism::Mechanism). Out: [`LifeResult`]. Never touches terminals, and no file but its
//! [`LifeJournal`].
//!
//! [`LifeStudy::new`] has the defaults of `linkwear life`; change its fields to ask for something else, then
//! [`LifeStudy::run`].

mod binning;
mod bins;
mod cost;
mod counted;
mod draw;
mod duty_result;
mod error;
mod facts;
mod fit;
mod journal;
mod machine_code;
mod mission;
mod mission_choice;
mod mission_result;
mod pace;
mod part;
mod paths;
mod process;
mod result;
mod run;
mod side_by_side;
mod source;
mod steady;
mod study;

pub use crate::parts::MergeError;
pub use crate::shard::{Shard, ShardError};
pub use cost::Cost;
pub use counted::{CountedEnds, LISTED_LIVES};
pub use error::{Cause, LifeError};
pub use facts::LifeFacts;
pub use fit::{JointFit, UnfitForLife};
pub use journal::LifeJournal;
#[cfg(feature = "page")]
pub(crate) use journal::NAME as JOURNAL;
pub use mission_choice::MissionChoice;
pub use mission_result::{AloneResult, MissionResult, SegmentResult};
pub use pace::Pace;
#[cfg(feature = "page")]
pub(crate) use part::NAME as SHARD;
pub use part::{LifePart, merge};
pub use paths::{LifePaths, Spread};
pub use process::JointProcess;
pub use result::{HOUR, LifeNumbers, LifeResult, WornPair, YEAR};
pub use steady::TurnErrors;
pub use study::{Coupling, LifeStudy, Trajectories};
