//! Singular values and eigenvalues of matrices that may hold anything. In: matrices. Out: their decomposition, or nothing.
//!
//! The search does not end for numbers that are infinite or none: it is asked here alone, and only where all are finite.

use nalgebra::{DMatrix, DVector, Dyn, SVD, SymmetricEigen};

/// Whether all numbers are finite.
fn is_finite(matrix: &DMatrix<f64>) -> bool {
    matrix.iter().all(|value| value.is_finite())
}

/// The largest first, as many as the shorter side is long.
pub fn singular_values(matrix: &DMatrix<f64>) -> Option<DVector<f64>> {
    is_finite(matrix).then(|| if matrix.is_empty() { DVector::zeros(0) } else { matrix.singular_values() })
}

/// With right singular vectors, and left ones if asked for.
pub fn singular_directions(matrix: DMatrix<f64>, left: bool) -> Option<SVD<f64, Dyn, Dyn>> {
    is_finite(&matrix).then(|| matrix.svd(left, true))
}

/// Eigenvalues and directions of a symmetric matrix.
pub fn symmetric_directions(matrix: DMatrix<f64>) -> Option<SymmetricEigen<f64, Dyn>> {
    is_finite(&matrix).then(|| matrix.symmetric_eigen())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_none_have_no_decomposition() {
        for odd in [f64::NAN, f64::INFINITY] {
            let given = DMatrix::from_row_slice(2, 2, &[1.0, odd, odd, 3.0]);
            assert!(!is_finite(&given) && singular_values(&given).is_none());
            assert!(singular_directions(given.clone(), true).is_none());
            assert!(symmetric_directions(given).is_none());
        }
        assert_eq!(singular_values(&DMatrix::zeros(0, 3)), Some(DVector::zeros(0)));
    }
}
