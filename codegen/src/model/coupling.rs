//! Couplings: linear relations between joint coordinates, and where their forces act.

use super::{Carrier, Formula};
use crate::id::{BodyId, JointId, PointId};
use crate::source::Span;

/// A linear relation between joint coordinates: `a_1 q_1 + a_2 q_2 + ... = offset`.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// Name in the file.
    pub name: String,
    /// Key of its kind in a file.
    pub kind: &'static str,
    /// The coordinates with their factors.
    pub terms: Vec<CoupledCoordinate>,
    /// What the sum is [rad] or [m].
    pub offset: Formula,
    /// Whether the sum is an angle; else it is a length.
    pub angular: bool,
    /// How it gives way; nothing if it is rigid.
    pub compliance: Option<Compliance>,
    /// What bodies feel of its multiplier; empty if the joints of its terms feel it along their coordinates.
    pub meshes: Vec<MeshSide>,
    /// Output columns.
    pub columns: Vec<ForceColumn>,
    /// The pitch point, if the file names it.
    pub at: Option<PointId>,
    /// Where it is written.
    pub span: Span,
}

/// A coupling that gives way: what misses its sum is the stretch of a spring with a damper, behind a backlash. Formulas
/// over parameters.
#[derive(Clone, Debug)]
pub struct Compliance {
    /// [N/m] or [N m/rad], above zero.
    pub stiffness: Formula,
    /// [N s/m] or [N m s/rad].
    pub damping: Formula,
    /// How far the sum goes between both flanks [m] or [rad].
    pub backlash: Formula,
}

/// A joint coordinate with its factor in a coupling.
#[derive(Clone, Debug)]
pub struct CoupledCoordinate {
    /// Joint.
    pub joint: JointId,
    /// Which coordinate of the joint.
    pub coordinate: usize,
    /// Its factor, over parameters: [1], [m/rad] or [rad/m].
    pub factor: Formula,
}

/// How something follows from a multiplier `lambda`: `constant + lambda signed + |lambda| pressed`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ByMultiplier<T> {
    /// Without a multiplier.
    pub constant: T,
    /// In proportion to it.
    pub signed: T,
    /// In proportion to its size: flanks push wheels apart whichever of them touch.
    pub pressed: T,
}

/// What one body feels of a coupling's multiplier: a wrench whose axes move with a carrier.
#[derive(Clone, Debug)]
pub struct MeshSide {
    /// The body.
    pub body: BodyId,
    /// Its joint at whose point the wrench is.
    pub joint: JointId,
    /// The body or ground with which its axes move.
    pub carrier: Carrier,
    /// Force [N], along axes of W at the reference pose.
    pub force: ByMultiplier<[f64; 3]>,
    /// Moment about the joint's point [N m], along axes of W at the reference pose.
    pub moment: ByMultiplier<[f64; 3]>,
    /// Prismatic joints along which it slides over the carrier, each with the direction of its path, along axes of W at the reference pose.
    pub slides: Vec<(JointId, [f64; 3])>,
    /// Its pitch circle, if it has one.
    pub pitch_circle: Option<PitchCircle>,
}

/// A pitch circle at the reference pose, across the axis of its wheel's joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PitchCircle {
    /// Its centre in W [m].
    pub centre: [f64; 3],
    /// Its radius [m].
    pub radius: f64,
}

/// An output column of a coupling.
#[derive(Clone, Debug)]
pub struct ForceColumn {
    /// Its name behind that of the coupling.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Its value.
    pub value: ByMultiplier<f64>,
}
