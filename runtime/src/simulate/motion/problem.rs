//! What methods of integration ask the motion. In: states on their way. Out: slopes, corrected states, natural sizes.

use super::{
    ConstrainedMotion, JUMP_FLOOR, PROJECTED_STAGES, SAMPLED, SHUNNED_END, TOTALS, WORKS, is_energy,
};
use crate::error::RunError;
use crate::evaluate::CLOSED;
use crate::integrate::{Beside, Problem, Stepped};
use crate::linear::replace;
use crate::simulate::slopes::Slopes;
use crate::system::StepOf;
use crate::tables::Motion;

impl Problem for ConstrainedMotion<'_> {
    fn derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), RunError> {
        let (q, v, _) = self.split(y);
        self.dynamics.accelerate(t, q, v)?;
        if self.dynamics.nearness() >= PROJECTED_STAGES {
            return self.write_derivative(t, y, derivative);
        }
        let mut stage = std::mem::take(&mut self.stage);
        stage.copy_from_slice(y);
        let mut outcome = Ok(());
        if self.put_on(t, &mut stage).is_ok() {
            let (q, v, _) = self.split(&stage);
            outcome = self.dynamics.accelerate(t, q, v);
        }
        let outcome = outcome.and_then(|()| self.write_derivative(t, &stage, derivative));
        self.stage = stage;
        outcome
    }

    fn derivatives(
        &mut self,
        beside: &Beside<'_>,
        storage: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<(), RunError> {
        match self.alone.checked_sub(1) {
            Some(left) => self.alone = left,
            None if self.slopes.is_none() => {
                let evaluator = &self.dynamics.evaluator;
                let system = evaluator.system().side_by_side();
                self.slopes = system.and_then(|system| Slopes::new(system, evaluator));
            }
            None => {}
        }
        let mut slopes = std::mem::take(&mut self.slopes);
        let aside = self.dynamics.aside();
        let regular = self.dynamics.nearness() >= PROJECTED_STAGES;
        let outcome = match &mut slopes {
            Some(slopes) if regular => {
                let finite = slopes.write(&mut self.dynamics.evaluator, beside, derivatives);
                // Without contacts.
                if finite { Ok(()) } else { Err(self.infinite_power(beside.t, &[])) }
            }
            _ => beside.one_by_one(storage, derivatives, |t, y, slope| self.derivative(t, y, slope)),
        };
        self.slopes = slopes;
        self.dynamics.resume(aside);
        self.dynamics.evaluations += beside.others.len() as u64 + 1;
        outcome
    }

    fn classical_step(
        &mut self,
        step: &StepOf<'_>,
        end: &mut [f64],
        last_slope: Option<&mut [f64]>,
    ) -> Stepped {
        if !self.dynamics.classical_step(step, self.looseness) {
            return Stepped::OneByOne;
        }
        let Some(answer) = self.dynamics.evaluator.last_step() else { return Stepped::OneByOne };
        if let Some(slope) = last_slope {
            replace(slope, answer.last_slope());
        }
        end.copy_from_slice(answer.next());
        let error = self.dynamics.evaluator.loop_error_of(answer.residuals());
        let is_closed = answer.is_untouched() && error.part(self.arm) <= CLOSED;
        if is_closed && self.dynamics.is_regular(answer.nearness_at_end()) {
            self.projector.take_over(error);
            self.dynamics.evaluator.go_to_end(step.times[1]);
            return Stepped::Whole;
        }
        end[..self.coordinates].copy_from_slice(answer.raw());
        Stepped::Raw
    }

    fn project(&mut self, t: f64, before: &[f64], y: &mut [f64]) -> Result<(), RunError> {
        self.stage.copy_from_slice(y);
        let near_singular = self.dynamics.nearness() < PROJECTED_STAGES;
        let looseness = if near_singular { 1.0 } else { self.looseness };
        let correction = self.put_within(t, y, looseness)?;
        if correction.position.max(correction.speed) > JUMP_FLOOR {
            self.check_correction(t, before, &correction)?;
        }
        if near_singular && correction.moved() { self.keep_momentum(t, y) } else { Ok(()) }
    }

    fn is_rough(&self) -> bool {
        self.dynamics.nearness() < PROJECTED_STAGES
    }

    fn shuns_end(&self) -> bool {
        self.regularity_reached >= SHUNNED_END && self.dynamics.nearness() < SHUNNED_END
    }

    /// What the accelerations differ by at a state that differs in the last place.
    fn noise(&mut self, t: f64, y: &[f64], derivative: &[f64]) -> f64 {
        let mut beside = std::mem::take(&mut self.beside);
        let (other, slope) = beside.split_at_mut(y.len());
        other.copy_from_slice(y);
        for (place, value) in other[..self.first_integral()].iter_mut().enumerate() {
            let ulp = f64::EPSILON * value.abs().max(1.0);
            *value += if place % 2 == 0 { ulp } else { -ulp };
        }
        let seen = self.derivative(t, other, slope).is_ok();
        let speeds = self.coordinates..self.coordinates + self.speeds;
        let ends = slope[speeds.clone()].iter().zip(&derivative[speeds.clone()]);
        let differs = ends.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        self.beside = beside;
        if seen { (SAMPLED * differs).max(self.dynamics.noise(&y[speeds])) } else { 0.0 }
    }

    fn reached(&mut self, t: f64, y: &[f64], derivative: &[f64]) {
        let accelerations = &derivative[self.coordinates..][..self.speeds];
        let (q, v, _) = self.split(y);
        if self.modal.note((q, v), accelerations) {
            self.modal.write(self.scales.split_at_mut(self.coordinates));
        }
        self.regularity_reached = self.dynamics.nearness();
        self.dynamics.note_reference(t, &derivative[self.coordinates..][..self.speeds]);
    }

    fn scale(&self, index: usize) -> f64 {
        let Some(integral) = index.checked_sub(self.first_integral()) else { return self.scales[index] };
        match integral.checked_sub(WORKS).map(|integral| integral % TOTALS) {
            Some(total) if !is_energy(total) => f64::INFINITY,
            _ => self.energy_scale,
        }
    }

    fn deciding(&self, _: usize) -> usize {
        self.first_integral()
    }

    fn fastest(&self) -> f64 {
        self.modal.fastest()
    }

    fn pass_over(&self, reach: f64, error: &mut [f64]) {
        self.modal.pass_over(reach, error.split_at_mut(self.coordinates));
    }

    fn follows(&self, index: usize) -> Option<usize> {
        let mut groups = self.dynamics.evaluator.layout().free();
        let group =
            groups.find(|group| group.coordinate == index && matches!(group.motion, Motion::Scalar { .. }));
        group.map(|group| self.coordinates + group.speed)
    }

    fn name(&self, index: usize) -> String {
        let description = self.dynamics.evaluator.description();
        match index.checked_sub(self.coordinates) {
            None => description.coordinates[index].name.to_string(),
            Some(index) if index < self.speeds => format!("speed {}", description.speeds[index].name),
            Some(index) if index == self.speeds => "work supplied".to_owned(),
            Some(index) if index == self.speeds + 1 => "work dissipated".to_owned(),
            Some(index) => {
                let joint = &description.contacts[(index - self.speeds - 2) / TOTALS].joint;
                format!("contact integrals of {joint}")
            }
        }
    }
}
