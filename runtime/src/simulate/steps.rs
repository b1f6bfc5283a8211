//! Runs a schedule to its end, step by step. In: a start, a method. Out: samples. Never knows how a start is found.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use super::schedule::steps_between;
use super::settings::Integrator;
use super::{dead_point, events, implicit};
use crate::error::RunError;
use crate::integrate::{Adaptive, Dopri5, Method, Rk4, Rk43};
use crate::watch::Watch;

/// Runs a schedule to its end with a method; `state` is then where it got.
pub(super) fn run(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &mut [f64],
    integrator: Integrator,
    watch: Watch<'_>,
) -> Result<(), RunError> {
    let outcome = match integrator {
        Integrator::Rk4 { step } => run_rk4(motion, sampler, state, step, watch),
        Integrator::Dopri5 { tolerance, max_step } => {
            run_adaptive::<Dopri5>(motion, sampler, state, (tolerance, max_step), watch)
        }
        Integrator::Rk43 { tolerance, max_step } => {
            motion.loosen(tolerance);
            run_adaptive::<Rk43>(motion, sampler, state, (tolerance, max_step), watch)
        }
        Integrator::GeneralizedAlpha { step, rho } => {
            implicit::run_generalized_alpha(motion, sampler, state, (step, rho), watch)
        }
    };
    outcome.map_err(|error| {
        let (t, reached) = &sampler.reached;
        let q = motion.split(reached).0.to_vec();
        sampler.passages.explain(integrator, dead_point::explain(motion, (*t, &q), error))
    })
}

/// Equal steps no longer than asked for, that land on every sample.
fn run_rk4(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &mut [f64],
    longest: f64,
    watch: Watch<'_>,
) -> Result<(), RunError> {
    let mut method = Rk4::new(state.len());
    let mut t = sampler.schedule.begin;
    sampler.sample_at_start(motion, state)?;
    while let Some(target) = sampler.next_stop(t) {
        let (from, steps) = (t, steps_between(t, target, longest));
        for i in 1..=steps {
            let next = if i == steps { target } else { from + (target - from) * (i as f64 / steps as f64) };
            method.step(motion, t, state, next - t)?;
            t = next;
            sampler.note_loop_error(motion, t, motion.projector.loop_error())?;
            sampler.follow_angles(motion, t, state, None)?;
            sampler.step_done(motion, t, state)?;
            if sampler.is_due(t) {
                sampler.sample(motion, t, state)?;
            }
            sampler.report(t, watch)?;
        }
    }
    Ok(())
}

fn run_adaptive<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &mut [f64],
    limits: (f64, Option<f64>),
    watch: Watch<'_>,
) -> Result<(), RunError> {
    let mut between = state.to_vec();
    let mut method = begin_adaptive::<M>(motion, sampler, state, limits)?;
    while method.t() < sampler.schedule.end {
        let stop = stop_at_kink(motion, sampler, method.t());
        let outcome = method.step(motion, stop);
        sampler.statistics.rejected = method.rejected();
        outcome?;
        events::stop_at_contact(motion, sampler, &mut method, &mut between)?;
        after_step(motion, sampler, &method, &mut between, watch)?;
    }
    state.copy_from_slice(method.y());
    Ok(())
}

/// Where the next step ends at the latest: no step leaps over a kink of an input.
fn stop_at_kink(motion: &ConstrainedMotion<'_>, sampler: &Sampler<'_>, t: f64) -> f64 {
    let stop = sampler.hard_stop(t);
    let Some(signals) = motion.dynamics.evaluator.signals() else { return stop };
    // Times that are the same but for rounding leave no step of a last bit.
    let slack = 1e-12 * sampler.duration();
    signals.next_kink(t + slack).filter(|kink| *kink < stop - slack).unwrap_or(stop)
}

/// Begins a schedule with a method, its tolerance and its longest step [s].
pub(super) fn begin_adaptive<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &[f64],
    (tolerance, longest): (f64, Option<f64>),
) -> Result<Adaptive<M>, RunError> {
    let longest = longest.unwrap_or(sampler.duration() / 10.0);
    let span = (sampler.schedule.begin, sampler.schedule.end);
    sampler.sample_at_start(motion, state)?;
    Adaptive::start(motion, span, state, tolerance, longest)
}

/// Notes what an accepted step shows, once it ends where a gap closes.
pub(super) fn after_step<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    method: &Adaptive<M>,
    between: &mut [f64],
    watch: Watch<'_>,
) -> Result<(), RunError> {
    sampler.note_loop_error(motion, method.t(), motion.projector.loop_error())?;
    sampler.follow_angles(motion, method.t(), method.y(), Some(&|t, y| method.interpolate(t, y)))?;
    for t in sampler.between(motion, method.before(), method.t()) {
        method.interpolate(t, between);
        sampler.look(motion, t, between)?;
    }
    while let Some(t) = sampler.due_before(method.t()) {
        method.interpolate(t, between);
        sampler.sample(motion, t, between)?;
    }
    sampler.step_done(motion, method.t(), method.y())?;
    if sampler.is_due(method.t()) {
        between.copy_from_slice(method.y());
        sampler.sample(motion, method.t(), between)?;
    }
    sampler.report(method.t(), watch)
}
