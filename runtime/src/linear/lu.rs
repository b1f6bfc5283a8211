//! LU with partial pivoting of a square matrix: Newton systems of implicit integrators.
//! In: a row-major matrix. Out: solutions, and whether the matrix is singular to working precision.

use core::cmp::Ordering;

/// Rows that are solved for at once: matrices are filled up with zeros to a multiple.
type Lanes = [f64; 4];

/// LU factors of a square matrix of fixed size.
#[derive(Clone, Debug)]
pub struct Lu {
    size: usize,
    /// Column by column: eliminating then adds multiples of whole columns.
    factors: Vec<Lanes>,
    /// What the rows below a pivot are of its row, zero at the others.
    multiples: Vec<Lanes>,
    /// The same below the diagonal alone, and above it: four rows by four, column by column. On the diagonal the inverses of both, so
    /// that a row need not wait for the one before.
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
            factors: vec![[0.0; 4]; size * blocks],
            multiples: vec![[0.0; 4]; blocks],
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
        self.factor_columns(|k, column| {
            let rows = matrix.chunks_exact(n);
            column.iter_mut().zip(rows).for_each(|(place, row)| *place = row[k]);
        })
    }

    /// Factors a matrix whose columns are written one by one, each with its number. Returns as [`Self::factor`].
    pub fn factor_columns(&mut self, mut write: impl FnMut(usize, &mut [f64])) -> f64 {
        let (n, blocks) = (self.size, self.work.len());
        if n == 0 {
            return 1.0;
        }
        for (k, column) in self.factors.chunks_exact_mut(blocks).enumerate() {
            write(k, &mut column.as_flattened_mut()[..n]);
        }
        (0..).zip(&mut self.order).for_each(|(row, place)| *place = row);
        let (mut smallest, mut most) = (f64::INFINITY, 0.0_f64);
        for k in 0..n {
            let (before, after) = self.factors.split_at_mut((k + 1) * blocks);
            let (before, column) = before.split_at_mut(k * blocks);
            let column = column.as_flattened_mut();
            let (mut best, mut largest) = (k, column[k].abs());
            for (i, value) in (k + 1..n).zip(&column[k + 1..]) {
                let is_larger = value.abs() > largest;
                best = if is_larger { i } else { best };
                largest = if is_larger { value.abs() } else { largest };
            }
            let pivot = column[best];
            if pivot == 0.0 || pivot.is_nan() {
                return pivot;
            }
            smallest = smallest.min(pivot.abs());
            most = most.max(pivot.abs());
            let reciprocal = 1.0 / pivot;
            self.reciprocal_pivots[k] = reciprocal;
            if best != k {
                self.order.swap(best, k);
                column.swap(best, k);
                let others = before.chunks_exact_mut(blocks).chain(after.chunks_exact_mut(blocks));
                others.for_each(|other| other.as_flattened_mut().swap(best, k));
            }
            column[k + 1..n].iter_mut().for_each(|factor| *factor *= reciprocal);
            let multiples = self.multiples.as_flattened_mut();
            multiples[..=k].fill(0.0);
            multiples[k + 1..].copy_from_slice(&column[k + 1..]);
            // Whole blocks, from that of the next row on.
            let first = (k + 1) / 4;
            for later in after.chunks_exact_mut(blocks) {
                let value = later[k / 4][k % 4];
                if value != 0.0 {
                    for (values, multiples) in later[first..].iter_mut().zip(&self.multiples[first..]) {
                        *values = without(*values, multiples, value);
                    }
                }
            }
        }
        self.split();
        smallest / most
    }

    /// Factors as [`Self::solve`] goes through them: by blocks, of those on the diagonal the inverses.
    fn split(&mut self) {
        let blocks = self.work.len();
        let width = 4 * blocks;
        for (k, column) in self.factors.chunks_exact(blocks).enumerate() {
            let diagonal = k / 4;
            for (block, values) in column.iter().enumerate() {
                let place = block * width + k;
                match block.cmp(&diagonal) {
                    Ordering::Less => self.upper[place] = *values,
                    Ordering::Greater => self.lower[place] = *values,
                    Ordering::Equal => {}
                }
            }
        }
        let places = (0..blocks).map(|block| (4 * block, block * width + 4 * block));
        for ((first, place), pivots) in places.zip(self.reciprocal_pivots.as_chunks::<4>().0) {
            let columns = (first..first + 4).map(|k| self.factors.get(k * blocks + first / 4));
            let mut tile = [[0.0; 4]; 4];
            tile.iter_mut().zip(columns).for_each(|(column, known)| *column = *known.unwrap_or(&[0.0; 4]));
            self.lower[place..place + 4].copy_from_slice(&inverse_of_lower(&tile));
            self.upper[place..place + 4].copy_from_slice(&inverse_of_upper(&tile, pivots));
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
            let values = known.fold(rest[0], |values, (columns, known)| less(values, columns, known));
            rest[0] = times(&columns[block], &values);
        }
        for (block, rows) in self.upper.chunks_exact(width).enumerate().rev() {
            let (columns, _) = rows.as_chunks::<4>();
            let (rest, solved) = self.work.split_at_mut(block + 1);
            // What was solved last comes last: nothing before waits for it.
            let known = columns[block + 1..].iter().zip(&*solved).rev();
            let values = known.fold(rest[block], |values, (columns, known)| less(values, columns, known));
            rest[block] = times(&columns[block], &values);
        }
        b[..self.size].copy_from_slice(&self.work.as_flattened()[..self.size]);
    }
}

/// Of the ones on the diagonal and what is below, column by column.
fn inverse_of_lower(tile: &[Lanes; 4]) -> [Lanes; 4] {
    let mut inverse = [[0.0; 4]; 4];
    for (j, column) in inverse.iter_mut().enumerate() {
        column[j] = 1.0;
        for k in j..3 {
            for i in k + 1..4 {
                column[i] -= tile[k][i] * column[k];
            }
        }
    }
    inverse
}

/// Of what is above the diagonal and on it, of which the reciprocals are given; zero for rows and columns without one.
fn inverse_of_upper(tile: &[Lanes; 4], reciprocals: &Lanes) -> [Lanes; 4] {
    let mut inverse = [[0.0; 4]; 4];
    for (j, column) in inverse.iter_mut().enumerate() {
        column[j] = 1.0;
        for k in (0..=j).rev() {
            column[k] *= reciprocals[k];
            for i in 0..k {
                column[i] -= tile[k][i] * column[k];
            }
        }
    }
    inverse
}

/// `values` less four columns, each times what is known.
#[inline(always)]
fn less(values: Lanes, columns: &[Lanes; 4], known: &Lanes) -> Lanes {
    let products = times(columns, known);
    core::array::from_fn(|i| values[i] - products[i])
}

/// Four columns, each times a value, in sums of two: no product waits for another one.
#[inline(always)]
fn times(columns: &[Lanes; 4], values: &Lanes) -> Lanes {
    let [a, b, c, d] = columns;
    core::array::from_fn(|i| (a[i] * values[0] + b[i] * values[1]) + (c[i] * values[2] + d[i] * values[3]))
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
