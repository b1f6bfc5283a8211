//! The steps of [`Rk43`](super::Rk43) of several trajectories side by side: each lane its own time, length and error, in the bits
//! that it has alone. In: slopes, stage by stage. Out: ends of steps, their errors. Never knows who accepts them.

use super::rk43::{PARTS, error_of, step_of};

/// Numbers of all lanes, beginning where a line of the cache does: values of several lanes that cross lines cost twice.
#[derive(Clone, Debug)]
pub(crate) struct Room<const N: usize> {
    numbers: Vec<f64>,
    first: usize,
    values: usize,
}

/// Bytes of a line of the cache.
const LINE: usize = 64;

impl<const N: usize> Room<N> {
    pub(crate) fn new(values: usize) -> Self {
        let numbers = vec![0.0_f64; values * N + LINE / size_of::<f64>()];
        let first = numbers.as_ptr().align_offset(LINE).min(LINE / size_of::<f64>());
        Self { numbers, first, values }
    }

    pub(crate) fn all(&self) -> &[[f64; N]] {
        self.numbers[self.first..][..self.values * N].as_chunks().0
    }

    pub(crate) fn all_mut(&mut self) -> &mut [[f64; N]] {
        self.numbers[self.first..][..self.values * N].as_chunks_mut().0
    }

    /// Writes what one lane has, from value `from` on.
    pub(crate) fn put(&mut self, lane: usize, from: usize, numbers: &[f64]) {
        for (value, number) in self.all_mut()[from..].iter_mut().zip(numbers) {
            value[lane] = *number;
        }
    }

    /// Reads what one lane has, from value `from` on.
    pub(crate) fn get(&self, lane: usize, from: usize, numbers: &mut [f64]) {
        for (value, number) in self.all()[from..].iter().zip(numbers) {
            *number = value[lane];
        }
    }
}

/// Stages of a step, and the slope at its end.
pub(crate) const SLOPES: usize = PARTS.len() + 2;

/// States and slopes of `N` trajectories.
pub(crate) struct Rk43Lanes<const N: usize> {
    pub(crate) y: Room<N>,
    pub(crate) next: Room<N>,
    /// Answers of the equations: slopes of the state, and what comes with them.
    pub(crate) answers: [Room<N>; SLOPES],
}

impl<const N: usize> Rk43Lanes<N> {
    /// Storage for states of `dimension` numbers; slopes come first in answers of `answer` numbers.
    pub(crate) fn new(dimension: usize, answer: usize) -> Self {
        Self {
            y: Room::new(dimension),
            next: Room::new(dimension),
            answers: std::array::from_fn(|_| Room::new(answer)),
        }
    }

    /// Writes the first values of the states at which stage `stage`, from 1, is evaluated.
    pub(crate) fn stage(&self, stage: usize, lengths: &[f64; N], states: &mut [[f64; N]]) {
        let factors = lengths.map(|length| PARTS[stage - 1] * length);
        let values = self.y.all().iter().zip(self.answers[stage - 1].all());
        for (state, (y, slope)) in states.iter_mut().zip(values) {
            for lane in 0..N {
                state[lane] = y[lane] + factors[lane] * slope[lane];
            }
        }
    }

    /// Writes the ends of the steps.
    pub(crate) fn finish(&mut self, lengths: &[f64; N]) {
        let [a, b, c, d, _] = self.answers.each_ref().map(Room::all);
        let slopes = a.iter().zip(b).zip(c.iter().zip(d));
        for ((next, y), ((a, b), (c, d))) in self.next.all_mut().iter_mut().zip(self.y.all()).zip(slopes) {
            for lane in 0..N {
                next[lane] = step_of(y[lane], lengths[lane], [a[lane], b[lane], c[lane], d[lane]]);
            }
        }
    }

    /// The largest error of each step; 1 is just accepted. What is not a number stays none.
    pub(crate) fn errors(&self, lengths: &[f64; N], tolerances: &[f64; N], scales: &[[f64; N]]) -> [f64; N] {
        let (mut most, mut is_none) = ([0.0; N], [false; N]);
        let ends = self.y.all().iter().zip(self.next.all());
        let slopes = self.answers[SLOPES - 2].all().iter().zip(self.answers[SLOPES - 1].all());
        for ((y, next), ((last, end), scale)) in ends.zip(slopes.zip(scales)) {
            for lane in 0..N {
                let size = y[lane].abs().max(next[lane].abs()).max(scale[lane]);
                let error = error_of(last[lane], end[lane]);
                let error = (lengths[lane] * error / (tolerances[lane] * size)).abs();
                most[lane] = if error > most[lane] { error } else { most[lane] };
                is_none[lane] |= error.is_nan();
            }
        }
        std::array::from_fn(|lane| if is_none[lane] { f64::NAN } else { most[lane] })
    }

    /// The steps of these lanes count: they begin at their ends.
    pub(crate) fn accept(&mut self, accepted: &[bool; N]) {
        let Self { y, next, answers } = self;
        choose(y.all_mut(), next.all(), accepted);
        let [first, .., end] = answers;
        choose(first.all_mut(), end.all(), accepted);
    }
}

fn choose<const N: usize>(values: &mut [[f64; N]], others: &[[f64; N]], chosen: &[bool; N]) {
    for (value, other) in values.iter_mut().zip(others) {
        for lane in 0..N {
            value[lane] = if chosen[lane] { other[lane] } else { value[lane] };
        }
    }
}
