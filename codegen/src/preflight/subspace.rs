//! Rank, null space and shortest solution of constraint rows. In: matrices. Out: numbers. Never knows mechanics.
//!
//! A QR decomposition with pivots costs a tenth of the singular values. It answers where it leaves no doubt of the
//! rank, and the singular values answer elsewhere. A matrix with numbers that are infinite or none has no rank, no
//! directions and no solution here.

use linkwear_runtime::linear::SparseQr;
use nalgebra::{DMatrix, DVector};

use crate::decompose;
use crate::sparse_rows::SparseRows;

/// Singular values below this share of the largest are zero. Rounding leaves 1e-14; a mechanism that is not
/// meant to be special has none below 1e-4.
pub const RANK_TOLERANCE: f64 = 1e-8;

/// Pivots above this share of the largest belong to the rank. The weakest singular value is below the last pivot by a
/// factor that reaches ten in matrices of hundreds of rows: it stays far above any tolerance asked for.
const CLEARLY_THERE: f64 = 1e-2;

/// Of null spaces of more columns than this, whose singular values take their cube, pivots above the tolerance by [`FAR_ABOVE`] do.
/// Directions lose no digits by the condition.
const MANY_COLUMNS: usize = 60;

/// The largest pivot and the largest singular value differ by the root of a matrix' entries at most, some hundred.
const FAR_ABOVE: f64 = 1e4;

/// Pivots below this share are rounding.
const CLEARLY_NOTHING: f64 = 1e-12;

/// Tolerances that the two bounds leave no doubt about.
const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-11..=1e-3;

/// The weakest singular value of the rank is below its last pivot by this factor at most; see [`CLEARLY_THERE`].
const BELOW_PIVOT: f64 = 10.0;

/// Rank of a matrix, and bounds of the weakest singular value of that rank.
#[derive(Clone, Copy, Debug)]
pub struct Strength {
    /// Rank.
    pub rank: usize,
    /// The weakest singular value lies between these; nothing where pivots leave doubt.
    pub weakest: Option<(f64, f64)>,
}

/// How strongly the rows of a matrix hold.
pub fn strength(matrix: &SparseRows) -> Strength {
    if let Some(factor) = Factor::new(matrix, RANK_TOLERANCE) {
        let weakest = (factor.rank > 0).then(|| {
            let pivot = factor.weakest_pivot();
            // What follows in its line of the triangle is no larger: one number a row at most.
            (pivot / BELOW_PIVOT, pivot * (factor.rows.len() as f64).sqrt())
        });
        return Strength { rank: factor.rank, weakest };
    }
    let values = singular_values(matrix);
    let largest = values.iter().copied().fold(0.0, f64::max);
    Strength { rank: values.iter().filter(|value| **value > RANK_TOLERANCE * largest).count(), weakest: None }
}

/// Rank of a matrix.
pub fn rank(matrix: &SparseRows) -> usize {
    strength(matrix).rank
}

/// The largest first, as many as the shorter side is long.
pub fn singular_values(matrix: &SparseRows) -> Vec<f64> {
    let found = decompose::singular_values(&without_zero_rows(matrix));
    let mut values: Vec<f64> = found.iter().flatten().copied().collect();
    values.resize(matrix.nrows().min(matrix.ncols()), 0.0);
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Columns span the null space.
pub fn null_space(matrix: &SparseRows) -> DMatrix<f64> {
    nearly_null_space(matrix, RANK_TOLERANCE)
}

/// The same of what is below a part of the largest singular value.
pub fn nearly_null_space(matrix: &SparseRows, tolerance: f64) -> DMatrix<f64> {
    let n = matrix.ncols();
    if n == 0 || !matrix.is_finite() {
        return DMatrix::zeros(n, 0);
    }
    let there = if n > MANY_COLUMNS { CLEARLY_THERE.min(FAR_ABOVE * tolerance) } else { CLEARLY_THERE };
    if let Some(factor) = Factor::clear(matrix, tolerance, there) {
        return factor.null_space();
    }
    let (values, v_t) = right_singular_vectors(without_zero_rows(matrix));
    let largest = values.amax();
    let rows: Vec<usize> = (0..n).filter(|i| values[*i] <= tolerance * largest || largest == 0.0).collect();
    DMatrix::from_fn(n, rows.len(), |i, j| v_t[(rows[j], i)])
}

/// As many singular values as there are columns, and all right singular vectors as rows.
pub fn right_singular_vectors(matrix: DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let n = matrix.ncols();
    // Zero rows below make the decomposition return all of them.
    let height = matrix.nrows().max(n);
    let svd = decompose::singular_directions(matrix.resize_vertically(height, 0.0), false);
    let found = svd.and_then(|svd| Some((svd.singular_values, svd.v_t?)));
    found.unwrap_or_else(|| (DVector::repeat(n, f64::NAN), DMatrix::identity(n, n)))
}

/// Shortest solution of a rank-deficient system.
pub fn least_norm(matrix: &SparseRows, right: &DVector<f64>) -> Option<DVector<f64>> {
    least_norm_within(matrix, right, RANK_TOLERANCE)
}

/// The same by the directions above a part of the strongest one.
pub fn least_norm_within(matrix: &SparseRows, right: &DVector<f64>, tolerance: f64) -> Option<DVector<f64>> {
    if matrix.nrows() == 0 || matrix.ncols() == 0 {
        return Some(DVector::zeros(matrix.ncols()));
    }
    if !matrix.is_finite() || right.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let factor = Factor::new(matrix, tolerance);
    if let Some(solution) = factor.and_then(|factor| factor.least_norm(matrix, right)) {
        return Some(solution);
    }
    let svd = decompose::singular_directions(matrix.dense(), true)?;
    let largest = svd.singular_values.amax();
    svd.solve(right, tolerance * largest).ok()
}

/// Rows of zeros, which planar mechanisms have many of, say nothing.
fn without_zero_rows(matrix: &SparseRows) -> DMatrix<f64> {
    matrix.select_rows(&matrix.rows_that_say_something()).dense()
}

/// QR decomposition of the transpose with pivots, where they tell the rank.
struct Factor {
    /// The rows that are not zero.
    rows: Vec<usize>,
    decomposition: SparseQr,
    rank: usize,
}

impl Factor {
    /// `None` where the pivots leave doubt.
    fn new(matrix: &SparseRows, tolerance: f64) -> Option<Self> {
        Self::clear(matrix, tolerance, CLEARLY_THERE)
    }

    /// The same with pivots that belong to the rank above another share of the largest.
    fn clear(matrix: &SparseRows, tolerance: f64, there: f64) -> Option<Self> {
        let rows = matrix.rows_that_say_something();
        let width = matrix.ncols();
        if rows.is_empty() || width == 0 || !TOLERANCES.contains(&tolerance) {
            return None;
        }
        let given = rows.iter().map(|row| matrix.row(*row).to_vec()).collect();
        let decomposition = SparseQr::new(width, given);
        let pivots = decomposition.pivots();
        let largest = pivots.iter().map(|pivot| pivot.abs()).fold(0.0, f64::max);
        let rank = pivots.iter().take_while(|pivot| pivot.abs() > there * largest).count();
        let clear = pivots.iter().skip(rank).all(|pivot| pivot.abs() < CLEARLY_NOTHING * largest);
        let factor = Self { rows, decomposition, rank };
        // The pivots promise it; to ask costs little.
        let holds = || factor.decomposition.weakest(rank) > there / BELOW_PIVOT * largest;
        (clear && largest.is_finite() && (rank == 0 || holds())).then_some(factor)
    }

    fn weakest_pivot(&self) -> f64 {
        let pivots = self.decomposition.pivots()[..self.rank].iter();
        pivots.map(|pivot| pivot.abs()).fold(f64::INFINITY, f64::min)
    }

    fn null_space(&self) -> DMatrix<f64> {
        let directions = self.decomposition.beyond(self.rank);
        let (height, count) = (self.decomposition.height(), directions.len());
        DMatrix::from_iterator(height, count, directions.into_iter().flatten())
    }

    /// Of independent rows; others ask for a compromise. `matrix' multipliers` with `R' R multipliers = right`, which needs no
    /// directions; it loses the digits of the condition twice, and the condition is small here.
    fn least_norm(&self, matrix: &SparseRows, right: &DVector<f64>) -> Option<DVector<f64>> {
        if self.rank < self.rows.len() {
            return None;
        }
        let wanted: Vec<f64> = self.rows.iter().map(|row| right[*row]).collect();
        let mut multipliers = DVector::zeros(matrix.nrows());
        for (row, multiplier) in self.rows.iter().zip(self.decomposition.solve_normal(&wanted)) {
            multipliers[*row] = multiplier;
        }
        Some(matrix.transposed_times(&multipliers))
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::random;
    use super::*;

    fn matrix(rows: usize, columns: usize, generator: &mut u64) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| random(generator))
    }

    fn sparse(matrix: &DMatrix<f64>) -> SparseRows {
        SparseRows::from_entries(matrix.ncols(), matrix.transpose().as_slice())
    }

    /// Products of two matrices have the rank of the narrower.
    #[test]
    fn ranks_null_spaces_and_shortest_solutions_are_those_of_the_singular_values() {
        let mut generator = 7;
        for (rows, columns, rank) in [(4, 7, 4), (7, 4, 4), (6, 6, 3), (9, 5, 2), (3, 8, 1), (20, 21, 20)] {
            let mut given = matrix(rows, rank, &mut generator) * matrix(rank, columns, &mut generator);
            given = given.insert_row(1, 0.0);
            let sparse = sparse(&given);
            assert_eq!(super::rank(&sparse), rank);
            let free = null_space(&sparse);
            assert_eq!(free.ncols(), columns - rank);
            assert!(
                (&given * &free).amax() < 1e-12
                    && (free.transpose() * &free - DMatrix::identity(columns - rank, columns - rank)).amax()
                        < 1e-12
            );
            let right = &given * matrix(columns, 1, &mut generator).column(0);
            let solution = least_norm(&sparse, &right).unwrap();
            let svd = given.clone().svd(true, true);
            let expected = svd.solve(&right, 1e-10).unwrap();
            // The condition of these is below a thousand.
            assert!((solution - expected).amax() < 1e-11, "{rows} by {columns} of rank {rank}");
        }
    }

    #[test]
    fn a_row_of_zeros_with_something_to_ask_for_changes_no_solution() {
        let given = SparseRows::from_entries(2, &[0.0, 0.0, 3.0, 4.0]);
        let solution = least_norm(&given, &DVector::from_vec(vec![1.0, 5.0])).unwrap();
        assert!((solution - DVector::from_vec(vec![0.6, 0.8])).amax() < 1e-15);
    }

    #[test]
    fn numbers_that_are_none_have_no_rank_and_no_solution() {
        for odd in [f64::NAN, f64::INFINITY] {
            let given = SparseRows::from_entries(3, &[1.0, 2.0, 0.0, odd, 1.0, 3.0]);
            assert_eq!((rank(&given), singular_values(&given)), (0, vec![0.0; 2]));
            assert_eq!(null_space(&given).shape(), (3, 0));
            assert_eq!(least_norm(&given, &DVector::zeros(2)), None);
            assert!(right_singular_vectors(given.dense()).0.iter().all(|value| value.is_nan()));
        }
        assert_eq!(least_norm(&SparseRows::units(2, &[0, 1]), &DVector::from_vec(vec![f64::NAN, 0.0])), None);
    }

    #[test]
    fn doubtful_ranks_go_by_the_singular_values() {
        let given = SparseRows::from_entries(2, &[1.0, 0.0, 0.0, 1e-7]);
        assert_eq!(rank(&given), 2);
        assert_eq!(nearly_null_space(&given, 1e-3).ncols(), 1);
        let zeros = SparseRows::from_entries(3, &[0.0; 6]);
        assert_eq!((rank(&zeros), null_space(&zeros).ncols()), (0, 3));
    }
}
