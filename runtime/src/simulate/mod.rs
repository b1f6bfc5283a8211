//! Runs a mechanism through time: consistent start, steps, samples, statistics.
//! In: a system, its description, parameters, [`Settings`]. Out: a [`Run`].
//! Never knows files or terminals; progress goes to the caller's closure, which may stop the run.

mod contacts;
mod events;
mod ideal;
mod implicit;
mod motion;
mod sampler;
mod schedule;
mod settings;
mod turns;
mod warning;

pub use contacts::TurnMeasure;
pub use ideal::{IdealJoint, IdealMeasure};
pub use motion::{BRANCH_PART, JUMP_FLOOR};
pub use settings::{Integrator, Run, Settings, Span, Statistics};
pub use turns::{TurnMeasures, TurnRunner, TurnState};
pub use warning::RunWarning;

use std::ops::ControlFlow;

use crate::integrate::{Dopri5, Rk4};
use crate::{Description, Dynamics, Evaluator, RunError, System, assemble_resting};
use motion::ConstrainedMotion;
use sampler::Sampler;
use schedule::Schedule;

/// Called after every step with the finished part of the run (0 to 1); `Break` stops the run.
pub type Progress<'p> = &'p mut dyn FnMut(f64) -> ControlFlow<()>;

/// Simulates from a consistent start at t = 0; journals with clearance touch there, see [`assemble_resting`].
///
/// A run that cannot go on is no error here: it keeps its samples, and [`Run::stopped`] says why.
///
/// # Errors
/// If it cannot start: settings, parameters, a span in turns without a turning driver, or assembly.
pub fn simulate(
    system: &dyn System<f64>,
    description: &Description,
    parameters: &[f64],
    settings: &Settings,
    progress: Progress<'_>,
) -> Result<Run, RunError> {
    settings.check()?;
    let mut evaluator = Evaluator::new(system, description, parameters)?;
    let schedule = Schedule::new(&mut evaluator, settings)?;
    let start = assemble_resting(&mut evaluator, 0.0)?;
    let dynamics = Dynamics::new(evaluator, settings.singular_pivot);
    let mut motion = ConstrainedMotion::new(dynamics);
    motion.learn_sizes(0.0, &start);
    let mut state = motion.join(&start);
    let mut sampler = Sampler::new(&mut motion, schedule, &state);
    let stopped = run(&mut motion, &mut sampler, &mut state, settings.integrator, progress);
    Ok(sampler.finish(&motion, warning::step_limits(settings.integrator), stopped.err()))
}

/// Runs a schedule to its end with a method; `state` is then where it got.
fn run(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler,
    state: &mut [f64],
    integrator: Integrator,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    match integrator {
        Integrator::Rk4 { step } => run_rk4(motion, sampler, state, step, progress),
        Integrator::Dopri5 { tolerance, max_step } => {
            let longest = max_step.unwrap_or(sampler.duration() / 10.0);
            run_dopri5(motion, sampler, state, (tolerance, longest), progress)
        }
        Integrator::GeneralizedAlpha { step, rho } => {
            implicit::run_generalized_alpha(motion, sampler, state, (step, rho), progress)
        }
    }
}

/// Equal steps no longer than asked for, that land on every sample.
fn run_rk4(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler,
    state: &mut [f64],
    longest: f64,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    let mut method = Rk4::new(state.len());
    let mut t = sampler.begin();
    sampler.sample_at_start(motion, state)?;
    while let Some(target) = sampler.next_stop(t) {
        let (from, steps) = (t, steps_between(t, target, longest));
        for i in 1..=steps {
            let next = if i == steps { target } else { from + (target - from) * (i as f64 / steps as f64) };
            method.step(motion, t, state, next - t)?;
            t = next;
            sampler.note_loop_error(motion.loop_error());
            sampler.step_done(motion, t, state)?;
            if sampler.is_due(t) {
                sampler.sample(motion, t, state)?;
            }
            sampler.report(t, progress)?;
        }
    }
    Ok(())
}

/// Number of equal steps; a hair of slack keeps a span that is a multiple of the step from one step more.
fn steps_between(from: f64, to: f64, longest: f64) -> u64 {
    (((to - from) / longest) * (1.0 - 1e-9)).ceil().max(1.0) as u64
}

fn run_dopri5(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler,
    state: &mut [f64],
    (tolerance, longest): (f64, f64),
    progress: Progress<'_>,
) -> Result<(), RunError> {
    let (begin, end) = (sampler.begin(), sampler.end());
    let mut between = state.to_vec();
    sampler.sample_at_start(motion, state)?;
    let mut method = Dopri5::start(motion, (begin, end), state, tolerance, longest)?;
    while method.t() < end {
        let outcome = method.step(motion, sampler.hard_stop(method.t()));
        sampler.statistics.rejected = method.rejected();
        outcome?;
        events::stop_at_contact(motion, sampler, &mut method, &mut between)?;
        sampler.note_loop_error(motion.loop_error());
        while let Some(t) = sampler.due_before(method.t()) {
            method.interpolate(t, &mut between);
            sampler.sample(motion, t, &mut between)?;
        }
        sampler.step_done(motion, method.t(), method.y())?;
        state.copy_from_slice(method.y());
        if sampler.is_due(method.t()) {
            between.copy_from_slice(method.y());
            sampler.sample(motion, method.t(), &mut between)?;
        }
        sampler.report(method.t(), progress)?;
    }
    Ok(())
}
