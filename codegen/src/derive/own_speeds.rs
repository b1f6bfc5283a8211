//! Speeds that the rows of one cut alone have, taken out within these rows.
//! In: [`PlanBlock`] with one row more than speeds, the loop Jacobian. Out: expressions. Never knows mechanics.
//!
//! With C the columns of these speeds in the rows and n at right angles to them, `n . rows` has none of them: one row is left to
//! all other speeds. These once known, the own ones follow by the dual columns D (`Dᵀ C = 1`, `Dᵀ n = 0`), and multipliers are
//! `D f + mu n` with what the own speeds feel and the multiplier of the row that is left. No entry is divided by, only the
//! square of n.

use crate::expr::{Expr, Scope, Vec3};

use super::plan::PlanBlock;

/// The own speeds of one cut.
pub struct OwnSpeeds<'a, 'g> {
    g: &'g Scope,
    pub plan: &'a PlanBlock,
    /// n.
    normal: Vec<Expr<'g>>,
    /// Of every speed, its column of D times `n . n`.
    duals: Vec<Vec<Expr<'g>>>,
    square: Expr<'g>,
    reciprocal: Expr<'g>,
}

impl<'a, 'g> OwnSpeeds<'a, 'g> {
    /// Of two rows, or of three.
    pub fn new(g: &'g Scope, plan: &'a PlanBlock, jacobian: &[Vec<Expr<'g>>]) -> Self {
        let column = |at: usize| -> Vec<Expr<'g>> {
            plan.rows.iter().map(|row| jacobian[*row][plan.speeds[at]]).collect()
        };
        let (normal, duals) = match plan.speeds.len() {
            1 => {
                let along = column(0);
                (vec![-along[1], along[0]], vec![along])
            }
            _ => {
                let [a, b] = [0, 1].map(|at| Vec3::first_of(&column(at)));
                let normal = a.cross(b);
                (normal.0.to_vec(), vec![b.cross(normal).0.to_vec(), normal.cross(a).0.to_vec()])
            }
        };
        let square = g.sum(normal.iter().map(|entry| entry.square()));
        Self { g, plan, normal, duals, square, reciprocal: square.recip() }
    }

    /// The row that stands for the one that is left.
    pub fn left(&self) -> usize {
        self.plan.left()
    }

    /// `n . rows`, of something that every row has.
    pub fn combined(&self, of_row: impl Fn(usize) -> Expr<'g>) -> Expr<'g> {
        let rows = self.plan.rows.iter().map(|row| of_row(*row));
        self.dot(&self.normal, &rows.collect::<Vec<_>>())
    }

    fn dot(&self, a: &[Expr<'g>], b: &[Expr<'g>]) -> Expr<'g> {
        self.g.sum(a.iter().zip(b).map(|(a, b)| *a * *b))
    }

    /// The own speeds' share of the rows' right sides.
    pub fn solve(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.duals.iter().map(|dual| self.reciprocal * self.dot(dual, right)).collect()
    }

    /// Multipliers of the rows, for what the own speeds feel, without that of the row that is left.
    pub fn push(&self, felt: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let felt: Vec<Expr<'g>> = felt.iter().map(|felt| self.reciprocal * *felt).collect();
        let of_row = |row: usize| {
            let entries: Vec<Expr<'g>> = self.duals.iter().map(|dual| dual[row]).collect();
            self.dot(&entries, &felt)
        };
        (0..self.plan.rows.len()).map(of_row).collect()
    }

    /// What the multiplier of the row that is left adds to those of the rows.
    pub fn along(&self, multiplier: Expr<'g>) -> Vec<Expr<'g>> {
        self.normal.iter().map(|entry| *entry * multiplier).collect()
    }

    /// Small near positions where the own speeds move the rows alike.
    pub fn pivot(&self) -> Expr<'g> {
        self.square
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_speeds_and_the_row_that_is_left_make_up_the_rows() {
        let g = Scope::new();
        let jacobian: Vec<Vec<_>> =
            [[0.3, -1.2], [2.0, 0.7], [-0.4, 1.1]].map(|row| row.map(|x| g.number(x)).to_vec()).to_vec();
        let list = |values: &[f64]| -> Vec<Expr<'_>> { values.iter().map(|x| g.number(*x)).collect() };
        let close = |found: Expr<'_>, expected: f64| {
            // A few roundings of numbers below ten.
            assert!((found.as_number().expect("a number") - expected).abs() < 1e-14);
        };
        for n in [1, 2] {
            let plan = PlanBlock { rows: (0..=n).collect(), speeds: (0..n).collect() };
            let own = OwnSpeeds::new(&g, &plan, &jacobian);
            let (speeds, felt, left) = ([0.6, -1.7], [1.3, 0.2], 0.8);
            let along = own.along(g.number(left));
            let rights: Vec<Expr<'_>> =
                (0..=n).map(|row| along[row] + own.dot(&jacobian[row][..n], &list(&speeds[..n]))).collect();
            own.solve(&rights).into_iter().zip(speeds).for_each(|(found, expected)| close(found, expected));
            close(own.combined(|row| rights[row]) / own.pivot(), left);
            let multipliers = own.push(&list(&felt[..n]));
            for (speed, felt) in felt[..n].iter().enumerate() {
                let column: Vec<Expr<'_>> = (0..=n).map(|row| jacobian[row][speed]).collect();
                close(own.dot(&column, &multipliers), *felt);
                close(own.combined(|row| jacobian[row][speed]), 0.0);
            }
            close(own.combined(|row| multipliers[row]), 0.0);
        }
    }
}
