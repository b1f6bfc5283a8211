//! One instance of a unit: modes, times, values. In: what a tool asks, in safe terms. Out: answers, or a [`Fault`] with its
//! reason. Never knows pointers.

use linkwear_runtime::channels;
use linkwear_runtime::{
    Integrator, RunError, SINGULAR_PIVOT, Settings, Simulation, SimulationState, Span, StateSpace, Watch,
};
use linkwear_tape::stored::{Damage, sealed, unsealed};

use crate::loaded::Loaded;
use crate::sensitivity::Sensitivity;
use crate::variables::{Variable, Variables};

/// How far a run goes at a time if nobody says when it stops [s].
const OPEN_END: f64 = 1.0;
/// Part of the time by which a step may begin beside the present one: sums of step lengths are rounded.
const SAME_TIME: f64 = 1e-9;

/// What a tool wants to do with a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// The tool integrates.
    ModelExchange,
    /// The unit integrates; with event mode if the tool says so.
    CoSimulation {
        /// Whether the tool enters event mode.
        events: bool,
    },
}

/// Where an instance is in its life, as the standard has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Instantiated,
    Initialization,
    Event,
    ContinuousTime,
    Step,
    Terminated,
}

linkwear_tape::stored!(enum Mode {
    0: Instantiated, 1: Initialization, 2: Event, 3: ContinuousTime, 4: Step, 5: Terminated,
});

/// Why a call has no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(pub String);

impl From<RunError> for Fault {
    fn from(error: RunError) -> Self {
        Self(error.to_string())
    }
}

impl From<linkwear_runtime::SetupError> for Fault {
    fn from(error: linkwear_runtime::SetupError) -> Self {
        Self(error.to_string())
    }
}

fn fault<T>(reason: impl Into<String>) -> Result<T, Fault> {
    Err(Fault(reason.into()))
}

/// When and how finely an experiment runs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Begin [s].
    pub start: f64,
    /// End [s], if there is one.
    pub stop: Option<f64>,
    /// Accuracy wanted.
    pub tolerance: Option<f64>,
}

linkwear_tape::stored!(struct Times { start, stop, tolerance });

/// The mechanism on its way, by either interface.
enum Motion {
    Steps(Box<Simulation<'static>>),
    Space(Box<StateSpace<'static>>),
}

/// All of an instance at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    mode: Mode,
    times: Times,
    parameters: Vec<f64>,
    motion: Option<SimulationState>,
}

linkwear_tape::stored!(struct Kept { mode, times, parameters, motion });

impl Kept {
    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        sealed(self)
    }

    /// From its bytes.
    ///
    /// # Errors
    /// If they are damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Damage> {
        unsealed(bytes)
    }
}

/// An instance of a unit.
pub struct Instance {
    loaded: &'static Loaded,
    interface: Interface,
    mode: Mode,
    times: Times,
    variables: Variables,
    /// Values that are wanted; those of the motion follow before it is asked.
    parameters: Vec<f64>,
    motion: Option<Motion>,
    sensitivity: Option<Sensitivity>,
}

impl Instance {
    /// A new one.
    pub fn new(loaded: &'static Loaded, interface: Interface) -> Self {
        let channels = channels(loaded.unit.program.description());
        Self {
            loaded,
            interface,
            mode: Mode::Instantiated,
            times: Times::default(),
            variables: Variables::new(&loaded.unit, &channels),
            parameters: defaults(loaded),
            motion: None,
            sensitivity: None,
        }
    }

    /// Its unit.
    pub fn loaded(&self) -> &'static Loaded {
        self.loaded
    }

    fn is(&self, allowed: &[Mode], call: &str) -> Result<(), Fault> {
        if allowed.contains(&self.mode) {
            return Ok(());
        }
        fault(format!("{call} is not allowed in the mode `{:?}`", self.mode))
    }

    /// Begins to initialise.
    ///
    /// # Errors
    /// In another mode, or with times that make no sense.
    pub fn enter_initialization(&mut self, times: Times) -> Result<(), Fault> {
        self.is(&[Mode::Instantiated], "fmi3EnterInitializationMode")?;
        let fits =
            times.start.is_finite() && times.stop.is_none_or(|stop| stop.is_finite() && stop > times.start);
        if !fits {
            return fault("the start time must be finite and before the stop time");
        }
        (self.times, self.mode) = (times, Mode::Initialization);
        Ok(())
    }

    /// Assembles the mechanism and ends the initialisation.
    ///
    /// # Errors
    /// In another mode, or if there is no consistent start.
    pub fn exit_initialization(&mut self) -> Result<(), Fault> {
        self.is(&[Mode::Initialization], "fmi3ExitInitializationMode")?;
        self.motion()?;
        self.mode = match self.interface {
            Interface::CoSimulation { events: false } => Mode::Step,
            _ => Mode::Event,
        };
        Ok(())
    }

    /// Enters event mode.
    ///
    /// # Errors
    /// In a mode from which it cannot be reached.
    pub fn enter_event_mode(&mut self) -> Result<(), Fault> {
        match self.interface {
            Interface::ModelExchange => self.is(&[Mode::ContinuousTime], "fmi3EnterEventMode")?,
            Interface::CoSimulation { events: true } => self.is(&[Mode::Step], "fmi3EnterEventMode")?,
            Interface::CoSimulation { events: false } => {
                return fault("fmi3EnterEventMode needs an instance with eventModeUsed");
            }
        }
        self.mode = Mode::Event;
        Ok(())
    }

    /// Enters step mode of co-simulation.
    ///
    /// # Errors
    /// In another mode than event mode of co-simulation.
    pub fn enter_step_mode(&mut self) -> Result<(), Fault> {
        self.is(&[Mode::Event], "fmi3EnterStepMode")?;
        if self.interface == Interface::ModelExchange {
            return fault("fmi3EnterStepMode belongs to co-simulation");
        }
        self.mode = Mode::Step;
        Ok(())
    }

    /// Enters continuous-time mode of model exchange.
    ///
    /// # Errors
    /// In another mode than event mode of model exchange.
    pub fn enter_continuous_time(&mut self) -> Result<(), Fault> {
        self.is(&[Mode::Event], "fmi3EnterContinuousTimeMode")?;
        if self.interface != Interface::ModelExchange {
            return fault("fmi3EnterContinuousTimeMode belongs to model exchange");
        }
        self.mode = Mode::ContinuousTime;
        Ok(())
    }

    /// Ends the experiment.
    ///
    /// # Errors
    /// Before its initialisation.
    pub fn terminate(&mut self) -> Result<(), Fault> {
        self.is(&[Mode::Event, Mode::ContinuousTime, Mode::Step], "fmi3Terminate")?;
        self.mode = Mode::Terminated;
        Ok(())
    }

    /// Back to a new instance.
    pub fn reset(&mut self) {
        let Self { loaded, interface, .. } = *self;
        *self = Self::new(loaded, interface);
    }

    /// The motion with the parameters that are wanted.
    fn motion(&mut self) -> Result<&mut Motion, Fault> {
        let stale = self.mode == Mode::Initialization
            && self.motion.as_ref().is_some_and(|motion| motion.parameters() != self.parameters);
        if self.motion.is_none() || stale {
            if self.mode == Mode::Instantiated {
                return fault("values are known from the initialization mode on");
            }
            self.motion = Some(self.start()?);
        }
        let Some(motion) = &mut self.motion else { return fault("there is no motion") };
        if motion.parameters() != self.parameters {
            let set = motion.set_parameters(&self.parameters);
            if let Err(error) = set {
                // What is refused is not asked for again.
                self.parameters = motion.parameters().to_vec();
                return Err(error);
            }
        }
        Ok(motion)
    }

    fn start(&self) -> Result<Motion, Fault> {
        let (system, description) = (self.loaded.system(), self.loaded.unit.program.description());
        let Times { start, stop, tolerance } = self.times;
        let tolerance = tolerance.map(|tolerance| tolerance.clamp(1e-14, 1e-1));
        let span = Span::Time(stop.map_or(OPEN_END, |stop| stop - start));
        let settings = Settings::new(Integrator::adaptive(description, tolerance), span, 0);
        debug_assert!(settings.singular_pivot == SINGULAR_PIVOT);
        Ok(match self.interface {
            Interface::CoSimulation { .. } => {
                let run = Simulation::start_at(start, system, description, &self.parameters, &settings)?;
                Motion::Steps(Box::new(run))
            }
            Interface::ModelExchange => {
                let space = StateSpace::start_at(start, system, description, &self.parameters, &settings)?;
                Motion::Space(Box::new(space))
            }
        })
    }

    /// Values of variables, in the order of their references.
    ///
    /// # Errors
    /// If one is unknown, or has no value here.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Fault> {
        if references.len() != values.len() {
            return fault("every variable here is one number: give as many values as references");
        }
        for (reference, value) in references.iter().zip(values) {
            *value = match self.variables.get(*reference) {
                None => return fault(format!("there is no variable {reference}")),
                Some(Variable::Parameter(index)) => self.parameters[index],
                Some(Variable::Constant(index)) => self.loaded.unit.constants[index].value,
                Some(Variable::Time) => match &self.motion {
                    Some(motion) => motion.t(),
                    None => self.times.start,
                },
                Some(Variable::Output(index)) => self.motion()?.values()?[index],
                Some(Variable::State(index)) => self.motion()?.state(index),
                Some(Variable::Derivative(index)) => self.motion()?.derivative(index)?,
                Some(Variable::Indicator(index)) => self.motion()?.penetrations()[index],
            };
        }
        Ok(())
    }

    /// Sets parameters.
    ///
    /// # Errors
    /// If a variable is none that may be set now, or a value is no number; nothing has changed then.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Fault> {
        if references.len() != values.len() {
            return fault("every variable here is one number: give as many values as references");
        }
        let begun = !matches!(self.mode, Mode::Instantiated | Mode::Initialization);
        let mut parameters = self.parameters.clone();
        for (reference, value) in references.iter().zip(values) {
            let Some(Variable::Parameter(index)) = self.variables.get(*reference) else {
                return fault(format!("variable {reference} is no parameter that can be set"));
            };
            let name = &self.loaded.unit.program.description().parameters[index].name;
            if !value.is_finite() {
                return fault(format!("parameter `{name}` is {value}; give it a finite value"));
            }
            let fixed = self.loaded.fixed[index];
            let is_input = index >= self.loaded.unit.program.description().tunable();
            let allowed = match self.mode {
                Mode::Event | Mode::Step | Mode::ContinuousTime if is_input => !fixed,
                Mode::Event => !fixed,
                Mode::Step => !fixed && self.interface == (Interface::CoSimulation { events: false }),
                _ => !begun,
            };
            if !allowed {
                let why =
                    if fixed { "the mechanism would have to be assembled anew" } else { "not in this mode" };
                return fault(format!("parameter `{name}` cannot be changed now: {why}"));
            }
            parameters[index] = *value;
        }
        self.parameters = parameters;
        Ok(())
    }

    /// Goes on by a step of co-simulation. The time reached.
    ///
    /// # Errors
    /// In another mode, at another time, or why the run cannot go on.
    pub fn step(&mut self, from: f64, length: f64) -> Result<f64, Fault> {
        self.is(&[Mode::Step], "fmi3DoStep")?;
        let stop = self.times.stop;
        let Motion::Steps(run) = self.motion()? else { return fault("fmi3DoStep belongs to co-simulation") };
        let slack = SAME_TIME * (run.t().abs().max(length.abs()));
        let meets = (from - run.t()).abs() <= slack;
        if !meets {
            return fault(format!("the step begins at {from} s, the unit is at {} s", run.t()));
        }
        let ahead = length > 0.0 && length.is_finite();
        if !ahead {
            return fault(format!("a step of {length} s leads nowhere"));
        }
        let mut to = from + length;
        if let Some(stop) = stop {
            if to > stop + slack {
                return fault(format!("the step ends at {to} s, after the stop time of {stop} s"));
            }
            // Sums of step lengths end beside it by rounding.
            if (to - stop).abs() <= slack {
                to = stop;
            }
        }
        run.advance(to.max(run.t()), Watch::NONE)?;
        Ok(run.t())
    }

    /// Contacts that closed or opened in the last step, as sentences.
    pub fn take_events(&mut self) -> Vec<String> {
        let Some(Motion::Steps(run)) = &mut self.motion else { return Vec::new() };
        let contacts = &self.loaded.unit.program.description().contacts;
        let told = |event: linkwear_runtime::ContactEvent| {
            let word = if event.closes { "closes" } else { "opens" };
            format!("joint {} {word} at {} s", contacts[event.joint].joint, event.t)
        };
        run.take_events().into_iter().map(told).collect()
    }

    fn space(&mut self, call: &str) -> Result<&mut StateSpace<'static>, Fault> {
        match self.motion()? {
            Motion::Space(space) => Ok(space),
            Motion::Steps(_) => fault(format!("{call} belongs to model exchange")),
        }
    }

    /// Sets the time of model exchange.
    ///
    /// # Errors
    /// In another mode, or if it is no number.
    pub fn set_time(&mut self, t: f64) -> Result<(), Fault> {
        self.is(&[Mode::ContinuousTime], "fmi3SetTime")?;
        if !t.is_finite() {
            return fault("the time must be finite");
        }
        self.space("fmi3SetTime")?.set_time(t);
        Ok(())
    }

    /// Sets the states of model exchange.
    ///
    /// # Errors
    /// In another mode, or if their number is another or one is none.
    pub fn set_states(&mut self, states: &[f64]) -> Result<(), Fault> {
        self.is(&[Mode::ContinuousTime], "fmi3SetContinuousStates")?;
        if let Some(wrong) = states.iter().find(|state| !state.is_finite()) {
            return fault(format!("a continuous state is {wrong}"));
        }
        Ok(self.space("fmi3SetContinuousStates")?.set_states(states)?)
    }

    /// States of model exchange.
    ///
    /// # Errors
    /// If there are none yet, or others asked for.
    pub fn states(&mut self, states: &mut [f64]) -> Result<(), Fault> {
        copy(self.space("fmi3GetContinuousStates")?.states(), states)
    }

    /// Natural sizes of the states.
    ///
    /// # Errors
    /// As [`Self::states`].
    pub fn nominals(&mut self, sizes: &mut [f64]) -> Result<(), Fault> {
        copy(self.space("fmi3GetNominalsOfContinuousStates")?.sizes(), sizes)
    }

    /// Derivatives of the states.
    ///
    /// # Errors
    /// If they have no value, or their number is another.
    pub fn derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), Fault> {
        copy(self.space("fmi3GetContinuousStateDerivatives")?.derivatives()?, derivatives)
    }

    /// Penetrations of contacts [m].
    ///
    /// # Errors
    /// If their number is another.
    pub fn indicators(&mut self, indicators: &mut [f64]) -> Result<(), Fault> {
        let found: Vec<f64> = self.space("fmi3GetEventIndicators")?.penetrations().collect();
        copy(&found, indicators)
    }

    /// Number of states.
    pub fn state_count(&self) -> usize {
        self.variables.states()
    }

    /// Number of event indicators.
    pub fn indicator_count(&self) -> usize {
        self.variables.indicators()
    }

    /// A step of the tool's integrator is done. Whether event mode should be entered: loops have opened.
    ///
    /// # Errors
    /// In another mode, or if the step was too long to be followed.
    pub fn completed_step(&mut self) -> Result<bool, Fault> {
        self.is(&[Mode::ContinuousTime], "fmi3CompletedIntegratorStep")?;
        Ok(self.space("fmi3CompletedIntegratorStep")?.complete_step()?)
    }

    /// Handles events: contacts that closed, loops that opened, parameters that changed. Whether states have moved.
    ///
    /// # Errors
    /// In another mode, or if loops cannot be closed.
    pub fn update_discrete(&mut self) -> Result<bool, Fault> {
        self.is(&[Mode::Event], "fmi3UpdateDiscreteStates")?;
        if self.interface != Interface::ModelExchange {
            self.motion()?;
            return Ok(false);
        }
        let before = match &self.motion {
            Some(Motion::Space(space)) => space.states().to_vec(),
            _ => Vec::new(),
        };
        let space = self.space("fmi3UpdateDiscreteStates")?;
        space.close_contacts();
        space.put_on()?;
        Ok(space.states() != before)
    }

    /// Everything to go on from here.
    pub fn keep(&mut self) -> Kept {
        let motion = self.motion.as_mut().map(|motion| match motion {
            Motion::Steps(run) => run.state(),
            Motion::Space(space) => space.state(),
        });
        Kept { mode: self.mode, times: self.times, parameters: self.parameters.clone(), motion }
    }

    /// Goes on from what was kept, of this unit by the same interface.
    ///
    /// # Errors
    /// If it is of another.
    pub fn put_back(&mut self, kept: &Kept) -> Result<(), Fault> {
        if kept.parameters.len() != self.parameters.len() {
            return fault("the state is of another unit");
        }
        let restored = match &kept.motion {
            None => None,
            Some(state) => {
                // Of what a start decides nothing is in a state: one that began otherwise begins again.
                let begun = self.motion.take().filter(|_| self.times == kept.times);
                let mut other = Self::new(self.loaded, self.interface);
                (other.times, other.mode) = (kept.times, Mode::Initialization);
                other.parameters.clone_from(&state.parameters);
                let mut motion = match begun {
                    Some(motion) => motion,
                    None => other.start()?,
                };
                match &mut motion {
                    Motion::Steps(run) => run.restore(state)?,
                    Motion::Space(space) => space.restore(state)?,
                }
                Some(motion)
            }
        };
        self.motion = restored;
        (self.mode, self.times) = (kept.mode, kept.times);
        self.parameters.clone_from(&kept.parameters);
        Ok(())
    }

    /// Derivative of unknowns along a direction of knowns, `seed`.
    ///
    /// # Errors
    /// If one of them is no such variable, or has no derivative here.
    pub fn directional(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), Fault> {
        if knowns.len() != seed.len() || unknowns.len() != sensitivity.len() {
            return fault("every variable here is one number: give as many of them as references");
        }
        let variable = |reference: &u32| match self.variables.get(*reference) {
            Some(variable) => Ok(variable),
            None => fault(format!("there is no variable {reference}")),
        };
        let unknowns = unknowns.iter().map(variable).collect::<Result<Vec<_>, _>>()?;
        let knowns = knowns.iter().map(variable).collect::<Result<Vec<_>, _>>()?;
        let loaded = self.loaded;
        let mut at = match self.motion()? {
            Motion::Steps(run) => run.state(),
            Motion::Space(space) => space.state(),
        };
        at.parameters.clone_from(&self.parameters);
        let dual = self.sensitivity.get_or_insert_with(|| Sensitivity::new(loaded));
        let found = dual.along(loaded, &at, &knowns, seed).map_err(Fault)?;
        for (unknown, value) in unknowns.iter().zip(sensitivity) {
            *value = found
                .of(*unknown)
                .ok_or_else(|| Fault("an unknown is no output or derivative".to_owned()))?;
        }
        Ok(())
    }

    /// Derivative of `seed`-weighted unknowns by each of the knowns.
    ///
    /// # Errors
    /// As [`Self::directional`].
    pub fn adjoint(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), Fault> {
        if unknowns.len() != seed.len() || knowns.len() != sensitivity.len() {
            return fault("every variable here is one number: give as many of them as references");
        }
        let mut column = vec![0.0; unknowns.len()];
        for (known, value) in knowns.iter().zip(sensitivity) {
            self.directional((unknowns, &[*known]), &[1.0], &mut column)?;
            *value = column.iter().zip(seed).map(|(a, b)| a * b).sum();
        }
        Ok(())
    }
}

fn defaults(loaded: &Loaded) -> Vec<f64> {
    loaded.unit.program.description().parameters.iter().map(|parameter| parameter.default).collect()
}

fn copy(from: &[f64], to: &mut [f64]) -> Result<(), Fault> {
    if from.len() != to.len() {
        return fault(format!("{} numbers are asked for, there are {}", to.len(), from.len()));
    }
    to.copy_from_slice(from);
    Ok(())
}

impl Motion {
    fn t(&self) -> f64 {
        match self {
            Self::Steps(run) => run.t(),
            Self::Space(space) => space.t(),
        }
    }

    fn parameters(&self) -> &[f64] {
        match self {
            Self::Steps(run) => run.parameters(),
            Self::Space(space) => space.parameters(),
        }
    }

    fn set_parameters(&mut self, parameters: &[f64]) -> Result<(), Fault> {
        match self {
            Self::Steps(run) => Ok(run.set_parameters(parameters)?),
            Self::Space(space) => Ok(space.set_parameters(parameters)?),
        }
    }

    fn values(&mut self) -> Result<&[f64], Fault> {
        match self {
            Self::Steps(run) => Ok(run.values()),
            Self::Space(space) => Ok(space.values()?),
        }
    }

    fn state(&self, index: usize) -> f64 {
        match self {
            Self::Steps(run) => {
                let (q, v) = (run.coordinates(), run.speeds());
                if index < q.len() { q[index] } else { v[index - q.len()] }
            }
            Self::Space(space) => space.states()[index],
        }
    }

    fn derivative(&mut self, index: usize) -> Result<f64, Fault> {
        match self {
            Self::Steps(run) => Ok(run.derivatives()?[index]),
            Self::Space(space) => Ok(space.derivatives()?[index]),
        }
    }

    fn penetrations(&mut self) -> Vec<f64> {
        match self {
            Self::Steps(run) => run.contacts().iter().map(|touch| touch.penetration()).collect(),
            Self::Space(space) => space.penetrations().collect(),
        }
    }
}
