//! Places of points and mass properties of bodies in the frames of their links.
//! In: [`Mechanism`], [`Linkage`]. Out: expressions, constant wherever no tunable parameter occurs.
//! Never knows coordinates.

use crate::expr::{ExprId, Mat3, Scope, Vec3, transpose};
use crate::id::PointId;
use crate::model::{Amount, Carrier, Inertia, Mechanism};

use super::deformation::{ModalMass, deformed};
use super::frame::Frame;
use super::linkage::{Freedom, Linkage};
use super::lower::Inputs;

/// Entries smaller than this share of the largest are rounding dust of frame changes.
const DUST: f64 = 1e-14;

/// Mass of a link: as a rigid body in its present shape, and what modes feel of it.
#[derive(Clone, Debug)]
pub struct LinkMass {
    /// Mass and moments.
    pub frozen: MassProperties,
    /// Of a flexible body.
    pub modal: Option<Box<ModalMass>>,
}

/// Mass, first and second moments about the link's origin, in its frame.
#[derive(Clone, Copy, Debug)]
pub struct MassProperties {
    /// Mass [kg].
    pub mass: ExprId,
    /// ∫ r dm [kg m].
    pub first: Vec3,
    /// ∫ r rᵀ dm [kg m²].
    pub second: Mat3,
}

/// Where points of bodies are in the frames of their links.
pub struct Geometry<'a> {
    /// The mechanism.
    pub mechanism: &'a Mechanism,
    /// Its links.
    pub linkage: &'a Linkage,
    /// Parameters and time.
    pub inputs: &'a Inputs,
}

impl Geometry<'_> {
    /// Position of a point as `carrier`'s branch describes it, in W at the reference pose [m].
    pub fn described(&self, g: &Scope, point: PointId, carrier: Carrier) -> Vec3 {
        self.inputs.lower3(g, self.mechanism.point(point).position_for(carrier))
    }

    /// A point of a link's body in the link's frame [m]; for the ground in W.
    pub fn local(&self, g: &Scope, link: Option<usize>, point: PointId) -> Vec3 {
        let Some(at) = link else { return self.described(g, point, Carrier::Ground) };
        let link = &self.linkage.links[at];
        let carrier = Carrier::Body(link.body);
        let place = self.described(g, point, carrier);
        let origin = self.described(g, link.origin, carrier);
        let arm = g.sub3(place, origin);
        let components = self.turn(g, &link.frame, arm);
        without_dust(g, components)
    }

    /// Position of a link's inboard joint in the parent link's frame [m].
    pub fn mount(&self, g: &Scope, at: usize) -> Vec3 {
        let link = &self.linkage.links[at];
        if link.node.is_some() {
            return g.zero_vector();
        }
        let first_of_chain = link.parent.is_none_or(|parent| self.linkage.links[parent].joint != link.joint);
        if !first_of_chain {
            return g.zero_vector();
        }
        self.local(g, link.parent, self.mechanism.joint(link.joint).at)
    }

    /// Components in a link's frame of a vector in W at the reference pose.
    pub fn turn(&self, g: &Scope, frame: &Frame, vector: Vec3) -> Vec3 {
        let matrix = g.matrix(frame.0);
        g.transpose_mul_vec3(matrix, vector)
    }

    /// Mass properties of every link, for given coordinates, of which those of modes matter.
    pub fn masses(&self, g: &Scope, q: &[ExprId]) -> Vec<LinkMass> {
        (0..self.linkage.links.len())
            .map(|at| {
                let link = &self.linkage.links[at];
                match &self.mechanism.body(link.body).flexible {
                    Some(flexible) if matches!(link.freedom, Freedom::Flexible { .. }) => {
                        g.begin_section(format!("mass properties of the deformed {}", link.name));
                        let (frozen, modal) = deformed(g, &flexible.data, &q[link.coordinates()]);
                        LinkMass { frozen, modal: Some(Box::new(modal)) }
                    }
                    _ => LinkMass { frozen: self.mass_of(g, at), modal: None },
                }
            })
            .collect()
    }

    fn mass_of(&self, g: &Scope, at: usize) -> MassProperties {
        let link = &self.linkage.links[at];
        if link.mass_share == 0.0 {
            let zero = g.zero();
            return MassProperties { mass: zero, first: [zero; 3], second: [[zero; 3]; 3] };
        }
        let body = self.mechanism.body(link.body).inertia.clone();
        let (mass, centre, central) = match &body {
            Inertia::Rod { ends, radius, inner_radius, amount } => {
                self.rod(g, at, *ends, [radius, inner_radius], amount)
            }
            Inertia::Box { ends, width, width_axis, amount } => {
                self.cuboid(g, at, *ends, width, *width_axis, amount)
            }
            Inertia::Given { mass, centre, inertia, axes } => {
                let centre = self.local(g, Some(at), *centre);
                let mass = self.inputs.lower(g, mass);
                let central = self.second_moment_of_inertia(g, at, inertia, axes);
                (mass, centre, central)
            }
        };
        let share = g.constant(link.mass_share);
        let mass = g.mul(share, mass);
        let central = central.map(|row| row.map(|x| g.mul(share, x)));
        let first = g.scale3(mass, centre);
        let first = without_dust(g, first);
        let carried: Mat3 = core::array::from_fn(|i| core::array::from_fn(|j| g.mul(first[i], centre[j])));
        let second = g.add_mat3(central, carried);
        let second = matrix_without_dust(g, second);
        MassProperties { mass, first, second }
    }

    /// Long axis of a body between two points: centre, unit vector, length; link frame.
    fn axis_between(&self, g: &Scope, at: usize, ends: [PointId; 2]) -> (Vec3, Vec3, ExprId) {
        let [a, b] = ends.map(|end| self.local(g, Some(at), end));
        let along = g.sub3(b, a);
        let square = g.dot3(along, along);
        let length = g.sqrt(square);
        let reciprocal = g.reciprocal(length);
        let direction = g.scale3(reciprocal, along);
        let direction = without_dust(g, direction);
        let (half, sum) = (g.constant(0.5), g.add3(a, b));
        (g.scale3(half, sum), direction, length)
    }

    /// Cylinder, solid or hollow.
    fn rod(
        &self,
        g: &Scope,
        at: usize,
        ends: [PointId; 2],
        radii: [&crate::model::Formula; 2],
        amount: &Amount,
    ) -> (ExprId, Vec3, Mat3) {
        let (centre, axis, length) = self.axis_between(g, at, ends);
        let [outer, inner] = radii.map(|radius| {
            let radius = self.inputs.lower(g, radius);
            g.square(radius)
        });
        let ring = g.sub(outer, inner);
        let pi = g.constant(std::f64::consts::PI);
        let section = g.mul(pi, ring);
        let volume = g.mul(section, length);
        let mass = self.amount(g, amount, volume);
        let (twelfth, quarter) = (g.constant(1.0 / 12.0), g.constant(0.25));
        let along = moment(g, mass, length, length, twelfth);
        let squares = g.add(outer, inner);
        let product = g.mul(mass, squares);
        let across = g.mul(quarter, product);
        (mass, centre, axial(g, axis, along, across))
    }

    fn cuboid(
        &self,
        g: &Scope,
        at: usize,
        ends: [PointId; 2],
        width: &[crate::model::Formula; 2],
        width_axis: [f64; 3],
        amount: &Amount,
    ) -> (ExprId, Vec3, Mat3) {
        let (centre, axis, length) = self.axis_between(g, at, ends);
        let [first, second] = [0, 1].map(|i| self.inputs.lower(g, &width[i]));
        let area = g.mul(first, second);
        let volume = g.mul(area, length);
        let mass = self.amount(g, amount, volume);
        let twelfth = g.constant(1.0 / 12.0);
        let along = moment(g, mass, length, length, twelfth);
        let across = moment(g, mass, first, first, twelfth);
        let third = moment(g, mass, second, second, twelfth);
        let side = g.vector(self.linkage.links[at].frame.local(width_axis));
        let side = without_dust(g, side);
        let other = g.cross3(axis, side);
        let zero = g.zero();
        let mut second_moment = [[zero; 3]; 3];
        for (weight, direction) in [(along, axis), (across, side), (third, other)] {
            let term = axial(g, direction, weight, zero);
            second_moment = g.add_mat3(second_moment, term);
        }
        (mass, centre, second_moment)
    }

    fn amount(&self, g: &Scope, amount: &Amount, volume: ExprId) -> ExprId {
        match amount {
            Amount::Mass(mass) => self.inputs.lower(g, mass),
            Amount::Density(density) => {
                let density = self.inputs.lower(g, density);
                g.mul(density, volume)
            }
        }
    }

    /// Second moment `tr(J)/2 - J` from an inertia tensor given about the centre in `axes`.
    fn second_moment_of_inertia(
        &self,
        g: &Scope,
        at: usize,
        inertia: &[crate::model::Formula; 6],
        axes: &[[f64; 3]; 3],
    ) -> Mat3 {
        let [xx, yy, zz, xy, xz, yz] = core::array::from_fn(|i| self.inputs.lower(g, &inertia[i]));
        let (sum, half) = (g.dot(&[]), g.constant(0.5));
        let trace = [xx, yy, zz].into_iter().fold(sum, |sum, x| g.add(sum, x));
        let half_trace = g.mul(half, trace);
        let [a, b, c] = [xx, yy, zz].map(|x| g.sub(half_trace, x));
        let [d, e, f] = [xy, xz, yz].map(|x| g.neg(x));
        let own: Mat3 = [[a, d, e], [d, b, f], [e, f, c]];
        let columns = Frame::from_axes(axes[0], axes[1], axes[2]);
        let turn = self.linkage.links[at].frame.transposed().times(&columns).snapped();
        let turn = g.matrix(turn.0);
        rotated(g, turn, own)
    }
}

/// `factor * mass * a * b`.
fn moment(g: &Scope, mass: ExprId, a: ExprId, b: ExprId, factor: ExprId) -> ExprId {
    let square = g.mul(a, b);
    let product = g.mul(mass, square);
    g.mul(factor, product)
}

/// `along u uᵀ + across (1 - u uᵀ)`.
fn axial(g: &Scope, u: Vec3, along: ExprId, across: ExprId) -> Mat3 {
    let difference = g.sub(along, across);
    let mut matrix: Mat3 = core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            let dyad = g.mul(u[i], u[j]);
            g.mul(difference, dyad)
        })
    });
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = g.add(row[i], across);
    }
    matrix
}

/// `turn m turnᵀ`.
pub fn rotated(g: &Scope, turn: Mat3, m: Mat3) -> Mat3 {
    let half = g.mul_mat3(turn, m);
    g.mul_mat3(half, transpose(turn))
}

/// Sets constants that are dust next to the largest constant to zero.
fn without_dust(g: &Scope, v: Vec3) -> Vec3 {
    let size = v.iter().filter_map(|x| g.as_constant(*x)).fold(0.0, |m: f64, x| m.max(x.abs()));
    v.map(|x| match g.as_constant(x) {
        Some(value) if value.abs() < DUST * size => g.zero(),
        _ => x,
    })
}

fn matrix_without_dust(g: &Scope, m: Mat3) -> Mat3 {
    let all = m.concat();
    let size = all.iter().filter_map(|x| g.as_constant(*x)).fold(0.0, |m: f64, x| m.max(x.abs()));
    m.map(|row| {
        row.map(|x| match g.as_constant(x) {
            Some(value) if value.abs() < DUST * size => g.zero(),
            _ => x,
        })
    })
}

/// `tr(P) 1 - P`: inertia tensor from the second moment.
pub fn inertia_of_second_moment(g: &Scope, second: Mat3) -> Mat3 {
    let mut inertia: Mat3 = second.map(|row| g.neg3(row));
    for i in 0..3 {
        inertia[i][i] = g.add(second[(i + 1) % 3][(i + 1) % 3], second[(i + 2) % 3][(i + 2) % 3]);
    }
    inertia
}
