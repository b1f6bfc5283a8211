//! Generalised-alpha: shifted start, equal steps onto the samples, work by the trapezoidal rule
//! (order 2, as the method). In: a consistent start. Out: samples. Never knows the method's formulas.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use super::samples;
use super::schedule::steps_between;
use crate::error::RunError;
use crate::integrate::{GeneralizedAlpha, Problem, Rk4};
use crate::watch::Watch;

/// Generalised-alpha under way.
pub(super) struct Implicit {
    method: Option<(GeneralizedAlpha, f64)>,
    longest: f64,
    rho: f64,
    t: f64,
    derivative: Vec<f64>,
    /// Powers at the begin and the end of a step.
    before: Vec<f64>,
    now: Vec<f64>,
    sampled: Vec<f64>,
}

impl Implicit {
    /// From a state, by the longest step [s] and the spectral radius at infinity.
    pub(super) fn new(
        motion: &ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
        (longest, rho): (f64, f64),
    ) -> Self {
        let powers = vec![0.0; state.len() - motion.first_integral()];
        let (derivative, sampled) = (vec![0.0; state.len()], state.to_vec());
        Self { method: None, longest, rho, t, derivative, before: powers.clone(), now: powers, sampled }
    }

    /// Starts afresh at `t`: laws have changed there, or the state.
    pub(super) fn begin_anew(&mut self, t: f64) {
        (self.method, self.t) = (None, t);
    }

    /// Goes on to a time, with a sample there if it is asked for.
    pub(super) fn advance(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        state: &mut [f64],
        (to, sampled): (f64, bool),
        watch: Watch<'_>,
    ) -> Result<(), RunError> {
        let n = motion.first_integral();
        while self.t < to {
            let stop = to.min(sampler.hard_stop(self.t));
            let target = motion.dynamics.evaluator.stop_at_sample(self.t, stop);
            let (from, steps) = (self.t, steps_between(self.t, target, self.longest));
            // One step size up to the next stop; another one starts the method afresh, because its own
            // accelerations belong to times that depend on the step.
            let h = (target - from) / steps as f64;
            let same = self.method.as_ref().is_some_and(|(_, known)| (h - known).abs() <= 1e-9 * h);
            if !same {
                self.method = Some((start(motion, self.t, state, (h, self.rho))?, h));
            }
            let Some((method, h)) = &mut self.method else { break };
            motion.derivative(self.t, state, &mut self.derivative)?;
            self.before.copy_from_slice(&self.derivative[n..]);
            let mut acted = false;
            for i in 1..=steps {
                let next =
                    if i == steps { target } else { from + (target - from) * (i as f64 / steps as f64) };
                let spent = (method.iterations(), method.evaluations());
                let outcome = method.step(&mut motion.dynamics.evaluator, self.t, *h);
                sampler.statistics.newton_iterations += method.iterations() - spent.0;
                sampler.statistics.evaluations += method.evaluations() - spent.1;
                outcome?;
                self.t = next;
                take_over(motion, method, next, (state, &mut self.before, &mut self.now), *h)?;
                let evaluator = &mut motion.dynamics.evaluator;
                evaluator.closure(next, method.q(), method.v());
                let open = evaluator.loop_error();
                sampler.note_loop_error(motion, next, open)?;
                sampler.follow_angles(motion, next, state, None)?;
                sampler.step_done(motion, next, state)?;
                acted = i == steps && samples::act_behind(motion, sampler, (from, next), state)?;
                if sampled && next == to {
                    self.sampled.copy_from_slice(state);
                    sampler.sample(motion, next, &mut self.sampled)?;
                }
                sampler.report(next, watch)?;
            }
            if acted {
                self.method = None;
            }
        }
        Ok(())
    }
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
