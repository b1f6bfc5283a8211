//! Mass properties of a rigid body, or of its share on one branch, in the frame of its link.
//! In: [`Geometry`]. Out: expressions, constant wherever no tunable parameter occurs. Never knows coordinates.

use crate::expr::{Expr, Mat3, Vec3};
use crate::id::PointId;
use crate::model::{Amount, Formula, Inertia};

use super::frame::Frame;
use super::geometry::{Geometry, matrix_without_dust, without_dust};
use super::mass_properties::MassProperties;

/// Mass, centre, and second moment about the centre.
type Central<'g> = (Expr<'g>, Vec3<'g>, Mat3<'g>);

/// Mass properties of the body on a link, less what other branches carry of it.
pub fn rigid_part<'g>(geometry: &Geometry<'g>, at: usize) -> MassProperties<'g> {
    let link = &geometry.linkage.links[at];
    if link.mass_share == 0.0 {
        return MassProperties::none(geometry.g);
    }
    let (mass, centre, central) = match &geometry.mechanism.body(link.body).inertia {
        Inertia::Rod { ends, radius, inner_radius, amount } => {
            rod(geometry, at, *ends, [radius, inner_radius], amount)
        }
        Inertia::Box { ends, width, width_axis, amount } => {
            cuboid(geometry, at, *ends, width, *width_axis, amount)
        }
        Inertia::Given { mass, centre, inertia, axes } => {
            let centre = geometry.local(Some(at), *centre);
            let mass = geometry.inputs.lower(mass);
            (mass, centre, second_moment_of_inertia(geometry, at, inertia, axes))
        }
    };
    let share = geometry.g.number(link.mass_share);
    let mass = share * mass;
    let central = share * central;
    let first = without_dust(mass * centre);
    let carried = Mat3::from_fn(|i, j| first[i] * centre[j]);
    MassProperties { mass, first, second: matrix_without_dust(central + carried) }
}

/// Long axis of a body between two points, in the link's frame.
struct LongAxis<'g> {
    centre: Vec3<'g>,
    direction: Vec3<'g>,
    length: Expr<'g>,
}

fn axis_between<'g>(geometry: &Geometry<'g>, at: usize, ends: [PointId; 2]) -> LongAxis<'g> {
    let [a, b] = ends.map(|end| geometry.local(Some(at), end));
    let along = b - a;
    let length = along.dot(along).sqrt();
    let direction = without_dust(length.recip() * along);
    let half = geometry.g.number(0.5);
    LongAxis { centre: half * (a + b), direction, length }
}

/// Cylinder, solid or hollow.
fn rod<'g>(
    geometry: &Geometry<'g>,
    at: usize,
    ends: [PointId; 2],
    radii: [&Formula; 2],
    amount: &Amount,
) -> Central<'g> {
    let LongAxis { centre, direction, length } = axis_between(geometry, at, ends);
    let [outer, inner] = radii.map(|radius| geometry.inputs.lower(radius).square());
    let volume = std::f64::consts::PI * (outer - inner) * length;
    let mass = total(geometry, amount, volume);
    let (twelfth, quarter) = (geometry.g.number(1.0 / 12.0), geometry.g.number(0.25));
    let along = twelfth * (mass * length.square());
    let across = quarter * (mass * (outer + inner));
    (mass, centre, axial(direction, along, across))
}

fn cuboid<'g>(
    geometry: &Geometry<'g>,
    at: usize,
    ends: [PointId; 2],
    width: &[Formula; 2],
    width_axis: [f64; 3],
    amount: &Amount,
) -> Central<'g> {
    let LongAxis { centre, direction, length } = axis_between(geometry, at, ends);
    let [first, second] = [0, 1].map(|i| geometry.inputs.lower(&width[i]));
    let mass = total(geometry, amount, first * second * length);
    let twelfth = geometry.g.number(1.0 / 12.0);
    let moments = [length, first, second].map(|size| twelfth * (mass * size.square()));
    let side = without_dust(geometry.g.vector(geometry.linkage.links[at].frame.local(width_axis)));
    let axes = [direction, side, direction.cross(side)];
    let zero = geometry.g.zero();
    let none = geometry.g.matrix([[0.0; 3]; 3]);
    let central = axes.into_iter().zip(moments).fold(none, |sum, (u, moment)| sum + axial(u, moment, zero));
    (mass, centre, central)
}

/// Mass from itself or from a density.
fn total<'g>(geometry: &Geometry<'g>, amount: &Amount, volume: Expr<'g>) -> Expr<'g> {
    match amount {
        Amount::Mass(mass) => geometry.inputs.lower(mass),
        Amount::Density(density) => geometry.inputs.lower(density) * volume,
    }
}

/// Second moment `tr(J)/2 - J` from an inertia tensor given about the centre in `axes`.
fn second_moment_of_inertia<'g>(
    geometry: &Geometry<'g>,
    at: usize,
    inertia: &[Formula; 6],
    axes: &[[f64; 3]; 3],
) -> Mat3<'g> {
    let [xx, yy, zz, xy, xz, yz] = core::array::from_fn(|i| geometry.inputs.lower(&inertia[i]));
    let half = geometry.g.number(0.5);
    let half_trace = half * (xx + yy + zz);
    let [a, b, c] = [xx, yy, zz].map(|x| half_trace - x);
    let [d, e, f] = [xy, xz, yz].map(|x| -x);
    let second = Mat3([Vec3([a, d, e]), Vec3([d, b, f]), Vec3([e, f, c])]);
    let columns = Frame::from_axes(axes[0], axes[1], axes[2]);
    let turn = geometry.linkage.links[at].frame.transposed().times(&columns).snapped();
    second.turned_by(geometry.g.matrix(turn.0))
}

/// `along u uᵀ + across (1 - u uᵀ)`.
fn axial<'g>(u: Vec3<'g>, along: Expr<'g>, across: Expr<'g>) -> Mat3<'g> {
    let difference = along - across;
    let mut matrix = Mat3::from_fn(|i, j| difference * (u[i] * u[j]));
    for i in 0..3 {
        matrix[i][i] += across;
    }
    matrix
}
