//! Runs generalised-alpha: shifted start, equal steps onto the samples, work by the trapezoidal rule
//! (order 2, as the method). In: a consistent start. Out: samples. Never knows the method's formulas.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use super::schedule::steps_between;
use crate::error::RunError;
use crate::integrate::{GeneralizedAlpha, Problem, Rk4};
use crate::watch::Watch;

pub(super) fn run_generalized_alpha(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &mut [f64],
    (longest, rho): (f64, f64),
    watch: Watch<'_>,
) -> Result<(), RunError> {
    sampler.sample_at_start(motion, state)?;
    let mut derivative = vec![0.0; state.len()];
    let powers = state.len() - motion.first_integral();
    let (mut before, mut now) = (vec![0.0; powers], vec![0.0; powers]);
    let mut sampled = state.to_vec();
    let mut method: Option<(GeneralizedAlpha, f64)> = None;
    let (mut t, n) = (sampler.schedule.begin, motion.first_integral());
    while let Some(target) = sampler.next_stop(t) {
        let (from, steps) = (t, steps_between(t, target, longest));
        // One step size up to the next stop; another one starts the method afresh, because its own
        // accelerations belong to times that depend on the step.
        let h = (target - from) / steps as f64;
        let same = method.as_ref().is_some_and(|(_, known)| (h - known).abs() <= 1e-9 * h);
        if !same {
            method = Some((start(motion, t, state, (h, rho))?, h));
        }
        let Some((method, h)) = &mut method else { break };
        motion.derivative(t, state, &mut derivative)?;
        before.copy_from_slice(&derivative[n..]);
        for i in 1..=steps {
            let next = if i == steps { target } else { from + (target - from) * (i as f64 / steps as f64) };
            let spent = (method.iterations(), method.evaluations());
            let outcome = method.step(&mut motion.dynamics.evaluator, t, *h);
            sampler.statistics.newton_iterations += method.iterations() - spent.0;
            sampler.statistics.evaluations += method.evaluations() - spent.1;
            outcome?;
            t = next;
            take_over(motion, method, t, (state, &mut before, &mut now), *h)?;
            let evaluator = &mut motion.dynamics.evaluator;
            evaluator.closure(t, method.q(), method.v());
            let open = evaluator.loop_error();
            sampler.note_loop_error(motion, t, open)?;
            sampler.follow_angles(motion, t, state, None)?;
            sampler.step_done(motion, t, state)?;
            if sampler.is_due(t) {
                sampled.copy_from_slice(state);
                sampler.sample(motion, t, &mut sampled)?;
            }
            sampler.report(t, watch)?;
        }
    }
    Ok(())
}

/// State and work at the end of a step.
fn take_over(
    motion: &mut ConstrainedMotion<'_>,
    method: &GeneralizedAlpha,
    t: f64,
    (state, before, now): (&mut [f64], &mut [f64], &mut [f64]),
    h: f64,
) -> Result<(), RunError> {
    let (q, v) = (method.q(), method.v());
    let n = q.len() + v.len();
    // Drivers work by the forces of the state that was reached, which are those that samples show; where the rows nearly lose
    // rank, rounding would decide the method's own.
    motion.dynamics.accelerate(t, q, v)?;
    // The rates of the coordinates go where the coordinates come next.
    motion.powers(t, q, v, &mut state[..q.len()], now);
    state[..q.len()].copy_from_slice(q);
    state[q.len()..n].copy_from_slice(v);
    for ((work, before), now) in state[n..].iter_mut().zip(before).zip(now) {
        *work += 0.5 * h * (*before + *now);
        *before = *now;
    }
    Ok(())
}

/// The method at a state, its own accelerations from a short explicit step to their shifted time.
fn start(
    motion: &mut ConstrainedMotion<'_>,
    t: f64,
    state: &[f64],
    (h, rho): (f64, f64),
) -> Result<GeneralizedAlpha, RunError> {
    let (q, v, _) = motion.split(state);
    motion.dynamics.accelerate(t, q, v)?;
    let v_dot = motion.dynamics.evaluator.last_forward().accelerations.to_vec();
    let shift = GeneralizedAlpha::shift(rho) * h;
    let mut shifted_state = state.to_vec();
    let mut shifted = v_dot.clone();
    // Laws may end at the start of the run: then the first steps are less accurate, nothing worse.
    if shift != 0.0 && Rk4::new(state.len()).step(motion, t, &mut shifted_state, shift).is_ok() {
        let (q, v, _) = motion.split(&shifted_state);
        if motion.dynamics.accelerate(t + shift, q, v).is_ok() {
            shifted.copy_from_slice(motion.dynamics.evaluator.last_forward().accelerations);
        }
    }
    let (q, v, _) = motion.split(state);
    let method = GeneralizedAlpha::new(&motion.dynamics.evaluator, rho, (q, v), &v_dot, &shifted);
    Ok(method.with_sizes(&motion.sizes))
}
