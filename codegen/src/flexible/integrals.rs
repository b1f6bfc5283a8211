//! Integrals over the mass of a beam. In: slices. Out: the constants of [`ModalData`](super::ModalData).
//!
//! A slice is a rigid body on its section, so the field is the full one of a beam with rotating sections:
//! φ = u + ψ x (place in the section). What the symmetry of the beam makes 0 comes out as exactly 0.0.

use super::data::{SecondOrder, transposed};
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
            let u = slice.displacement[k];
            (0..3).for_each(|j| gamma[k][j] += slice.mass * u[j]);
            add_outer(&mut moment[k], slice.mass, [slice.x, 0.0, 0.0], u);
            for (axis, spread) in slice.spread.into_iter().enumerate() {
                let mut unit = [0.0; 3];
                unit[axis] = 1.0;
                add_outer(&mut moment[k], spread, unit, turned(slice.rotation[k], axis));
            }
            for (l, block) in coupling[k].iter_mut().enumerate().take(k + 1) {
                add_outer(block, slice.mass, u, slice.displacement[l]);
                for (axis, spread) in slice.spread.into_iter().enumerate() {
                    let fibres = [k, l].map(|mode| turned(slice.rotation[mode], axis));
                    add_outer(block, spread, fibres[0], fibres[1]);
                }
            }
        }
    }
    let size: Vec<Vector> = (0..modes).map(|k| [0, 1, 2].map(|j| coupling[k][k][j][j].max(0.0))).collect();
    for k in 0..modes {
        for j in 0..3 {
            gamma[k][j] = snap(gamma[k][j], (mass * size[k][j]).sqrt());
        }
        snap_block(&mut moment[k], second, size[k]);
        still_moment(&mut moment[k], second, size[k]);
        for (l, block) in coupling[k].iter_mut().enumerate().take(k + 1) {
            snap_block(block, size[k], size[l]);
            fix_trace(block, if k == l { 1.0 } else { 0.0 });
        }
    }
    let mirrored = square(modes, |k, l| if l <= k { coupling[k][l] } else { transposed(&coupling[l][k]) });
    Integrals { gamma, moment, coupling: mirrored }
}

/// block += factor a bᵀ.
fn add_outer(block: &mut Matrix, factor: f64, a: Vector, b: Vector) {
    for (row, a) in block.iter_mut().zip(a) {
        for (entry, b) in row.iter_mut().zip(b) {
            *entry += factor * a * b;
        }
    }
}

/// Entries that are rounding beside what rows and columns of these squared sizes allow become 0.
fn snap_block(block: &mut Matrix, rows: Vector, columns: Vector) {
    for (row, a) in block.iter_mut().zip(rows) {
        for (entry, b) in row.iter_mut().zip(columns) {
            *entry = snap(*entry, (a * b).sqrt());
        }
    }
}

/// Angular momentum about an axis is C_ij - C_ji; where it is rounding beside what the entries allow (modes of a free
/// beam have none), both become the entry of the smaller allowance, so that code generated from them sees exactly 0.
fn still_moment(block: &mut Matrix, rows: Vector, columns: Vector) {
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let (upper, lower) = ((rows[i] * columns[j]).sqrt(), (rows[j] * columns[i]).sqrt());
        if (block[i][j] - block[j][i]).abs() <= ROUNDING * upper.max(lower) {
            let common = if upper < lower { block[i][j] } else { block[j][i] };
            block[i][j] = common;
            block[j][i] = common;
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
        slices.iter().map(|slice| weight(slice) * slice.shortening[(k, l)]).sum()
    };
    let size =
        square(modes, |k, l| slices.iter().map(|slice| slice.shortening[(k, l)].abs()).fold(0.0, f64::max));
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
