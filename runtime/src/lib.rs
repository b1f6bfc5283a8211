//! Runtime of linkwear: what generated solver code stands on.
//!
//! Generated code knows this crate; this crate knows nobody. The core (scalar, intrinsics, the
//! [`System`] contract) is `no_std` and does not allocate; descriptions, integrators and recorders
//! come with the default feature `std`.
#![cfg_attr(not(feature = "std"), no_std)]

mod dual;
mod float;
mod intrinsic;
mod scalar;
mod sincos;
mod system;

#[cfg(feature = "std")]
#[rustfmt::skip]
mod stub; // STUB
#[cfg(feature = "std")]
pub use stub::{Integrator, Run, RunError, Settings, Span, Statistics, record, simulate}; // STUB

#[cfg(feature = "std")]
mod description;

pub use dual::Dual;
pub use intrinsic::{angle_over_sine, log_coefficient};
pub use scalar::Scalar;
pub use sincos::sin_cos;
pub use system::{Entry, Sizes, System};

#[cfg(feature = "std")]
pub use description::{
    Channel, Description, DriverInfo, List, Motion, ParameterInfo, RowInfo, Text, VariableInfo,
};
