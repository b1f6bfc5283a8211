//! Gauss-Newton on the loop residuals. In: a guess and which coordinates are held. Out: closed loops.
//! Works on all rows, because kept rows alone can vanish at a position the dropped ones forbid (a Bennett
//! linkage keeps 2 of 5); the Jacobian of dropped rows comes from central differences. Kept rows polish.

use super::held::frozen;
use super::offset::{offset_columns, place_in_motion};
use super::units::Units;
use crate::error::AssemblyError;
use crate::evaluate::{CLOSED_AT_START, Evaluator};
use crate::layout::turn;
use crate::linear::{Shortest, dot, largest};

const MAX_ITERATIONS: usize = 60;
/// Singular values below this part of the largest are not followed; first strict, then bolder when stuck.
const TOLERANCES: [f64; 3] = [1e-8, 1e-4, 1e-2];
/// Longest step of an angle [rad]; lengths may move by this much times the longest lever arm.
const LONGEST_STEP: f64 = 0.5;
/// Half width of the central differences: truncation 1e-12, rounding 1e-10, of the arm's length.
const DIFFERENCE: f64 = 1e-6;
/// A step away from a guess at which residuals are no numbers [rad]: far enough that what is lost beside half a turn does not count,
/// near enough to lead where the guess would.
const ASIDE: f64 = 1e-3;
/// All rows this small: only kept rows, whose Jacobian is exact, go on.
const POLISH: f64 = 1e-9;

/// One attempt to close the loops.
pub(super) struct Newton<'e, 'a> {
    evaluator: &'e mut Evaluator<'a>,
    t: f64,
    guess: Vec<f64>,
    wish: Vec<f64>,
    held: Vec<bool>,
    columns: Vec<bool>,
    pose_rows: Vec<(usize, usize, usize)>,
    angles: Vec<bool>,
    /// Joint and axis of every offset that shall be zero.
    centred: Vec<(usize, usize)>,
    units: Units,
    iterations: usize,
}

impl<'e, 'a> Newton<'e, 'a> {
    pub(super) fn new(
        evaluator: &'e mut Evaluator<'a>,
        t: f64,
        guess: &[f64],
        wish: &[f64],
        held: &[bool],
    ) -> Self {
        let (columns, pose_rows) = frozen(evaluator, held);
        let angles =
            evaluator.description().speeds.iter().map(|speed| speed.unit.starts_with("rad")).collect();
        Self {
            t,
            guess: guess.to_vec(),
            wish: wish.to_vec(),
            held: held.to_vec(),
            columns,
            pose_rows,
            angles,
            centred: Vec::new(),
            units: Units::new(evaluator, t, guess, wish),
            iterations: 0,
            evaluator,
        }
    }

    /// The same with these offsets (joint, axis) at zero, as if their joints had no clearance.
    pub(super) fn centred(self, offsets: Vec<(usize, usize)>) -> Self {
        Self { centred: offsets, ..self }
    }

    /// The mechanism.
    pub(super) fn evaluator(&mut self) -> &mut Evaluator<'a> {
        self.evaluator
    }

    /// When [s].
    pub(super) fn time(&self) -> f64 {
        self.t
    }

    /// What makes pure numbers of rows and speeds.
    pub(super) fn units(&self) -> &Units {
        &self.units
    }

    /// The next attempt begins a step away from a position.
    pub(super) fn set_out(&mut self, q: &[f64], step: &[f64]) {
        self.guess = self.moved(q, step, 1.0);
        self.iterations = 0;
    }

    /// Closes the loops from the guess.
    pub(super) fn run(&mut self) -> Result<Vec<f64>, AssemblyError> {
        let mut q = self.guess.clone();
        let mut residual = self.residuals(&q);
        if residual.iter().any(|x| !x.is_finite()) {
            q = self.aside(&q);
            residual = self.residuals(&q);
        }
        if let Some(row) = residual.iter().position(|x| !x.is_finite()) {
            let joint = self.evaluator.joint_of_row(row);
            return Err(AssemblyError::NonFinite { what: format!("loop residual of {joint}") });
        }
        let mut boldness = 0;
        while largest(&residual) > POLISH && self.iterations < MAX_ITERATIONS && boldness < TOLERANCES.len() {
            self.iterations += 1;
            let delta = self.step(&q, &residual, TOLERANCES[boldness]);
            match self.search(&q, &residual, &delta) {
                Some(better) => (q, residual) = better,
                None => boldness += 1,
            }
        }
        if largest(&residual) <= POLISH {
            self.polish(&mut q);
        }
        let offsets = self.residuals(&q).split_off(self.evaluator.sizes().all_rows);
        let error = self.evaluator.loop_error();
        // Rounding of large coordinates moves the loops by about their last place.
        let closed = CLOSED_AT_START + 4.0 * f64::EPSILON * largest(&q);
        if error.part(self.units.arm).max(largest(&offsets)) <= closed {
            return Ok(q);
        }
        Err(AssemblyError::NoConvergence {
            iterations: self.iterations,
            joint: self.evaluator.joint_of_row(error.worst),
            meaning: self.evaluator.description().rows[error.worst].meaning.to_string(),
            residual_m: error.metres,
            residual_rad: error.radians,
        })
    }

    /// A little beside a position. The logarithm of exactly half a turn is no number: its axis points either way.
    fn aside(&mut self, q: &[f64]) -> Vec<f64> {
        // Speeds move differently, so that no symmetry stays.
        let step: Vec<f64> = (1_i32..)
            .zip(&self.columns)
            .map(|(speed, frozen)| if *frozen { 0.0 } else { ASIDE * (1.0 + f64::from(speed).recip()) })
            .collect();
        self.moved(q, &step, 1.0)
    }

    /// Of all rows, then of the offsets: pure numbers.
    fn residuals(&mut self, q: &[f64]) -> Vec<f64> {
        let residuals = self.evaluator.closure(self.t, q, &self.wish).positions;
        let mut pure: Vec<f64> =
            residuals.iter().zip(&self.units.rows).map(|(residual, unit)| residual * unit).collect();
        if !self.centred.is_empty() {
            let motion = self.evaluator.contact_motion(self.t, q, &self.wish);
            pure.extend(self.centred.iter().map(|place| motion[place_in_motion(*place)] / self.units.arm));
        }
        pure
    }

    /// Minimum-norm step, limited in length.
    fn step(&mut self, q: &[f64], residual: &[f64], tolerance: f64) -> Vec<f64> {
        let jacobian = self.full_jacobian(q);
        let longest_arm = jacobian.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let mut delta = self.least_squares(q, jacobian, residual, tolerance);
        let shrink = delta.iter().zip(&self.angles).fold(1.0_f64, |shrink, (step, angle)| {
            let limit = if *angle { LONGEST_STEP } else { LONGEST_STEP * longest_arm };
            if step.abs() > limit { shrink.min(limit / step.abs()) } else { shrink }
        });
        delta.iter_mut().for_each(|x| *x *= shrink);
        delta
    }

    /// The shortest step of what is not held that changes rows with this Jacobian by as much as is wanted, pure numbers.
    pub(super) fn shortest(&self, q: &[f64], jacobian: Vec<f64>, wanted: &[f64]) -> Vec<f64> {
        let residual: Vec<f64> = wanted.iter().map(|x| -x).collect();
        self.least_squares(q, jacobian, &residual, TOLERANCES[0])
    }

    fn least_squares(&self, q: &[f64], mut jacobian: Vec<f64>, residual: &[f64], tolerance: f64) -> Vec<f64> {
        let n = self.columns.len();
        let mut delta = vec![0.0; n];
        if n == 0 {
            return delta;
        }
        for row in jacobian.chunks_exact_mut(n) {
            for (entry, frozen) in row.iter_mut().zip(&self.columns) {
                if *frozen {
                    *entry = 0.0;
                }
            }
        }
        let mut right: Vec<f64> = residual.iter().map(|x| -x).collect();
        for (at, speed, component) in &self.pose_rows {
            // The held component in W is a row of the rotation matrix times the body's velocity.
            let mut row = vec![0.0; n];
            let quaternion = [q[*at], q[at + 1], q[at + 2], q[at + 3]];
            for axis in 0..3 {
                let unit = core::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
                row[speed + 3 + axis] = turn(quaternion, unit)[*component];
            }
            jacobian.extend(row);
            right.push(0.0);
        }
        Shortest::new(&jacobian, right.len(), n, tolerance).solve(&right, &mut delta);
        delta
    }

    /// Jacobian of all rows: exact for kept ones, central differences for dropped ones.
    pub(super) fn full_jacobian(&mut self, q: &[f64]) -> Vec<f64> {
        let (n, all) = (self.columns.len(), self.evaluator.sizes().all_rows);
        let mut jacobian = vec![0.0; all * n];
        if self.evaluator.kept().len() < all {
            for j in 0..n {
                let mut delta = vec![0.0; n];
                let mut sides = [DIFFERENCE, -DIFFERENCE].map(|step| {
                    delta[j] = step * self.units.speeds[j];
                    let mut moved = q.to_vec();
                    self.evaluator.layout().advance(&mut moved, &delta);
                    self.residuals(&moved).into_iter()
                });
                let [plus, minus] = &mut sides;
                for (i, (a, b)) in plus.zip(minus).take(all).enumerate() {
                    jacobian[i * n + j] = (a - b) / (2.0 * DIFFERENCE);
                }
            }
        }
        self.evaluator.closure(self.t, q, &self.wish);
        let mut exact = self.evaluator.last_closure().jacobian.to_vec();
        self.units.scale(&mut exact, self.evaluator.kept().iter().copied());
        for (k, row) in self.evaluator.kept().iter().enumerate() {
            jacobian[row * n..(row + 1) * n].copy_from_slice(&exact[k * n..(k + 1) * n]);
        }
        jacobian.extend(self.offset_rows(q));
        jacobian
    }

    /// The rows of the offsets, by all speeds.
    fn offset_rows(&mut self, q: &[f64]) -> Vec<f64> {
        if self.centred.is_empty() {
            return Vec::new();
        }
        let columns = offset_columns(self.evaluator, self.t, q);
        let Units { arm, speeds, .. } = &self.units;
        let rows = self.centred.iter().map(|(joint, axis)| &columns[*joint][*axis]);
        rows.flat_map(|row| row.iter().zip(speeds).map(|(entry, unit)| entry * unit / arm)).collect()
    }

    /// The longest of a few parts of the step that brings the loops nearer; `None` if none does.
    fn search(&mut self, q: &[f64], residual: &[f64], delta: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let before = dot(residual, residual);
        let mut part = 1.0;
        for _ in 0..12 {
            let moved = self.moved(q, delta, part);
            let after = self.residuals(&moved);
            // Not a number counts as no better.
            if dot(&after, &after) <= (1.0 - 1e-4 * part) * before {
                return Some((moved, after));
            }
            part *= 0.5;
        }
        None
    }

    fn moved(&mut self, q: &[f64], delta: &[f64], part: f64) -> Vec<f64> {
        let mut step: Vec<f64> = delta.iter().map(|x| part * x).collect();
        self.units.restore(&mut step);
        let mut moved = q.to_vec();
        self.evaluator.layout().advance(&mut moved, &step);
        self.evaluator.layout().normalize(&mut moved);
        // Held values are exact, not exact up to the rounding of a solve.
        for (i, held) in self.held.iter().enumerate() {
            if *held {
                moved[i] = self.guess[i];
            }
        }
        moved
    }

    /// Newton on the kept rows and the offsets until rounding stops it.
    fn polish(&mut self, q: &mut Vec<f64>) {
        let mut before = f64::INFINITY;
        let offsets = self.evaluator.sizes().all_rows..;
        let rows: Vec<usize> =
            self.evaluator.kept().iter().copied().chain(offsets.take(self.centred.len())).collect();
        for _ in 0..8 {
            let n = self.columns.len();
            let positions = self.residuals(q);
            let mut jacobian = self.evaluator.last_closure().jacobian.to_vec();
            self.units.scale(&mut jacobian, self.evaluator.kept().iter().copied());
            jacobian.extend(self.offset_rows(q));
            let kept: Vec<f64> = rows.iter().map(|row| positions[*row]).collect();
            let size = largest(&kept);
            if size == 0.0 || size > 0.5 * before || n == 0 {
                return;
            }
            before = size;
            let delta = self.least_squares(q, jacobian, &kept, TOLERANCES[0]);
            let moved = self.moved(q, &delta, 1.0);
            let after = self.residuals(&moved);
            if rows.iter().all(|row| after[*row].abs() <= size) {
                *q = moved;
            }
        }
    }
}
