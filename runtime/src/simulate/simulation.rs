//! A run that is advanced from outside, as far as somebody asks: for programs that follow a machine, or are coupled to others.
//! In: a mechanism, settings; then times, other parameters, readings of wear. Out: columns at the present time, events, states
//! that can be kept and put back.

use super::changed_laws;
use super::contact_event::ContactEvent;
use super::motion::ConstrainedMotion;
use super::run::Run;
use super::sampler::Sampler;
use super::samples;
use super::schedule::Schedule;
use super::settings::{Integrator, Settings};
use super::steps::Steps;
use super::surface;
use super::warning::step_limits;
use crate::assemble::{State, assemble_static_contact};
use crate::clearance_joint::{ClearanceState, ContactState};
use crate::description::{Channel, Description};
use crate::dynamics::Dynamics;
use crate::error::{RunError, SetupError};
use crate::evaluate::{Evaluator, put_back};
use crate::guide::Guide;
use crate::integrate::Problem;
use crate::system::System;
use crate::watch::Watch;
use crate::wear::Profile;

/// Angles on their turns: times, each with the angle and the rate of every column that wraps.
pub type KnownAngles = Vec<(f64, Vec<(f64, f64)>)>;

/// All that has to be kept to go on with a simulation, in the same bits (with generalised-alpha up to its error).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SimulationState {
    /// Present time [s].
    pub t: f64,
    /// Values of the parameters.
    pub parameters: Vec<f64>,
    /// What contacts remember and how far joints are worn.
    pub joints: Vec<ClearanceState>,
    /// Turns of angles that columns recompute.
    pub angles: KnownAngles,
    /// The state, and what solvers and methods remember.
    pub memory: Vec<f64>,
}

impl SimulationState {
    /// Refuses a state of other lengths: of its memory, of the joints with clearance, of the angles.
    pub(super) fn fits(&self, memory: usize, joints: usize, angles: usize) -> Result<(), SetupError> {
        let same = |what, expected, found| {
            if expected == found { Ok(()) } else { Err(SetupError::Length { what, expected, found }) }
        };
        same("numbers of a state", memory, self.memory.len())?;
        same("joints with clearance", joints, self.joints.len())?;
        self.angles.iter().try_for_each(|(_, values)| same("angles of a state", angles, values.len()))
    }
}

/// A mechanism on its way through time, advanced as far as somebody asks.
///
/// [`super::simulate`] is a simulation advanced over its samples: both give the same bits.
///
/// ```
/// use linkwear_runtime::{Settings, Simulation, Watch};
///
/// mod fall {
///     // Generated code: `linkwear_runtime::include_mechanism!("fall")`. This one was written by hand.
///     include!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/fall.rs.txt"));
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mechanism = fall::Mechanism::default();
/// let (description, settings) = (fall::description(), Settings::default());
/// let mut run = Simulation::start(&mechanism, description, &mechanism.parameters(), &settings)?;
/// run.advance(0.5, Watch::NONE)?;
/// let kept = run.state();
/// // What the moon would do from here on, then the earth again.
/// run.set_parameters(&[1.62])?;
/// run.advance(1.0, Watch::NONE)?;
/// let high = run.values()[0];
/// run.restore(&kept)?;
/// run.advance(1.0, Watch::NONE)?;
/// assert!((run.values()[0] - (20.0 - 0.5 * 9.81)).abs() < 2e-8 && run.values()[0] < high);
/// # Ok(())
/// # }
/// ```
pub struct Simulation<'a> {
    motion: ConstrainedMotion<'a>,
    sampler: Sampler<'a>,
    steps: Steps,
    integrator: Integrator,
    /// Present time and flat state.
    t: f64,
    state: Vec<f64>,
    /// How far the schedule goes on at its end [s].
    leg: f64,
}

impl<'a> Simulation<'a> {
    /// From a consistent start at t = 0 through the settling; journals with clearance touch there.
    ///
    /// `settings.span` is how far it is meant to go: steps are a tenth of it at most, and end there. It may go on.
    /// `settings.samples` is how many evenly spaced times will be asked for; any others may be.
    ///
    /// # Errors
    /// As [`super::simulate`], and what stops a run while it settles.
    pub fn start(
        system: &'a dyn System<f64>,
        description: &'a Description,
        parameters: &[f64],
        settings: &Settings,
    ) -> Result<Self, RunError> {
        Self::start_at(0.0, system, description, parameters, settings)
    }

    /// The same from another time [s].
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn start_at(
        begin: f64,
        system: &'a dyn System<f64>,
        description: &'a Description,
        parameters: &[f64],
        settings: &Settings,
    ) -> Result<Self, RunError> {
        settings.check()?;
        if !begin.is_finite() {
            return Err(SetupError::Setting { name: "start time", value: begin, need: "finite" }.into());
        }
        let mut evaluator = Evaluator::new(system, description, parameters)?;
        let schedule = Schedule::new(&mut evaluator, settings, begin)?;
        let start = assemble_static_contact(&mut evaluator, begin)?;
        let mut motion = ConstrainedMotion::new(Dynamics::new(evaluator, settings.singular_pivot));
        motion.learn_sizes(begin, &start);
        let mut state = motion.join(&start);
        samples::begin(&mut motion, begin, &mut state)?;
        let mut sampler = Sampler::new(&mut motion, schedule, &state);
        sampler.watch_angles();
        if let Some(follower) = &mut sampler.follower {
            follower.events = Some(Vec::new());
        }
        let sampled = schedule.start == schedule.begin;
        let mut steps = Steps::begin(&mut motion, &mut sampler, &state, settings.integrator, sampled)?;
        if !sampled {
            let wanted = (schedule.start, true);
            steps.advance(&mut motion, &mut sampler, &mut state, wanted, Watch::NONE)?;
        }
        let (t, leg, integrator) = (schedule.start, schedule.end - schedule.start, settings.integrator);
        Ok(Self { motion, sampler, steps, integrator, t, state, leg })
    }

    /// Goes on to a time [s], not before the present one.
    ///
    /// # Errors
    /// Why it cannot go on. The state is then no longer of use; one that was kept before can be put back.
    pub fn advance(&mut self, to: f64, watch: Watch<'_>) -> Result<(), RunError> {
        if !(to.is_finite() && to >= self.t) {
            let need = "finite and not before the present time";
            return Err(SetupError::Setting { name: "time to advance to", value: to, need }.into());
        }
        let Self { motion, sampler, steps, state, .. } = self;
        while to > sampler.schedule.end {
            let end = sampler.schedule.end;
            steps.advance(motion, sampler, state, (end, false), watch)?;
            sampler.extend(motion, (end, state), (end + self.leg).max(to));
        }
        steps.advance(motion, sampler, state, (to, true), watch)?;
        self.t = to;
        Ok(())
    }

    /// Present time [s].
    pub const fn t(&self) -> f64 {
        self.t
    }

    /// Free coordinates at the present time.
    pub fn coordinates(&self) -> &[f64] {
        self.motion.split(&self.state).0
    }

    /// Free speeds at the present time.
    pub fn speeds(&self) -> &[f64] {
        self.motion.split(&self.state).1
    }

    /// Derivatives of coordinates, then of speeds, at the present time.
    ///
    /// # Errors
    /// If they have no value there.
    pub fn derivatives(&mut self) -> Result<Vec<f64>, RunError> {
        let mut slope = vec![0.0; self.state.len()];
        let aside = self.motion.dynamics.aside();
        let found = self.motion.derivative(self.t, &self.state, &mut slope);
        self.motion.dynamics.resume(aside);
        slope.truncate(self.motion.first_integral());
        found.map(|()| slope)
    }

    /// Names and units of [`Self::values`]: columns of the mechanism, then those of its contacts.
    pub fn channels(&self) -> &[Channel] {
        self.sampler.channels()
    }

    /// Columns at the present time, in the order of [`Self::channels`].
    pub fn values(&self) -> &[f64] {
        self.sampler.values()
    }

    /// Values of the parameters.
    pub fn parameters(&self) -> &[f64] {
        self.motion.dynamics.evaluator.parameters()
    }

    /// Contacts that closed or opened since they were asked for last.
    pub fn take_events(&mut self) -> Vec<ContactEvent> {
        let events = self.sampler.follower.as_mut().and_then(|follower| follower.events.as_mut());
        events.map(std::mem::take).unwrap_or_default()
    }

    /// Other values of the parameters from the present time on. Journals that touch follow their bearings; all else stays
    /// where it is and as fast.
    ///
    /// # Errors
    /// If values are no numbers, a clearance is none, or drivers or loops would jump; nothing has changed then. Else what
    /// stops a run.
    pub fn set_parameters(&mut self, parameters: &[f64]) -> Result<(), RunError> {
        let before = self.parameters().to_vec();
        if before == parameters {
            return Ok(());
        }
        self.change(
            |evaluator| evaluator.set_parameters(parameters),
            |evaluator| {
                let _ = evaluator.set_parameters(&before);
            },
        )
    }

    /// Lets the inputs that drives follow go on to a time [s], from where they are: there they are as the values and rates among
    /// `parameters`, those of the present time, lead to with the acceleration told, as fast and as much accelerated. Their values
    /// and first two rates are continuous, so no drive jumps; behind that time the acceleration stays. Other parameters stay as they are.
    ///
    /// A source that tells its inputs truly is followed up to the third order of the time between two calls.
    ///
    /// # Errors
    /// As [`Self::set_parameters`], or if the time does not lie ahead; nothing has changed then.
    pub fn lead_inputs(&mut self, parameters: &[f64], to: f64) -> Result<(), RunError> {
        let t = self.t;
        if !(to.is_finite() && to > t) {
            let need = "finite and behind the present time";
            return Err(SetupError::Setting { name: "time to lead inputs to", value: to, need }.into());
        }
        let evaluator = &mut self.motion.dynamics.evaluator;
        let wanted = evaluator.inputs_among(parameters)?.to_vec();
        let before = evaluator.guide().clone();
        let mut guide = before.clone();
        guide.lead(t, to - t, evaluator.inputs(t), &wanted);
        let put = |guide: &Guide, evaluator: &mut Evaluator<'a>| evaluator.set_guide(guide);
        self.change(
            |evaluator| {
                put(&guide, evaluator);
                Ok(())
            },
            |evaluator| put(&before, evaluator),
        )
    }

    /// Values of the parameters, with the inputs as they are at the present time.
    pub fn present_parameters(&mut self) -> Vec<f64> {
        let mut parameters = self.parameters().to_vec();
        let inputs = self.motion.dynamics.evaluator.inputs(self.t);
        let first = parameters.len() - inputs.len();
        parameters[first..].copy_from_slice(inputs);
        parameters
    }

    /// Present radial clearances with their mean wear [m], joint by joint.
    pub fn clearances(&mut self) -> Vec<f64> {
        self.contacts().iter().map(|touch| touch.clearance).collect()
    }

    /// Every contact at the present time.
    pub fn contacts(&mut self) -> &[ContactState] {
        let (q, v, _) = self.motion.split(&self.state);
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.evaluate_contacts(self.t, q, v);
        evaluator.clearances().contacts()
    }

    /// Sets how far a joint is worn: radial clearance [m] on top of that of the parameters, and a depth by bearing angle on
    /// top of both. A journal in contact follows the surface.
    ///
    /// # Errors
    /// As [`Self::set_parameters`], or if there is no such joint.
    pub fn set_worn(&mut self, joint: usize, worn: f64, profile: Option<Profile>) -> Result<(), RunError> {
        self.set_worn_pair(joint, worn, [profile, None])
    }

    /// The same of a joint whose journal wears: depths of bush and journal, each by its own angle.
    ///
    /// # Errors
    /// As [`Self::set_worn`].
    pub fn set_worn_pair(
        &mut self,
        joint: usize,
        worn: f64,
        [profile, journal]: [Option<Profile>; 2],
    ) -> Result<(), RunError> {
        let states = self.motion.dynamics.evaluator.clearances().states();
        let Some(kept) = states.get(joint).cloned() else {
            let what = "joints with clearance";
            return Err(SetupError::Length { what, expected: states.len(), found: joint + 1 }.into());
        };
        self.change(
            |evaluator| {
                let state = &mut evaluator.clearances_mut().states_mut()[joint];
                (state.worn, state.profile, state.journal) = (worn, profile.clone(), journal.clone());
                Ok(())
            },
            |evaluator| evaluator.clearances_mut().states_mut()[joint] = kept.clone(),
        )
    }

    /// Changes laws at the present time; `undo` takes that back where the mechanism does not bear it.
    fn change(
        &mut self,
        change: impl Fn(&mut Evaluator<'a>) -> Result<(), SetupError>,
        undo: impl Fn(&mut Evaluator<'a>),
    ) -> Result<(), RunError> {
        let Self { motion, sampler, steps, t, state, .. } = self;
        let (q, v, _) = motion.split(state);
        let mut now = State { q: q.to_vec(), v: v.to_vec() };
        let (evaluator, arm) = (&mut motion.dynamics.evaluator, motion.arm);
        let before = changed_laws::change(evaluator, (*t, &now), arm, &change, &undo)?;
        // The step that ends here is judged by the laws that it went by: its energy is not what it would be by others.
        undo(evaluator);
        steps.cut(motion, sampler, *t, state)?;
        change(&mut motion.dynamics.evaluator)?;
        motion.dynamics.evaluator.evaluate_contacts(*t, &now.q, &now.v);
        surface::follow(&mut motion.dynamics.evaluator, *t, &mut now, &before);
        state[..now.q.len()].copy_from_slice(&now.q);
        state[now.q.len()..][..now.v.len()].copy_from_slice(&now.v);
        steps.go_on_from(motion, *t, state)?;
        sampler.watch_from(motion, (*t, state));
        if let Some(follower) = &mut sampler.follower {
            follower.look_again(motion, *t, state);
        }
        sampler.sample(motion, *t, &mut state.clone())
    }

    /// Everything that has to be kept to go on from here.
    pub fn state(&mut self) -> SimulationState {
        let mut memory = Vec::new();
        self.visit_memory(&mut |number| memory.push(*number));
        self.motion.visit_sizes_and_memory(&mut |number| memory.push(*number));
        SimulationState {
            t: self.t,
            parameters: self.parameters().to_vec(),
            joints: self.motion.dynamics.evaluator.clearances().states().to_vec(),
            angles: self.sampler.angles.known(),
            memory,
        }
    }

    /// Goes on from a kept state, whatever happened since.
    ///
    /// # Errors
    /// If it does not belong to this mechanism and method; nothing has changed then.
    pub fn restore(&mut self, kept: &SimulationState) -> Result<(), SetupError> {
        let (mut own, mut motion) = (0, 0);
        self.visit_memory(&mut |_| own += 1);
        self.motion.visit_sizes_and_memory(&mut |_| motion += 1);
        let joints = self.motion.dynamics.evaluator.clearances().states().len();
        kept.fits(own + motion, joints, self.sampler.angles.count())?;
        self.motion.dynamics.evaluator.set_parameters(&kept.parameters)?;
        self.t = kept.t;
        let (own_memory, motion_memory) = kept.memory.split_at(own);
        self.visit_memory(&mut put_back(own_memory));
        self.motion.dynamics.evaluator.clearances_mut().states_mut().clone_from_slice(&kept.joints);
        self.sampler.angles.put_back(&kept.angles);
        self.motion.visit_sizes_and_memory(&mut put_back(motion_memory));
        self.sampler.resume(&mut self.motion);
        // Once more: looking at the state has changed what solvers remember.
        self.motion.visit_sizes_and_memory(&mut put_back(motion_memory));
        Ok(())
    }

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.motion.dynamics.evaluator.visit_guide(visit);
        self.state.iter_mut().for_each(&mut *visit);
        self.steps.visit_memory(self.t, visit);
        self.sampler.visit_memory(visit);
    }

    /// Cost, quality and measured turns of all that was simulated; there are no rows.
    pub fn finish(self) -> Run {
        self.sampler.finish(&self.motion, step_limits(self.integrator), None)
    }
}
