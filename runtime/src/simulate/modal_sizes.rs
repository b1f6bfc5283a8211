//! How large the deflections of flexible bodies are by nature: by them the errors of steps are judged, so that a tolerance holds for
//! forces. In: states with their accelerations. Out: sizes of modal coordinates and speeds. Never knows steps.

use crate::evaluate::Evaluator;
use crate::linear::largest;

/// Width of the difference quotients of stiffnesses, in units of modal coordinates: they are linear in the dynamics.
const DIFFERENCE: f64 = 1e-6;
/// Part of their sizes by which deflections are judged that loops stand on. Such a deflection is the force in its loop, and as little as
/// links are damped it rings for some fifty vibrations, over which errors of the steps add up. What bends between its joints without
/// moving them only adds its inertia.
const IN_LOOPS: f64 = 0.05;
/// Part of the largest acceleration or squared speed, in their units, that counts as a load at least. Where nothing loads the modes, as of a
/// body that falls, their accelerations are rounding of terms of that size, some 1e-15 of them: steps that go by it make no progress. Loads
/// that are no rounding are larger than this part.
const LEAST_LOAD: f64 = 1e-6;
/// Columns of the loops' rows below this part of the largest entry are rounding.
const NOTHING: f64 = 1e-12;

/// A modal coordinate that nothing prescribes.
#[derive(Clone, Copy, Debug)]
struct Mode {
    coordinate: usize,
    speed: usize,
    /// Acceleration against a deflection of 1, at the start [1/s²]; 0 if nothing holds it there.
    stiffness: f64,
    /// Part of its size by which its errors are judged.
    share: f64,
}

/// Modal coordinates of a mechanism, and the largest load on one of them so far.
///
/// A deflection is judged beside the one that this load holds: an error of it by a part is an error of the forces by that part at most.
#[derive(Clone, Debug, Default)]
pub(super) struct ModalSizes {
    modes: Vec<Mode>,
    /// In the unit of accelerations of modal coordinates.
    load: f64,
}

impl ModalSizes {
    /// Looks for modal coordinates; their stiffnesses are those at a state.
    pub(super) fn new(evaluator: &mut Evaluator<'_>, (t, q, v): (f64, &[f64], &[f64])) -> Self {
        let places: Vec<(usize, usize)> = evaluator.description().modes().collect();
        let mut q = q.to_vec();
        let shares = shares(evaluator, (t, &q, v));
        let modes = places.into_iter().map(|(coordinate, speed)| {
            let value = q[coordinate];
            let mut at = |value| {
                q[coordinate] = value;
                evaluator.forward(t, &q, v).accelerations[speed]
            };
            let stiffness = (at(value - DIFFERENCE) - at(value + DIFFERENCE)) / (2.0 * DIFFERENCE);
            q[coordinate] = value;
            let share = shares[speed];
            let is_held = stiffness > 0.0 && stiffness.is_finite();
            Mode { coordinate, speed, stiffness: if is_held { stiffness } else { 0.0 }, share }
        });
        Self { modes: modes.collect(), load: 0.0 }
    }

    /// Learns from a state that counts; whether anything changed.
    pub(super) fn note(&mut self, (q, v): (&[f64], &[f64]), accelerations: &[f64]) -> bool {
        if self.held().next().is_none() {
            return false;
        }
        let loads = self.held().map(|mode| {
            let held = mode.stiffness * q[mode.coordinate];
            held.abs().max(accelerations[mode.speed].abs())
        });
        let speed = largest(v);
        let least = LEAST_LOAD * largest(accelerations).max(speed * speed);
        let load = loads.fold(self.load.max(least), f64::max);
        let more = load > self.load;
        self.load = load;
        more
    }

    /// Frequency of the fastest mode [rad/s]; 0 without modes.
    pub(super) fn fastest(&self) -> f64 {
        self.held().fold(0.0, |fastest, mode| fastest.max(mode.stiffness.sqrt()))
    }

    fn held(&self) -> impl Iterator<Item = &Mode> {
        self.modes.iter().filter(|mode| mode.stiffness > 0.0)
    }

    /// Writes the sizes, as far as errors are judged by them, among those of all coordinates and speeds, if a load is known.
    pub(super) fn write(&self, (coordinates, speeds): (&mut [f64], &mut [f64])) {
        if self.load > 0.0 {
            for mode in self.held() {
                let load = self.load * mode.share;
                coordinates[mode.coordinate] = (load / mode.stiffness).min(1.0);
                speeds[mode.speed] = (load / mode.stiffness.sqrt()).min(1.0);
            }
        }
    }

    /// See [`crate::integrate::Problem::pass_over`]. Deflections that loops stand on keep their errors: what a step adds to them may come
    /// from where the bodies are, and is not forgotten.
    pub(super) fn pass_over(&self, reach: f64, (coordinates, speeds): (&mut [f64], &mut [f64])) {
        for mode in self.held().filter(|mode| mode.share >= 1.0) {
            let squared = reach * reach * mode.stiffness;
            if squared > 1.0 {
                let passed = squared.sqrt();
                coordinates[mode.coordinate] /= passed;
                speeds[mode.speed] /= passed;
            }
        }
    }

    /// As [`crate::Evaluator::visit_memory`].
    pub(super) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        visit(&mut self.load);
    }

    /// The same of what is known of modes from a start.
    pub(super) fn visit_modes(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        for mode in &mut self.modes {
            visit(&mut mode.stiffness);
            visit(&mut mode.share);
        }
    }
}

/// Of every speed, [`Mode::share`] if it is one of a mode.
fn shares(evaluator: &mut Evaluator<'_>, (t, q, v): (f64, &[f64], &[f64])) -> Vec<f64> {
    let jacobian = evaluator.closure(t, q, v).jacobian;
    let least = NOTHING * largest(jacobian);
    let moves_loops = |speed: usize| jacobian.chunks_exact(v.len()).any(|row| row[speed].abs() > least);
    (0..v.len()).map(|speed| if moves_loops(speed) { IN_LOOPS } else { 1.0 }).collect()
}
