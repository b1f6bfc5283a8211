//! The end of a step side by side with others: what is there, how large the error is, whether anything happened, over any scalar. In: an
//! arena. Out: its [`super::Conclusion`]. Never knows machine code.

use super::plan::{Evaluate, StepPlan, none_of};
use super::slope::Slope;
use super::{TOTALS, WORKS, is_energy};
use crate::contact::Course;
use crate::flat_laws::{CONTACT_ANSWER, CONTACT_MEMORY, PENETRATION, TOUCHING};
use crate::integrate::{error_of, floored, growth_of, relative_error};
use crate::joint_laws::Response;
use crate::ledger::{Energies, Ledger, Shown, Touched, sum};
use crate::regularity::note_pivots;
use crate::scalar::Scalar;
use crate::system::Entry;
use crate::wear::Load;

impl StepPlan {
    /// What is at the end of a step, and how large its error is.
    pub fn conclude<T: Scalar>(&self, evaluate: Evaluate<'_, T>, arena: &[T]) -> Vec<T> {
        let (at, one) = (&self.places, |place: usize| arena[place]);
        let (y, next, t) = (&arena[at.y.clone()], &arena[at.next.clone()], one(at.end));
        let slope = self.slope(evaluate, (arena, &arena[at.memory.clone()]), t, next);
        let energy = evaluate(Entry::Energy, &self.ask(arena, t, next));
        let mut pivots = arena[at.grown_pivots.clone()].to_vec();
        let nearness = note_pivots(&slope.pivots, &mut pivots);
        let nothing = none_of(T::constant(0.0), &slope.state[self.sizes.coordinates..]);
        let nothing = none_of(nothing, &slope.forces);
        let (yes, no) = (T::constant(1.0), T::constant(0.0));
        let before = &arena[at.pivots.clone()];
        let has_grown = before
            .iter()
            .zip(&pivots)
            .fold(no, |grown, (before, now)| T::select(before.lt(*now), yes, grown));
        let last = &arena[at.last_slope.clone()];
        let mut error = no;
        for i in 0..y.len() {
            let Some(scale) = self.scale(i) else { continue };
            let per_second = error_of(last[i], slope.state[i]);
            let own = relative_error(
                (y[i], next[i], arena[scale]),
                (one(at.length), per_second),
                one(at.tolerance),
            );
            error = T::select(error.lt(own), own, error);
        }
        let growth = growth_of(one(at.last_error), floored(error));
        let mut ledger = self.ledger(arena, (&slope, &energy));
        let is_quiet = self.is_quiet(arena, &slope, &ledger);
        let mut flags = vec![has_grown, nearness + nothing, one(at.energy_scale).max(energy[0])];
        ledger.visit(&mut |number| flags.push(*number));
        flags.extend([is_quiet, error, growth]);
        let answer = [slope.state, slope.contacts, energy, pivots, flags].concat();
        debug_assert_eq!(self.conclude_question() + answer.len(), self.arena());
        answer
    }

    /// Place of the natural size of a number of a flat state; none if it is not judged.
    fn scale(&self, index: usize) -> Option<usize> {
        let Some(integral) = index.checked_sub(self.places.scales.len()) else {
            return Some(self.places.scales.start + index);
        };
        let judged = integral.checked_sub(WORKS).is_none_or(|integral| is_energy(integral % TOTALS));
        judged.then_some(self.places.energy_scale)
    }

    /// What the trajectory has added up, if the step counts.
    fn ledger<T: Scalar>(&self, arena: &[T], (slope, energy): (&Slope<T>, &[T])) -> Ledger<T> {
        let (at, one) = (&self.places, |place: usize| arena[place]);
        let (speeds, integrals) =
            arena[at.next.clone()][self.sizes.coordinates..].split_at(self.sizes.speeds);
        let losses = integrals[WORKS..].chunks_exact(TOTALS).map(|totals| totals[TOTALS - 1]);
        let energies = Energies {
            kinetic: energy[0],
            potential: energy[1],
            supplied: integrals[0],
            dissipated: integrals[1],
            elastic: sum(slope.responses.iter().map(|response| response.elastic_energy)),
            contact_loss: sum(losses),
        };
        let length = one(at.end) - one(at.begin);
        let mut ledger = Ledger::of(&arena[at.ledger.clone()], self.sizes.contacts);
        ledger.note_open(at.open.map(one));
        let shown = Shown { t: one(at.end), length, energies, speeds, turning: &self.turning };
        ledger.note_step(&shown, slope.responses.iter().map(touched));
        ledger
    }

    /// 1 where nothing happened that a trajectory would have to look at, else 0.
    fn is_quiet<T: Scalar>(&self, arena: &[T], slope: &Slope<T>, ledger: &Ledger<T>) -> T {
        let (yes, no) = (T::constant(1.0), T::constant(0.0));
        let (at, length) = (&self.places, arena[self.places.end] - arena[self.places.begin]);
        let mut loud = no;
        for (joint, response) in slope.responses.iter().enumerate() {
            let end = (response.penetration, response.penetration_rate);
            let [penetration, rate] =
                PENETRATION.map(|place| arena[at.touches.start + CONTACT_ANSWER * joint + place]);
            let touching = arena[at.memory.start + CONTACT_MEMORY * joint + TOUCHING];
            loud = loud.max(Course::new((penetration, rate), end, length).may_change(touching));
            loud = T::select(arena[at.watched.start + joint].lt(end.0), yes, loud);
        }
        // Energies that are infinite or none are no reason to go on.
        let sound = none_of(no, &[ledger.balance.throughput]).lt(yes);
        T::select(sound, yes - loud, no)
    }
}

/// What a response shows at the end of a step.
fn touched<T: Scalar>(response: &Response<T>) -> Touched<T> {
    let Response { normal_force, penetration, sliding_speed, pressure, .. } = *response;
    Touched { load: Load { normal_force, penetration, sliding_speed }, pressure }
}
