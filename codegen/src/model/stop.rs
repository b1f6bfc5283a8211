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

/// A limit that is passed: its key in the file and where it is [rad] or [m].
pub type Passed = (&'static str, f64);

impl Stop {
    /// Which of these values of its limits a coordinate has passed by more than `slack` [rad] or [m].
    pub fn passed(&self, position: f64, limits: [Option<f64>; 2], slack: f64) -> Option<Passed> {
        match limits {
            [Some(lower), _] if position < lower - slack => Some(("lower", lower)),
            [_, Some(upper)] if position > upper + slack => Some(("upper", upper)),
            _ => None,
        }
    }

    /// That its joint starts beyond a limit.
    pub fn starts_beyond(&self, joint: &str, position: f64, (key, limit): Passed) -> String {
        let (unit, name) = (if self.angular { "rad" } else { "m" }, &self.name);
        format!(
            "joint `{joint}` starts at {position} {unit}, beyond the `{key}` stop `{name}` at {limit} {unit}"
        )
    }

    /// The cure.
    pub const START_BETWEEN: &str =
        "start between the stops; a part that is pressed against one starts at the limit itself";
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
