//! A turn in steps of one length, with tangents along several directions. In: where it begins and how that varies. Out: what the joints
//! wear and how that varies. Never knows parameters or lives.
//!
//! The classical Runge-Kutta method, and the end of the turn put onto the constraints: a smooth function of all that varies, but where a
//! gap closes at the very end of a step. Its tangents are exact but for rounding.

use linkwear_codegen::tape::Tape;
use linkwear_runtime::contact::crossing_speed;
use linkwear_runtime::{Dual, Layout, Motion, Scalar, Sizes};
use nalgebra::DMatrix;

use super::function::Function;
use super::roots;
use super::varied::{ANSWER, MEMORY};

/// Loops that are open by more at the end of a turn [m], [rad]: steps were too long.
const DRIFTED: f64 = 1e-5;
/// Loops count as closed then [m], [rad].
const CLOSED: f64 = 1e-13;
/// Corrections at most: each squares what is left.
const CORRECTIONS: usize = 5;
/// Singular values of the loops below this part of the largest are none.
const NO_ROW: f64 = 1e-12;

/// A value and its tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Varied<const N: usize> {
    pub value: f64,
    pub tangents: [f64; N],
}

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

/// How long a step is: as a part of a turn, and of the steps of the turn.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    of_turn: f64,
    of_step: f64,
}

/// Steps that one is made in where what wears begins, ends or changes fast: derivatives jump there.
const SHORTER: u32 = 32;

/// What a step did, joint by joint.
struct Step<const N: usize> {
    /// Rates of depths at its begin and in its middle [m/s].
    begin: Vec<Varied<N>>,
    middle: Vec<Varied<N>>,
    /// What it added to wear integrals [J].
    integrals: Vec<Varied<N>>,
    losses: u32,
    is_rough: bool,
}

/// What steps have worn, joint by joint.
struct Wear<const N: usize> {
    integrals: Vec<Varied<N>>,
    /// Depths [m] over the length of a step of the turn, until the last time that lengths changed.
    depths: Vec<Varied<N>>,
    /// Rates of depths since then, at ends and middles of steps.
    since: Vec<Vec<Varied<N>>>,
    part: f64,
}

impl<const N: usize> Wear<N> {
    fn new(joints: usize) -> Self {
        let zeros = vec![Varied::ZERO; joints];
        Self { integrals: zeros.clone(), depths: zeros, since: vec![Vec::new(); joints], part: 1.0 }
    }

    fn add(&mut self, step: &Step<N>, part: Part) {
        if part.of_step != self.part {
            self.begin_anew(&step.begin);
            self.part = part.of_step;
        }
        for (joint, since) in self.since.iter_mut().enumerate() {
            since.extend([step.begin[joint], step.middle[joint]]);
            self.integrals[joint] = self.integrals[joint].plus(1.0, &step.integrals[joint]);
        }
    }

    /// Adds up what has been since the lengths changed; `rates` are those at hand.
    fn begin_anew(&mut self, rates: &[Varied<N>]) {
        let half = Varied { value: 0.5 * self.part, tangents: [0.0; N] };
        for ((depth, since), rate) in self.depths.iter_mut().zip(&mut self.since).zip(rates) {
            since.push(*rate);
            *depth = depth.plus(1.0, &roots::integral(since, &half));
            since.clear();
        }
    }

    /// Wear integrals and depths, by the length of a step.
    fn finish(mut self, rates: &[Varied<N>], step: &Varied<N>) -> Vec<[Varied<N>; 2]> {
        self.begin_anew(rates);
        let depth = |depth: &Varied<N>| Varied::ZERO.moved(1.0, step, depth);
        self.integrals.iter().zip(&self.depths).map(|(integral, one)| [*integral, depth(one)]).collect()
    }
}

/// Why a turn cannot be made in these steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooLong;

/// Turns of a mechanism.
pub(super) struct Turns<const N: usize> {
    motion: Function<N>,
    closure: Function<N>,
    sizes: Sizes,
    layout: Layout,
    /// Of every kept row, its row among all.
    kept: Vec<usize>,
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
        let integrals = integrals.map(|rates| Varied::ZERO.moved(1.0, &length, &rates[0])).collect();
        let is_rough = ranges.iter().any(|(least, most)| *least < roots::SMOOTH * most);
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

    /// Puts a state onto the constraints.
    fn close(&mut self, t: Varied<N>, state: &mut [Varied<N>]) -> Result<(), TooLong> {
        self.normalize(state);
        let Sizes { rows, all_rows, coordinates, speeds, .. } = self.sizes;
        if rows == 0 {
            return Ok(());
        }
        let mut loops = self.loops(t, state);
        for correction in 0.. {
            let positions: Vec<Varied<N>> = self.kept.iter().map(|row| loops.residuals[*row]).collect();
            let open = positions.iter().fold(0.0_f64, |most, one| most.max(one.value.abs()));
            // What is no number is open too.
            if !(open <= DRIFTED) {
                return Err(TooLong);
            }
            let Some(inverse) = loops.inverse.take() else { return Err(TooLong) };
            let delta = shortest(&inverse, &positions);
            self.advance(state, &delta);
            loops = self.loops(t, state);
            if open <= CLOSED || correction == CORRECTIONS {
                break;
            }
        }
        let Some(inverse) = loops.inverse else { return Err(TooLong) };
        let delta = shortest(&inverse, &loops.residuals[all_rows..all_rows + rows]);
        for (speed, delta) in state[coordinates..coordinates + speeds].iter_mut().zip(&delta) {
            *speed = speed.plus(1.0, delta);
        }
        Ok(())
    }

    fn loops(&mut self, t: Varied<N>, state: &[Varied<N>]) -> Loops<N> {
        put_state(&mut self.closure, self.sizes.parameters, (t, state));
        let Sizes { rows, all_rows, speeds, .. } = self.sizes;
        let (values, tangents) = self.closure.run();
        let residual =
            |(value, tangents): (&[f64; N], &[f64; N])| Varied { value: value[0], tangents: *tangents };
        let residuals = values.iter().zip(tangents).take(all_rows + rows).map(residual).collect();
        let jacobian: Vec<f64> = values[all_rows + rows..].iter().map(|value| value[0]).collect();
        let jacobian = DMatrix::from_row_slice(rows, speeds, &jacobian);
        let is_finite = jacobian.iter().all(|entry| entry.is_finite());
        let inverse = if is_finite { jacobian.pseudo_inverse(NO_ROW).ok() } else { None };
        Loops { residuals, inverse }
    }

    /// Moves coordinates by a small motion.
    fn advance(&self, state: &mut [Varied<N>], delta: &[Varied<N>]) {
        for group in self.layout.free() {
            let (q, delta) = (&mut state[group.coordinate..], &delta[group.speed..]);
            match group.motion {
                Motion::Scalar { .. } => q[0] = q[0].plus(1.0, &delta[0]),
                Motion::Rotation => rotate(q, delta),
                Motion::Pose => {
                    let (shift, [a, b, c, d]) = (&delta[3..6], [0, 1, 2, 3].map(|i| q[i].value));
                    // By first order, as the motion is small: a moved point by the body's axes.
                    let axes = [
                        [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
                        [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
                        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
                    ];
                    for (place, axis) in q[4..7].iter_mut().zip(axes) {
                        for (part, along) in axis.into_iter().zip(shift) {
                            *place = place.plus(part, along);
                        }
                    }
                    rotate(q, delta);
                }
            }
        }
        self.normalize(state);
    }

    /// Scales quaternions to unit length.
    fn normalize(&self, state: &mut [Varied<N>]) {
        for group in self.layout.free().filter(|group| !matches!(group.motion, Motion::Scalar { .. })) {
            let part = &mut state[group.coordinate..][..4];
            let length = part.iter().map(|one| one.value * one.value).sum::<f64>().sqrt();
            let along: [f64; N] = std::array::from_fn(|lane| {
                part.iter().map(|one| one.value * one.tangents[lane]).sum::<f64>() / (length * length)
            });
            for one in part {
                let tangents =
                    std::array::from_fn(|lane| (one.tangents[lane] - one.value * along[lane]) / length);
                *one = Varied { value: one.value / length, tangents };
            }
        }
    }
}

/// Stages of the method: the part of the step where each is, and its weight.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// Loops at a state.
struct Loops<const N: usize> {
    /// Positions of all rows, speeds of those that are kept.
    residuals: Vec<Varied<N>>,
    /// Of their Jacobian; none if that is no number.
    inverse: Option<DMatrix<f64>>,
}

impl<const N: usize> Varied<N> {
    pub(super) const ZERO: Self = Self { value: 0.0, tangents: [0.0; N] };

    /// A multiple.
    pub(super) fn times(&self, factor: f64) -> Self {
        Self { value: factor * self.value, tangents: self.tangents.map(|x| factor * x) }
    }

    /// Plus a multiple of another.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let tangents = std::array::from_fn(|lane| self.tangents[lane] + factor * other.tangents[lane]);
        Self { value: self.value + factor * other.value, tangents }
    }

    /// Where a rate leads in a part of a step, whose length varies too.
    fn moved(&self, part: f64, length: &Self, rate: &Self) -> Self {
        let step = part * length.value;
        let tangents = std::array::from_fn(|lane| {
            self.tangents[lane] + step * rate.tangents[lane] + part * length.tangents[lane] * rate.value
        });
        Self { value: self.value + step * rate.value, tangents }
    }
}

fn put_state<const N: usize>(
    function: &mut Function<N>,
    first: usize,
    (t, state): (Varied<N>, &[Varied<N>]),
) {
    for (place, one) in (first..).zip(std::iter::once(&t).chain(state)) {
        function.put(place, one.value);
        function.put_tangent(place, one.tangents);
    }
}

/// The shortest motion that takes residuals away.
fn shortest<const N: usize>(inverse: &DMatrix<f64>, residuals: &[Varied<N>]) -> Vec<Varied<N>> {
    let along = |speed: usize| {
        residuals
            .iter()
            .enumerate()
            .fold(Varied::ZERO, |sum, (row, one)| sum.plus(-inverse[(speed, row)], one))
    };
    (0..inverse.nrows()).map(along).collect()
}

/// Quaternion times a small rotation by the vector `angle` in the body's own frame.
fn rotate<const N: usize>(q: &mut [Varied<N>], angle: &[Varied<N>]) {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| q[i].value);
    let rows = [[-b, -c, -d], [a, -d, c], [d, a, -b], [-c, b, a]];
    for (part, row) in q[..4].iter_mut().zip(rows) {
        for (factor, angle) in row.into_iter().zip(angle) {
            *part = part.plus(0.5 * factor, angle);
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
