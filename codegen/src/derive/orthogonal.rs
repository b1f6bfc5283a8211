//! Blocks of rows that are too large for adjugates, solved by orthogonal columns: no entry is divided by, so that none may
//! vanish where the block is regular.
//! In: a square matrix of expressions. Out: expressions. Never knows mechanics.
//!
//! Gram and Schmidt, modified, without square roots: `B = Q R` with `R` one on its diagonal, and `1 / (q . q)` of every column.
//! Right sides lose their part along a column at once, and solutions of the transposed system get theirs in the reverse order:
//! each is as exact as by reflections.

use crate::expr::{Expr, Scope};

/// A factored matrix.
pub struct Orthogonal<'g> {
    g: &'g Scope,
    /// The columns, by number, in the order in which they were made orthogonal.
    order: Vec<usize>,
    /// In this order.
    columns: Vec<Vec<Expr<'g>>>,
    /// `q . q` of each.
    squares: Vec<Expr<'g>>,
    reciprocals: Vec<Expr<'g>>,
    /// Of each the parts along those before it.
    along: Vec<Vec<Expr<'g>>>,
}

impl<'g> Orthogonal<'g> {
    /// Of a matrix by rows. Columns with many zeros come first, as those of the others are filled up.
    pub fn new(g: &'g Scope, matrix: &[Vec<Expr<'g>>]) -> Self {
        let n = matrix.len();
        let filled = |column: &usize| matrix.iter().filter(|row| !row[*column].is_zero()).count();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(filled);
        let mut made = Self {
            g,
            order,
            columns: Vec::with_capacity(n),
            squares: Vec::with_capacity(n),
            reciprocals: Vec::with_capacity(n),
            along: Vec::with_capacity(n),
        };
        for at in made.order.clone() {
            let mut column: Vec<Expr<'g>> = matrix.iter().map(|row| row[at]).collect();
            let along = (0..made.columns.len()).map(|before| made.take(before, &mut column)).collect();
            let square = made.dot(&column, &column);
            made.squares.push(square);
            made.reciprocals.push(square.recip());
            made.along.push(along);
            made.columns.push(column);
        }
        made
    }

    fn dot(&self, a: &[Expr<'g>], b: &[Expr<'g>]) -> Expr<'g> {
        self.g.sum(a.iter().zip(b).map(|(a, b)| *a * *b))
    }

    /// Takes its part along a column out of a vector. Out: how many times the column it was.
    fn take(&self, at: usize, vector: &mut [Expr<'g>]) -> Expr<'g> {
        let column = &self.columns[at];
        let part = self.dot(column, vector) * self.reciprocals[at];
        for (entry, of_column) in vector.iter_mut().zip(column) {
            *entry -= part * *of_column;
        }
        part
    }

    /// `B⁻¹ right`.
    pub fn solve(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let (n, mut left) = (self.columns.len(), right.to_vec());
        let mut parts: Vec<Expr<'g>> = (0..n).map(|at| self.take(at, &mut left)).collect();
        for at in (0..n).rev() {
            for before in 0..at {
                let less = self.along[at][before] * parts[at];
                parts[before] -= less;
            }
        }
        let mut solution = parts.clone();
        for (at, part) in self.order.iter().zip(parts) {
            solution[*at] = part;
        }
        solution
    }

    /// `B⁻ᵀ right`.
    pub fn solve_transposed(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let n = self.columns.len();
        let mut wanted: Vec<Expr<'g>> = Vec::with_capacity(n);
        for at in 0..n {
            let known = self.dot(&self.along[at], &wanted);
            wanted.push(right[self.order[at]] - known);
        }
        let mut solution = vec![self.g.zero(); n];
        for at in (0..n).rev() {
            let missing = wanted[at] - self.dot(&self.columns[at], &solution);
            let part = missing * self.reciprocals[at];
            for (entry, of_column) in solution.iter_mut().zip(&self.columns[at]) {
                *entry += part * *of_column;
            }
        }
        solution
    }

    /// Squares of what is left of each column without its parts along those before it, of which one is small near a singular
    /// position.
    pub fn pivots(&self) -> Vec<Expr<'g>> {
        self.squares.clone()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    fn numbers(list: Vec<Expr<'_>>) -> DVector<f64> {
        DVector::from_iterator(list.len(), list.into_iter().map(|x| x.as_number().expect("a number")))
    }

    #[test]
    fn systems_are_solved_both_ways_however_near_they_are_to_singular() {
        let mut state = 11_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for (n, least) in [(4, 1.0), (5, 1e-3), (6, 1e-6), (9, 1e-9), (12, 1e-12)] {
            let g = Scope::new();
            let [left, right] = [(); 2].map(|()| DMatrix::from_fn(n, n, |_, _| next()).qr().q());
            let sizes = DVector::from_fn(n, |i, _| if i + 1 == n { least } else { 1.0 + i as f64 });
            let matrix = left * DMatrix::from_diagonal(&sizes) * right;
            let rows: Vec<Vec<Expr<'_>>> =
                matrix.row_iter().map(|row| row.iter().map(|x| g.number(*x)).collect()).collect();
            let of: Vec<f64> = (0..n).map(|_| next()).collect();
            let known: Vec<Expr<'_>> = of.iter().map(|x| g.number(*x)).collect();
            let of = DVector::from_vec(of);
            let block = Orthogonal::new(&g, &rows);
            for (matrix, found) in [
                (matrix.clone(), numbers(block.solve(&known))),
                (matrix.transpose(), numbers(block.solve_transposed(&known))),
            ] {
                // A solution of a system nearby, off by some roundings of it.
                let error = (&matrix * &found - &of).norm() / (matrix.norm() * found.norm());
                assert!(error < 1e-14, "{n}, {least:e}: {error:e}");
            }
            let pivots = numbers(block.pivots());
            // The smallest column that is left is no smaller than what is singular, and about so near to it.
            let smallest = pivots.min().sqrt();
            assert!(smallest > 0.9 * least && smallest < 100.0 * least, "{smallest:e} of {least:e}");
        }
    }
}
