//! The mass matrix by composite bodies, [CS (6)].
//! In: [`Linkage`], poses, mass properties. Out: M as expressions. Never knows forces or closures.
//!
//! With the absolute angular velocity as speed of a ball link, turning the parent does not turn the
//! child: a composite then passes only its mass inwards, and its own block of M stays constant.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::deformation::ModalMass;
use super::inertia::{LinkMass, inertia_of_second_moment, rotated};
use super::kinematics::{Pose, Poses};
use super::linkage::{Freedom, LinkIndex, Linkage};
use super::node::NodePose;
use super::wrench::Wrench;

/// Composite rigid body: everything outboard of a link's joint, frozen.
#[derive(Clone, Copy, Debug)]
struct Composite<'g> {
    mass: Expr<'g>,
    first: Vec3<'g>,
    inertia: Mat3<'g>,
}

impl<'g> Composite<'g> {
    fn parts(&self) -> (Expr<'g>, Vec3<'g>, Mat3<'g>) {
        (self.mass, self.first, self.inertia)
    }
}

/// The mass matrix, dense and symmetric with structural zeros; rows and columns are all speeds.
pub fn mass_matrix<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    poses: &Poses<'g>,
    masses: &[LinkMass<'g>],
) -> Vec<Vec<Expr<'g>>> {
    let zero = g.zero();
    let n = linkage.speeds();
    let mut columns = Columns { linkage, poses, matrix: vec![vec![zero; n]; n] };
    let mut composites: Vec<Composite<'g>> = masses
        .iter()
        .map(|own| Composite {
            mass: own.frozen.mass,
            first: own.frozen.first,
            inertia: inertia_of_second_moment(g, own.frozen.second),
        })
        .collect();
    let mut modal: Vec<Option<ModalColumns<'g>>> =
        masses.iter().map(|own| own.modal.as_ref().map(|modal| ModalColumns::new(g, modal))).collect();
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
        if let (Some(node), Some(parent)) = (&poses.nodes[at], link.parent) {
            if let Some(mut own) = modal[at].take() {
                own.hold(g, node, &composite);
                own.fill(g, &mut columns, at);
            } else if let Some(body) = &mut modal[parent] {
                body.carry(g, node, &poses.relative[at], &composite);
            }
            continue;
        }
        for (column, wrench) in momentum_columns(g, link.freedom, &composite).into_iter().enumerate() {
            columns.fill(g, at, link.first_speed + column, wrench);
        }
    }
    columns.matrix
}

/// Momentum per unit of every modal speed of one flexible body.
struct ModalColumns<'g> {
    /// Of the body and what its nodes carry, about its origin, in its frame.
    wrenches: Vec<Wrench<'g>>,
    /// Block of M.
    block: Vec<Vec<Expr<'g>>>,
}

impl<'g> ModalColumns<'g> {
    fn new(g: &'g Scope, own: &ModalMass<'g>) -> Self {
        Self {
            wrenches: (0..own.matrix.len()).map(|k| own.column(k)).collect(),
            block: own.matrix.iter().map(|row| row.iter().map(|x| g.constant(*x)).collect()).collect(),
        }
    }

    /// Adds what hangs on a node, which the modes move along.
    fn carry(&mut self, g: &'g Scope, node: &NodePose<'g>, pose: &Pose<'g>, hanging: &Composite<'g>) {
        let screws: Vec<[Vec3<'g>; 2]> =
            (0..self.wrenches.len()).map(|k| node.screw(g, k).map(|v| node.to_section(g, v))).collect();
        for (k, [turn, slide]) in screws.iter().enumerate() {
            let momentum = Wrench::momentum(g, hanging.parts(), *turn, *slide);
            for (l, [turn, slide]) in screws.iter().enumerate().take(k + 1) {
                let entry = momentum.power(g, *turn, *slide);
                self.block[k][l] = g.add(self.block[k][l], entry);
                self.block[l][k] = self.block[k][l];
            }
            let passed = momentum.on_parent(g, pose);
            self.wrenches[k] = self.wrenches[k].plus(g, passed);
        }
    }

    /// Adds that the whole body moves when its inboard node stays.
    fn hold(&mut self, g: &'g Scope, node: &NodePose<'g>, whole: &Composite<'g>) {
        let screws: Vec<[Vec3<'g>; 2]> = (0..self.wrenches.len())
            .map(|k| {
                let [turn, slide] = node.screw(g, k);
                let lever = g.cross3(turn, node.place);
                [g.neg3(turn), g.sub3(lever, slide)]
            })
            .collect();
        let moved: Vec<Wrench<'g>> =
            screws.iter().map(|[turn, slide]| Wrench::momentum(g, whole.parts(), *turn, *slide)).collect();
        for k in 0..screws.len() {
            for l in 0..=k {
                let terms = [
                    self.wrenches[k].power(g, screws[l][0], screws[l][1]),
                    self.wrenches[l].power(g, screws[k][0], screws[k][1]),
                    moved[k].power(g, screws[l][0], screws[l][1]),
                ];
                for term in terms {
                    self.block[k][l] = g.add(self.block[k][l], term);
                }
                self.block[l][k] = self.block[k][l];
            }
        }
        for (wrench, moved) in self.wrenches.iter_mut().zip(moved) {
            *wrench = wrench.plus(g, moved);
        }
    }

    fn fill(self, g: &'g Scope, columns: &mut Columns<'_, 'g>, at: usize) {
        let link = &columns.linkage.links[at];
        let first = link.first_speed;
        for (k, row) in self.block.into_iter().enumerate() {
            // Entries with speeds outboard of the body's nodes are there already.
            columns.matrix[first + k][first..first + row.len()].copy_from_slice(&row);
        }
        for (k, wrench) in self.wrenches.into_iter().enumerate() {
            let passed = wrench.on_parent(g, &columns.poses.relative[at]);
            columns.carry(g, link.parent, first + k, passed);
        }
    }
}

fn pass_composite<'g>(g: &'g Scope, freedom: Freedom, pose: &Pose<'g>, own: Composite<'g>) -> Composite<'g> {
    let zero = g.zero();
    let (mass, first, inertia) = match freedom {
        Freedom::Free => (zero, g.zero_vector(), g.matrix([[0.0; 3]; 3])),
        Freedom::Ball => (own.mass, g.zero_vector(), g.matrix([[0.0; 3]; 3])),
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
    let pairs: Mat3<'g> = Mat3::from_fn(|i, j| p[i] * shifted[j] + first[i] * p[j]);
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
fn momentum_columns<'g>(g: &'g Scope, freedom: Freedom, own: &Composite<'g>) -> Vec<Wrench<'g>> {
    let turn = |g: &'g Scope, axis: usize| {
        let mut unit = g.zero_vector();
        unit[axis] = g.one();
        Wrench { moment: Vec3::from_fn(|i| own.inertia[i][axis]), force: g.cross3(unit, own.first) }
    };
    let slide = |g: &'g Scope, direction: Vec3<'g>| Wrench {
        moment: g.cross3(own.first, direction),
        force: g.scale3(own.mass, direction),
    };
    let unit = |g: &'g Scope, axis: usize| {
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
            let mut columns: Vec<Wrench<'g>> = (0..3).map(|axis| turn(g, axis)).collect();
            for axis in 0..3 {
                let direction = unit(g, axis);
                columns.push(slide(g, direction));
            }
            columns
        }
        Freedom::Weld | Freedom::Flexible { .. } | Freedom::Node => Vec::new(),
    }
}

/// The columns of M as they fill.
struct Columns<'a, 'g> {
    linkage: &'a Linkage,
    poses: &'a Poses<'g>,
    matrix: Vec<Vec<Expr<'g>>>,
}

impl<'g> Columns<'_, 'g> {
    /// Fills the column of one speed of a link, down to the link and on to the ground.
    fn fill(&mut self, g: &'g Scope, from: usize, column: usize, wrench: Wrench<'g>) {
        let link = &self.linkage.links[from];
        for (row, entry) in wrench.generalised(g, link.freedom, None).into_iter().enumerate() {
            let row = link.first_speed + row;
            // Within a link, keep the entry computed first, so that M is symmetric to the bit.
            if row <= column {
                self.matrix[row][column] = entry;
                self.matrix[column][row] = entry;
            }
        }
        let passed = wrench.passed_inwards(g, link.freedom, &self.poses.relative[from]);
        self.carry(g, link.parent, column, passed);
    }

    /// Carries a momentum column from a link to the ground and reads off the entries of M.
    fn carry(&mut self, g: &'g Scope, from: LinkIndex, column: usize, wrench: Wrench<'g>) {
        let mut carried = wrench;
        let mut at = from;
        while let Some(index) = at {
            let link = &self.linkage.links[index];
            let node = self.poses.nodes[index].as_ref();
            for (row, entry) in carried.generalised(g, link.freedom, node).into_iter().enumerate() {
                // A flexible body is met twice: at its node and at its frame.
                let row = link.first_speed + row;
                let sum = g.add(self.matrix[row][column], entry);
                self.matrix[row][column] = sum;
                self.matrix[column][row] = sum;
            }
            carried = carried.passed_inwards(g, link.freedom, &self.poses.relative[index]);
            at = link.parent;
        }
    }
}
