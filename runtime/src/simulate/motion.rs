//! The mechanism as an initial value problem on its constraints: state = coordinates, speeds, work
//! supplied, work dissipated. In: states. Out: derivatives, projected states.
//! Never knows samples.

use crate::integrate::Problem;
use crate::linear::largest;
use crate::{Correction, Dynamics, LoopError, Projector, RunError, State};

/// A projection may move coordinates or speeds by this part of what the step itself moved them...
pub const BRANCH_PART: f64 = 0.1;
/// ...or by this much [rad, m, rad/s, m/s], relative to values above 1.
pub const JUMP_FLOOR: f64 = 1e-6;

/// Below this regularity (see [`Dynamics::nearness`]; about the square of a singular value) the stages of a
/// step are put onto the constraints before they are evaluated. A stage is off the constraints by its own
/// truncation error, which the nearly lost direction multiplies by the inverse of its singular value, twice;
/// on the constraints the accelerations stay smooth right through a singular position.
const PROJECTED_STAGES: f64 = 0.05;

/// Energies smaller than this [J] are noise to the step control.
const ENERGY_FLOOR: f64 = 1e-9;

/// Dynamics and projection of one mechanism, with what was counted.
pub(super) struct ConstrainedMotion<'a> {
    pub(super) dynamics: Dynamics<'a>,
    pub(super) projections: u64,
    projector: Projector,
    stage: Vec<f64>,
    coordinates: usize,
    speeds: usize,
    /// Largest kinetic energy so far [J]: the scale of the work quadratures.
    pub(super) energy_scale: f64,
}

impl<'a> ConstrainedMotion<'a> {
    pub(super) fn new(dynamics: Dynamics<'a>) -> Self {
        let sizes = dynamics.evaluator.sizes();
        let projector = Projector::new(&dynamics.evaluator);
        Self {
            dynamics,
            projections: 0,
            projector,
            stage: vec![0.0; sizes.coordinates + sizes.speeds + 2],
            coordinates: sizes.coordinates,
            speeds: sizes.speeds,
            energy_scale: ENERGY_FLOOR,
        }
    }

    /// The flat state of a start without any work done.
    pub(super) fn join(&self, state: &State) -> Vec<f64> {
        [&state.q[..], &state.v, &[0.0, 0.0]].concat()
    }

    /// Coordinates, speeds, and (work supplied, work dissipated) of a flat state.
    pub(super) fn split<'y>(&self, y: &'y [f64]) -> (&'y [f64], &'y [f64], (f64, f64)) {
        let (q, rest) = y.split_at(self.coordinates);
        let (v, work) = rest.split_at(self.speeds);
        (q, v, (work[0], work[1]))
    }

    /// Loop error after the last projection.
    pub(super) fn loop_error(&self) -> LoopError {
        self.projector.loop_error()
    }

    /// Puts a state onto the constraints, however far it moves.
    pub(super) fn put_on(&mut self, t: f64, y: &mut [f64]) -> Result<Correction, RunError> {
        let (q, rest) = y.split_at_mut(self.coordinates);
        let v = &mut rest[..self.speeds];
        let regularity = if self.dynamics.is_near_singular() { 0.0 } else { self.dynamics.nearness() };
        let evaluator = &mut self.dynamics.evaluator;
        let correction = self.projector.project(evaluator, t, (q, v), regularity).map_err(|open| {
            let error = open.error;
            let joint = evaluator.joint_of_row(error.worst);
            if error.metres.is_nan() || error.radians.is_nan() {
                return RunError::NonFinite { t, what: format!("loop residual of {joint}") };
            }
            RunError::LostAssembly { t, joint, residual_m: error.metres, residual_rad: error.radians }
        })?;
        self.projections += u64::from(correction.moved());
        Ok(correction)
    }

    /// Writes rates of coordinates, accelerations of the last forward dynamics, and powers.
    fn write_derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), RunError> {
        let (q, v, _) = self.split(y);
        let accelerations = self.dynamics.evaluator.last_forward().accelerations;
        derivative[self.coordinates..][..self.speeds].copy_from_slice(accelerations);
        let rates = self.dynamics.evaluator.rates(t, q, v);
        derivative[..self.coordinates].copy_from_slice(rates.coordinates);
        let work = &mut derivative[self.coordinates + self.speeds..];
        (work[0], work[1]) = (rates.supplied, rates.dissipated);
        if work.iter().all(|power| power.is_finite()) {
            Ok(())
        } else {
            Err(RunError::NonFinite { t, what: "power of drivers and forces".to_owned() })
        }
    }
}

impl Problem for ConstrainedMotion<'_> {
    fn derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), RunError> {
        let (q, v, _) = self.split(y);
        self.dynamics.accelerate(t, q, v)?;
        let projected = self.dynamics.nearness() < PROJECTED_STAGES;
        let mut stage = std::mem::take(&mut self.stage);
        stage.copy_from_slice(y);
        if projected && self.put_on(t, &mut stage).is_ok() {
            let (q, v, _) = self.split(&stage);
            self.dynamics.accelerate(t, q, v)?;
        }
        let result = self.write_derivative(t, &stage, derivative);
        self.stage = stage;
        result
    }

    fn project(&mut self, t: f64, before: &[f64], y: &mut [f64]) -> Result<(), RunError> {
        let moved = |range: std::ops::Range<usize>, y: &[f64]| {
            let ends = before[range.clone()].iter().zip(&y[range]);
            ends.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        let q_range = 0..self.coordinates;
        let v_range = self.coordinates..self.coordinates + self.speeds;
        let limit = |own: f64, values: &[f64]| (BRANCH_PART * own).max(JUMP_FLOOR * largest(values).max(1.0));
        let q_limit = limit(moved(q_range.clone(), y), &before[q_range]);
        // Speeds may stand still while the mechanism moves on: they count by their size as well.
        let v_size = largest(&before[v_range.clone()]);
        let v_limit = limit(moved(v_range.clone(), y).max(v_size), &before[v_range]);
        let correction = self.put_on(t, y)?;
        let name = |index| self.dynamics.evaluator.speed_name(index);
        if correction.position > q_limit {
            return Err(RunError::BranchChange {
                t,
                variable: name(correction.worst),
                jump: correction.position,
            });
        }
        if correction.speed > v_limit {
            let variable = format!("speed {}", name(correction.worst_speed));
            return Err(RunError::BranchChange { t, variable, jump: correction.speed });
        }
        Ok(())
    }

    fn reached(&mut self, t: f64, derivative: &[f64]) {
        self.dynamics.note_reference(t, &derivative[self.coordinates..][..self.speeds]);
    }

    fn scale(&self, index: usize) -> f64 {
        if index < self.coordinates + self.speeds { 1.0 } else { self.energy_scale }
    }

    fn name(&self, index: usize) -> String {
        let description = self.dynamics.evaluator.description();
        match index.checked_sub(self.coordinates) {
            None => description.coordinates[index].name.to_string(),
            Some(index) if index < self.speeds => format!("speed {}", description.speeds[index].name),
            Some(index) if index == self.speeds => "work supplied".to_owned(),
            Some(_) => "work dissipated".to_owned(),
        }
    }
}
