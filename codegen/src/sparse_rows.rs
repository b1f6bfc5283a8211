//! Matrices that are mostly zeros, by rows: Jacobians of long mechanisms have some ten entries in a row of hundreds.
//! In: entries. Out: rows, products, parts. Never knows what a row stands for.

use linkwear_runtime::linear::{Entries, entries_of, largest_entry, length};
use nalgebra::{DMatrix, DVector};

/// A matrix as its rows, without their zeros.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseRows {
    columns: usize,
    rows: Vec<Entries>,
}

impl SparseRows {
    /// Of rows that hold columns and entries, columns ascending and below `columns`; zeros are left out.
    pub fn new(columns: usize, mut rows: Vec<Entries>) -> Self {
        rows.iter_mut().for_each(|row| row.retain(|(_, entry)| *entry != 0.0));
        Self { columns, rows }
    }

    /// Of all entries, row by row.
    pub fn from_entries(columns: usize, entries: &[f64]) -> Self {
        Self { columns, rows: entries.chunks_exact(columns.max(1)).map(entries_of).collect() }
    }

    /// One row for each of the columns, with nothing but 1 there.
    pub fn units(columns: usize, of: &[usize]) -> Self {
        Self { columns, rows: of.iter().map(|column| vec![(*column, 1.0)]).collect() }
    }

    /// Number of rows.
    pub fn nrows(&self) -> usize {
        self.rows.len()
    }

    /// Number of columns.
    pub fn ncols(&self) -> usize {
        self.columns
    }

    /// Columns and entries of a row, columns ascending, without zeros.
    pub fn row(&self, row: usize) -> &[(usize, f64)] {
        &self.rows[row]
    }

    /// The rows that are not all zero.
    pub fn rows_that_say_something(&self) -> Vec<usize> {
        (0..self.rows.len()).filter(|row| !self.rows[*row].is_empty()).collect()
    }

    /// Euclidean length of a row.
    pub fn length(&self, row: usize) -> f64 {
        length(&self.rows[row])
    }

    /// Largest magnitude of a row.
    pub fn largest(&self, row: usize) -> f64 {
        largest_entry(&self.rows[row])
    }

    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.rows.iter().flatten().all(|(_, entry)| entry.is_finite())
    }

    /// Some rows, in the order asked for.
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        Self { columns: self.columns, rows: rows.iter().map(|row| self.rows[*row].clone()).collect() }
    }

    /// Some columns, in the order asked for.
    pub fn select_columns(&self, columns: &[usize]) -> Self {
        let mut place = vec![None; self.columns];
        columns.iter().enumerate().for_each(|(at, column)| place[*column] = Some(at));
        let ascending = columns.is_sorted();
        let chosen = |row: &Entries| {
            let mut chosen: Entries =
                row.iter().filter_map(|(column, entry)| Some((place[*column]?, *entry))).collect();
            if !ascending {
                chosen.sort_unstable_by_key(|(column, _)| *column);
            }
            chosen
        };
        Self { columns: columns.len(), rows: self.rows.iter().map(chosen).collect() }
    }

    /// Puts a vector in the place of a row.
    pub fn set_row(&mut self, row: usize, vector: &DVector<f64>) {
        self.rows[row] = entries_of(vector.as_slice());
    }

    /// Rows and columns change places.
    pub fn transpose(&self) -> Self {
        let mut rows = vec![Vec::new(); self.columns];
        for (at, row) in self.rows.iter().enumerate() {
            row.iter().for_each(|(column, entry)| rows[*column].push((at, *entry)));
        }
        Self { columns: self.rows.len(), rows }
    }

    /// The rows of another matrix of as many columns below.
    pub fn stack(&self, below: &Self) -> Self {
        Self { columns: self.columns, rows: [&self.rows[..], &below.rows].concat() }
    }

    /// Every entry times a factor of its row and column.
    pub fn scaled(mut self, factor: impl Fn(usize, usize) -> f64) -> Self {
        for (at, row) in self.rows.iter_mut().enumerate() {
            row.iter_mut().for_each(|(column, entry)| *entry *= factor(at, *column));
        }
        // What is too small for a number is zero then.
        Self::new(self.columns, self.rows)
    }

    /// The same with nothing left of rows whose entries are all below a magnitude.
    pub fn without_rows_below(mut self, magnitude: f64) -> Self {
        for row in &mut self.rows {
            if row.iter().all(|(_, entry)| entry.abs() < magnitude) {
                row.clear();
            }
        }
        self
    }

    /// The matrix times a vector.
    pub fn times(&self, vector: &DVector<f64>) -> DVector<f64> {
        let along = |row: &Entries| row.iter().map(|(column, entry)| entry * vector[*column]).sum();
        DVector::from_iterator(self.rows.len(), self.rows.iter().map(along))
    }

    /// The transpose times a vector.
    pub fn transposed_times(&self, vector: &DVector<f64>) -> DVector<f64> {
        let mut product = DVector::zeros(self.columns);
        for (row, amount) in self.rows.iter().zip(vector.iter()) {
            row.iter().for_each(|(column, entry)| product[*column] += entry * amount);
        }
        product
    }

    /// With its zeros.
    pub fn dense(&self) -> DMatrix<f64> {
        let mut dense = DMatrix::zeros(self.rows.len(), self.columns);
        for (at, row) in self.rows.iter().enumerate() {
            row.iter().for_each(|(column, entry)| dense[(at, *column)] = *entry);
        }
        dense
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_and_products_are_those_of_the_whole_matrix() {
        let entries = [0.0, 2.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, f64::MIN_POSITIVE, 4.0];
        let (sparse, dense) =
            (SparseRows::from_entries(4, &entries), DMatrix::from_row_slice(3, 4, &entries));
        assert_eq!(sparse.dense(), dense);
        assert_eq!((sparse.rows_that_say_something(), sparse.row(1).len()), (vec![0, 2], 0));
        assert_eq!(sparse.transpose().dense(), dense.transpose());
        for columns in [&[1, 3][..], &[3, 0, 1]] {
            let chosen = sparse.select_columns(columns);
            assert_eq!(chosen.dense(), dense.select_columns(columns));
            assert!(chosen.rows.iter().all(|row| row.is_sorted_by_key(|(column, _)| *column)));
        }
        assert_eq!(sparse.select_rows(&[2, 0]).dense(), dense.select_rows(&[2, 0]));
        let stacked = sparse.stack(&SparseRows::units(4, &[2]));
        assert_eq!((stacked.nrows(), stacked.row(3)), (4, &[(2, 1.0)][..]));
        let (right, left) =
            (DVector::from_vec(vec![1.0, 2.0, 3.0, 4.0]), DVector::from_vec(vec![5.0, 6.0, 7.0]));
        assert_eq!(sparse.times(&right), &dense * &right);
        assert_eq!(sparse.transposed_times(&left), dense.tr_mul(&left));
        assert_eq!((sparse.length(0), sparse.largest(2)), (5.0_f64.sqrt(), 4.0));
        let mut changed = sparse.clone();
        changed.set_row(0, &right);
        assert_eq!(changed.dense().row(0), right.transpose());
        // What becomes zero is left out.
        assert_eq!(
            sparse.scaled(|_, column| if column == 2 { 0.1 } else { 0.0 }).row(2),
            &[(2, f64::MIN_POSITIVE * 0.1)][..]
        );
        assert!(!SparseRows::from_entries(1, &[f64::NAN]).is_finite());
    }
}
