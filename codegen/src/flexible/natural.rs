//! Natural frequencies of a body as its matrices have them. In: M_ff and K_ff. Out: one for each mode.

use std::f64::consts::TAU;

use nalgebra::{Cholesky, DMatrix};

use super::data::ModalData;

/// Entries beside a diagonal below this part of it are rounding of written numbers: shapes are eigenmodes then.
const BESIDE: f64 = 1e-9;

impl ModalData {
    /// Frequencies [Hz] at which the body vibrates in its floating frame, undamped. Where shapes are eigenmodes, each has its own; else
    /// each takes one of all together, in the order of those that they would have alone.
    pub fn natural_frequencies(&self) -> Vec<f64> {
        let n = self.mode_count();
        let alone: Vec<f64> = (0..n).map(|k| self.stiffness[k][k] / self.mass_matrix[k][k]).collect();
        let hertz = |square: f64| square.max(0.0).sqrt() / TAU;
        if is_diagonal(&self.mass_matrix) && is_diagonal(&self.stiffness) {
            return alone.into_iter().map(hertz).collect();
        }
        let matrix = |rows: &[Vec<f64>]| DMatrix::from_fn(n, n, |i, j| 0.5 * (rows[i][j] + rows[j][i]));
        // L⁻¹ K L⁻ᵀ with M = L Lᵀ.
        let reduced = Cholesky::new(matrix(&self.mass_matrix)).and_then(|factor| {
            let lower = factor.l();
            let half = lower.solve_lower_triangular(&matrix(&self.stiffness))?;
            lower.solve_lower_triangular(&half.transpose())
        });
        let Some(reduced) = reduced else { return alone.into_iter().map(hertz).collect() };
        let mut squares: Vec<f64> = reduced.symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| alone[*a].total_cmp(&alone[*b]));
        let mut found = vec![0.0; n];
        for (mode, square) in order.into_iter().zip(squares) {
            found[mode] = hertz(square);
        }
        found
    }
}

fn is_diagonal(rows: &[Vec<f64>]) -> bool {
    let entries = |i: usize| (0..i).map(move |j| (i, j));
    (0..rows.len()).flat_map(entries).all(|(i, j)| {
        let size = (rows[i][i] * rows[j][j]).sqrt();
        rows[i][j].abs().max(rows[j][i].abs()) <= BESIDE * size
    })
}

#[cfg(test)]
mod tests {
    use super::super::data::Mode;
    use super::*;

    fn data(mass_matrix: [[f64; 2]; 2], stiffness: [[f64; 2]; 2]) -> ModalData {
        let rows = |matrix: [[f64; 2]; 2]| matrix.map(|row| row.to_vec()).to_vec();
        let modes = ["a", "b"].map(|name| Mode { name: name.to_owned(), frequency: 0.0 });
        let (mass_matrix, stiffness) = (rows(mass_matrix), rows(stiffness));
        ModalData { modes: modes.to_vec(), mass_matrix, stiffness, ..ModalData::default() }
    }

    #[test]
    fn frequencies_are_those_of_both_matrices_together() {
        let eigenmodes = data([[2.0, 0.0], [0.0, 1.0]], [[72.0, 0.0], [0.0, 9.0]]);
        assert_eq!(eigenmodes.natural_frequencies(), [6.0 / TAU, 3.0 / TAU]);
        // Two masses of 1 on a wall and between them springs of 1, by displacement and distance: 1.5 -+ sqrt(5)/2.
        let chain = data([[2.0, 1.0], [1.0, 1.0]], [[1.0, 0.0], [0.0, 1.0]]);
        let exact = [1.5 - 1.25_f64.sqrt(), 1.5 + 1.25_f64.sqrt()].map(|square| square.sqrt() / TAU);
        for (found, exact) in chain.natural_frequencies().into_iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
        }
    }
}
