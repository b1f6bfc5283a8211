//! QR decomposition with pivots of columns that are mostly zeros. In: columns. Out: pivots, triangle, directions that no
//! column asks for. Never knows what rank is.
//!
//! Reflections by Householder; each is applied to the columns alone that have a place in common with it. The column with the largest
//! entry left comes next, in large matrices the one with the fewest, so that loops in a row cost as much as there are of them.

use super::entries::{Entries, add_products, largest_entry, subtract};

/// From as many places or columns as this, the column with the fewest entries left comes next, of those whose largest is not much
/// below the largest of all, and its reflection leaves the places where they are: loops in a row then cost as much as there are of
/// them. What is smaller fills anyway.
pub const SPARSE: usize = 64;

/// A column whose largest entry is below this part of the largest of all waits. A pivot this much smaller loses one digit.
const LARGE_ENOUGH: f64 = 0.1;

/// Rounds of inverse iteration: each makes the weakest direction stand out by the square of its strength against the next.
const ROUNDS: usize = 3;

/// Decomposition of columns of one length.
#[derive(Clone, Debug)]
pub struct SparseQr {
    height: usize,
    /// The triangle: of the column of every pivot the entries in the lines of the pivots before it, by number, without zeros.
    above: Vec<Entries>,
    /// The given column behind each of these.
    order: Vec<usize>,
    pivots: Vec<f64>,
    /// Unit vectors that the reflections turn round, without their zeros.
    axes: Vec<Entries>,
    /// The place that each reflection takes away.
    heads: Vec<usize>,
}

/// Columns as they are reduced.
struct Columns {
    /// What is left of each, places ascending.
    left: Vec<Entries>,
    /// Of what is left, the largest magnitude.
    largest: Vec<f64>,
    /// By place, the columns that have or had an entry there.
    at_place: Vec<Vec<usize>>,
    work: Entries,
}

impl Columns {
    fn new(height: usize, left: Vec<Entries>) -> Self {
        let mut at_place = vec![Vec::new(); height];
        for (column, entries) in left.iter().enumerate() {
            entries.iter().for_each(|(place, _)| at_place[*place].push(column));
        }
        let largest = left.iter().map(|entries| largest_entry(entries)).collect();
        Self { left, largest, at_place, work: Vec::new() }
    }

    /// Which of these comes next, by its number in the list.
    fn next(&self, list: &[usize], is_sparse: bool) -> usize {
        let larger = |best: usize, at: usize| {
            if self.largest[list[at]] > self.largest[list[best]] { at } else { best }
        };
        let largest = (1..list.len()).fold(0, larger);
        if !is_sparse {
            return largest;
        }
        let least = LARGE_ENOUGH * self.largest[list[largest]];
        let large = (0..list.len()).filter(|at| self.largest[list[*at]] >= least);
        large.min_by_key(|at| (self.left[list[*at]].len(), list[*at])).unwrap_or(largest)
    }

    /// Reflects a column and takes its place `head`, the first of the axis, out of it. Out: what was there.
    fn reflect(&mut self, column: usize, axis: &[(usize, f64)]) -> f64 {
        let Some(((head, part), others)) = axis.split_first() else { return 0.0 };
        let left = &mut self.left[column];
        let at_head = left.iter().position(|(place, _)| place == head).map_or(0.0, |at| left.remove(at).1);
        let along = add_products(at_head * part, others, left);
        if along != 0.0 {
            let is_new = |place: usize| self.at_place[place].push(column);
            subtract(left, (2.0 * along, others), &mut self.work, is_new);
        }
        self.largest[column] = largest_entry(left);
        at_head - 2.0 * along * part
    }
}

impl SparseQr {
    /// Decomposes columns of `height` entries, given by those that are not zero, places ascending.
    pub fn new(height: usize, columns: Vec<Entries>) -> Self {
        let count = columns.len();
        let is_sparse = height.max(count) >= SPARSE;
        let mut columns = Columns::new(height, columns);
        let mut order: Vec<usize> = (0..count).collect();
        let (mut is_free, mut above) = (vec![true; height], vec![Vec::new(); count]);
        let (mut pivots, mut axes, mut heads) = (Vec::new(), Vec::new(), Vec::new());
        // The step that a column was met in, or taken before.
        let mut met = vec![None; count];
        for step in 0..height.min(count) {
            let next = step + columns.next(&order[step..], is_sparse);
            order.swap(step, next);
            let left = &columns.left[order[step]];
            let head = if is_sparse { largest_place(left, &is_free) } else { step };
            let (pivot, axis) = axis(left, head);
            is_free[head] = false;
            met[order[step]] = Some(usize::MAX);
            for (place, _) in &axis {
                for at in 0..columns.at_place[*place].len() {
                    let column = columns.at_place[*place][at];
                    if met[column].is_some_and(|met| met == step || met == usize::MAX) {
                        continue;
                    }
                    met[column] = Some(step);
                    let leaves = columns.reflect(column, &axis);
                    if leaves != 0.0 {
                        above[column].push((step, leaves));
                    }
                }
            }
            pivots.push(pivot);
            axes.push(axis);
            heads.push(head);
        }
        let above = order.iter().map(|column| std::mem::take(&mut above[*column])).collect();
        Self { height, above, order, pivots, axes, heads }
    }

    /// Length of the columns.
    pub fn height(&self) -> usize {
        self.height
    }

    /// One per column or per entry of a column, whichever are fewer.
    pub fn pivots(&self) -> &[f64] {
        &self.pivots
    }

    /// Unit directions at right angles to the first `rank` columns of the decomposition and to each other.
    pub fn beyond(&self, rank: usize) -> Vec<Vec<f64>> {
        let sign: f64 = self.pivots.iter().map(|pivot| pivot.signum()).product();
        let mut is_free = vec![true; self.height];
        self.heads[..rank].iter().for_each(|head| is_free[*head] = false);
        let direction = |place: usize| {
            let mut direction = vec![0.0; self.height];
            direction[place] = sign;
            self.axes.iter().rev().for_each(|axis| reflect(axis, &mut direction));
            direction
        };
        (0..self.height).filter(|place| is_free[*place]).map(direction).collect()
    }

    /// The weakest singular value of the first `rank` columns of the decomposition, or somewhat above it.
    pub fn weakest(&self, rank: usize) -> f64 {
        let mut direction = vec![1.0; rank];
        let mut least = f64::INFINITY;
        for _ in 0..ROUNDS {
            self.solve_triangles(&mut direction);
            let size = direction.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            direction.iter_mut().for_each(|entry| *entry /= size);
            least = (1.0 / size).sqrt();
        }
        least
    }

    /// Amounts of the given columns with `columns' columns amounts = right`, of as many pivots as there are columns.
    pub fn solve_normal(&self, right: &[f64]) -> Vec<f64> {
        let mut along: Vec<f64> = self.order.iter().map(|place| right[*place]).collect();
        self.solve_triangles(&mut along);
        let mut amounts = vec![0.0; right.len()];
        self.order.iter().zip(along).for_each(|(place, amount)| amounts[*place] = amount);
        amounts
    }

    /// Puts in the place of `x`, given in the order of the pivots, what the triangle's transpose times the triangle makes `x` of.
    fn solve_triangles(&self, x: &mut [f64]) {
        for k in 0..x.len() {
            let known: f64 = self.above[k].iter().map(|(i, entry)| entry * x[*i]).sum();
            x[k] = (x[k] - known) / self.pivots[k];
        }
        for k in (0..x.len()).rev() {
            x[k] /= self.pivots[k];
            let amount = x[k];
            self.above[k].iter().for_each(|(i, entry)| x[*i] -= amount * entry);
        }
    }
}

/// The place of the largest entry, the first among equals; of a column of zeros, whose places are all free, the first free one.
fn largest_place(column: &[(usize, f64)], is_free: &[bool]) -> usize {
    let larger =
        |best: (usize, f64), entry: (usize, f64)| if entry.1.abs() > best.1.abs() { entry } else { best };
    let largest = column.iter().copied().reduce(larger);
    largest.map(|(place, _)| place).or_else(|| is_free.iter().position(|is_free| *is_free)).unwrap_or(0)
}

/// What a column leaves at place `head`, and the axis of the reflection that takes its other places away, the head first.
fn axis(column: &[(usize, f64)], head: usize) -> (f64, Entries) {
    let others = column.iter().filter(|(place, _)| *place != head);
    let lead = column.iter().find(|(place, _)| *place == head).map_or(0.0, |(_, entry)| *entry);
    let mut axis: Entries = std::iter::once(&(head, lead)).chain(others).copied().collect();
    let square: f64 = axis.iter().map(|(_, entry)| entry * entry).sum();
    let norm = square.sqrt();
    let size = (2.0 * (square + lead.abs() * norm)).sqrt();
    if size == 0.0 {
        return (0.0, Vec::new());
    }
    axis[0].1 += if lead < 0.0 { -norm } else { norm };
    axis.iter_mut().for_each(|(_, entry)| *entry /= size);
    (if lead < 0.0 { norm } else { -norm }, axis)
}

/// Reflects a vector.
fn reflect(axis: &[(usize, f64)], vector: &mut [f64]) {
    let along: f64 = axis.iter().map(|(place, part)| vector[*place] * part).sum();
    if along != 0.0 {
        axis.iter().for_each(|(place, part)| vector[*place] -= 2.0 * along * part);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// Columns of a chain: three entries each, one in common with the next.
    fn chain(links: usize) -> Vec<Entries> {
        let mut seed = 11_u64;
        let mut drawn = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            0.5 + (seed >> 40) as f64 / f64::from(1 << 23)
        };
        let mut column = |link: usize| (2 * link..2 * link + 3).map(|place| (place, drawn())).collect();
        (0..links).map(&mut column).collect()
    }

    #[test]
    fn products_of_the_columns_are_those_of_the_triangle() {
        // Some below, some above the length from which places stay where they are.
        for links in [9, 60] {
            let (columns, height) = (chain(links), 2 * links + 1);
            let mut given = DMatrix::zeros(height, links);
            for (at, column) in columns.iter().enumerate() {
                column.iter().for_each(|(place, entry)| given[(*place, at)] = *entry);
            }
            let factor = SparseQr::new(height, columns);
            assert!(factor.pivots().windows(2).all(|pair| pair[1].abs() > 0.05 * pair[0].abs()));
            let weakest = given.singular_values().min();
            // Three rounds come near it; what they find is no less.
            assert!((0.999 * weakest..2.0 * weakest).contains(&factor.weakest(links)));
            let right: Vec<f64> = (0..links).map(|i| i as f64 - 3.0).collect();
            let amounts = DMatrix::from_column_slice(links, 1, &factor.solve_normal(&right));
            let reached = given.tr_mul(&(&given * amounts));
            // The condition of the products is below a thousand, the numbers below a hundred.
            assert!(reached.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-11), "{reached}");
            let beyond = factor.beyond(links).concat();
            let beyond = DMatrix::from_column_slice(height, links + 1, &beyond);
            assert!(given.tr_mul(&beyond).amax() < 1e-14);
            assert!((beyond.tr_mul(&beyond) - DMatrix::identity(links + 1, links + 1)).amax() < 1e-14);
        }
    }

    #[test]
    fn long_chains_take_no_more_entries_a_link_than_short_ones() {
        let entries = |links: usize| {
            let factor = SparseQr::new(2 * links + 1, chain(links));
            let axes: usize = factor.axes.iter().map(Vec::len).sum();
            (axes + factor.above.iter().map(Vec::len).sum::<usize>()) as f64 / links as f64
        };
        // The columns are drawn, and so is the order of the pivots.
        assert!(entries(400) < 1.3 * entries(100));
    }

    #[test]
    fn columns_of_zeros_and_repeated_ones_have_no_pivots() {
        let mut columns = chain(3);
        columns.insert(1, Vec::new());
        columns.push(columns[0].clone());
        let factor = SparseQr::new(7, columns);
        let pivots: Vec<f64> = factor.pivots().iter().map(|pivot| pivot.abs()).collect();
        assert!(pivots.len() == 5 && pivots[..3].iter().all(|pivot| *pivot > 0.1));
        assert!(pivots[3..].iter().all(|pivot| *pivot < 1e-15));
        assert!(factor.beyond(3).len() == 4 && factor.beyond(3)[0].len() == 7);
    }
}
