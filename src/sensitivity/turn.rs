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
use super::stages::{DONE, Places, stages};
use super::tangents::{Many, Varied};
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
    /// What follows from a step's begin, and where it is told of it.
    stages: Function<N>,
    at: Places,
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
        let (at, of_stages) = (Places::of(motion), stages(motion, &sizes));
        let (mut motion, mut closure) = (Function::new(motion), Function::new(closure));
        let mut stages = Function::new(&of_stages);
        let state = sizes.coordinates + sizes.speeds;
        let (of_motion, of_closure) =
            (sizes.parameters + 1 + state + MEMORY * sizes.contacts, sizes.parameters + 1 + state);
        let put = |function: &mut Function<N>, first: usize, all: &[Varied<N>]| {
            for (place, one) in (first..).zip(all) {
                function.put_varied(place, one);
            }
        };
        for function in [&mut motion, &mut stages, &mut closure] {
            put(function, 0, &directions.parameters);
        }
        for function in [&mut motion, &mut stages] {
            put(function, of_motion, &directions.motion_constants);
        }
        put(&mut closure, of_closure, &directions.closure_constants);
        Self { motion, stages, at, closure, sizes, layout, kept, period: directions.period }
    }

    /// How worn the joints are [m].
    pub(super) fn wear(&mut self, worn: impl Iterator<Item = Varied<N>>) {
        let first = self.memory();
        for (joint, worn) in worn.enumerate() {
            for function in [&mut self.motion, &mut self.stages] {
                function.put_varied(first + MEMORY * joint, &worn);
            }
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
        let (mut flat, contacts) = (Many::of(&state.flat), &mut state.contacts);
        let mut kept = contacts.clone();
        for step in 0..steps {
            kept.copy_from_slice(contacts);
            let at = begin + step as f64 * whole.of_turn;
            let mut did = self.step(at, whole, (&mut flat, contacts));
            if did.is_rough {
                // The motion was told where the step began.
                flat.take(self.motion.told(self.sizes.parameters + 1));
                contacts.copy_from_slice(&kept);
                self.remember(contacts);
                for part in 0..SHORTER {
                    did = self.step(at + part as f64 * fine.of_turn, fine, (&mut flat, contacts));
                    losses += did.losses;
                    wear.add(&did, fine);
                }
            } else {
                losses += did.losses;
                wear.add(&did, whole);
            }
            if !flat.is_finite() {
                return Err(TooLong);
            }
        }
        flat.write_to(&mut state.flat);
        let end = self.time(begin + 1.0);
        self.close(end, &mut state.flat)?;
        state.t += self.period.value;
        let last = self.step_rates(end, &Many::of(&state.flat));
        let step = self.period.times(whole.of_turn);
        Ok(Turned { wear: wear.finish(&last, &step), losses })
    }

    /// Times are parts of turns: they vary as turns do.
    fn time(&self, turns: f64) -> Varied<N> {
        self.period.times(turns)
    }

    /// Rates of the depths at a state.
    fn step_rates(&mut self, t: Varied<N>, flat: &Many<N>) -> Vec<Varied<N>> {
        self.begin(t, flat).chunks_exact(ANSWER).map(|rates| rates[1]).collect()
    }

    /// A step from so many turns on.
    fn step(&mut self, at: f64, part: Part, (flat, contacts): (&mut Many<N>, &mut [Touch<N>])) -> Step<N> {
        let length = self.period.times(part.of_turn);
        let mut begin = self.begin(self.time(at), flat);
        let (changed, losses) = touched(contacts, &begin);
        if changed {
            self.remember(contacts);
            begin = self.begin(self.time(at), flat);
        }
        let (middle, end) = (self.time(at + 0.5 * part.of_turn), self.time(at + part.of_turn));
        let Self { stages, at: places, .. } = self;
        put_flat(stages, self.sizes.parameters, (&middle, flat));
        stages.put_varied(places.end, &end);
        stages.put_varied(places.length, &length);
        let (values, tangents) = stages.run();
        let found = |place: usize| Varied::answered(&values[place], &tangents[place]);
        flat.take((values, tangents));
        let rates = flat.values.len();
        let mut step =
            Step { begin: Vec::new(), middle: Vec::new(), integrals: Vec::new(), losses, is_rough: false };
        for (joint, begin) in begin.chunks_exact(ANSWER).enumerate() {
            let first = rates + DONE * joint;
            step.begin.push(begin[1]);
            step.integrals.push(found(first));
            step.middle.push(found(first + 1));
            let of_stages = || values[first + 2..first + DONE].iter().map(|rate| rate[0]);
            let least = of_stages().fold(begin[1].value, f64::min);
            let most = of_stages().fold(begin[1].value.max(0.0), f64::max);
            step.is_rough |= least < SMOOTH * most;
        }
        step
    }

    /// Where a step begins: tells its stages the slope there. Out: what contacts are like.
    fn begin(&mut self, t: Varied<N>, flat: &Many<N>) -> Vec<Varied<N>> {
        put_flat(&mut self.motion, self.sizes.parameters, (&t, flat));
        let (values, tangents) = self.motion.run();
        self.stages.put_many(self.at.slope, (values, tangents));
        let answers = values.iter().zip(tangents).skip(flat.values.len());
        answers.map(|(value, tangents)| Varied::answered(value, tangents)).collect()
    }

    /// Tells the motion what contacts remember.
    fn remember(&mut self, contacts: &[Touch<N>]) {
        let first = self.memory();
        for (joint, touch) in contacts.iter().enumerate() {
            let place = first + MEMORY * joint;
            for function in [&mut self.motion, &mut self.stages] {
                function.put(place + 1, if touch.is_touching { 1.0 } else { 0.0 });
                function.put_varied(place + 2, &touch.closing_speed);
            }
        }
    }
}

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

/// Writes time and state to the inputs of a function, in one go.
fn put_flat<const N: usize>(function: &mut Function<N>, first: usize, (t, flat): (&Varied<N>, &Many<N>)) {
    function.put_varied(first, t);
    function.put_many(first + 1, (&flat.values, &flat.tangents));
}

/// Writes time and state, number by number, to the inputs of a function.
pub(super) fn put_state<const N: usize>(
    function: &mut Function<N>,
    first: usize,
    (t, state): (Varied<N>, &[Varied<N>]),
) {
    for (place, one) in (first..).zip(std::iter::once(&t).chain(state)) {
        function.put_varied(place, one);
    }
}
