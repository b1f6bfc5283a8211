//! Matrices of elastic mounts, six by six: units by block, symmetry, and whether they store and take energy.

use nalgebra::Matrix6;

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::Formula;
use crate::spec::{At, Dimension, ForceSpec, Name, SixNumbers};

/// How far entries across the diagonal may differ and eigenvalues be below zero, beside a diagonal of ones: digits that a finite
/// element program prints.
const PRINTED: f64 = 1e-6;

const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl Resolver<'_> {
    /// The 36 entries, row by row. Of two across the diagonal both are the upper one, so that energy is one.
    pub(super) fn matrix(
        &mut self,
        name: &Name,
        key: &str,
        written: Option<&At<Vec<SixNumbers>>>,
        [first, mixed, last]: [Dimension; 3],
    ) -> Vec<Formula> {
        let dimension = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => first,
            (false, false) => last,
            _ => mixed,
        };
        let entry =
            |value: f64| (0..36).map(|at| Formula::number(value, dimension(at / 6, at % 6))).collect();
        let Some(written) = written else { return entry(0.0) };
        let what = place(key, "force", name);
        if written.value.len() != 6 {
            self.wrong_count(written.span, written.value.len(), "6 rows", &what);
            return entry(f64::NAN);
        }
        let mut rows: Vec<Vec<Formula>> = Vec::with_capacity(6);
        for (i, SixNumbers(row)) in written.value.iter().enumerate() {
            if row.value.len() != 6 {
                self.wrong_count(row.span, row.value.len(), "6", &format!("row {} of {what}", i + 1));
                return entry(f64::NAN);
            }
            let of_row = row.value.iter().enumerate();
            rows.push(
                of_row
                    .map(|(j, entry)| self.formula(entry, Some(dimension(i, j)), Allowed::PARAMETERS, &what))
                    .collect(),
            );
        }
        self.check_matrix(&rows, &what);
        (0..36).map(|at| rows[(at / 6).min(at % 6)][(at / 6).max(at % 6)].clone()).collect()
    }

    fn check_matrix(&mut self, rows: &[Vec<Formula>], what: &str) {
        let values = Matrix6::from_fn(|i, j| self.value(&rows[i][j]));
        if values.iter().any(|value| !value.is_finite()) {
            return;
        }
        for i in 0..6 {
            for j in 0..i {
                let (lower, upper) = (values[(i, j)], values[(j, i)]);
                // Entries of a semidefinite matrix are no larger than this.
                let scale =
                    (values[(i, i)].abs() * values[(j, j)].abs()).sqrt().max(lower.abs().min(upper.abs()));
                if (lower - upper).abs() > PRINTED * scale {
                    let message = format!(
                        "{what} is not symmetric: {} in row {}, column {}, but {} across the diagonal",
                        lower,
                        i + 1,
                        j + 1,
                        upper
                    );
                    self.refuse(Code::BadMatrix, rows[i][j].span, message)
                        .help("a spring has one energy, so its matrix is symmetric: check signs, units and the order x, y, z, rx, ry, rz");
                    return;
                }
            }
        }
        let root = |i: usize| values[(i, i)].max(0.0).sqrt();
        if let Some(i) = (0..6).find(|i| values[(*i, *i)] < 0.0) {
            let message = format!("{what} is negative on its diagonal, in row {}", i + 1);
            self.refuse(Code::BadMatrix, rows[i][i].span, message)
                .help("pushed along that axis it would push on");
            return;
        }
        let loose = |i: usize, j: usize| values[(i, j)] != 0.0 && (root(i) == 0.0 || root(j) == 0.0);
        let scaled = Matrix6::from_fn(|i, j| {
            let scale = root(i) * root(j);
            if scale == 0.0 { f64::from(loose(i, j)) } else { values[(i, j)] / scale }
        });
        let symmetric = 0.5 * (scaled + scaled.transpose());
        let eigen = symmetric.symmetric_eigen();
        let (least, value) = eigen.eigenvalues.argmin();
        if value >= -PRINTED {
            return;
        }
        let direction = eigen.eigenvectors.column(least);
        let shares =
            (0..6).filter(|i| direction[*i].abs() > 0.3).map(|i| NAMES[i]).collect::<Vec<_>>().join(", ");
        let message = format!("{what} is not positive semidefinite: an eigenvalue is below zero");
        self.refuse(Code::BadMatrix, rows[0][0].span, message).help(format!(
            "a motion of {shares} would give energy: each entry beside the diagonal is at most the root of the product of the two on it"
        ));
    }

    /// Reports what is given by axis and as a matrix.
    pub(super) fn check_one_matrix(&mut self, name: &Name, spec: &ForceSpec) {
        let by_axis = |of: fn(&crate::spec::ByAxis) -> bool| {
            let parts = [&spec.translation, &spec.rotation];
            parts.into_iter().flatten().any(|part| of(&part.value))
        };
        for (key, matrix, twice) in [
            ("stiffness_matrix", &spec.stiffness_matrix, by_axis(|part| part.stiffness.is_some())),
            ("damping_matrix", &spec.damping_matrix, by_axis(|part| part.damping.is_some())),
        ] {
            if let (Some(matrix), true) = (matrix, twice) {
                let message = format!("`{}` has a `{key}`, and the same by axis", name.value);
                self.refuse(Code::ConflictingKeys, matrix.span, message)
                    .help("write all of it into the matrix, or take the matrix away");
            }
        }
    }
}
