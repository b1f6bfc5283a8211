//! Force elements between bodies: what acts where.

use super::{Carrier, Formula};
use crate::id::PointId;
use crate::source::Span;

/// A force element between bodies.
#[derive(Clone, Debug)]
pub struct Force {
    /// Name in the file.
    pub name: String,
    /// What acts.
    pub kind: ForceKind,
    /// Where it is written.
    pub span: Span,
}

/// The kinds of force elements.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one per element: plain to read is worth more than small")]
pub enum ForceKind {
    /// Spring and damper between two points.
    Spring(Spring),
    /// Elastic mount between two bodies.
    Bushing(Bushing),
    /// A force by formula.
    Force(AppliedForce),
    /// A torque by formula.
    Torque(AppliedTorque),
}

/// Linear spring and damper between two points: pull `k (l - rest) + c l̇` along the line, plus `preload`.
#[derive(Clone, Debug)]
pub struct Spring {
    /// The two bodies.
    pub bodies: [Carrier; 2],
    /// Attachment point on each.
    pub at: [PointId; 2],
    /// [N/m].
    pub stiffness: Formula,
    /// Unloaded length [m].
    pub rest: Formula,
    /// [N s/m].
    pub damping: Formula,
    /// Constant pull [N].
    pub preload: Formula,
}

/// Springs and dampers along and about three axes between two bodies, at rest in the reference pose.
#[derive(Clone, Debug)]
pub struct Bushing {
    /// The two bodies.
    pub bodies: [Carrier; 2],
    /// The point, as each body's branch describes it.
    pub at: PointId,
    /// x, y and z axis: unit vectors in W at the reference pose.
    pub axes: [[f64; 3]; 3],
    /// Along each axis of the first body [N/m].
    pub stiffness: [Formula; 3],
    /// Along each axis of the first body [N s/m].
    pub damping: [Formula; 3],
    /// Per component of the rotation vector [N m/rad].
    pub turning_stiffness: [Formula; 3],
    /// About each axis of the second body [N m s/rad].
    pub turning_damping: [Formula; 3],
}

/// A force on a body at a point, with its opposite on `reaction`.
#[derive(Clone, Debug)]
pub struct AppliedForce {
    /// Body that is pushed.
    pub body: Carrier,
    /// Body that takes the reaction at the same place; ground takes it silently.
    pub reaction: Carrier,
    /// Where it acts.
    pub at: PointId,
    /// Components [N] over coordinates, speeds and t.
    pub components: [Formula; 3],
    /// Axes in which the components are meant: W, or W-parallel at the reference pose and moving with
    /// this body.
    pub axes: Carrier,
}

/// A torque on a body, with its opposite on `reaction`.
#[derive(Clone, Debug)]
pub struct AppliedTorque {
    /// Body that is turned.
    pub body: Carrier,
    /// Body that takes the reaction.
    pub reaction: Carrier,
    /// Components [N m] over coordinates, speeds and t.
    pub components: [Formula; 3],
    /// As for [`AppliedForce`].
    pub axes: Carrier,
}

impl ForceKind {
    /// Points at which bodies are pushed, and whether they are turned there too.
    pub fn attachments(&self) -> Vec<(Carrier, PointId, bool)> {
        match self {
            Self::Spring(Spring { bodies: [a, b], at, .. }) => vec![(*a, at[0], false), (*b, at[1], false)],
            Self::Bushing(Bushing { bodies: [a, b], at, .. }) => vec![(*a, *at, true), (*b, *at, true)],
            Self::Force(AppliedForce { body, reaction, at, .. }) => {
                vec![(*body, *at, false), (*reaction, *at, false)]
            }
            Self::Torque(_) => Vec::new(),
        }
    }

    /// Formulas over the state; those of springs and bushings are over parameters.
    pub fn laws(&self) -> &[Formula] {
        match self {
            Self::Spring(_) | Self::Bushing(_) => &[],
            Self::Force(AppliedForce { components, .. }) | Self::Torque(AppliedTorque { components, .. }) => {
                components
            }
        }
    }
}
