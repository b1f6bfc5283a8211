//! Puts the end of a step onto the constraints: positions, then speeds, in corrections of minimum norm. In: a flat state near them.
//! Out: the state on them, how far it moved. Never knows methods; gives up where [`crate::Projector`] would leave directions out.

use super::storage::Storage;
use super::{CORRECTIONS, FixedStep, Halt};
use crate::linear::{add_scaled, factor_gram, largest, solve_gram};
use crate::manifold::groups;
use crate::row_scales::{note_lengths, scale_rows};
use crate::system::{Entry, System};
use crate::tolerances::{
    CLOSED, POSITION_TOLERANCE, SETTLED, TRUSTED_PIVOT, position_tolerance, speed_tolerance, untouched,
};

/// Loops and their speeds that are closed by so much at the start stay as they were assembled.
const ASSEMBLED: f64 = 1e-9;
/// Corrections may move coordinates and speeds by this part of what the step itself moved them...
const BRANCH_PART: f64 = 0.1;
/// ...or by this much [rad, m, rad/s, m/s], relative to values above 1.
const JUMP_FLOOR: f64 = 1e-6;

impl<S: System<f64>> FixedStep<'_, S> {
    /// Whether loops and their speeds are closed as an assembled start has them.
    pub(super) fn is_closed(&mut self, parameters: &[f64], t: f64, y: &[f64]) -> bool {
        self.evaluate_loops(parameters, t, y);
        largest(&self.storage.answer[..self.sizes.all_rows + self.sizes.rows]) <= ASSEMBLED
    }

    /// Puts a flat state onto the constraints; `strictness`: how regular the position is. Out: the largest corrections of positions
    /// and speeds.
    pub(super) fn put_on(
        &mut self,
        (parameters, t): (&[f64], f64),
        y: &mut [f64],
        strictness: f64,
    ) -> Result<[f64; 2], Halt> {
        groups(self.tables.motions).filter(|group| group.is_free()).for_each(|group| group.normalize(y));
        if self.sizes.rows == 0 {
            return Ok([0.0; 2]);
        }
        let (mut moved, mut before, mut is_factored) = ([0.0_f64; 2], f64::INFINITY, false);
        let coordinates = self.sizes.coordinates;
        let (own, least) = untouched(strictness);
        let tolerance = position_tolerance(strictness, largest(&y[..coordinates]));
        for correction in 0.. {
            self.evaluate_loops(parameters, t, y);
            self.load_positions();
            let size = largest(self.storage.residual);
            if correction == 0 && size <= own {
                break;
            }
            let is_stalled = size > 0.25 * before;
            if size <= tolerance || (is_stalled && size <= SETTLED) {
                break;
            }
            if size.is_nan() || correction == CORRECTIONS {
                return Err(Halt::OpenLoop);
            }
            if !is_factored || is_stalled {
                self.factor()?;
                is_factored = true;
            }
            before = size;
            self.solve();
            let delta = &*self.storage.delta;
            groups(self.tables.motions)
                .filter(|group| group.is_free())
                .for_each(|group| group.advance(y, delta));
            moved[0] = moved[0].max(largest(delta));
        }
        let open = largest(&self.storage.answer[..self.sizes.all_rows]);
        if open.is_nan() || open > CLOSED + POSITION_TOLERANCE {
            return Err(Halt::OpenLoop);
        }
        let Storage { answer, residual, .. } = &mut self.storage;
        residual.copy_from_slice(&answer[self.sizes.all_rows..][..self.sizes.rows]);
        let v = &mut y[coordinates..][..self.sizes.speeds];
        if largest(residual) <= speed_tolerance(least, largest(v)) {
            return Ok(moved);
        }
        if !is_factored {
            self.factor()?;
        }
        self.solve();
        add_scaled(v, 1.0, self.storage.delta);
        moved[1] = largest(self.storage.delta);
        Ok(moved)
    }

    /// Whether corrections were as small as errors of a step are.
    pub(super) fn check_moved(&self, moved: [f64; 2], y: &[f64], next: &[f64]) -> Result<(), Halt> {
        let (q, v) =
            (0..self.sizes.coordinates, self.sizes.coordinates..self.sizes.coordinates + self.sizes.speeds);
        let step = |range: core::ops::Range<usize>| {
            let ends = y[range.clone()].iter().zip(&next[range]);
            ends.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        let limit = |own: f64, size: f64| (BRANCH_PART * own).max(JUMP_FLOOR * size.max(1.0));
        let (q_size, v_size) = (largest(&y[q.clone()]), largest(&y[v.clone()]));
        let fits = moved[0] <= limit(step(q), q_size) && moved[1] <= limit(step(v).max(v_size), v_size);
        if fits { Ok(()) } else { Err(Halt::Jumped) }
    }

    fn evaluate_loops(&mut self, parameters: &[f64], t: f64, y: &[f64]) {
        self.fill(parameters, t, y);
        let sizes = self.sizes;
        let Storage { question, answer, workspace, row_lengths, .. } = &mut self.storage;
        let answer = &mut answer[..sizes.output(Entry::Closure)];
        self.system.evaluate(Entry::Closure, &question[..sizes.input(Entry::Closure)], answer, workspace);
        note_lengths(row_lengths, &answer[sizes.all_rows + sizes.rows..], sizes.speeds);
    }

    /// Takes the residuals of the kept rows as what is to go.
    fn load_positions(&mut self) {
        let Storage { answer, residual, .. } = &mut self.storage;
        for (position, (.., kept)) in answer.iter().zip(self.tables.rows) {
            if let Some(place) = kept.and_then(|kept| residual.get_mut(kept)) {
                *place = *position;
            }
        }
    }

    /// Factors the Jacobian of the last evaluation.
    fn factor(&mut self) -> Result<(), Halt> {
        let n = self.sizes.speeds;
        let rows = self.tables.rows.iter();
        let kinds = rows.filter_map(|(_, _, angular, kept)| kept.map(|kept| (kept, *angular)));
        let Storage { answer, jacobian, factors, work, scales, row_lengths, .. } = &mut self.storage;
        scale_rows(scales, row_lengths, kinds);
        let known = &answer[self.sizes.all_rows + self.sizes.rows..][..jacobian.len()];
        let rows = jacobian.chunks_exact_mut(n.max(1)).zip(known.chunks_exact(n.max(1)));
        for ((row, known), scale) in rows.zip(&**scales) {
            for ((place, value), size) in row.iter_mut().zip(known).zip(self.start.sizes) {
                *place = value * (scale * size);
            }
        }
        // What is not a number is not trusted either.
        if factor_gram(factors, work, jacobian, n) > TRUSTED_PIVOT {
            Ok(())
        } else {
            Err(Halt::NearlySingular)
        }
    }

    /// The shortest motion that takes the residual away.
    fn solve(&mut self) {
        let n = self.sizes.speeds;
        let Storage { jacobian, factors, scales, residual, right, delta, .. } = &mut self.storage;
        for ((right, residual), scale) in right.iter_mut().zip(&**residual).zip(&**scales) {
            *right = -scale * residual;
        }
        solve_gram(factors, right);
        delta.fill(0.0);
        for (amount, row) in right.iter().zip(jacobian.chunks_exact(n.max(1))) {
            add_scaled(delta, *amount, row);
        }
        delta.iter_mut().zip(self.start.sizes).for_each(|(x, size)| *x *= size);
    }
}
