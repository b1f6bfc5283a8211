//! Reactions that redundant constraints leave undetermined: self-stress of the loops.
//! In: the left null space of the constraint Jacobian. Out: names of wrench components.

use nalgebra::{DMatrix, DVector};

use crate::sparse_rows::SparseRows;

use super::case::Case;
use super::samples::{ClosedPositions, random};
use super::subspace::null_space;

/// Components below this share of a self-stress, or of the loads that it is as large as, count as untouched by it.
const UNTOUCHED: f64 = 1e-7;

/// Positions looked at: a component that a self-stress leaves alone in one position it may touch in the next.
const POSITIONS: usize = 6;

/// Mixtures of the self-stresses of a position. A component that all of them leave alone is untouched by each mixture; one
/// that a stress touches by a tenth of its size hides in a mixture with a chance of 1e-6.
const MIXTURES: usize = 2;

/// Wrench components (`R1.Fx`) that change under a self-stress in some position.
pub fn non_unique(case: &Case<'_>, positions: &ClosedPositions) -> Vec<String> {
    let sizes = case.system.sizes();
    let channels = &case.description.channels;
    let wrenches: Vec<usize> = (0..channels.len()).filter(|i| is_wrench(&channels[*i].name)).collect();
    let mut touched = vec![false; sizes.channels];
    let mut generator = 0x9E37_79B9_7F4A_7C15_u64;
    let stride = positions.positions.len().div_ceil(POSITIONS).max(1);
    for position in positions.positions.iter().step_by(stride) {
        let observe = |multipliers: &[f64]| case.observe(&position.q, &vec![0.0; sizes.speeds], multipliers);
        let unloaded = observe(&vec![0.0; sizes.rows]);
        let own = |index: usize, values: &[f64]| values[index] / case.units.channels[index];
        // As large as the loads, for it must stand out of their rounding.
        let size = wrenches.iter().map(|i| own(*i, &unloaded).abs()).fold(1.0, f64::max);
        for stress in mixtures(&SelfStresses::new(&position.jacobian), &mut generator) {
            // A row in metres has a force as its multiplier, a row in radians a moment.
            let multipliers = stress.iter().zip(&case.units.rows);
            let multipliers: Vec<f64> =
                multipliers.map(|(stress, row)| stress * size * (case.units.length / row)).collect();
            let loaded = observe(&multipliers);
            for index in &wrenches {
                touched[*index] |= (own(*index, &loaded) - own(*index, &unloaded)).abs() > UNTOUCHED * size;
            }
        }
    }
    let names = channels.iter().zip(touched);
    names.filter(|(_, touched)| *touched).map(|(channel, _)| channel.name.to_string()).collect()
}

/// What can press the loops against themselves in a position.
struct SelfStresses {
    /// Rows that forbid nothing, as a planar mechanism's out of its plane: each alone is a self-stress.
    idle: Vec<usize>,
    /// The other rows, ...
    rows: Vec<usize>,
    /// ... and their self-stresses as columns.
    among: DMatrix<f64>,
}

impl SelfStresses {
    fn new(jacobian: &SparseRows) -> Self {
        let says = |row: &usize| !jacobian.row(*row).is_empty();
        let (rows, idle): (Vec<usize>, Vec<usize>) = (0..jacobian.nrows()).partition(says);
        let among = null_space(&jacobian.select_rows(&rows).transpose());
        Self { idle, rows, among }
    }

    fn count(&self) -> usize {
        self.idle.len() + self.among.ncols()
    }

    /// These amounts of all.
    fn mixed(&self, amount: &mut dyn FnMut(usize) -> f64) -> DVector<f64> {
        let mut stress = DVector::zeros(self.idle.len() + self.rows.len());
        let among = &self.among * DVector::from_fn(self.among.ncols(), |i, _| amount(i));
        self.rows.iter().zip(among.iter()).for_each(|(row, part)| stress[*row] = *part);
        self.idle.iter().enumerate().for_each(|(i, row)| stress[*row] = amount(self.among.ncols() + i));
        stress
    }
}

/// Unit stresses: all of them if they are few, else mixtures of all.
fn mixtures(stresses: &SelfStresses, generator: &mut u64) -> Vec<DVector<f64>> {
    let count = stresses.count();
    if count <= MIXTURES {
        return (0..count).map(|one| stresses.mixed(&mut |at| f64::from(u8::from(at == one)))).collect();
    }
    (0..MIXTURES).map(|_| stresses.mixed(&mut |_| random(generator))).collect()
}

fn is_wrench(name: &str) -> bool {
    let component = name.rsplit_once('.').map(|(_, component)| component);
    component.is_some_and(|component| ["Fx", "Fy", "Fz", "Mx", "My", "Mz"].contains(&component))
}
