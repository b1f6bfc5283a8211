//! What sensitivities can tell apart. In: a matrix of sensitivities. Out: its directions, known and unknown. Never knows where it
//! is from.

use nalgebra::{DMatrix, DVector};

/// Right singular vectors of sensitivities, by falling singular value.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    pub singular: Vec<f64>,
    /// A direction a column.
    pub vectors: DMatrix<f64>,
}

/// Smallest singular value that is divided by, as a part of the largest.
const LEAST: f64 = 1e-12;

impl Directions {
    /// Of sensitivities whose columns are known up to parts `doubt` of themselves; what is less than that is nothing.
    pub fn of(slopes: &DMatrix<f64>, doubt: &[f64]) -> Self {
        let size = slopes.ncols();
        if size == 0 {
            return Self { singular: Vec::new(), vectors: DMatrix::zeros(0, 0) };
        }
        let triangle = if slopes.nrows() >= size { slopes.clone().qr().r() } else { slopes.clone() };
        let svd = triangle.svd(false, true);
        let errors: Vec<f64> =
            slopes.column_iter().zip(doubt).map(|(column, doubt)| doubt * column.norm()).collect();
        let rows = svd.v_t.unwrap_or_else(|| DMatrix::identity(size, size));
        let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
        order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
        let mut singular = Vec::new();
        let mut vectors = DMatrix::zeros(size, order.len());
        for (to, from) in order.into_iter().enumerate() {
            let error: f64 = rows.row(from).iter().zip(&errors).map(|(part, error)| part.abs() * error).sum();
            let value = svd.singular_values[from];
            singular.push(if value > error { value } else { 0.0 });
            // A direction has no sign: its largest part is positive.
            let mut vector = DVector::from_iterator(size, rows.row(from).iter().copied());
            if vector[vector.iamax()] < 0.0 {
                vector.neg_mut();
            }
            vectors.set_column(to, &vector);
        }
        Self { singular, vectors }
    }

    /// Inverse of the normal matrix; a direction that is not known at all gets an error that nothing passes.
    pub fn inverse(&self) -> DMatrix<f64> {
        let largest = self.singular.first().copied().unwrap_or(0.0);
        let least = (LEAST * largest).max(f64::MIN_POSITIVE.sqrt());
        let weights =
            DVector::from_iterator(self.singular.len(), self.singular.iter().map(|s| s.max(least).powi(-2)));
        &self.vectors * DMatrix::from_diagonal(&weights) * self.vectors.transpose()
    }
}

/// The columns of some parameters without what those of others can do in their place.
pub(super) fn apart_from(slopes: &DMatrix<f64>, own: &[usize], others: &[usize]) -> DMatrix<f64> {
    let mine = slopes.select_columns(own);
    if others.is_empty() {
        return mine;
    }
    let q = slopes.select_columns(others).qr().q();
    &mine - &q * q.tr_mul(&mine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_columns_leave_their_difference_unknown() {
        let slopes = DMatrix::from_row_slice(3, 2, &[1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
        let directions = Directions::of(&slopes, &[1e-9, 1e-9]);
        // sqrt(2 (1 + 4 + 9)) along (1, 1) / sqrt 2.
        assert!((directions.singular[0] - 28.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(directions.singular[1], 0.0);
        assert!((directions.vectors[(0, 0)] - 0.5_f64.sqrt()).abs() < 1e-12);
        assert!((directions.vectors[(0, 1)] + directions.vectors[(1, 1)]).abs() < 1e-12);
        assert!(directions.inverse()[(0, 0)] > 1e20);
    }

    #[test]
    fn the_inverse_is_that_of_the_normal_matrix() {
        let slopes = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.0, 2.0, 0.0, 1.0]);
        let inverse = Directions::of(&slopes, &[0.0, 0.0]).inverse();
        assert!((inverse[(0, 0)] - 1.0).abs() < 1e-14 && (inverse[(1, 1)] - 0.2).abs() < 1e-14);
        let rest = apart_from(&DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 0.0, 1.0]), &[1], &[0]);
        assert!(rest[(0, 0)].abs() < 1e-15 && (rest[(1, 0)] - 1.0).abs() < 1e-15);
    }
}
