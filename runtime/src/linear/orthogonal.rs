//! Complete orthogonal decomposition: rank-revealing, minimum-norm least squares, null space.
//! In: a row-major matrix and a rank tolerance. Out: solutions of `A x = b` and `Aᵀ y = c`, null space.
//!
//! `A P = Q [T 0; 0 0] Z`: Householder QR with column pivoting (Golub & Van Loan, Matrix Computations,
//! 4th ed., 5.4.2), then reflections from the right (5.4.7).

use super::vector::dot;

/// Decomposition of a matrix of at most the size it was made for.
#[derive(Clone, Debug)]
pub struct Orthogonal {
    rows: usize,
    columns: usize,
    rank: usize,
    /// Column major; Householder vectors below the diagonal, `T` above, right vectors beside `T`.
    entries: Vec<f64>,
    left: Vec<f64>,
    right: Vec<f64>,
    order: Vec<usize>,
    norms: Vec<f64>,
    work: Vec<f64>,
}

impl Orthogonal {
    /// Storage for matrices of up to `rows` x `columns`.
    pub fn new(rows: usize, columns: usize) -> Self {
        let least = rows.min(columns);
        Self {
            rows,
            columns,
            rank: 0,
            entries: vec![0.0; rows * columns],
            left: vec![0.0; least],
            right: vec![0.0; least],
            order: vec![0; columns],
            norms: vec![0.0; columns],
            work: vec![0.0; rows.max(columns)],
        }
    }

    /// Decomposes the row-major `rows` x `columns` matrix. Directions whose pivot is below `tolerance`
    /// times the first pivot count as null.
    ///
    /// # Panics
    /// If the matrix is larger than the storage.
    pub fn factor(&mut self, matrix: &[f64], rows: usize, columns: usize, tolerance: f64) {
        (self.rows, self.columns) = (rows, columns);
        for j in 0..columns {
            self.order[j] = j;
            for i in 0..rows {
                self.entries[j * rows + i] = matrix[i * columns + j];
            }
        }
        self.rank = self.reduce_columns(tolerance);
        self.reduce_rows();
    }

    /// Number of directions that are not null.
    pub fn rank(&self) -> usize {
        self.rank
    }

    fn reduce_columns(&mut self, tolerance: f64) -> usize {
        let (m, n) = (self.rows, self.columns);
        let mut first_pivot = 0.0;
        for k in 0..m.min(n) {
            // Norms are computed afresh: as much work as the reflections, but no cancellation to watch.
            for j in k..n {
                let tail = &self.entries[j * m + k..(j + 1) * m];
                self.norms[j] = dot(tail, tail).sqrt();
            }
            let best = (k..n).fold(k, |best, j| if self.norms[j] > self.norms[best] { j } else { best });
            let norm = self.norms[best];
            if k == 0 {
                first_pivot = norm;
            }
            // Written so that NaN ends the loop too.
            if !(norm > tolerance * first_pivot && norm > 0.0) {
                return k;
            }
            if best != k {
                self.order.swap(best, k);
                for i in 0..m {
                    self.entries.swap(best * m + i, k * m + i);
                }
            }
            self.reflect_column(k, norm);
        }
        m.min(n)
    }

    fn reflect_column(&mut self, k: usize, norm: f64) {
        let m = self.rows;
        let (before, after) = self.entries.split_at_mut((k + 1) * m);
        let column = &mut before[k * m + k..];
        let head = if column[0] > 0.0 { -norm } else { norm };
        let lead = column[0] - head;
        self.left[k] = -lead / head;
        column[0] = head;
        for x in &mut column[1..] {
            *x /= lead;
        }
        let vector = &column[1..];
        for other in after.chunks_exact_mut(m).take(self.columns - k - 1) {
            let (top, tail) = other[k..].split_at_mut(1);
            let amount = self.left[k] * (top[0] + dot(vector, tail));
            // Columns of loops in a row have little in common.
            if amount != 0.0 {
                top[0] -= amount;
                super::add_scaled(tail, -amount, vector);
            }
        }
    }

    fn reduce_rows(&mut self) {
        let (m, n, r) = (self.rows, self.columns, self.rank);
        for i in (0..r).rev() {
            let tail_square: f64 = (r..n).map(|j| self.entries[j * m + i] * self.entries[j * m + i]).sum();
            if tail_square == 0.0 {
                self.right[i] = 0.0;
                continue;
            }
            let diagonal = self.entries[i * m + i];
            let norm = (diagonal * diagonal + tail_square).sqrt();
            let head = if diagonal > 0.0 { -norm } else { norm };
            let lead = diagonal - head;
            self.right[i] = -lead / head;
            self.entries[i * m + i] = head;
            for j in r..n {
                self.entries[j * m + i] /= lead;
            }
            for row in 0..i {
                let mut amount = self.entries[i * m + row];
                for j in r..n {
                    amount += self.entries[j * m + i] * self.entries[j * m + row];
                }
                amount *= self.right[i];
                self.entries[i * m + row] -= amount;
                for j in r..n {
                    self.entries[j * m + row] -= amount * self.entries[j * m + i];
                }
            }
        }
    }

    fn apply_left(&self, k: usize, x: &mut [f64]) {
        let m = self.rows;
        let vector = &self.entries[k * m + k + 1..(k + 1) * m];
        let amount = self.left[k] * (x[k] + dot(vector, &x[k + 1..m]));
        x[k] -= amount;
        super::add_scaled(&mut x[k + 1..m], -amount, vector);
    }

    fn apply_right(&self, i: usize, x: &mut [f64]) {
        let (m, n, r) = (self.rows, self.columns, self.rank);
        let vector = |j: usize| self.entries[j * m + i];
        let (head, tail) = x.split_at_mut(r);
        let mut amount = head[i];
        for (j, value) in (r..n).zip(tail.iter()) {
            amount += vector(j) * value;
        }
        amount *= self.right[i];
        head[i] -= amount;
        for (j, value) in (r..n).zip(tail) {
            *value -= amount * vector(j);
        }
    }

    /// Back to the caller's order of columns, from `work`.
    fn unpermute(&mut self, x: &mut [f64]) {
        for (value, place) in self.work.iter().zip(&self.order[..self.columns]) {
            x[*place] = *value;
        }
    }

    /// The shortest `x` that minimises |A x - b|; `b` has `rows` entries, `x` has `columns`.
    pub fn solve(&mut self, b: &[f64], x: &mut [f64]) {
        let (m, r) = (self.rows, self.rank);
        let mut work = core::mem::take(&mut self.work);
        work[..m].copy_from_slice(&b[..m]);
        for k in 0..r {
            self.apply_left(k, &mut work);
        }
        for i in (0..r).rev() {
            let sum: f64 = (i + 1..r).map(|j| self.entries[j * m + i] * work[j]).sum();
            work[i] = (work[i] - sum) / self.entries[i * m + i];
        }
        work[r..].fill(0.0);
        for i in 0..r {
            self.apply_right(i, &mut work);
        }
        self.work = work;
        self.unpermute(x);
    }

    /// The shortest `y` that minimises |Aᵀ y - c|; `c` has `columns` entries, `y` has `rows`.
    pub fn solve_transposed(&mut self, c: &[f64], y: &mut [f64]) {
        let (m, n, r) = (self.rows, self.columns, self.rank);
        let mut work = core::mem::take(&mut self.work);
        for (value, place) in work.iter_mut().zip(&self.order[..n]) {
            *value = c[*place];
        }
        for i in (0..r).rev() {
            self.apply_right(i, &mut work);
        }
        y[..m].fill(0.0);
        for i in 0..r {
            let sum = dot(&self.entries[i * m..][..i], &y[..i]);
            y[i] = (work[i] - sum) / self.entries[i * m + i];
        }
        self.work = work;
        for k in (0..r).rev() {
            self.apply_left(k, y);
        }
    }

    /// Direction `index` (below `columns - rank`) of an orthonormal basis of the null space.
    pub fn null_direction(&mut self, index: usize, x: &mut [f64]) {
        let mut work = core::mem::take(&mut self.work);
        work.fill(0.0);
        work[self.rank + index] = 1.0;
        for i in 0..self.rank {
            self.apply_right(i, &mut work);
        }
        self.work = work;
        self.unpermute(x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn times(a: &[f64], columns: usize, x: &[f64]) -> Vec<f64> {
        a.chunks_exact(columns).map(|row| dot(row, x)).collect()
    }

    fn transposed(a: &[f64], rows: usize, columns: usize) -> Vec<f64> {
        (0..columns).flat_map(|j| (0..rows).map(move |i| a[i * columns + j])).collect()
    }

    /// A `rows` x `columns` matrix of rank at most `rank`.
    fn product(rows: usize, columns: usize, rank: usize, numbers: &[f64]) -> Vec<f64> {
        let (left, right) = numbers.split_at(rows * rank);
        (0..rows * columns)
            .map(|at| {
                let (i, j) = (at / columns, at % columns);
                (0..rank).map(|k| left[i * rank + k] * right[k * columns + j]).sum()
            })
            .collect()
    }

    proptest! {
        #[test]
        fn least_squares_of_any_rank_meets_its_normal_equations(
            rows in 1_usize..7, columns in 1_usize..7, rank in 1_usize..5,
            numbers in proptest::collection::vec(-1.0..1.0_f64, 60),
            b in proptest::collection::vec(-1.0..1.0_f64, 6),
        ) {
            let a = product(rows, columns, rank, &numbers);
            let mut decomposition = Orthogonal::new(rows, columns);
            decomposition.factor(&a, rows, columns, 1e-10);
            let found = decomposition.rank();
            prop_assert!(found <= rank.min(rows).min(columns));
            let mut x = vec![0.0; columns];
            decomposition.solve(&b[..rows], &mut x);
            let residual: Vec<f64> = times(&a, columns, &x).iter().zip(&b).map(|(p, q)| p - q).collect();
            let normal = times(&transposed(&a, rows, columns), rows, &residual);
            // Pivots down to 1e-10 are kept, so |x| may reach 1e10 and its rounding 1e-6.
            let size = 1.0 + crate::linear::largest(&x);
            prop_assert!(crate::linear::largest(&normal) < 1e-14 * 100.0 * size);
            // Shortest: nothing of x lies in the null space, which A does not see.
            let mut direction = vec![0.0; columns];
            for index in 0..columns - found {
                decomposition.null_direction(index, &mut direction);
                prop_assert!(dot(&direction, &x).abs() < 1e-13 * size);
                prop_assert!((dot(&direction, &direction) - 1.0).abs() < 1e-13);
                // Directions below the rank tolerance of 1e-10 count as null.
                prop_assert!(crate::linear::largest(&times(&a, columns, &direction)) < 1e-8);
            }
        }

        #[test]
        fn transposed_solution_is_that_of_the_transposed_matrix(
            rows in 1_usize..6, columns in 1_usize..6,
            numbers in proptest::collection::vec(-1.0..1.0_f64, 36),
            c in proptest::collection::vec(-1.0..1.0_f64, 6),
        ) {
            let a = &numbers[..rows * columns];
            let (mut y, mut expected) = (vec![0.0; rows], vec![0.0; rows]);
            let mut decomposition = Orthogonal::new(rows, columns);
            decomposition.factor(a, rows, columns, 1e-6);
            decomposition.solve_transposed(&c[..columns], &mut y);
            let mut other = Orthogonal::new(columns, rows);
            other.factor(&transposed(a, rows, columns), columns, rows, 1e-6);
            prop_assume!(other.rank() == decomposition.rank());
            other.solve(&c[..columns], &mut expected);
            for (p, q) in y.iter().zip(&expected) {
                // Condition up to 1e6, |y| up to 1e6.
                prop_assert!((p - q).abs() < 1e-8 * (1.0 + q.abs()));
            }
        }
    }

    #[test]
    fn zero_matrix_has_rank_zero_and_zero_solution() {
        let mut decomposition = Orthogonal::new(2, 3);
        decomposition.factor(&[0.0; 6], 2, 3, 1e-10);
        let mut x = [1.0; 3];
        decomposition.solve(&[1.0, 2.0], &mut x);
        assert_eq!((decomposition.rank(), x), (0, [0.0; 3]));
    }
}
