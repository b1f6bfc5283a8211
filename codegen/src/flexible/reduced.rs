//! Inertia of a body whose modal accelerations follow those of its frame: what is left when they are eliminated.
//! In: tables of a body. Out: [`Reduced`]. Plain numbers.
//!
//! With the momentum `c_k = (∫ r x φ_k dm, Γ_k)` per unit of modal speed k, the modes take
//! `M_ff q'' = -c (alpha, a_O) + ...`, so that the frame feels `I - cᵀ M_ff⁻¹ c`: a polynomial of the modal coordinates.
//! Its coefficients are summed here, so that what cancels is not computed.

use super::data::ModalData;
use super::equal::share_magnitudes;

type Matrix = [[f64; 3]; 3];

/// A coefficient below this part of the sum of its terms is their rounding.
const ROUNDING: f64 = 1e-13;

/// Inertia about the origin of the floating frame, in that frame: force `translation a + couplingᵀ alpha`, moment
/// `coupling a + inertia alpha`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reduced {
    /// Inverse of M_ff.
    pub inverse: Vec<Vec<f64>>,
    /// Constant.
    pub translation: Matrix,
    /// Constant part.
    pub coupling: Matrix,
    /// Per unit of each modal coordinate.
    pub coupling_by: Vec<Matrix>,
    /// Constant part.
    pub inertia: Matrix,
    /// Per unit of each modal coordinate.
    pub inertia_by: Vec<Matrix>,
    /// Per unit of the product of the modal coordinates k and l up to k.
    pub inertia_by_products: Vec<Vec<Matrix>>,
}

/// A sum that knows how large its terms were.
#[derive(Clone, Copy, Default)]
struct Sum {
    value: f64,
    size: f64,
}

#[derive(Clone, Copy, Default)]
struct Sums([[Sum; 3]; 3]);

impl Sums {
    fn add(&mut self, factor: f64, entry: impl Fn(usize, usize) -> f64) {
        for i in 0..3 {
            for j in 0..3 {
                let term = factor * entry(i, j);
                self.0[i][j].value += term;
                self.0[i][j].size += term.abs();
            }
        }
    }

    fn finished(self) -> Matrix {
        self.0.map(|row| row.map(|sum| if sum.value.abs() <= ROUNDING * sum.size { 0.0 } else { sum.value }))
    }
}

/// `∫ r x φ dm` of `∫ r φᵀ dm`.
fn axial(m: &Matrix) -> [f64; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        m[j][k] - m[k][j]
    })
}

/// The matrix of `a x`.
fn skew(a: [f64; 3]) -> impl Fn(usize, usize) -> f64 {
    move |i, j| match (j + 3 - i) % 3 {
        1 => -a[3 - i - j],
        2 => a[3 - i - j],
        _ => 0.0,
    }
}

/// `tr(P) 1 - P` of a symmetric part `P + Pᵀ`, halved by `factor`.
fn inertia_of(p: Matrix) -> impl Fn(usize, usize) -> f64 {
    move |i, j| {
        let entry = -(p[i][j] + p[j][i]);
        if i == j { entry + 2.0 * (p[0][0] + p[1][1] + p[2][2]) } else { entry }
    }
}

impl ModalData {
    /// The inertia that is left; nothing where the field is not linear in the modal coordinates.
    pub fn reduced(&self) -> Option<Reduced> {
        let n = self.mode_count();
        if self.second_order.is_some() || n == 0 {
            return None;
        }
        let inverse = self.inverse_mass()?;
        let constant: Vec<[f64; 3]> = self.moment.iter().map(axial).collect();
        let by = |m: usize, k: usize| axial(&self.coupling[m][k]);
        let mut translation = Sums::default();
        translation.add(self.mass, |i, j| f64::from(u8::from(i == j)));
        let mut coupling = Sums::default();
        coupling.add(1.0, skew(self.first_moment));
        let mut coupling_by: Vec<Sums> = vec![Sums::default(); n];
        let mut inertia = Sums::default();
        inertia.add(0.5, inertia_of(self.second_moment));
        let mut inertia_by: Vec<Sums> = vec![Sums::default(); n];
        let mut products: Vec<Vec<Sums>> = (0..n).map(|k| vec![Sums::default(); k + 1]).collect();
        for m in 0..n {
            coupling_by[m].add(1.0, skew(self.gamma[m]));
            inertia_by[m].add(1.0, inertia_of(self.moment[m]));
            for l in 0..n {
                products[m.max(l)][m.min(l)].add(0.5, inertia_of(self.coupling[m][l]));
            }
        }
        for (k, row) in inverse.iter().enumerate() {
            for (l, factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
                translation.add(-factor, |i, j| self.gamma[k][i] * self.gamma[l][j]);
                coupling.add(-factor, |i, j| constant[k][i] * self.gamma[l][j]);
                inertia.add(-factor, |i, j| constant[k][i] * constant[l][j]);
                for m in 0..n {
                    let linear = by(m, k);
                    coupling_by[m].add(-factor, |i, j| linear[i] * self.gamma[l][j]);
                    inertia_by[m]
                        .add(-factor, |i, j| linear[i] * constant[l][j] + constant[l][i] * linear[j]);
                    for p in 0..n {
                        let other = by(p, l);
                        products[m.max(p)][m.min(p)].add(-factor, |i, j| linear[i] * other[j]);
                    }
                }
            }
        }
        let finished = |list: Vec<Sums>| -> Vec<Matrix> { list.into_iter().map(Sums::finished).collect() };
        let mut reduced = Reduced {
            inverse,
            translation: translation.finished(),
            coupling: coupling.finished(),
            coupling_by: finished(coupling_by),
            inertia: inertia.finished(),
            inertia_by: finished(inertia_by),
            inertia_by_products: products.into_iter().map(finished).collect(),
        };
        share_magnitudes(reduced.translation.iter_mut().flatten());
        share_magnitudes(reduced.coupling_by.iter_mut().flatten().flatten());
        share_magnitudes(reduced.inertia_by.iter_mut().flatten().flatten());
        share_magnitudes(reduced.inertia_by_products.iter_mut().flatten().flatten().flatten());
        Some(reduced)
    }

    /// M_ff⁻¹ by Gauss and Jordan; that of ones is exact. Written out, so that all machines get the same bits. Nothing if
    /// it is not positive definite.
    fn inverse_mass(&self) -> Option<Vec<Vec<f64>>> {
        let n = self.mode_count();
        let mut left = self.mass_matrix.clone();
        let mut inverse: Vec<Vec<f64>> =
            (0..n).map(|k| (0..n).map(|l| f64::from(u8::from(k == l))).collect()).collect();
        for k in 0..n {
            let pivot = left[k][k];
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            for l in 0..n {
                (left[k][l], inverse[k][l]) = (left[k][l] / pivot, inverse[k][l] / pivot);
            }
            for m in (0..n).filter(|m| *m != k) {
                let factor = left[m][k];
                for l in 0..n {
                    left[m][l] -= factor * left[k][l];
                    inverse[m][l] -= factor * inverse[k][l];
                }
            }
        }
        let size = |k: usize, l: usize| (inverse[k][k] * inverse[l][l]).sqrt();
        let entry = |k: usize, l: usize| {
            let (k, l) = (k.max(l), k.min(l));
            if inverse[k][l].abs() <= ROUNDING * size(k, l) { 0.0 } else { inverse[k][l] }
        };
        Some((0..n).map(|k| (0..n).map(|l| entry(k, l)).collect()).collect())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector, Vector3};

    use super::super::cloud::{Cloud, numbers};
    use super::*;

    /// The frame's inertia from kinetic energy: mass points, modes eliminated by numbers.
    fn by_points(cloud: &Cloud, q: &[f64]) -> DMatrix<f64> {
        let n = q.len();
        let mut mass: DMatrix<f64> = DMatrix::zeros(n + 6, n + 6);
        for point in &cloud.points {
            let at = Vector3::from(point.place) + Vector3::from(cloud.moved(q, point));
            let turn = (0..3).map(|axis| Vector3::ith(axis, 1.0).cross(&at));
            let slide = (0..3).map(|axis| Vector3::ith(axis, 1.0));
            let shapes = (0..n).map(|k| Vector3::from(cloud.shape(k, point)));
            let columns: Vec<Vector3<f64>> = turn.chain(slide).chain(shapes).collect();
            for (i, a) in columns.iter().enumerate() {
                for (j, b) in columns.iter().enumerate() {
                    mass[(i, j)] += point.mass * a.dot(b);
                }
            }
        }
        let (frame, modes) = (mass.view((0, 0), (6, 6)), mass.view((6, 6), (n, n)));
        let across = mass.view((6, 0), (n, 6));
        let followed = modes.into_owned().lu().solve(&across.into_owned()).expect("regular");
        frame - across.transpose() * followed
    }

    #[test]
    fn it_is_the_inertia_of_the_points_without_their_modes() {
        for (cloud, seed) in [(Cloud::rod(2, 3), 1), (Cloud::any(3, 4), 2), (Cloud::any(1, 9), 3)] {
            let data = cloud.data();
            let mut next = numbers(seed);
            let q: Vec<f64> = (0..data.mode_count()).map(|_| next()).collect();
            let reduced = data.reduced().expect("a linear field");
            let entry = |constant: &Matrix, by: &[Matrix], i: usize, j: usize| {
                constant[i][j] + by.iter().zip(&q).map(|(m, q)| m[i][j] * q).sum::<f64>()
            };
            let expected = by_points(&cloud, &q);
            for i in 0..3 {
                for j in 0..3 {
                    let mut inertia = entry(&reduced.inertia, &reduced.inertia_by, i, j);
                    for (k, row) in reduced.inertia_by_products.iter().enumerate() {
                        for (l, m) in row.iter().enumerate() {
                            inertia += m[i][j] * q[k] * q[l];
                        }
                    }
                    let coupling = entry(&reduced.coupling, &reduced.coupling_by, i, j);
                    // Entries are of the order of ten, modes' matrices of a condition of some ten.
                    assert!((inertia - expected[(i, j)]).abs() < 1e-11);
                    assert!((coupling - expected[(i, j + 3)]).abs() < 1e-11);
                    assert!((reduced.translation[i][j] - expected[(i + 3, j + 3)]).abs() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn the_inverse_of_ones_is_exact_and_of_any_matrix_its_inverse() {
        let data = Cloud::any(4, 21).data();
        let inverse = data.inverse_mass().expect("positive definite");
        for (k, row) in inverse.iter().enumerate() {
            let row = DVector::from_vec(row.clone());
            for (l, column) in data.mass_matrix.iter().enumerate() {
                let column = DVector::from_vec(column.clone());
                // A few roundings of numbers of the order of ten.
                assert!((row.dot(&column) - f64::from(u8::from(k == l))).abs() < 1e-12);
            }
        }
        let ones: Vec<Vec<f64>> = vec![vec![1.0, 0.0], vec![0.0, 1.0]];
        let normalised = ModalData { mass_matrix: ones.clone(), modes: data.modes[..2].to_vec(), ..data };
        assert_eq!(normalised.inverse_mass(), Some(ones));
    }
}
