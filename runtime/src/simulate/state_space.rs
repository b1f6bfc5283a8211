//! The mechanism as ordinary differential equations x' = f(t, x), for integrators of others: x are free coordinates and speeds.
//! In: times, states. Out: derivatives, columns, event indicators; states back on the constraints. Never takes a step.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use super::schedule::Schedule;
use super::simulation::SimulationState;
use super::{changed_laws, settings::Settings, surface};
use crate::assemble::{State, assemble_static_contact};
use crate::clearance_joint::ContactState;
use crate::description::{Channel, Description};
use crate::dynamics::Dynamics;
use crate::error::{RunError, SetupError};
use crate::evaluate::{Evaluator, put_back};
use crate::integrate::Problem;
use crate::linear::largest;
use crate::system::System;

/// Loops may stay open by this much [m, rad] before a state is put back onto them: less than what is left of the assembly
/// where nobody integrates more finely.
const OPEN: f64 = 1e-9;
/// A gap below this [m] that is closing has closed: event times are found up to their tolerance.
const JUST_CLOSED: f64 = 1e-9;

/// A mechanism at a time and a state that somebody else chooses.
pub struct StateSpace<'a> {
    motion: ConstrainedMotion<'a>,
    sampler: Sampler<'a>,
    t: f64,
    /// Coordinates, speeds, then integrals that nobody asks for.
    state: Vec<f64>,
    slope: Vec<f64>,
    /// Contacts at the end of the last completed step.
    contacts: Vec<ContactState>,
    sampled: bool,
}

impl<'a> StateSpace<'a> {
    /// At a consistent start at time `begin` [s]; journals with clearance touch there. Of the settings the singular pivot
    /// counts alone.
    ///
    /// # Errors
    /// As [`super::simulate`].
    pub fn start_at(
        begin: f64,
        system: &'a dyn System<f64>,
        description: &'a Description,
        parameters: &[f64],
        settings: &Settings,
    ) -> Result<Self, RunError> {
        let mut evaluator = Evaluator::new(system, description, parameters)?;
        if evaluator.has_samplers() {
            return Err(SetupError::Sampled.into());
        }
        let start = assemble_static_contact(&mut evaluator, begin)?;
        let mut motion = ConstrainedMotion::new(Dynamics::new(evaluator, settings.singular_pivot));
        motion.learn_sizes(begin, &start);
        let state = motion.join(&start);
        let schedule = Schedule { begin, start: begin, end: begin + 1.0, samples: 0 };
        let mut sampler = Sampler::new(&mut motion, schedule, &state);
        sampler.watch_angles();
        sampler.see_start(&mut motion, &state, true)?;
        let contacts = motion.dynamics.evaluator.clearances().contacts().to_vec();
        let slope = vec![0.0; state.len()];
        Ok(Self { motion, sampler, t: begin, state, slope, contacts, sampled: true })
    }

    /// Number of states: free coordinates and speeds.
    pub fn count(&self) -> usize {
        self.motion.first_integral()
    }

    /// Present time [s].
    pub const fn t(&self) -> f64 {
        self.t
    }

    /// Free coordinates, then free speeds.
    pub fn states(&self) -> &[f64] {
        &self.state[..self.count()]
    }

    /// Natural sizes of the states.
    pub fn sizes(&self) -> &[f64] {
        self.motion.state_scales()
    }

    /// Goes to another time [s].
    pub fn set_time(&mut self, t: f64) {
        (self.t, self.sampled) = (t, false);
    }

    /// Goes to another state, as many numbers as [`Self::count`].
    ///
    /// # Errors
    /// If they are not so many.
    pub fn set_states(&mut self, states: &[f64]) -> Result<(), SetupError> {
        let (expected, found) = (self.count(), states.len());
        if expected != found {
            return Err(SetupError::Length { what: "states", expected, found });
        }
        self.state[..expected].copy_from_slice(states);
        self.sampled = false;
        Ok(())
    }

    /// Derivatives of the states at the present time and state.
    ///
    /// # Errors
    /// If they have no value there.
    pub fn derivatives(&mut self) -> Result<&[f64], RunError> {
        self.motion.derivative(self.t, &self.state, &mut self.slope)?;
        Ok(&self.slope[..self.motion.first_integral()])
    }

    /// Names and units of [`Self::values`].
    pub fn channels(&self) -> &[Channel] {
        self.sampler.channels()
    }

    /// Columns at the present time and state, put onto the constraints for it.
    ///
    /// # Errors
    /// If one has no value there, or the loops cannot be closed.
    pub fn values(&mut self) -> Result<&[f64], RunError> {
        if !self.sampled {
            self.sampler.sample(&mut self.motion, self.t, &mut self.state.clone())?;
            self.sampled = true;
        }
        Ok(self.sampler.values())
    }

    /// Penetration of every contact [m]: where one passes zero, laws change.
    pub fn penetrations(&mut self) -> impl Iterator<Item = f64> + '_ {
        let (q, v, _) = self.motion.split(&self.state);
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.evaluate_contacts(self.t, q, v);
        evaluator.clearances().contacts().iter().map(ContactState::penetration)
    }

    /// A step ends at the present state: contacts remember, angles are followed. Whether loops have opened so far that
    /// [`Self::put_on`] should come next.
    ///
    /// # Errors
    /// If turns cannot be told, the step was that long.
    pub fn complete_step(&mut self) -> Result<bool, RunError> {
        self.sampler.follow_angles(&mut self.motion, self.t, &self.state, None)?;
        let (q, v, _) = self.motion.split(&self.state);
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.evaluate_contacts(self.t, q, v);
        evaluator.clearances_mut().remember(&self.contacts);
        self.contacts.copy_from_slice(evaluator.clearances().contacts());
        if evaluator.sizes().rows == 0 {
            return Ok(self.quaternions_off(q) > OPEN);
        }
        let speeds_off = largest(evaluator.closure(self.t, q, v).speeds);
        let open = evaluator.loop_error();
        let off = open.metres.max(open.radians).max(speeds_off).max(self.quaternions_off(q));
        Ok(off > OPEN)
    }

    /// How far the longest or shortest quaternion is from unit length.
    fn quaternions_off(&self, q: &[f64]) -> f64 {
        let description = self.motion.dynamics.evaluator.description();
        let length = |first: &usize| q[*first..first + 4].iter().map(|x| x * x).sum::<f64>();
        description.quaternions.iter().fold(0.0, |most, first| most.max((length(first) - 1.0).abs()))
    }

    /// Contacts that are just closing close: an event is where it was looked for.
    pub fn close_contacts(&mut self) {
        let (q, v, _) = self.motion.split(&self.state);
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.evaluate_contacts(self.t, q, v);
        let clearances = evaluator.clearances_mut();
        for joint in 0..self.contacts.len() {
            let touch = clearances.contacts()[joint];
            let apart = clearances.states()[joint].memory.touching <= 0.5;
            if apart && touch.gap < JUST_CLOSED && touch.penetration_rate > 0.0 {
                clearances.close(joint);
            }
        }
        self.sampled = false;
    }

    /// Puts the state onto the constraints. Whether it moved.
    ///
    /// # Errors
    /// If the loops cannot be closed.
    pub fn put_on(&mut self) -> Result<bool, RunError> {
        let moved = self.motion.put_sample_on(self.t, &mut self.state)?.moved();
        self.sampled = false;
        Ok(moved)
    }

    /// Values of the parameters.
    pub fn parameters(&self) -> &[f64] {
        self.motion.dynamics.evaluator.parameters()
    }

    /// Other values of the parameters: see [`super::Simulation::set_parameters`]. States may have moved.
    ///
    /// # Errors
    /// As there; nothing has changed then.
    pub fn set_parameters(&mut self, parameters: &[f64]) -> Result<(), SetupError> {
        let kept = self.parameters().to_vec();
        if kept == parameters {
            return Ok(());
        }
        let (q, v, _) = self.motion.split(&self.state);
        let mut now = State { q: q.to_vec(), v: v.to_vec() };
        let (t, arm) = (self.t, self.motion.arm);
        let evaluator = &mut self.motion.dynamics.evaluator;
        let before = changed_laws::change(
            evaluator,
            (t, &now),
            arm,
            |evaluator| evaluator.set_parameters(parameters),
            |evaluator| {
                let _ = evaluator.set_parameters(&kept);
            },
        )?;
        surface::follow(evaluator, t, &mut now, &before);
        evaluator.evaluate_contacts(t, &now.q, &now.v);
        self.contacts.copy_from_slice(evaluator.clearances().contacts());
        self.state[..now.q.len()].copy_from_slice(&now.q);
        self.state[now.q.len()..][..now.v.len()].copy_from_slice(&now.v);
        self.sampled = false;
        Ok(())
    }

    /// Other values of the inputs, as an integrator asks for at every time and state: nothing moves. Where a drive follows one, loops
    /// stay closed as far as values, rates and states belong together.
    ///
    /// # Errors
    /// If values are no numbers; nothing has changed then.
    pub fn set_inputs(&mut self, parameters: &[f64]) -> Result<(), SetupError> {
        let evaluator = &mut self.motion.dynamics.evaluator;
        let inputs = evaluator.inputs_among(parameters)?.len();
        let mut all = evaluator.parameters().to_vec();
        let first = all.len() - inputs;
        all[first..].copy_from_slice(&parameters[first..]);
        evaluator.set_parameters(&all)?;
        self.sampled = false;
        Ok(())
    }

    /// Everything that has to be kept to go on from here.
    pub fn state(&mut self) -> SimulationState {
        let mut memory = self.state.clone();
        self.motion.visit_sizes_and_memory(&mut |number| memory.push(*number));
        SimulationState {
            t: self.t,
            parameters: self.parameters().to_vec(),
            joints: self.motion.dynamics.evaluator.clearances().states().to_vec(),
            angles: self.sampler.angles.known(),
            memory,
        }
    }

    /// Goes to a kept state.
    ///
    /// # Errors
    /// If it does not belong to this mechanism; nothing has changed then.
    pub fn restore(&mut self, kept: &SimulationState) -> Result<(), SetupError> {
        let mut length = self.state.len();
        self.motion.visit_sizes_and_memory(&mut |_| length += 1);
        kept.fits(length, self.contacts.len(), self.sampler.angles.count())?;
        self.motion.dynamics.evaluator.set_parameters(&kept.parameters)?;
        self.t = kept.t;
        let (state, memory) = kept.memory.split_at(self.state.len());
        self.state.copy_from_slice(state);
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.clearances_mut().states_mut().clone_from_slice(&kept.joints);
        let (q, v, _) = self.motion.split(&self.state);
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.evaluate_contacts(self.t, q, v);
        self.contacts.copy_from_slice(evaluator.clearances().contacts());
        self.sampler.angles.put_back(&kept.angles);
        self.motion.visit_sizes_and_memory(&mut put_back(memory));
        self.sampled = false;
        Ok(())
    }

    /// What every contact remembers: whether it touches, and how fast it closed [m/s].
    pub fn contact_memories(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let states = self.motion.dynamics.evaluator.clearances().states();
        states.iter().map(|state| (state.memory.touching, state.memory.closing_speed))
    }
}
