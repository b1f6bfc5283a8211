//! Sparse symbolic solution of the equations of motion, [CS (6)]: structure is found once, at generation.
//! In: symmetric matrix and right-hand sides as expressions. Out: expressions. Never knows mechanics.
//!
//!   [ M   Jᵀ ] [  v̇      ]   [ f ]
//!   [ J   0  ] [ -lambda ] = [ c ]
//!
//! L D Lᵀ without pivoting: a speed by its diagonal, a row when all its speeds are gone, each with one reciprocal; or a
//! speed and a row together by the constant that ties them, with none. In which order, [`Order`] says.

use std::cmp::Reverse;

use super::elimination_cost::Costs;
use crate::expr::{Expr, Scope};

/// The solution and the pivots of the loop rows.
#[derive(Clone)]
pub struct Solution<'g> {
    /// Accelerations of the given speeds.
    pub accelerations: Vec<Expr<'g>>,
    /// Multipliers, one per row.
    pub multipliers: Vec<Expr<'g>>,
    /// Diagonal of D for the loop rows, as if each had been eliminated alone: positive in regular positions.
    pub pivots: Vec<Expr<'g>>,
}

impl<'g> Solution<'g> {
    /// Accelerations and pivots.
    pub fn of_accelerations(&self) -> Vec<Expr<'g>> {
        self.accelerations.iter().chain(&self.pivots).copied().collect()
    }
}

/// In which order unknowns are eliminated.
#[derive(Clone, Copy, Debug)]
pub enum Order<'a> {
    /// Speeds from the leaves of the tree to its root (no fill-in), then rows in order of least fill.
    Leaves,
    /// What takes the fewest operations next; by row and speed, whether a constant may serve as pivot of both.
    Cheapest(&'a [Vec<bool>]),
    /// The same, but pairs before all others.
    PairsFirst(&'a [Vec<bool>]),
}

/// The equations: `mass` and `jacobian` are over the same speeds, ordered root to leaves.
pub struct Saddle<'a, 'g> {
    pub mass: &'a [Vec<Expr<'g>>],
    pub jacobian: &'a [Vec<Expr<'g>>],
    pub force: &'a [Expr<'g>],
    pub target: &'a [Expr<'g>],
}

/// Solves for accelerations and multipliers.
pub fn solve<'g>(g: &'g Scope, saddle: &Saddle<'_, 'g>, order: Order<'_>) -> Solution<'g> {
    let (n, m) = (saddle.mass.len(), saddle.jacobian.len());
    let zero = g.zero();
    let mut matrix = vec![vec![zero; n + m]; n + m];
    for (row, mass) in matrix.iter_mut().zip(saddle.mass) {
        row[..n].copy_from_slice(mass);
    }
    for (r, jacobian) in saddle.jacobian.iter().enumerate() {
        for (i, entry) in jacobian.iter().enumerate() {
            (matrix[n + r][i], matrix[i][n + r]) = (*entry, *entry);
        }
    }
    let mut right: Vec<Expr<'g>> = saddle.force.iter().chain(saddle.target).copied().collect();
    let mut system = Elimination::new(matrix, n);
    g.begin_section("elimination of speeds, from the leaves of the tree to its root");
    if let Order::Leaves = order {
        (0..n).rev().for_each(|i| system.alone(i, &mut right));
    }
    g.begin_section("elimination of loop rows");
    while let Some(next) = system.next(order) {
        match next {
            Pivot::Alone(at) => system.alone(at, &mut right),
            Pivot::Pair(speed, row) => system.pair(speed, row, &mut right),
        }
    }
    g.begin_section("back substitution");
    let solution = system.substitute(&right);
    let mut pivots = vec![zero; m];
    for step in &system.steps {
        match *step {
            Step::Alone { at, .. } if at >= n => pivots[at - n] = -system.matrix[at][at],
            // What the row's diagonal would be if the speed were eliminated alone: of the size of the others.
            Step::Pair { speed, row, .. } => {
                pivots[row - n] = system.matrix[row][speed].square() / system.matrix[speed][speed];
            }
            Step::Alone { .. } => {}
        }
    }
    let multipliers = solution[n..].iter().map(|x| -*x).collect();
    Solution { accelerations: solution[..n].to_vec(), multipliers, pivots }
}

/// More than a pair costs among as many unknowns as are ordered by cost.
const PAIRS_FIRST: usize = 1_000_000;

/// What is eliminated next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pivot {
    /// An unknown by its diagonal.
    Alone(usize),
    /// A speed and a row by the entry that they have in common.
    Pair(usize, usize),
}

/// Operations, neighbours, and the unknown, of which the last comes first.
type Key = (usize, usize, Reverse<usize>);

/// What was eliminated, and the unknowns that were left then and have entries with it.
enum Step<'g> {
    Alone { at: usize, reciprocal: Expr<'g>, others: Vec<usize> },
    Pair { speed: usize, row: usize, reciprocal: Expr<'g>, others: Vec<usize> },
}

struct Elimination<'g> {
    matrix: Vec<Vec<Expr<'g>>>,
    /// Unknowns before this one are speeds, the others rows.
    speeds: usize,
    left: Vec<usize>,
    /// By unknown, those left that have entries with it, in order: most have few.
    neighbours: Vec<Vec<usize>>,
    steps: Vec<Step<'g>>,
}

impl<'g> Elimination<'g> {
    fn new(matrix: Vec<Vec<Expr<'g>>>, speeds: usize) -> Self {
        let count = matrix.len();
        let with = |(k, row): (usize, &Vec<Expr<'g>>)| {
            (0..count).filter(|i| *i != k && !row[*i].is_zero()).collect()
        };
        let neighbours = matrix.iter().enumerate().map(with).collect();
        Self { matrix, speeds, left: (0..count).collect(), neighbours, steps: Vec::new() }
    }

    /// Takes an unknown out of those left. Out: those that have entries with it.
    fn leaves(&mut self, k: usize) -> Vec<usize> {
        self.left.retain(|other| *other != k);
        let others = std::mem::take(&mut self.neighbours[k]);
        for other in &others {
            self.neighbours[*other].retain(|known| *known != k);
        }
        others
    }

    fn update(&mut self, i: usize, j: usize, less: Expr<'g>) {
        let updated = self.matrix[i][j] - less;
        self.matrix[i][j] = updated;
        self.matrix[j][i] = updated;
        for (one, other) in [(i, j), (j, i)].into_iter().filter(|_| i != j) {
            let list = &mut self.neighbours[one];
            match (list.binary_search(&other), updated.is_zero()) {
                (Ok(place), true) => _ = list.remove(place),
                (Err(place), false) => list.insert(place, other),
                _ => {}
            }
        }
    }

    /// Takes unknown `k` out: updates the block of those left and the right-hand side.
    fn alone(&mut self, k: usize, right: &mut [Expr<'g>]) {
        let reciprocal = self.matrix[k][k].recip();
        let others = self.leaves(k);
        for (position, &i) in others.iter().enumerate() {
            let factor = self.matrix[i][k] * reciprocal;
            for &j in &others[position..] {
                self.update(i, j, factor * self.matrix[j][k]);
            }
            right[i] -= factor * right[k];
        }
        self.steps.push(Step::Alone { at: k, reciprocal, others });
    }

    /// Takes a speed out by a row that has no diagonal: `x_s = (f_r - sum b_j x_j) / c`, put into all other equations; the
    /// row's unknown follows from the equation of the speed.
    fn pair(&mut self, s: usize, r: usize, right: &mut [Expr<'g>]) {
        let reciprocal = self.matrix[r][s].recip();
        let (with_speed, with_row) = (self.leaves(s), self.leaves(r));
        let mut others: Vec<usize> = with_speed.into_iter().filter(|i| *i != r).chain(with_row).collect();
        others.sort_unstable();
        others.dedup();
        let diagonal = self.matrix[s][s];
        // x_s = known - sum share_j x_j.
        let known = reciprocal * right[r];
        let share: Vec<Expr<'g>> = others.iter().map(|j| reciprocal * self.matrix[*j][r]).collect();
        let after: Vec<Expr<'g>> =
            others.iter().zip(&share).map(|(j, share)| self.matrix[*j][s] - diagonal * *share).collect();
        for (position, &i) in others.iter().enumerate() {
            let beside = self.matrix[i][s];
            for (other, &j) in others.iter().enumerate().skip(position) {
                self.update(i, j, beside * share[other] + share[position] * after[other]);
            }
            right[i] -= beside * known + share[position] * (right[s] - diagonal * known);
        }
        self.steps.push(Step::Pair { speed: s, row: r, reciprocal, others });
    }

    /// Solves from the last eliminated unknown to the first.
    fn substitute(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut solution = right.to_vec();
        for step in self.steps.iter().rev() {
            let rest = |at: usize, others: &[usize], solution: &[Expr<'g>]| {
                others.iter().fold(right[at], |sum, j| sum - self.matrix[*j][at] * solution[*j])
            };
            match step {
                Step::Alone { at, reciprocal, others } => {
                    solution[*at] = *reciprocal * rest(*at, others, &solution);
                }
                Step::Pair { speed, row, reciprocal, others } => {
                    solution[*speed] = *reciprocal * rest(*row, others, &solution);
                    let own = self.matrix[*speed][*speed] * solution[*speed];
                    solution[*row] = *reciprocal * (rest(*speed, others, &solution) - own);
                }
            }
        }
        solution
    }

    fn next(&self, order: Order<'_>) -> Option<Pivot> {
        match order {
            Order::Leaves => self.least_fill(),
            Order::Cheapest(constant) => self.cheapest(constant, 1),
            Order::PairsFirst(constant) => self.cheapest(constant, PAIRS_FIRST),
        }
    }

    /// The unknown with the fewest neighbours among those left; the first among equals.
    fn least_fill(&self) -> Option<Pivot> {
        let next = self.left.iter().copied().min_by_key(|k| self.neighbours[*k].len());
        next.map(Pivot::Alone)
    }

    /// What takes the fewest operations; the fewest neighbours, then the last among equals, which is nearest to the leaves.
    /// The cost of pairs counts for one part in `share`.
    fn cheapest(&self, constant: &[Vec<bool>], share: usize) -> Option<Pivot> {
        let costs = Costs::new(&self.matrix);
        let is_row = |k: usize| k >= self.speeds;
        let mut best: Option<(Key, Pivot)> = None;
        for &k in &self.left {
            let others = &self.neighbours[k];
            // A row without its speeds gone has no diagonal, or one that may vanish.
            if is_row(k) && others.iter().any(|other| !is_row(*other)) {
                continue;
            }
            let mut offer = |cost: usize, pivot: Pivot| {
                let key = (cost, others.len(), Reverse(k));
                if best.as_ref().is_none_or(|(least, _)| key < *least) {
                    best = Some((key, pivot));
                }
            };
            offer(costs.alone(k, others), Pivot::Alone(k));
            for &r in others.iter().filter(|r| is_row(**r) && !is_row(k)) {
                let may = constant[r - self.speeds][k] && self.matrix[r][k].as_number().is_some();
                // The formulas of a pair stand on a row that nothing has been eliminated from.
                if may && self.matrix[r][r].is_zero() {
                    let both = self.left.iter().copied().filter(|i| {
                        *i != k && *i != r && !(self.matrix[*i][k].is_zero() && self.matrix[*i][r].is_zero())
                    });
                    offer(costs.pair(k, r, &both.collect::<Vec<_>>()) / share, Pivot::Pair(k, r));
                }
            }
        }
        best.map(|(_, pivot)| pivot)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    #[test]
    fn constrained_system_of_numbers_is_solved() {
        // Two unit masses held at equal acceleration, a force of 2 on the first: both accelerate with 1.
        let g = Scope::new();
        let (zero, one, two) = (g.zero(), g.number(1.0), g.number(2.0));
        let (mass, jacobian) = (vec![vec![one, zero], vec![zero, one]], vec![vec![one, -one]]);
        let saddle = Saddle { mass: &mass, jacobian: &jacobian, force: &[two, zero], target: &[zero] };
        for order in [Order::Leaves, Order::Cheapest(&[vec![false; 2]]), Order::Cheapest(&[vec![true; 2]])] {
            let solution = solve(&g, &saddle, order);
            let accelerations: Vec<_> = solution.accelerations.into_iter().map(Expr::as_number).collect();
            assert_eq!(accelerations, [Some(1.0), Some(1.0)]);
            // M v̇ = f + Jᵀ lambda: 1 = 2 + lambda.
            assert_eq!(solution.multipliers[0].as_number(), Some(-1.0));
        }
    }

    #[test]
    fn every_order_solves_any_system() {
        let g = Scope::new();
        let (n, m) = (5, 3);
        let mut state = 5_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let root = DMatrix::from_fn(n, n, |_, _| next());
        let mass = &root * root.transpose() + DMatrix::identity(n, n);
        // Rows 0 and 1 have constants, and row 1 no entry by the speed of row 0's.
        let mut jacobian = DMatrix::from_fn(m, n, |_, _| next());
        (jacobian[(0, 4)], jacobian[(1, 3)], jacobian[(1, 4)]) = (2.0, -1.5, 0.0);
        let (force, target) = (DVector::from_fn(n, |_, _| next()), DVector::from_fn(m, |_, _| next()));
        let mut whole = DMatrix::zeros(n + m, n + m);
        whole.view_mut((0, 0), (n, n)).copy_from(&mass);
        whole.view_mut((n, 0), (m, n)).copy_from(&jacobian);
        whole.view_mut((0, n), (n, m)).copy_from(&jacobian.transpose());
        let right = DVector::from_iterator(n + m, force.iter().chain(&target).copied());
        let expected = whole.lu().solve(&right).expect("regular");
        let numbers = |x: &DMatrix<f64>| -> Vec<Vec<Expr<'_>>> {
            x.row_iter().map(|row| row.iter().map(|x| g.number(*x)).collect()).collect()
        };
        let list = |x: &DVector<f64>| -> Vec<Expr<'_>> { x.iter().map(|x| g.number(*x)).collect() };
        let saddle = Saddle {
            mass: &numbers(&mass),
            jacobian: &numbers(&jacobian),
            force: &list(&force),
            target: &list(&target),
        };
        let mut constant = vec![vec![false; n]; m];
        (constant[0][4], constant[1][3]) = (true, true);
        for order in [Order::Leaves, Order::Cheapest(&constant), Order::PairsFirst(&constant)] {
            let found = solve(&g, &saddle, order);
            let both = found.accelerations.iter().copied().chain(found.multipliers.iter().map(|x| -*x));
            for (found, expected) in both.zip(&expected) {
                let found = found.as_number().expect("numbers make a number");
                // Numbers of the order of one, pivots above a tenth.
                assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
            }
            assert!(found.pivots.iter().all(|pivot| pivot.as_number().is_some_and(|pivot| pivot > 0.0)));
        }
    }
}
