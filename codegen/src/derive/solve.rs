//! Sparse symbolic solution of the equations of motion, [CS (6)]: structure is found once, at generation.
//! In: symmetric matrix and right-hand sides as expressions. Out: expressions. Never knows mechanics.
//!
//!   [ M   Jᵀ ] [  v̇      ]   [ f ]
//!   [ J   0  ] [ -lambda ] = [ c ]
//!
//! L D Lᵀ without pivoting, speeds from the leaves of the tree to its root (no fill-in), then the loop
//! rows, whose Schur complement J M⁻¹ Jᵀ is eliminated in order of least fill. One reciprocal a pivot.

use crate::expr::{Expr, Scope};

/// The solution and the pivots of the loop rows.
pub struct Solution<'g> {
    /// Accelerations of the given speeds.
    pub accelerations: Vec<Expr<'g>>,
    /// Multipliers, one per row.
    pub multipliers: Vec<Expr<'g>>,
    /// Diagonal of D for the loop rows, positive in regular positions.
    pub pivots: Vec<Expr<'g>>,
}

/// Solves for accelerations and multipliers. `mass` and `jacobian` are over the same speeds, ordered root to
/// leaves; `names` label the pivots.
pub fn solve<'g>(
    g: &'g Scope,
    mass: &[Vec<Expr<'g>>],
    jacobian: &[Vec<Expr<'g>>],
    force: &[Expr<'g>],
    target: &[Expr<'g>],
) -> Solution<'g> {
    let (n, m) = (mass.len(), jacobian.len());
    let zero = g.zero();
    let mut matrix = vec![vec![zero; n + m]; n + m];
    for i in 0..n {
        matrix[i][..n].copy_from_slice(&mass[i]);
        for r in 0..m {
            matrix[n + r][i] = jacobian[r][i];
            matrix[i][n + r] = jacobian[r][i];
        }
    }
    let mut right: Vec<Expr<'g>> = force.iter().chain(target).copied().collect();
    let mut system = Elimination { matrix, reciprocal: vec![zero; n + m], order: Vec::new() };
    let mut left: Vec<usize> = (0..n + m).collect();
    g.begin_section("elimination of speeds, from the leaves of the tree to its root");
    for i in (0..n).rev() {
        system.eliminate(i, &mut left, &mut right);
    }
    g.begin_section("elimination of loop rows");
    while let Some(next) = system.least_fill(&left) {
        system.eliminate(next, &mut left, &mut right);
    }
    g.begin_section("back substitution");
    let solution = system.substitute(&right);
    let pivots = (n..n + m).map(|r| -system.matrix[r][r]).collect();
    let multipliers = solution[n..].iter().map(|x| -*x).collect();
    Solution { accelerations: solution[..n].to_vec(), multipliers, pivots }
}

struct Elimination<'g> {
    matrix: Vec<Vec<Expr<'g>>>,
    reciprocal: Vec<Expr<'g>>,
    order: Vec<usize>,
}

impl<'g> Elimination<'g> {
    /// Takes unknown `k` out: updates the block of those left and the right-hand side.
    fn eliminate(&mut self, k: usize, left: &mut Vec<usize>, right: &mut [Expr<'g>]) {
        left.retain(|other| *other != k);
        self.order.push(k);
        self.reciprocal[k] = self.matrix[k][k].recip();
        let neighbours: Vec<usize> = left.iter().copied().filter(|i| !self.matrix[*i][k].is_zero()).collect();
        for (position, &i) in neighbours.iter().enumerate() {
            let factor = self.matrix[i][k] * self.reciprocal[k];
            for &j in &neighbours[position..] {
                let updated = self.matrix[i][j] - factor * self.matrix[j][k];
                self.matrix[i][j] = updated;
                self.matrix[j][i] = updated;
            }
            right[i] -= factor * right[k];
        }
    }

    /// Solves from the last eliminated unknown to the first.
    fn substitute(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut solution = right.to_vec();
        for (position, &k) in self.order.iter().enumerate().rev() {
            let mut sum = right[k];
            for &j in &self.order[position + 1..] {
                sum -= self.matrix[j][k] * solution[j];
            }
            solution[k] = self.reciprocal[k] * sum;
        }
        solution
    }

    /// The row with the fewest neighbours among those left; the first among equals.
    fn least_fill(&self, left: &[usize]) -> Option<usize> {
        let degree = |k: usize| left.iter().filter(|i| **i != k && !self.matrix[**i][k].is_zero()).count();
        left.iter().copied().min_by_key(|k| degree(*k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constrained_system_of_numbers_is_solved() {
        // Two unit masses held at equal acceleration, a force of 2 on the first: both accelerate with 1.
        let g = Scope::new();
        let (zero, one, two) = (g.zero(), g.number(1.0), g.number(2.0));
        let solution =
            solve(&g, &[vec![one, zero], vec![zero, one]], &[vec![one, -one]], &[two, zero], &[zero]);
        let accelerations: Vec<_> = solution.accelerations.into_iter().map(Expr::as_number).collect();
        assert_eq!(accelerations, [Some(1.0), Some(1.0)]);
        // M v̇ = f + Jᵀ lambda: 1 = 2 + lambda.
        assert_eq!(solution.multipliers[0].as_number(), Some(-1.0));
    }
}
