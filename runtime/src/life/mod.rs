//! The coarse scale of a life, [CS section 4.3]: wear of whole cycles, clearance fed back, until a joint has failed.
//! In: a [`FineScale`] that says what a revolution wears, [`LifeSettings`], an [`IncrementDraw`]. Out: cycles, a
//! [`Failure`], a [`LifeState`] to go on from. Never knows equations, integrators, random numbers, files or terminals.
//!
//! A cycle stands for many revolutions. In its mean path every joint gains `revolutions_per_cycle` times what one
//! revolution wears, and wear changes the clearance (or the worn profile) on the way. At the end of a cycle the draw
//! turns the mean increment dLambda into the wear increment dW; the deterministic life takes dW = dLambda.
//!
//! `full` coupling measures with the dynamics themselves, `table` coupling with a [`Table`] made from them once. Both
//! are fine scales to the same loop, [`run_life`].

mod calibrate;
mod cycle;
mod draw;
mod fine;
mod interpolate;
mod path;
mod settings;
mod state;
mod stop;
mod summary;
mod table;

pub use calibrate::{Calibration, CalibrationError, calibrate};
pub use cycle::{Outcome, run_life};
pub use draw::{IncrementDraw, Mean};
pub use fine::{FineScale, JointWear, RevolutionWear};
pub use settings::{Feedback, JointLife, LifeSettings, SettingsError, WearOf, WearStep};
pub use state::{Control, CycleJoint, CycleRecord, Failure, JointState, JointWarning, LifeState};
pub use stop::Stop;
pub use summary::{Quantiles, Summary};
pub use table::{DEFAULT_POINTS, Table, TableReport};
