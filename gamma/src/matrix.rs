//! Small symmetric matrices, a few parameters wide. In: matrices by rows. Out: factors, solutions. Never knows what they
//! are of.

/// Lower triangular Cholesky factor, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Factor(Vec<Vec<f64>>);

/// Root of a pivot, from what is left of a diagonal entry and the entry itself; None refuses the matrix.
type Pivot = fn(f64, f64) -> Option<f64>;

impl Factor {
    /// Of a positive definite matrix; None if it is not. NaN, too, is not positive definite.
    pub fn definite(matrix: &[Vec<f64>]) -> Option<Self> {
        Self::with(matrix, |rest, _| (rest > 0.0).then(|| libm::sqrt(rest)))
    }

    /// Of a covariance of `size` variables, which may have no variance in some directions: they get zero columns.
    ///
    /// # Errors
    /// What is wrong with the matrix.
    pub fn covariance(matrix: &[Vec<f64>], size: usize) -> Result<Self, &'static str> {
        if matrix.len() != size || matrix.iter().any(|row| row.len() != size) {
            return Err("another size than the parameters");
        }
        if matrix.iter().flatten().any(|value| !value.is_finite()) {
            return Err("a value is no finite number");
        }
        for i in 0..size {
            for j in 0..i {
                let scale = libm::sqrt((matrix[i][i] * matrix[j][j]).abs());
                if (matrix[i][j] - matrix[j][i]).abs() > 1e-6 * scale {
                    return Err("not symmetric");
                }
            }
        }
        // Rounding of printed matrices may leave a tiny negative pivot.
        let pivot: Pivot =
            |rest, entry| (entry >= 0.0 && rest >= -1e-9 * entry).then(|| libm::sqrt(rest.max(0.0)));
        Self::with(matrix, pivot).ok_or("negative in some direction")
    }

    fn with(matrix: &[Vec<f64>], pivot: Pivot) -> Option<Self> {
        let size = matrix.len();
        let mut lower = vec![vec![0.0; size]; size];
        for i in 0..size {
            for j in 0..=i {
                let inner: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let rest: f64 = matrix[i][j] - inner;
                lower[i][j] = if i == j {
                    pivot(rest, matrix[i][i])?
                } else if lower[j][j] > 0.0 {
                    rest / lower[j][j]
                } else {
                    0.0
                };
            }
        }
        Some(Self(lower))
    }

    /// Whether it is of no matrix at all.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// L z; nothing for an empty factor.
    pub fn times(&self, z: &[f64]) -> Vec<f64> {
        let row = |row: &Vec<f64>| row.iter().zip(z).map(|(a, b)| a * b).sum();
        self.0.iter().map(row).collect()
    }

    /// |L' g|²: variance of g · x.
    pub fn variance(&self, gradient: &[f64]) -> f64 {
        let column = |j: usize| -> f64 { self.0.iter().zip(gradient).map(|(row, g)| row[j] * g).sum() };
        (0..self.0.len()).map(|j| column(j) * column(j)).sum()
    }

    /// L^-1 d; None where a direction has no variance.
    fn forward(&self, d: &[f64]) -> Option<Vec<f64>> {
        let mut x = d.to_vec();
        for (i, row) in self.0.iter().enumerate() {
            if row[i] <= 0.0 {
                return None;
            }
            let inner: f64 = (0..i).map(|k| row[k] * x[k]).sum();
            x[i] = (x[i] - inner) / row[i];
        }
        Some(x)
    }

    /// |L^-1 d|²: squared distance in standard deviations; None where a direction has no variance.
    pub fn distance(&self, d: &[f64]) -> Option<f64> {
        Some(self.forward(d)?.iter().map(|x| x * x).sum())
    }

    /// Solution of L L' x = right; None where a direction has no variance.
    pub fn solve(&self, right: &[f64]) -> Option<Vec<f64>> {
        let mut x = self.forward(right)?;
        for i in (0..x.len()).rev() {
            let inner: f64 = (i + 1..x.len()).map(|k| self.0[k][i] * x[k]).sum();
            x[i] = (x[i] - inner) / self.0[i][i];
        }
        Some(x)
    }

    /// Inverse of L L', symmetric to the last bit; None where a direction has no variance.
    pub fn inverse(&self) -> Option<Vec<Vec<f64>>> {
        let size = self.0.len();
        let column = |at: usize| {
            let mut unit = vec![0.0; size];
            unit[at] = 1.0;
            self.solve(&unit)
        };
        let columns = (0..size).map(column).collect::<Option<Vec<_>>>()?;
        let entry = |i: usize, j: usize| columns[i.min(j)][i.max(j)];
        Some((0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_system_is_solved_and_an_indefinite_one_refused() {
        let factor = Factor::definite(&[vec![4.0, 2.0], vec![2.0, 3.0]]).expect("definite");
        let x = factor.solve(&[8.0, 8.0]).expect("definite");
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15, "{x:?}");
        let inverse = factor.inverse().expect("definite");
        assert!((inverse[0][0] - 0.375).abs() < 1e-15 && (inverse[0][1] + 0.25).abs() < 1e-15);
        assert_eq!(Factor::definite(&[vec![1.0, 2.0], vec![2.0, 1.0]]), None);
    }

    #[test]
    fn a_covariance_may_leave_a_direction_without_variance() {
        let flat = [vec![1.0, 1.0], vec![1.0, 1.0]];
        let factor = Factor::covariance(&flat, 2).expect("semi-definite");
        assert_eq!(factor.variance(&[1.0, -1.0]), 0.0);
        assert_eq!((factor.distance(&[0.1, 0.1]), Factor::definite(&flat)), (None, None));
    }
}
