//! How rows of the loops' Jacobian are scaled against each other. In: rows. Out: factors. Never knows what is solved with them.

use crate::linear::dot;
use crate::scalar::Scalar;

/// Keeps the longest length that each row has had; whether one has grown.
pub(crate) fn note_lengths(lengths: &mut [f64], jacobian: &[f64], columns: usize) -> bool {
    let mut has_grown = false;
    for (length, row) in lengths.iter_mut().zip(jacobian.chunks_exact(columns.max(1))) {
        let now = Scalar::sqrt(dot(row, row));
        if now > *length {
            (*length, has_grown) = (now, true);
        }
    }
    has_grown
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
