//! Shortest solutions of rows that are mostly zeros. In: a row-major matrix. Out: minimum-norm solutions.
//!
//! Of many unknowns, where the pivots leave no doubt that all rows are independent, they are sums of the rows, which costs as much as
//! there are entries; elsewhere all of the matrix is decomposed.

use super::entries::Entries;
use super::orthogonal::Orthogonal;
use super::sparse_qr::{SPARSE, SparseQr};

/// Rows are clearly independent if their weakest direction is above this part of the strongest pivot: products of rows by rows then
/// leave ten digits.
const CLEARLY: f64 = 1e-3;

/// A matrix, ready to be solved with.
#[derive(Clone, Debug)]
pub struct Shortest(Factored);

#[derive(Clone, Debug)]
enum Factored {
    Rows { rows: Vec<Entries>, of_rows: SparseQr },
    All(Orthogonal),
}

impl Shortest {
    /// Decomposes the row-major `rows` x `columns` matrix. Directions whose pivot is below `tolerance` times the first pivot count as
    /// null.
    pub fn new(matrix: &[f64], rows: usize, columns: usize, tolerance: f64) -> Self {
        let sparse = (columns >= SPARSE && rows <= columns).then(|| of_rows(matrix, columns)).flatten();
        Self(sparse.unwrap_or_else(|| {
            let mut all = Orthogonal::new(rows, columns);
            all.factor(matrix, rows, columns, tolerance);
            Factored::All(all)
        }))
    }

    /// The shortest `x` that minimises |A x - b|; `b` has `rows` entries, `x` has `columns`. Of sums of rows it has ten digits: once
    /// more with the residual gives the others.
    pub fn solve(&mut self, b: &[f64], x: &mut [f64]) {
        match &mut self.0 {
            Factored::All(all) => all.solve(b, x),
            Factored::Rows { rows, of_rows } => {
                x.fill(0.0);
                for (row, amount) in rows.iter().zip(of_rows.solve_normal(b)) {
                    row.iter().for_each(|(place, entry)| x[*place] += amount * entry);
                }
            }
        }
    }
}

fn of_rows(matrix: &[f64], columns: usize) -> Option<Factored> {
    let entries = |row: &[f64]| -> Entries {
        row.iter().copied().enumerate().filter(|(_, entry)| *entry != 0.0).collect()
    };
    let rows: Vec<Entries> = matrix.chunks_exact(columns).map(entries).collect();
    let of_rows = SparseQr::new(columns, rows.clone());
    let largest = super::largest(of_rows.pivots());
    let is_clear = largest.is_finite() && !rows.is_empty() && of_rows.weakest(rows.len()) > CLEARLY * largest;
    is_clear.then_some(Factored::Rows { rows, of_rows })
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
            matches!(shortest.0, Factored::Rows { .. })
        };
        assert!(solved_both(&matrix));
        // A row that repeats another leaves the rank in doubt.
        matrix.copy_within(0..columns, columns);
        assert!(!solved_both(&matrix));
        matrix[5] = f64::NAN;
        assert!(matches!(Shortest::new(&matrix, rows, columns, 1e-10).0, Factored::All(_)));
    }
}
