//! Which speeds the rows of one cut alone have, and what is left of a plan without them.
//! In: where the loop Jacobian is not zero, and what it is at closed positions. Out: [`Plan`]. Never knows expressions.
//!
//! Of a leg under a platform that is its universal joint: of the three rows of its ball one is left to the platform, along the leg
//! if nothing else of it moves.

use nalgebra::DVector;

use crate::sparse_rows::SparseRows;

use super::plan::{Plan, PlanBlock};

impl Plan {
    /// A plan where the speeds that the rows of one cut alone have are taken out in these rows; nothing where there are no such, or
    /// where rows are still left to the equations of motion then. `cuts`: the cut of every row.
    pub fn without_own(
        pattern: &[Vec<bool>],
        speeds: usize,
        numbers: &[SparseRows],
        cuts: &[usize],
    ) -> Option<Self> {
        let in_rows = |speed: &usize| pattern.iter().any(|row| row[*speed]);
        if (0..speeds).filter(in_rows).count() != pattern.len() {
            return None;
        }
        let own = own_speeds(pattern, speeds, cuts);
        let own: Vec<PlanBlock> = own.into_iter().filter(|own| own.is_regular(numbers)).collect();
        if own.is_empty() {
            return None;
        }
        let others = |all: usize, gone: &dyn Fn(&PlanBlock) -> Vec<usize>| -> Vec<usize> {
            let gone: Vec<usize> = own.iter().flat_map(gone).collect();
            (0..all).filter(|at| !gone.contains(at)).collect()
        };
        let rows = others(pattern.len(), &|own| own.rows[..own.rows.len() - 1].to_vec());
        let columns = others(speeds, &|own| own.speeds.clone());
        let from = |row: &usize| own.iter().find(|own| own.left() == *row);
        let reduced: Vec<Vec<bool>> = rows
            .iter()
            .map(|row| {
                let all = from(row).map_or_else(|| vec![*row], |own| own.rows.clone());
                columns.iter().map(|speed| all.iter().any(|row| pattern[*row][*speed])).collect()
            })
            .collect();
        let numbers: Vec<SparseRows> = numbers
            .iter()
            .map(|jacobian| {
                let mut left = jacobian.clone();
                for own in &own {
                    let rows = jacobian.select_rows(&own.rows);
                    left.set_row(own.left(), &rows.transposed_times(&own.normal(jacobian)));
                }
                left.select_rows(&rows).select_columns(&columns)
            })
            .collect();
        let (small, large) = Self::new(&reduced, columns.len(), &numbers);
        let plan = large.unwrap_or(small);
        let placed = |block: PlanBlock| PlanBlock {
            rows: block.rows.into_iter().map(|row| rows[row]).collect(),
            speeds: block.speeds.into_iter().map(|speed| columns[speed]).collect(),
        };
        let (blocks, rest) = (plan.blocks.into_iter().map(placed).collect(), placed(plan.rest));
        rest.rows.is_empty().then_some(Self { own, blocks, rest })
    }
}

impl PlanBlock {
    /// Direction among the rows, of which there is one more than speeds, in which none of the speeds moves them.
    fn normal(&self, jacobian: &SparseRows) -> DVector<f64> {
        let columns = jacobian.select_rows(&self.rows).select_columns(&self.speeds).dense();
        let normal = match self.speeds.len() {
            1 => DVector::from_vec(vec![-columns[1], columns[0]]),
            _ => {
                let [a, b] = [0, 1].map(|at| columns.fixed_view::<3, 1>(0, at).into_owned());
                DVector::from_column_slice(a.cross(&b).as_slice())
            }
        };
        let size = normal.norm();
        if size > 0.0 { normal / size } else { normal }
    }
}

/// By cut, its rows and the speeds that no other row has, if these are one fewer and no more than two.
fn own_speeds(pattern: &[Vec<bool>], speeds: usize, cuts: &[usize]) -> Vec<PlanBlock> {
    let mut found: Vec<PlanBlock> = Vec::new();
    let mut known: Vec<usize> = Vec::new();
    for cut in cuts {
        if known.contains(cut) {
            continue;
        }
        known.push(*cut);
        let (own, others): (Vec<usize>, Vec<usize>) = (0..pattern.len()).partition(|row| cuts[*row] == *cut);
        let alone = |speed: &usize| {
            own.iter().any(|row| pattern[*row][*speed]) && !others.iter().any(|row| pattern[*row][*speed])
        };
        let alone: Vec<usize> = (0..speeds).filter(alone).collect();
        if matches!(alone.len(), 1 | 2) && own.len() == alone.len() + 1 {
            found.push(PlanBlock { rows: own, speeds: alone });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::plan::tests::numbered;
    use super::*;

    #[test]
    fn speeds_of_one_cut_alone_leave_one_of_its_rows() {
        // Two cuts of three rows, each with two speeds of its own: two rows are left for the other two speeds.
        let rows = ["xx..xx", "xx..xx", "xx..x.", "..xxxx", "..xx.x", "..xxx."];
        let (pattern, numbers) = numbered(&rows);
        let numbers = [numbers];
        let plan = Plan::without_own(&pattern, 6, &numbers, &[0, 0, 0, 1, 1, 1]).expect("a plan");
        let block =
            |rows: &[usize], speeds: &[usize]| PlanBlock { rows: rows.to_vec(), speeds: speeds.to_vec() };
        assert_eq!(plan.own, [block(&[0, 1, 2], &[0, 1]), block(&[3, 4, 5], &[2, 3])]);
        assert_eq!((plan.blocks, plan.rest), (vec![block(&[2, 5], &[5, 4])], PlanBlock::default()));
        // One cut has all of them: more than its rows may leave out.
        assert_eq!(Plan::without_own(&pattern, 6, &numbers, &[0; 6]), None);
    }
}
