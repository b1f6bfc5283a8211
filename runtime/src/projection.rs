//! Puts a state back onto the constraints after a step: positions on the manifold, then speeds.
//! In: time and a state near the constraints. Out: the state on them, and how far it moved.
//! Never knows integrators; allocates only when made.
//!
//! Corrections have minimum norm, and leave deflections of flexible bodies alone where anything else can move.
//! Directions in which the rows are nearly singular are left alone as long
//! as the residual can be met without them: near a singular position an error of 1e-15 m there would
//! move the mechanism by far more, perhaps to another branch.

use crate::evaluate::{CLOSED, Evaluator, LoopError};
use crate::linear::{Cholesky, Orthogonal, add_scaled, largest};
pub use crate::tolerances::{POSITION_TOLERANCE, SPEED_TOLERANCE};
use crate::tolerances::{SETTLED, TRUSTED_PIVOT, position_tolerance, speed_tolerance, untouched};

/// Singular values, relative to the largest, down to which directions are corrected, one after the other.
const LEVELS: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
/// The first of them where nearly lost directions are to stay as they are: that of [`crate::SINGULAR_PIVOT`], its root. A residual
/// of 1e-14 m, met by a singular value of 2e-4, would turn speeds by 1e-7.
const LOST: f64 = 3e-4;
/// What is left of [`POSITION_TOLERANCE`] and [`SPEED_TOLERANCE`] there: last places.
const STRICT: f64 = 1e-2;
const MAX_ITERATIONS: usize = 25;
/// Natural size of the motion along a mode at most, as [`Projector::set_sizes`] has it. A deflection holds a force: of a stiff link it is
/// a micrometre or a nanometre, which an equal share in the correction of a loop of metres would change by far more than itself.
const MODE: f64 = 1e-6;

/// How far a projection moved the state: largest component of each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Of the coordinates [rad, m].
    pub position: f64,
    /// Index of the free speed that belongs to it.
    pub worst: usize,
    /// Of the speeds [rad/s, m/s].
    pub speed: f64,
    /// Index of the free speed corrected most.
    pub worst_speed: usize,
}

impl Correction {
    /// Whether anything was moved.
    pub fn moved(&self) -> bool {
        self.position > 0.0 || self.speed > 0.0
    }
}

/// The loops cannot be closed from here (or the residual is not a number).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotClosed {
    /// Where the loops stayed open.
    pub error: LoopError,
}

/// Storage of the projection of one mechanism.
pub struct Projector {
    jacobian: Vec<f64>,
    residual: Vec<f64>,
    delta: Vec<f64>,
    right: Vec<f64>,
    scales: Vec<f64>,
    /// Natural size of each free speed's motion: how readily a correction moves it.
    sizes: Vec<f64>,
    /// The speeds of modes among them.
    modes: Vec<usize>,
    gram: Cholesky,
    orthogonal: Orthogonal,
    factored: Factored,
    error: LoopError,
    /// Longest lever arm [m].
    arm: f64,
    /// What the last projection moved: positions (as speeds would) and speeds.
    moved: [Vec<f64>; 2],
    /// Whether these may be other than zero.
    has_moved: bool,
    /// Factor on the tolerances.
    strictness: f64,
    /// Whether nearly lost directions stay untouched.
    keep_lost: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Factored {
    No,
    Gram,
    Orthogonal { level: usize },
}

impl Projector {
    /// Storage for the evaluator's mechanism.
    pub fn new(evaluator: &Evaluator<'_>) -> Self {
        let (m, n) = (evaluator.sizes().rows, evaluator.sizes().speeds);
        let modes = evaluator.description().modes().map(|(_, speed)| speed).collect();
        let mut projector = Self {
            jacobian: vec![0.0; m * n],
            residual: vec![0.0; m],
            delta: vec![0.0; n],
            right: vec![0.0; m],
            gram: Cholesky::new(m),
            orthogonal: Orthogonal::new(m, n),
            factored: Factored::No,
            error: LoopError::default(),
            arm: 1.0,
            moved: [vec![0.0; n], vec![0.0; n]],
            has_moved: false,
            strictness: 1.0,
            keep_lost: false,
            scales: vec![0.0; m],
            sizes: vec![0.0; n],
            modes,
        };
        projector.set_sizes(&vec![1.0; n]);
        projector
    }

    /// Sets the natural size of each free speed's motion, 1 unless told otherwise: corrections are smallest
    /// relative to it. Micrometres of a clearance stay out of the correction of a loop of metres.
    pub fn set_sizes(&mut self, sizes: &[f64]) {
        self.sizes.copy_from_slice(sizes);
        for mode in &self.modes {
            self.sizes[*mode] = self.sizes[*mode].min(MODE);
        }
    }

    /// Sets the longest lever arm [m], which lengths are compared with; 1 m unless told otherwise.
    pub fn set_arm(&mut self, arm: f64) {
        self.arm = arm;
    }

    /// Loop error over all rows after the last projection.
    pub fn loop_error(&self) -> LoopError {
        self.error
    }

    /// Takes over the loop error of a state that was seen elsewhere to need nothing.
    pub(crate) fn take_over(&mut self, error: LoopError) {
        self.error = error;
    }

    /// All that the last projection moved: positions, as speeds would in unit time, and speeds.
    pub(crate) fn moved(&mut self) -> &mut [Vec<f64>; 2] {
        self.has_moved = true;
        &mut self.moved
    }

    /// Moves `q` and `v` onto the constraints at time `t`. Quaternions come out with unit length.
    ///
    /// `regularity`: [`crate::Dynamics::nearness`], 1 for regular positions. On the way to a singular one
    /// an open loop shows as speed divided by it, so tolerances shrink with it; above 1 they are wider. 0: nearly lost
    /// directions are left as they are.
    ///
    /// # Errors
    /// If the loops stay open by more than [`CLOSED`], or a residual is not a number.
    pub fn project(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
        regularity: f64,
    ) -> Result<Correction, NotClosed> {
        self.strictness = if regularity > 0.0 { regularity } else { STRICT };
        self.keep_lost = regularity <= 0.0;
        let mut correction = Correction::default();
        evaluator.layout().normalize(q);
        self.factored = Factored::No;
        self.error = LoopError::default();
        if std::mem::take(&mut self.has_moved) {
            self.moved.iter_mut().for_each(|moved| moved.fill(0.0));
        }
        if evaluator.sizes().all_rows == 0 {
            return Ok(correction);
        }
        self.close(evaluator, t, q, v, &mut correction)?;
        self.match_speeds(evaluator, t, q, v, &mut correction);
        Ok(correction)
    }

    fn close(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        t: f64,
        q: &mut [f64],
        v: &[f64],
        correction: &mut Correction,
    ) -> Result<(), NotClosed> {
        self.load(evaluator, t, q, v);
        // Most steps end so close, and need no tolerance.
        if largest(&self.residual) <= untouched(self.strictness).0 {
            self.error = evaluator.loop_error();
            if self.error.part(self.arm) <= CLOSED {
                return Ok(());
            }
        }
        let tolerance = position_tolerance(self.strictness, largest(q));
        let mut before = f64::INFINITY;
        for iteration in 0..=MAX_ITERATIONS {
            if iteration > 0 {
                self.load(evaluator, t, q, v);
            }
            let size = largest(&self.residual);
            let stalled = size > 0.25 * before;
            if size <= tolerance || (stalled && size <= SETTLED) {
                break;
            }
            if size.is_nan() || iteration == MAX_ITERATIONS {
                return Err(NotClosed { error: evaluator.loop_error() });
            }
            match (self.factored, stalled) {
                (Factored::No, _) | (Factored::Gram, true) => self.factor(evaluator, 0),
                (Factored::Orthogonal { level }, true) => {
                    let full = self.orthogonal.rank() == self.residual.len();
                    self.factor(evaluator, if full { level } else { level + 1 });
                }
                (_, false) => {}
            }
            before = size;
            self.has_moved = true;
            self.solve();
            evaluator.layout().advance(q, &self.delta);
            add_scaled(&mut self.moved[0], 1.0, &self.delta);
            note(&mut correction.position, &mut correction.worst, &self.delta);
        }
        self.error = evaluator.loop_error();
        let open = self.error.part(self.arm);
        if open.is_nan() || open > CLOSED + tolerance / self.arm {
            Err(NotClosed { error: self.error })
        } else {
            Ok(())
        }
    }

    fn match_speeds(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        t: f64,
        q: &[f64],
        v: &mut [f64],
        correction: &mut Correction,
    ) {
        let (_, least) = untouched(self.strictness);
        if largest(evaluator.last_closure().speeds) <= least {
            return;
        }
        let tolerance = speed_tolerance(least, largest(v));
        for _ in 0..=LEVELS.len() {
            self.residual.copy_from_slice(evaluator.last_closure().speeds);
            if largest(&self.residual) <= tolerance {
                return;
            }
            match self.factored {
                Factored::No => self.factor(evaluator, 0),
                Factored::Orthogonal { level } if correction.speed > 0.0 => self.factor(evaluator, level + 1),
                _ => {}
            }
            self.has_moved = true;
            self.solve();
            add_scaled(v, 1.0, &self.delta);
            add_scaled(&mut self.moved[1], 1.0, &self.delta);
            note(&mut correction.speed, &mut correction.worst_speed, &self.delta);
            let complete = match self.factored {
                Factored::Orthogonal { .. } => self.orthogonal.rank() == self.residual.len(),
                _ => true,
            };
            if complete || self.keep_lost {
                // Speeds enter linearly: one solve with all directions is enough.
                return;
            }
            evaluator.closure(t, q, v);
        }
    }

    fn load(&mut self, evaluator: &mut Evaluator<'_>, t: f64, q: &[f64], v: &[f64]) {
        evaluator.closure(t, q, v);
        let closure = evaluator.last_closure();
        for (residual, row) in self.residual.iter_mut().zip(evaluator.kept()) {
            *residual = closure.positions[*row];
        }
    }

    /// Factors the Jacobian of the last closure; from the second try on (or near a singular position)
    /// with an orthogonal decomposition that leaves out directions below the level.
    fn factor(&mut self, evaluator: &Evaluator<'_>, level: usize) {
        self.jacobian.copy_from_slice(evaluator.last_closure().jacobian);
        let n = self.delta.len();
        self.scales.copy_from_slice(evaluator.row_scales());
        for (scale, row) in self.scales.iter().zip(self.jacobian.chunks_exact_mut(n.max(1))) {
            row.iter_mut().zip(&self.sizes).for_each(|(x, size)| *x *= *scale * size);
        }
        if level == 0 && !self.keep_lost && self.gram.factor_gram(&self.jacobian, n) > TRUSTED_PIVOT {
            self.factored = Factored::Gram;
            return;
        }
        let level = level.min(LEVELS.len() - 1);
        let least = if level == 0 && self.keep_lost { LOST } else { LEVELS[level] };
        self.orthogonal.factor(&self.jacobian, self.residual.len(), n, least);
        self.factored = Factored::Orthogonal { level };
    }

    /// `delta`: the shortest solution of `J delta = -residual`.
    fn solve(&mut self) {
        let n = self.delta.len();
        for ((right, residual), scale) in self.right.iter_mut().zip(&self.residual).zip(&self.scales) {
            *right = -scale * residual;
        }
        if self.factored == Factored::Gram {
            self.gram.solve(&mut self.right);
            self.delta.fill(0.0);
            for (amount, row) in self.right.iter().zip(self.jacobian.chunks_exact(n.max(1))) {
                add_scaled(&mut self.delta, *amount, row);
            }
        } else {
            self.orthogonal.solve(&self.right, &mut self.delta);
        }
        self.delta.iter_mut().zip(&self.sizes).for_each(|(x, size)| *x *= size);
    }
}

fn note(most: &mut f64, worst: &mut usize, delta: &[f64]) {
    for (i, step) in delta.iter().enumerate() {
        if step.abs() > *most {
            (*most, *worst) = (step.abs(), i);
        }
    }
}
