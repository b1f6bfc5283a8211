//! States within a step: the cubic through values and slopes at its ends, which methods of higher order bend further.
//! In: an accepted step. Out: states at parts of it. Never knows how the step was made.

use super::adaptive::Step;

/// Cubics of all components.
#[derive(Clone, Debug)]
pub(super) struct Cubics([Vec<f64>; 4]);

impl Cubics {
    /// Storage for states of `dimension` numbers.
    pub(super) fn new(dimension: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; dimension]))
    }

    /// Goes through a step that ends in `next`, with the slopes at its begin and its end.
    pub(super) fn set(&mut self, step: Step<'_>, next: &[f64], [begin, end]: [&[f64]; 2]) {
        let Self([values, differences, bends, rests]) = self;
        let length = step.length;
        for (i, y) in step.y.iter().enumerate() {
            let difference = next[i] - y;
            let bend = length * begin[i] - difference;
            values[i] = *y;
            differences[i] = difference;
            bends[i] = bend;
            rests[i] = difference - length * end[i] - bend;
        }
    }

    /// Shows every number that it stands on.
    pub(super) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.0.iter_mut().flatten().for_each(visit);
    }

    /// States at parts `s` of the step, side by side; `further(i)` bends component i by a fourth power.
    pub(super) fn at<const N: usize>(&self, s: [f64; N], y: &mut [[f64; N]], further: impl Fn(usize) -> f64) {
        for (i, values) in y.iter_mut().enumerate() {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.0[k][i]);
            let further = further(i);
            *values = s.map(|s| {
                let r = 1.0 - s;
                a + s * (b + r * (c + s * (d + r * further)))
            });
        }
    }
}
