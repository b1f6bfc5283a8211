//! Whether the products of modal data over the mass can be those of one body. In: [`ModalData`] whose lists have their lengths. Out: the
//! mode that cannot be, or modes whose mass is not that of their products. Never knows where data are from.
//!
//! ∫ w wᵀ dm with w = (1, rbar, φ_1 .. φ_n) has no negative direction, whatever the body: its blocks are m, s0, Γ, P0, C and N. Rotary
//! inertia adds such a product of its own.

use nalgebra::DMatrix;

use super::check::DataError;
use super::data::ModalData;

/// Half a unit in the last of six digits, which written data have, of a number that begins with a one.
const WRITTEN: f64 = 5e-6;
/// A mass and the trace of its products may differ by this part: those of lumped masses and of rotary inertia that is left out.
const SAME_MASS: f64 = 0.01;

impl ModalData {
    /// Whether the products can be of one body, as far as written numbers tell.
    pub(super) fn check_products(&self) -> Result<(), DataError> {
        let all: Vec<usize> = (0..self.mode_count()).collect();
        // The first mode that cannot be, else all together.
        let alone = all.chunks(1).find(|mode| !self.is_possible(mode));
        if let Some(modes) = alone.or_else(|| (!self.is_possible(&all)).then_some(&all[..])) {
            let names = modes.iter().map(|mode| self.modes[*mode].name.clone()).collect();
            let is_missing = |mode: &usize| self.coupling[*mode][*mode] == [[0.0; 3]; 3];
            return Err(DataError::Products { modes: names, missing: modes.iter().any(is_missing) });
        }
        Ok(())
    }

    /// Whether the products of the rigid body and of some modes have no negative direction.
    fn is_possible(&self, modes: &[usize]) -> bool {
        let size = 4 + 3 * modes.len();
        let mut products = DMatrix::zeros(size, size);
        let mut put = |(row, column): (usize, usize), value: f64| {
            products[(row, column)] = value;
            products[(column, row)] = value;
        };
        put((0, 0), self.mass);
        for i in 0..3 {
            put((0, 1 + i), self.first_moment[i]);
            for j in 0..3 {
                put((1 + i, 1 + j), self.second_moment[i][j]);
            }
        }
        for (at, k) in modes.iter().enumerate() {
            for i in 0..3 {
                let column = 4 + 3 * at + i;
                put((0, column), self.gamma[*k][i]);
                for j in 0..3 {
                    put((1 + j, column), self.moment[*k][j][i]);
                }
                for (other, l) in modes.iter().enumerate() {
                    for j in 0..3 {
                        put((column, 4 + 3 * other + j), self.coupling[*k][*l][i][j]);
                    }
                }
            }
        }
        // Of three components of one vector the largest counts: which of them are none is a matter of axes.
        let of_modes = modes.iter().map(|k| self.mass_matrix[*k][*k].max(self.product(*k, *k)));
        let place: f64 = (0..3).map(|i| self.second_moment[i][i]).sum();
        let sizes: Vec<f64> =
            std::iter::once(self.mass).chain([place; 3]).chain(of_modes.flat_map(|size| [size; 3])).collect();
        let scaled = DMatrix::from_fn(size, size, |i, j| {
            let scale = (sizes[i] * sizes[j]).sqrt();
            if scale > 0.0 { products[(i, j)] / scale } else { products[(i, j)] }
        });
        scaled.symmetric_eigenvalues().min() >= -WRITTEN * size as f64
    }

    /// ∫ φ_k . φ_l dm [kg m²/q²].
    fn product(&self, k: usize, l: usize) -> f64 {
        (0..3).map(|i| self.coupling[k][l][i][i]).sum()
    }

    /// The two modes whose mass is farthest from the trace of their products, beside the masses of each alone, and both numbers
    /// [kg m²/q²]; nothing where they agree.
    pub(crate) fn mass_beside_products(&self) -> Option<([usize; 2], [f64; 2])> {
        let n = self.mode_count();
        let pairs = (0..n).flat_map(|k| (k..n).map(move |l| [k, l]));
        let apart = |[k, l]: [usize; 2]| {
            let scale = (self.mass_matrix[k][k] * self.mass_matrix[l][l]).sqrt();
            (self.mass_matrix[k][l] - self.product(k, l)).abs() / scale
        };
        let [k, l] =
            pairs.filter(|pair| apart(*pair) > SAME_MASS).max_by(|a, b| apart(*a).total_cmp(&apart(*b)))?;
        Some(([k, l], [self.mass_matrix[k][l], self.product(k, l)]))
    }
}
