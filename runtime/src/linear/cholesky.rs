//! LDLᵀ of a symmetric positive definite matrix, without pivoting: the fast path of projections.
//! In: the lower triangle. Out: solutions, and the pivots that tell how far the result can be trusted.

use super::gram::{factor_gram, solve_gram};

/// LDLᵀ factors of a matrix of fixed size.
#[derive(Clone, Debug)]
pub struct Cholesky {
    factors: Vec<f64>,
    work: Vec<f64>,
}

impl Cholesky {
    /// Storage for matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        Self { factors: vec![0.0; size * size], work: vec![0.0; size] }
    }

    /// As [`factor_gram`], for the `size` x `columns` row-major matrix `a`.
    pub fn factor_gram(&mut self, a: &[f64], columns: usize) -> f64 {
        factor_gram(&mut self.factors, &mut self.work, a, columns)
    }

    /// Solves in place.
    pub fn solve(&self, b: &mut [f64]) {
        solve_gram(&self.factors, &mut b[..self.work.len()]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::vector::dot;
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
