//! One instance of a unit: modes, times, values. In: what a tool asks, in safe terms. Out: answers, or a [`Fault`] with its
//! reason. Never knows pointers.

mod clearances;
mod exchange;
pub mod kept;
mod motion;
mod values;

use linkwear_runtime::{
    ContactEvent, Integrator, SINGULAR_PIVOT, Settings, Simulation, Span, StateSpace, Watch, channels,
};

use crate::fault::{Fault, fault};
use crate::loaded::Loaded;
use crate::sensitivity::Sensitivity;
use crate::variables::Variables;
use motion::Motion;

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
    /// Values that the motion refused, and why: they stay refused until others are wanted.
    refused: Option<(Vec<f64>, Fault)>,
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
            refused: None,
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
        if let Some((_, fault)) = self.refused.as_ref().filter(|(values, _)| *values == self.parameters) {
            return Err(fault.clone());
        }
        self.refused = None;
        let stale = self.mode == Mode::Initialization
            && self.motion.as_ref().is_some_and(|motion| motion.parameters() != self.parameters);
        if self.motion.is_none() || stale {
            if self.mode == Mode::Instantiated {
                return fault("values are known from the initialization mode on");
            }
            self.motion = Some(self.start()?);
        }
        let Some(motion) = &mut self.motion else { return fault("there is no motion") };
        let set = if self.loaded.has_leading_inputs {
            motion.follow(self.loaded, &self.parameters)
        } else if motion.parameters() == self.parameters {
            Ok(())
        } else {
            motion.set_parameters(&self.parameters)
        };
        if let Err(error) = set {
            match motion {
                Motion::Steps(_) => self.refused = Some((self.parameters.clone(), error.clone())),
                // States are the tool's: with others the same values may do.
                Motion::Space(_) => self.parameters = motion.parameters().to_vec(),
            }
            return Err(error);
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

    /// Goes on by a step of co-simulation. The time reached.
    ///
    /// # Errors
    /// In another mode, at another time, or why the run cannot go on.
    pub fn step(&mut self, from: f64, length: f64) -> Result<f64, Fault> {
        self.is(&[Mode::Step], "fmi3DoStep")?;
        let stop = self.times.stop;
        let leads = self.loaded.has_leading_inputs;
        // As they hold at the beginning of the step: drives go where they lead to.
        let wanted = if leads { self.parameters.clone() } else { Vec::new() };
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
        let to = to.max(run.t());
        if leads && to > run.t() {
            run.lead_inputs(&wanted, to)?;
        }
        run.advance(to, Watch::NONE)?;
        Ok(run.t())
    }

    /// Contacts that closed or opened in the last step, as sentences.
    pub fn take_events(&mut self) -> Vec<String> {
        let Some(Motion::Steps(run)) = &mut self.motion else { return Vec::new() };
        let contacts = &self.loaded.unit.program.description().contacts;
        let told = |event: ContactEvent| {
            let word = if event.closes { "closes" } else { "opens" };
            format!("joint {} {word} at {} s", contacts[event.joint].joint, event.t)
        };
        run.take_events().into_iter().map(told).collect()
    }
}

fn defaults(loaded: &Loaded) -> Vec<f64> {
    loaded.unit.program.description().parameters.iter().map(|parameter| parameter.default).collect()
}
