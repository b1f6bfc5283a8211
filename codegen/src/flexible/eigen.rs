//! Eigenmodes of a stiffness and a mass matrix, mass-normalised, lowest first.
//!
//! Sums are written out, because products of nalgebra's dynamic matrices choose their kernel by the processor they run
//! on, and the last bits with it; its decompositions are plain loops.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::line::Matrices;

/// One eigenmode: xᵀ M x = 1, xᵀ K x = omega².
#[derive(Clone, Debug)]
pub struct Eigenmode {
    /// omega² [rad²/s²].
    pub square: f64,
    /// The unknowns.
    pub shape: DVector<f64>,
}

/// aᵀ B c.
pub fn product(a: &DVector<f64>, matrix: &DMatrix<f64>, c: &DVector<f64>) -> f64 {
    let row = |i: usize| -> f64 { (0..c.len()).map(|j| matrix[(i, j)] * c[j]).sum() };
    (0..a.len()).filter(|i| a[*i] != 0.0).map(|i| a[i] * row(i)).sum()
}

/// The lowest `count` modes with some unknowns held at 0.
///
/// K + `shift` M must be definite on the free unknowns. Modes come orthogonal to `without` (rigid motions, orthogonal
/// among each other or not), which are left out themselves. `None`: definiteness was lost to rounding.
pub fn lowest(
    matrices: &Matrices,
    held: &[usize],
    shift: f64,
    without: &[DVector<f64>],
    count: usize,
) -> Option<Vec<Eigenmode>> {
    let free: Vec<usize> = (0..matrices.mass.nrows()).filter(|unknown| !held.contains(unknown)).collect();
    let stiffness = free_part(&matrices.stiffness, &free);
    let mass = free_part(&matrices.mass, &free);
    let shifted = DMatrix::from_fn(free.len(), free.len(), |i, j| stiffness[(i, j)] + shift * mass[(i, j)]);
    let lower = shifted.cholesky()?.unpack();
    // L⁻¹ M L⁻ᵀ has the eigenvalues 1 / (omega² + shift): the lowest modes are its largest, and the best determined.
    let half = lower.solve_lower_triangular(&mass)?;
    let whole = lower.solve_lower_triangular(&half.transpose())?;
    let eigen = SymmetricEigen::new(DMatrix::from_fn(free.len(), free.len(), |i, j| {
        f64::midpoint(whole[(i, j)], whole[(j, i)])
    }));
    let mut order: Vec<usize> = (0..free.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));

    let mut done: Vec<DVector<f64>> = vec![];
    for rigid in without {
        done.push(orthonormal(rigid.clone(), &matrices.mass, &done)?);
    }
    let upper = lower.transpose();
    let mut modes = vec![];
    for index in order.into_iter().skip(without.len()).take(count) {
        let part = upper.solve_upper_triangular(&eigen.eigenvectors.column(index).into_owned())?;
        let mut shape = DVector::zeros(matrices.mass.nrows());
        for (unknown, value) in free.iter().zip(part.iter()) {
            shape[*unknown] = *value;
        }
        let shape = orthonormal(shape, &matrices.mass, &done)?;
        done.push(shape.clone());
        modes.push(Eigenmode { square: product(&shape, &matrices.stiffness, &shape), shape });
    }
    Some(modes)
}

fn free_part(matrix: &DMatrix<f64>, free: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])])
}

/// Length 1 and orthogonal to `others`, in the metric of the mass. Twice, because once leaves the rounding of the first.
pub fn orthonormal(
    mut shape: DVector<f64>,
    mass: &DMatrix<f64>,
    others: &[DVector<f64>],
) -> Option<DVector<f64>> {
    for _ in 0..2 {
        for other in others {
            let part = product(other, mass, &shape);
            shape.axpy(-part, other, 1.0);
        }
        let square = product(&shape, mass, &shape);
        if square.is_nan() || square <= 0.0 {
            return None;
        }
        shape /= square.sqrt();
    }
    Some(shape)
}
