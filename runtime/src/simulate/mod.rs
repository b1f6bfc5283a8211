//! Runs a mechanism through time: consistent start, steps, samples, statistics.
//! In: a system, its description, parameters, [`Settings`]. Out: a [`Run`].
//! Never knows files or terminals; a [`Watch`] hears of progress and may stop the run.

mod angles;
mod bends;
mod bundle;
mod changed_laws;
mod contact_event;
mod contacts;
mod dead_point;
mod events;
mod extremes;
mod guard;
mod half_turn;
mod ideal;
mod implicit;
mod looks;
mod modal_sizes;
mod motion;
mod run;
mod sampler;
mod samples;
mod schedule;
mod settings;
mod simulation;
mod singular_passage;
mod slopes;
mod state_space;
mod steps;
mod surface;
mod switches;
mod turns;
mod unbounded;
mod warning;

pub(crate) use bundle::LOOKS_EVERY;
pub use bundle::{
    LaneTurns, TurnBundle, TurnOutcome, TurnQueue, TurnRequests, WholeSteps, WideBundle, turn_queue,
};
pub use contact_event::ContactEvent;
pub use extremes::{At, ENVELOPE_PIECES, Extremes, Peak};
pub use ideal::IdealJoint;
pub use motion::{BRANCH_PART, JUMP_FLOOR};
pub use run::{Run, Statistics};
pub use settings::{Integrator, Settings, Span};
pub use simulation::{KnownAngles, Simulation, SimulationState};
pub use state_space::StateSpace;
pub(crate) use turns::Place;
pub use turns::{TurnMeasures, TurnRunner, TurnState};
pub use warning::RunWarning;

use crate::assemble::assemble_static_contact;
use crate::description::Description;
use crate::dynamics::Dynamics;
use crate::error::RunError;
use crate::evaluate::Evaluator;
use crate::signals::Signals;
use crate::system::System;
use crate::watch::Watch;
use motion::ConstrainedMotion;
use sampler::Sampler;
use schedule::Schedule;
use steps::Steps;

/// Simulates from a consistent start at t = 0; journals with clearance touch there, see [`assemble_static_contact`].
///
/// A run that cannot go on is no error here: it keeps its samples, and [`Run::stopped`] says why.
///
/// # Errors
/// If it cannot start: settings, parameters, a span in turns without a turning driver, or assembly.
///
/// ```
/// use linkwear_runtime::{Settings, Span, Watch, simulate};
///
/// mod fall {
///     // Generated code: `linkwear_runtime::include_mechanism!("fall")`. This one was written by hand.
///     include!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/fall.rs.txt"));
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mechanism = fall::Mechanism { g: 1.62 };
/// let settings = Settings { span: Span::Time(2.0), samples: 5, ..Settings::default() };
/// let run = simulate(&mechanism, fall::description(), &mechanism.parameters(), &settings, Watch::NONE)?;
/// assert!(run.stopped.is_none());
/// for (t, z) in run.times.iter().zip(run.column("z")?) {
///     // At the tolerance of 1e-9, for heights of 20 m.
///     assert!((z - (20.0 - 0.5 * 1.62 * t * t)).abs() < 2e-8);
/// }
/// # Ok(())
/// # }
/// ```
pub fn simulate(
    system: &dyn System<f64>,
    description: &Description,
    parameters: &[f64],
    settings: &Settings,
    watch: Watch<'_>,
) -> Result<Run, RunError> {
    settings.check()?;
    run(Evaluator::new(system, description, parameters)?, settings, watch)
}

/// As [`simulate`], with inputs that change in time.
///
/// # Errors
/// Those of [`simulate`], and if the inputs are not known for the whole run.
pub fn simulate_with_inputs<'a>(
    system: &'a dyn System<f64>,
    description: &'a Description,
    parameters: &[f64],
    signals: &'a dyn Signals,
    settings: &Settings,
    watch: Watch<'_>,
) -> Result<Run, RunError> {
    settings.check()?;
    let mut evaluator = Evaluator::new(system, description, parameters)?;
    evaluator.connect(signals);
    run(evaluator, settings, watch)
}

fn run(mut evaluator: Evaluator<'_>, settings: &Settings, watch: Watch<'_>) -> Result<Run, RunError> {
    let schedule = Schedule::new(&mut evaluator, settings, 0.0)?;
    if let Some(signals) = evaluator.signals() {
        schedule.check_covered(signals.span())?;
    }
    let start = assemble_static_contact(&mut evaluator, 0.0)?;
    let dynamics = Dynamics::new(evaluator, settings.singular_pivot);
    let mut motion = ConstrainedMotion::new(dynamics);
    motion.learn_sizes(0.0, &start);
    let mut state = motion.join(&start);
    samples::begin(&mut motion, 0.0, &mut state)?;
    let mut sampler = Sampler::new(&mut motion, schedule, &state);
    sampler.collect_extremes(&motion);
    let stopped = record(&mut motion, &mut sampler, &mut state, settings.integrator, watch);
    Ok(sampler.finish(&motion, warning::step_limits(settings.integrator), stopped.err()))
}

/// Runs a schedule to its end and records its samples.
fn record(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &mut [f64],
    integrator: Integrator,
    watch: Watch<'_>,
) -> Result<(), RunError> {
    let Schedule { begin, start, end, samples } = sampler.schedule;
    let sampled = samples > 0 && start == begin;
    let mut steps = Steps::begin(motion, sampler, state, integrator, sampled)?;
    if sampled {
        sampler.record(begin);
    }
    for index in usize::from(sampled)..samples {
        let t = sampler.schedule.time(index);
        steps.advance(motion, sampler, state, (t, true), watch)?;
        sampler.record(t);
    }
    if samples == 0 { steps.advance(motion, sampler, state, (end, false), watch) } else { Ok(()) }
}
