//! Moving bodies: where their mass is, how they bend.

use super::Formula;
use crate::flexible::{ModalData, Node};
use crate::id::PointId;
use crate::source::Span;

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
    /// Young's modulus [Pa] and where it is written; nothing of modal data.
    pub young: Option<(f64, Span)>,
    /// Where its damping is written, else the body's shapes.
    pub damped: Span,
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
    /// Whether it twists the body.
    pub torsion: bool,
    /// [Hz].
    pub frequency: f64,
}

impl Flexible {
    /// The node at a point.
    ///
    /// # Panics
    /// If the point is not in `nodes`; the resolver lists every point that the body is used at.
    #[expect(clippy::expect_used, reason = "documented: the resolver lists every point in use")]
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

impl Inertia {
    /// The points that describe where the matter is.
    pub fn points(&self) -> Vec<PointId> {
        match self {
            Self::Rod { ends, .. } | Self::Box { ends, .. } => ends.to_vec(),
            Self::Given { centre, .. } => vec![*centre],
        }
    }
}
