//! The mechanism, resolved: ids instead of names, SI instead of units, formulas instead of text.
//! In: [`crate::spec`]. Out: [`Mechanism`] and its [`Topology`]. Never knows expression graphs or Rust syntax.
//!
//! Everything is stated in one reference pose, in the ground frame W (docs/notation.md). A point may
//! have one position per body, where branches of a loop are described open.

use crate::diagnostic::Code;
use crate::id::{BodyId, JointId, ParameterId, PointId};
use crate::source::{Sources, Span};
use crate::spec::{Dimension, Turning};

mod body;
mod clearance;
mod coordinate;
mod coupling;
mod dry_friction;
mod force;
mod formula;
mod free_sections;
mod joint_kind;
mod joint_model;
mod local_loops;
mod mission;
mod piecewise;
mod resolve;
mod response;
mod sampler;
mod sensor;
mod state;
mod stop;
mod table;
pub mod topology;
pub use crate::spec::{Closure, Ends};
pub use body::{Amount, Body, Flexible, Inertia, LeftOut, Station};
pub use clearance::{Clearance, ClearancePlaces, ContactPlace, WearFactor};
pub use coordinate::Coordinate;
pub use coupling::{
    ByMultiplier, Compliance, CoupledCoordinate, Coupling, ForceColumn, MeshSide, PitchCircle,
};
pub use dry_friction::DryFriction;
pub use force::Force;
pub use formula::{Formula, Function, Term};
pub use free_sections::with_free_sections;
pub use joint_kind::{AxisKeys, Direction, JOINT_KINDS, JointKind, Look, PlaceKey, Primitive};
pub use joint_model::{Axis, JointModel};
pub use mission::{Mission, Segment};
pub use piecewise::{Piecewise, Value};
pub use resolve::{OverrideError, Overrides, resolve};
pub use response::Response;
pub use sampler::Sampler;
pub use sensor::Sensor;
pub use state::StateVariable;
pub use stop::{Stop, StopLoss};
pub use table::DataTable;

/// A body or the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Carrier {
    /// The fixed frame W.
    Ground,
    /// A moving body.
    Body(BodyId),
}

/// A mechanism with all names resolved and all dimensions checked.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Name in the file.
    pub name: String,
    /// Parameters in file order, then inputs in file order.
    pub parameters: Vec<Parameter>,
    /// Gravity [m/s²] in W; formulas over parameters.
    pub gravity: [Formula; 3],
    /// Moving bodies in file order.
    pub bodies: Vec<Body>,
    /// Named points in file order.
    pub points: Vec<Point>,
    /// Joints in file order.
    pub joints: Vec<Joint>,
    /// Couplings in file order.
    pub couplings: Vec<Coupling>,
    /// End stops in file order.
    pub stops: Vec<Stop>,
    /// Force elements in file order.
    pub forces: Vec<Force>,
    /// State variables of the file's own, in file order, then those of its controllers.
    pub states: Vec<StateVariable>,
    /// Controllers that act at sampled times, in the order in which they do where several act at once.
    pub samplers: Vec<Sampler>,
    /// Named values of a run, in file order, then what continuous controllers put out.
    pub sensors: Vec<Sensor>,
    /// Duty cycles in file order.
    pub missions: Vec<Mission>,
    /// How loops are closed.
    pub closure: Closure,
    /// Warnings that the file does not want.
    pub allowed: Vec<Code>,
    /// Start values by joint coordinate.
    pub starts: Vec<Start>,
    /// Files that were read besides the mechanism's own: parts, modal data.
    pub attached: Vec<std::path::PathBuf>,
    /// The texts that all places are in.
    pub sources: Sources,
}

/// A named quantity.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Name in the file.
    pub name: String,
    /// Value in SI.
    pub value: f64,
    /// Dimension, hence SI unit.
    pub dimension: Dimension,
    /// Whether it counts turns or radians, as far as its unit or formula tells.
    pub turning: Turning,
    /// Number and unit as the user wrote them; nothing for a formula.
    pub written: Option<(f64, String)>,
    /// Stays a run-time field of the generated struct.
    pub tunable: bool,
    /// A signal from outside, which may change with time; the value is its default.
    pub input: bool,
    /// Not from the cited source but ours.
    pub assumed: bool,
    /// Where it is written.
    pub span: Span,
}

/// A named point: one position for everybody, or one per body where the branches are described open.
#[derive(Clone, Debug)]
pub struct Point {
    /// Name in the file.
    pub name: String,
    /// Position in W at the reference pose [m], formulas over parameters.
    pub position: Position,
    /// The body (or ground) whose material point it is in the output.
    pub carrier: Carrier,
    /// Not from the cited source but ours.
    pub assumed: bool,
    /// Where it is written.
    pub span: Span,
}

/// Where a point is at the reference pose.
#[derive(Clone, Debug)]
pub enum Position {
    /// The same for every body.
    Shared([Formula; 3]),
    /// A position for each body that uses it: the loop is open here.
    PerBody(Vec<(Carrier, [Formula; 3])>),
}

impl Point {
    /// Position in W at the reference pose of `carrier`'s branch.
    pub fn position_for(&self, carrier: Carrier) -> &[Formula; 3] {
        match &self.position {
            Position::Shared(position) => position,
            Position::PerBody(positions) => positions
                .iter()
                .find(|(body, _)| *body == carrier)
                .map_or(&positions[0].1, |(_, position)| position),
        }
    }
}

/// A joint between two bodies; the parent is the first in the file.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the file.
    pub name: String,
    /// Kind and axes: the relative motion that it leaves.
    pub model: JointModel,
    /// First body.
    pub parent: Carrier,
    /// Second body.
    pub child: Carrier,
    /// Where the joint is.
    pub at: PointId,
    /// What it demands of the place of that point, if its kind does.
    pub surface: Option<Box<Surface>>,
    /// The user wants the loop cut here.
    pub cut: bool,
    /// Motion law of one coordinate, over parameters, inputs and t.
    pub drives: Vec<Drive>,
    /// Viscous damping, springs and actuator forces, by coordinate.
    pub passive: Vec<Passive>,
    /// Clearance, contact and wear; nothing for an ideal joint.
    pub clearance: Option<Box<Clearance>>,
    /// Where it is written.
    pub span: Span,
}

/// Where a joint's point may be, seen from a point of the parent.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The point of the parent.
    pub origin: PointId,
    /// Zero where the point may be [m]: over parameters and the place along axes that turn with the parent and are parallel to
    /// those of W at the reference pose.
    pub equation: Formula,
}

/// A prescribed coordinate of a joint.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Which coordinate of the joint, from 0.
    pub coordinate: usize,
    /// Position over parameters, inputs and t [rad or m].
    pub law: Formula,
}

/// A force in a joint, on the child, with its opposite on the parent.
#[derive(Clone, Debug)]
pub enum Passive {
    /// `-coefficient * speed` of one coordinate; for a spherical joint (coordinate 0) of the
    /// relative angular velocity.
    Damping {
        /// Which coordinate.
        coordinate: usize,
        /// [N m s/rad] or [N s/m].
        coefficient: Formula,
    },
    /// `-stiffness * (q - rest) - preload`.
    Spring {
        /// Which coordinate.
        coordinate: usize,
        /// [N m/rad] or [N/m].
        stiffness: Formula,
        /// Unloaded position [rad] or [m].
        rest: Formula,
        /// Against the coordinate [N m] or [N].
        preload: Formula,
    },
    /// A force by expression over coordinates, speeds and t.
    Actuator {
        /// Which coordinate.
        coordinate: usize,
        /// [N m] or [N], positive along the coordinate.
        force: Formula,
    },
    /// Dry friction under the joint's own force, against the only coordinate.
    DryFriction(Box<DryFriction>),
}

/// A start value of one joint coordinate (or of a spherical joint's rotation vector, indices 0..3).
#[derive(Clone, Debug)]
pub struct Start {
    /// Joint.
    pub joint: JointId,
    /// Which coordinate of the joint.
    pub coordinate: usize,
    /// Position [rad or m] over parameters.
    pub position: Option<Formula>,
    /// Speed [rad/s or m/s] over parameters.
    pub speed: Option<Formula>,
    /// Demanded exactly (`[initial]`), or only a guess for Newton (`[assembly]`).
    pub held: bool,
    /// Where it is written.
    pub span: Span,
}

/// The spanning tree and the joints where loops are cut.
#[derive(Clone, Debug)]
pub struct Topology {
    /// Tree joints, parents before children.
    pub tree: Vec<TreeJoint>,
    /// Joints that close loops, in file order.
    pub cuts: Vec<JointId>,
    /// Whether rows of plane loops are along the axes of W, else along those of the links: what is shorter.
    pub rows_in_ground: bool,
    /// Whether rows of cut joints at a body that turns freely are along the axes of the other body, else along its own: what is
    /// shorter.
    pub rows_off_balls: bool,
}

/// One step outwards in the spanning tree.
#[derive(Clone, Copy, Debug)]
pub struct TreeJoint {
    /// The joint.
    pub joint: JointId,
    /// Nearer to ground.
    pub inboard: Carrier,
    /// Farther from ground.
    pub outboard: BodyId,
    /// True if the outboard body is the joint's parent.
    pub reversed: bool,
}

impl Joint {
    /// Its point on the parent and on the child: one, but where a surface is seen from another.
    pub fn points(&self) -> [PointId; 2] {
        [self.surface.as_ref().map_or(self.at, |surface| surface.origin), self.at]
    }
}

impl Mechanism {
    /// The body with this index.
    pub fn body(&self, id: BodyId) -> &Body {
        &self.bodies[id.index()]
    }
    /// The joint with this index.
    pub fn joint(&self, id: JointId) -> &Joint {
        &self.joints[id.index()]
    }
    /// The point with this index.
    pub fn point(&self, id: PointId) -> &Point {
        &self.points[id.index()]
    }
    /// The parameter with this index.
    pub fn parameter(&self, id: ParameterId) -> &Parameter {
        &self.parameters[id.index()]
    }
    /// Whether a drive follows this input, so that its rates are needed too.
    pub fn drives_follow(&self, input: ParameterId) -> bool {
        self.drives().any(|(_, drive)| drive.law.depends_on(&|id| id == input))
    }
    /// Values of all parameters and defaults of all inputs in file order [SI], as [`Formula::value`] wants them.
    pub fn parameter_values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }
    /// Every prescribed coordinate with its joint.
    pub fn drives(&self) -> impl Iterator<Item = (JointId, &Drive)> {
        let joints = self.joints.iter().enumerate();
        joints.flat_map(|(at, joint)| joint.drives.iter().map(move |drive| (JointId::new(at), drive)))
    }
    /// Couplings that are rows.
    pub fn rigid_couplings(&self) -> impl Iterator<Item = &Coupling> {
        self.couplings.iter().filter(|coupling| coupling.compliance.is_none())
    }
    /// Freedoms by the Grübler-Kutzbach count: 6 (bodies) minus what every joint and coupling takes away. Modes do not count.
    pub fn grubler(&self) -> i64 {
        let taken: usize = self.joints.iter().map(|joint| joint.model.rows()).sum();
        6 * self.bodies.len() as i64 - (taken + self.rigid_couplings().count()) as i64
    }
    /// Takes the modes of all flexible bodies away: same mass, no deformation.
    pub fn freeze(&mut self) {
        for flexible in self.bodies.iter_mut().filter_map(|body| body.flexible.as_mut()) {
            flexible.data = flexible.data.frozen();
            flexible.start.clear();
            flexible.left_out.clear();
            flexible.stations.clear();
        }
    }

    /// The linkage with ideal joints in place of those with clearance: no play, no forces, and start values only as
    /// guesses, because those that play lets be met all together an ideal joint need not.
    pub fn with_clearances_closed(&self) -> Self {
        let mut closed = self.clone();
        closed.forces.clear();
        closed.stops.clear();
        for joint in &mut closed.joints {
            (joint.model.clearance, joint.model.tilt) = (false, None);
            joint.clearance = None;
            joint.passive.clear();
        }
        closed.starts.retain_mut(|start| {
            start.held = false;
            start.coordinate < closed.joints[start.joint.index()].model.start_values().len()
        });
        closed
    }

    /// Name of a body, or `ground`.
    pub fn carrier_name(&self, carrier: Carrier) -> &str {
        match carrier {
            Carrier::Ground => "ground",
            Carrier::Body(id) => &self.body(id).name,
        }
    }
}
