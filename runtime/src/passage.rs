//! Accelerations in a singular position that the motion passes, from states before and after it.
//! In: a nearly singular state. Out: the accelerations of the branch that the motion is on. Never knows step sizes.
//!
//! In the position itself rounding decides what the rows say about the nearly lost directions, but the branch is smooth: the
//! same motion a little earlier and a little later is regular. Means of both sides at one and at two distances, extrapolated
//! to none, are off by the fourth power of the distance.

use crate::evaluate::{Evaluator, Forward};
use crate::linear::largest;
use crate::projection::Projector;

/// Farthest of these states [rad, m] along the motion.
const REACH: f64 = 0.1;
/// Rounds that find the distance.
const ROUNDS: usize = 6;

/// Tells how regular a forward dynamics is (see [`crate::Dynamics::nearness`]), and how regular the states beside have to be.
pub(crate) type Judge<'a> = (&'a dyn Fn(&Forward<'_>) -> f64, f64);

/// Storage for the states beside one.
pub(crate) struct Passage {
    pub(crate) projector: Projector,
    /// Calls of the forward dynamics so far.
    pub(crate) evaluations: u64,
    q: Vec<f64>,
    v: Vec<f64>,
    delta: Vec<f64>,
    /// Means of both sides, at one and at two distances.
    means: [Vec<f64>; 2],
    accelerations: Vec<f64>,
    memory: Vec<f64>,
}

impl Passage {
    /// Storage for the evaluator's mechanism.
    pub(crate) fn new(evaluator: &Evaluator<'_>) -> Self {
        let sizes = evaluator.sizes();
        let zero = || vec![0.0; sizes.speeds];
        Self {
            projector: Projector::new(evaluator),
            evaluations: 0,
            q: vec![0.0; sizes.coordinates],
            v: zero(),
            delta: zero(),
            means: [zero(), zero()],
            accelerations: zero(),
            memory: Vec::new(),
        }
    }

    /// Accelerations at a state by those beside it.
    ///
    /// `None` if the motion has no regular states near by on both sides. Leaves the contacts of the state in the evaluator.
    pub(crate) fn accelerations(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        judge: Judge<'_>,
    ) -> Option<&[f64]> {
        // What the evaluator remembers of other states is none of the run's.
        let mut memory = std::mem::take(&mut self.memory);
        memory.clear();
        evaluator.visit_memory(&mut |number| memory.push(*number));
        self.accelerations.fill(0.0);
        let found = self.look_beside(evaluator, (t, q, v), judge);
        let mut kept = memory.iter();
        evaluator.visit_memory(&mut |number| *number = kept.next().copied().unwrap_or(*number));
        self.memory = memory;
        evaluator.evaluate_contacts(t, q, v);
        found.map(|()| &self.accelerations[..])
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
            let carried = distance * largest(&self.accelerations) < speed;
            if !(2.0 * distance * speed <= REACH && carried) {
                return None;
            }
            let least = self.mean(evaluator, state, distance, 0, judge)?;
            if regular {
                self.mean(evaluator, state, 2.0 * distance, 1, judge)?;
                let [once, twice] = &self.means;
                let mut same = true;
                for (value, (once, twice)) in self.accelerations.iter_mut().zip(once.iter().zip(twice)) {
                    *value = (4.0 * once - twice) / 3.0;
                    same &= value.is_finite();
                }
                return same.then_some(());
            }
            self.accelerations.copy_from_slice(&self.means[0]);
            regular = least >= 0.5 * enough;
            if !regular {
                // Regularity goes with the square of the distance.
                distance *= (enough / least).sqrt().clamp(1.5, 8.0);
            }
        }
        None
    }

    /// Writes the mean of the accelerations `distance` [s] before and after a state; returns the lesser regularity.
    fn mean(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        distance: f64,
        place: usize,
        (regularity, enough): Judge<'_>,
    ) -> Option<f64> {
        let mut least = f64::INFINITY;
        self.means[place].fill(0.0);
        for step in [-distance, distance] {
            self.q.copy_from_slice(q);
            for (i, a) in self.accelerations.iter().enumerate() {
                self.delta[i] = step * (v[i] + 0.5 * step * a);
                self.v[i] = v[i] + step * a;
            }
            evaluator.layout().advance(&mut self.q, &self.delta);
            self.projector.project(evaluator, t + step, (&mut self.q, &mut self.v), enough).ok()?;
            self.evaluations += 1;
            let forward = evaluator.forward(t + step, &self.q, &self.v);
            least = least.min(regularity(&forward));
            crate::linear::add_scaled(&mut self.means[place], 0.5, forward.accelerations);
        }
        Some(least)
    }
}
