//! Slopes of several states at once, in the bits that each has alone. In: states near one where the loops are regular. Out: their
//! slopes, integrals included. Allocates only when made. Without contacts.

use crate::evaluate::Evaluator;
use crate::integrate::Beside;
use crate::system::{Entry, STATES, SideBySide, Sizes};

/// Answers [`Entry::Derivative`] at several states.
pub(super) struct Slopes<'a> {
    system: &'a dyn SideBySide<f64>,
    sizes: Sizes,
    /// Where inputs begin among the parameters.
    inputs: usize,
    question: Vec<[f64; STATES]>,
    answer: Vec<[f64; STATES]>,
    workspace: Vec<[f64; STATES]>,
}

impl<'a> Slopes<'a> {
    /// None if the system answers one state after the other.
    pub(super) fn new(system: &'a dyn SideBySide<f64>, evaluator: &Evaluator<'_>) -> Option<Self> {
        let sizes = evaluator.sizes();
        (sizes.contacts == 0 && system.answers(Entry::Derivative)).then(|| {
            let zeros = |length| vec![[0.0; STATES]; length];
            Self {
                system,
                sizes,
                inputs: evaluator.first_input(),
                question: zeros(sizes.input(Entry::Derivative)),
                answer: zeros(sizes.output(Entry::Derivative)),
                workspace: zeros(system.workspace()),
            }
        })
    }

    /// Evaluates flat states at their times, side by side; whether all that is told of them is finite.
    pub(super) fn evaluate(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        times: &[f64; STATES],
        states: &[[f64; STATES]],
    ) -> bool {
        let state = self.sizes.coordinates + self.sizes.speeds;
        let (known, asked) = self.question.split_at_mut(self.sizes.parameters);
        put_parameters(known, evaluator);
        let (time, asked) = asked.split_at_mut(1);
        for (lane, t) in times.iter().enumerate() {
            put_time((&mut known[self.inputs..], &mut time[0]), lane, evaluator, *t);
        }
        asked[..state].copy_from_slice(&states[..state]);
        self.ask()
    }

    fn ask(&mut self) -> bool {
        self.system.evaluate(Entry::Derivative, &self.question, &mut self.answer, &mut self.workspace);
        let mut finite = [0.0; STATES];
        for value in &self.answer {
            // Zero but for what is infinite or no number.
            finite.iter_mut().zip(value).for_each(|(sum, value)| *sum += 0.0 * value);
        }
        finite == [0.0; STATES]
    }

    /// Writes the slopes of flat states beside one, of every component a row; whether all are finite.
    pub(super) fn write(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        beside: &Beside<'_>,
        slopes: &mut [f64],
    ) -> bool {
        let Sizes { parameters, coordinates, speeds, .. } = self.sizes;
        let (state, all) = (coordinates + speeds, self.sizes.flat_state());
        let powers = self.answer.len() - (all - state);
        let row = Beside::row(beside.others.len());
        let (known, asked) = self.question.split_at_mut(parameters);
        put_parameters(known, evaluator);
        let (time, asked) = asked.split_at_mut(1);
        for lane in 0..STATES {
            put_time((&mut known[self.inputs..], &mut time[0]), lane, evaluator, beside.t);
        }
        asked.iter_mut().zip(&beside.y[..state]).for_each(|(place, value)| *place = [*value; STATES]);
        let count = beside.others.len();
        let mut finite = true;
        for group in 0..row / STATES {
            let here = group * STATES..((group + 1) * STATES).min(count);
            let others = here.clone().zip(&beside.others[here.clone()]);
            let (known, asked) = self.question.split_at_mut(parameters);
            let (time, asked) = asked.split_at_mut(1);
            for (lane, (place, other)) in others.enumerate() {
                asked[place][lane] = *other;
            }
            if let Some(lane) = count.checked_sub(group * STATES).filter(|lane| *lane < STATES) {
                put_time((&mut known[self.inputs..], &mut time[0]), lane, evaluator, beside.later);
            }
            finite &= self.ask();
            let told = self.answer[..state].iter().chain(&self.answer[powers..]);
            for (row, values) in slopes.chunks_exact_mut(row).zip(told) {
                row[group * STATES..][..STATES].copy_from_slice(values);
            }
            for place in here {
                self.question[parameters + 1 + place] = [beside.y[place]; STATES];
            }
        }
        finite
    }

    /// Question of one of the states last evaluated: parameters, inputs, time, coordinates and speeds.
    pub(super) fn question(&self, lane: usize) -> impl Iterator<Item = f64> + '_ {
        self.question.iter().map(move |value| value[lane])
    }

    /// Forward dynamics of one of the states last evaluated: accelerations, multipliers, drive forces, pivots.
    pub(super) fn forward(&self, lane: usize) -> [impl Iterator<Item = f64> + '_; 4] {
        let Sizes { coordinates, speeds, rows, drivers, .. } = self.sizes;
        let mut begin = coordinates;
        [speeds, rows, drivers, rows].map(|length| {
            let part = &self.answer[begin..][..length];
            begin += length;
            part.iter().map(move |value| value[lane])
        })
    }
}

/// As they are now: a run may be given others on its way.
fn put_parameters(known: &mut [[f64; STATES]], evaluator: &Evaluator<'_>) {
    for (place, value) in known.iter_mut().zip(evaluator.parameters()) {
        *place = [*value; STATES];
    }
}

/// A state's time, and inputs at it.
fn put_time(
    (inputs, time): (&mut [[f64; STATES]], &mut [f64; STATES]),
    lane: usize,
    evaluator: &mut Evaluator<'_>,
    t: f64,
) {
    for (place, value) in inputs.iter_mut().zip(evaluator.inputs(t)) {
        place[lane] = *value;
    }
    time[lane] = t;
}
