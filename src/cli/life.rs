//! `life`: the coupled wear of a mechanism, cycle by cycle, to the failure threshold.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use linkwear_runtime::life::{
    CycleRecord, DEFAULT_POINTS, FineScale, JointLife, JointWear, LifeSettings, LifeState, Mean, Outcome,
    RevolutionWear, Stop, Summary, Table, WearStep, run_life,
};
use linkwear_runtime::{
    Description, Integrator, RunError, RunWarning, SINGULAR_PIVOT, System, TurnRunner, TurnState,
};
use serde_json::{Value, json};

use super::failure::Failure;
use super::file::print;
use super::input::{Loaded, load_as};
use super::progress::{Progress, catch_interrupts, stop_requested};
use super::simulate::choose_backend;
use super::table::{number, table};
use super::{Coupling, Format, LifeArguments};

/// Cycles that are printed before long lives are thinned out.
const SHOWN: usize = 40;

/// Answers `life`.
pub fn run(arguments: &LifeArguments, format: Format) -> Result<(), Failure> {
    let loaded = load_as(&arguments.input, arguments.rigid)?;
    let description = loaded.compiled.description();
    let (backend, system) = choose_backend(&arguments.input, arguments.backend, arguments.rigid, &loaded)?;
    catch_interrupts();
    let mut fine = Turns::new(arguments, &loaded, &*system)?;
    let settings = fine.settings(arguments, description)?;
    let mut progress = Progress::new();
    let lived = live(arguments, settings, &mut fine, &mut progress);
    progress.finish();
    let life = lived?;
    match format {
        Format::Json => print(&life.machine(&loaded, &fine, backend)),
        Format::Text => print(&life.human(&loaded, &fine, backend)),
    }
}

/// The fine scale: revolutions by the generated equations.
struct Turns<'a> {
    runner: TurnRunner<'a>,
    start: TurnState,
    /// Indices of the wearing joints among those with clearance, with their clearance at the start [m].
    wearing: Vec<(usize, f64)>,
    settle: u32,
    warnings: Vec<RunWarning>,
}

impl<'a> Turns<'a> {
    fn new(
        arguments: &LifeArguments,
        loaded: &'a Loaded,
        system: &'a dyn System<f64>,
    ) -> Result<Self, Failure> {
        let description = loaded.compiled.description();
        let integrator = Integrator::Rk4 { step: arguments.step };
        let parameters = loaded.compiled.parameters();
        let runner = TurnRunner::new(system, description, &parameters, integrator, SINGULAR_PIVOT);
        let mut runner = runner.map_err(|error| failed(arguments, &error.to_string()))?;
        let clearances = runner.clearances();
        let wearing = (0..description.contacts.len()).filter(|at| description.contacts[*at].wear.is_some());
        let wearing: Vec<(usize, f64)> = wearing.map(|at| (at, clearances[at])).collect();
        if wearing.is_empty() {
            return Err(failed(
                arguments,
                "no joint of this mechanism wears: add [clearance.R1] and [wear.R1]",
            ));
        }
        let start = runner.state();
        Ok(Self { runner, start, wearing, settle: arguments.settle, warnings: Vec::new() })
    }

    fn settings(
        &self,
        arguments: &LifeArguments,
        description: &Description,
    ) -> Result<LifeSettings, Failure> {
        let mut joints = Vec::new();
        for (at, clearance) in &self.wearing {
            let joint = JointLife::of_contact(&description.contacts[*at], *clearance);
            joints.extend(joint.map_err(|error| failed(arguments, &error.to_string()))?);
        }
        let settings = LifeSettings::new(joints);
        Ok(if arguments.no_feedback { settings.without_feedback() } else { settings })
    }
}

impl FineScale for Turns<'_> {
    type State = Option<TurnState>;
    type Error = RunError;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<RevolutionWear>, RunError> {
        self.runner.restore(state.as_ref().unwrap_or(&self.start))?;
        for ((at, unworn), joint) in self.wearing.iter().zip(joints) {
            self.runner.set_worn(*at, joint.clearance - unworn, joint.profile.clone())?;
        }
        let mut go_on = |_: f64| {
            if stop_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        self.runner.settle(self.settle, &mut go_on)?;
        let measured = self.runner.measure(&mut go_on)?;
        *state = Some(self.runner.state());
        for warning in measured.warnings {
            // Told once a kind: the figures change from turn to turn.
            let same = |known: &RunWarning| std::mem::discriminant(known) == std::mem::discriminant(&warning);
            if !self.warnings.iter().any(same) {
                self.warnings.push(warning);
            }
        }
        let wears = self.wearing.iter().map(|(at, _)| {
            let turn = &measured.joints[*at];
            RevolutionWear {
                wear_integral: turn.wear_integral_J,
                depth: turn.depth_m,
                profile: turn.deposit.clone(),
                mean_force: turn.mean_normal_force_N,
                peak_force: turn.peak_normal_force_N,
                contact_losses: turn.contact_losses as f64,
                separated: 1.0 - turn.touching_part,
                observed: turn.observed.expect("a joint that wears is observed"),
            }
        });
        Ok(wears.collect())
    }
}

/// A life and what it was made from.
struct Life {
    summary: Summary,
    joints: Vec<String>,
    warnings: Vec<String>,
    table_error: Option<f64>,
    measurements: usize,
    revolutions_per_cycle: f64,
    failed_joint: String,
}

fn live(
    arguments: &LifeArguments,
    mut settings: LifeSettings,
    fine: &mut Turns<'_>,
    progress: &mut Progress,
) -> Result<Life, Failure> {
    match arguments.coupling {
        Coupling::Table => {
            let made = Table::measure(&settings, fine, DEFAULT_POINTS, &mut |part| progress.set(part));
            let mut made = made.map_err(|stop| stopped(arguments, &stop, &[]))?;
            let error = made.report().left_out.iter().copied().fold(0.0, f64::max);
            let measurements = made.report().measurements;
            settings.step = WearStep::TABLE;
            let life = last(arguments, &settings, &mut made, &mut |_| {})?;
            Ok(Life { table_error: Some(error), measurements, ..life })
        }
        Coupling::Full => {
            settings.step = WearStep::FULL;
            last(arguments, &settings, fine, &mut |used| progress.set(used.min(1.0)))
        }
    }
}

/// Lives to the end.
fn last<F: FineScale>(
    arguments: &LifeArguments,
    settings: &LifeSettings,
    fine: &mut F,
    progress: &mut dyn FnMut(f64),
) -> Result<Life, Failure>
where
    F::Error: std::fmt::Display,
{
    let state = LifeState::new(settings, 0);
    let mut state = state.map_err(|error| failed(arguments, &error.to_string()))?;
    let outcome = run_life(settings, fine, &Mean, &mut state, &mut |cycle| {
        progress(cycle.used);
        if stop_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let joints: Vec<String> = settings.joints.iter().map(|joint| joint.joint.clone()).collect();
    let failure = match outcome {
        Ok(Outcome::Failed(failure)) => failure,
        Ok(Outcome::Cancelled) => return Err(failed(arguments, "stopped on request")),
        Ok(Outcome::CycleLimit) => {
            let message = format!("no joint has failed after {} cycles", settings.most_cycles);
            return Err(failed(arguments, &message));
        }
        Err(stop) => return Err(stopped(arguments, &stop, &state.cycles)),
    };
    let warnings = state
        .warnings
        .iter()
        .map(|known| format!("{}, cycle {}: {}", joints[known.joint], known.cycle, known.warning));
    Ok(Life {
        warnings: warnings.collect(),
        summary: Summary::of(&[failure], 0, state.cycles.clone()).expect("one life is not none"),
        failed_joint: joints[failure.joint].clone(),
        revolutions_per_cycle: settings.joints[failure.joint].revolutions_per_cycle,
        joints,
        table_error: None,
        measurements: usize::try_from(state.measurements).unwrap_or(usize::MAX),
    })
}

fn failed(arguments: &LifeArguments, message: &str) -> Failure {
    Failure::Life { file: arguments.input.file.clone(), message: message.to_owned(), cycles: 0 }
}

/// A life that stopped early, with the number of cycles that it had.
fn stopped<E: std::fmt::Display>(
    arguments: &LifeArguments,
    stop: &Stop<E>,
    cycles: &[CycleRecord],
) -> Failure {
    Failure::Life { file: arguments.input.file.clone(), message: stop.to_string(), cycles: cycles.len() }
}

impl Life {
    fn machine(&self, loaded: &Loaded, fine: &Turns<'_>, backend: &str) -> Value {
        let own = &self.summary;
        let cycles: Vec<Value> = own.cycles.iter().map(|cycle| self.cycle_entry(cycle)).collect();
        let run = fine.warnings.iter().map(ToString::to_string);
        let of_run =
            run.chain(self.warnings.iter().cloned()).map(|text| json!({ "code": "life", "message": text }));
        let warnings: Vec<Value> = loaded.warnings().into_iter().chain(of_run).collect();
        json!({
            "name": loaded.compiled.description().name,
            "backend": backend,
            "mean": own.mean, "std": own.std, "cov": own.cov,
            "quantiles": { "p10": own.quantiles.p10, "p50": own.quantiles.p50, "p90": own.quantiles.p90 },
            "mean_whole_cycles": own.mean_whole_cycles,
            "trajectories": own.trajectories, "seed": own.seed,
            "failed_joint": self.failed_joint,
            "revolutions": own.mean * self.revolutions_per_cycle,
            "table_error": self.table_error,
            "measurements": self.measurements,
            "cycles": cycles,
            "warnings": warnings,
        })
    }

    fn cycle_entry(&self, cycle: &CycleRecord) -> Value {
        let joints: Vec<Value> = self
            .joints
            .iter()
            .zip(&cycle.joints)
            .map(|(name, joint)| {
                json!({
                    "joint": name, "clearance_m": joint.clearance, "dLambda_m": joint.mean_increment,
                    "wear_m": joint.wear, "wear_integral_J": joint.wear_integral,
                    "mean_force_N": joint.mean_force, "peak_force_N": joint.peak_force,
                    "contact_losses": joint.contact_losses,
                })
            })
            .collect();
        json!({ "cycle": cycle.cycle, "used": cycle.used, "joints": joints })
    }

    fn human(&self, loaded: &Loaded, fine: &Turns<'_>, backend: &str) -> String {
        let own = &self.summary;
        let mut text = format!(
            "{}: {} fails after {:.3} cycles ({} whole), {} revolutions; {backend}\n\n",
            loaded.compiled.description().name,
            self.failed_joint,
            own.mean,
            own.mean_whole_cycles,
            number(own.mean * self.revolutions_per_cycle),
        );
        let stride = own.cycles.len().div_ceil(SHOWN).max(1);
        let end = own.cycles.len().saturating_sub(1);
        let mut rows = Vec::new();
        for (at, cycle) in own.cycles.iter().enumerate() {
            if at % stride != 0 && at != end {
                continue;
            }
            for (name, joint) in self.joints.iter().zip(&cycle.joints) {
                rows.push(vec![
                    cycle.cycle.to_string(),
                    name.clone(),
                    format!("{:.3}", 1e6 * joint.clearance),
                    format!("{:.4}", 1e6 * joint.mean_increment),
                    format!("{:.3}", 1e6 * joint.wear),
                    number(joint.peak_force),
                    number(joint.contact_losses),
                ]);
            }
        }
        let head = [
            "cycle",
            "joint",
            "clearance [um]",
            "dLambda [um]",
            "wear [um]",
            "peak force [N]",
            "contact losses",
        ];
        text.push_str(&table(&head, &rows));
        if let Some(error) = self.table_error {
            let _ = writeln!(
                text,
                "\nwear per revolution from a table of {} measured turns, good to {:.1e} of itself",
                self.measurements, error
            );
        }
        let run = fine.warnings.iter().map(ToString::to_string);
        for warning in run.chain(self.warnings.iter().cloned()) {
            let _ = writeln!(text, "\nwarning: {warning}");
        }
        text.trim_end().to_owned()
    }
}
