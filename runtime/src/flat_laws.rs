//! Laws of contact as code wants them that has them inside: answers to motions as flat numbers, and back. In: motions, memories.
//! Out: wrenches, rates, what a contact is like; their places. Never knows steps.

use std::ops::Range;

use crate::clearance_joint::{Clearance, ClearanceState, Clearances, ContactState};
use crate::contact::{ImpactMemory, Support};
use crate::joint_laws::Response;
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH, Entry, Sizes, TOTALS};

/// Laws with all their constants, in words that are equal for equal laws alone: numbers are written to the last place.
pub(crate) fn in_words(joints: &[Clearance]) -> String {
    format!("{joints:?}")
}

/// Numbers per joint with clearance that laws want besides its motion: how far it is worn [m], on top of its clearance;
/// stiffness K there [N/m^n]; whether it touches (1) and the speed at which its gap closed [m/s], as in
/// [`crate::contact::ImpactMemory`].
pub(crate) const CONTACT_MEMORY: usize = 4;

/// Place of whether it touches among them.
pub(crate) const TOUCHING: usize = 2;

/// Numbers per joint with clearance that tell what a contact is like, besides the rates of its totals: offset (3) [m], penetration
/// [m], its rate [m/s], sliding speed [m/s], energy stored [J], mean pressure [Pa], wrench as [`crate::CONTACT_WRENCH`].
pub(crate) const CONTACT_ANSWER: usize = 8 + CONTACT_WRENCH;

/// Places of penetration and rate among them.
pub(crate) const PENETRATION: [usize; 2] = [3, 4];

/// Places in the answer of a derivative with the laws inside, in order, behind the answer of [`Entry::Derivative`].
#[derive(Clone, Debug)]
pub(crate) struct LawsPlaces {
    /// Rates of the [`TOTALS`] of every joint with clearance.
    pub(crate) totals: Range<usize>,
    /// [`CONTACT_ANSWER`] numbers of every joint.
    pub(crate) contacts: Range<usize>,
    /// Radial clearance of every joint with its wear [m].
    pub(crate) clearances: Range<usize>,
}

impl LawsPlaces {
    pub(crate) fn new(sizes: &Sizes) -> Self {
        let behind = |first: usize, numbers: usize| first..first + numbers * sizes.contacts;
        let totals = behind(sizes.output(Entry::Derivative), TOTALS);
        let contacts = behind(totals.end, CONTACT_ANSWER);
        Self { clearances: behind(contacts.end, 1), totals, contacts }
    }

    /// Length of all.
    pub(crate) fn all(&self) -> usize {
        self.clearances.end
    }
}

/// Hands out places one behind the other.
pub(crate) struct Next(pub(crate) usize);

impl Next {
    pub(crate) fn one(&mut self) -> usize {
        self.some(1).start
    }

    pub(crate) fn some(&mut self, count: usize) -> Range<usize> {
        let start = self.0;
        self.0 += count;
        start..self.0
    }
}

/// Places in the question and in the answer of [`crate::ClassicalStep`], in order.
#[derive(Clone, Debug)]
pub(crate) struct StepPlaces {
    /// Behind the parameters: times of the stages in the middle and at the end [s], length of the step [s].
    pub(crate) middle: usize,
    pub(crate) end: usize,
    pub(crate) length: usize,
    /// The flat state where the step begins, and its slope there.
    pub(crate) y: Range<usize>,
    pub(crate) slope: Range<usize>,
    /// [`CONTACT_MEMORY`] numbers of every joint with clearance; its radial clearance with its wear [m].
    pub(crate) memory: Range<usize>,
    pub(crate) clearances: Range<usize>,
    /// The largest value that each loop pivot has had.
    pub(crate) pivots: Range<usize>,
    /// Factor on how far loops may stay open.
    pub(crate) looseness: usize,
    /// From here on places of the answer, behind that of [`crate::WithLaws::derivative`] at the end: the flat state there, with quaternions
    /// of unit length; its coordinates as the method has them.
    pub(crate) next: Range<usize>,
    pub(crate) raw: Range<usize>,
    /// The slope at the last inner stage.
    pub(crate) last_slope: Range<usize>,
    /// Kinetic and potential energy at the end [J].
    pub(crate) energy: Range<usize>,
    /// How regular the loops are at the last inner stage; the least of all of these, no number if an answer is infinite or none, zero
    /// if a clearance is another one; at the end, where the same is said.
    pub(crate) nearness: usize,
    pub(crate) least_nearness: usize,
    pub(crate) nearness_at_end: usize,
    /// 1 where residuals of positions and speeds are such that nothing has to be moved, else 0.
    pub(crate) is_untouched: usize,
    /// The largest value that each pivot has had after the inner stages.
    pub(crate) grown_pivots: Range<usize>,
    /// Squares of the lengths of the Jacobian's rows at the end.
    pub(crate) row_squares: Range<usize>,
    /// Residuals of all rows at the end.
    pub(crate) residuals: Range<usize>,
}

impl StepPlaces {
    pub(crate) fn new(sizes: &Sizes) -> Self {
        let flat = sizes.flat_state();
        let (mut asked, mut told) = (Next(sizes.parameters), Next(LawsPlaces::new(sizes).all()));
        Self {
            middle: asked.one(),
            end: asked.one(),
            length: asked.one(),
            y: asked.some(flat),
            slope: asked.some(flat),
            memory: asked.some(CONTACT_MEMORY * sizes.contacts),
            clearances: asked.some(sizes.contacts),
            pivots: asked.some(sizes.rows),
            looseness: asked.one(),
            next: told.some(flat),
            raw: told.some(sizes.coordinates),
            last_slope: told.some(flat),
            energy: told.some(sizes.output(Entry::Energy)),
            nearness: told.one(),
            least_nearness: told.one(),
            nearness_at_end: told.one(),
            is_untouched: told.one(),
            grown_pivots: told.some(sizes.rows),
            row_squares: told.some(sizes.rows),
            residuals: told.some(sizes.all_rows),
        }
    }

    /// Length of the question.
    pub(crate) fn question(&self) -> usize {
        self.looseness + 1
    }

    /// Length of the answer.
    pub(crate) fn answer(&self) -> usize {
        self.residuals.end
    }
}

/// The [`CONTACT_MEMORY`] numbers of a joint; `touch`: its contact at any instant of the same wear.
pub(crate) fn contact_memory(state: &ClearanceState, touch: &ContactState) -> [f64; CONTACT_MEMORY] {
    [state.worn, touch.stiffness, state.memory.touching, state.memory.closing_speed]
}

/// Writes them for all joints, one behind the other.
pub(crate) fn write_memories(memories: &mut [f64], clearances: &Clearances) {
    let joints = clearances.states().iter().zip(clearances.contacts());
    for (memory, (state, touch)) in memories.as_chunks_mut().0.iter_mut().zip(joints) {
        *memory = contact_memory(state, touch);
    }
}

/// What a round bearing answers to a motion, by the numbers that a question has of it.
pub(crate) fn round_response<T: Scalar>(
    joint: &Clearance,
    motion: &[T; CONTACT_MOTION],
    memory: [T; CONTACT_MEMORY],
) -> Response<T> {
    let clearance = worn_clearance(motion, &memory);
    let [_, stiffness, touching, closing_speed] = memory;
    let memory = ImpactMemory { touching, closing_speed };
    joint.respond(motion, |offset| Support::round(offset, clearance), (clearance, stiffness), &memory)
}

/// Radial clearance with its wear [m].
pub(crate) fn worn_clearance<T: Scalar>(motion: &[T; CONTACT_MOTION], memory: &[T; CONTACT_MEMORY]) -> T {
    motion[CONTACT_MOTION - 1] + memory[0]
}

/// What a response adds to the totals of its joint in a second.
pub(crate) fn total_rates<T: Scalar>(response: &Response<T>) -> [T; TOTALS] {
    [response.wear_power, response.depth_rate, response.normal_force, response.loss]
}

/// What the contact is like, besides.
pub(crate) fn contact_answer<T: Scalar>(
    joint: &Clearance,
    motion: &[T; CONTACT_MOTION],
    response: &Response<T>,
) -> [T; CONTACT_ANSWER] {
    let [x, y, z] = joint.offset(motion);
    let Response { penetration, penetration_rate, sliding_speed, elastic_energy, pressure, .. } = *response;
    let [fx, fy, fz, mx, my, mz] = response.wrench;
    [x, y, z, penetration, penetration_rate, sliding_speed, elastic_energy, pressure, fx, fy, fz, mx, my, mz]
}

/// The same of a contact that is known.
pub(crate) fn known_answer(touch: &ContactState) -> [f64; CONTACT_ANSWER] {
    let ([x, y, z], [fx, fy, fz, mx, my, mz]) = (touch.offset, touch.wrench);
    let [penetration, rate] = [touch.penetration(), touch.penetration_rate];
    let (speed, energy, pressure) = (touch.sliding_speed, touch.elastic_energy, touch.pressure);
    [x, y, z, penetration, rate, speed, energy, pressure, fx, fy, fz, mx, my, mz]
}

/// The contact as laws tell it alone, by both of its answers; `before`: at another instant of the same wear.
pub(crate) fn contact_state(
    before: &ContactState,
    rates: [f64; TOTALS],
    answer: [f64; CONTACT_ANSWER],
) -> ContactState {
    let [wear_power, depth_rate, normal_force, loss] = rates;
    let [x, y, z, penetration, penetration_rate, sliding_speed, elastic_energy, pressure, wrench @ ..] =
        answer;
    let response = Response {
        penetration,
        penetration_rate,
        normal_force,
        sliding_speed,
        elastic_energy,
        pressure,
        loss,
        wear_power,
        depth_rate,
        // Of wear by angle alone, which runs one trajectory at a time.
        wear_factor: None,
        wrench,
    };
    ContactState::of(([x, y, z], before.turned), (before.clearance, before.stiffness), &response)
}
