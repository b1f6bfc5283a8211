//! Integrals over the mass of a beam. In: slices. Out: the constants of [`ModalData`](super::ModalData).
//!
//! A slice is a rigid body on its section, so the field is the full one of a beam with rotating sections:
//! φ = u + ψ x (place in the section). What the symmetry of the beam makes 0 comes out as exactly 0.0.

use super::data::SecondOrder;
use super::motion::{Slice, square};

type Vector = [f64; 3];
type Matrix = [[f64; 3]; 3];

/// Γ, C and N of all modes.
pub struct Integrals {
    /// Γ_k.
    pub gamma: Vec<Vector>,
    /// C_k.
    pub moment: Vec<Matrix>,
    /// N_kl.
    pub coupling: Vec<Vec<Matrix>>,
}

/// Entries below this part of what Cauchy and Schwarz allow them are rounding, and become 0: shapes are good to some
/// 1e-14 of their size, and nothing physical is this small beside its neighbours without being 0 by symmetry.
pub const ROUNDING: f64 = 1e-12;

/// `value`, or exactly 0 where it is rounding beside `scale`.
pub fn snap(value: f64, scale: f64) -> f64 {
    if value.abs() <= ROUNDING * scale { 0.0 } else { value }
}

/// Integrals of mass-normalised modes. `mass` and the diagonal of the second moment bound them.
pub fn integrals(slices: &[Slice], modes: usize, mass: f64, second: Vector) -> Integrals {
    let mut gamma = vec![[0.0; 3]; modes];
    let mut moment = vec![[[0.0; 3]; 3]; modes];
    let mut coupling = square(modes, |_, _| [[0.0; 3]; 3]);
    for slice in slices {
        for k in 0..modes {
            for j in 0..3 {
                gamma[k][j] += slice.mass * slice.displacement[k][j];
                moment[k][0][j] += slice.mass * slice.x * slice.displacement[k][j];
            }
            for axis in 0..3 {
                let fibre = turned(slice.rotation[k], axis);
                for j in 0..3 {
                    moment[k][axis][j] += slice.spread[axis] * fibre[j];
                }
            }
            for l in 0..=k {
                add_coupling(&mut coupling[k][l], slice, k, l);
            }
        }
    }
    let size: Vec<Vector> = (0..modes).map(|k| [0, 1, 2].map(|j| coupling[k][k][j][j].max(0.0))).collect();
    for k in 0..modes {
        for j in 0..3 {
            gamma[k][j] = snap(gamma[k][j], (mass * size[k][j]).sqrt());
            for i in 0..3 {
                moment[k][i][j] = snap(moment[k][i][j], (second[i] * size[k][j]).sqrt());
                for l in 0..=k {
                    let scale = (size[k][i] * size[l][j]).sqrt();
                    coupling[k][l][i][j] = snap(coupling[k][l][i][j], scale);
                }
            }
        }
        for l in 0..=k {
            fix_trace(&mut coupling[k][l], if k == l { 1.0 } else { 0.0 });
            coupling[l][k] = transposed(&coupling[k][l]);
        }
    }
    Integrals { gamma, moment, coupling }
}

fn add_coupling(block: &mut Matrix, slice: &Slice, k: usize, l: usize) {
    for i in 0..3 {
        for j in 0..3 {
            block[i][j] += slice.mass * slice.displacement[k][i] * slice.displacement[l][j];
        }
    }
    for axis in 0..3 {
        let (first, second) = (turned(slice.rotation[k], axis), turned(slice.rotation[l], axis));
        for i in 0..3 {
            for j in 0..3 {
                block[i][j] += slice.spread[axis] * first[i] * second[j];
            }
        }
    }
}

/// Mass-normalised modes have tr N_kl = 1 or 0; its rounding goes where it weighs least, into the largest entry.
fn fix_trace(block: &mut Matrix, trace: f64) {
    let size = |axis: usize| block[axis][axis].abs();
    let largest = (0..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best });
    let others: f64 = (0..3).filter(|axis| *axis != largest).map(|axis| block[axis][axis]).sum();
    debug_assert!((block[largest][largest] + others - trace).abs() < 1e-9, "{block:?}");
    block[largest][largest] = trace - others;
}

/// Quadratic integrals; `extent` is the diagonal entry xx of the second moment.
pub fn second_order(slices: &[Slice], modes: usize, mass: f64, extent: f64) -> SecondOrder {
    let sum = |k: usize, l: usize, weight: &dyn Fn(&Slice) -> f64| -> f64 {
        slices.iter().map(|slice| weight(slice) * slice.shortening[k][l]).sum()
    };
    let size =
        square(modes, |k, l| slices.iter().map(|slice| slice.shortening[k][l].abs()).fold(0.0, f64::max));
    let bound = |k: usize, l: usize| (size[k][k] * size[l][l]).sqrt();
    SecondOrder {
        gamma: square(modes, |k, l| [snap(sum(k, l, &|slice| slice.mass), mass * bound(k, l)), 0.0, 0.0]),
        moment: square(modes, |k, l| {
            let value = sum(k, l, &|slice| slice.mass * slice.x);
            let xx = snap(value, (mass * extent).sqrt() * bound(k, l));
            [[xx, 0.0, 0.0], [0.0; 3], [0.0; 3]]
        }),
    }
}

/// rotation x e_axis.
fn turned(rotation: Vector, axis: usize) -> Vector {
    let [x, y, z] = rotation;
    match axis {
        0 => [0.0, z, -y],
        1 => [-z, 0.0, x],
        _ => [y, -x, 0.0],
    }
}

fn transposed(block: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| block[j][i]))
}
