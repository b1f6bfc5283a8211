//! Why a mechanism cannot be modelled, as data.

use thiserror::Error;

/// Why a mechanism cannot be modelled.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum OracleError {
    /// A mass is not positive, or not a number.
    #[error("body {body}: mass {mass} kg or its inertia is not a positive number")]
    NotPositive {
        /// Name of the body.
        body: String,
        /// Its mass [kg].
        mass: f64,
    },
    /// A formula that must be constant depends on time or state.
    #[error("a formula of {element} must not depend on time or state")]
    NotConstant {
        /// Name of the element.
        element: String,
    },
    /// A force that asks for accelerations, joint forces or angular velocities of bodies, or a state of the file's own.
    #[error("{element} depends on what this model does not solve for")]
    Responses {
        /// Name of the element.
        element: String,
    },
    /// A drive, spring, damper or actuator on a coordinate that the joint does not have.
    #[error("joint {joint} has no scalar coordinate {coordinate}")]
    NoCoordinate {
        /// Name of the joint.
        joint: String,
        /// The coordinate asked for.
        coordinate: usize,
    },
}
