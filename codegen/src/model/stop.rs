//! End stops: on which coordinate, where, and with what law they push.

use super::Formula;
use crate::id::JointId;
use crate::source::Span;

/// End stops of one joint coordinate. Formulas are over parameters.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Name in the file.
    pub name: String,
    /// Joint.
    pub joint: JointId,
    /// Which coordinate of the joint.
    pub coordinate: usize,
    /// Whether that is an angle; else it is a length.
    pub angular: bool,
    /// Where the coordinate is stopped from below and from above [rad] or [m]; at least one of both.
    pub limits: [Option<Formula>; 2],
    /// Force over depth [N m/rad] or [N/m], above zero.
    pub stiffness: Formula,
    /// Exponent of the depth, from 1, and the depth [rad] or [m] at which force over depth is the stiffness.
    pub power: Option<(f64, f64)>,
    /// What it takes of an impact.
    pub loss: StopLoss,
    /// Where it is written.
    pub span: Span,
}

/// What a stop takes of the energy of an impact. Speeds are in [rad/s] or [m/s].
#[derive(Clone, Debug)]
pub enum StopLoss {
    /// Nothing.
    None,
    /// A viscous force beside the spring.
    Damping(Formula),
    /// On the way out the force is this part of that on the way in; speeds below the floor are between.
    Hysteresis {
        /// e².
        returned: f64,
        /// The floor.
        floor: Formula,
    },
    /// The force is `1 + factor speed / impact_speed` times that of the spring.
    BySpeed {
        /// chi of the law.
        factor: f64,
        /// Impact speed that the factor is made for.
        impact_speed: Formula,
    },
}
