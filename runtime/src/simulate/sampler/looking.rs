//! Where curves are looked at for their extremes. In: steps, and states within them. Out: extremes of all columns. Never records rows.

use std::f64::consts::PI;

use super::Sampler;
use crate::error::RunError;
use crate::evaluate::Known;
use crate::integrate::Problem;
use crate::simulate::extremes::Collector;
use crate::simulate::looks::Looks;
use crate::simulate::motion::{ConstrainedMotion, PROJECTED_STAGES};
use crate::system::STATES;

/// Times in a turn of the fastest body at which curves are looked at, at least: the peak of a tenth harmonic is then found
/// to a part in a hundred of its size, of the first to a part in ten thousand.
const LOOKS_PER_TURN: f64 = 240.0;
/// Looks in a radian of the fastest vibration, up to so many in a step: its peak is then met to a few ten-thousandths where steps
/// follow it closely, and steps that do not have no more of it to see.
const LOOKS_PER_RADIAN: f64 = 25.0;
const LOOKS_AT_VIBRATION: f64 = 4.0;

/// Looks that are taken one by one before several are taken together.
const LOOKS_ALONE: usize = 500;
/// Looks within one step, at most.
const MOST_LOOKS: f64 = 1000.0;

impl<'a> Sampler<'a> {
    /// Collects the extremes of all columns along the way.
    pub(in crate::simulate) fn collect_extremes(&mut self, motion: &ConstrainedMotion<'a>) {
        // Angles are put on their turns at once, while these are known.
        self.soon = self.angles.is_empty().then(|| (motion.dynamics.evaluator.system(), LOOKS_ALONE));
        let span = (self.schedule.start, self.schedule.end);
        self.extremes = Some(Collector::new(&self.columns.channels, span));
    }

    /// Where within the last step, from `before` to `t`, curves are looked at: nowhere unless the step is long against a
    /// turn. Near a singular position steps are short, and forces off the constraints mean nothing.
    pub(in crate::simulate) fn between(
        &self,
        motion: &ConstrainedMotion<'_>,
        before: f64,
        t: f64,
    ) -> impl Iterator<Item = f64> + use<> {
        let turned = (t - before) * self.ledger.fastest_turning / (2.0 * PI);
        let vibrated = (t - before) * motion.fastest() * LOOKS_PER_RADIAN;
        let looks = (turned * LOOKS_PER_TURN).min(MOST_LOOKS).max(vibrated.min(LOOKS_AT_VIBRATION));
        let asked = self.extremes.is_some() && motion.dynamics.nearness() >= PROJECTED_STAGES;
        let looks = if asked { looks } else { 0.0 };
        let pieces = looks.ceil() as usize;
        (1..pieces).map(move |piece| before + (t - before) * (piece as f64 / pieces as f64))
    }

    /// Looks are taken together once there are many: code for several states is written when it is asked for first.
    fn count_look(&mut self, motion: &ConstrainedMotion<'_>) {
        match self.soon.take() {
            Some((system, 1)) => {
                self.looks = Looks::new(system, &motion.dynamics.evaluator, self.values.len());
            }
            soon => self.soon = soon.map(|(system, more)| (system, more - 1)),
        }
    }

    /// Notes the extremes of all columns at a state of the motion; `known`: what was known of it.
    pub(in crate::simulate) fn look(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (t, state): (f64, &[f64]),
        known: Option<Known>,
    ) -> Result<(), RunError> {
        self.count_look(motion);
        let Some(extremes) = &mut self.extremes else { return Ok(()) };
        if let Some(looks) = &mut self.looks {
            let (q, v, _) = motion.split(state);
            let aside = motion.dynamics.aside();
            let holds = known.map_or(Ok(false), |known| motion.dynamics.accelerate_known(known, (t, q, v)));
            let seen = match holds {
                Ok(false) => motion.dynamics.accelerate(t, q, v),
                seen => seen.map(drop),
            };
            let waits = seen.is_ok() && !motion.dynamics.is_rank_lost();
            if waits {
                looks.look(&mut motion.dynamics.evaluator, (t, q, v), &self.columns, extremes);
            }
            motion.dynamics.resume(aside);
            seen?;
            if waits {
                return Ok(());
            }
            looks.finish(extremes);
        }
        self.observe_aside(motion, t, state)?;
        self.angles.unwrap(t, &mut self.values);
        if let Some(extremes) = &mut self.extremes {
            extremes.note(t, &self.values);
        }
        Ok(())
    }

    /// The same of the first `count` of several flat states within a step: side by side where that gives the same.
    pub(in crate::simulate) fn look_at_several(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (times, count): (&[f64; STATES], usize),
        states: &[[f64; STATES]],
    ) -> Result<(), RunError> {
        let known = self
            .looks
            .as_mut()
            .is_some_and(|looks| looks.evaluate(&mut motion.dynamics.evaluator, times, states));
        for (lane, t) in times.iter().enumerate().take(count) {
            if known
                && let (Some(looks), Some(extremes)) = (&mut self.looks, &mut self.extremes)
                && motion.dynamics.regularity(looks.pivots(lane)) >= PROJECTED_STAGES
            {
                looks.look_at(&motion.dynamics.evaluator, (lane, *t), extremes);
            } else {
                let mut state = std::mem::take(&mut self.inner);
                state.clear();
                state.extend(states.iter().map(|values| values[lane]));
                let seen = self.look(motion, (*t, &state), None);
                self.inner = state;
                seen?;
            }
        }
        Ok(())
    }
}
