//! Joints that never move although the mechanism does, and motions that move no mass.
//! In: closed positions with Jacobian and mass matrix, output columns. Out: joints. Never words a message.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::decompose::symmetric_directions;
use crate::derive::{Freedom, Link, row_count};
use crate::id::JointId;
use crate::model::Closure;

use super::case::Case;
use super::samples::{ClosedPositions, Position};

/// Shares of a unit motion below this are rest; rounding leaves 1e-12.
const REST: f64 = 1e-7;

/// Smallest eigenvalue of a mass matrix scaled to a unit diagonal. Rounding leaves 1e-15; slender rods, whose spin
/// hardly moves any mass, have a diagonal of their own and stay far above.
const NO_MASS: f64 = 1e-12;

/// Joints that cannot move in any position tried. `fixed` joints do not count.
pub fn rigid_joints(case: &Case<'_>, positions: &ClosedPositions) -> Vec<JointId> {
    let mut moves = vec![false; case.system.sizes().all_speeds];
    let joint_speeds = case.linkage.joint_speeds();
    for position in &positions.positions {
        let free = position.freedoms(&joint_speeds);
        for (row, speed) in joint_speeds.iter().enumerate() {
            moves[*speed] |= free.row(row).amax() > REST;
        }
    }
    let balls = Ball::all(case);
    balls.iter().for_each(|ball| moves[ball.speeds.clone()].fill(false));
    for position in &positions.positions {
        note_balls(case, position, (&balls, &joint_speeds), &mut moves);
    }
    let own = |link: &&Link, joint: JointId| {
        link.joint == joint && !matches!(link.freedom, Freedom::Flexible { .. })
    };
    let still = |joint: JointId| {
        let links = case.linkage.links.iter().filter(|link| own(link, joint));
        links.flat_map(|link| link.first_speed..link.first_speed + link.freedom.speeds()).all(|v| !moves[v])
    };
    let has_freedom =
        |joint: JointId| case.linkage.links.iter().any(|link| own(&link, joint) && link.freedom.speeds() > 0);
    let tree =
        case.topology.tree.iter().map(|step| step.joint).filter(|joint| has_freedom(*joint) && still(*joint));
    let mut rigid: Vec<JointId> = tree.collect();
    // A joint that closes a loop of joints at rest rests too.
    let cuts = case.topology.cuts.iter().copied().filter(|cut| {
        let loop_joints = case.topology.between(case.mechanism.joint(*cut));
        let could = row_count(&case.mechanism.joint(*cut).model, Closure::Joint) < 6;
        could && loop_joints.iter().any(|joint| rigid.contains(joint)) && loop_joints.into_iter().all(still)
    });
    let cuts: Vec<JointId> = cuts.collect();
    rigid.extend(cuts);
    rigid.sort_by_key(|joint| joint.index());
    rigid
}

/// A ball of the tree. Its speeds are absolute: those of a Delta robot's platform are zero though all its joints turn.
struct Ball {
    speeds: Range<usize>,
    /// Channels of the angular velocities of the bodies that it joins, nothing for the ground.
    sides: [Option<[usize; 3]>; 2],
}

impl Ball {
    fn all(case: &Case<'_>) -> Vec<Self> {
        let balls = case.linkage.links.iter().filter(|link| link.freedom == Freedom::Ball);
        let ball = |link: &Link| {
            let joint = case.mechanism.joint(link.joint);
            let sides = [joint.parent, joint.child].map(|carrier| case.turn_channels(carrier));
            Self { speeds: link.first_speed..link.first_speed + 3, sides }
        };
        balls.map(ball).collect()
    }

    /// Whether the ball turns when the channels are these.
    fn turns(&self, channels: &[f64]) -> bool {
        let turn = |side: usize, axis: usize| self.sides[side].map_or(0.0, |place| channels[place[axis]]);
        (0..3).any(|axis| (turn(1, axis) - turn(0, axis)).abs() > REST)
    }
}

/// Notes which balls turn in a position.
fn note_balls(
    case: &Case<'_>,
    position: &Position,
    (balls, joint_speeds): (&[Ball], &[usize]),
    moves: &mut [bool],
) {
    if balls.iter().all(|ball| moves[ball.speeds.start]) {
        return;
    }
    for amounts in position.freedoms(joint_speeds).column_iter() {
        let v = case.speeds_of(joint_speeds, amounts.iter());
        let channels = case.observe(&position.q, &v, &vec![0.0; case.system.sizes().rows]);
        balls.iter().for_each(|ball| moves[ball.speeds.start] |= ball.turns(&channels));
    }
}

/// A joint (with the body it carries) whose motion moves no mass in any position tried. Elimination divides by the
/// masses of the tree, so loops that would lend it inertia do not help.
pub fn massless(case: &Case<'_>, positions: &ClosedPositions) -> Option<(JointId, String)> {
    let driven: Vec<usize> = case.drivers().into_iter().map(|(_, speed)| speed).collect();
    let free: Vec<usize> =
        (0..case.system.sizes().all_speeds).filter(|speed| !driven.contains(speed)).collect();
    let mut found = None;
    for position in &positions.positions {
        let mut mass = case.walker().mass(&position.q);
        if mass.iter().all(|entry| *entry == 0.0) {
            // Left out of long mechanisms: each speed by itself is looked at.
            mass = DMatrix::from_diagonal(&case.walker().inertias(&position.q));
        }
        let speed = free[weightless(&mass, &free)?];
        found = found.or(Some(speed));
    }
    let speed = found?;
    let link = case
        .linkage
        .links
        .iter()
        .find(|link| (link.first_speed..link.first_speed + link.freedom.speeds()).contains(&speed))?;
    let body = case.topology.tree.iter().find(|step| step.joint == link.joint)?.outboard;
    Some((link.joint, case.mechanism.body(body).name.clone()))
}

/// The free speed with the largest share in a motion without inertia, if there is such a motion.
fn weightless(all: &DMatrix<f64>, free: &[usize]) -> Option<usize> {
    let n = free.len();
    if n == 0 {
        return None;
    }
    let mass = DMatrix::from_fn(n, n, |i, j| all[(free[i], free[j])]);
    let largest = mass.diagonal().amax();
    if let Some(zero) = (0..n).find(|i| mass[(*i, *i)] <= f64::MIN_POSITIVE.max(1e-30 * largest)) {
        return Some(zero);
    }
    let scaled = |i: usize, j: usize| mass[(i, j)] / (mass[(i, i)] * mass[(j, j)]).sqrt();
    let mut least: Option<(f64, usize)> = None;
    // Motions that share no mass, as those of a row of machines, have eigenvectors of their own.
    for own in coupled(&mass) {
        let eigen =
            symmetric_directions(DMatrix::from_fn(own.len(), own.len(), |i, j| scaled(own[i], own[j])))?;
        let at = eigen.eigenvalues.imin();
        if least.is_none_or(|(value, _)| eigen.eigenvalues[at] < value) {
            least = Some((eigen.eigenvalues[at], own[eigen.eigenvectors.column(at).icamax()]));
        }
    }
    least.filter(|(value, _)| *value < NO_MASS).map(|(_, speed)| speed)
}

/// The groups of rows that entries beside the diagonal couple.
fn coupled(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = matrix.nrows();
    let mut is_known = vec![false; n];
    let mut groups = Vec::new();
    for first in 0..n {
        if is_known[first] {
            continue;
        }
        is_known[first] = true;
        let mut group = vec![first];
        let mut next = 0;
        while let Some(row) = group.get(next).copied() {
            next += 1;
            for column in 0..n {
                if !is_known[column] && matrix[(row, column)] != 0.0 {
                    is_known[column] = true;
                    group.push(column);
                }
            }
        }
        group.sort_unstable();
        groups.push(group);
    }
    groups
}
