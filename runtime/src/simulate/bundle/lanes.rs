//! What the lanes of a bundle have in common: their steps, told where they begin, read where they end.
//! In: lengths of steps. Out: ends of steps, their errors, which lanes are still ordinary. Never knows turns.

use std::ops::Range;

use super::room::Room;
use crate::bundle::{Bundle, Conclusion, Places};
use crate::clearance_joint::{Clearances, ContactState};
use crate::dynamics::Dynamics;
use crate::evaluate::Evaluator;
use crate::flat_laws::{CONTACT_ANSWER, CONTACT_MEMORY, contact_memory, contact_state, known_answer};
use crate::ledger::Ledger;
use crate::simulate::motion::{ConstrainedMotion, PROJECTED_STAGES};
use crate::simulate::sampler::Sampler;
use crate::system::Sizes;

/// Of the numbers that a contact remembers, so many stay the same in a turn: how far it is worn, stiffness.
const STEADY: usize = 2;

/// Steps that are tried, one in each lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps<const N: usize> {
    /// Where they begin [s].
    pub(super) begins: [f64; N],
    /// Their lengths [s]; zero in lanes without a turn.
    pub(super) lengths: [f64; N],
    /// Where they end [s].
    pub(super) ends: [f64; N],
    /// Lanes that had nothing but regular positions and finite numbers.
    pub(super) ordinary: [bool; N],
}

/// Where the steps of all lanes are computed.
pub(super) struct Lanes<'a, const N: usize> {
    bundle: &'a dyn Bundle<N>,
    pub(super) sizes: Sizes,
    places: Places,
    /// See [`Bundle`].
    arena: Room<N>,
    workspace: Room<N>,
    /// Whether a lane has put the end of its step elsewhere since all were tried.
    has_moved: bool,
}

impl<'a, const N: usize> Lanes<'a, N> {
    pub(super) fn new(bundle: &'a dyn Bundle<N>, parameters: &[f64]) -> Self {
        let sizes = bundle.sizes();
        let places = Places::new(&sizes);
        let mut arena = Room::new(places.conclusion.all);
        (0..N).for_each(|lane| arena.put(lane, places.parameters.start, parameters));
        Self { bundle, sizes, arena, workspace: Room::new(bundle.workspace()), places, has_moved: false }
    }

    /// Takes over where a trajectory is: its state, and the slope there.
    pub(super) fn put_state(&mut self, lane: usize, y: &[f64], slope: &[f64]) {
        self.arena.put(lane, self.places.y.start, y);
        self.arena.put(lane, self.places.slope.start, slope);
    }

    /// Takes over what stays the same in a turn.
    pub(super) fn put_settings(&mut self, lane: usize, motion: &ConstrainedMotion<'_>, tolerance: f64) {
        self.arena.put(lane, self.places.looseness, &[motion.looseness()]);
        self.arena.put(lane, self.places.tolerance, &[tolerance]);
        self.arena.put(lane, self.places.scales.start, motion.state_scales());
        self.put_memories(lane, motion.dynamics.evaluator.clearances(), 0..STEADY);
    }

    /// These of the numbers that contacts remember.
    fn put_memories(&mut self, lane: usize, clearances: &Clearances, numbers: Range<usize>) {
        let joints = clearances.states().iter().zip(clearances.contacts());
        for (joint, (state, touch)) in joints.enumerate() {
            let place = self.places.memory.start + CONTACT_MEMORY * joint + numbers.start;
            self.arena.put(lane, place, &contact_memory(state, touch)[numbers.clone()]);
        }
    }

    /// Takes over what steps change beside the state: what contacts remember, what they are like, up to where nobody looks at them,
    /// how large energies are, what the run has added up.
    pub(super) fn put_progress(
        &mut self,
        lane: usize,
        motion: &ConstrainedMotion<'_>,
        sampler: &mut Sampler<'_>,
    ) {
        let clearances = motion.dynamics.evaluator.clearances();
        self.put_memories(lane, clearances, STEADY..CONTACT_MEMORY);
        let Self { places, arena, .. } = self;
        for (joint, touch) in sampler.contacts().iter().enumerate() {
            arena.put(lane, places.touches.start + CONTACT_ANSWER * joint, &known_answer(touch));
        }
        let all = arena.all_mut();
        all[places.energy_scale][lane] = motion.energy_scale;
        for (place, depth) in places.watched.clone().zip(sampler.watched(clearances)) {
            all[place][lane] = depth;
        }
        let mut numbers = all[places.ledger.clone()].iter_mut();
        sampler
            .ledger
            .visit(&mut |number| numbers.next().into_iter().for_each(|place| place[lane] = *number));
    }

    /// Takes over the error of the last step that counted.
    pub(super) fn put_last_error(&mut self, lane: usize, last_error: f64) {
        self.arena.all_mut()[self.places.last_error][lane] = last_error;
    }

    /// How large energies of a lane are [J].
    pub(super) fn energy_scale(&self, lane: usize) -> f64 {
        self.arena.all()[self.places.energy_scale][lane]
    }

    /// What the run of a lane has added up.
    pub(super) fn read_ledger(&self, lane: usize, ledger: &mut Ledger<f64>) {
        let mut numbers = self.arena.all()[self.places.ledger.clone()].iter();
        ledger.visit(&mut |number| numbers.next().into_iter().for_each(|place| *number = place[lane]));
    }

    /// Takes over the largest pivots so far.
    pub(super) fn put_pivots(&mut self, lane: usize, dynamics: &Dynamics<'_>) {
        self.arena.put(lane, self.places.pivots.start, dynamics.largest_pivots());
    }

    /// Takes over how long rows of the Jacobian have been.
    pub(super) fn put_row_squares(&mut self, lane: usize, evaluator: &Evaluator<'_>) {
        let squares = &mut self.arena.all_mut()[self.places.row_squares.clone()];
        for (place, square) in squares.iter_mut().zip(evaluator.rows().squares()) {
            place[lane] = *square;
        }
    }

    /// Numbers of a lane in the arena, from a place on.
    pub(super) fn get(&self, lane: usize, from: usize, numbers: &mut [f64]) {
        self.arena.get(lane, from, numbers);
    }

    /// What the places in the arena are.
    pub(super) fn places(&self) -> &Places {
        &self.places
    }

    /// How far loops of a lane are open at the end of its step [m], [rad].
    pub(super) fn open(&self, lane: usize) -> [f64; 2] {
        self.places.open.map(|place| self.arena.all()[place][lane])
    }

    /// Whether nothing happened in a lane's step that its trajectory would have to look at.
    pub(super) fn is_quiet(&self, lane: usize) -> bool {
        self.arena.all()[self.places.conclusion.is_quiet][lane] == 1.0
    }

    /// Whether nothing has to be moved at the end of a lane's step, as far as kept rows and speeds tell.
    pub(super) fn is_untouched(&self, lane: usize) -> bool {
        self.arena.all()[self.places.is_untouched][lane] == 1.0
    }

    /// How regular the loops were at the last inner stage of a lane.
    pub(super) fn nearness(&self, lane: usize) -> f64 {
        self.arena.all()[self.places.nearness][lane]
    }

    /// How regular they are at the end of its step.
    pub(super) fn nearness_at_end(&self, lane: usize) -> f64 {
        self.arena.all()[self.places.conclusion.nearness][lane]
    }

    /// Whether a row of its Jacobian there is longer than ever.
    pub(super) fn has_longer_row(&self, lane: usize) -> bool {
        self.arena.all()[self.places.has_longer_row][lane] == 1.0
    }

    /// Squares of the lengths of that Jacobian's rows.
    pub(super) fn squares_at_end(&self, lane: usize) -> impl Iterator<Item = f64> {
        self.arena.all()[self.places.squares_at_end.clone()].iter().map(move |value| value[lane])
    }

    /// The end of a lane's step is another one.
    pub(super) fn put_end(&mut self, lane: usize, next: &[f64]) {
        self.arena.put(lane, self.places.next.start, next);
        self.has_moved = true;
    }

    /// The end of a lane's step before quaternions got their unit length.
    pub(super) fn raw_end(&self, lane: usize, next: &mut [f64]) {
        self.get(lane, self.places.next.start, next);
        self.get(lane, self.places.raw.start, &mut next[..self.sizes.coordinates]);
    }

    /// Slopes of a lane at both ends of its step.
    pub(super) fn slopes(&self, lane: usize, [begin, end]: [&mut [f64]; 2]) {
        self.arena.get(lane, self.places.slope.start, begin);
        self.arena.get(lane, self.places.conclusion.slope.start, end);
    }

    /// Kinetic and potential energy of a lane at the end of its step [J].
    pub(super) fn energy(&self, lane: usize) -> (f64, f64) {
        let energy = &self.arena.all()[self.places.conclusion.energy.clone()];
        (energy[0][lane], energy[1][lane])
    }

    /// A contact of a lane at the end of its step, by what it was at another instant.
    pub(super) fn contact(&self, lane: usize, joint: usize, before: &ContactState) -> ContactState {
        let Conclusion { slope, contacts, .. } = &self.places.conclusion;
        self.contact_in((slope, contacts), (lane, joint), before)
    }

    /// The same at the beginning of its step.
    pub(super) fn contact_before(&self, lane: usize, joint: usize, before: &ContactState) -> ContactState {
        let Places { slope, touches, .. } = &self.places;
        self.contact_in((slope, touches), (lane, joint), before)
    }

    fn contact_in(
        &self,
        (slope, contacts): (&Range<usize>, &Range<usize>),
        (lane, joint): (usize, usize),
        before: &ContactState,
    ) -> ContactState {
        let numbers = self.arena.all();
        let totals = slope.start + Conclusion::totals(&self.sizes, joint);
        let contact = contacts.start + CONTACT_ANSWER * joint;
        let rates = std::array::from_fn(|at| numbers[totals + at][lane]);
        contact_state(before, rates, std::array::from_fn(|at| numbers[contact + at][lane]))
    }

    /// The largest pivots of a lane, if they have grown in its step.
    pub(super) fn grown_pivots(&self, lane: usize) -> Option<Vec<f64>> {
        let (all, at) = (self.arena.all(), &self.places.conclusion);
        let pivots = &all[at.pivots.clone()];
        (all[at.has_grown][lane] == 1.0).then(|| pivots.iter().map(|all| all[lane]).collect())
    }

    /// The error of a lane's step, 1 just accepted, and by how much the next one may be longer.
    pub(super) fn error(&self, lane: usize) -> (f64, f64) {
        let (all, at) = (self.arena.all(), &self.places.conclusion);
        (all[at.error][lane], all[at.growth][lane])
    }

    /// Tries steps, as if none of their ends had to be put onto the constraints.
    pub(super) fn step(&mut self, steps: &mut Steps<N>) {
        let Self { places, arena, .. } = self;
        let all = arena.all_mut();
        (all[places.begin], all[places.length], all[places.end]) = (steps.begins, steps.lengths, steps.ends);
        let (question, answer) = all.split_at_mut(places.question());
        self.bundle.step(question, answer, self.workspace.all_mut());
        judge(steps, &arena.all()[places.least_nearness]);
    }

    /// What is at the ends of the steps, and their errors: those that have been put elsewhere are looked at once more.
    pub(super) fn conclude(&mut self, steps: &mut Steps<N>) {
        let Self { places: Places { pivots, conclusion, .. }, arena, .. } = self;
        if std::mem::take(&mut self.has_moved) {
            let (question, answer) = arena.all_mut().split_at_mut(conclusion.start());
            self.bundle.conclude(question, answer, self.workspace.all_mut());
        }
        judge(steps, &arena.all()[conclusion.nearness]);
        arena.all_mut().copy_within(conclusion.pivots.clone(), pivots.start);
    }

    /// The steps of these lanes count: the next ones begin at their ends.
    pub(super) fn accept(&mut self, accepted: &[bool; N]) {
        let Self { places, arena, .. } = self;
        let places = &*places;
        let Places { y, slope, touches, ledger, energy_scale, conclusion, .. } = places;
        let first = places.question();
        let (question, found) = arena.all_mut().split_at_mut(first);
        let answers = [
            (y.start, &places.next),
            (slope.start, &conclusion.slope),
            (touches.start, &conclusion.contacts),
            (ledger.start, &conclusion.ledger),
            (*energy_scale, &(conclusion.energy_scale..conclusion.energy_scale + 1)),
        ];
        for (place, at) in answers {
            choose(&mut question[place..][..at.len()], &found[at.start - first..][..at.len()], accepted);
        }
    }
}

/// Lanes without a regularity, or with one that is too small, are no longer ordinary.
fn judge<const N: usize>(steps: &mut Steps<N>, nearness: &[f64; N]) {
    for (ordinary, nearness) in steps.ordinary.iter_mut().zip(nearness) {
        *ordinary &= *nearness >= PROJECTED_STAGES;
    }
}

fn choose<const N: usize>(values: &mut [[f64; N]], others: &[[f64; N]], chosen: &[bool; N]) {
    if chosen.iter().all(|chosen| *chosen) {
        values.copy_from_slice(others);
        return;
    }
    let masks = chosen.map(|chosen| if chosen { u64::MAX } else { 0 });
    for (value, other) in values.iter_mut().zip(others) {
        for lane in 0..N {
            let kept = value[lane].to_bits() & !masks[lane];
            value[lane] = f64::from_bits(kept | other[lane].to_bits() & masks[lane]);
        }
    }
}
