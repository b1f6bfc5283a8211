//! What is computed in a step of [`crate::Integrator::Rk43`], and in a derivative with the laws of contact inside, over any scalar:
//! machine code is written by running it on numbers that write down what is done with them. In: answers of entries. Out: ends of
//! steps, errors, derivatives. Never knows machine code.

use super::places::{Conclusion, Places};
use super::{TOTALS, WORKS, is_energy};
use crate::clearance_joint::{Clearance, Clearances};
use crate::contact::Course;
use crate::description::Description;
use crate::error::SetupError;
use crate::flat_laws::{
    CONTACT_ANSWER, CONTACT_MEMORY, LawsPlaces, PENETRATION, StagesPlaces, TOUCHING, contact_answer,
    in_words, round_response, total_rates, worn_clearance,
};
use crate::integrate::{PARTS, error_of, floored, growth_of, relative_error, step_of};
use crate::joint_laws::Response;
use crate::layout::Layout;
use crate::ledger::{Energies, Ledger, Shown, Touched, sum};
use crate::regularity::note_pivots;
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, Entry, Sizes};
use crate::tolerances::tolerances;
use crate::wear::Load;

/// Answers an entry, as [`crate::System::evaluate`] does.
pub type Evaluate<'e, T> = &'e dyn Fn(Entry, &[T]) -> Vec<T>;

/// Part of the square of a row's length that is rounding: nobody asks for more.
const ROUNDED: f64 = 1e-12;

/// What has to be known of a mechanism for its steps.
#[derive(Clone, Debug)]
pub struct StepPlan {
    sizes: Sizes,
    joints: Vec<Clearance>,
    layout: Layout,
    /// Of every kept row, its row among all.
    kept: Vec<usize>,
    /// Of every row, whether it is an angle; of every free speed, whether it turns.
    angular: Vec<bool>,
    turning: Vec<bool>,
    places: Places,
}

/// What the equations say at a state.
struct Slope<T> {
    /// Of the flat state.
    state: Vec<T>,
    /// Multipliers and drive forces.
    forces: Vec<T>,
    pivots: Vec<T>,
    /// What the laws say of every joint, and its [`crate::flat_laws::CONTACT_ANSWER`] numbers.
    responses: Vec<Response<T>>,
    contacts: Vec<T>,
    /// Radial clearance of every joint with its wear [m].
    clearances: Vec<T>,
}

/// What the equations and the laws say at a state.
struct Answer<T> {
    /// The answer of [`Entry::Derivative`].
    equations: Vec<T>,
    /// What the laws say of every joint, and the rates of its [`TOTALS`].
    responses: Vec<Response<T>>,
    totals: Vec<T>,
    /// [`crate::flat_laws::CONTACT_ANSWER`] numbers of every joint.
    contacts: Vec<T>,
    /// Radial clearance of every joint with its wear [m].
    clearances: Vec<T>,
}

impl StepPlan {
    /// Numbers of a contact in the answer of [`Self::derivative`].
    pub const CONTACT_ANSWER: usize = CONTACT_ANSWER;
    /// Places of its penetration and of the rate of that among them.
    pub const PENETRATION: [usize; 2] = PENETRATION;

    /// Of a mechanism with these counts.
    ///
    /// # Errors
    /// [`SetupError::Contact`] if a constant of a law is out of range.
    pub fn new(description: &Description, sizes: Sizes) -> Result<Self, SetupError> {
        Ok(Self {
            sizes,
            joints: Clearances::of(description)?.joints().to_vec(),
            layout: Layout::new(&description.motions),
            kept: description.kept_rows(sizes.rows),
            angular: description.rows.iter().map(|row| row.angular).collect(),
            turning: description.turning_speeds(),
            places: Places::new(&sizes),
        })
    }

    /// The counts of the mechanism.
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// The joints with clearance.
    pub fn joints(&self) -> &[Clearance] {
        &self.joints
    }

    /// The laws of these joints, in words that are equal for equal laws alone.
    pub fn laws(&self) -> String {
        in_words(&self.joints)
    }

    /// Length of the question of [`Self::attempt`].
    pub fn question(&self) -> usize {
        self.places.question()
    }

    /// Length of the question of [`Self::conclude`]: that of an attempt and its answer.
    pub fn arena(&self) -> usize {
        self.places.all
    }

    /// The inner stages of a step, its end before it is put onto the constraints, and whether it has to be.
    pub fn attempt<T: Scalar>(&self, evaluate: Evaluate<'_, T>, question: &[T]) -> Vec<T> {
        let (at, one) = (&self.places, |place: usize| question[place]);
        let (y, length) = (&question[at.y.clone()], one(at.length));
        let mut slopes = vec![question[at.slope.clone()].to_vec()];
        let mut pivots = question[at.pivots.clone()].to_vec();
        let (mut nearness, mut least, mut nothing) = (T::constant(1.0), T::constant(1.0), T::constant(0.0));
        for part in PARTS {
            let factor = T::constant(part) * length;
            let t = if part == 1.0 { one(at.end) } else { one(at.begin) + factor };
            let before = &slopes[slopes.len() - 1];
            let state: Vec<T> = y.iter().zip(before).map(|(y, slope)| *y + factor * *slope).collect();
            let slope = self.slope(evaluate, (question, &question[at.memory.clone()]), t, &state);
            nearness = note_pivots(&slope.pivots, &mut pivots);
            least = T::select(nearness.lt(least), nearness, least);
            nothing = none_of(nothing, &slope.forces);
            slopes.push(slope.state);
        }
        let end = |i: usize| step_of(y[i], length, std::array::from_fn(|stage| slopes[stage][i]));
        let mut next: Vec<T> = (0..y.len()).map(end).collect();
        // Slopes that are infinite or none leave no finite end.
        nothing = none_of(nothing, &next);
        let raw = next[..self.sizes.coordinates].to_vec();
        self.layout.normalize(&mut next);
        let closure = evaluate(Entry::Closure, &self.ask(question, one(at.end), &next));
        let [is_untouched, has_longer_row] = self.judge_loops(question, (&next, &closure), nearness);
        let last_slope = slopes.pop().unwrap_or_default();
        let [metres, radians] = self.open(&closure);
        let flags = vec![nearness, least + nothing, is_untouched, has_longer_row, metres, radians];
        let answer = [next, raw, last_slope, pivots, flags, closure].concat();
        debug_assert_eq!(self.question() + answer.len(), self.arena());
        answer
    }

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
        debug_assert_eq!(answer.len(), Conclusion::new(&self.sizes).all);
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

    /// How far loops are open [m], [rad], by the answer of [`Entry::Closure`]; no number if that is none.
    fn open<T: Scalar>(&self, closure: &[T]) -> [T; 2] {
        let positions = &closure[..self.sizes.all_rows];
        let nothing = none_of(T::constant(0.0), positions);
        [false, true].map(|angular| {
            let rows = self.angular.iter().zip(positions).filter(|(row, _)| **row == angular);
            nothing + rows.fold(T::constant(0.0), |most, (_, residual)| most.max(residual.abs()))
        })
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

    /// Question of an entry of coordinates and speeds.
    fn ask<T: Scalar>(&self, arena: &[T], t: T, state: &[T]) -> Vec<T> {
        let state = &state[..self.sizes.coordinates + self.sizes.speeds];
        [&arena[self.places.parameters.clone()], &[t], state].concat()
    }

    /// The answer of [`Entry::Derivative`] to a state, laws of contact in the middle. Behind it, of all joints with clearance: rates of
    /// the [`TOTALS`] of each; what each contact is like (14: offset (3) [m], penetration [m], its rate [m/s], sliding speed [m/s],
    /// energy stored [J], mean pressure [Pa], wrench as [`crate::CONTACT_WRENCH`]); the radial clearance with its wear of each [m].
    /// In: the question of [`Entry::Contacts`], then of every joint how far it is worn [m], its stiffness [N/m^n], whether it touches
    /// (1), the speed at which its gap closed [m/s].
    pub fn derivative<T: Scalar>(&self, evaluate: Evaluate<'_, T>, question: &[T]) -> Vec<T> {
        let (state, memory) = question.split_at(self.sizes.input(Entry::Contacts));
        let Answer { equations, totals, contacts, clearances, .. } = self.answer(evaluate, state, memory);
        let answer = [equations, totals, contacts, clearances].concat();
        debug_assert_eq!(answer.len(), LawsPlaces::new(&self.sizes).all());
        answer
    }

    /// Stages within a step of the classical Runge-Kutta method: their slopes of the flat state, one behind the other; how regular loops
    /// are at the last one, and the least of all, which is no number if an answer is infinite or none, and zero if a clearance is
    /// another one; the largest pivots then. In: parameters, times in the middle and at the end [s], length of the step [s]; coordinates
    /// and speeds, their slopes; of every joint as [`Self::derivative`] wants it, then its radial clearance with its wear [m] as known;
    /// the largest pivots so far.
    pub fn stages<T: Scalar>(&self, evaluate: Evaluate<'_, T>, question: &[T]) -> Vec<T> {
        let (at, one) = (StagesPlaces::new(&self.sizes), |place: usize| question[place]);
        let (y, memory) = (&question[at.y.clone()], &question[at.memory.clone()]);
        let mut before = question[at.slope.clone()].to_vec();
        let mut pivots = question[at.pivots.clone()].to_vec();
        let (yes, no) = (T::constant(1.0), T::constant(0.0));
        let (mut nearness, mut least, mut nothing) = (yes, yes, no);
        let mut slopes = Vec::with_capacity(at.answer());
        for part in PARTS {
            let factor = T::constant(part) * one(at.length);
            let t = one(if part == 1.0 { at.end } else { at.middle });
            let state: Vec<T> = y.iter().zip(&before).map(|(y, slope)| *y + factor * *slope).collect();
            let slope = self.slope(evaluate, (question, memory), t, &state);
            nearness = note_pivots(&slope.pivots, &mut pivots);
            least = T::select(nearness.lt(least), nearness, least);
            for (now, known) in slope.clearances.iter().zip(&question[at.clearances.clone()]) {
                let at_least = T::select(now.lt(*known), no, least);
                least = T::select(known.lt(*now), no, at_least);
            }
            nothing = none_of(none_of(nothing, &slope.forces), &slope.state[self.sizes.coordinates..]);
            slopes.extend(&slope.state);
            before = slope.state;
        }
        let answer = [slopes, vec![nearness, least + nothing], pivots].concat();
        debug_assert_eq!(answer.len(), at.answer());
        answer
    }

    /// Length of the question of [`Self::stages`].
    pub fn stages_question(&self) -> usize {
        StagesPlaces::new(&self.sizes).question()
    }

    /// Length of the question of [`Self::derivative`].
    pub fn derivative_question(&self) -> usize {
        self.sizes.input(Entry::Contacts) + CONTACT_MEMORY * self.sizes.contacts
    }

    /// What equations and laws say at a state, the question of [`Entry::Contacts`].
    fn answer<T: Scalar>(&self, evaluate: Evaluate<'_, T>, state: &[T], memory: &[T]) -> Answer<T> {
        let moved = evaluate(Entry::Contacts, state);
        let (motions, _) = moved.as_chunks::<CONTACT_MOTION>();
        let (memories, _) = memory.as_chunks();
        let each = self.joints.iter().zip(motions).zip(memories);
        let responses: Vec<_> =
            each.map(|((joint, motion), memory)| round_response(joint, motion, *memory)).collect();
        let wrenches = responses.iter().flat_map(|response| response.wrench).collect();
        let question = [state.to_vec(), wrenches, moved.clone()].concat();
        let each = self.joints.iter().zip(motions).zip(&responses);
        let contacts = each.flat_map(|((joint, motion), response)| contact_answer(joint, motion, response));
        let clearances = motions.iter().zip(memories).map(|(motion, memory)| worn_clearance(motion, memory));
        Answer {
            equations: evaluate(Entry::Derivative, &question),
            contacts: contacts.collect(),
            clearances: clearances.collect(),
            totals: responses.iter().flat_map(total_rates).collect(),
            responses,
        }
    }

    /// The derivative of a flat state, laws of contact in the middle. In: parameters and what may stand behind them, memories.
    fn slope<T: Scalar>(
        &self,
        evaluate: Evaluate<'_, T>,
        (arena, memory): (&[T], &[T]),
        t: T,
        state: &[T],
    ) -> Slope<T> {
        let answer = self.answer(evaluate, &self.ask(arena, t, state), memory);
        let (rates, rest) = answer.equations.split_at(self.sizes.coordinates + self.sizes.speeds);
        let (rest, powers) = rest.split_at(rest.len() - WORKS);
        let (forces, pivots) = rest.split_at(rest.len() - self.sizes.rows);
        Slope {
            state: [rates, powers, &answer.totals].concat(),
            forces: forces.to_vec(),
            pivots: pivots.to_vec(),
            responses: answer.responses,
            contacts: answer.contacts,
            clearances: answer.clearances,
        }
    }

    /// Whether loops are closed such that nothing is moved; whether a row of the Jacobian may be longer than ever.
    fn judge_loops<T: Scalar>(&self, question: &[T], (next, closure): (&[T], &[T]), nearness: T) -> [T; 2] {
        let (yes, no) = (T::constant(1.0), T::constant(0.0));
        let (positions, rest) = closure.split_at(self.sizes.all_rows);
        let (speeds, jacobian) = rest.split_at(self.sizes.rows);
        let (q, v) =
            (&next[..self.sizes.coordinates], &next[self.sizes.coordinates..self.places.scales.len()]);
        let largest = |values: &[T]| values.iter().fold(no, |most, value| most.max(value.abs()));
        let strictness = nearness * question[self.places.looseness];
        let (position, speed) = tolerances(strictness, largest(q), largest(v));
        let residuals = self.kept.iter().map(|row| (positions[*row], position));
        let residuals = residuals.chain(speeds.iter().map(|residual| (*residual, speed)));
        let is_untouched =
            residuals.fold(yes, |closed, (residual, limit)| T::select(limit.lt(residual.abs()), no, closed));
        let rows = jacobian.chunks_exact(self.sizes.speeds.max(1));
        let squares = &question[self.places.row_squares.clone()];
        let longer = rows.zip(squares).fold(no, |longer, (row, most)| {
            let square = row.iter().fold(no, |sum, x| sum + *x * *x);
            T::select((T::constant(1.0 - ROUNDED) * *most).lt(square), yes, longer)
        });
        [is_untouched, longer]
    }
}

/// What a response shows at the end of a step.
fn touched<T: Scalar>(response: &Response<T>) -> Touched<T> {
    let Response { normal_force, penetration, sliding_speed, pressure, .. } = *response;
    Touched { load: Load { normal_force, penetration, sliding_speed }, pressure }
}

/// `nothing`, which is zero, unless a value is infinite or none.
fn none_of<T: Scalar>(nothing: T, values: &[T]) -> T {
    values.iter().fold(nothing, |nothing, value| nothing + T::constant(0.0) * *value)
}
