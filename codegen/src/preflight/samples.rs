//! Closed positions of a mechanism without drivers, found by walking along its freedoms.
//! In: the interpreter. Out: positions with their Jacobians. Never knows why they are wanted.

use std::cell::OnceCell;

use linkwear_runtime::{
    AssemblyError, CLOSED_AT_START, Description, Entry, Evaluator, Layout, System, assemble_with,
};
use nalgebra::{DMatrix, DVector};

use crate::sparse_rows::SparseRows;

use super::own_units::OwnUnits;
use super::subspace::{RANK_TOLERANCE, least_norm, least_norm_within, null_space};

/// Positions tried beyond the first, of small mechanisms: enough to walk once round a closed motion, since rows
/// that are independent here may depend on each other elsewhere.
const MANY_STEPS: usize = 48;
/// The same of large mechanisms: enough that a chance singular position cannot decide the rank.
const FEW_STEPS: usize = 6;
/// Speeds from which a mechanism counts as large: decompositions then cost milliseconds each.
const LARGE: usize = 24;
/// Newton that gains less than this part of the residual in its last step has come as near as the loops let it.
const STALLED: f64 = 0.9;
/// Corrections of Newton; a few close a loop after a step.
const ITERATIONS: usize = 19;
/// Length of a step along the freedoms [rad, own units]: large enough to change the geometry, small enough that a few
/// Newton steps close the loops again.
pub const STEP: f64 = 0.25;
/// Loops count as closed below this residual [rad, own units]; Newton ends near 1e-15.
const CLOSED: f64 = 1e-11;
/// Where joints are far beside the loops' own lever arms, as of several linkages along a line, loops close to the same part of the arms,
/// down to this part of [`CLOSED`], below which is rounding.
const CLOSER: f64 = 1e-3;

/// Rows below this [own units] are rounding: a hinge or a slide that moves a row does so by its lever, which counts beside one, and
/// sums of levers leave 1e-15 of it. Plane loops that lie askew have nothing else in the rows out of their plane, which are zeros where
/// the plane is one of the drawing's; scaled up they would look like constraints.
const UNMOVED: f64 = 1e-12;

/// One closed position.
#[derive(Clone, Debug)]
pub struct Position {
    /// All coordinates.
    pub q: Vec<f64>,
    /// Residuals of all rows, in own units.
    pub residual: DVector<f64>,
    /// Jacobian of all rows by all speeds, in own units.
    pub jacobian: SparseRows,
    freedoms: OnceCell<DMatrix<f64>>,
}

impl Position {
    /// A position with what was evaluated there.
    pub fn new(q: Vec<f64>, residual: DVector<f64>, jacobian: SparseRows) -> Self {
        Self { q, residual, jacobian, freedoms: OnceCell::new() }
    }

    /// Motions of the joints that the loops allow, as columns; found once, so that the speeds of the joints have to be the same
    /// in every call.
    pub fn freedoms(&self, joint_speeds: &[usize]) -> &DMatrix<f64> {
        self.freedoms.get_or_init(|| null_space(&self.jacobian.select_columns(joint_speeds)))
    }
}

/// Closed positions, the assembled start first.
pub struct ClosedPositions {
    /// Positions.
    pub positions: Vec<Position>,
    /// The longest lever arm at the start [m].
    pub arm: f64,
    /// Residuals, in own units, where the loops stayed open by a little along the way.
    pub open: Vec<DVector<f64>>,
}

impl ClosedPositions {
    /// Assembles the mechanism at t = 0 and walks on from there.
    ///
    /// # Errors
    /// If Newton cannot close the loops.
    pub fn walk(walker: &Walker<'_>, description: &Description) -> Result<Self, AssemblyError> {
        let mut evaluator = Evaluator::new(walker.system, description, &walker.parameters)?;
        let state = assemble_with(&mut evaluator, 0.0)?;
        let arm = evaluator.longest_arm(0.0, &state.q, &state.v);
        let mut positions = vec![walker.position(state.q)];
        let mut open = Vec::new();
        let mut generator = 0x2545_F491_4F6C_DD1D_u64;
        let closed = CLOSED * (arm / walker.units.length).clamp(CLOSER, 1.0);
        let steps = if walker.system.sizes().all_speeds < LARGE { MANY_STEPS } else { FEW_STEPS };
        let mut direction = None;
        for step in 0..steps {
            // Half of the steps go on from the last position, half set out from the start again another way.
            if step == steps / 2 {
                direction = None;
            }
            let from = if step == steps / 2 { 0 } else { positions.len() - 1 };
            match walker.step(&positions[from], closed, &mut direction, &mut generator) {
                Some(Ended::Closed(next)) => positions.push(next),
                Some(Ended::Open(residual)) => open.push(residual),
                None => {}
            }
        }
        Ok(Self { positions, arm, open })
    }
}

/// Where Newton ended.
pub enum Ended {
    /// In a closed position.
    Closed(Position),
    /// As near to one as the loops let it, with these residuals in own units: no freedom takes them away.
    Open(DVector<f64>),
}

/// Evaluates an entry with a fresh workspace; contact wrenches, the last inputs, are zero where not given.
pub fn evaluate(system: &dyn System<f64>, entry: Entry, input: &[f64], output: &mut [f64]) {
    let sizes = system.sizes();
    let mut workspace = vec![0.0; sizes.workspace];
    let mut all = input.to_vec();
    all.resize(sizes.input(entry), 0.0);
    system.evaluate(entry, &all, output, &mut workspace);
}

/// Position residuals of all rows and their Jacobian, at a question of the equations of motion.
pub type RowsAt<'a> = dyn Fn(&[f64]) -> (Vec<f64>, SparseRows) + 'a;

/// A mechanism without drivers, moved by its joint speeds.
pub struct Walker<'a> {
    /// The mechanism.
    pub system: &'a dyn System<f64>,
    /// Its rows, at the question of its equations of motion.
    pub rows: &'a RowsAt<'a>,
    /// Values of the tunable parameters.
    pub parameters: Vec<f64>,
    /// Places of coordinates and speeds.
    pub layout: Layout,
    /// The speeds that move joints; modes keep their shape.
    pub joint_speeds: Vec<usize>,
    /// What lengths are measured in.
    pub units: &'a OwnUnits,
}

impl Walker<'_> {
    /// Residuals of all rows and their Jacobian, in own units.
    pub fn equations(&self, q: &[f64]) -> (DVector<f64>, SparseRows) {
        let (residuals, jacobian) = (self.rows)(&self.at_rest(q));
        let OwnUnits { speeds, rows, .. } = self.units;
        let residuals = residuals.iter().zip(rows).map(|(residual, unit)| residual / unit);
        let residuals = DVector::from_iterator(rows.len(), residuals);
        (residuals, jacobian.scaled(|row, speed| speeds[speed] / rows[row]).without_rows_below(UNMOVED))
    }

    /// Mass matrix of all speeds, in own units but for a common factor.
    pub fn mass(&self, q: &[f64]) -> DMatrix<f64> {
        let n = self.system.sizes().all_speeds;
        let mut output = vec![0.0; self.system.sizes().output(Entry::EquationsOfMotion)];
        evaluate(self.system, Entry::EquationsOfMotion, &self.at_rest(q), &mut output);
        let speeds = &self.units.speeds;
        let mut mass = DMatrix::zeros(n, n);
        let upper = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
        for ((i, j), value) in upper.zip(&output) {
            mass[(i, j)] = *value * (speeds[i] / self.units.length) * (speeds[j] / self.units.length);
            mass[(j, i)] = mass[(i, j)];
        }
        mass
    }

    /// Its diagonal, by the kinetic energy of each speed alone.
    pub fn inertias(&self, q: &[f64]) -> DVector<f64> {
        let sizes = self.system.sizes();
        let mut output = vec![0.0; sizes.output(Entry::Energy)];
        DVector::from_fn(sizes.all_speeds, |speed, _| {
            let mut v = vec![0.0; sizes.all_speeds];
            v[speed] = self.units.speeds[speed] / self.units.length;
            let input = [&self.parameters, &[0.0][..], q, &v].concat();
            evaluate(self.system, Entry::Energy, &input, &mut output);
            2.0 * output[0]
        })
    }

    /// The question of the equations of motion, at rest.
    fn at_rest(&self, q: &[f64]) -> Vec<f64> {
        let sizes = self.system.sizes();
        let mut question = [&self.parameters, &[0.0][..], q].concat();
        question.resize(sizes.input(Entry::EquationsOfMotion), 0.0);
        question
    }

    fn position(&self, q: Vec<f64>) -> Position {
        let (residual, jacobian) = self.equations(&q);
        Position::new(q, residual, jacobian)
    }

    /// A step along a direction that the loops allow, then Newton back onto the closed positions.
    fn step(
        &self,
        from: &Position,
        closed: f64,
        last: &mut Option<DVector<f64>>,
        generator: &mut u64,
    ) -> Option<Ended> {
        let free = from.freedoms(&self.joint_speeds);
        if free.ncols() == 0 {
            return None;
        }
        // Go on where the last step went as far as the loops let it, with some random motion mixed in.
        let weights = DVector::from_fn(free.ncols(), |_, _| random(generator));
        let mut direction = free * weights;
        if let Some(last) = last {
            let onwards = free * (free.transpose() * &*last);
            let size = direction.norm().max(f64::MIN_POSITIVE);
            direction =
                onwards + direction * (0.3 * last.norm() / size) * f64::from(u8::from(free.ncols() > 1));
        }
        let norm = direction.amax();
        if norm == 0.0 {
            return None;
        }
        let scaled = direction * (STEP / norm);
        *last = Some(scaled.clone());
        let mut q = from.q.clone();
        self.layout.advance(&mut q, &self.all_speeds(&scaled));
        self.close_within(q, RANK_TOLERANCE, closed)
    }

    /// Newton by the joint speeds; directions below a part of the strongest one are not followed. `None` where it does not
    /// converge.
    pub fn close(&self, q: Vec<f64>, tolerance: f64) -> Option<Ended> {
        self.close_within(q, tolerance, CLOSED)
    }

    /// The same until residuals are below a bound.
    fn close_within(&self, mut q: Vec<f64>, tolerance: f64, closed: f64) -> Option<Ended> {
        let mut before = f64::INFINITY;
        for iteration in 0..=ITERATIONS {
            let (phi, jacobian) = self.equations(&q);
            let size = phi.amax();
            let stalled = iteration == ITERATIONS && size > STALLED * before;
            if size < closed || (stalled && size < CLOSED_AT_START) {
                return Some(Ended::Closed(Position::new(q, phi, jacobian)));
            }
            if iteration == ITERATIONS {
                return stalled.then_some(Ended::Open(phi));
            }
            before = size;
            let correction =
                least_norm_within(&jacobian.select_columns(&self.joint_speeds), &-phi, tolerance)?;
            self.layout.advance(&mut q, &self.all_speeds(&correction));
        }
        None
    }

    /// How far the loops stay open at least [rad, own units] when a driver goes on by a small step, forwards or backwards,
    /// and the other held speeds rest.
    pub fn driver_misses(&self, start: &Position, driver: usize, held: &[usize]) -> f64 {
        let misses = |amount: f64| self.misses(start, (driver, amount), held);
        misses(STEP).min(misses(-STEP))
    }

    /// The same for a speed and an amount.
    fn misses(&self, from: &Position, (driven, amount): (usize, f64), held: &[usize]) -> f64 {
        let followers: Vec<usize> = self
            .joint_speeds
            .iter()
            .copied()
            .filter(|speed| *speed != driven && !held.contains(speed))
            .collect();
        let mut q = from.q.clone();
        let mut least = f64::INFINITY;
        let mut step = vec![0.0; self.units.speeds.len()];
        step[driven] = amount * self.units.speeds[driven];
        for _ in 0..20 {
            self.layout.advance(&mut q, &step);
            let (phi, jacobian) = self.equations(&q);
            if phi.iter().any(|value| !value.is_finite()) {
                break;
            }
            least = least.min(phi.amax());
            let Some(correction) = least_norm(&jacobian.select_columns(&followers), &-phi) else { break };
            step.fill(0.0);
            for (speed, amount) in followers.iter().zip(correction.iter()) {
                step[*speed] = *amount * self.units.speeds[*speed];
            }
        }
        least
    }

    /// A step of all speeds, in SI, that moves only joints.
    pub fn all_speeds(&self, step: &DVector<f64>) -> Vec<f64> {
        let mut all = vec![0.0; self.system.sizes().all_speeds];
        for (speed, amount) in self.joint_speeds.iter().zip(step.iter()) {
            all[*speed] = *amount * self.units.speeds[*speed];
        }
        all
    }
}

/// A number in (-1, 1) from a small generator (xorshift), so that generation is reproducible.
pub fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
