//! The way to the forward dynamics that takes the fewest operations.
//! In: [`Problem`], the loop Jacobian at closed positions. Out: [`Forward`]. Never knows how a way goes.
//!
//! Every way is gone and its operations are counted, so that no rule makes a mechanism dearer.

use nalgebra::DMatrix;

use super::dynamics::shapes_of;
use super::forward::{Forward, Problem, Way};
use super::local_modes::local_modes;
use super::plan::Plan;
use super::solve::Order;
use super::turned::Axes;

/// A pivot that other entries of its row exceed by more than this lets rounding grow.
const SMALLEST_PIVOT: f64 = 0.1;

/// More unknowns than this are eliminated from the leaves to the root: to look for a shorter order takes their cube.
const MOST_TO_ORDER: usize = 60;

/// By row and speed, whether the entry is among the largest of its row at all positions.
fn large_entries(rows: usize, speeds: usize, jacobians: &[DMatrix<f64>]) -> Vec<Vec<bool>> {
    let of_row = |row: usize| {
        let mut always = vec![true; speeds];
        for jacobian in jacobians {
            let least = SMALLEST_PIVOT * jacobian.row(row).amax();
            for (always, entry) in always.iter_mut().zip(jacobian.row(row).iter()) {
                *always &= entry.abs() >= least;
            }
        }
        always
    };
    (0..rows).map(of_row).collect()
}

/// The shortest so far, the first among equals.
struct Best<'s, 'g> {
    operations: usize,
    forward: Forward<'g>,
    way: Way<'s, 'g>,
}

impl<'s, 'g> Best<'s, 'g> {
    fn new(problem: &Problem<'_, 'g>, plan: &Plan, way: Way<'s, 'g>) -> Self {
        let forward = problem.by(plan, way);
        Self { operations: forward.operations(problem.motion.poses.geometry.g), forward, way }
    }

    fn offer(&mut self, problem: &Problem<'_, 'g>, plan: &Plan, way: Way<'s, 'g>) {
        let next = Self::new(problem, plan, way);
        if next.operations < self.operations {
            *self = next;
        }
    }
}

/// Forward dynamics by the way that takes the fewest operations, the first among equals: rows first where the loops fix
/// accelerations, else, or where that is dearer, by elimination alone. Without `jacobians`, by elimination of everything.
pub fn forward<'g>(problem: &Problem<'_, 'g>, jacobians: &[DMatrix<f64>]) -> Forward<'g> {
    let speeds = problem.partition.free.len();
    let pattern: Vec<Vec<bool>> = problem
        .jacobian()
        .into_iter()
        .map(|row| row.into_iter().map(|entry| !entry.is_zero()).collect())
        .collect();
    let plan = Plan::new(&pattern, speeds, jacobians);
    let axes = Axes::default();
    let plain = Way { rows_first: false, shapes: &[], local: &[], again: true, order: Order::Leaves, axes };
    let shapes = shapes_of(problem.masses);
    let local = local_modes(problem.motion, &pattern, &plan.rest, &problem.partition.free);
    let constant = large_entries(problem.rows.len(), speeds, jacobians);
    let mut best = Best::new(problem, &plan, plain);
    if jacobians.is_empty() {
        return best.forward;
    }
    let mut kinds = vec![&[][..]];
    if !shapes.is_empty() {
        kinds.push(&shapes[..]);
    }
    for shapes in kinds {
        if !shapes.is_empty() {
            best.offer(problem, &plan, Way { shapes, ..plain });
        }
        let first = Way { rows_first: true, shapes, ..plain };
        if !plan.blocks.is_empty() {
            best.offer(problem, &plan, first);
        }
        if !local.is_empty() {
            for again in [false, true] {
                best.offer(problem, &plan, Way { local: &local, again, ..first });
            }
        }
    }
    let way = best.way;
    for axes in &Axes::ALL[1..] {
        best.offer(problem, &plan, Way { axes: *axes, ..way });
    }
    // The order changes little of what else a way takes: it is looked for on the best one alone.
    let way = best.way;
    let rest = plan.rest.speeds.len() + plan.rest.rows.len();
    let unknowns = if way.rows_first { rest } else { speeds + pattern.len() };
    // What nothing drives passes singular positions, and pivots of pairs do not tell how near they are: their own are constant, and
    // the others vary with the rest of the row.
    if unknowns <= MOST_TO_ORDER && !problem.partition.driven.is_empty() {
        for order in [Order::Cheapest(&constant), Order::PairsFirst(&constant)] {
            best.offer(problem, &plan, Way { order, ..way });
        }
    }
    best.forward
}
