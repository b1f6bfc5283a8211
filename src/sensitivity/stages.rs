//! The stages of a step after its first as one tape: machine code then adds up what their slopes add up to. In: the motion as a tape.
//! Out: a tape from the slope at a step's begin to its end. Never knows tangents.

use linkwear_codegen::tape::{Number, Operand, Recorder, Tape};
use linkwear_runtime::{Scalar, Sizes};

use super::varied::ANSWER;

/// Stages of the classical Runge-Kutta method: the part of the step where each is, and its weight.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// Numbers per joint with clearance behind the state at the end: what the step adds to the wear integral [J], the rate of the depth in
/// its middle [m/s], and at each of these stages.
pub(super) const DONE: usize = 2 + STAGES.len() - 1;

/// Places of the inputs that stand behind those of the motion, whose time is that in the middle of the step and whose state that at its
/// begin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    /// Time at the end of the step [s].
    pub end: usize,
    /// Its length [s].
    pub length: usize,
    /// The answer of the motion at its begin.
    pub slope: usize,
}

impl Places {
    pub(super) fn of(motion: &Tape) -> Self {
        let end = motion.input_len();
        Self { end, length: end + 1, slope: end + 2 }
    }
}

/// The stages after the first. Out: the state at the end, its quaternions as the method has them, then [`DONE`].
pub(super) fn stages(motion: &Tape, sizes: &Sizes) -> Tape {
    let recorder = Recorder::default();
    let (at, rates) = (Places::of(motion), sizes.coordinates + sizes.speeds);
    let inputs = at.slope + motion.output_len();
    let all: Vec<Number<'_>> = (0..inputs as u32).map(|index| recorder.input(index)).collect();
    let (length, time) = (all[at.length], sizes.parameters);
    let state = &all[time + 1..][..rates];
    let mut slopes = vec![all[at.slope..].to_vec()];
    for (of_step, _) in &STAGES[1..] {
        let mut question = all[..at.end].to_vec();
        if *of_step == 1.0 {
            question[time] = all[at.end];
        }
        let step = Number::constant(*of_step) * length;
        let before = &slopes[slopes.len() - 1];
        for ((place, state), slope) in question[time + 1..].iter_mut().zip(state).zip(&before[..rates]) {
            *place = *state + step * *slope;
        }
        slopes.push(recorder.run(motion, &question));
    }
    let sum = |place: usize| {
        let weighted =
            slopes.iter().zip(STAGES).map(|(slope, (_, weight))| Number::constant(weight) * slope[place]);
        weighted.reduce(|sum, one| sum + one).unwrap_or(Number::constant(0.0))
    };
    let mut outputs: Vec<Number<'_>> = (0..rates).map(|place| state[place] + length * sum(place)).collect();
    for joint in 0..sizes.contacts {
        let [work, depth] = [0, 1].map(|of_joint| rates + ANSWER * joint + of_joint);
        let half = Number::constant(0.5);
        // Errors of both stages in the middle take each other away.
        outputs.extend([length * sum(work), half * slopes[1][depth] + half * slopes[2][depth]]);
        outputs.extend(slopes[1..].iter().map(|slope| slope[depth]));
    }
    let outputs: Vec<Operand> = outputs.into_iter().map(Recorder::operand).collect();
    recorder.finish("stages", inputs, &outputs)
}
