//! Rows first: accelerations that the loop rows fix are solved from `J v̇ = gamma`, and multipliers follow from inverse
//! dynamics with all accelerations known.
//! In: [`Plan`], the loop Jacobian. Out: expressions. Never knows mechanics.
//!
//! The solution is that of [CS (6)] on the constraints and off them: elimination in another order. `J M⁻¹ Jᵀ` squares the
//! condition of `J`; this does not.

use crate::expr::{Expr, Scope, Vec3};

use super::orthogonal::Orthogonal;
use super::plan::{LARGEST, PlanBlock};

/// A diagonal block of the loop Jacobian, to be solved for its own unknowns and, transposed, for its multipliers.
pub struct Block<'a, 'g> {
    pub plan: &'a PlanBlock,
    inverse: Inverse<'g>,
}

enum Inverse<'g> {
    Adjugate(Adjugate<'g>),
    Orthogonal(Orthogonal<'g>),
}

impl<'a, 'g> Block<'a, 'g> {
    /// Of a Jacobian of kept rows by free speeds.
    pub fn new(g: &'g Scope, plan: &'a PlanBlock, jacobian: &[Vec<Expr<'g>>]) -> Self {
        let of_row = |row: &usize| plan.speeds.iter().map(|speed| jacobian[*row][*speed]).collect();
        let matrix: Vec<Vec<Expr<'g>>> = plan.rows.iter().map(of_row).collect();
        let inverse = match plan.rows.len() {
            0..=LARGEST => Inverse::Adjugate(Adjugate::new(g, &matrix)),
            _ => Inverse::Orthogonal(Orthogonal::new(g, &matrix)),
        };
        Self { plan, inverse }
    }

    /// `B⁻¹ right`.
    pub fn solve(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        match &self.inverse {
            Inverse::Adjugate(inverse) => inverse.solve(right),
            Inverse::Orthogonal(inverse) => inverse.solve(right),
        }
    }

    /// `B⁻ᵀ right`.
    pub fn solve_transposed(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        match &self.inverse {
            Inverse::Adjugate(inverse) => inverse.solve_transposed(right),
            Inverse::Orthogonal(inverse) => inverse.solve_transposed(right),
        }
    }

    /// One for each row.
    pub fn pivots(&self) -> Vec<Expr<'g>> {
        match &self.inverse {
            Inverse::Adjugate(inverse) => vec![inverse.pivot(); self.plan.rows.len()],
            Inverse::Orthogonal(inverse) => inverse.pivots(),
        }
    }
}

/// A matrix that is at most 3 by 3.
struct Adjugate<'g> {
    g: &'g Scope,
    /// `B adj(B) = det(B) 1`.
    adjugate: Vec<Vec<Expr<'g>>>,
    determinant: Expr<'g>,
    reciprocal: Expr<'g>,
}

impl<'g> Adjugate<'g> {
    fn new(g: &'g Scope, matrix: &[Vec<Expr<'g>>]) -> Self {
        let entry = |i: usize, j: usize| matrix[i][j];
        let (adjugate, determinant) = match matrix.len() {
            1 => (vec![vec![g.number(1.0)]], entry(0, 0)),
            2 => {
                let [a, b, c, d] = [entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)];
                (vec![vec![d, -b], vec![-c, a]], a * d - b * c)
            }
            _ => {
                let row = |i: usize| Vec3::from_fn(|j| entry(i, j));
                let columns = [row(1).cross(row(2)), row(2).cross(row(0)), row(0).cross(row(1))];
                let adjugate = (0..3).map(|j| columns.iter().map(|column| column[j]).collect()).collect();
                (adjugate, row(0).dot(columns[0]))
            }
        };
        Self { g, adjugate, determinant, reciprocal: determinant.recip() }
    }

    fn solve(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let sum = |row: &Vec<Expr<'g>>| {
            self.reciprocal * self.g.sum(row.iter().zip(right).map(|(entry, right)| *entry * *right))
        };
        self.adjugate.iter().map(sum).collect()
    }

    fn solve_transposed(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let sum = |i: usize| {
            let column = self.adjugate.iter().map(|row| row[i]);
            self.reciprocal * self.g.sum(column.zip(right).map(|(entry, right)| entry * *right))
        };
        (0..right.len()).map(sum).collect()
    }

    /// About the square of the smallest singular value: `1 / |B⁻¹|²`; of two rows with the usual size of the adjugate, by
    /// which the pivot is only measured.
    fn pivot(&self) -> Expr<'g> {
        if self.adjugate.len() == 2 {
            let size: f64 = self.adjugate.iter().flatten().map(|entry| entry.size().powi(2)).sum();
            return (size.sqrt().recip() * self.determinant).square();
        }
        let entries = self.adjugate.iter().flatten();
        self.determinant.square() / self.g.sum(entries.map(|entry| entry.square()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_numbers_are_solved_both_ways() {
        let g = Scope::new();
        let matrix = [
            [2.0, -1.0, 0.5, 0.0, 1.0],
            [1.0, 3.0, -2.0, 0.0, 0.5],
            [0.25, 1.5, 4.0, 1.0, -3.0],
            [0.0, 2.0, -1.0, 0.0, 1.5],
            [-1.0, 0.5, 0.0, 2.0, 1.0],
        ];
        let jacobian: Vec<Vec<_>> = matrix.iter().map(|row| row.map(|x| g.number(x)).to_vec()).collect();
        for n in 1..=5 {
            let plan = PlanBlock { rows: (0..n).collect(), speeds: (0..n).collect() };
            let block = Block::new(&g, &plan, &jacobian);
            let right: Vec<_> = (0..n).map(|i| g.number(1.0 + i as f64)).collect();
            let numbers = |list: Vec<Expr<'_>>| -> Vec<f64> {
                list.into_iter().map(|x| x.as_number().expect("a number")).collect()
            };
            let (x, y) = (numbers(block.solve(&right)), numbers(block.solve_transposed(&right)));
            let matrix = nalgebra::DMatrix::from_fn(n, n, |i, j| matrix[i][j]);
            let right = nalgebra::DVector::from_fn(n, |i, _| 1.0 + i as f64);
            let [x, y] = [x, y].map(nalgebra::DVector::from_vec);
            // A few roundings of numbers below ten.
            assert!((&matrix * x - &right).amax() < 2e-14);
            assert!((matrix.transpose() * y - &right).amax() < 2e-14);
            let pivots = numbers(block.pivots());
            let norm = matrix.clone().try_inverse().expect("regular").norm();
            if n <= LARGEST {
                assert!((pivots[0] * norm * norm - 1.0).abs() < 1e-14);
            } else {
                let determinant = matrix.determinant();
                assert!((pivots.iter().product::<f64>() / determinant.powi(2) - 1.0).abs() < 1e-13);
            }
        }
    }
}
