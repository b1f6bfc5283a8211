//! Shortest solutions of rows that are mostly zeros. In: a row-major matrix. Out: minimum-norm solutions.
//!
//! Of many unknowns, where the pivots leave no doubt that the rows other than zero are independent, they are sums of these rows, which
//! costs as much as there are entries; elsewhere all of the matrix is decomposed.

use super::entries::{Entries, entries_of};
use super::orthogonal::Orthogonal;
use super::sparse_qr::{SPARSE, SparseQr};

/// Rows are clearly independent if their weakest direction is above this part of the strongest pivot: products of rows by rows then
/// leave five digits, and a second round as many more.
const CLEARLY: f64 = 1e-5;

/// By how much the weakest direction has to be above the tolerance: the strongest pivot is below the largest singular value by less.
const ABOVE_TOLERANCE: f64 = 10.0;

/// A matrix, ready to be solved with.
#[derive(Clone, Debug)]
pub struct Shortest(Factored);

#[derive(Clone, Debug)]
enum Factored {
    Rows(IndependentRows),
    All(Orthogonal),
}

/// Independent rows.
#[derive(Clone, Debug)]
struct IndependentRows {
    /// Number of each and its entries; rows of zeros are left out.
    rows: Vec<(usize, Entries)>,
    decomposition: SparseQr,
}

impl Shortest {
    /// Decomposes the row-major `rows` x `columns` matrix. Directions whose pivot is below `tolerance` times the first pivot count as
    /// null.
    pub fn new(matrix: &[f64], rows: usize, columns: usize, tolerance: f64) -> Self {
        let sparse = (columns >= SPARSE).then(|| IndependentRows::new(matrix, columns, tolerance)).flatten();
        Self(sparse.map_or_else(
            || {
                let mut all = Orthogonal::new(rows, columns);
                all.factor(matrix, rows, columns, tolerance);
                Factored::All(all)
            },
            Factored::Rows,
        ))
    }

    /// The shortest `x` that minimises |A x - b|; `b` has `rows` entries, `x` has `columns`.
    pub fn solve(&mut self, b: &[f64], x: &mut [f64]) {
        match &mut self.0 {
            Factored::All(all) => all.solve(b, x),
            Factored::Rows(rows) => rows.solve(b, x),
        }
    }
}

impl IndependentRows {
    /// Nothing where it is not clear that rows other than zero are independent.
    fn new(matrix: &[f64], columns: usize, tolerance: f64) -> Option<Self> {
        let rows = matrix.chunks_exact(columns).map(entries_of).enumerate();
        let rows: Vec<(usize, Entries)> = rows.filter(|(_, entries)| !entries.is_empty()).collect();
        if rows.is_empty() || rows.len() > columns {
            return None;
        }
        let decomposition = SparseQr::new(columns, rows.iter().map(|(_, entries)| entries.clone()).collect());
        let largest = super::largest(decomposition.pivots());
        let least = CLEARLY.max(ABOVE_TOLERANCE * tolerance) * largest;
        // Written so that NaN is not clear either.
        let is_clear = largest.is_finite() && decomposition.weakest(rows.len()) > least;
        is_clear.then_some(Self { rows, decomposition })
    }

    fn solve(&self, b: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for _ in 0..2 {
            let along =
                |entries: &Entries| entries.iter().map(|(place, entry)| entry * x[*place]).sum::<f64>();
            let left: Vec<f64> = self.rows.iter().map(|(row, entries)| b[*row] - along(entries)).collect();
            for ((_, entries), amount) in self.rows.iter().zip(self.decomposition.solve_normal(&left)) {
                entries.iter().for_each(|(place, entry)| x[*place] += amount * entry);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a chain, three entries each.
    fn chain(rows: usize) -> Vec<f64> {
        let columns = 2 * rows + 1;
        let mut matrix = vec![0.0; rows * columns];
        for row in 0..rows {
            let entries = [1.0, 2.0 + (row % 3) as f64, -0.5];
            matrix[row * columns + 2 * row..][..3].copy_from_slice(&entries);
        }
        matrix
    }

    #[test]
    fn solutions_of_sparse_rows_are_those_of_the_whole_matrix() {
        let (rows, columns) = (40, 81);
        let mut matrix = chain(rows);
        let b: Vec<f64> = (0..rows).map(|row| (row as f64).sin()).collect();
        let (mut x, mut expected) = (vec![0.0; columns], vec![0.0; columns]);
        let mut solved_both = |matrix: &[f64]| {
            let mut shortest = Shortest::new(matrix, rows, columns, 1e-10);
            shortest.solve(&b, &mut x);
            let mut all = Orthogonal::new(rows, columns);
            all.factor(matrix, rows, columns, 1e-10);
            all.solve(&b, &mut expected);
            // The condition is below ten.
            assert!(x.iter().zip(&expected).all(|(x, y)| (x - y).abs() < 1e-14));
            matches!(shortest.0, Factored::Rows(_))
        };
        assert!(solved_both(&matrix));
        // A row of zeros asks for nothing.
        matrix[..columns].fill(0.0);
        assert!(solved_both(&matrix));
        // A row that repeats another leaves the rank in doubt.
        matrix.copy_within(columns..2 * columns, 0);
        assert!(!solved_both(&matrix));
        matrix[5] = f64::NAN;
        assert!(matches!(Shortest::new(&matrix, rows, columns, 1e-10).0, Factored::All(_)));
    }
}
