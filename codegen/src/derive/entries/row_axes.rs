//! Along which axes the rows of loops are shortest, and by which of two trees.
//! In: [`Mechanism`], [`Topology`]. Out: a choice, the same for all entry points. Never knows positions.

use crate::expr::{Expr, Scope};
use crate::model::{Closure, Mechanism, Topology};
use crate::sparse_rows::SparseRows;

use super::deriver::{Deriver, inputs};
use crate::derive::closure::{cut_rows, row_count};
use crate::derive::forward::Problem;
use crate::derive::geometry::Geometry;
use crate::derive::kept_rows::kept_rows;
use crate::derive::linkage::{Freedom, LinkIndex, Linkage};
use crate::derive::linkage_build::linkage;
use crate::derive::moving::Known;
use crate::derive::relative_motion::Sums;
use crate::derive::shortest_way::forward;

/// Speeds and rows at most: to derive the forward dynamics of a longer chain more than once takes longer than all the rest of
/// a check.
pub(super) const MOST_TO_COMPARE: usize = 60;

/// Of a cut in a plane, the others say nothing.
const ROWS_IN_PLANE: usize = 2;

/// Of a cut where one of the two bodies turns freely.
const ROWS_AT_BALL: usize = 3;

/// Counts are taken before what positions say and before passes: a tree that takes a few parts in a hundred less may take more then.
const CLEARLY: f64 = 0.95;

/// A step asks for accelerations at four states and more, and closes loops about twice.
const SOLVED_PER_CLOSED: usize = 2;

/// Whether the equations of a mechanism with plane loops are no longer with their rows along the axes of W than with them
/// along those of the links.
pub fn shorter_in_ground(mechanism: &Mechanism, topology: &Topology) -> bool {
    let linkage = tree(mechanism, topology);
    let rows = ROWS_IN_PLANE * linkage.cuts.iter().filter(|cut| cut.plane).count();
    if rows == 0 || linkage.speeds() + rows > MOST_TO_COMPARE {
        return false;
    }
    let by = |rows_in_ground: bool| {
        let [solved, closed] = operations(mechanism, &Topology { rows_in_ground, ..topology.clone() });
        solved + closed
    };
    by(true) <= by(false)
}

/// Whether the equations of a mechanism in which loops meet at a body that turns freely are shorter with their rows there along
/// the axes of the other bodies: along a rod no acceleration of its own joints is felt, so that one row of three is left to the
/// body that they carry.
pub fn shorter_off_balls(mechanism: &Mechanism, topology: &Topology) -> bool {
    let is_driven = mechanism.joints.iter().any(|joint| !joint.drives.is_empty());
    let turns_freely = topology.cuts.iter().filter(|cut| mechanism.joint(**cut).model.turns_freely());
    // Rows of one cut are few enough as they are.
    if !is_driven || turns_freely.count() < 2 {
        return false;
    }
    let linkage = tree(mechanism, topology);
    let turns = |link: LinkIndex| link.is_some_and(|at| linkage.links[at].freedom == Freedom::Ball);
    let at_balls = linkage.cuts.iter().filter(|cut| {
        let model = &mechanism.joint(cut.joint).model;
        let is_ball = cut.closure == Closure::Joint && model.turns_freely() && !model.is_held_in_parent();
        is_ball && turns(cut.parent) != turns(cut.child)
    });
    let rows = ROWS_AT_BALL * at_balls.count();
    if rows <= ROWS_AT_BALL || linkage.speeds() + rows > MOST_TO_COMPARE {
        return false;
    }
    let by = |rows_off_balls: bool| {
        let [solved, closed] = operations(mechanism, &Topology { rows_off_balls, ..topology.clone() });
        SOLVED_PER_CLOSED * solved + closed
    };
    by(true) < by(false)
}

/// Whether the equations by another tree are so much shorter that it pays to have other coordinates.
pub fn clearly_shorter(mechanism: &Mechanism, [other, topology]: [&Topology; 2]) -> bool {
    let count = |topology: &Topology| {
        let linkage = tree(mechanism, topology);
        let rows: usize = topology.cuts.iter().map(|cut| mechanism.joint(*cut).model.rows()).sum();
        let is_short = linkage.speeds() + rows <= MOST_TO_COMPARE;
        is_short.then(|| {
            let [solved, closed] = operations(mechanism, topology);
            (SOLVED_PER_CLOSED * solved + closed) as f64
        })
    };
    matches!((count(other), count(topology)), (Some(other), Some(own)) if other < CLEARLY * own)
}

/// Whether of a plane loop's two rows along axes of W one alone is kept. Which of them the other rows make redundant changes
/// as the links turn; rows along the links' axes turn with them.
pub fn splits_plane_rows(mechanism: &Mechanism, topology: &Topology, keep: &[bool]) -> bool {
    let mut first = 0;
    topology.rows_in_ground
        && tree(mechanism, topology).cuts.iter().any(|cut| {
            let rows = first..first + row_count(&mechanism.joint(cut.joint).model, cut.closure);
            first = rows.end;
            let kept = &keep[rows];
            cut.plane && kept[0] != kept[1]
        })
}

fn tree(mechanism: &Mechanism, topology: &Topology) -> Linkage {
    linkage(mechanism, topology, &mechanism.parameter_values())
}

/// Operations of the forward dynamics, and of the closure, which a run asks for both, before positions say more than the pattern of
/// the loop Jacobian does.
fn operations(mechanism: &Mechanism, topology: &Topology) -> [usize; 2] {
    let linkage = tree(mechanism, topology);
    let scope = Scope::new();
    let (inputs, parameters) = inputs(&scope, mechanism);
    let geometry = Geometry { g: &scope, mechanism, linkage: &linkage, inputs: &inputs };
    let deriver = Deriver::new(geometry, parameters, None, false);
    let masses = deriver.masses();
    let instant = deriver.instant(deriver.driven_state(&[]));
    let (motion, partition) = (&instant.state.motion, &deriver.partition);
    let mut rows = kept_rows(motion, (&instant.cuts, &instant.couplings), &deriver.keep);
    // In a plane, rows out of it say nothing.
    rows.retain(|kept| partition.free.iter().any(|speed| !kept.jacobian[*speed].is_zero()));
    let entry = |row: usize, speed: usize| rows[row].jacobian[partition.free[speed]];
    let numbers_of = |row: usize| {
        let number = |speed: usize| (speed, any_number(entry(row, speed), row, speed));
        (0..partition.free.len()).map(number).collect()
    };
    let numbers = SparseRows::new(partition.free.len(), (0..rows.len()).map(numbers_of).collect());
    let problem = Problem {
        motion,
        v: &instant.state.v,
        rates: &instant.state.v_dot,
        masses: &masses,
        loads: &instant.loads,
        rows: &rows,
        made: (Sums::Links, &deriver.keep),
        partition,
        known: &Known::default(),
    };
    let solved = forward(&problem, |_| {}, (&[numbers], false)).whole.operations(&scope);
    let exact = cut_rows(motion, true, Sums::Links);
    let closed = exact.iter().flat_map(|cut| cut.rows.iter().map(move |row| (cut, row)));
    let closed = closed.flat_map(|(cut, row)| {
        let jacobian = cut.jacobian(&motion.poses, row);
        [row.residual, row.rate].into_iter().chain(jacobian).collect::<Vec<_>>()
    });
    [solved, scope.operations(closed)]
}

/// A number for an entry, such that blocks of them are regular wherever their pattern lets them.
fn any_number(entry: Expr<'_>, row: usize, speed: usize) -> f64 {
    if entry.is_zero() {
        0.0
    } else {
        // Of a sum of what row and speed make alone, no more than three rows would be independent.
        let (row, speed) = (row as f64, speed as f64);
        1.0 + (1.0 + 3.7 * row + 1.3 * speed * speed + 2.3 * row * speed).sin() / 2.0
    }
}
