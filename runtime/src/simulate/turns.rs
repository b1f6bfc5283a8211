//! Runs one mechanism turn by turn, for a life in which wear changes the clearances in between.
//! In: a mechanism, a method, clearances. Out: [`ContactMeasure`]s. Never knows how wear follows from them.

mod journals;
mod laws;

pub(crate) use journals::Place;

use std::f64::consts::PI;

use super::motion::ConstrainedMotion;
use super::run::Statistics;
use super::sampler::Sampler;
use super::samples;
use super::schedule::Schedule;
use super::settings::{Integrator, Settings, Span};
use super::steps;
use super::surface;
use super::warning::RunWarning;
use super::warning::step_limits;
use crate::assemble::{State, assemble_under_way, check_clearances};
use crate::clearance_joint::{Clearance, ClearanceState};
use crate::description::Description;
use crate::dynamics::Dynamics;
use crate::error::{RunError, SetupError};
use crate::evaluate::{Evaluator, put_back};
use crate::linear::largest;
use crate::system::System;
use crate::watch::Watch;
use crate::wear::{ContactMeasure, Profile};

/// Turns that differ by no more of themselves last equally long: their ends are found to rounding.
const EVEN: f64 = 1e-9;

/// Parts of a turn at which laws that repeat themselves are compared: no harmonic has the same value at all of them.
const PHASES: [f64; 4] = [0.0, 0.13, 0.37, 0.71];

/// Turns are looked at again for forces that jump with an angle when a clearance has grown by this factor. An angle moves by
/// the growth over a lever arm, thousands of times less than what it misses half a turn by in any but a chance design.
const GROWN: f64 = 1.25;

/// All that has to be kept to go on with a trajectory.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TurnState {
    /// Time [s].
    pub t: f64,
    /// Free coordinates.
    pub q: Vec<f64>,
    /// Free speeds.
    pub v: Vec<f64>,
    /// What contacts remember and how far joints are worn.
    pub joints: Vec<ClearanceState>,
    /// What solvers remember: longest rows, largest pivots, the last regular accelerations. Without it (empty) the
    /// motion goes on, but not with the same bits.
    #[cfg_attr(feature = "serde", serde(default))]
    pub memory: Vec<f64>,
}

/// What one measured turn gave.
#[derive(Clone, Debug, PartialEq)]
pub struct TurnMeasures {
    /// One per joint with clearance.
    pub joints: Vec<ContactMeasure>,
    /// What is doubtful about the turn.
    pub warnings: Vec<RunWarning>,
    /// Cost and quality of the turn.
    pub statistics: Statistics,
}

impl TurnMeasures {
    /// Those of several turns as one: means of what joints did, all that was doubtful, what they cost together.
    pub(crate) fn mean(turns: Vec<Self>) -> Self {
        let count = turns.iter().map(|turn| turn.joints.len()).min().unwrap_or(0);
        let joint =
            |at: usize| ContactMeasure::mean(&turns.iter().map(|turn| &turn.joints[at]).collect::<Vec<_>>());
        Self {
            joints: (0..count).map(joint).collect(),
            statistics: turns.iter().fold(Statistics::default(), |sum, turn| sum.and(&turn.statistics)),
            warnings: turns.into_iter().flat_map(|turn| turn.warnings).collect(),
        }
    }
}

/// Runs a mechanism turn by turn.
pub struct TurnRunner<'a> {
    pub(super) motion: ConstrainedMotion<'a>,
    pub(super) integrator: Integrator,
    t: f64,
    state: State,
    /// Whether turns differ by their clearances alone, once that was asked.
    alike: Option<bool>,
    /// Clearances [m] of the last turn that was looked at for forces that jump with an angle.
    looked_at: Vec<f64>,
}

impl<'a> TurnRunner<'a> {
    /// Starts at t = 0 as [`super::simulate`] does.
    ///
    /// # Errors
    /// If parameters or the method make no sense, or nothing turns, or there is no consistent start.
    pub fn new(
        system: &'a dyn System<f64>,
        description: &'a Description,
        parameters: &[f64],
        integrator: Integrator,
        singular_pivot: f64,
    ) -> Result<Self, RunError> {
        let settings = Settings { singular_pivot, ..Settings::new(integrator, Span::Turns(1.0), 0) };
        settings.check()?;
        if description.turn_driver.is_none() {
            return Err(RunError::NoTurns);
        }
        let mut evaluator = Evaluator::new(system, description, parameters)?;
        let mut state = assemble_under_way(&mut evaluator, 0.0)?;
        let mut motion = ConstrainedMotion::new(Dynamics::new(evaluator, singular_pivot));
        motion.learn_sizes(0.0, &state);
        let mut flat = motion.join(&state);
        samples::begin(&mut motion, 0.0, &mut flat)?;
        state.v.copy_from_slice(motion.split(&flat).1);
        Ok(Self { motion, integrator, t: 0.0, state, alike: None, looked_at: Vec::new() })
    }

    /// Everything that has to be kept to go on from here.
    pub fn state(&mut self) -> TurnState {
        let mut memory = Vec::new();
        self.motion.visit_memory(&mut |number| memory.push(*number));
        TurnState {
            memory,
            t: self.t,
            q: self.state.q.clone(),
            v: self.state.v.clone(),
            joints: self.motion.dynamics.evaluator.clearances().states().to_vec(),
        }
    }

    /// Goes on from a kept state.
    ///
    /// # Errors
    /// If it does not belong to this mechanism.
    pub fn restore(&mut self, kept: &TurnState) -> Result<(), SetupError> {
        let sizes = self.motion.dynamics.evaluator.sizes();
        let same = |what, expected, found| {
            if expected == found { Ok(()) } else { Err(SetupError::Length { what, expected, found }) }
        };
        same("coordinates", sizes.coordinates, kept.q.len())?;
        same("speeds", sizes.speeds, kept.v.len())?;
        same("joints with clearance", sizes.contacts, kept.joints.len())?;
        let joints = self.motion.dynamics.evaluator.clearances_mut().states_mut();
        joints.clone_from_slice(&kept.joints);
        self.motion.visit_memory(&mut put_back(&kept.memory));
        (self.t, self.state) = (kept.t, State { q: kept.q.clone(), v: kept.v.clone() });
        self.motion.learn_sizes(self.t, &self.state);
        Ok(())
    }

    /// Parameters that it runs with, in SI.
    pub(crate) fn parameters(&self) -> &[f64] {
        self.motion.dynamics.evaluator.parameters()
    }

    /// Present radial clearances with their mean wear [m], joint by joint.
    pub fn clearances(&mut self) -> Vec<f64> {
        let evaluator = &mut self.motion.dynamics.evaluator;
        evaluator.evaluate_contacts(self.t, &self.state.q, &self.state.v);
        evaluator.clearances().contacts().iter().map(|touch| touch.clearance).collect()
    }

    /// Sets how far a joint is worn: radial clearance [m] on top of that of the parameters, and a depth by bearing
    /// angle on top of both. A journal in contact keeps its penetration: it follows the surface.
    ///
    /// # Errors
    /// If there is no such joint, or the clearance is none; nothing has changed then.
    pub fn set_worn(&mut self, joint: usize, worn: f64, profile: Option<Profile>) -> Result<(), SetupError> {
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
    ) -> Result<(), SetupError> {
        let evaluator = &mut self.motion.dynamics.evaluator;
        let count = evaluator.sizes().contacts;
        if joint >= count {
            let what = "joints with clearance";
            return Err(SetupError::Length { what, expected: count, found: joint + 1 });
        }
        evaluator.evaluate_contacts(self.t, &self.state.q, &self.state.v);
        let before = evaluator.clearances().contacts().to_vec();
        let kept = evaluator.clearances().states()[joint].clone();
        let now = &mut evaluator.clearances_mut().states_mut()[joint];
        (now.worn, now.profile, now.journal) = (worn, profile, journal);
        if let Err(error) = check_clearances(evaluator, self.t, &self.state) {
            evaluator.clearances_mut().states_mut()[joint] = kept;
            return Err(error);
        }
        // Where loops do not let it, the journal finds its way through the settling turns.
        surface::follow(evaluator, self.t, &mut self.state, &before);
        self.motion.learn_sizes(self.t, &self.state);
        Ok(())
    }

    /// How long a turn lasts [s], if the first three last equally long.
    ///
    /// # Errors
    /// [`RunError::TurnsNotReached`] if there are none.
    pub fn seconds_per_turn(&mut self) -> Result<Option<f64>, RunError> {
        let evaluator = &mut self.motion.dynamics.evaluator;
        let mut turn = |from: f64| Schedule::turn(evaluator, from).map(|turn| turn.end);
        let first = turn(0.0)?;
        let second = turn(first)?;
        let third = turn(second)?;
        let is_even = |length: f64| (length - first).abs() <= EVEN * first;
        Ok((is_even(second - first) && is_even(third - second)).then_some(first))
    }

    /// Runs turns one after the other.
    ///
    /// # Errors
    /// As [`Self::measure`].
    pub fn turns(&mut self, turns: u32, watch: Watch<'_>) -> Result<Vec<TurnMeasures>, RunError> {
        watch.pieces(turns).map(|watch| self.measure(watch)).collect()
    }

    /// Whether a turn with these clearances [m] may differ from the last one that was looked at by more than angles notice.
    fn may_differ(&mut self, clearances: &[f64]) -> bool {
        let alike = match self.alike {
            Some(known) => known,
            None => self.turns_are_alike(),
        };
        self.alike = Some(alike);
        let grown = |(now, then): (&f64, &f64)| *now > GROWN * then;
        !alike || self.looked_at.is_empty() || clearances.iter().zip(&self.looked_at).any(grown)
    }

    /// Whether every turn is as the one before but for clearances: drivers leave no freedom open but play, and repeat
    /// themselves with the turn.
    fn turns_are_alike(&mut self) -> bool {
        let Ok(Some(turn)) = self.seconds_per_turn() else { return false };
        let evaluator = &mut self.motion.dynamics.evaluator;
        let play: usize = evaluator.clearances().joints().iter().map(Clearance::freedoms).sum();
        let sizes = evaluator.sizes();
        if sizes.speeds - sizes.rows > play {
            return false;
        }
        PHASES.iter().all(|phase| {
            let laws = |evaluator: &mut Evaluator<'_>, t: f64| evaluator.prescribed(t).to_vec();
            let (now, later) = (laws(evaluator, phase * turn), laws(evaluator, (phase + 1.0) * turn));
            let laws = now.chunks_exact(3).zip(later.chunks_exact(3));
            laws.zip(&*evaluator.description().drivers).all(|((now, later), driver)| {
                let turns = if driver.angular { ((later[0] - now[0]) / (2.0 * PI)).round() } else { 0.0 };
                let size = largest(now).max(1.0);
                (later[0] - 2.0 * PI * turns - now[0]).abs() <= EVEN * size
                    && now[1..].iter().zip(&later[1..]).all(|(a, b)| (a - b).abs() <= EVEN * size)
            })
        })
    }

    /// Runs one turn and says what it did; `watch` hears the finished part of this turn.
    ///
    /// # Errors
    /// Why the turn could not be finished, or [`RunError::Interrupted`]; the runner is then where it was before
    /// the turn.
    pub fn measure(&mut self, watch: Watch<'_>) -> Result<TurnMeasures, RunError> {
        let looks = self.looks();
        let mut turn = self.begin(looks)?;
        let Turn { sampler, state, .. } = &mut turn;
        if let Err(error) = steps::run(&mut self.motion, sampler, state, self.integrator, watch) {
            self.restore(&turn.kept)?;
            return Err(error);
        }
        Ok(self.end(turn))
    }

    /// The clearances [m], if the next turn has to be looked at for forces that jump with an angle.
    pub(crate) fn looks(&mut self) -> Option<Vec<f64>> {
        let clearances = self.clearances();
        self.may_differ(&clearances).then_some(clearances)
    }

    /// Goes on after a turn that was run elsewhere; `looked_at` as [`Self::looks`] has it.
    pub(crate) fn go_on(&mut self, state: &TurnState, looked_at: Option<Vec<f64>>) -> Result<(), SetupError> {
        if let Some(clearances) = looked_at {
            self.looked_at = clearances;
        }
        self.restore(state)
    }

    /// Begins a turn, of which nothing is done yet.
    pub(super) fn begin(&mut self, looks: Option<Vec<f64>>) -> Result<Turn<'a>, RunError> {
        let schedule = Schedule::turn(&mut self.motion.dynamics.evaluator, self.t)?;
        // A turn depends on where it begins alone, whatever went before.
        self.motion.learn_sizes(self.t, &self.state);
        let kept = self.state();
        let costs = (self.motion.dynamics.evaluations, self.motion.projections);
        let state = self.motion.join(&self.state);
        let mut sampler = Sampler::new(&mut self.motion, schedule, &state);
        if looks.is_some() {
            sampler.watch_angles();
        }
        Ok(Turn { sampler, state, kept, looks, costs })
    }

    /// A turn is done: what it did.
    pub(super) fn end(&mut self, turn: Turn<'a>) -> TurnMeasures {
        let Turn { sampler, state, looks, costs: (evaluations, projections), .. } = turn;
        if let Some(clearances) = looks {
            self.looked_at = clearances;
        }
        let (q, v, _) = self.motion.split(&state);
        self.state = State { q: q.to_vec(), v: v.to_vec() };
        self.t = sampler.schedule.end;
        let mut run = sampler.finish(&self.motion, step_limits(self.integrator), None);
        let mut statistics = run.statistics;
        statistics.evaluations -= evaluations;
        statistics.projections -= projections;
        TurnMeasures { joints: run.turns.pop().unwrap_or_default(), warnings: run.warnings, statistics }
    }
}

/// A turn under way.
pub(super) struct Turn<'a> {
    pub(super) sampler: Sampler<'a>,
    /// The flat state it has got to.
    pub(super) state: Vec<f64>,
    /// Where it began.
    pub(super) kept: TurnState,
    /// Clearances [m], if it is looked at for forces that jump with an angle.
    looks: Option<Vec<f64>>,
    /// Evaluations and projections before it.
    costs: (u64, u64),
}
