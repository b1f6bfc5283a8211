//! Mass properties of bodies in the frames of their links.
//! In: [`Geometry`]. Out: expressions, constant wherever no tunable parameter occurs.
//! Never knows coordinates.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::id::PointId;
use crate::model::{Amount, Inertia};

use super::deformation::{ModalMass, deformed};
use super::frame::Frame;
use super::geometry::{Geometry, matrix_without_dust, without_dust};
use super::linkage::Freedom;

/// Mass of a link: as a rigid body in its present shape, and what modes feel of it.
#[derive(Clone, Debug)]
pub struct LinkMass<'g> {
    /// Mass and moments.
    pub frozen: MassProperties<'g>,
    /// Of a flexible body.
    pub modal: Option<Box<ModalMass<'g>>>,
}

/// Mass, first and second moments about the link's origin, in its frame.
#[derive(Clone, Copy, Debug)]
pub struct MassProperties<'g> {
    /// Mass [kg].
    pub mass: Expr<'g>,
    /// ∫ r dm [kg m].
    pub first: Vec3<'g>,
    /// ∫ r rᵀ dm [kg m²].
    pub second: Mat3<'g>,
}

impl<'g> Geometry<'g> {
    /// Mass properties of every link, for given coordinates, of which those of modes matter.
    pub fn masses(&self, g: &'g Scope, q: &[Expr<'g>]) -> Vec<LinkMass<'g>> {
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

    fn mass_of(&self, g: &'g Scope, at: usize) -> MassProperties<'g> {
        let link = &self.linkage.links[at];
        if link.mass_share == 0.0 {
            let zero = g.zero();
            return MassProperties { mass: zero, first: g.zero_vector(), second: g.matrix([[0.0; 3]; 3]) };
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
                let mass = self.inputs.lower(mass);
                let central = self.second_moment_of_inertia(g, at, inertia, axes);
                (mass, centre, central)
            }
        };
        let share = g.constant(link.mass_share);
        let mass = g.mul(share, mass);
        let central = share * central;
        let first = g.scale3(mass, centre);
        let first = without_dust(first);
        let carried: Mat3<'g> = Mat3::from_fn(|i, j| first[i] * centre[j]);
        let second = g.add_mat3(central, carried);
        let second = matrix_without_dust(second);
        MassProperties { mass, first, second }
    }

    /// Long axis of a body between two points: centre, unit vector, length; link frame.
    fn axis_between(&self, g: &'g Scope, at: usize, ends: [PointId; 2]) -> (Vec3<'g>, Vec3<'g>, Expr<'g>) {
        let [a, b] = ends.map(|end| self.local(g, Some(at), end));
        let along = g.sub3(b, a);
        let square = g.dot3(along, along);
        let length = g.sqrt(square);
        let reciprocal = g.reciprocal(length);
        let direction = g.scale3(reciprocal, along);
        let direction = without_dust(direction);
        let (half, sum) = (g.constant(0.5), g.add3(a, b));
        (g.scale3(half, sum), direction, length)
    }

    /// Cylinder, solid or hollow.
    fn rod(
        &self,
        g: &'g Scope,
        at: usize,
        ends: [PointId; 2],
        radii: [&crate::model::Formula; 2],
        amount: &Amount,
    ) -> (Expr<'g>, Vec3<'g>, Mat3<'g>) {
        let (centre, axis, length) = self.axis_between(g, at, ends);
        let [outer, inner] = radii.map(|radius| {
            let radius = self.inputs.lower(radius);
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
        g: &'g Scope,
        at: usize,
        ends: [PointId; 2],
        width: &[crate::model::Formula; 2],
        width_axis: [f64; 3],
        amount: &Amount,
    ) -> (Expr<'g>, Vec3<'g>, Mat3<'g>) {
        let (centre, axis, length) = self.axis_between(g, at, ends);
        let [first, second] = [0, 1].map(|i| self.inputs.lower(&width[i]));
        let area = g.mul(first, second);
        let volume = g.mul(area, length);
        let mass = self.amount(g, amount, volume);
        let twelfth = g.constant(1.0 / 12.0);
        let along = moment(g, mass, length, length, twelfth);
        let across = moment(g, mass, first, first, twelfth);
        let third = moment(g, mass, second, second, twelfth);
        let side = g.vector(self.linkage.links[at].frame.local(width_axis));
        let side = without_dust(side);
        let other = g.cross3(axis, side);
        let zero = g.zero();
        let mut second_moment = g.matrix([[0.0; 3]; 3]);
        for (weight, direction) in [(along, axis), (across, side), (third, other)] {
            let term = axial(g, direction, weight, zero);
            second_moment = g.add_mat3(second_moment, term);
        }
        (mass, centre, second_moment)
    }

    fn amount(&self, g: &'g Scope, amount: &Amount, volume: Expr<'g>) -> Expr<'g> {
        match amount {
            Amount::Mass(mass) => self.inputs.lower(mass),
            Amount::Density(density) => {
                let density = self.inputs.lower(density);
                g.mul(density, volume)
            }
        }
    }

    /// Second moment `tr(J)/2 - J` from an inertia tensor given about the centre in `axes`.
    fn second_moment_of_inertia(
        &self,
        g: &'g Scope,
        at: usize,
        inertia: &[crate::model::Formula; 6],
        axes: &[[f64; 3]; 3],
    ) -> Mat3<'g> {
        let [xx, yy, zz, xy, xz, yz] = core::array::from_fn(|i| self.inputs.lower(&inertia[i]));
        let (sum, half) = (g.dot(&[]), g.constant(0.5));
        let trace = [xx, yy, zz].into_iter().fold(sum, |sum, x| g.add(sum, x));
        let half_trace = g.mul(half, trace);
        let [a, b, c] = [xx, yy, zz].map(|x| g.sub(half_trace, x));
        let [d, e, f] = [xy, xz, yz].map(|x| g.neg(x));
        let own: Mat3<'g> = Mat3([Vec3([a, d, e]), Vec3([d, b, f]), Vec3([e, f, c])]);
        let columns = Frame::from_axes(axes[0], axes[1], axes[2]);
        let turn = self.linkage.links[at].frame.transposed().times(&columns).snapped();
        let turn = g.matrix(turn.0);
        rotated(g, turn, own)
    }
}

/// `factor * mass * a * b`.
fn moment<'g>(g: &'g Scope, mass: Expr<'g>, a: Expr<'g>, b: Expr<'g>, factor: Expr<'g>) -> Expr<'g> {
    let square = g.mul(a, b);
    let product = g.mul(mass, square);
    g.mul(factor, product)
}

/// `along u uᵀ + across (1 - u uᵀ)`.
fn axial<'g>(g: &'g Scope, u: Vec3<'g>, along: Expr<'g>, across: Expr<'g>) -> Mat3<'g> {
    let difference = g.sub(along, across);
    let mut matrix = Mat3::from_fn(|i, j| difference * (u[i] * u[j]));
    for i in 0..3 {
        matrix[i][i] += across;
    }
    matrix
}

/// `turn m turnᵀ`.
pub fn rotated<'g>(g: &'g Scope, turn: Mat3<'g>, m: Mat3<'g>) -> Mat3<'g> {
    let half = g.mul_mat3(turn, m);
    g.mul_mat3(half, turn.transpose())
}

/// `tr(P) 1 - P`: inertia tensor from the second moment.
pub fn inertia_of_second_moment<'g>(g: &'g Scope, second: Mat3<'g>) -> Mat3<'g> {
    let mut inertia: Mat3<'g> = Mat3(second.0.map(|row| -row));
    for i in 0..3 {
        inertia[i][i] = g.add(second[(i + 1) % 3][(i + 1) % 3], second[(i + 2) % 3][(i + 2) % 3]);
    }
    inertia
}
