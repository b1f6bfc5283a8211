//! The mass matrix by composite bodies, [CS (6)].
//! In: [`Linkage`], poses, mass properties. Out: M as expressions. Never knows forces or closures.
//!
//! With the absolute angular velocity as speed of a ball link, turning the parent does not turn the
//! child: a composite then passes only its mass inwards, and its own block of M stays constant.

use crate::expr::{ExprId, Graph, Mat3, Vec3};

use super::inertia::{MassProperties, inertia_of_second_moment, rotated};
use super::kinematics::{Pose, Poses};
use super::linkage::{Freedom, Linkage};
use super::wrench::Wrench;

/// Composite rigid body: everything outboard of a link's joint, frozen.
#[derive(Clone, Copy, Debug)]
struct Composite {
    mass: ExprId,
    first: Vec3,
    inertia: Mat3,
}

/// The mass matrix, dense and symmetric with structural zeros; rows and columns are all speeds.
pub fn mass_matrix(
    g: &mut Graph,
    linkage: &Linkage,
    poses: &Poses,
    masses: &[MassProperties],
) -> Vec<Vec<ExprId>> {
    let zero = g.zero();
    let n = linkage.speeds();
    let mut matrix = vec![vec![zero; n]; n];
    let mut composites: Vec<Composite> = masses
        .iter()
        .map(|own| Composite {
            mass: own.mass,
            first: own.first,
            inertia: inertia_of_second_moment(g, own.second),
        })
        .collect();
    for at in (0..linkage.links.len()).rev() {
        let link = &linkage.links[at];
        let composite = composites[at];
        if let Some(parent) = link.parent {
            let passed = pass_composite(g, link.freedom, &poses.relative[at], composite);
            let sum = &mut composites[parent];
            sum.mass = g.add(sum.mass, passed.mass);
            sum.first = g.add3(sum.first, passed.first);
            sum.inertia = g.add_mat3(sum.inertia, passed.inertia);
        }
        for (column, wrench) in momentum_columns(g, link.freedom, &composite).into_iter().enumerate() {
            fill_column(g, linkage, poses, at, link.first_speed + column, wrench, &mut matrix);
        }
    }
    matrix
}

fn pass_composite(g: &mut Graph, freedom: Freedom, pose: &Pose, own: Composite) -> Composite {
    let zero = g.zero();
    let (mass, first, inertia) = match freedom {
        Freedom::Free => (zero, [zero; 3], [[zero; 3]; 3]),
        Freedom::Ball => (own.mass, [zero; 3], [[zero; 3]; 3]),
        _ => {
            let inertia = rotated(g, pose.rotation, own.inertia);
            (own.mass, g.mul_vec3(pose.rotation, own.first), inertia)
        }
    };
    let p = pose.offset;
    let weighted = g.scale3(mass, p);
    // Parallel axes: (2 p.s + m p.p) 1 - (p sᵀ + s pᵀ + m p pᵀ), with u = 2 s + m p.
    let shifted = g.add3(first, weighted);
    let mut moved = inertia;
    let pairs: Mat3 =
        core::array::from_fn(|i| core::array::from_fn(|j| g.dot(&[(p[i], shifted[j]), (first[i], p[j])])));
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sum = g.add(pairs[j][j], pairs[k][k]);
        moved[i][i] = g.add(moved[i][i], sum);
        moved[i][j] = g.sub(moved[i][j], pairs[i][j]);
        moved[j][i] = moved[i][j];
    }
    Composite { mass, first: shifted, inertia: moved }
}

/// Momentum of the composite per unit of each own speed of its link.
fn momentum_columns(g: &mut Graph, freedom: Freedom, own: &Composite) -> Vec<Wrench> {
    let turn = |g: &mut Graph, axis: usize| {
        let mut unit = g.zero_vector();
        unit[axis] = g.one();
        Wrench { moment: [0, 1, 2].map(|i| own.inertia[i][axis]), force: g.cross3(unit, own.first) }
    };
    let slide = |g: &mut Graph, direction: Vec3| Wrench {
        moment: g.cross3(own.first, direction),
        force: g.scale3(own.mass, direction),
    };
    let unit = |g: &mut Graph, axis: usize| {
        let mut unit = g.zero_vector();
        unit[axis] = g.one();
        unit
    };
    match freedom {
        Freedom::Rotation { advance, .. } => {
            let turned = turn(g, 2);
            let rate = g.constant(advance);
            let axis = unit(g, 2);
            let along = g.scale3(rate, axis);
            let slid = slide(g, along);
            vec![turned.plus(g, slid)]
        }
        Freedom::Translation { axis } => {
            let axis = g.vector(axis);
            vec![slide(g, axis)]
        }
        Freedom::Ball => (0..3).map(|axis| turn(g, axis)).collect(),
        Freedom::Free => {
            let mut columns: Vec<Wrench> = (0..3).map(|axis| turn(g, axis)).collect();
            for axis in 0..3 {
                let direction = unit(g, axis);
                columns.push(slide(g, direction));
            }
            columns
        }
        Freedom::Weld => Vec::new(),
    }
}

/// Carries one momentum column from its link to the ground and reads off the entries of M.
fn fill_column(
    g: &mut Graph,
    linkage: &Linkage,
    poses: &Poses,
    from: usize,
    column: usize,
    wrench: Wrench,
    matrix: &mut [Vec<ExprId>],
) {
    let mut carried = wrench;
    let mut at = Some(from);
    while let Some(link_index) = at {
        let link = &linkage.links[link_index];
        for (row, entry) in carried.generalised(g, link.freedom).into_iter().enumerate() {
            let row = link.first_speed + row;
            // Within a link, keep the entry computed first, so that M is symmetric to the bit.
            if link_index != from || row <= column {
                matrix[row][column] = entry;
                matrix[column][row] = entry;
            }
        }
        carried = carried.passed_inwards(g, link.freedom, &poses.relative[link_index]);
        at = link.parent;
    }
}
