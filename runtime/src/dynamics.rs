//! Accelerations at a state: the generated forward dynamics, or a rank-revealing solve where the loops
//! are nearly singular. In: time and state. Out: accelerations, multipliers, drive forces.
//! Never knows step sizes.

mod pivots;

use crate::error::RunError;
use crate::evaluate::{Evaluator, Forward, Known, StepLimits};
use crate::linear::{is_finite, largest};
use crate::passage::{Judge, Limit, Passage};
use crate::regularity::PROJECTED_STAGES;
use crate::runge_kutta::PARTS;
use crate::singular_dynamics::SingularSolver;
use crate::system::StepOf;
use pivots::LargestPivots;

/// A loop pivot (about the square of a singular value) below this part of the largest value the same pivot
/// has had makes the runtime leave the generated elimination. At 1e-7 (a singular value of 3e-4) rounding
/// of the loop, 1e-16 m, already shows as speeds of 1e-8 in the direction that becomes singular; nearer to
/// the singular position exact equations would follow such errors onto another branch. Smaller values
/// let more of that noise in (1e-9: a hundred times); larger ones continue the acceleration for longer.
pub const SINGULAR_PIVOT: f64 = 1e-7;

/// Below this multiple of it, rounding of the generated elimination already shows more than the error of the means that
/// [`crate::passage`] takes, ...
const ROUNDED: f64 = 10.0;
/// ... and above this multiple rounding is less than that error: there they are taken. With forty loops in a row a third of it
/// leaves five times as much of the rounding.
const BESIDE: f64 = 300.0;

/// Rounding of accelerations at nearness 1, relative to the square of the largest speed: ten last places.
///
/// Rounding of the loop, 1e-16 m, shows in the speeds of the nearly lost direction by the inverse square of the singular
/// value, and these show in its acceleration by one more.
const NOISE: f64 = 10.0 * f64::EPSILON;

/// An acceleration noted further back than this [rad, m] along the motion says nothing about the present one.
const REACH: f64 = 0.1;

/// Evaluates accelerations and counts how.
pub struct Dynamics<'a> {
    /// The mechanism.
    pub evaluator: Evaluator<'a>,
    /// Calls of the forward dynamics.
    pub evaluations: u64,
    /// Calls that needed the rank-revealing solve.
    pub rank_revealing_solves: u64,
    singular_pivot: f64,
    largest_pivots: LargestPivots,
    nearness: f64,
    reference: Vec<f64>,
    reference_time: Option<f64>,
    pub(crate) solver: SingularSolver,
    pub(crate) passage: Passage,
    /// Whether the rows lost rank at the last state, so that they do not tell all forces there.
    rank_lost: bool,
    /// The last answer that was found regular and finite, how often the largest pivots had changed by then, and how regular it is.
    seen: Option<(Known, u64, f64)>,
    /// The answer of the generated elimination.
    direct: Vec<f64>,
}

/// What evaluations change in [`Dynamics`].
pub(crate) struct Aside {
    evaluations: u64,
    rank_revealing_solves: u64,
    nearness: f64,
    rank_lost: bool,
}

impl<'a> Dynamics<'a> {
    /// Prepares storage; `singular_pivot` is the threshold, [`SINGULAR_PIVOT`] by default.
    pub fn new(mut evaluator: Evaluator<'a>, singular_pivot: f64) -> Self {
        let (solver, passage) = (SingularSolver::new(&evaluator), Passage::new(&evaluator));
        let sizes = evaluator.sizes();
        Self {
            direct: evaluator.forward_mut().to_vec(),
            evaluator,
            evaluations: 0,
            rank_revealing_solves: 0,
            singular_pivot,
            largest_pivots: LargestPivots::new(sizes.rows),
            nearness: 1.0,
            reference: vec![0.0; sizes.speeds],
            reference_time: None,
            solver,
            passage,
            rank_lost: false,
            seen: None,
        }
    }

    /// Accelerations, multipliers and drive forces at a state; read them with
    /// [`Evaluator::last_forward`].
    ///
    /// # Errors
    /// [`RunError::NonFinite`] if one of them is infinite or not a number.
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), RunError> {
        self.evaluations += 1;
        self.rank_lost = false;
        if let Some((known, changes, nearness)) = self.seen
            && self.largest_pivots.changes() == changes
            && self.evaluator.holds_at(known, (t, q, v))
        {
            self.nearness = nearness;
            return Ok(());
        }
        self.see_nearness(t, q, v);
        self.judge(t, q, v)
    }

    /// The same of a state for which this was known. Whether it still is.
    ///
    /// # Errors
    /// As [`Self::accelerate`].
    pub(crate) fn accelerate_known(
        &mut self,
        known: Known,
        (t, q, v): (f64, &[f64], &[f64]),
    ) -> Result<bool, RunError> {
        if !self.evaluator.holds(known) {
            return Ok(false);
        }
        debug_assert!(self.evaluator.holds_at(known, (t, q, v)));
        self.evaluations += 1;
        self.rank_lost = false;
        self.nearness = self.largest_pivots.note(self.evaluator.last_forward().pivots);
        self.judge(t, q, v).map(|()| true)
    }

    /// Goes the ways of nearly singular states, if the last one is.
    fn judge(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), RunError> {
        if self.nearness < ROUNDED * self.singular_pivot {
            self.pass(t, q, v);
            self.evaluations += std::mem::take(&mut self.passage.evaluations);
            return self.check(t);
        }
        self.check(t)?;
        let changes = self.largest_pivots.changes();
        self.seen = self.evaluator.known().map(|known| (known, changes, self.nearness));
        Ok(())
    }

    /// Evaluates the inner stages of a step at once, and its end as far as it needs no projection, if that can be done: at states as
    /// regular as any. Whether it did.
    pub(crate) fn classical_step(&mut self, step: &StepOf<'_>, looseness: f64) -> bool {
        let limits = StepLimits { pivots: self.largest_pivots.known(), looseness };
        if !self.is_regular(self.nearness) || !self.evaluator.classical_step(step, limits) {
            return false;
        }
        let Some(answer) = self.evaluator.last_step() else { return false };
        if !self.is_regular(answer.least_nearness()) {
            return false;
        }
        self.evaluations += PARTS.len() as u64;
        (self.nearness, self.rank_lost) = (answer.nearness(), false);
        self.largest_pivots.note(answer.grown_pivots());
        true
    }

    /// Whether loops are as regular as any where generated code says so much of them; not if that is no number.
    pub(crate) fn is_regular(&self, nearness: f64) -> bool {
        nearness >= PROJECTED_STAGES.max(ROUNDED * self.singular_pivot)
    }

    /// Sees how regular a state is; no part of what a run costs.
    pub(crate) fn see_nearness(&mut self, t: f64, q: &[f64], v: &[f64]) {
        let pivots = self.evaluator.pivots(t, q, v);
        self.nearness = self.largest_pivots.note(pivots);
    }

    /// How regular loops of these pivots are, by the largest that each has had.
    pub(crate) fn regularity(&self, pivots: impl Iterator<Item = f64>) -> f64 {
        self.largest_pivots.regularity_of(pivots)
    }

    /// Takes over evaluations made elsewhere, after the last of which the loops are as regular as this.
    pub(crate) fn take_over(&mut self, evaluations: u64, nearness: f64) {
        self.evaluations += evaluations;
        (self.nearness, self.rank_lost) = (nearness, false);
    }

    /// The largest value that each pivot has had.
    pub(crate) fn largest_pivots(&self) -> &[f64] {
        self.largest_pivots.known()
    }

    /// Notes pivots of an evaluation made elsewhere.
    pub(crate) fn note_pivots(&mut self, pivots: &[f64]) -> f64 {
        self.largest_pivots.note(pivots)
    }

    /// What to go on with after a look that is no part of the run; one at a time.
    pub(crate) fn aside(&mut self) -> Aside {
        let Self { evaluations, rank_revealing_solves, nearness, rank_lost, .. } = *self;
        self.largest_pivots.put_aside();
        Aside { evaluations, rank_revealing_solves, nearness, rank_lost }
    }

    /// Goes on as if nothing had been evaluated since.
    pub(crate) fn resume(&mut self, aside: Aside) {
        (self.evaluations, self.rank_revealing_solves) = (aside.evaluations, aside.rank_revealing_solves);
        (self.nearness, self.rank_lost) = (aside.nearness, aside.rank_lost);
        self.largest_pivots.resume();
    }

    /// Smallest pivot at the last state, each relative to the largest value it has had (1: as regular as
    /// ever, 0: singular).
    pub fn nearness(&self) -> f64 {
        self.nearness
    }

    /// Whether the last state counted as nearly singular.
    pub fn is_near_singular(&self) -> bool {
        self.nearness < self.singular_pivot
    }

    /// Notes accelerations of a state that was reached, unless it is nearly singular.
    pub fn note_reference(&mut self, t: f64, accelerations: &[f64]) {
        if !self.is_near_singular() {
            self.reference.copy_from_slice(accelerations);
            self.reference_time = Some(t);
        }
    }

    /// Whether the rows do not tell all forces at the last state. What was not found by the states beside it is then zero.
    pub(crate) fn is_rank_lost(&self) -> bool {
        self.rank_lost
    }

    /// The generated columns at the last state, which lost rank, by the states beside it; leaves the forward dynamics as it is.
    pub(crate) fn columns_beside(&mut self, t: f64, q: &[f64], v: &[f64]) -> Option<&Limit> {
        self.direct.copy_from_slice(self.evaluator.forward_mut());
        let regularity = |forward: &Forward<'_>| self.largest_pivots.regularity(forward.pivots);
        let judge: Judge<'_> = (&regularity, BESIDE * self.singular_pivot);
        let found = self.passage.limit(&mut self.evaluator, (t, q, v), judge, true).is_some();
        self.evaluations += std::mem::take(&mut self.passage.evaluations);
        self.evaluator.forward_mut().copy_from_slice(&self.direct);
        found.then_some(&self.passage.limit)
    }

    /// On the way through a singular position: by states beside it, if they explain what is here but for rounding.
    // Seldom, and much code: out of the way of what every evaluation runs through.
    #[cold]
    #[inline(never)]
    fn pass(&mut self, t: f64, q: &[f64], v: &[f64]) {
        self.direct.copy_from_slice(self.evaluator.forward_mut());
        let regularity = |forward: &Forward<'_>| self.largest_pivots.regularity(forward.pivots);
        let judge: Judge<'_> = (&regularity, BESIDE * self.singular_pivot);
        let limit = self.passage.limit(&mut self.evaluator, (t, q, v), judge, false);
        if self.nearness < self.singular_pivot {
            self.rank_revealing_solves += 1;
            // At a dead point nothing comes later: what was before goes on, and the run ends where loops do not close.
            let reach = |from: f64| (t - from).abs() * largest(v).max(1.0) <= REACH;
            let before = self.reference_time.is_some_and(reach).then_some(&self.reference[..]);
            let branch = limit.map(Limit::accelerations).or(before);
            self.rank_lost = self.solver.solve(&mut self.evaluator, (t, q, v), branch);
            if let Some(limit) = limit.filter(|_| self.rank_lost) {
                // The rows' own accelerations stay: they meet the constraints to the last place.
                let (forward, forces) = (limit.forward(), v.len()..limit.forward().len());
                self.evaluator.forward_mut()[forces.clone()].copy_from_slice(&forward[forces]);
            }
            return;
        }
        let branch = limit.map(Limit::accelerations);
        let noise = noise(self.nearness, v);
        let rounded = |branch: &&[f64]| branch.iter().zip(&self.direct).all(|(a, b)| (a - b).abs() <= noise);
        let output = self.evaluator.forward_mut();
        output.copy_from_slice(&self.direct);
        if let Some(branch) = branch.filter(rounded) {
            output[..branch.len()].copy_from_slice(branch);
        }
    }

    /// Rounding of the accelerations of the last state, whose speeds are `v`, of their largest component.
    pub(crate) fn noise(&self, v: &[f64]) -> f64 {
        noise(self.nearness.max(self.singular_pivot), v)
    }

    /// As [`Evaluator::visit_memory`], of all that it stands on too.
    pub(crate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.evaluator.visit_memory(visit);
        self.solver.visit_memory(visit);
        self.largest_pivots.visit(visit);
        self.reference.iter_mut().chain([&mut self.nearness]).for_each(&mut *visit);
        // No number of JSON says that there is none: a flag before the time.
        let (mut flag, mut time) = self.reference_time.map_or((0.0, 0.0), |time| (1.0, time));
        visit(&mut flag);
        visit(&mut time);
        self.reference_time = (flag != 0.0).then_some(time);
    }

    fn check(&self, t: f64) -> Result<(), RunError> {
        if is_finite(self.evaluator.last_solution()) { Ok(()) } else { Err(self.not_finite(t)) }
    }

    #[cold]
    fn not_finite(&self, t: f64) -> RunError {
        if self.is_near_singular() && self.solver.is_without_masses() {
            return RunError::MassLeftOut { t };
        }
        let Forward { accelerations, multipliers, drives, .. } = self.evaluator.last_forward();
        let description = self.evaluator.description();
        let bad = |values: &[f64]| values.iter().position(|x| !x.is_finite());
        let what = if let Some(i) = bad(accelerations) {
            format!("acceleration of {}", description.speeds[i].name)
        } else if let Some(i) = bad(drives) {
            format!("drive of {}", description.drivers[i].joint)
        } else {
            let row = bad(multipliers).map_or(0, |i| self.evaluator.kept()[i]);
            format!("multiplier of {}", self.evaluator.joint_of_row(row))
        };
        RunError::NonFinite { t, what }
    }
}

/// See [`NOISE`].
fn noise(nearness: f64, v: &[f64]) -> f64 {
    let speed = largest(v);
    NOISE * speed * speed / (nearness * nearness.sqrt())
}
