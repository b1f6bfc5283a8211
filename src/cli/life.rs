//! `life`: the coupled wear of a mechanism, cycle by cycle, to the failure threshold; one mean path, or many random
//! ones by its Gamma process.

mod folder;
mod lived;
mod output;

use std::num::NonZero;

use linkwear_gamma::coupled::GammaDraw;
use linkwear_runtime::life::{Feedback, LifeSettings, WearStep};
use linkwear_runtime::{Description, Integrator, RevolutionSettings, Revolutions, System};

use self::folder::Folder;
use self::lived::Lived;
use super::failure::Failure;
use super::file::print;
use super::input::load_as;
use super::progress::{catch_interrupts, stop_requested};
use super::simulate::choose_backend;
use super::{Coupling, Format, LifeArguments};

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
    /// Random lives; nothing for the mean path alone.
    random: Option<(GammaDraw, u64)>,
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
        let start = Revolutions::new(system, description, &parameters, revolutions)
            .map_err(|error| wrong(error.to_string(), ""))?;
        let joints = start.joints().map_err(|error| wrong(error.to_string(), ""))?;
        if joints.is_empty() {
            let message = "no joint of this mechanism wears".to_owned();
            return Err(wrong(message, "add [clearance.R1] and [wear.R1], R1 being the joint that wears"));
        }
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
        let random = random(arguments, description, coupling)?;
        let threads = arguments.threads.or_else(|| std::thread::available_parallelism().ok());
        let threads = threads.unwrap_or(NonZero::<usize>::MIN);
        Ok(Self { arguments, description, parameters, revolutions, settings, coupling, random, threads })
    }

    /// Revolutions of a system, ended by Ctrl-C.
    fn fine<'s>(
        &'s self,
        system: &'s dyn System<f64>,
    ) -> Result<Revolutions<'s>, linkwear_runtime::RunError> {
        let made = Revolutions::new(system, self.description, &self.parameters, self.revolutions)?;
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

/// The draws and how many lives, if any are to be drawn.
fn random(
    arguments: &LifeArguments,
    description: &Description,
    coupling: Coupling,
) -> Result<Option<(GammaDraw, u64)>, Failure> {
    let wearing = description.contacts.iter().filter_map(|contact| contact.wear.map(|wear| (contact, wear)));
    let mut rates = Vec::new();
    for (contact, wear) in wearing {
        match wear.scatter {
            Some(scatter) => rates.push(scatter),
            None if arguments.trajectories.is_some() => {
                let message = format!("joint `{}` has no Gamma process to draw from", contact.joint);
                let help = format!(
                    "add alpha = \"13.65 1/um\" to [wear.{}], or leave --trajectories out",
                    contact.joint
                );
                return Err(failed(arguments, &message, &help));
            }
            None => return Ok(None),
        }
    }
    let default =
        if coupling == Coupling::Table && !arguments.mean { Some(DEFAULT_TRAJECTORIES) } else { None };
    let count = arguments.trajectories.or(default);
    Ok(count.map(|count| (GammaDraw::new(arguments.seed, &rates), count)))
}

fn failed(arguments: &LifeArguments, message: &str, help: &str) -> Failure {
    Failure::Life {
        file: arguments.input.file.clone(),
        message: message.to_owned(),
        help: help.to_owned(),
        cycles: Vec::new(),
    }
}
