//! Accelerations and forces in a singular position that the motion passes, from states before and after it.
//! In: a nearly singular state. Out: the accelerations of the branch that the motion is on, and its [`Limit`]. Never knows
//! step sizes.
//!
//! In the position itself rounding decides what the rows say about the nearly lost directions, but the branch is smooth: the
//! same motion a little earlier and a little later is regular. Means of both sides at one and at two distances, extrapolated
//! to none, are off by the fourth power of the distance.
//!
//! Forces may grow without bounds on the way there, as the inverse of the distance, with opposite signs on both sides. Half
//! the difference of both sides tells: it doubles with the distance if the force is smooth, and halves if it has such a pole.

use crate::evaluate::{Evaluator, Forward, put_back};
use crate::linear::largest;
use crate::projection::Projector;

/// Farthest of these states [rad, m] along the motion.
const REACH: f64 = 0.1;
/// Rounds that find the distance.
const ROUNDS: usize = 6;

/// Tells how regular a forward dynamics is (see [`crate::Dynamics::nearness`]), and how regular the states beside have to be.
pub(crate) type Judge<'a> = (&'a dyn Fn(&Forward<'_>) -> f64, f64);

/// Part of a pole, at the distance of the states beside, from which it is no rounding: of multipliers in states this regular.
const POLE: f64 = 1e-6;
/// Part that the third derivative of a smooth force may pretend at a distance of 1 rad: four thirds of it are in the
/// difference, and it may be some times the force itself.
const BENT: f64 = 10.0;

/// What a nearly singular state has by the states beside it.
pub(crate) struct Limit {
    /// Accelerations of the free speeds, multipliers of the kept rows, drive forces, then the generated columns if they were
    /// asked for. Of a number that grows without bounds: the part that does not.
    values: Vec<f64>,
    /// Part of each that grows without bounds, at the distance of the states beside.
    poles: Vec<f64>,
    /// That distance [rad, m] along the motion.
    distance: f64,
    accelerations: usize,
    forces: usize,
}

impl Limit {
    /// Accelerations of the free speeds.
    pub(crate) fn accelerations(&self) -> &[f64] {
        &self.values[..self.accelerations]
    }

    /// Accelerations, multipliers and drive forces.
    pub(crate) fn forward(&self) -> &[f64] {
        &self.values[..self.forces]
    }

    /// Value of column `index`.
    pub(crate) fn column(&self, index: usize) -> f64 {
        self.values[self.forces + index]
    }

    /// How large column `index` is at the state or beside it.
    pub(crate) fn size(&self, index: usize) -> f64 {
        let place = self.forces + index;
        self.values[place].abs().max(self.poles[place].abs())
    }

    /// Whether column `index`, among columns of this size, grows without bounds towards the state.
    pub(crate) fn is_unbounded(&self, index: usize, size: f64) -> bool {
        let smooth = POLE.max(BENT * self.distance.powi(3));
        self.poles[self.forces + index].abs() > smooth * size
    }
}

/// Storage for the states beside one.
pub(crate) struct Passage {
    pub(crate) projector: Projector,
    /// Calls of the forward dynamics so far.
    pub(crate) evaluations: u64,
    q: Vec<f64>,
    v: Vec<f64>,
    delta: Vec<f64>,
    /// Means of both sides, and half their differences, at one and at two distances.
    means: [Vec<f64>; 2],
    differences: [Vec<f64>; 2],
    /// What [`Self::limit`] found last.
    pub(crate) limit: Limit,
    /// Whether the columns are taken too.
    columns: bool,
    memory: Vec<f64>,
}

impl Passage {
    /// Storage for the evaluator's mechanism.
    pub(crate) fn new(evaluator: &Evaluator<'_>) -> Self {
        let sizes = evaluator.sizes();
        let forces = sizes.speeds + sizes.rows + sizes.drivers;
        let zero = || vec![0.0; forces + sizes.channels];
        Self {
            projector: Projector::new(evaluator),
            evaluations: 0,
            q: vec![0.0; sizes.coordinates],
            v: vec![0.0; sizes.speeds],
            delta: vec![0.0; sizes.speeds],
            means: [zero(), zero()],
            differences: [zero(), zero()],
            limit: Limit {
                values: zero(),
                poles: zero(),
                distance: 0.0,
                accelerations: sizes.speeds,
                forces,
            },
            columns: false,
            memory: Vec::new(),
        }
    }

    /// Accelerations and forces at a state by those beside it, and the generated columns if `columns`.
    ///
    /// `None` if the motion has no regular states near by on both sides. Leaves the contacts of the state in the evaluator, and
    /// the forward dynamics of another state.
    pub(crate) fn limit(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        judge: Judge<'_>,
        columns: bool,
    ) -> Option<&Limit> {
        // What the evaluator remembers of other states is none of the run's.
        let mut memory = std::mem::take(&mut self.memory);
        memory.clear();
        evaluator.visit_memory(&mut |number| memory.push(*number));
        self.limit.values.fill(0.0);
        self.columns = columns;
        let found = self.look_beside(evaluator, (t, q, v), judge);
        evaluator.visit_memory(&mut put_back(&memory));
        self.memory = memory;
        evaluator.evaluate_contacts(t, q, v);
        found.map(|()| &self.limit)
    }

    fn look_beside(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        state: (f64, &[f64], &[f64]),
        judge: Judge<'_>,
    ) -> Option<()> {
        let enough = judge.1;
        let speed = largest(state.2);
        let mut distance = enough.sqrt() / speed;
        let mut regular = false;
        for _ in 0..ROUNDS {
            // Twice the distance has to be within reach, and speeds have to carry the motion there.
            let carried = distance * largest(self.limit.accelerations()) < speed;
            if !(2.0 * distance * speed <= REACH && carried) {
                return None;
            }
            let least = self.look_at(evaluator, state, distance, 0, judge)?;
            if regular {
                self.look_at(evaluator, state, 2.0 * distance, 1, judge)?;
                return self.extrapolate(distance * speed);
            }
            self.limit.values.copy_from_slice(&self.means[0]);
            regular = least >= 0.5 * enough;
            if !regular {
                // Regularity goes with the square of the distance.
                distance *= (enough / least).sqrt().clamp(1.5, 8.0);
            }
        }
        None
    }

    /// From both distances to the state itself; the nearer one is `distance` [rad, m] away.
    fn extrapolate(&mut self, distance: f64) -> Option<()> {
        let Limit { values, poles, distance: known, .. } = &mut self.limit;
        *known = distance;
        for (value, (once, twice)) in values.iter_mut().zip(self.means[0].iter().zip(&self.means[1])) {
            *value = (4.0 * once - twice) / 3.0;
        }
        let differences = self.differences[0].iter().zip(&self.differences[1]);
        for (pole, (once, twice)) in poles.iter_mut().zip(differences) {
            // A pole halves what it adds when the distance doubles, and a slope doubles it: what is left is 3/2 of the pole.
            *pole = (2.0 * once - twice) / 1.5;
        }
        values.iter().all(|value| value.is_finite()).then_some(())
    }

    /// Writes means and half differences of the numbers `distance` [s] before and after a state; returns the lesser
    /// regularity.
    fn look_at(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        distance: f64,
        place: usize,
        (regularity, enough): Judge<'_>,
    ) -> Option<f64> {
        let mut least = f64::INFINITY;
        self.means[place].fill(0.0);
        self.differences[place].fill(0.0);
        for (side, step) in [(-0.5, -distance), (0.5, distance)] {
            self.q.copy_from_slice(q);
            for (i, a) in self.limit.accelerations().iter().enumerate() {
                self.delta[i] = step * (v[i] + 0.5 * step * a);
                self.v[i] = v[i] + step * a;
            }
            evaluator.layout().advance(&mut self.q, &self.delta);
            self.projector.project(evaluator, t + step, (&mut self.q, &mut self.v), enough).ok()?;
            self.evaluations += 1;
            let forward = evaluator.forward(t + step, &self.q, &self.v);
            least = least.min(regularity(&forward));
            let Forward { accelerations, multipliers, drives, .. } = forward;
            let (mean, difference) = (&mut self.means[place], &mut self.differences[place]);
            let numbers = accelerations.iter().chain(multipliers).chain(drives);
            add(mean, difference, numbers, side);
            if self.columns {
                let first = self.limit.forces;
                let columns = evaluator.observe(t + step, &self.q, &self.v);
                add(&mut mean[first..], &mut difference[first..], columns.iter(), side);
            }
        }
        Some(least)
    }
}

/// Adds half of the numbers of one side to their mean, and with the side's sign to half their difference.
fn add<'a>(mean: &mut [f64], difference: &mut [f64], numbers: impl Iterator<Item = &'a f64>, side: f64) {
    for ((mean, difference), number) in mean.iter_mut().zip(difference).zip(numbers) {
        *mean += 0.5 * number;
        *difference += side * number;
    }
}
