//! Where the journals of a turn stand, and how they are put elsewhere. In: a runner between two turns. Out: places, or the same runner
//! with its journals displaced. Never knows what for.

use super::TurnRunner;
use crate::assemble::place_moving;
use crate::simulate::Integrator;
use crate::system::CONTACT_MOTION;

/// One direction in which a journal is free.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Offset [m] and its rate [m/s].
    pub offset: f64,
    pub rate: f64,
    /// Radial clearance [m].
    pub clearance: f64,
}

impl TurnRunner<'_> {
    /// Goes on by another method; the one before.
    pub(crate) const fn go_by(&mut self, integrator: Integrator) -> Integrator {
        core::mem::replace(&mut self.integrator, integrator)
    }

    /// The method.
    pub(crate) const fn method(&self) -> Integrator {
        self.integrator
    }

    /// Where all journals stand, axis by axis.
    pub(crate) fn journals(&mut self) -> Vec<Place> {
        let evaluator = &mut self.motion.dynamics.evaluator;
        let motions = evaluator.contact_motion(self.t, &self.state.q, &self.state.v).to_vec();
        evaluator.evaluate_contacts(self.t, &self.state.q, &self.state.v);
        let clearances = evaluator.clearances();
        let each = motions.as_chunks::<CONTACT_MOTION>().0.iter().zip(clearances.joints());
        let places = each.zip(clearances.contacts()).flat_map(|((motion, law), touch)| {
            let clearance = touch.clearance;
            let at = move |axis: usize| Place { offset: motion[axis], rate: motion[3 + axis], clearance };
            (0..law.freedoms()).map(at)
        });
        places.collect()
    }

    /// Displaces journals from where they stand by offsets [m] and rates [m/s], in the same order; whether loops let them.
    pub(crate) fn displace(&mut self, by: &[[f64; 2]]) -> bool {
        let evaluator = &mut self.motion.dynamics.evaluator;
        let motions = evaluator.contact_motion(self.t, &self.state.q, &self.state.v).to_vec();
        let mut by = by.iter();
        let (mut targets, mut rates) = (Vec::new(), Vec::new());
        for (motion, law) in
            motions.as_chunks::<CONTACT_MOTION>().0.iter().zip(evaluator.clearances().joints())
        {
            let [mut offset, mut rate] =
                [0, 3].map(|from| [motion[from], motion[from + 1], motion[from + 2]]);
            for (axis, [to, faster]) in (0..law.freedoms()).zip(&mut by) {
                offset[axis] += to;
                rate[axis] += faster;
            }
            targets.push(Some(offset));
            rates.push(rate);
        }
        let placed = place_moving(evaluator, self.t, &mut self.state, (&targets, &rates));
        self.motion.learn_sizes(self.t, &self.state);
        placed
    }
}
