//! Least-norm solutions of rank-deficient systems by singular values.
//! In: rows and right-hand side. Out: solution, multipliers, rank. Never knows mechanics.

use nalgebra::{DMatrix, DVector};

/// Sweeps of Jacobi turns; six to ten are enough, the rest is a guard.
const MAX_SWEEPS: usize = 60;

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
        let (columns, turns) = orthogonalised(matrix.transpose());
        let values: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
        let bound = tolerance * values.iter().copied().fold(0.0, f64::max);
        let (kept, dropped): (Vec<usize>, Vec<usize>) = (0..values.len()).partition(|k| values[*k] > bound);
        let mut right = columns.select_columns(&kept);
        for (mut column, k) in right.column_iter_mut().zip(&kept) {
            column /= values[*k];
        }
        Self {
            left: turns.select_columns(&kept),
            right,
            dropped: dropped.iter().fold(0.0, |top, k| f64::max(top, values[*k])),
            kept: DVector::from_iterator(kept.len(), kept.iter().map(|k| values[*k])),
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

/// Turns the columns of `a` into each other until they stand at right angles (one-sided Jacobi: Hestenes
/// 1958, Demmel and Veselic 1992). Returns `a * turns` and the orthogonal `turns`. Chosen for its accuracy:
/// singular values and vectors come out to a few rounding errors.
fn orthogonalised(mut a: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let count = a.ncols();
    let mut turns = DMatrix::identity(count, count);
    // Columns this small are what rounding leaves of dependent ones; their angles mean nothing.
    let dust = 1e-15 * a.norm();
    for _ in 0..MAX_SWEEPS {
        let mut turned = false;
        for i in 0..count {
            for j in i + 1..count {
                let (p, q) = (a.column(i), a.column(j));
                let (pp, qq, pq) = (p.norm_squared(), q.norm_squared(), p.dot(&q));
                let bound = f64::EPSILON * (pp * qq).sqrt();
                // Not a number ends the sweeps too: it shows in the result.
                if pp.min(qq).sqrt() <= dust || pq.abs() <= bound || pq.is_nan() {
                    continue;
                }
                turned = true;
                let zeta = (qq - pp) / (2.0 * pq);
                let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                turn(&mut a, i, j, cosine, tangent * cosine);
                turn(&mut turns, i, j, cosine, tangent * cosine);
            }
        }
        if !turned {
            break;
        }
    }
    (a, turns)
}

/// Columns `i` and `j` become `c p - s q` and `s p + c q`.
fn turn(a: &mut DMatrix<f64>, i: usize, j: usize, c: f64, s: f64) {
    let (mut p, mut q) = a.columns_range_pair_mut(i, j);
    for (x, y) in p.iter_mut().zip(q.iter_mut()) {
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
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
