//! What deflections turn of a body's inertia, from the modal equations in the place of accelerations.
//! In: [`Basis`], what else the modes feel. Out: moments by axis. Never knows the tree.
//!
//! Along an axis n the moment has `n . sum_j U_j x X_j`, where the modes feel `f_l = sum_j e_lj . X_j`. Where turns about n
//! take modes to modes, `n x e_kj = sum_l c_kl e_lj` but for functions j along n, which have no part in it, that is
//!   `sum_k q_k sum_l c_kl (f_l - what functions along n have of it)`.
//! The modal equations say what `f_l` is. Stiffness and what the spin makes of functions along n cancel, where both are
//! the same for modes that the turn exchanges.

use crate::expr::{Expr, Scope, Vec3};
use crate::flexible::{Basis, ModalData};

use super::motion::ModalState;

/// By what equal numbers may differ.
const SAME: f64 = 1e-12;

/// `n . sum_j U_j x X_j` by axis, where it is known.
pub type ByModes<'g> = [Option<Expr<'g>>; 3];

/// A turn that takes the shapes of modes to those of others.
#[derive(Clone, Debug)]
pub struct Turning {
    axis: usize,
    /// c_kl.
    by: Vec<Vec<f64>>,
    /// Functions along the axis.
    along: Vec<usize>,
    /// By two modes: `sum_ij e_lj G_ji e_mi` of these functions.
    felt: Vec<Vec<f64>>,
}

impl Turning {
    /// About every axis about which there is one; `along` has the functions along each.
    pub fn all(basis: &Basis, along: [&[usize]; 3], data: &ModalData) -> Vec<Self> {
        (0..3).filter_map(|axis| Self::about(axis, along[axis], basis, data)).collect()
    }

    /// Where modes feel `besides` what inertia and stiffness do to each, and `held` of the frame's motion by function.
    pub fn add_to<'g>(
        &self,
        known: &mut ByModes<'g>,
        (basis, held): (&Basis, impl Fn(usize) -> Vec3<'g>),
        (g, modes): (&'g Scope, &ModalState<'g>),
        besides: &[Expr<'g>],
    ) {
        let axis = self.axis;
        let felt = |(l, besides): (usize, &Expr<'g>)| {
            let held = self.along.iter().map(|j| basis.directions[l][*j][axis] * held(*j)[axis]);
            let held = g.sum(held.filter(|held| !held.is_zero()));
            *besides - g.weighted(self.felt[l].iter().copied(), &modes.v_dot) - held
        };
        let across: Vec<Expr<'g>> = besides.iter().enumerate().map(felt).collect();
        let terms = modes.q.iter().zip(&self.by);
        known[axis] = Some(g.sum(terms.map(|(q, row)| *q * g.weighted(row.iter().copied(), &across))));
    }

    fn about(axis: usize, along: &[usize], basis: &Basis, data: &ModalData) -> Option<Self> {
        let modes = basis.directions.len();
        let across: Vec<usize> = (0..basis.functions.len()).filter(|j| !along.contains(j)).collect();
        let shape = |k: usize| across.iter().flat_map(move |j| basis.directions[k][*j]).collect::<Vec<f64>>();
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let turned = |k: usize| {
            let of = |j: &usize| {
                let mut turned = [0.0; 3];
                (turned[next], turned[last]) =
                    (-basis.directions[k][*j][last], basis.directions[k][*j][next]);
                turned
            };
            across.iter().flat_map(of).collect::<Vec<f64>>()
        };
        let shapes: Vec<Vec<f64>> = (0..modes).map(shape).collect();
        let row = |k: usize| {
            let turned = turned(k);
            let mut row = vec![0.0; modes];
            if turned.iter().any(|x| *x != 0.0) {
                let (mode, ratio) =
                    shapes.iter().enumerate().find_map(|(l, other)| Some((l, ratio(&turned, other)?)))?;
                row[mode] = ratio;
            }
            Some(row)
        };
        let by: Vec<Vec<f64>> = (0..modes).map(row).collect::<Option<_>>()?;
        let of = |l: usize, m: usize| {
            let products = along.iter().flat_map(|j| along.iter().map(move |i| (*j, *i)));
            products
                .map(|(j, i)| basis.directions[l][j][axis] * basis.gram[j][i] * basis.directions[m][i][axis])
                .sum()
        };
        let felt: Vec<Vec<f64>> = (0..modes).map(|l| (0..modes).map(|m| of(l, m)).collect()).collect();
        let turns = by.iter().flatten().any(|c| *c != 0.0);
        let holds = turns && [&data.stiffness, &felt].into_iter().all(|matrix| cancels(&by, matrix));
        holds.then(|| Self { axis, by, along: along.to_vec(), felt })
    }
}

/// `a / b`, if they have the same direction.
fn ratio(a: &[f64], b: &[f64]) -> Option<f64> {
    let (at, largest) = b.iter().enumerate().max_by(|(_, x), (_, y)| x.abs().total_cmp(&y.abs()))?;
    if *largest == 0.0 {
        return None;
    }
    let ratio = a[at] / largest;
    let same = a.iter().zip(b).all(|(a, b)| (a - ratio * b).abs() <= SAME * (ratio * largest).abs());
    (ratio != 0.0 && same).then_some(ratio)
}

/// Whether `qᵀ c matrix q` is zero for all q.
fn cancels(by: &[Vec<f64>], matrix: &[Vec<f64>]) -> bool {
    let modes = by.len();
    let size = matrix.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    let entry = |k: usize, m: usize| (0..modes).map(|l| by[k][l] * matrix[l][m]).sum::<f64>();
    (0..modes).all(|k| (0..modes).all(|m| (entry(k, m) + entry(m, k)).abs() <= SAME * size))
}
