//! Runtime of linkwear: what generated solver code stands on.
//!
//! Generated code knows this crate; this crate knows nobody. The core (scalar, intrinsics, the
//! [`System`] contract, tables, laws of contact, [`FixedStep`]) is `no_std` and does not allocate; descriptions, adaptive
//! integrators and recorders come with the default feature `std`.
//!
//! From a mechanism to numbers: [`simulate`] runs it, [`assemble`] only finds a consistent start,
//! [`Run::table`] and [`write_csv`] record a [`Run`]. Below them: [`Evaluator`] asks a [`System`], [`Dynamics`] gives
//! accelerations, [`Projector`] keeps loops closed, [`integrate`] holds the methods.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]
#![cfg_attr(not(feature = "std"), no_std)]

pub mod contact;
mod dual;
pub mod elementary;
mod fixed_step;
mod float;
mod include;
mod intrinsic;
mod joint_laws;
pub mod linear;
mod manifold;
mod named;
#[cfg(test)]
mod pair;
mod regularity;
mod row_scales;
mod runge_kutta;
mod scalar;
mod sincos;
mod system;
mod tables;
mod text;
mod tolerances;
pub mod wear;

#[cfg(feature = "std")]
mod assemble;
#[cfg(feature = "std")]
mod bundle;
#[cfg(feature = "std")]
pub mod clearance_joint;
#[cfg(feature = "std")]
mod column;
#[cfg(feature = "std")]
mod contact_frequency;
#[cfg(feature = "std")]
mod description;
#[cfg(feature = "std")]
mod dynamics;
#[cfg(feature = "std")]
mod dynamics_source;
#[cfg(feature = "std")]
mod error;
#[cfg(feature = "std")]
mod evaluate;
#[cfg(feature = "std")]
mod flat_laws;
#[cfg(feature = "std")]
mod guide;
#[cfg(feature = "std")]
pub mod integrate;
#[cfg(feature = "std")]
pub mod jump;
#[cfg(feature = "std")]
mod layout;
#[cfg(feature = "std")]
mod ledger;
#[cfg(feature = "std")]
pub mod life;
#[cfg(feature = "std")]
mod mission;
#[cfg(feature = "std")]
mod passage;
#[cfg(feature = "std")]
mod projection;
#[cfg(feature = "std")]
mod record;
#[cfg(feature = "std")]
mod signals;
#[cfg(feature = "std")]
mod simulate;
#[cfg(feature = "std")]
mod singular_dynamics;
#[cfg(feature = "std")]
mod watch;

pub use dual::Dual;
pub use fixed_step::{CORRECTIONS, FixedStep, Halt, StepContact};
pub use intrinsic::{angle_over_sine, log_coefficient};
pub use joint_laws::{JointLaws, Response};
pub use scalar::Scalar;
pub use sincos::sin_cos;
pub use system::{
    CONTACT_MOTION, CONTACT_WRENCH, ClassicalStep, Entry, STATES, SideBySide, Sizes, StageSum, StepOf,
    System, TOTALS, WORKS, WithLaws,
};
pub use tables::{
    AllTables, CoefficientRow, ContactInfo, GammaRates, InputRole, JournalWear, MissionRow, Motion,
    SegmentRow, Start, Tables, WearInfo,
};
pub use text::Text;

#[cfg(feature = "std")]
pub use {
    assemble::{
        State, assemble, assemble_static_contact, assemble_with, check_clearances, close_loops, motion_sizes,
        offset_columns, place, resting_contacts, rows_of_free_offsets,
    },
    bundle::{Bundle, Evaluate, StepPlan},
    clearance_joint::channels,
    column::Column,
    contact_frequency::contact_frequencies,
    description::{
        BendInfo, Channel, CoefficientFactor, Description, DriverInfo, List, MODE, NEXT, ParameterInfo, ROW,
        RowInfo, SAMPLE, SWITCH, TabledDescription, VALUE, VariableInfo,
    },
    dynamics::{Dynamics, SINGULAR_PIVOT},
    dynamics_source::{DynamicsSource, Orbit, RevolutionSettings, Steadiness},
    error::{AssemblyError, NoColumn, RunError, SetupError, what_and_cure},
    evaluate::{
        Accelerations, CLOSED, CLOSED_AT_START, Closure, Equations, Evaluator, Forward, LoopError, Rates,
    },
    layout::{Group, Layout},
    mission::{MissionInfo, SegmentInfo},
    projection::{Correction, NotClosed, POSITION_TOLERANCE, Projector, SPEED_TOLERANCE},
    record::{Cells, Table, TableColumn, write_csv},
    signals::{SampledSignals, Signals},
    simulate::{
        At, BRANCH_PART, ContactEvent, ENVELOPE_PIECES, Extremes, IdealJoint, Integrator, JUMP_FLOOR,
        KnownAngles, LaneTurns, Peak, Run, RunWarning, Settings, Simulation, SimulationState, Span,
        StateSpace, Statistics, TurnBundle, TurnMeasures, TurnOutcome, TurnQueue, TurnRequests, TurnRunner,
        TurnState, WholeSteps, WideBundle, simulate, simulate_with_inputs, turn_queue,
    },
    singular_dynamics::{LOST_RANK, NEARLY_LOST},
    watch::Watch,
};
