//! LDLᵀ of a matrix times its transpose, without pivoting, in slices of the caller. In: rows. Out: factors, pivots, solutions.

use super::vector::{add_scaled, dot};

/// Factors `A Aᵀ` for the row-major matrix `a` of `work.len()` rows into the lower triangle of `factors`. Returns the smallest pivot
/// over the largest: about the square of the ratio of singular values, 0 or less (or NaN) if rank is lost.
///
/// # Panics
/// If a slice is shorter than that.
pub fn factor_gram(factors: &mut [f64], work: &mut [f64], a: &[f64], columns: usize) -> f64 {
    let n = work.len();
    for i in 0..n {
        for j in 0..=i {
            let (row, column) = (&a[i * columns..][..columns], &a[j * columns..][..columns]);
            factors[i * n + j] = dot(row, column);
        }
    }
    let (mut smallest, mut most) = (f64::INFINITY, 0.0_f64);
    for i in 0..n {
        // work[j] = L_ij d_j while row i is being made; then L_ij.
        for j in 0..i {
            let (rows_before, rows_from) = factors.split_at(i * n);
            let value = rows_from[j] - dot(&work[..j], &rows_before[j * n..][..j]);
            work[j] = value;
        }
        let mut pivot = factors[i * n + i];
        for j in 0..i {
            let scaled = work[j] / factors[j * n + j];
            pivot -= scaled * work[j];
            factors[i * n + j] = scaled;
        }
        factors[i * n + i] = pivot;
        if pivot.is_nan() {
            return f64::NAN;
        }
        smallest = smallest.min(pivot);
        most = most.max(pivot);
    }
    if n == 0 { 1.0 } else { smallest / most }
}

/// Solves in place, with factors of [`factor_gram`].
///
/// # Panics
/// If there are fewer factors than the square of `b`.
pub fn solve_gram(factors: &[f64], b: &mut [f64]) {
    let n = b.len();
    for i in 0..n {
        b[i] -= dot(&factors[i * n..][..i], &b[..i]);
    }
    for (i, value) in b.iter_mut().enumerate() {
        *value /= factors[i * n + i];
    }
    for i in (0..n).rev() {
        let (before, from) = b.split_at_mut(i);
        add_scaled(before, -from[0], &factors[i * n..][..i]);
    }
}
