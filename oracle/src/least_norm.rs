//! Least-norm solutions of rank-deficient systems by singular values.
//! In: rows and right-hand side. Out: solution, multipliers, rank. Never knows mechanics.

use nalgebra::{DMatrix, DVector};

/// A factorised matrix of rows; small singular values are left out.
#[derive(Clone, Debug)]
pub(crate) struct LeastNorm {
    left: DMatrix<f64>,
    right: DMatrix<f64>,
    kept: DVector<f64>,
    /// Length of each row before it was scaled to 1.
    lengths: DVector<f64>,
    /// Largest singular value that was left out.
    pub dropped: f64,
}

impl LeastNorm {
    /// Factorises `matrix`, rows scaled to length 1, without singular values below `tolerance` times the
    /// largest.
    pub fn new(mut matrix: DMatrix<f64>, tolerance: f64) -> Self {
        let lengths = DVector::from_iterator(matrix.nrows(), matrix.row_iter().map(|row| row.norm()));
        for (mut row, length) in matrix.row_iter_mut().zip(lengths.iter()) {
            row /= length.max(f64::MIN_POSITIVE);
        }
        if matrix.is_empty() {
            let (m, n) = matrix.shape();
            let kept = DVector::zeros(0);
            return Self {
                left: DMatrix::zeros(m, 0),
                right: DMatrix::zeros(n, 0),
                kept,
                lengths,
                dropped: 0.0,
            };
        }
        let svd = matrix.svd(true, true);
        let (Some(u), Some(v_t)) = (&svd.u, &svd.v_t) else {
            unreachable!("both factors were asked for");
        };
        let bound = tolerance * svd.singular_values.max();
        let rank = svd.singular_values.iter().filter(|s| **s > bound).count();
        // `svd` sorts singular values from large to small.
        Self {
            left: u.columns(0, rank).into_owned(),
            right: v_t.rows(0, rank).transpose(),
            kept: svd.singular_values.rows(0, rank).into_owned(),
            dropped: svd.singular_values.get(rank).copied().unwrap_or(0.0),
            lengths,
        }
    }

    pub fn rank(&self) -> usize {
        self.kept.len()
    }

    /// Smallest singular value that was kept, the largest being about 1; infinity without rows.
    pub fn smallest(&self) -> f64 {
        self.kept.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The shortest `y` with `matrix y = rhs`, in the sense of least squares.
    pub fn solve(&self, rhs: &DVector<f64>) -> DVector<f64> {
        let scaled = rhs.zip_map(&self.lengths, |r, length| r / length.max(f64::MIN_POSITIVE));
        &self.right * (self.left.transpose() * scaled).component_div(&self.kept)
    }

    /// Multipliers with `matrixᵀ lambda = y`; those of scaled rows are the shortest.
    pub fn multipliers(&self, y: &DVector<f64>) -> DVector<f64> {
        let scaled = &self.left * (self.right.transpose() * y).component_div(&self.kept);
        scaled.zip_map(&self.lengths, |l, length| l / length.max(f64::MIN_POSITIVE))
    }

    /// How much of the multiplier combination `weights . lambda` is left to choice: zero if it is the same
    /// for all multipliers that solve the system; relative to the length of `weights`.
    pub fn freedom(&self, weights: &DVector<f64>) -> f64 {
        let scaled = weights.component_div(&self.lengths);
        let length = scaled.norm();
        if length == 0.0 {
            return 0.0;
        }
        let fixed = &self.left * (self.left.transpose() * &scaled);
        (scaled - fixed).norm() / length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_rows_are_found_and_the_system_still_solved() {
        // Third row = first + second; fifth = 2 * first.
        let rows = [[1.0, 2.0, 0.5, -1.0], [0.0, 1.0, 3.0, 1.0], [1.0, 3.0, 3.5, 0.0], [2.0, 0.0, 1.0, 1.0]];
        let matrix = DMatrix::from_fn(5, 4, |i, j| if i < 4 { rows[i][j] } else { 2.0 * rows[0][j] });
        let solved = LeastNorm::new(matrix.clone(), 1e-9);
        assert_eq!(solved.rank(), 3);
        let x = DVector::from_vec(vec![0.3, -1.0, 2.0, 0.7]);
        let rhs = &matrix * &x;
        let y = solved.solve(&rhs);
        // Well-conditioned numbers of order 1: some ten rounding errors.
        assert!((&matrix * &y - rhs).norm() < 1e-13);
        assert!((matrix.transpose() * solved.multipliers(&y) - &y).norm() < 1e-13);
        // Row 4 stands alone, so its multiplier is unique; row 1's is not.
        let unit = |k: usize| DVector::from_fn(5, |i, _| f64::from(u8::from(i == k)));
        assert!(solved.freedom(&unit(3)) < 1e-13);
        assert!(solved.freedom(&unit(0)) > 0.1);
    }
}
