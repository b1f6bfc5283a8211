//! A turn in steps of one length, with tangents along several directions. In: where it begins and how that varies. Out: what the joints
//! wear and how that varies. Never knows parameters or lives.
//!
//! The classical Runge-Kutta method, and the end of the turn put onto the constraints: a smooth function of all that varies, but where a
//! gap closes at the very end of a step. Its tangents are exact but for rounding.

use linkwear_codegen::tape::Tape;
use linkwear_runtime::contact::crossing_speed;
use linkwear_runtime::{Dual, Layout, Scalar, Sizes};

use super::function::Function;
use super::roots::SMOOTH;
use super::tangents::Varied;
use super::varied::{ANSWER, MEMORY};
use super::worn::{Part, Step, Wear};

/// What varies along the directions of all lanes.
#[derive(Clone, Debug)]
pub(super) struct Directions<const N: usize> {
    /// Inputs of the motion that are the same all along: parameters, then lifted constants.
    pub parameters: Vec<Varied<N>>,
    pub motion_constants: Vec<Varied<N>>,
    pub closure_constants: Vec<Varied<N>>,
    /// How long a turn lasts [s].
    pub period: Varied<N>,
}

/// Where a motion is, with its tangents.
#[derive(Clone, Debug)]
pub(super) struct State<const N: usize> {
    /// Time [s].
    pub t: f64,
    /// Coordinates and speeds.
    pub flat: Vec<Varied<N>>,
    /// What contacts remember.
    pub contacts: Vec<Touch<N>>,
}

/// A contact from step to step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch<const N: usize> {
    /// Whether the bodies touch, and at which speed their gap closed [m/s].
    pub is_touching: bool,
    pub closing_speed: Varied<N>,
    /// Penetration [m] and its rate [m/s] at the begin of the last step, if there was one.
    pub before: Option<[Varied<N>; 2]>,
}

/// What a turn did.
#[derive(Clone, Debug)]
pub(super) struct Turned<const N: usize> {
    /// Per joint with clearance: wear integral [J], depth [m].
    pub wear: Vec<[Varied<N>; 2]>,
    /// How often bodies came apart.
    pub losses: u32,
}

/// Steps that one is made in where what wears begins, ends or changes fast: derivatives jump there.
const SHORTER: u32 = 32;

/// Why a turn cannot be made in these steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooLong;

/// Turns of a mechanism.
pub(super) struct Turns<const N: usize> {
    motion: Function<N>,
    pub(super) closure: Function<N>,
    pub(super) sizes: Sizes,
    pub(super) layout: Layout,
    /// Of every kept row, its row among all.
    pub(super) kept: Vec<usize>,
    period: Varied<N>,
}

impl<const N: usize> Turns<N> {
    /// Of tapes with their lifted constants behind their inputs.
    pub(super) fn new(
        [motion, closure]: [&Tape; 2],
        sizes: Sizes,
        (layout, kept): (Layout, Vec<usize>),
        directions: &Directions<N>,
    ) -> Self {
        let (mut motion, mut closure) = (Function::new(motion), Function::new(closure));
        let state = sizes.coordinates + sizes.speeds;
        let (of_motion, of_closure) =
            (sizes.parameters + 1 + state + MEMORY * sizes.contacts, sizes.parameters + 1 + state);
        let put = |function: &mut Function<N>, first: usize, all: &[Varied<N>]| {
            for (place, one) in (first..).zip(all) {
                function.put(place, one.value);
                function.put_tangent(place, one.tangents);
            }
        };
        for function in [&mut motion, &mut closure] {
            put(function, 0, &directions.parameters);
        }
        put(&mut motion, of_motion, &directions.motion_constants);
        put(&mut closure, of_closure, &directions.closure_constants);
        Self { motion, closure, sizes, layout, kept, period: directions.period }
    }

    /// How worn the joints are [m].
    pub(super) fn wear(&mut self, worn: impl Iterator<Item = f64>) {
        let first = self.memory();
        for (joint, worn) in worn.enumerate() {
            self.motion.put(first + MEMORY * joint, worn);
        }
    }

    /// Place of what contacts remember among the inputs of the motion.
    fn memory(&self) -> usize {
        self.sizes.parameters + 1 + self.sizes.coordinates + self.sizes.speeds
    }

    /// Runs a turn.
    pub(super) fn run(&mut self, state: &mut State<N>, steps: u64) -> Result<Turned<N>, TooLong> {
        let whole = Part { of_turn: 1.0 / steps as f64, of_step: 1.0 };
        let fine = Part { of_turn: whole.of_turn / SHORTER as f64, of_step: 1.0 / SHORTER as f64 };
        let mut wear = Wear::new(self.sizes.contacts);
        let (begin, mut losses) = (state.t / self.period.value, 0);
        self.remember(&state.contacts);
        let mut kept = state.clone();
        for step in 0..steps {
            kept.flat.copy_from_slice(&state.flat);
            kept.contacts.copy_from_slice(&state.contacts);
            let at = begin + step as f64 * whole.of_turn;
            let mut did = self.step(at, whole, state);
            if did.is_rough {
                state.flat.copy_from_slice(&kept.flat);
                state.contacts.copy_from_slice(&kept.contacts);
                self.remember(&state.contacts);
                for part in 0..SHORTER {
                    did = self.step(at + part as f64 * fine.of_turn, fine, state);
                    losses += did.losses;
                    wear.add(&did, fine);
                }
            } else {
                losses += did.losses;
                wear.add(&did, whole);
            }
            if !state.flat.iter().all(|one| one.value.is_finite()) {
                return Err(TooLong);
            }
        }
        let end = self.time(begin + 1.0);
        self.close(end, &mut state.flat)?;
        state.t += self.period.value;
        let last = self.step_rates(end, &state.flat);
        let step = self.period.times(whole.of_turn);
        Ok(Turned { wear: wear.finish(&last, &step), losses })
    }

    /// Times are parts of turns: they vary as turns do.
    fn time(&self, turns: f64) -> Varied<N> {
        self.period.times(turns)
    }

    /// Rates of the depths at a state.
    fn step_rates(&mut self, t: Varied<N>, state: &[Varied<N>]) -> Vec<Varied<N>> {
        let mut slope = vec![Varied::ZERO; state.len() + ANSWER * self.sizes.contacts];
        self.slope(t, state, &mut slope);
        slope[state.len()..].chunks_exact(ANSWER).map(|rates| rates[1]).collect()
    }

    /// A step from so many turns on.
    fn step(&mut self, at: f64, part: Part, state: &mut State<N>) -> Step<N> {
        let (rates, length) = (state.flat.len(), self.period.times(part.of_turn));
        let outputs = rates + ANSWER * self.sizes.contacts;
        let (mut sum, mut slope) = (vec![Varied::ZERO; outputs], vec![Varied::ZERO; outputs]);
        let mut stage = state.flat.clone();
        let mut losses = 0;
        let joints = || vec![Varied::ZERO; self.sizes.contacts];
        let (mut begin, mut middle) = (joints(), joints());
        let mut ranges = vec![(f64::INFINITY, 0.0_f64); self.sizes.contacts];
        for (number, (of_step, weight)) in STAGES.into_iter().enumerate() {
            let t = self.time(at + of_step * part.of_turn);
            if number > 0 {
                for ((stage, state), slope) in stage.iter_mut().zip(&state.flat).zip(&slope) {
                    *stage = state.moved(of_step, &length, slope);
                }
                self.slope(t, &stage, &mut slope);
            } else {
                self.slope(t, &state.flat, &mut slope);
                let (changed, lost) = touched(&mut state.contacts, &slope[rates..]);
                losses = lost;
                if changed {
                    self.remember(&state.contacts);
                    self.slope(t, &state.flat, &mut slope);
                }
            }
            for (joint, rates) in slope[rates..].chunks_exact(ANSWER).enumerate() {
                let (least, most) = &mut ranges[joint];
                (*least, *most) = (least.min(rates[1].value), most.max(rates[1].value));
                match number {
                    0 => begin[joint] = rates[1],
                    // Errors of both stages in the middle take each other away.
                    1 | 2 => middle[joint] = middle[joint].plus(0.5, &rates[1]),
                    _ => {}
                }
            }
            for (sum, slope) in sum.iter_mut().zip(&slope) {
                *sum = sum.plus(weight, slope);
            }
        }
        let (of_state, of_joints) = sum.split_at(rates);
        for (state, rate) in state.flat.iter_mut().zip(of_state) {
            *state = state.moved(1.0, &length, rate);
        }
        let integrals = of_joints.chunks_exact(ANSWER);
        let integrals = integrals.map(|rates| rates[0].over(&length)).collect();
        let is_rough = ranges.iter().any(|(least, most)| *least < SMOOTH * most);
        Step { begin, middle, integrals, losses, is_rough }
    }

    /// Tells the motion what contacts remember.
    fn remember(&mut self, contacts: &[Touch<N>]) {
        let first = self.memory();
        for (joint, touch) in contacts.iter().enumerate() {
            let place = first + MEMORY * joint;
            self.motion.put(place + 1, if touch.is_touching { 1.0 } else { 0.0 });
            self.motion.put(place + 2, touch.closing_speed.value);
            self.motion.put_tangent(place + 2, touch.closing_speed.tangents);
        }
    }

    fn slope(&mut self, t: Varied<N>, state: &[Varied<N>], slope: &mut [Varied<N>]) {
        let first = self.sizes.parameters;
        put_state(&mut self.motion, first, (t, state));
        let (values, tangents) = self.motion.run();
        for ((slope, value), tangents) in slope.iter_mut().zip(values).zip(tangents) {
            *slope = Varied { value: value[0], tangents: *tangents };
        }
    }
}

/// Stages of the method: the part of the step where each is, and its weight.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// What contacts remember where a step begins, by the penetrations there: as runs with steps of one length have it. Whether anything is
/// new, and how many bodies came apart.
fn touched<const N: usize>(contacts: &mut [Touch<N>], answers: &[Varied<N>]) -> (bool, u32) {
    let (mut changed, mut losses) = (false, 0);
    for (touch, answer) in contacts.iter_mut().zip(answers.chunks_exact(ANSWER)) {
        let after = [answer[2], answer[3]];
        let is_touching = after[0].value > 0.0;
        if is_touching != touch.is_touching {
            changed = true;
            losses += u32::from(touch.is_touching);
            touch.closing_speed = if is_touching { crossing(touch.before, after) } else { Varied::ZERO };
            touch.is_touching = is_touching;
        }
        touch.before = Some(after);
    }
    (changed, losses)
}

/// The speed at which a gap closed in a step, never below zero: lane by lane by the runtime's rule.
fn crossing<const N: usize>(before: Option<[Varied<N>; 2]>, after: [Varied<N>; 2]) -> Varied<N> {
    let Some(before) = before else { return Varied::ZERO };
    let of_lane = |lane: usize| {
        let dual = |one: Varied<N>| Dual::new(one.value, one.tangents[lane]);
        let [before, after] = [before, after].map(|ends| (dual(ends[0]), dual(ends[1])));
        crossing_speed(before, after).max(Dual::constant(0.0))
    };
    let speeds: [Dual<f64>; N] = std::array::from_fn(of_lane);
    Varied { value: speeds[0].value, tangents: speeds.map(|speed| speed.derivative) }
}

/// Writes time and state to the inputs of a function.
pub(super) fn put_state<const N: usize>(
    function: &mut Function<N>,
    first: usize,
    (t, state): (Varied<N>, &[Varied<N>]),
) {
    for (place, one) in (first..).zip(std::iter::once(&t).chain(state)) {
        function.put(place, one.value);
        function.put_tangent(place, one.tangents);
    }
}
