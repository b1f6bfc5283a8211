//! LU with partial pivoting of a square matrix: Newton systems of implicit integrators.
//! In: a row-major matrix. Out: solutions, and whether the matrix is singular to working precision.

use super::vector::add_scaled;

/// Rows that are solved for at once: matrices are filled up with zeros to a multiple.
type Lanes = [f64; 4];

/// LU factors of a square matrix of fixed size.
#[derive(Clone, Debug)]
pub struct Lu {
    size: usize,
    /// Column by column: eliminating then adds multiples of whole columns.
    factors: Vec<f64>,
    /// The same below the diagonal alone, and above it, zero elsewhere: four rows by four, column by column.
    lower: Vec<Lanes>,
    upper: Vec<Lanes>,
    reciprocal_pivots: Vec<f64>,
    order: Vec<usize>,
    work: Vec<Lanes>,
}

impl Lu {
    /// Storage for matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        let blocks = size.div_ceil(4);
        let triangle = vec![[0.0; 4]; 4 * blocks * blocks];
        Self {
            size,
            factors: vec![0.0; size * size],
            lower: triangle.clone(),
            upper: triangle,
            reciprocal_pivots: vec![0.0; 4 * blocks],
            order: vec![0; size],
            work: vec![[0.0; 4]; blocks],
        }
    }

    /// Factors a row-major matrix. Returns the smallest pivot over the largest (0 or NaN: singular).
    pub fn factor(&mut self, matrix: &[f64]) -> f64 {
        let n = self.size;
        if n == 0 {
            return 1.0;
        }
        for (i, row) in matrix.chunks_exact(n).enumerate() {
            self.order[i] = i;
            for (place, value) in self.factors[i..].iter_mut().step_by(n).zip(row) {
                *place = *value;
            }
        }
        let (mut smallest, mut most) = (f64::INFINITY, 0.0_f64);
        for k in 0..n {
            let (before, after) = self.factors.split_at_mut((k + 1) * n);
            let (before, column) = before.split_at_mut(k * n);
            let mut best = k;
            for i in k + 1..n {
                if column[i].abs() > column[best].abs() {
                    best = i;
                }
            }
            let pivot = column[best];
            if pivot == 0.0 || pivot.is_nan() {
                return pivot;
            }
            smallest = smallest.min(pivot.abs());
            most = most.max(pivot.abs());
            let reciprocal = 1.0 / pivot;
            self.reciprocal_pivots[k] = reciprocal;
            self.order.swap(best, k);
            before.chunks_exact_mut(n).for_each(|column| column.swap(best, k));
            column.swap(best, k);
            column[k + 1..].iter_mut().for_each(|factor| *factor *= reciprocal);
            for later in after.chunks_exact_mut(n) {
                later.swap(best, k);
                let value = later[k];
                if value != 0.0 {
                    add_scaled(&mut later[k + 1..], -value, &column[k + 1..]);
                }
            }
        }
        self.split();
        smallest / most
    }

    fn split(&mut self) {
        let width = 4 * self.work.len();
        for (k, column) in self.factors.chunks_exact(self.size).enumerate() {
            for (i, value) in column.iter().enumerate() {
                let place = i / 4 * width + k;
                self.lower[place][i % 4] = if i > k { *value } else { 0.0 };
                self.upper[place][i % 4] = if i < k { *value } else { 0.0 };
            }
        }
    }

    /// Solves in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        let width = 4 * self.work.len();
        if width == 0 {
            return;
        }
        for (value, place) in self.work.as_flattened_mut().iter_mut().zip(&self.order) {
            *value = b[*place];
        }
        for (block, rows) in self.lower.chunks_exact(width).enumerate() {
            let (columns, _) = rows.as_chunks::<4>();
            let (solved, rest) = self.work.split_at_mut(block);
            let known = columns.iter().zip(&*solved);
            let mut values = known.fold(rest[0], |values, (columns, known)| less(values, columns, known));
            let [first, second, third, _] = columns[block];
            values = without(values, &first, values[0]);
            values = without(values, &second, values[1]);
            rest[0] = without(values, &third, values[2]);
        }
        for (block, rows) in self.upper.chunks_exact(width).enumerate().rev() {
            let (columns, _) = rows.as_chunks::<4>();
            let pivots = &self.reciprocal_pivots[4 * block..][..4];
            let (rest, solved) = self.work.split_at_mut(block + 1);
            let known = columns[block + 1..].iter().zip(&*solved);
            let mut values = known.fold(rest[block], |values, (columns, known)| less(values, columns, known));
            let [_, second, third, fourth] = columns[block];
            values[3] *= pivots[3];
            values = without(values, &fourth, values[3]);
            values[2] *= pivots[2];
            values = without(values, &third, values[2]);
            values[1] *= pivots[1];
            values = without(values, &second, values[1]);
            values[0] *= pivots[0];
            rest[block] = values;
        }
        b[..self.size].copy_from_slice(&self.work.as_flattened()[..self.size]);
    }
}

/// `values` less four columns, each times what is known.
#[inline(always)]
fn less(values: Lanes, columns: &[Lanes; 4], known: &Lanes) -> Lanes {
    let values = without(values, &columns[0], known[0]);
    let values = without(values, &columns[1], known[1]);
    let values = without(values, &columns[2], known[2]);
    without(values, &columns[3], known[3])
}

#[inline(always)]
fn without(values: Lanes, column: &Lanes, factor: f64) -> Lanes {
    core::array::from_fn(|i| values[i] - column[i] * factor)
}

#[cfg(test)]
mod tests {
    use super::super::vector::dot;
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

    /// Blocks of four rows: full, begun, and none.
    #[test]
    fn systems_of_all_sizes_are_solved() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for size in 0..14 {
            let mut factors = Lu::new(size);
            // Twice with one storage: nothing is left of the first matrix.
            for _ in 0..2 {
                let a: Vec<f64> = (0..size * size).map(|_| random()).collect();
                let b: Vec<f64> = (0..size).map(|_| random()).collect();
                assert!(factors.factor(&a) > 1e-4, "{size}");
                let mut x = b.clone();
                factors.solve(&mut x);
                for (row, wanted) in a.chunks_exact(size.max(1)).zip(b) {
                    // Rounding of numbers of order 1, up to the condition of some hundred.
                    assert!((dot(row, &x) - wanted).abs() < 1e-12, "{size}");
                }
            }
        }
    }

    #[test]
    fn singular_matrix_is_told() {
        assert_eq!(Lu::new(2).factor(&[1.0, 2.0, 2.0, 4.0]), 0.0);
    }
}
