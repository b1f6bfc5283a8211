//! QR decomposition with pivots of columns that are mostly zeros. In: columns. Out: pivots, triangle, directions that no
//! column asks for. Never knows what rank is.
//!
//! Reflections by Householder; each is applied to the columns alone that have a place in common with it, so that loops in a
//! row cost as much as there are of them. The column with the largest entry left comes next.

use nalgebra::DMatrix;

/// Decomposition of columns of one length.
pub struct PivotedQr {
    height: usize,
    /// The triangle: of column `k` the first `k` entries and the pivot, in the order of the pivots.
    columns: Vec<Vec<f64>>,
    /// The given column behind each of these.
    order: Vec<usize>,
    pivots: Vec<f64>,
    /// Unit vectors that the reflections turn round, without their zeros.
    axes: Vec<Vec<(usize, f64)>>,
}

impl PivotedQr {
    /// Decomposes columns of `height` entries.
    pub fn new(height: usize, columns: Vec<Vec<f64>>) -> Self {
        let count = columns.len();
        let (order, steps) = ((0..count).collect(), height.min(count));
        let mut factor = Self { height, columns, order, pivots: Vec::new(), axes: Vec::new() };
        let mut largest: Vec<f64> = factor.columns.iter().map(|column| amax(column)).collect();
        for step in 0..steps {
            let next =
                (step + 1..count).fold(step, |best, j| if largest[j] > largest[best] { j } else { best });
            factor.columns.swap(step, next);
            factor.order.swap(step, next);
            largest.swap(step, next);
            let (head, axis) = axis(&factor.columns[step], step);
            factor.pivots.push(head);
            factor.columns[step][step] = head;
            for (column, largest) in factor.columns[step + 1..].iter_mut().zip(&mut largest[step + 1..]) {
                let loses = column[step] != 0.0;
                if reflect(&axis, column) || loses {
                    *largest = amax(&column[step + 1..]);
                }
            }
            factor.axes.push(axis);
        }
        factor
    }

    /// One per column or per entry of a column, whichever are fewer.
    pub fn pivots(&self) -> &[f64] {
        &self.pivots
    }

    /// Unit directions at right angles to the first `rank` columns of the decomposition, as columns.
    pub fn beyond(&self, rank: usize) -> DMatrix<f64> {
        let sign: f64 = self.pivots.iter().map(|pivot| pivot.signum()).product();
        let mut directions = DMatrix::zeros(self.height, self.height - rank);
        for (place, mut direction) in directions.column_iter_mut().enumerate() {
            direction[rank + place] = sign;
            for axis in self.axes.iter().rev() {
                reflect(axis, direction.as_mut_slice());
            }
        }
        directions
    }

    /// Amounts of the given columns with `columns' columns amounts = right`, of as many pivots as there are columns.
    pub fn solve_normal(&self, right: &[f64]) -> Vec<f64> {
        let mut along: Vec<f64> = Vec::with_capacity(right.len());
        for (k, (place, column)) in self.order.iter().zip(&self.columns).enumerate() {
            let known: f64 = column.iter().zip(&along).map(|(entry, known)| entry * known).sum();
            along.push((right[*place] - known) / self.pivots[k]);
        }
        let mut amounts = vec![0.0; right.len()];
        for (k, (place, column)) in self.order.iter().zip(&self.columns).enumerate().rev() {
            let amount = along[k] / self.pivots[k];
            amounts[*place] = amount;
            for (along, entry) in along[..k].iter_mut().zip(column) {
                *along -= amount * entry;
            }
        }
        amounts
    }
}

fn amax(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| if value.abs() > most { value.abs() } else { most })
}

/// What a column leaves at place `from`, and the axis of the reflection that takes the places below away.
fn axis(column: &[f64], from: usize) -> (f64, Vec<(usize, f64)>) {
    let below = column.iter().copied().enumerate().skip(from);
    let mut axis: Vec<(usize, f64)> =
        below.filter(|(place, entry)| *entry != 0.0 || *place == from).collect();
    let square: f64 = axis.iter().map(|(_, entry)| entry * entry).sum();
    let (norm, lead) = (square.sqrt(), column[from]);
    let size = (2.0 * (square + lead.abs() * norm)).sqrt();
    if size == 0.0 {
        return (0.0, Vec::new());
    }
    axis[0].1 += if lead < 0.0 { -norm } else { norm };
    axis.iter_mut().for_each(|(_, entry)| *entry /= size);
    (if lead < 0.0 { norm } else { -norm }, axis)
}

/// Reflects a vector; whether that changed it.
fn reflect(axis: &[(usize, f64)], vector: &mut [f64]) -> bool {
    let along: f64 = axis.iter().map(|(place, part)| vector[*place] * part).sum();
    if along != 0.0 {
        axis.iter().for_each(|(place, part)| vector[*place] -= 2.0 * along * part);
    }
    along != 0.0
}

#[cfg(test)]
mod tests {
    use super::super::samples::random;
    use super::*;

    /// Columns of a chain: three entries each, one in common with the next.
    fn chain(links: usize) -> Vec<Vec<f64>> {
        let mut generator = 11;
        let column = |link: usize| {
            let mut column = vec![0.0; 2 * links + 1];
            column[2 * link..2 * link + 3].fill_with(|| 1.5 + random(&mut generator));
            column
        };
        (0..links).map(column).collect()
    }

    #[test]
    fn products_of_the_columns_are_those_of_the_triangle() {
        let columns = chain(9);
        let given = DMatrix::from_fn(19, 9, |i, j| columns[j][i]);
        let factor = PivotedQr::new(19, columns);
        assert!(factor.pivots().windows(2).all(|pair| pair[1].abs() > 0.05 * pair[0].abs()));
        let right: Vec<f64> = (0..9).map(|i| f64::from(i) - 3.0).collect();
        let amounts = DMatrix::from_column_slice(9, 1, &factor.solve_normal(&right));
        let reached = given.tr_mul(&(&given * amounts));
        // The condition of the products is below a thousand.
        assert!(reached.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-12), "{reached}");
        let beyond = factor.beyond(9);
        assert!(given.tr_mul(&beyond).amax() < 1e-14);
        assert!((beyond.tr_mul(&beyond) - DMatrix::identity(10, 10)).amax() < 1e-14);
    }

    #[test]
    fn columns_of_zeros_and_repeated_ones_have_no_pivots() {
        let mut columns = chain(3);
        columns.insert(1, vec![0.0; 7]);
        columns.push(columns[0].clone());
        let factor = PivotedQr::new(7, columns);
        let pivots: Vec<f64> = factor.pivots().iter().map(|pivot| pivot.abs()).collect();
        assert!(pivots.len() == 5 && pivots[..3].iter().all(|pivot| *pivot > 0.1));
        assert!(pivots[3..].iter().all(|pivot| *pivot < 1e-15));
        assert_eq!(factor.beyond(3).shape(), (7, 4));
    }
}
