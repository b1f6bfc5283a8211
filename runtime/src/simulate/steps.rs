//! Goes through a schedule, step by step. In: a start, a method, times. Out: states and samples at these times. Never knows
//! how a start is found.
//!
//! An adaptive step mostly ends beyond the time that is asked for, and the state there comes from within it. Such a step
//! is open: what follows from its end waits until no earlier time can be asked for.

use super::implicit::Implicit;
use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use super::schedule::steps_between;
use super::settings::Integrator;
use super::{dead_point, events, samples, switches};
use crate::error::RunError;
use crate::integrate::{Adaptive, Dopri5, Method, Rk4, Rk43, Rodas5P, Switching};
use crate::system::STATES;
use crate::watch::Watch;

/// A method under way.
pub(super) struct Steps {
    integrator: Integrator,
    method: Way,
}

/// By which method.
enum Way {
    Rk4 { method: Rk4, t: f64, longest: f64 },
    Adaptive(Box<dyn StepsOfAnyLength>),
    Implicit(Box<Implicit>),
}

/// Adaptive steps by any method, as a schedule asks for them: see the functions of [`Steps`].
trait StepsOfAnyLength: Send {
    fn advance(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        state: &mut [f64],
        wanted: Wanted,
        watch: Watch<'_>,
    ) -> Result<(), RunError>;

    fn cut(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError>;

    fn go_on_from(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError>;

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64));
}

/// Adaptive steps, of which the last one may be open.
struct AdaptiveSteps<M> {
    method: Adaptive<M>,
    open: bool,
    between: Vec<f64>,
}

/// What is asked for: a time, and whether a sample is taken there.
pub(super) type Wanted = (f64, bool);

impl Steps {
    /// Begins a schedule; `sampled`: with a sample at its begin.
    pub(super) fn begin(
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        state: &[f64],
        integrator: Integrator,
        sampled: bool,
    ) -> Result<Self, RunError> {
        let begin = sampler.schedule.begin;
        let method = match integrator {
            Integrator::Rk4 { step } => {
                let seen = sampler.see_start(motion, state, sampled);
                seen.map(|()| Way::Rk4 { method: Rk4::new(state.len()), t: begin, longest: step })
            }
            Integrator::Dopri5 { tolerance, max_step } => {
                AdaptiveSteps::<Dopri5>::begin(motion, sampler, state, ((tolerance, max_step), sampled))
            }
            Integrator::Rodas5P { tolerance, max_step } => {
                motion.judge_modes(begin, state);
                AdaptiveSteps::<Rodas5P>::begin(motion, sampler, state, ((tolerance, max_step), sampled))
            }
            Integrator::Switching { tolerance, max_step } => {
                motion.judge_modes(begin, state);
                let has_modes = motion.dynamics.evaluator.description().modes().next().is_some();
                let begin = if has_modes {
                    AdaptiveSteps::<Switching<true>>::begin
                } else {
                    AdaptiveSteps::<Switching<false>>::begin
                };
                begin(motion, sampler, state, ((tolerance, max_step), sampled))
            }
            Integrator::Rk43 { tolerance, max_step } => {
                let tolerance = Integrator::of_contacts(tolerance);
                motion.loosen(tolerance);
                AdaptiveSteps::<Rk43>::begin(motion, sampler, state, ((tolerance, max_step), sampled))
            }
            Integrator::GeneralizedAlpha { step, rho } => {
                let seen = sampler.see_start(motion, state, sampled);
                seen.map(|()| Way::Implicit(Box::new(Implicit::new(motion, begin, state, (step, rho)))))
            }
        };
        let method = method.map_err(|error| explain(motion, sampler, integrator, error))?;
        Ok(Self { integrator, method })
    }

    /// Goes on to a time, up to which the schedule must reach; `state` is then the one there.
    pub(super) fn advance(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        state: &mut [f64],
        wanted: Wanted,
        watch: Watch<'_>,
    ) -> Result<(), RunError> {
        let outcome = match &mut self.method {
            Way::Rk4 { method, t, longest } => {
                advance_rk4(motion, sampler, (method, t, *longest), state, wanted, watch)
            }
            Way::Adaptive(steps) => steps.advance(motion, sampler, state, wanted, watch),
            Way::Implicit(method) => method.advance(motion, sampler, state, wanted, watch),
        };
        outcome.map_err(|error| explain(motion, sampler, self.integrator, error))
    }

    /// Ends an open step at `t` within it: the motion goes on otherwise from the state there.
    pub(super) fn cut(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        match &mut self.method {
            Way::Adaptive(steps) => steps.cut(motion, sampler, t, state),
            Way::Rk4 { .. } | Way::Implicit(_) => Ok(()),
        }
    }

    /// Goes on from a state whose laws have changed.
    pub(super) fn go_on_from(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        match &mut self.method {
            Way::Adaptive(steps) => steps.go_on_from(motion, t, state),
            Way::Rk4 { t: reached, .. } => {
                *reached = t;
                Ok(())
            }
            Way::Implicit(method) => {
                method.begin_anew(t);
                Ok(())
            }
        }
    }

    /// Shows every number that it stands on, to be read or put back at time `t`.
    pub(super) fn visit_memory(&mut self, t: f64, visit: &mut dyn FnMut(&mut f64)) {
        match &mut self.method {
            Way::Adaptive(steps) => steps.visit_memory(visit),
            Way::Rk4 { t: reached, .. } => *reached = t,
            Way::Implicit(method) => method.begin_anew(t),
        }
    }
}

/// Runs a schedule to its end with a method, without samples; `state` is then where it got.
pub(super) fn run(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    state: &mut [f64],
    integrator: Integrator,
    watch: Watch<'_>,
) -> Result<(), RunError> {
    let mut steps = Steps::begin(motion, sampler, state, integrator, false)?;
    steps.advance(motion, sampler, state, (sampler.schedule.end, false), watch)
}

/// Why a run failed, by where it had got.
fn explain(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &Sampler<'_>,
    integrator: Integrator,
    error: RunError,
) -> RunError {
    let (t, reached) = &sampler.reached;
    let q = motion.split(reached).0.to_vec();
    sampler.passages.explain(integrator, dead_point::explain(motion, (*t, &q), error))
}

/// Equal steps no longer than asked for, that land on every time asked for.
fn advance_rk4(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    (method, t, longest): (&mut Rk4, &mut f64, f64),
    state: &mut [f64],
    (to, sampled): Wanted,
    watch: Watch<'_>,
) -> Result<(), RunError> {
    while *t < to {
        let stop = to.min(sampler.hard_stop(*t));
        let target = motion.dynamics.evaluator.stop_at_sample(*t, stop);
        let (from, steps) = (*t, steps_between(*t, target, longest));
        for i in 1..=steps {
            let next = if i == steps { target } else { from + (target - from) * (i as f64 / steps as f64) };
            method.step(motion, *t, state, next - *t)?;
            *t = next;
            sampler.note_loop_error(motion, *t, motion.projector.loop_error())?;
            sampler.follow_angles(motion, *t, state, None)?;
            sampler.step_done(motion, *t, state)?;
            if i == steps {
                samples::act_behind(motion, sampler, (from, *t), state)?;
            }
            if sampled && *t == to {
                sampler.sample(motion, *t, state)?;
            }
            sampler.report(*t, watch)?;
        }
    }
    Ok(())
}

/// Where the next step ends at the latest: no step leaps over a kink of an input, or a sample of a controller.
fn stop_at_kink(motion: &ConstrainedMotion<'_>, sampler: &Sampler<'_>, t: f64) -> f64 {
    let stop = motion.dynamics.evaluator.stop_at_sample(t, sampler.hard_stop(t));
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
    ((tolerance, longest), sampled): ((f64, Option<f64>), bool),
) -> Result<Adaptive<M>, RunError> {
    let longest = longest.unwrap_or(sampler.duration() / 10.0);
    let span = (sampler.schedule.begin, sampler.schedule.end);
    sampler.see_start(motion, state, sampled)?;
    Adaptive::start(motion, span, state, tolerance, longest)
}

/// Notes what the inside of a step shows, once it ends where a gap closes.
pub(super) fn look_back<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    method: &Adaptive<M>,
) -> Result<(), RunError> {
    sampler.note_loop_error(motion, method.t(), motion.projector.loop_error())?;
    sampler.follow_angles(motion, method.t(), method.y(), Some(&|t, y| method.interpolate(t, y)))?;
    let mut states = std::mem::take(&mut sampler.within);
    states.resize(method.y().len(), [0.0; STATES]);
    let mut inner = sampler.between(motion, method.before(), method.t());
    while let Some(first) = inner.next() {
        // Places without a look repeat the first, and nobody reads what they give.
        let (mut times, mut count) = ([first; STATES], 1);
        for (time, t) in times[1..].iter_mut().zip(inner.by_ref()) {
            *time = t;
            count += 1;
        }
        method.interpolate_several(times, &mut states);
        sampler.look_at_several(motion, (&times, count), &states)?;
    }
    sampler.within = states;
    Ok(())
}

impl<M: Method + Send + 'static> AdaptiveSteps<M> {
    fn begin(
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        state: &[f64],
        settings: ((f64, Option<f64>), bool),
    ) -> Result<Way, RunError> {
        let method = begin_adaptive(motion, sampler, state, settings)?;
        Ok(Way::Adaptive(Box::new(Self { method, open: false, between: state.to_vec() })))
    }
}

impl<M: Method + Send> StepsOfAnyLength for AdaptiveSteps<M> {
    fn advance(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        state: &mut [f64],
        (to, sampled): Wanted,
        watch: Watch<'_>,
    ) -> Result<(), RunError> {
        let Self { method, open, between } = self;
        loop {
            // A row at a sample is behind it, however the time of either is rounded.
            let to = if motion.dynamics.evaluator.is_same_time(method.t(), to) { method.t() } else { to };
            if *open && to < method.t() {
                method.interpolate(to, state);
                return if sampled { sampler.sample(motion, to, state) } else { Ok(()) };
            }
            if *open {
                *open = false;
                sampler.step_done(motion, method.t(), method.y())?;
                state.copy_from_slice(method.y());
                if samples::act_behind(motion, sampler, (method.before(), method.t()), state)? {
                    method.go_on_from(motion, method.t(), state)?;
                }
                if sampled && to == method.t() {
                    sampler.sample(motion, to, state)?;
                }
                sampler.report(method.t(), watch)?;
                if sampled && to == method.t() {
                    return Ok(());
                }
            }
            if to <= method.t() {
                state.copy_from_slice(method.y());
                return if sampled { sampler.sample(motion, to, state) } else { Ok(()) };
            }
            let stop = stop_at_kink(motion, sampler, method.t());
            switches::cross(motion, method, stop, between)?;
            if to <= method.t() {
                continue;
            }
            let stop = switches::stop_in_time(motion, method, stop, between);
            let outcome = method.step(motion, stop);
            sampler.statistics.rejected = method.rejected();
            sampler.statistics.implicit_steps = method.implicit_steps();
            outcome?;
            events::stop_at_contact(motion, sampler, method, between)?;
            if switches::stop_at_switch(motion, sampler, method, between)? {
                // A shorter step is another motion, in which a gap may close that stayed open.
                events::stop_at_contact(motion, sampler, method, between)?;
            }
            look_back(motion, sampler, method)?;
            *open = true;
        }
    }

    fn cut(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        if std::mem::take(&mut self.open) { sampler.cut(motion, t, state) } else { Ok(()) }
    }

    fn go_on_from(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        self.method.go_on_from(motion, t, state)
    }

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let mut open = f64::from(u8::from(self.open));
        visit(&mut open);
        self.open = open != 0.0;
        self.method.visit_memory(visit);
    }
}
