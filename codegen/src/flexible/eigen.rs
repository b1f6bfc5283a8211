//! Eigenmodes of a mass matrix beside a stiffness of 1, mass-normalised, lowest frequency first.
//!
//! Sums are written out, because products of nalgebra's dynamic matrices choose their kernel by the processor they run
//! on, and the last bits with it; its decompositions are plain loops.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// One eigenmode: xᵀ M x = 1, xᵀ x = omega².
#[derive(Clone, Debug)]
pub struct Eigenmode {
    /// omega² [rad²/s²].
    pub square: f64,
    /// The unknowns.
    pub shape: DVector<f64>,
}

/// aᵀ B c.
pub fn product(a: &DVector<f64>, matrix: &DMatrix<f64>, c: &DVector<f64>) -> f64 {
    (0..c.len()).filter(|j| c[*j] != 0.0).map(|j| c[j] * matrix.column(j).dot(a)).sum()
}

/// The lowest `count` modes among the unknowns orthogonal to `held`, which are orthonormal. `None`: there are not as many, or
/// rounding buried them.
pub fn lowest(mass: &DMatrix<f64>, held: &[DVector<f64>], count: usize) -> Option<Vec<Eigenmode>> {
    if count == 0 {
        return Some(vec![]);
    }
    // Eigenvalues are 1 / omega²: the lowest modes are the largest, and the best determined.
    let eigen = SymmetricEigen::new(without(mass, held));
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let largest = eigen.eigenvalues[*order.first()?];
    let mut modes: Vec<Eigenmode> = vec![];
    for index in order.into_iter().take(count) {
        // Rounding of the largest; NaN fails too.
        if !matches!(
            eigen.eigenvalues[index].partial_cmp(&(1e-13 * largest)),
            Some(std::cmp::Ordering::Greater)
        ) {
            return None;
        }
        let mut shape = eigen.eigenvectors.column(index).into_owned();
        for row in held {
            shape.axpy(-row.dot(&shape), row, 1.0);
        }
        modes.push(mass_orthonormal(shape, mass, &modes)?);
    }
    (modes.len() == count).then_some(modes)
}

/// P M P with P the projection away from `held`.
fn without(mass: &DMatrix<f64>, held: &[DVector<f64>]) -> DMatrix<f64> {
    let mut projected = mass.clone();
    for row in held {
        let image = DVector::from_fn(row.len(), |i, _| projected.column(i).dot(row));
        let square = image.dot(row);
        for j in 0..row.len() {
            for i in 0..row.len() {
                projected[(i, j)] += square * row[i] * row[j] - image[i] * row[j] - row[i] * image[j];
            }
        }
    }
    projected
}

/// A mode of length 1 and orthogonal to `others` in the metric of the mass. Twice, because once leaves the rounding of the first.
pub fn mass_orthonormal(
    mut shape: DVector<f64>,
    mass: &DMatrix<f64>,
    others: &[Eigenmode],
) -> Option<Eigenmode> {
    for _ in 0..2 {
        for Eigenmode { shape: other, .. } in others {
            let part = product(other, mass, &shape);
            shape.axpy(-part, other, 1.0);
        }
        let square = product(&shape, mass, &shape);
        if square.is_nan() || square <= 0.0 {
            return None;
        }
        shape /= square.sqrt();
    }
    Some(Eigenmode { square: shape.dot(&shape), shape })
}

/// Rows made orthonormal, in their order. `None`: they depend on each other.
pub fn orthonormal(rows: &[DVector<f64>]) -> Option<Vec<DVector<f64>>> {
    let mut done: Vec<DVector<f64>> = vec![];
    for row in rows {
        let (mut rest, length) = (row.clone(), row.norm());
        for _ in 0..2 {
            for other in &done {
                rest.axpy(-other.dot(&rest), other, 1.0);
            }
        }
        // Closer together than rounding can tell apart.
        if rest.norm() <= 1e-12 * length {
            return None;
        }
        let norm = rest.norm();
        done.push(rest / norm);
    }
    Some(done)
}
