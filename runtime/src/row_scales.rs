//! How rows of the loops' Jacobian are scaled against each other. In: rows. Out: factors. Never knows what is solved with them.

use crate::scalar::Scalar;

/// Keeps the longest length that each row has had.
pub(crate) fn note_lengths(lengths: &mut [f64], jacobian: &[f64], columns: usize) {
    for (length, row) in lengths.iter_mut().zip(jacobian.chunks_exact(columns.max(1))) {
        let now = Scalar::sqrt(square_of(row));
        if now > *length {
            *length = now;
        }
    }
}

/// Square of the length of a row, in four running sums.
#[inline]
pub(crate) fn square_of<T: Scalar>(row: &[T]) -> T {
    let (blocks, rest) = row.as_chunks::<4>();
    let squares = blocks.iter().map(|block| block.map(|x| x * x));
    let sums = squares.reduce(|sums, block| core::array::from_fn(|i| sums[i] + block[i]));
    let of_blocks = sums.map(|[a, b, c, d]| (a + b) + (c + d));
    let of_rest = rest.iter().map(|x| *x * *x).reduce(|sum, square| sum + square);
    let both = of_blocks.zip(of_rest).map(|(a, b)| a + b);
    both.or(of_blocks).or(of_rest).unwrap_or(T::constant(0.0))
}

/// The largest square whose root is not above a length: rows of larger ones are longer.
#[cfg(feature = "std")]
fn largest_square(length: f64) -> f64 {
    if !length.is_finite() {
        return length;
    }
    let is_within = |square: f64| Scalar::sqrt(square) <= length;
    let mut square = (length * length).min(f64::MAX);
    while !is_within(square) {
        square = square.next_down();
    }
    while square < f64::MAX && is_within(square.next_up()) {
        square = square.next_up();
    }
    square
}

/// Rows that follow the longest that each has been.
#[cfg(feature = "std")]
pub(crate) struct RowScales {
    /// Of every row, whether its residual is an angle.
    angular: Vec<bool>,
    lengths: Vec<f64>,
    /// The largest square of a length that is no longer.
    squares: Vec<f64>,
    scales: Vec<f64>,
}

#[cfg(feature = "std")]
impl RowScales {
    pub(crate) fn new(angular: Vec<bool>) -> Self {
        let numbers = |value| vec![value; angular.len()];
        Self { lengths: numbers(0.0), squares: numbers(0.0), scales: numbers(1.0), angular }
    }

    /// Squares of the rows' lengths at a state.
    pub(crate) fn note_squares(&mut self, squares: impl Iterator<Item = f64>) {
        let mut has_grown = false;
        for ((square, most), length) in squares.zip(&mut self.squares).zip(&mut self.lengths) {
            if square > *most {
                (*length, has_grown) = (Scalar::sqrt(square), true);
                *most = largest_square(*length);
            }
        }
        if has_grown {
            let kinds = self.angular.iter().copied().enumerate();
            scale_rows(&mut self.scales, &self.lengths, kinds);
        }
    }

    /// The largest square of a length of each row that is no longer than the longest so far.
    pub(crate) fn squares(&self) -> &[f64] {
        &self.squares
    }

    pub(crate) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Passes all numbers, to be read or written.
    pub(crate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.lengths.iter_mut().chain(&mut self.scales).for_each(visit);
        for (square, length) in self.squares.iter_mut().zip(&self.lengths) {
            *square = largest_square(*length);
        }
    }
}

/// Factors that make rows at most about as long as one, those in metres and those in radians each among themselves; `kinds`: of every
/// kept row its place and whether its residual is an angle.
pub(crate) fn scale_rows(
    scales: &mut [f64],
    lengths: &[f64],
    kinds: impl Iterator<Item = (usize, bool)> + Clone,
) {
    let mut most = [0.0_f64; 2];
    for (row, angular) in kinds.clone() {
        let kind = usize::from(angular);
        most[kind] = most[kind].max(lengths[row]);
    }
    for (row, angular) in kinds {
        // A row that starts at a singular position has no length of its own yet.
        scales[row] = 1.0 / lengths[row].max(1e-3 * most[usize::from(angular)]).max(f64::MIN_POSITIVE);
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::linear::dot;

    #[test]
    fn squares_are_scalar_products_to_the_last_bit() {
        let row: Vec<f64> = (1..12).map(|i| 1.0 / f64::from(i) - 0.3).collect();
        for end in 0..row.len() {
            assert_eq!(square_of(&row[..end]).to_bits(), dot(&row[..end], &row[..end]).to_bits(), "{end}");
        }
    }

    #[test]
    fn a_square_says_as_its_root_does_whether_a_row_is_longer() {
        for length in [0.0, 1e-170, 3e-155, 0.1, 1.0 / 3.0, 1.0, 2.0_f64.sqrt(), 7e5, 1e160, f64::INFINITY] {
            let limit = largest_square(length);
            for square in [limit.next_down(), limit, limit.next_up(), length * length] {
                assert_eq!(Scalar::sqrt(square) > length, square > limit, "{length} {square}");
            }
        }
    }
}
