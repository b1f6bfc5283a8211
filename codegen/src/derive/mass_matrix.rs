//! The mass matrix by composite bodies, [CS (6)].
//! In: [`Linkage`], poses, mass properties. Out: M as expressions. Never knows forces or closures.
//!
//! With the absolute angular velocity as speed of a ball link, turning the parent does not turn the
//! child: a composite then passes only its mass inwards, and its own block of M stays constant.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::attachment::NodePose;
use super::deformation::ModalMass;
use super::frame_inertia::FrameInertia;
use super::geometry::Geometry;
use super::kinematics::{Pose, Poses};
use super::link_mass::LinkMass;
use super::linkage::Freedom;
use super::screws::{Screw, inboard_screws};
use super::turned::Axes;
use super::wrench::Wrench;

/// Composite rigid body: everything outboard of a link's joint, as if its joints were locked.
#[derive(Clone, Copy, Debug)]
struct Composite<'g> {
    mass: Expr<'g>,
    first: Vec3<'g>,
    inertia: Mat3<'g>,
    /// What bodies whose modes are eliminated add.
    uneven: Option<Uneven<'g>>,
}

/// Inertia that no rigid body has: force `translation a + couplingᵀ alpha`, moment `coupling a`.
#[derive(Clone, Copy, Debug)]
struct Uneven<'g> {
    translation: Mat3<'g>,
    /// The same along the axes of W, if it goes by way of those.
    in_ground: Option<Mat3<'g>>,
    coupling: Mat3<'g>,
}

/// A flexible body whose modes are eliminated: the link of its floating frame, and what that feels.
pub struct Eliminated<'g> {
    pub link: usize,
    pub inertia: FrameInertia<'g>,
}

/// The mass matrix, dense and symmetric with structural zeros; rows and columns are all speeds. Along which `axes` momenta
/// are passed inwards changes no value.
pub fn mass_matrix<'g>(poses: &Poses<'g>, masses: &[LinkMass<'g>], axes: Axes) -> Vec<Vec<Expr<'g>>> {
    reduced_mass_matrix(poses, masses, &[], axes)
}

/// The same with the modes of some bodies eliminated: zero in their rows and columns.
pub fn reduced_mass_matrix<'g>(
    poses: &Poses<'g>,
    masses: &[LinkMass<'g>],
    eliminated: &[Eliminated<'g>],
    axes: Axes,
) -> Vec<Vec<Expr<'g>>> {
    let Geometry { g, linkage, .. } = poses.geometry;
    let n = linkage.speeds();
    let screws = if axes.screws_outboard { inboard_screws(poses) } else { Vec::new() };
    let mut columns = Columns { poses, axes, screws, matrix: vec![vec![g.zero(); n]; n] };
    let mut composites: Vec<Composite<'g>> = masses
        .iter()
        .map(|LinkMass { rigid, .. }| Composite {
            mass: rigid.mass,
            first: rigid.first,
            inertia: rigid.inertia(),
            uneven: None,
        })
        .collect();
    let mut modal: Vec<Option<ModalColumns<'g>>> =
        masses.iter().map(|mass| mass.modal.as_ref().map(|modal| ModalColumns::new(g, modal))).collect();
    for body in eliminated {
        composites[body.link] = Composite::of_frame(g, &body.inertia);
        modal[body.link] = None;
    }
    for at in (0..linkage.links.len()).rev() {
        let link = &linkage.links[at];
        let composite = composites[at];
        if let Some(parent) = link.parent {
            let turns = axes.forces_in_ground.then(|| [at, parent].map(|link| poses.world[link].rotation));
            let passed = composite.passed_inwards(link.freedom, &poses.relative[at], turns);
            let sum = &mut composites[parent];
            sum.mass += passed.mass;
            sum.first += passed.first;
            sum.inertia += passed.inertia;
            sum.uneven = match (sum.uneven, passed.uneven) {
                (Some(one), Some(other)) => Some(one.and(other)),
                (one, other) => one.or(other),
            };
        }
        if let (Some(node), Some(parent)) = (&poses.nodes[at], link.parent) {
            if let Some(mut body) = modal[at].take() {
                body.hold(node, &composite);
                body.fill(&mut columns, at);
            } else if let Some(body) = &mut modal[parent] {
                body.carry(node, &poses.relative[at], &composite);
            }
            continue;
        }
        for (column, wrench) in composite.momentum_columns(link.freedom).into_iter().enumerate() {
            columns.fill(at, link.first_speed + column, wrench);
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
    fn new(g: &'g Scope, modal: &ModalMass<'g>) -> Self {
        let numbers = |row: &Vec<f64>| row.iter().map(|x| g.number(*x)).collect();
        Self {
            wrenches: (0..modal.gamma.len()).map(|k| modal.column(k)).collect(),
            block: modal.data.mass_matrix.iter().map(numbers).collect(),
        }
    }

    /// Adds what hangs on a node, which the modes move along.
    fn carry(&mut self, node: &NodePose<'g>, pose: &Pose<'g>, hanging: &Composite<'g>) {
        let screws = node.section_screws();
        for (k, screw) in screws.iter().enumerate() {
            let momentum = hanging.momentum(*screw);
            for (l, [turn, slide]) in screws.iter().enumerate().take(k + 1) {
                self.block[k][l] += momentum.power(*turn, *slide);
                self.block[l][k] = self.block[k][l];
            }
            self.wrenches[k] += momentum.on_parent(pose);
        }
    }

    /// Adds that the whole body moves when its inboard node stays.
    fn hold(&mut self, node: &NodePose<'g>, whole: &Composite<'g>) {
        let screws = node.frame_screws();
        let moving: Vec<Wrench<'g>> = self
            .wrenches
            .iter()
            .zip(&screws)
            .map(|(wrench, screw)| *wrench + whole.momentum(*screw))
            .collect();
        for k in 0..screws.len() {
            for l in 0..=k {
                // What the body alone has across, once for each, and once for both what it has as a whole.
                self.block[k][l] += moving[k].power(screws[l][0], screws[l][1]);
                self.block[k][l] += self.wrenches[l].power(screws[k][0], screws[k][1]);
                self.block[l][k] = self.block[k][l];
            }
        }
        self.wrenches = moving;
    }

    fn fill(self, columns: &mut Columns<'_, 'g>, at: usize) {
        let link = &columns.poses.geometry.linkage.links[at];
        let first = link.first_speed;
        for (k, row) in self.block.into_iter().enumerate() {
            // Entries with speeds outboard of the body's nodes are there already.
            columns.matrix[first + k][first..first + row.len()].copy_from_slice(&row);
        }
        for (k, wrench) in self.wrenches.into_iter().enumerate() {
            // What joins the body to its parent passes all of it.
            columns.passed(at, first + k, Freedom::Weld, wrench);
        }
    }
}

impl<'g> Uneven<'g> {
    fn and(self, other: Self) -> Self {
        let ground = self.in_ground.zip(other.in_ground);
        Self {
            translation: self.translation + other.translation,
            in_ground: ground.map(|(one, other)| one + other),
            coupling: self.coupling + other.coupling,
        }
    }

    /// In the axes of the parent link, to which `turn` takes components; both links' `turns` to the axes of W.
    fn turned_by(self, turn: Mat3<'g>, turns: Option<[Mat3<'g>; 2]>) -> Self {
        let coupling = self.coupling.turned_by(turn);
        let Some([own, parents]) = turns else {
            return Self { translation: self.translation.turned_by(turn), in_ground: None, coupling };
        };
        let ground = self.in_ground.unwrap_or_else(|| {
            let turned = self.translation.turned_by(own);
            // One triangle, mirrored, so that it is symmetric to the bit.
            Mat3::from_fn(|i, j| turned[i.min(j)][i.max(j)])
        });
        Self { translation: ground.turned_by(parents.transpose()), in_ground: Some(ground), coupling }
    }

    /// Seen from an origin from which this one's is at `p`; and the inertia that this adds there.
    fn moved(self, p: Vec3<'g>) -> (Self, Mat3<'g>) {
        let (lever, back) = (p.skew(), p.skew().transpose());
        let across = lever * self.coupling.transpose();
        let inertia = across + across.transpose() + lever * self.translation * back;
        (Self { coupling: self.coupling + lever * self.translation, ..self }, inertia)
    }

    fn momentum(&self, [omega, origin]: [Vec3<'g>; 2]) -> Wrench<'g> {
        let force = self.translation * origin + self.coupling.transpose() * omega;
        Wrench { moment: self.coupling * origin, force }
    }
}

impl<'g> Composite<'g> {
    /// Of a body whose modes are eliminated.
    fn of_frame(g: &'g Scope, inertia: &FrameInertia<'g>) -> Self {
        let FrameInertia { even, translation, coupling, inertia } = *inertia;
        Self {
            mass: even,
            first: g.zero_vector(),
            inertia,
            uneven: Some(Uneven { translation, in_ground: None, coupling }),
        }
    }

    /// Momentum per unit of a twist.
    fn momentum(&self, twist: [Vec3<'g>; 2]) -> Wrench<'g> {
        let [omega, origin] = twist;
        let even = Wrench::momentum((self.mass, self.first, self.inertia), omega, origin);
        self.with_uneven(even, twist)
    }

    fn with_uneven(&self, even: Wrench<'g>, twist: [Vec3<'g>; 2]) -> Wrench<'g> {
        self.uneven.map_or(even, |uneven| even + uneven.momentum(twist))
    }

    /// What of it the joint at `pose` passes to the parent link, in the parent's frame about its origin.
    /// `turns` of both links to the axes of W where what directions differ in goes by way of those.
    fn passed_inwards(self, freedom: Freedom, pose: &Pose<'g>, turns: Option<[Mat3<'g>; 2]>) -> Self {
        let g = self.mass.scope();
        let none = g.matrix([[0.0; 3]; 3]);
        let (mass, first, inertia, uneven) = match freedom {
            Freedom::Free => (g.zero(), g.zero_vector(), none, None),
            Freedom::Ball => {
                let uneven = self.uneven.map(|uneven| Uneven { coupling: none, ..uneven });
                (self.mass, g.zero_vector(), none, uneven)
            }
            _ => {
                let inertia = self.inertia.turned_by(pose.rotation);
                (self.mass, pose.rotation * self.first, inertia, self.uneven)
            }
        };
        let p = pose.offset;
        // Parallel axes: (2 p.s + m p.p) 1 - (p sᵀ + s pᵀ + m p pᵀ), with u = 2 s + m p.
        let shifted = first + mass * p;
        let pairs = Mat3::from_fn(|i, j| p[i] * shifted[j] + first[i] * p[j]);
        let mut moved = inertia;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            moved[i][i] += pairs[j][j] + pairs[k][k];
            moved[i][j] -= pairs[i][j];
            moved[j][i] = moved[i][j];
        }
        let uneven = uneven.map(|uneven| {
            let (uneven, inertia) = uneven.turned_by(pose.rotation, turns).moved(p);
            moved += inertia;
            uneven
        });
        Self { mass, first: shifted, inertia: moved, uneven }
    }

    /// Momentum per unit of each speed of the link that carries it.
    fn momentum_columns(&self, freedom: Freedom) -> Vec<Wrench<'g>> {
        let g = self.mass.scope();
        let unit = |axis: usize| {
            let mut unit = g.zero_vector();
            unit[axis] = g.number(1.0);
            unit
        };
        let turn = |axis: usize| {
            let moment = Vec3::from_fn(|i| self.inertia[i][axis]);
            let even = Wrench { moment, force: unit(axis).cross(self.first) };
            self.with_uneven(even, [unit(axis), g.zero_vector()])
        };
        let slide = |direction: Vec3<'g>| {
            let even = Wrench { moment: self.first.cross(direction), force: self.mass * direction };
            self.with_uneven(even, [g.zero_vector(), direction])
        };
        match freedom {
            Freedom::Rotation { advance, .. } => vec![turn(2) + slide(advance * unit(2))],
            Freedom::Translation { axis } => vec![slide(g.vector(axis))],
            Freedom::Ball => (0..3).map(turn).collect(),
            Freedom::Free => (0..3).map(turn).chain((0..3).map(|axis| slide(unit(axis)))).collect(),
            Freedom::Weld | Freedom::Flexible { .. } | Freedom::Node => Vec::new(),
        }
    }
}

/// The columns of M as they fill.
struct Columns<'a, 'g> {
    poses: &'a Poses<'g>,
    axes: Axes,
    /// By link, of the speeds inboard of it, where these are asked along its axes.
    screws: Vec<Vec<(usize, Screw<'g>)>>,
    matrix: Vec<Vec<Expr<'g>>>,
}

impl<'g> Columns<'_, 'g> {
    /// Fills the column of one speed of a link, down to the link and on to the ground.
    fn fill(&mut self, from: usize, column: usize, wrench: Wrench<'g>) {
        let link = &self.poses.geometry.linkage.links[from];
        for (row, entry) in wrench.generalised(link.freedom, None).into_iter().enumerate() {
            let row = link.first_speed + row;
            // Within a link, keep the entry computed first, so that M is symmetric to the bit.
            if row <= column {
                self.matrix[row][column] = entry;
                self.matrix[column][row] = entry;
            }
        }
        self.passed(from, column, link.freedom, wrench);
    }

    /// Carries a momentum column of a link on to the ground and reads off the entries of M. The speeds inboard feel of it what
    /// `freedom` passes.
    fn passed(&mut self, from: usize, column: usize, freedom: Freedom, wrench: Wrench<'g>) {
        if self.axes.screws_outboard {
            for (row, [turn, slide]) in &self.screws[from] {
                add(&mut self.matrix, (*row, column), wrench.power(*turn, *slide));
            }
            return;
        }
        let poses = self.poses;
        let linkage = poses.geometry.linkage;
        let passed = |at: usize, freedom: Freedom, carried: Wrench<'g>, ground: Vec3<'g>| {
            let parent = linkage.links[at].parent.filter(|_| self.axes.forces_in_ground);
            match (parent, freedom) {
                (None, _) | (_, Freedom::Free) => carried.passed_inwards(freedom, &poses.relative[at]),
                (Some(parent), _) => {
                    let zero = carried.force.scope().zero_vector();
                    let moment = if freedom == Freedom::Ball { zero } else { carried.moment };
                    let Pose { rotation, offset } = poses.relative[at];
                    let force = poses.world[parent].inwards(ground);
                    Wrench { moment: rotation * moment + offset.cross(force), force }
                }
            }
        };
        let ground = poses.world[from].rotation * wrench.force;
        let mut carried = passed(from, freedom, wrench, ground);
        for index in linkage.path(linkage.links[from].parent) {
            let link = &linkage.links[index];
            let node = poses.nodes[index].as_ref();
            for (row, entry) in link.speeds().zip(carried.generalised(link.freedom, node)) {
                // A flexible body is met twice: at its node and at its frame.
                add(&mut self.matrix, (row, column), entry);
            }
            carried = passed(index, link.freedom, carried, ground);
        }
    }
}

/// Adds to an entry of a symmetric matrix and to its mirror, to the bit.
fn add<'g>(matrix: &mut [Vec<Expr<'g>>], (row, column): (usize, usize), entry: Expr<'g>) {
    let sum = matrix[row][column] + entry;
    matrix[row][column] = sum;
    matrix[column][row] = sum;
}
