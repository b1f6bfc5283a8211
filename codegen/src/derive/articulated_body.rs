//! A link with all that hangs on it, as its own acceleration and the multipliers of open loops see it.
//! In: inertia, forces, wrenches of rows. Out: expressions about the link's origin, in its frame. Never knows the tree.
//!
//! Vectors have six components: of motions the angular ones and those of the origin, of wrenches moment and force.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::kinematics::Pose;
use super::mass_properties::MassProperties;
use super::wrench::Wrench;

/// Six components, angular ones first.
pub type Six<'g> = [Expr<'g>; 6];

/// Which components of a link's acceleration are not zero by structure: all else of a plane mechanism is left out.
pub type Moves = [bool; 6];

/// Wrench that the inboard joint has to transmit: `inertia a + bias + sum loops_i lambda_i`.
#[derive(Clone)]
pub struct ArticulatedBody<'g> {
    /// Symmetric; its upper half is read.
    pub inertia: [Six<'g>; 6],
    pub bias: Six<'g>,
    /// Of open rows, by their number, in its order.
    pub loops: Vec<(usize, Six<'g>)>,
}

/// Both vectors in one.
pub fn six<'g>(first: Vec3<'g>, second: Vec3<'g>) -> Six<'g> {
    [first[0], first[1], first[2], second[0], second[1], second[2]]
}

/// The angular vector, and the other.
pub fn halves<'g>(six: &Six<'g>) -> [Vec3<'g>; 2] {
    [Vec3::first_of(&six[..3]), Vec3::first_of(&six[3..])]
}

/// Those of both that are not zero by structure.
pub fn dot<'g>(g: &'g Scope, a: &Six<'g>, b: &Six<'g>) -> Expr<'g> {
    g.sum(a.iter().zip(b).filter(|(a, b)| !a.is_zero() && !b.is_zero()).map(|(a, b)| *a * *b))
}

/// Components that are not moved are nobody's business.
fn kept<'g>(g: &'g Scope, mut six: Six<'g>, moves: Moves) -> Six<'g> {
    for (component, moves) in six.iter_mut().zip(moves) {
        if !moves {
            *component = g.zero();
        }
    }
    six
}

/// Wrench on the parent of a wrench on a link.
pub fn on_parent<'g>(wrench: &Six<'g>, pose: &Pose<'g>) -> Six<'g> {
    let [moment, force] = halves(wrench);
    let Wrench { moment, force } = Wrench { moment, force }.on_parent(pose);
    six(moment, force)
}

/// Motion of a link that moves as if it were fixed to its parent.
pub fn carried<'g>(motion: &Six<'g>, pose: &Pose<'g>) -> Six<'g> {
    let [alpha, origin] = halves(motion);
    six(pose.inwards(alpha), pose.inwards(origin + alpha.cross(pose.offset)))
}

/// Which components of that are not zero by structure.
pub fn carried_moves(moves: Moves, pose: &Pose<'_>) -> Moves {
    let turned = |vector: [bool; 3]| -> [bool; 3] {
        std::array::from_fn(|k| (0..3).any(|i| vector[i] && !pose.rotation[i][k].is_zero()))
    };
    let [x, y, z] = [moves[0], moves[1], moves[2]];
    let [r0, r1, r2] = [0, 1, 2].map(|i| !pose.offset[i].is_zero());
    let lever = [(y && r2) || (z && r1), (z && r0) || (x && r2), (x && r1) || (y && r0)];
    let alpha = turned([x, y, z]);
    let origin = turned(std::array::from_fn(|i| moves[3 + i] || lever[i]));
    [alpha[0], alpha[1], alpha[2], origin[0], origin[1], origin[2]]
}

impl<'g> ArticulatedBody<'g> {
    /// A rigid link by itself with what it feels where nothing accelerates freely.
    pub fn new(g: &'g Scope, mass: &MassProperties<'g>, felt: Wrench<'g>, moves: Moves) -> Self {
        let (about, first) = (mass.inertia(), mass.first.skew());
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            _ if !moves[i] || !moves[j] => g.zero(),
            (true, true) => about[i][j],
            (true, false) => first[i][j - 3],
            (false, true) => -first[i - 3][j],
            (false, false) if i == j => mass.mass,
            (false, false) => g.zero(),
        };
        Self {
            inertia: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
            bias: kept(g, six(felt.moment, felt.force), moves),
            loops: Vec::new(),
        }
    }

    /// Adds another one that moves with this.
    pub fn add(&mut self, other: Self) {
        for (own, other) in self.inertia.iter_mut().zip(&other.inertia) {
            add(own, other);
        }
        add(&mut self.bias, &other.bias);
        other.loops.into_iter().for_each(|(row, wrench)| self.push(row, &wrench));
    }

    /// Adds a wrench per multiplier of a row.
    pub fn push(&mut self, row: usize, wrench: &Six<'g>) {
        match self.loops.binary_search_by_key(&row, |(row, _)| *row) {
            Ok(at) => add(&mut self.loops[at].1, wrench),
            Err(at) => self.loops.insert(at, (row, *wrench)),
        }
    }

    /// `inertia a` for a constant motion `a`.
    pub fn momentum(&self, g: &'g Scope, axis: &[f64; 6]) -> Six<'g> {
        self.inertia.map(|row| g.weighted(axis.iter().copied(), &row))
    }

    /// Adds `factor vector vectorᵀ` to the inertia.
    pub fn add_square(&mut self, vector: &Six<'g>, factor: Expr<'g>) {
        for i in (0..6).filter(|i| !vector[*i].is_zero()) {
            let scaled = factor * vector[i];
            for j in (i..6).filter(|j| !vector[*j].is_zero()) {
                self.inertia[i][j] += scaled * vector[j];
                self.inertia[j][i] = self.inertia[i][j];
            }
        }
    }

    /// What is left for others along a component in which the link moves by a force of this size alone.
    pub fn release(&mut self, g: &'g Scope, component: usize, force: Expr<'g>) {
        for other in 0..6 {
            self.inertia[component][other] = g.zero();
            self.inertia[other][component] = g.zero();
        }
        self.bias[component] = force;
        for (_, wrench) in &mut self.loops {
            wrench[component] = g.zero();
        }
    }

    /// As the parent link sees it.
    pub fn on_parent(&self, g: &'g Scope, pose: &Pose<'g>, moves: Moves) -> Self {
        let block = |row: usize, column: usize| Mat3::from_fn(|i, j| self.inertia[row + i][column + j]);
        let turn = pose.rotation;
        let about = turned(block(0, 0), turn);
        let mixed = block(0, 3).turned_by(turn);
        let mass = turned(block(3, 3), turn);
        // Forces act, and origins move, an offset away.
        let lever = pose.offset.skew();
        let moved = mixed + lever * mass;
        let shared = moved * lever;
        let about = about - shared + lever * mixed.transpose();
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            _ if !moves[i] || !moves[j] => g.zero(),
            (true, true) => about[i.min(j)][i.max(j)],
            (true, false) => moved[i][j - 3],
            (false, true) => moved[j][i - 3],
            (false, false) => mass[i.min(j) - 3][i.max(j) - 3],
        };
        let seen = |wrench: &Six<'g>| kept(g, on_parent(wrench, pose), moves);
        Self {
            inertia: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
            bias: seen(&self.bias),
            loops: self.loops.iter().map(|(row, wrench)| (*row, seen(wrench))).collect(),
        }
    }
}

fn add<'g>(own: &mut Six<'g>, other: &Six<'g>) {
    for (own, other) in own.iter_mut().zip(other) {
        *own += *other;
    }
}

/// `turn m turnᵀ` of a symmetric matrix, upper half. About z by half as many operations:
/// with `w = s (m_xx - m_yy) + 2 c m_xy` it is `m_xx - s w`, `m_yy + s w`, `c w - m_xy`.
fn turned<'g>(m: Mat3<'g>, turn: Mat3<'g>) -> Mat3<'g> {
    let (c, s) = (turn[0][0], turn[1][0]);
    let about_z = turn[2][2].as_number() == Some(1.0) && c.id() == turn[1][1].id() && !s.is_zero();
    if !about_z {
        return m.turned_by(turn);
    }
    let w = s * (m[0][0] - m[1][1]) + 2.0 * c * m[0][1];
    let across = [c * m[0][2] - s * m[1][2], s * m[0][2] + c * m[1][2]];
    let (change, mixed) = (s * w, c * w - m[0][1]);
    Mat3([
        Vec3([m[0][0] - change, mixed, across[0]]),
        Vec3([mixed, m[1][1] + change, across[1]]),
        Vec3([across[0], across[1], m[2][2]]),
    ])
}
