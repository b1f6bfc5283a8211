//! The coarse scale of a life, [CS section 4.3]: wear of whole cycles, clearance fed back, until a joint has failed.
//! In: a [`WearSource`] that says what a revolution wears, [`LifeSettings`], an [`IncrementModel`]. Out: cycles, a
//! [`FailureEvent`], a [`LifeState`] to go on from. Never knows equations, integrators, random numbers, files or terminals.
//!
//! A cycle stands for many revolutions. In its mean path every joint gains `revolutions_per_cycle` times what one
//! revolution wears, and wear changes the clearance (or the worn profile) on the way. At the end of a cycle the draw
//! turns the mean increment dLambda into the wear increment dW; the deterministic life takes dW = dLambda.
//!
//! `full` coupling measures with the dynamics themselves, `table` coupling with a [`WearTable`] made from them once. Both
//! are fine scales to the same loop, [`run_life`].

mod ahead;
mod along_curves;
mod asked;
mod calibrate;
mod control;
mod crossing;
mod curve;
mod cycle;
mod error;
mod flow;
mod increment;
mod interpolate;
mod joint;
mod mission;
mod path;
mod settings;
mod settings_error;
mod source;
mod state;
mod table;
mod worn;

pub use calibrate::{Calibration, CalibrationError, calibrate};
pub use control::Control;
pub use cycle::{LifeOutcome, run_life};
pub use error::LifeError;
pub use flow::{ERROR as FLOW_ERROR, WearFlow};
pub use increment::{IncrementModel, LANES, Lanes, MeanIncrement};
pub use joint::{Feedback, JointLife, WearOf};
pub use mission::{MissionError, MissionSegment, MissionSource, SegmentsMeasured};
pub use settings::{LifeSettings, WearStep};
pub use settings_error::SettingsError;
pub use source::{JointWear, WearSource, one_by_one};
pub use state::{CycleJoint, CycleRecord, FailureEvent, JointWarning, LifeState};
pub use table::{DEFAULT_POINTS, TableReport, WearTable};
pub use worn::WearState;
