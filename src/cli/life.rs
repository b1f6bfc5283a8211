//! `life`: the coupled wear of a mechanism, cycle by cycle, to the failure threshold; one mean path, or many random
//! ones by its Gamma process.

mod folder;
mod lived;
mod output;
mod process;

use std::num::NonZero;

use linkwear_runtime::life::{Feedback, LifeSettings, WearStep};
use linkwear_runtime::{Description, DynamicsSource, Integrator, RevolutionSettings, RunError, System};

use self::folder::Folder;
use self::lived::Lived;
use self::process::Process;
use super::arguments::{Coupling, Format, LifeArguments};
use super::failure::Failure;
use super::file::print;
use super::input::load_as;
use super::simulate::choose_backend;
use linkwear::progress::{catch_interrupts, stop_requested};

/// Random lives unless told otherwise: a standard error of a thirtieth of their scatter.
const DEFAULT_TRAJECTORIES: u64 = 1000;

/// What to live, and how.
struct Plan<'a> {
    arguments: &'a LifeArguments,
    description: &'a Description,
    parameters: Vec<f64>,
    revolutions: RevolutionSettings,
    settings: LifeSettings,
    coupling: Coupling,
    /// alpha and beta of all wearing joints, if all have them.
    process: Option<Process>,
    /// Random lives; nothing for the mean path alone.
    trajectories: Option<u64>,
    threads: NonZero<usize>,
}

/// Answers `life`.
pub fn run(arguments: &LifeArguments, format: Format) -> Result<(), Failure> {
    let loaded = load_as(&arguments.input, arguments.rigid)?;
    let folder = arguments.out.as_deref().map(Folder::claim).transpose()?;
    let system = || choose_backend(&arguments.input, arguments.backend, arguments.rigid, &loaded);
    let (backend, own) = system()?;
    catch_interrupts();
    let plan = Plan::new(arguments, loaded.compiled.description(), loaded.compiled.parameters(), &*own)?;
    let lend = || system().map(|(_, system)| system).ok();
    let lived = plan.live(&*own, &lend).map_err(|stopped| stopped.keep(folder.as_ref(), format))?;
    if let Some(folder) = &folder {
        folder.write(&lived, &loaded, backend)?;
    }
    match format {
        Format::Json => print(&lived.machine(&loaded, backend)),
        Format::Text => print(&lived.human(&loaded, backend)),
    }
}

impl<'a> Plan<'a> {
    fn new(
        arguments: &'a LifeArguments,
        description: &'a Description,
        parameters: Vec<f64>,
        system: &dyn System<f64>,
    ) -> Result<Self, Failure> {
        let revolutions = RevolutionSettings {
            integrator: Integrator::Rk4 { step: arguments.step },
            settle: arguments.settle,
            average: arguments.average,
        };
        let wrong = |message: String, help: &str| failed(arguments, &message, help);
        if !description.contacts.iter().any(|contact| contact.wear.is_some()) {
            let message = "no joint of this mechanism wears".to_owned();
            return Err(wrong(message, "add [clearance.R1] and [wear.R1], R1 being the joint that wears"));
        }
        let start =
            DynamicsSource::new(system, description, &parameters, revolutions).map_err(
                |error| match error {
                    RunError::NoTurns => {
                        let message =
                            "no revolute joint is driven, so revolutions cannot be counted".to_owned();
                        wrong(message, "drive one, as in R1 = { revolute = .., drive = \"2*pi*speed*t\" }")
                    }
                    error => wrong(error.to_string(), ""),
                },
            )?;
        let joints = start.joints().map_err(|error| wrong(error.to_string(), ""))?;
        let mut settings = LifeSettings::new(joints);
        if arguments.no_feedback {
            settings = settings.without_feedback();
        }
        let profile = settings.joints.iter().any(|joint| joint.feedback == Feedback::Profile);
        let default = if profile { Coupling::Full } else { Coupling::Table };
        let coupling = arguments.coupling.unwrap_or(default);
        settings.step = match coupling {
            Coupling::Table => WearStep::TABLE,
            Coupling::Full => WearStep::FULL,
        };
        let process = Process::of(arguments, description)?;
        let trajectories = trajectories(arguments, process.as_ref(), coupling)?;
        let threads = arguments.threads.or_else(|| std::thread::available_parallelism().ok());
        let threads = threads.unwrap_or(NonZero::<usize>::MIN);
        Ok(Self {
            arguments,
            description,
            parameters,
            revolutions,
            settings,
            coupling,
            process,
            trajectories,
            threads,
        })
    }

    /// Revolutions of a system, ended by Ctrl-C.
    fn fine<'s>(&'s self, system: &'s dyn System<f64>) -> Result<DynamicsSource<'s>, RunError> {
        let made = DynamicsSource::new(system, self.description, &self.parameters, self.revolutions)?;
        Ok(made.stopped_by(&stop_requested))
    }

    fn live<'p>(
        &'p self,
        system: &dyn System<f64>,
        lend: &(dyn Fn() -> Option<Box<dyn System<f64>>> + Sync),
    ) -> Result<Lived<'p>, lived::Stopped> {
        Lived::of(self, system, lend)
    }
}

/// How many lives are to be drawn, if any.
fn trajectories(
    arguments: &LifeArguments,
    process: Option<&Process>,
    coupling: Coupling,
) -> Result<Option<u64>, Failure> {
    let default =
        if coupling == Coupling::Table && !arguments.mean { Some(DEFAULT_TRAJECTORIES) } else { None };
    let count = process.and(arguments.trajectories.or(default));
    if count.is_none() && arguments.shared_factor.is_some() {
        let message = "--shared-factor spreads random lives, and none are asked for".to_owned();
        let help =
            "add --trajectories 16; with full coupling every life costs a run of the dynamics".to_owned();
        return Err(Failure::Usage { message, help });
    }
    Ok(count)
}

fn failed(arguments: &LifeArguments, message: &str, help: &str) -> Failure {
    Failure::Life {
        file: arguments.input.file.clone(),
        message: message.to_owned(),
        help: help.to_owned(),
        cycles: Vec::new(),
    }
}
