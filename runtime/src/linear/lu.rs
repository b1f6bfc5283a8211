//! LU with partial pivoting of a square matrix: Newton systems of implicit integrators.
//! In: a row-major matrix. Out: solutions, and whether the matrix is singular to working precision.

use super::vector::{add_scaled, dot};

/// LU factors of a square matrix of fixed size.
#[derive(Clone, Debug)]
pub struct Lu {
    size: usize,
    factors: Vec<f64>,
    order: Vec<usize>,
    work: Vec<f64>,
}

impl Lu {
    /// Storage for matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        Self { size, factors: vec![0.0; size * size], order: vec![0; size], work: vec![0.0; size] }
    }

    /// Factors a row-major matrix. Returns the smallest pivot over the largest (0 or NaN: singular).
    pub fn factor(&mut self, matrix: &[f64]) -> f64 {
        let n = self.size;
        self.factors.copy_from_slice(&matrix[..n * n]);
        let (mut smallest, mut most) = (f64::INFINITY, 0.0_f64);
        for (i, place) in self.order.iter_mut().enumerate() {
            *place = i;
        }
        for k in 0..n {
            let mut best = k;
            for i in k + 1..n {
                if self.factors[i * n + k].abs() > self.factors[best * n + k].abs() {
                    best = i;
                }
            }
            if best != k {
                self.order.swap(best, k);
                for j in 0..n {
                    self.factors.swap(best * n + j, k * n + j);
                }
            }
            let pivot = self.factors[k * n + k];
            if pivot == 0.0 || pivot.is_nan() {
                return pivot;
            }
            smallest = smallest.min(pivot.abs());
            most = most.max(pivot.abs());
            let (above, below) = self.factors.split_at_mut((k + 1) * n);
            let pivot_row = &above[k * n..];
            for row in below.chunks_exact_mut(n) {
                let factor = row[k] / pivot;
                row[k] = factor;
                if factor != 0.0 {
                    add_scaled(&mut row[k + 1..], -factor, &pivot_row[k + 1..]);
                }
            }
        }
        if n == 0 { 1.0 } else { smallest / most }
    }

    /// Solves in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        let n = self.size;
        for (value, place) in self.work.iter_mut().zip(&self.order) {
            *value = b[*place];
        }
        for i in 0..n {
            self.work[i] -= dot(&self.factors[i * n..][..i], &self.work[..i]);
        }
        for i in (0..n).rev() {
            let row = &self.factors[i * n..][..n];
            self.work[i] = (self.work[i] - dot(&row[i + 1..], &self.work[i + 1..])) / row[i];
        }
        b[..n].copy_from_slice(&self.work);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn system_with_zero_diagonal_is_solved() {
        let a = [0.0, 2.0, 1.0, 1.0, 0.0, -1.0, 3.0, 1.0, 0.0];
        let mut factors = Lu::new(3);
        assert!(factors.factor(&a) > 0.1);
        let mut x = [1.0, 2.0, 3.0];
        factors.solve(&mut x);
        for (i, wanted) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            // A handful of operations on numbers of order 3.
            assert!((dot(&a[3 * i..][..3], &x) - wanted).abs() < 1e-14);
        }
    }

    #[test]
    fn singular_matrix_is_told() {
        assert_eq!(Lu::new(2).factor(&[1.0, 2.0, 2.0, 4.0]), 0.0);
    }
}
