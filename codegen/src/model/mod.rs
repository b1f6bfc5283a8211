//! The mechanism, resolved: ids instead of names, SI instead of units, formulas instead of text.
//! In: [`crate::spec`]. Out: [`Mechanism`] and its [`Topology`]. Never knows expression graphs or Rust syntax.
//!
//! Everything is stated in one reference pose, in the ground frame W (docs/notation.md). A point may
//! have one position per body, where branches of a loop are described open.

use linkwear_runtime::ContactInfo;

use crate::flexible::{ModalData, Node};
use crate::id::{BodyId, JointId, ParameterId, PointId};
use crate::source::Span;
use crate::spec::Dimension;

mod coordinate;
mod force;
mod formula;
mod joint_kind;
mod resolve;
pub mod topology;
pub use coordinate::Coordinate;
pub use force::Force;
pub use formula::{Formula, Function, Term};
pub use joint_kind::{Axis, AxisKeys, Direction, JOINT_KINDS, JointKind, JointModel, Primitive};
pub use resolve::{OverrideError, Overrides, resolve};

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
    /// Parameters in file order.
    pub parameters: Vec<Parameter>,
    /// Gravity [m/s²] in W; formulas over parameters.
    pub gravity: [Formula; 3],
    /// Moving bodies in file order.
    pub bodies: Vec<Body>,
    /// Named points in file order.
    pub points: Vec<Point>,
    /// Joints in file order.
    pub joints: Vec<Joint>,
    /// Force elements in file order.
    pub forces: Vec<Force>,
    /// How loops are closed.
    pub closure: Closure,
    /// Start values by joint coordinate.
    pub starts: Vec<Start>,
    /// Files that were read besides the mechanism's own: modal data.
    pub attached: Vec<std::path::PathBuf>,
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
    /// Stays a run-time field of the generated struct.
    pub tunable: bool,
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

/// A moving body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name in the file.
    pub name: String,
    /// Mass, centre and inertia of the undeformed body.
    pub inertia: Inertia,
    /// How it bends; nothing if it is rigid.
    pub flexible: Option<Box<Flexible>>,
    /// Where it is written.
    pub span: Span,
}

/// A flexible body in its floating frame, all in numbers.
#[derive(Clone, Debug)]
pub struct Flexible {
    /// Constants of inertia and elasticity, shapes at the nodes.
    pub data: ModalData,
    /// x, y and z axis of the floating frame: unit vectors in W at the reference pose.
    pub axes: [[f64; 3]; 3],
    /// Where the frame's origin lies.
    pub origin: PointId,
    /// Points of the mechanism at which something is attached or looked at, with their nodes in `data`.
    pub nodes: Vec<(PointId, usize)>,
    /// Nodes in `data` whose displacement or stress is a column.
    pub stations: Vec<Station>,
    /// Start value and start speed of every modal coordinate.
    pub start: Vec<[f64; 2]>,
    /// What was left out, for warnings.
    pub left_out: Vec<LeftOut>,
}

/// A place on a flexible body that is looked at.
#[derive(Clone, Debug)]
pub struct Station {
    /// Suffix of its columns: empty for the middle of the link, else a number.
    pub name: String,
    /// Node in the modal data.
    pub node: usize,
    /// Bending stress at the outer fibres in +y and +z per unit of each modal coordinate [Pa]; nothing if
    /// the section is not known.
    pub stress: Option<Vec<[f64; 2]>>,
}

/// A mode that is not kept.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// What moves: `y4`, `z4`, `axial`, `torsion`.
    pub name: String,
    /// [Hz].
    pub frequency: f64,
}

impl Flexible {
    /// The node at a point.
    ///
    /// # Panics
    /// If the point is not in `nodes`; the resolver lists every point that the body is used at.
    pub fn node_at(&self, point: PointId) -> &Node {
        let found = self.nodes.iter().find(|(known, _)| *known == point);
        let (_, node) = found.expect("the resolver gives every point of a flexible body a node");
        &self.data.nodes[*node]
    }
}

/// How a body's mass is described. Formulas over parameters, SI.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one per body: plain to read is worth more than small")]
pub enum Inertia {
    /// Solid cylinder between two points.
    Rod {
        /// End points.
        ends: [PointId; 2],
        /// Outer radius [m].
        radius: Formula,
        /// Inner radius [m]; zero for a solid rod.
        inner_radius: Formula,
        /// Density [kg/m³], or total mass [kg].
        amount: Amount,
    },
    /// Cuboid with its long edge from one point to another.
    Box {
        /// Centres of two opposite faces.
        ends: [PointId; 2],
        /// Edge along `width_axis` and the other edge [m].
        width: [Formula; 2],
        /// Direction of the first of `width` in W, at right angles to the long edge.
        width_axis: [f64; 3],
        /// Density [kg/m³], or total mass [kg].
        amount: Amount,
    },
    /// Numbers from elsewhere.
    Given {
        /// Mass [kg].
        mass: Formula,
        /// Centre of mass.
        centre: PointId,
        /// Inertia about the centre [kg m²]: xx, yy, zz, xy, xz, yz as matrix entries (xy = -∫xy dm).
        inertia: [Formula; 6],
        /// The x, y and z axis of `inertia`, each a unit vector in W at the reference pose.
        axes: [[f64; 3]; 3],
    },
}

/// How much matter there is.
#[derive(Clone, Debug)]
pub enum Amount {
    /// Density [kg/m³].
    Density(Formula),
    /// Total mass [kg].
    Mass(Formula),
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
    /// The user wants the loop cut here.
    pub cut: bool,
    /// Motion law of one coordinate, over parameters and t.
    pub drives: Vec<Drive>,
    /// Viscous damping, springs and actuator forces, by coordinate.
    pub passive: Vec<Passive>,
    /// Clearance, contact and wear; nothing for an ideal joint.
    pub clearance: Option<Box<Clearance>>,
    /// Where it is written.
    pub span: Span,
}

/// A joint with clearance.
#[derive(Clone, Debug)]
pub struct Clearance {
    /// Radial clearance [m], a formula over parameters.
    pub radial: Formula,
    /// Laws of contact, friction and wear with their constants.
    pub laws: ContactInfo,
}

/// A prescribed coordinate of a joint.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Which coordinate of the joint, from 0.
    pub coordinate: usize,
    /// Position over parameters and t [rad or m].
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
    /// `-stiffness * (q - rest)`.
    Spring {
        /// Which coordinate.
        coordinate: usize,
        /// [N m/rad] or [N/m].
        stiffness: Formula,
        /// Unloaded position [rad] or [m].
        rest: Formula,
    },
    /// A force by expression over coordinates, speeds and t.
    Actuator {
        /// Which coordinate.
        coordinate: usize,
        /// [N m] or [N], positive along the coordinate.
        force: Formula,
    },
}

/// How a loop is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Closure {
    /// Cut a joint, keep the rows it takes away.
    #[default]
    Joint,
    /// Six rows `Log(T_b^-1 T_a)` of a common end body, [CS (3)].
    Log,
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
    /// Values of all parameters in file order [SI], as [`Formula::value`] wants them.
    pub fn parameter_values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }
    /// Every prescribed coordinate with its joint.
    pub fn drives(&self) -> impl Iterator<Item = (JointId, &Drive)> {
        let joints = self.joints.iter().enumerate();
        joints.flat_map(|(at, joint)| joint.drives.iter().map(move |drive| (JointId::new(at), drive)))
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

    /// Name of a body, or `ground`.
    pub fn carrier_name(&self, carrier: Carrier) -> &str {
        match carrier {
            Carrier::Ground => "ground",
            Carrier::Body(id) => &self.body(id).name,
        }
    }
}
impl Inertia {
    /// The points that describe where the matter is.
    pub fn points(&self) -> Vec<PointId> {
        match self {
            Self::Rod { ends, .. } | Self::Box { ends, .. } => ends.to_vec(),
            Self::Given { centre, .. } => vec![*centre],
        }
    }
}
