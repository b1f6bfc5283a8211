//! The way to the forward dynamics that takes the fewest operations.
//! In: [`Problem`], the loop Jacobian at closed positions. Out: [`Forward`]. Never knows how a way goes.
//!
//! Every way is gone and its operations are counted, so that no rule makes a mechanism dearer.

use std::rc::Rc;

use crate::sparse_rows::SparseRows;

use super::articulated::articulated;
use super::dynamics::{Asked, shapes_of};
use super::fields::Shapes;
use super::forward::{Forward, Problem, Way};
use super::kept_rows::KeptRow;
use super::least_elimination::elimination_takes_more;
use super::local_modes::local_modes;
use super::plan::{Plan, PlanBlock};
use super::solve::{Order, Solution};
use super::turned::Axes;

/// A pivot that other entries of its row exceed by more than this lets rounding grow.
const SMALLEST_PIVOT: f64 = 0.1;

/// More unknowns than this are eliminated from the leaves to the root: to look for a shorter order takes their cube.
const MOST_TO_ORDER: usize = 60;

/// Where elimination takes at least as many operations, it is tried only if links one by one take more.
const MOST_TO_ELIMINATE: usize = 10_000;

/// Passes shorten a form by several parts in a hundred, one more than another: what is shorter by less than this part of it may
/// be longer after them.
const CLEARLY: f64 = 0.95;

/// By row and speed, whether the entry is among the largest of its row at all positions.
fn large_entries(rows: usize, speeds: usize, jacobians: &[SparseRows]) -> Vec<Vec<bool>> {
    let of_row = |row: usize| {
        let mut always = vec![true; speeds];
        for jacobian in jacobians {
            let least = SMALLEST_PIVOT * jacobian.largest(row);
            let mut large = vec![least == 0.0; speeds];
            jacobian.row(row).iter().for_each(|(speed, entry)| large[*speed] = entry.abs() >= least);
            always.iter_mut().zip(large).for_each(|(always, large)| *always &= large);
        }
        always
    };
    (0..rows).map(of_row).collect()
}

/// The shortest so far; among equals the one with the shortest accelerations, the first of those.
struct Best<'s, 'g> {
    /// Of everything, and of accelerations alone.
    operations: (usize, usize),
    forward: Forward<'g>,
    way: Way<'s, 'g>,
    /// The same of accelerations alone, whatever all else takes.
    alone: (usize, Solution<'g>),
    /// Ways that were gone already, of the problem at hand, with their operations.
    gone: Vec<(Way<'s, 'g>, (usize, usize))>,
}

impl<'s, 'g> Best<'s, 'g> {
    /// Operations of a way that was gone already, of the problem at hand.
    fn operations_of(&self, way: &Way<'s, 'g>) -> Option<(usize, usize)> {
        self.gone.iter().find(|(gone, _)| gone.is(way)).map(|(_, operations)| *operations)
    }

    /// Takes over what is shorter of a solution that goes no [`Way`], of this many operations.
    fn take(&mut self, problem: &Problem<'_, 'g>, (operations, forward): (usize, Forward<'g>)) {
        let g = problem.motion.poses.geometry.g;
        let alone = problem.known.operations(g, &forward.solution.of_accelerations());
        if alone < self.alone.0 {
            self.alone = (alone, forward.solution.clone());
        }
        if (operations, alone) < self.operations {
            (self.operations, self.forward) = ((operations, alone), forward);
        }
    }
}

/// Forward dynamics in two forms.
pub struct Shortest<'g> {
    /// By the way that is the shortest for all that is asked for.
    pub whole: Forward<'g>,
    /// By the way that is the shortest for accelerations and pivots.
    pub alone: Solution<'g>,
}

impl<'g> From<Forward<'g>> for Shortest<'g> {
    fn from(whole: Forward<'g>) -> Self {
        Self { alone: whole.solution.clone(), whole }
    }
}

/// Among the ways to solve a problem.
struct Search<'a, 'g> {
    problem: &'a Problem<'a, 'g>,
}

impl<'g> Search<'_, 'g> {
    fn first<'s>(&self, way: Way<'s, 'g>) -> Best<'s, 'g> {
        let g = self.problem.motion.poses.geometry.g;
        let forward = self.problem.by(way);
        let Problem { known, .. } = self.problem;
        let alone = known.operations(g, &forward.solution.of_accelerations());
        let operations = (known.operations(g, &forward.all()), alone);
        let alone = (alone, forward.solution.clone());
        Best { operations, forward, way, alone, gone: vec![(way, operations)] }
    }

    /// Whether the way is shorter than the best. One that was gone already is not.
    fn offer<'s>(&self, best: &mut Best<'s, 'g>, way: Way<'s, 'g>) -> bool {
        self.offer_by(best, way, |next, best| next < best)
    }

    /// Takes a way that is shorter for everything and for accelerations together: passes make more of one than of the other.
    fn offer_for_both<'s>(&self, best: &mut Best<'s, 'g>, way: Way<'s, 'g>) -> bool {
        self.offer_by(best, way, |(whole, alone), best| whole + alone < best.0 + best.1)
    }

    /// The same by how operations of everything and of accelerations alone compare.
    fn offer_by<'s>(
        &self,
        best: &mut Best<'s, 'g>,
        way: Way<'s, 'g>,
        is_shorter: impl Fn((usize, usize), (usize, usize)) -> bool,
    ) -> bool {
        if best.operations_of(&way).is_some() {
            return false;
        }
        let next = self.first(way);
        best.gone.push((way, next.operations));
        if next.alone.0 < best.alone.0 {
            best.alone = next.alone;
        }
        let shorter = is_shorter(next.operations, best.operations);
        if shorter {
            (best.operations, best.forward, best.way) = (next.operations, next.forward, way);
        }
        shorter
    }

    /// Whether the unknowns are so few that shorter ways to eliminate them are looked for.
    fn is_short(&self) -> bool {
        self.problem.partition.free.len() + self.problem.rows.len() <= MOST_TO_ORDER
    }

    /// Whether rows can be taken by the wrenches of their cuts.
    fn has_wrenches(&self, way: &Way<'_, 'g>) -> bool {
        way.rows_first.is_some_and(|plan| !plan.blocks.is_empty()) && self.is_short()
    }

    /// The other ways to sum vectors up and to take rows, one choice after the other: each is made on the best so far.
    fn along_axes<'s>(&self, best: &mut Best<'s, 'g>) {
        let by_wrenches = Way { rows_moved: true, rows_push: true, ..best.way };
        let mut shorter = self.has_wrenches(&best.way) && self.offer(best, by_wrenches);
        shorter |= self.offer_axes(best);
        if shorter {
            self.by_wrenches(best);
        }
    }

    /// Other axes of accelerations, then other ones of forces along the better of these.
    fn offer_axes<'s>(&self, best: &mut Best<'s, 'g>) -> bool {
        let way = best.way;
        let mut shorter = false;
        let [links, ground] = [false, true].map(|accelerations_in_ground| {
            let way = Way { axes: Axes { accelerations_in_ground, ..Axes::default() }, ..way };
            shorter |= self.offer(best, way);
            (best.operations_of(&way), way.axes)
        });
        let (_, axes) = std::cmp::min_by_key(links, ground, |(operations, _)| *operations);
        for axes in axes.with_these_accelerations(self.is_short()) {
            shorter |= self.offer(best, Way { axes, ..way });
        }
        shorter
    }

    /// The other ways to take rows.
    fn by_wrenches<'s>(&self, best: &mut Best<'s, 'g>) {
        let way = best.way;
        if self.has_wrenches(&way) {
            for (rows_moved, rows_push) in [(false, false), (true, false), (false, true), (true, true)] {
                self.offer(best, Way { rows_moved, rows_push, ..way });
            }
        }
    }

    /// The other orders of what is left to the equations of motion.
    fn in_order<'s>(&self, best: &mut Best<'s, 'g>, constant: &'s [Vec<bool>]) {
        let way = best.way;
        let local: usize = way.local.iter().map(|body| body.speeds.len()).sum();
        let unknowns = match way.rows_first {
            Some(Plan { rest, .. }) => rest.speeds.len() + rest.rows.len() - local,
            None => self.problem.partition.free.len() + self.problem.rows.len(),
        };
        // What nothing drives passes singular positions, and pivots of pairs do not tell how near they are: their own are constant,
        // and the others vary with the rest of the row.
        if (2..=MOST_TO_ORDER).contains(&unknowns) && self.problem.is_driven() {
            for order in [Order::Cheapest(constant), Order::PairsFirst(constant)] {
                self.offer(best, Way { order, ..way });
            }
        }
    }
}

/// The cut of every row by number; rows of couplings are alone.
fn cuts(rows: &[KeptRow<'_, '_>]) -> Vec<usize> {
    let first = |(at, row): (usize, &KeptRow<'_, '_>)| {
        let same = |other: &KeptRow<'_, '_>| match (row.between, other.between) {
            (Some(one), Some(other)) => std::ptr::eq(one, other),
            _ => false,
        };
        rows.iter().position(same).unwrap_or(at)
    };
    rows.iter().enumerate().map(first).collect()
}

/// Forward dynamics by the way that takes the fewest operations, the first among equals: rows first where the loops fix
/// accelerations, else, or where that is dearer, by elimination alone. Without `jacobians`, by elimination of everything.
/// `others` shows the problem with rows that are made in other ways.
pub fn forward<'g>(
    problem: &Problem<'_, 'g>,
    others: impl Fn(&mut dyn FnMut(&Problem<'_, 'g>)),
    (jacobians, link_by_link): (&[SparseRows], bool),
) -> Shortest<'g> {
    let speeds = problem.partition.free.len();
    let pattern: Vec<Vec<bool>> = problem
        .jacobian()
        .into_iter()
        .map(|row| row.into_iter().map(|entry| !entry.is_zero()).collect())
        .collect();
    // Larger blocks may cost more than elimination.
    let (plan, larger) = Plan::new(&pattern, speeds, jacobians);
    let without_own = if plan.rest.rows.is_empty() {
        None
    } else {
        Plan::without_own(&pattern, speeds, jacobians, &cuts(problem.rows))
    };
    let plain = Way {
        rows_first: None,
        rows_moved: false,
        rows_push: false,
        shapes: &[],
        local: &[],
        again: true,
        asked: Asked::Nothing,
        order: Order::Leaves,
        axes: Axes::default(),
        // Elimination of everything is what the other ways are tested against.
        slid: problem.is_driven() && !jacobians.is_empty(),
    };
    let g = problem.motion.poses.geometry.g;
    let by_links = || {
        let solved = if jacobians.is_empty() { None } else { articulated(problem) };
        solved.map(|forward| (problem.known.operations(g, &forward.all()), forward))
    };
    let shapes = shapes_of(problem.masses);
    let local = local_modes(problem.motion, &pattern, &plan.rest, &problem.partition.free);
    let constant = large_entries(problem.rows.len(), speeds, jacobians);
    let search = Search { problem };
    let takes_more = |than: usize, block: &PlanBlock| {
        let (linkage, free) = (problem.motion.poses.geometry.linkage, &problem.partition.free);
        elimination_takes_more(than, linkage, free, &pattern, (&block.speeds, &block.rows))
    };
    let all = PlanBlock { rows: (0..pattern.len()).collect(), speeds: (0..speeds).collect() };
    let mut first = plain;
    // What has been gone link by link, if it has.
    let mut gone_by_links = None;
    if link_by_link || takes_more(MOST_TO_ELIMINATE, &all) {
        let known = by_links();
        let is_longer = |block| known.as_ref().is_some_and(|(operations, _)| takes_more(*operations, block));
        let rows_first_is_longer = plan.blocks.is_empty() || is_longer(&plan.rest);
        let all_is_longer = is_longer(&all);
        match known {
            Some((_, forward)) if link_by_link || (all_is_longer && rows_first_is_longer) => {
                return forward.into();
            }
            known => gone_by_links = Some(known),
        }
        if all_is_longer {
            first = Way { rows_first: Some(&plan), ..plain };
        }
    }
    let mut best = search.first(first);
    if jacobians.is_empty() {
        return Shortest { whole: best.forward, alone: best.alone.1 };
    }
    let mut kinds = vec![&[][..]];
    if !shapes.is_empty() {
        kinds.push(&shapes[..]);
    }
    // What lost to another way without shape functions is not tried with them.
    for shapes in kinds {
        if !shapes.is_empty() && best.way.rows_first.is_none() {
            search.offer(&mut best, Way { shapes, ..plain });
        }
        for plan in std::iter::once(&plan).chain(&larger).chain(&without_own) {
            let first = Way { rows_first: Some(plan), shapes, ..plain };
            if !plan.blocks.is_empty() {
                search.offer(&mut best, first);
            }
            if !local.is_empty() {
                let chosen = [best.way.again];
                let either = if best.way.local.is_empty() { &[false, true][..] } else { &chosen };
                for again in either {
                    search.offer(&mut best, Way { local: &local, again: *again, ..first });
                }
            }
        }
    }
    let way = best.way;
    let turn = |shapes: &Option<Rc<Shapes<'g>>>| shapes.as_ref().is_some_and(|shapes| shapes.turns());
    if !way.local.is_empty() && way.shapes.iter().any(turn) {
        search.offer_for_both(&mut best, Way { asked: Asked::Moments, ..way });
    }
    let way = best.way;
    if best.forward.slid && search.is_short() {
        search.offer(&mut best, Way { slid: false, ..way });
    }
    // What follows changes little of what else a way takes: it is looked for on the best one alone.
    search.along_axes(&mut best);
    search.in_order(&mut best, &constant);
    others(&mut |problem| {
        let search = Search { problem };
        best.gone.clear();
        search.offer_axes(&mut best);
        search.in_order(&mut best, &constant);
    });
    // Of few unknowns other orders of elimination do as well, which are chosen from more forms.
    if !search.is_short()
        && let Some(solved) = gone_by_links.unwrap_or_else(by_links)
    {
        best.take(problem, solved);
    }
    let (least, alone) = best.alone;
    let (_, of_whole) = best.operations;
    let alone =
        if (least as f64) < CLEARLY * of_whole as f64 { alone } else { best.forward.solution.clone() };
    Shortest { whole: best.forward, alone }
}
