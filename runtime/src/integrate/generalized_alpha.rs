//! Generalised-alpha for mechanisms: index-3 equations, Lie-group update, fixed step, order 2.
//! In: equations of motion through an [`Evaluator`], a start. Out: the next state. The only method here
//! that knows mechanisms: it needs their mass matrix and constraints, not a right-hand side.
//!
//! Arnold & Brüls, Multibody System Dynamics 18 (2007) 185-202; Brüls & Cardona, J. Comput. Nonlinear
//! Dynam. 5 (2010) 031002. Driven coordinates are eliminated. Unknowns of a step: the increment `x` of the
//! free coordinates (in speed space; quaternions and poses move along their group) and the multipliers
//! times `h²`, which keeps the Newton matrix well scaled at every step size (Bottasso et al. 2007).

use super::expected::{Coefficients, Expected, Point};
use crate::error::RunError;
use crate::evaluate::{CLOSED, Evaluator};
use crate::linear::{Lu, Orthogonal, add_scaled, is_finite, largest, largest_of};

const MAX_ITERATIONS: u32 = 40;
/// Corrections no smaller than this part of the one before: the Newton matrix is out of date. The second correction says
/// nothing yet: what has little inertia, as a rod's spin, follows what the first one did to all else.
const SLOW: f64 = 0.05;
/// Below this the rate of two corrections tells how far the last one was from the solution.
const STEADY: f64 = 0.2;
/// A step's equations are solved to this part of its own error, which goes with the change of the accelerations...
const SOLVED: f64 = 1e-5;
/// ...and better than this [rad, m]: loops stay closed.
const CLOSED_BY_A_STEP: f64 = 1e-2 * CLOSED;
/// A correction this small [rad, m] that does not shrink further is rounding.
const ROUNDING: f64 = 1e-10;
/// Width of the difference quotients of the Newton matrix: truncation and rounding both near 1e-8.
const DIFFERENCE: f64 = 1e-7;
/// Pivots below this part of the largest: rank is lost, and a minimum-norm correction is used.
const LOST_PIVOT: f64 = 1e-13;

/// State and storage of the method.
#[must_use]
pub struct GeneralizedAlpha {
    now: Point,
    /// Where the step is expected to end.
    expected: Expected,
    /// Trial values at the end of a step.
    next: Point,
    trial: Trial,
    /// What is added to the expected increments.
    x: Vec<f64>,
    /// Multipliers times `h²`.
    scaled_multipliers: Vec<f64>,
    /// The same one step before.
    multipliers_before: Vec<f64>,
    /// Step of the last steps, and how many there were.
    last_steps: (f64, u64),
    /// For every kept row, its row in the description.
    kept: Vec<usize>,
    residual: Vec<f64>,
    shifted: Vec<f64>,
    /// Kept rows of the Jacobian by the free speeds.
    free_rows: Vec<f64>,
    matrix: Vec<f64>,
    lu: Lu,
    orthogonal: Orthogonal,
    /// Natural size of each free speed's motion, and one over it.
    sizes: Vec<f64>,
    per_size: Vec<f64>,
    /// Step that the Newton matrix was made for; 0: none.
    factored_step: f64,
    rank_lost: bool,
    iterations: u64,
    evaluations: u64,
}

/// Equations of motion at a trial, of all coordinates.
struct Trial {
    all_q: Vec<f64>,
    all_v: Vec<f64>,
    all_a: Vec<f64>,
    balance: Vec<f64>,
    free: Vec<usize>,
    driven: Vec<usize>,
}

impl GeneralizedAlpha {
    /// Starts at coordinates `q`, speeds `v`, accelerations `v_dot`; `shifted`: accelerations at
    /// [`Self::shift`] steps after the start (`v_dot` again costs accuracy in the first steps only).
    pub fn new(
        evaluator: &Evaluator<'_>,
        rho: f64,
        state: (&[f64], &[f64]),
        v_dot: &[f64],
        shifted: &[f64],
    ) -> Self {
        let sizes = evaluator.sizes();
        let (n, m, all) = (sizes.speeds, sizes.rows, sizes.all_speeds);
        let (free, driven) = evaluator.layout().speed_places(sizes.drivers);
        let (q, v) = (state.0.to_vec(), state.1.to_vec());
        let now = Point { q, v, v_dot: v_dot.to_vec(), a: shifted.to_vec() };
        let trial = Trial {
            all_q: vec![0.0; sizes.all_coordinates],
            all_v: vec![0.0; all],
            all_a: vec![0.0; all],
            balance: vec![0.0; all],
            free,
            driven,
        };
        Self {
            expected: Expected::new(rho, &now),
            next: now.clone(),
            now,
            trial,
            x: vec![0.0; n],
            scaled_multipliers: vec![0.0; m],
            multipliers_before: vec![0.0; m],
            last_steps: (0.0, 0),
            kept: evaluator.kept().to_vec(),
            residual: vec![0.0; n + m],
            shifted: vec![0.0; n + m],
            free_rows: vec![0.0; m * n],
            matrix: vec![0.0; (n + m) * (n + m)],
            lu: Lu::new(n + m),
            orthogonal: Orthogonal::new(n + m, n + m),
            sizes: vec![1.0; n],
            per_size: vec![1.0; n],
            factored_step: 0.0,
            rank_lost: false,
            iterations: 0,
            evaluations: 0,
        }
    }

    /// Sets the natural size of each free speed's motion, 1 unless told otherwise: difference quotients and the end
    /// of the iteration go by it. A contact is as stiff as its penetrations are small.
    pub fn with_sizes(mut self, sizes: &[f64]) -> Self {
        self.sizes.copy_from_slice(sizes);
        self.per_size.iter_mut().zip(sizes).for_each(|(per_size, size)| *per_size = 1.0 / size);
        self
    }

    /// Time to which the method's own accelerations belong, in steps after the state's time.
    pub fn shift(rho: f64) -> f64 {
        Coefficients::new(rho).shift()
    }

    /// Coordinates reached.
    pub fn q(&self) -> &[f64] {
        &self.now.q
    }

    /// Speeds reached.
    pub fn v(&self) -> &[f64] {
        &self.now.v
    }

    /// Newton iterations so far.
    pub fn iterations(&self) -> u64 {
        self.iterations
    }

    /// Evaluations of the equations of motion so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Advances by `h` from `t`.
    ///
    /// # Errors
    /// [`RunError::NewtonFailed`], [`RunError::NonFinite`] or [`RunError::MassLeftOut`].
    pub fn step(&mut self, evaluator: &mut Evaluator<'_>, t: f64, h: f64) -> Result<(), RunError> {
        self.expect(h);
        let laws = evaluator.prescribed(t + h).chunks_exact(3);
        for (place, law) in self.trial.driven.iter().zip(laws) {
            self.trial.all_a[*place] = law[2];
        }
        let mut before = f64::INFINITY;
        let mut fresh = false;
        for iteration in 1..=MAX_ITERATIONS {
            self.iterations += 1;
            let renewed = self.factored_step != h;
            if !self.evaluate(evaluator, t + h, h) {
                return Err(RunError::MassLeftOut { t: t + h });
            }
            core::mem::swap(&mut self.residual, &mut self.shifted);
            if !is_finite(&self.shifted) {
                return Err(RunError::NonFinite { t: t + h, what: "the equations of motion".to_owned() });
            }
            if renewed {
                self.refresh(evaluator, t + h, h);
                fresh = true;
            }
            let size = self.correct();
            let rounding = 2.0 * f64::EPSILON * largest(&self.now.q).max(1.0);
            // What a steady rate leaves behind is a geometric series; a tenth of rounding is nothing.
            let rate = if before.is_finite() { size / before } else { 1.0 };
            let left = size * rate / (1.0 - rate);
            let enough = (SOLVED * self.expected.moved(&self.now, &self.x, &self.per_size))
                .min(CLOSED_BY_A_STEP)
                .max(0.1 * rounding);
            let converged = size <= rounding || (rate < STEADY && left <= enough);
            if converged || (size > 0.5 * before && size < ROUNDING) {
                return self.accept(evaluator, t + h);
            }
            if iteration > 2 && size > SLOW * before && !fresh {
                self.factored_step = 0.0;
            }
            fresh = false;
            before = size;
        }
        self.factored_step = 0.0;
        Err(RunError::NewtonFailed { t, step: h, correction: before })
    }

    /// Begins a step of `h` where accelerations and multipliers go on as they did over the last one.
    fn expect(&mut self, h: f64) {
        let (last, count) = self.last_steps;
        // The first step knows nothing before it, and its start is not the method's own.
        let goes_on = count > 1;
        // Multipliers keep their size, so the scaled ones change with the step.
        let rescale = if last > 0.0 { (h / last) * (h / last) } else { 1.0 };
        for (scaled, before) in self.scaled_multipliers.iter_mut().zip(&mut self.multipliers_before) {
            let expected = if goes_on { 2.0 * *scaled - *before } else { *scaled };
            (*scaled, *before) = (rescale * expected, rescale * *scaled);
        }
        self.expected.begin(&self.now, h, goes_on);
        self.x.fill(0.0);
        self.last_steps = (h, count + 1);
    }

    /// Applies the Newton correction for the residual in `shifted`; returns its largest increment.
    fn correct(&mut self) -> f64 {
        let n = self.x.len();
        if self.rank_lost {
            self.orthogonal.solve(&self.shifted, &mut self.residual);
            self.shifted.copy_from_slice(&self.residual);
        } else {
            self.lu.solve(&mut self.shifted);
        }
        add_scaled(&mut self.x, -1.0, &self.shifted[..n]);
        add_scaled(&mut self.scaled_multipliers, -1.0, &self.shifted[n..]);
        largest_of(self.shifted[..n].iter().zip(&self.per_size).map(|(x, per_size)| x * per_size))
    }

    /// Moves the trial to the present unknowns.
    fn advance(&mut self, evaluator: &Evaluator<'_>) {
        // The increments go where the residual comes next.
        let increments = &mut self.residual[..self.x.len()];
        self.expected.corrected(&self.x, &mut self.next, increments);
        self.next.q.copy_from_slice(&self.now.q);
        evaluator.layout().advance(&mut self.next.q, increments);
    }

    /// Residual of the balance of forces (times `h²`) and of the constraints, for the present unknowns; false where the equations
    /// come without masses.
    fn evaluate(&mut self, evaluator: &mut Evaluator<'_>, t: f64, h: f64) -> bool {
        self.evaluations += 1;
        self.advance(evaluator);
        let (n, m) = (self.x.len(), self.scaled_multipliers.len());
        let (next, trial) = (&self.next, &mut self.trial);
        let all = trial.all_a.len();
        let prescribed = evaluator.last_prescribed();
        evaluator.layout().expand((&next.q, &next.v), prescribed, (&mut trial.all_q, &mut trial.all_v));
        let all_a = &mut trial.all_a[..];
        for (place, a) in trial.free.iter().zip(&next.v_dot) {
            all_a[*place] = *a;
        }
        evaluator.evaluate_contacts(t, &next.q, &next.v);
        let equations = evaluator.equations(t, &trial.all_q, &trial.all_v);
        let has_masses = !equations.is_without_masses();
        equations.inertia(&trial.all_a, &mut trial.balance);
        for (balance, bias) in trial.balance.iter_mut().zip(equations.bias) {
            *balance = h * h * (*balance + bias);
        }
        for (k, index) in self.kept.iter().enumerate() {
            let row = &equations.jacobian[index * all..][..all];
            add_scaled(&mut trial.balance, -self.scaled_multipliers[k], row);
            // Only a new Newton matrix asks for the rows themselves.
            if self.factored_step != h {
                for (entry, place) in self.free_rows[k * n..].iter_mut().zip(&trial.free) {
                    *entry = row[*place];
                }
            }
        }
        let (balance, (forces, loops)) = (&trial.balance[..], self.residual.split_at_mut(n));
        for (residual, place) in forces.iter_mut().zip(&trial.free) {
            *residual = balance[*place];
        }
        for (residual, index) in loops[..m].iter_mut().zip(&self.kept) {
            *residual = equations.positions[*index];
        }
        has_masses
    }

    /// Newton matrix by difference quotients in the increments; exact in the multipliers.
    fn refresh(&mut self, evaluator: &mut Evaluator<'_>, t: f64, h: f64) {
        let (n, m) = (self.x.len(), self.scaled_multipliers.len());
        let size = n + m;
        self.factored_step = h;
        self.matrix.fill(0.0);
        for k in 0..m {
            for i in 0..n {
                self.matrix[i * size + n + k] = -self.free_rows[k * n + i];
            }
        }
        for j in 0..n {
            let kept = self.x[j];
            let difference = DIFFERENCE * self.sizes[j];
            self.x[j] = kept + difference;
            self.evaluate(evaluator, t, h);
            self.x[j] = kept;
            for (i, (moved, base)) in self.residual.iter().zip(&self.shifted).enumerate() {
                self.matrix[i * size + j] = (moved - base) / difference;
            }
        }
        let pivot = self.lu.factor(&self.matrix);
        self.rank_lost = pivot.is_nan() || pivot < LOST_PIVOT;
        if self.rank_lost {
            self.orthogonal.factor(&self.matrix, size, size, LOST_PIVOT);
        }
    }

    /// Takes the converged unknowns over.
    fn accept(&mut self, evaluator: &Evaluator<'_>, t: f64) -> Result<(), RunError> {
        self.advance(evaluator);
        evaluator.layout().normalize(&mut self.next.q);
        if !is_finite(&self.next.v_dot) || !is_finite(&self.scaled_multipliers) {
            return Err(RunError::NonFinite { t, what: "the result of the implicit step".to_owned() });
        }
        core::mem::swap(&mut self.now, &mut self.next);
        Ok(())
    }
}
