//! Which unknowns of the forward dynamics the loop rows alone fix, and in which order.
//! In: where the loop Jacobian is not zero, and what it is at closed positions. Out: [`Plan`]. Never knows expressions.
//!
//! The part of the Jacobian that no speed without a row of its own reaches (Dulmage and Mendelsohn) is square and has
//! no entries by other speeds: its accelerations follow from the rows. Its strongly connected components are the diagonal
//! blocks of a block triangular form, so that it is singular only where one of them is.

use crate::decompose::singular_values;
use crate::sparse_rows::SparseRows;

/// What numbers say to the derivation.
#[derive(Clone, Debug, Default)]
pub struct Guide {
    /// Whether each constraint row (cuts in topology order) is kept.
    pub keep: Vec<bool>,
    /// At closed positions: Jacobian of all rows by all speeds, rows and speeds in units that make them comparable.
    pub jacobians: Vec<SparseRows>,
    /// Whether the forward dynamics goes link by link wherever that is possible, shorter or not.
    pub link_by_link: bool,
    /// Whether the equations of motion have their mass matrix however large it is.
    pub whole_equations: bool,
}

/// Rows and speeds, by number among kept rows and free speeds, that are solved together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PlanBlock {
    pub rows: Vec<usize>,
    pub speeds: Vec<usize>,
}

/// How the forward dynamics is solved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// Rows of a cut each and the speeds that they alone have, one fewer: among the blocks, what is left of them when these are
    /// taken out stands for the last of the rows ([`PlanBlock::left`]).
    pub own: Vec<PlanBlock>,
    /// Solved from the rows alone, in this order.
    pub blocks: Vec<PlanBlock>,
    /// What is left to the equations of motion.
    pub rest: PlanBlock,
}

/// Blocks larger than this are not solved by adjugates: these cost more than elimination.
pub const LARGEST: usize = 3;

/// Blocks larger than this are left to the equations of motion whatever they cost.
pub const LARGEST_ORTHOGONAL: usize = 12;

/// A block counts as singular at a position where its smallest singular value is below this part of its rows. Above it,
/// no more digits are lost than loops close to.
const SINGULAR: f64 = 1e-6;

/// Share of the positions at which a block may be singular: a walk passes singular positions, but does not stay in them.
const PASSED: f64 = 0.1;

impl Plan {
    /// For a Jacobian of kept rows by free speeds that is not zero where `pattern` says; `numbers` are its values at
    /// closed positions. With blocks that adjugates serve, and with larger ones as well, where there are such.
    pub fn new(pattern: &[Vec<bool>], speeds: usize, numbers: &[SparseRows]) -> (Self, Option<Self>) {
        let rows = pattern.len();
        let Some(speed_of) = matching(pattern, speeds) else {
            let rest = PlanBlock { rows: (0..rows).collect(), speeds: (0..speeds).collect() };
            return (Self { rest, ..Self::default() }, None);
        };
        let rest_row = reached(pattern, speeds, &speed_of);
        let components = components(pattern, &speed_of, &rest_row);
        let blocks = components.into_iter().map(|rows| {
            let block = PlanBlock { speeds: rows.iter().map(|row| speed_of[*row]).collect(), rows };
            let is_regular = block.rows.len() <= LARGEST_ORTHOGONAL && block.is_regular(numbers);
            (block, is_regular)
        });
        let blocks: Vec<(PlanBlock, bool)> = blocks.collect();
        let of = |largest: usize| Self::up_to(largest, &blocks, pattern, (speeds, &speed_of, &rest_row));
        let is_large = blocks.iter().any(|(block, is_regular)| *is_regular && block.rows.len() > LARGEST);
        (of(LARGEST), is_large.then(|| of(LARGEST_ORTHOGONAL)))
    }

    /// Of blocks, each with whether it is regular, those that are not larger and need none that is left out.
    fn up_to(
        largest: usize,
        all: &[(PlanBlock, bool)],
        pattern: &[Vec<bool>],
        (speeds, speed_of, rest_row): (usize, &[usize], &[bool]),
    ) -> Self {
        let mut rest_row = rest_row.to_vec();
        let mut blocks = Vec::new();
        for (block, is_regular) in all {
            let needs_rest = (0..pattern.len())
                .any(|other| rest_row[other] && block.rows.iter().any(|row| pattern[*row][speed_of[other]]));
            if needs_rest || block.rows.len() > largest || !is_regular {
                block.rows.iter().for_each(|row| rest_row[*row] = true);
            } else {
                blocks.push(block.clone());
            }
        }
        let solved: Vec<usize> = blocks.iter().flat_map(|block| block.speeds.iter().copied()).collect();
        let rest = PlanBlock {
            rows: (0..pattern.len()).filter(|row| rest_row[*row]).collect(),
            speeds: (0..speeds).filter(|speed| !solved.contains(speed)).collect(),
        };
        Self { own: Vec::new(), blocks, rest }
    }
}

impl PlanBlock {
    /// Of a cut whose own speeds are taken out: the row that what is left stands for.
    pub fn left(&self) -> usize {
        self.rows[self.rows.len() - 1]
    }

    pub(super) fn is_regular(&self, numbers: &[SparseRows]) -> bool {
        let singular = numbers.iter().filter(|jacobian| {
            let rows = jacobian.select_rows(&self.rows);
            let values = singular_values(&rows.select_columns(&self.speeds).dense());
            let largest = (0..rows.nrows()).map(|row| rows.largest(row)).fold(0.0, f64::max);
            // Against all of its rows: an entry may be there symbolically and vanish wherever loops close.
            values.is_none_or(|values| !rows.is_finite() || values.min() <= SINGULAR * largest)
        });
        // Without numbers nothing is known.
        !numbers.is_empty() && singular.count() as f64 <= PASSED * numbers.len() as f64
    }
}

/// A speed of its own for every row; nothing if there are not enough.
fn matching(pattern: &[Vec<bool>], speeds: usize) -> Option<Vec<usize>> {
    fn place(pattern: &[Vec<bool>], row: usize, row_of: &mut [Option<usize>], tried: &mut [bool]) -> bool {
        for speed in (0..row_of.len()).filter(|speed| pattern[row][*speed]) {
            if std::mem::replace(&mut tried[speed], true) {
                continue;
            }
            if row_of[speed].is_none_or(|other| place(pattern, other, row_of, tried)) {
                row_of[speed] = Some(row);
                return true;
            }
        }
        false
    }
    let mut row_of = vec![None; speeds];
    for row in 0..pattern.len() {
        if !place(pattern, row, &mut row_of, &mut vec![false; speeds]) {
            return None;
        }
    }
    let mut speed_of = vec![0; pattern.len()];
    for (speed, row) in row_of.into_iter().enumerate() {
        if let Some(row) = row {
            speed_of[row] = speed;
        }
    }
    Some(speed_of)
}

/// The rows that a speed without a row of its own reaches: directly, or by the speed of a row that it reaches.
fn reached(pattern: &[Vec<bool>], speeds: usize, speed_of: &[usize]) -> Vec<bool> {
    let mut rows = vec![false; pattern.len()];
    let mut stack: Vec<usize> = (0..speeds).filter(|speed| !speed_of.contains(speed)).collect();
    while let Some(speed) = stack.pop() {
        for row in 0..pattern.len() {
            if pattern[row][speed] && !std::mem::replace(&mut rows[row], true) {
                stack.push(speed_of[row]);
            }
        }
    }
    rows
}

/// Strongly connected components of the rows that are not left out, where a row needs those whose speeds it has: what a
/// component needs comes before it (Tarjan).
fn components(pattern: &[Vec<bool>], speed_of: &[usize], left_out: &[bool]) -> Vec<Vec<usize>> {
    struct Search<'a> {
        pattern: &'a [Vec<bool>],
        speed_of: &'a [usize],
        number: Vec<Option<usize>>,
        low: Vec<usize>,
        open: Vec<usize>,
        found: Vec<Vec<usize>>,
        done: Vec<bool>,
        next: usize,
    }
    impl Search<'_> {
        fn visit(&mut self, row: usize) {
            (self.number[row], self.low[row]) = (Some(self.next), self.next);
            self.next += 1;
            self.open.push(row);
            for other in 0..self.pattern.len() {
                if self.done[other] || !self.pattern[row][self.speed_of[other]] {
                    continue;
                }
                match self.number[other] {
                    Some(number) => self.low[row] = self.low[row].min(number),
                    None => {
                        self.visit(other);
                        self.low[row] = self.low[row].min(self.low[other]);
                    }
                }
            }
            if self.number[row] == Some(self.low[row]) {
                let first = self.open.iter().position(|open| *open == row).unwrap_or(0);
                let mut rows = self.open.split_off(first);
                rows.sort_unstable();
                rows.iter().for_each(|row| self.done[*row] = true);
                self.found.push(rows);
            }
        }
    }
    let n = pattern.len();
    let mut search = Search {
        pattern,
        speed_of,
        number: vec![None; n],
        low: vec![0; n],
        open: Vec::new(),
        found: Vec::new(),
        done: left_out.to_vec(),
        next: 0,
    };
    for row in 0..n {
        if !search.done[row] {
            search.visit(row);
        }
    }
    search.found
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A Jacobian of ones and zeros, and numbers that are regular wherever its pattern is.
    pub fn numbered(rows: &[&str]) -> (Vec<Vec<bool>>, SparseRows) {
        let pattern: Vec<Vec<bool>> =
            rows.iter().map(|row| row.chars().map(|entry| entry != '.').collect()).collect();
        let mut seed = 7_u64;
        let number = |is_there: &bool| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            if *is_there { 1.0 + (seed >> 40) as f64 / 1e7 } else { 0.0 }
        };
        let numbers: Vec<f64> = pattern.iter().flatten().map(number).collect();
        let numbers = SparseRows::from_entries(pattern[0].len(), &numbers);
        (pattern, numbers)
    }

    fn plans(rows: &[&str]) -> (Plan, Option<Plan>) {
        let (pattern, numbers) = numbered(rows);
        Plan::new(&pattern, pattern[0].len(), &[numbers])
    }

    fn plan(rows: &[&str]) -> Plan {
        plans(rows).0
    }

    fn sizes(plan: &Plan) -> Vec<usize> {
        plan.blocks.iter().map(|block| block.rows.len()).collect()
    }

    #[test]
    fn rows_that_fix_their_speeds_come_in_the_order_of_their_needs() {
        let found = plan(&["xx..", ".x..", "x.x."]);
        assert_eq!(found.blocks.iter().map(|block| block.rows[0]).collect::<Vec<_>>(), [1, 0, 2]);
        assert_eq!(found.rest, PlanBlock { rows: vec![], speeds: vec![3] });
    }

    #[test]
    fn a_speed_too_many_keeps_its_rows_for_the_equations_of_motion() {
        let found = plan(&["xx...", "..xx.", "..xx."]);
        assert_eq!(sizes(&found), [2]);
        assert_eq!(found.rest, PlanBlock { rows: vec![0], speeds: vec![0, 1, 4] });
    }

    #[test]
    fn blocks_that_are_singular_or_too_large_are_left_with_all_that_needs_them() {
        let pattern = vec![vec![true, false], vec![true, true]];
        let singular = SparseRows::from_entries(2, &[0.0, 0.0, 1.0, 1.0]);
        assert_eq!(Plan::new(&pattern, 2, &[singular]).0.blocks, []);
        assert_eq!(sizes(&plan(&["xxxx", "xxxx", "xxxx", "xxxx"])), [0; 0]);
        let [larger, small] =
            [&["xxxxx", "xxxxx", "xxxxx", "xxxxx", "....x"], &["xxx..", "xxx..", "xxx..", "...xx", "....x"]]
                .map(|rows| plans(rows).1.map(|plan| sizes(&plan)));
        assert_eq!((larger, small), (Some(vec![1, 4]), None));
    }
}
