//! LDLᵀ of a symmetric positive definite matrix, without pivoting: the fast path of projections.
//! In: the lower triangle. Out: solutions, and the pivots that tell how far the result can be trusted.

use super::vector::{add_scaled, dot};

/// LDLᵀ factors of a matrix of fixed size.
#[derive(Clone, Debug)]
pub struct Cholesky {
    size: usize,
    factors: Vec<f64>,
    work: Vec<f64>,
}

impl Cholesky {
    /// Storage for matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        Self { size, factors: vec![0.0; size * size], work: vec![0.0; size] }
    }

    /// Factors `A Aᵀ` for the `size` x `columns` row-major matrix `a`. Returns the smallest pivot over
    /// the largest: about the square of the ratio of singular values, 0 or less (or NaN) if rank is lost.
    pub fn factor_gram(&mut self, a: &[f64], columns: usize) -> f64 {
        let n = self.size;
        for i in 0..n {
            for j in 0..=i {
                let (row, column) = (&a[i * columns..][..columns], &a[j * columns..][..columns]);
                self.factors[i * n + j] = dot(row, column);
            }
        }
        self.factor_in_place()
    }

    fn factor_in_place(&mut self) -> f64 {
        let n = self.size;
        let (mut smallest, mut most) = (f64::INFINITY, 0.0_f64);
        for i in 0..n {
            // work[j] = L_ij d_j while row i is being made; then L_ij.
            for j in 0..i {
                let (rows_before, rows_from) = self.factors.split_at(i * n);
                let value = rows_from[j] - dot(&self.work[..j], &rows_before[j * n..][..j]);
                self.work[j] = value;
            }
            let mut pivot = self.factors[i * n + i];
            for j in 0..i {
                let scaled = self.work[j] / self.factors[j * n + j];
                pivot -= scaled * self.work[j];
                self.factors[i * n + j] = scaled;
            }
            self.factors[i * n + i] = pivot;
            if pivot.is_nan() {
                return f64::NAN;
            }
            smallest = smallest.min(pivot);
            most = most.max(pivot);
        }
        if n == 0 { 1.0 } else { smallest / most }
    }

    /// Solves in place.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.size;
        for i in 0..n {
            b[i] -= dot(&self.factors[i * n..][..i], &b[..i]);
        }
        for (i, value) in b.iter_mut().enumerate().take(n) {
            *value /= self.factors[i * n + i];
        }
        for i in (0..n).rev() {
            let (before, from) = b.split_at_mut(i);
            add_scaled(before, -from[0], &self.factors[i * n..][..i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gram_system_is_solved() {
        let a = [1.0, 2.0, 0.0, -1.0, 0.5, 3.0, 2.0, 2.0, 1.0, 1.0, -2.0, 0.25];
        let mut factors = Cholesky::new(3);
        assert!(factors.factor_gram(&a, 4) > 1e-3);
        let mut x = [1.0, -2.0, 0.5];
        factors.solve(&mut x);
        for (i, wanted) in [1.0, -2.0, 0.5].into_iter().enumerate() {
            let value: f64 = (0..3).map(|j| dot(&a[4 * i..][..4], &a[4 * j..][..4]) * x[j]).sum();
            // Entries of order 10, condition below 100.
            assert!((value - wanted).abs() < 1e-13);
        }
    }

    #[test]
    fn lost_rank_shows_in_the_pivots() {
        let a = [1.0, 2.0, 3.0, 2.0, 4.0, 6.0];
        assert!(Cholesky::new(2).factor_gram(&a, 3) < 1e-15);
    }
}
