//! Whether modal data can belong to a body: shapes of the lists, symmetry, definiteness.
//! In: [`ModalData`] from anywhere. Out: the first thing that is wrong, with its place.

use nalgebra::{DMatrix, Matrix3, Vector3};
use thiserror::Error;

use super::data::{ModalData, transposed};

/// What cannot be in the modal data of a body. `place` names the key as the file does.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DataError {
    /// A list of the wrong length.
    #[error("{place} has {found} entries, not {expected}")]
    Length {
        /// The list.
        place: String,
        /// Its length.
        found: usize,
        /// What the number of modes asks for.
        expected: usize,
    },
    /// Infinite or not a number.
    #[error("{place} is not finite")]
    NotFinite {
        /// The number.
        place: String,
    },
    /// A name given twice.
    #[error("the name {name} is given twice among the {place}s")]
    Twice {
        /// `mode` or `node`.
        place: &'static str,
        /// The name.
        name: String,
    },
    /// A matrix that must be symmetric is not.
    #[error("{place} is not symmetric")]
    NotSymmetric {
        /// The matrix.
        place: String,
    },
    /// A matrix or number that must be positive is not.
    #[error("{place} is not positive{}", if *.definite { " definite" } else { "" })]
    NotPositive {
        /// The matrix or number.
        place: String,
        /// Whether it is a matrix.
        definite: bool,
    },
    /// A number is below 0.
    #[error("{place} is negative")]
    Negative {
        /// The number.
        place: String,
    },
    /// The mass matrix of rigid and modal motion together has a direction of negative mass: Γ, C, M_ff and the rigid
    /// constants do not come from one body.
    #[error(
        "gamma, moment, mass_matrix and the rigid constants do not belong to one body: a motion has negative mass"
    )]
    NegativeMass,
    /// Products of these modes over the mass are of no body.
    #[error(
        "the couplings of {} do not belong to one body with gamma, moment and the rigid constants: a motion has negative mass{}",
        .modes.iter().map(|mode| format!("mode {mode}")).collect::<Vec<_>>().join(", "),
        if *.missing { "; a mode has no [[coupling]] with itself" } else { "" }
    )]
    Products {
        /// Their names: one, where that is wrong alone.
        modes: Vec<String>,
        /// Whether one has no coupling with itself.
        missing: bool,
    },
    /// A node has `displacement2` and the body no second order, or the other way round.
    #[error("node {node} must have displacement2 exactly when order = 2")]
    Order {
        /// Name of the node.
        node: String,
    },
}

/// Negative eigenvalues of a matrix scaled to diagonal 1 down to this count as rounding: written data have six digits.
const WRITTEN: f64 = 1e-6;

/// Entries of a symmetric matrix may differ by this part of their diagonal: rounding of the program that wrote them.
const SYMMETRIC: f64 = 1e-9;

impl ModalData {
    /// Checks lengths, symmetry and definiteness.
    ///
    /// # Errors
    /// The first thing found wrong.
    pub fn check(&self) -> Result<(), DataError> {
        self.check_lengths()?;
        self.check_names()?;
        self.check_finite()?;
        if self.mass <= 0.0 {
            return Err(DataError::NotPositive { place: "mass".to_owned(), definite: false });
        }
        if let Some(mode) = self.modes.iter().find(|mode| mode.frequency < 0.0) {
            return Err(DataError::Negative { place: format!("frequency of mode {}", mode.name) });
        }
        symmetric("second_moment", &square3(&self.second_moment))?;
        for k in 0..self.mode_count() {
            symmetric(
                &format!("coupling of {0} with {0}", self.modes[k].name),
                &square3(&self.coupling[k][k]),
            )?;
        }
        for k in 0..self.mode_count() {
            if let Some(l) = (0..k).find(|l| self.coupling[k][*l] != transposed(&self.coupling[*l][k])) {
                let place = format!("coupling of {} with {}", self.modes[k].name, self.modes[l].name);
                return Err(DataError::NotSymmetric { place });
            }
        }
        let mass = definite("mass_matrix", &self.mass_matrix)?;
        if mass.cholesky().is_none() {
            return Err(DataError::NotPositive { place: "mass_matrix".to_owned(), definite: true });
        }
        definite("stiffness", &self.stiffness)?;
        definite("damping", &self.damping)?;
        definite("second_moment", &self.second_moment.map(|row| row.to_vec()))?;
        semidefinite(&self.full_mass_matrix()).then_some(()).ok_or(DataError::NegativeMass)?;
        self.check_products()
    }

    fn check_lengths(&self) -> Result<(), DataError> {
        let n = self.mode_count();
        length("gamma", self.gamma.len(), n)?;
        length("moment", self.moment.len(), n)?;
        table("coupling", &self.coupling, n)?;
        table("mass_matrix", &self.mass_matrix, n)?;
        table("stiffness", &self.stiffness, n)?;
        table("damping", &self.damping, n)?;
        if let Some(second) = &self.second_order {
            table("second_order.gamma", &second.gamma, n)?;
            table("second_order.moment", &second.moment, n)?;
        }
        for node in &self.nodes {
            let name = &node.name;
            length(&format!("displacement of node {name}"), node.displacement.len(), n)?;
            length(&format!("rotation of node {name}"), node.rotation.len(), n)?;
            if node.displacement2.is_some() != self.second_order.is_some() {
                return Err(DataError::Order { node: name.clone() });
            }
            if let Some(second) = &node.displacement2 {
                table(&format!("displacement2 of node {name}"), second, n)?;
            }
            if let Some(strain) = &node.strain {
                length(&format!("strain.extension of node {name}"), strain.extension.len(), n)?;
                length(&format!("strain.curvature_y of node {name}"), strain.curvature_y.len(), n)?;
                length(&format!("strain.curvature_z of node {name}"), strain.curvature_z.len(), n)?;
            }
        }
        Ok(())
    }

    fn check_names(&self) -> Result<(), DataError> {
        let modes: Vec<&String> = self.modes.iter().map(|mode| &mode.name).collect();
        let nodes: Vec<&String> = self.nodes.iter().map(|node| &node.name).collect();
        for (place, names) in [("mode", modes), ("node", nodes)] {
            for (index, name) in names.iter().enumerate() {
                if names[..index].contains(name) {
                    return Err(DataError::Twice { place, name: (*name).clone() });
                }
            }
        }
        Ok(())
    }

    fn check_finite(&self) -> Result<(), DataError> {
        let finite = |place: &str, mut numbers: &mut dyn Iterator<Item = f64>| {
            let wrong = || DataError::NotFinite { place: place.to_owned() };
            // By a reference: `all` needs a sized iterator.
            (&mut numbers).all(f64::is_finite).then_some(()).ok_or_else(wrong)
        };
        finite("mass", &mut [self.mass].into_iter())?;
        finite("first_moment", &mut self.first_moment.into_iter())?;
        finite("second_moment", &mut self.second_moment.into_iter().flatten())?;
        finite("frequency", &mut self.modes.iter().map(|mode| mode.frequency))?;
        finite("gamma", &mut self.gamma.iter().flatten().copied())?;
        finite("moment", &mut self.moment.iter().flatten().flatten().copied())?;
        finite("coupling", &mut self.coupling.iter().flatten().flatten().flatten().copied())?;
        finite("mass_matrix", &mut self.mass_matrix.iter().flatten().copied())?;
        finite("stiffness", &mut self.stiffness.iter().flatten().copied())?;
        finite("damping", &mut self.damping.iter().flatten().copied())?;
        if let Some(second) = &self.second_order {
            let gamma = second.gamma.iter().flatten().flatten();
            let moment = second.moment.iter().flatten().flatten().flatten();
            finite("second_order", &mut gamma.chain(moment).copied())?;
        }
        for node in &self.nodes {
            let shapes = node.displacement.iter().chain(&node.rotation).flatten();
            let second = node.displacement2.iter().flatten().flatten().flatten();
            let strain = node.strain.iter().flat_map(|strain| {
                let lists = strain.extension.iter().chain(&strain.curvature_y).chain(&strain.curvature_z);
                lists.chain([&strain.youngs_modulus])
            });
            let mut all = node.position.iter().chain(shapes).chain(second).chain(strain).copied();
            finite(&format!("node {}", node.name), &mut all)?;
        }
        Ok(())
    }

    /// Mass matrix of the undeformed body over velocity of the origin, angular velocity and modal speeds:
    /// [m 1, -s0~, Γ; s0~, J, ∫ rbar x φ; Γᵀ, (∫ rbar x φ)ᵀ, M_ff]. Lists must have their lengths.
    pub fn full_mass_matrix(&self) -> DMatrix<f64> {
        let n = self.mode_count();
        let mut full = DMatrix::zeros(6 + n, 6 + n);
        let second = Matrix3::from_fn(|i, j| self.second_moment[i][j]);
        let skew = Vector3::from(self.first_moment).cross_matrix();
        full.view_mut((0, 0), (3, 3)).fill_diagonal(self.mass);
        full.view_mut((3, 0), (3, 3)).copy_from(&skew);
        full.view_mut((0, 3), (3, 3)).copy_from(&-skew);
        full.view_mut((3, 3), (3, 3)).copy_from(&(Matrix3::identity() * second.trace() - second));
        for k in 0..n {
            let c = self.moment[k];
            let spin = [c[1][2] - c[2][1], c[2][0] - c[0][2], c[0][1] - c[1][0]];
            for i in 0..3 {
                full[(i, 6 + k)] = self.gamma[k][i];
                full[(6 + k, i)] = self.gamma[k][i];
                full[(3 + i, 6 + k)] = spin[i];
                full[(6 + k, 3 + i)] = spin[i];
            }
            for l in 0..n {
                full[(6 + k, 6 + l)] = self.mass_matrix[k][l];
            }
        }
        full
    }
}

/// A table as a matrix, when it is symmetric and has no negative direction.
fn definite(place: &str, rows: &[Vec<f64>]) -> Result<DMatrix<f64>, DataError> {
    let matrix = DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j]);
    symmetric(place, &matrix)?;
    let wrong = || DataError::NotPositive { place: place.to_owned(), definite: true };
    semidefinite(&matrix).then_some(matrix).ok_or_else(wrong)
}

fn table<T>(place: &str, rows: &[Vec<T>], n: usize) -> Result<(), DataError> {
    let lengths = std::iter::once(rows.len()).chain(rows.iter().map(Vec::len));
    lengths.into_iter().try_for_each(|found| length(place, found, n))
}

fn length(place: &str, found: usize, expected: usize) -> Result<(), DataError> {
    let wrong = || DataError::Length { place: place.to_owned(), found, expected };
    (found == expected).then_some(()).ok_or_else(wrong)
}

fn square3(matrix: &[[f64; 3]; 3]) -> DMatrix<f64> {
    DMatrix::from_fn(3, 3, |i, j| matrix[i][j])
}

fn symmetric(place: &str, matrix: &DMatrix<f64>) -> Result<(), DataError> {
    for i in 0..matrix.nrows() {
        for j in 0..i {
            let scale = matrix[(i, i)].abs().max(matrix[(j, j)].abs());
            if (matrix[(i, j)] - matrix[(j, i)]).abs() > SYMMETRIC * scale {
                return Err(DataError::NotSymmetric { place: place.to_owned() });
            }
        }
    }
    Ok(())
}

/// Whether no direction is negative. A direction of diagonal 0 (the axis of a thin line) must be 0 throughout.
fn semidefinite(matrix: &DMatrix<f64>) -> bool {
    let n = matrix.nrows();
    let size = |i: usize| matrix[(i, i)];
    if (0..n).any(|i| size(i) < 0.0 || (size(i) == 0.0 && matrix.row(i).iter().any(|entry| *entry != 0.0))) {
        return false;
    }
    let scaled = DMatrix::from_fn(n, n, |i, j| match (size(i) * size(j)).sqrt() {
        0.0 => 0.0,
        scale => matrix[(i, j)] / scale,
    });
    n == 0 || scaled.symmetric_eigenvalues().min() >= -WRITTEN
}
