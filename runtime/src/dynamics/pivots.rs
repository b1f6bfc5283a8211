//! How regular loops are by their pivots. In: pivots at one state after the other. Out: the smallest one relative to the
//! largest value it has had. Never knows what is done about it.

use crate::linear::largest;

/// Pivots below this part of the largest of all pivots are noise, whatever they were before.
const NOISE_PIVOT: f64 = 1e-13;

/// The largest value that each pivot has had.
#[derive(Clone, Debug)]
pub(super) struct LargestPivots {
    values: Vec<f64>,
    /// Pivots up to here are noise.
    noise: f64,
    /// Both before a look aside.
    aside: (Vec<f64>, f64),
}

impl LargestPivots {
    pub(super) fn new(count: usize) -> Self {
        Self { values: vec![0.0; count], noise: 0.0, aside: (vec![0.0; count], 0.0) }
    }

    /// Keeps the largest value of each and says how regular they are.
    pub(super) fn note(&mut self, pivots: &[f64]) -> f64 {
        let grown = |(pivot, most): (&f64, &f64)| pivot > most;
        if pivots.iter().zip(&self.values).any(grown) {
            self.grow(pivots);
        }
        self.regularity(pivots)
    }

    #[cold]
    fn grow(&mut self, pivots: &[f64]) {
        for (pivot, most) in pivots.iter().zip(&mut self.values) {
            if *pivot > *most && pivot.is_finite() {
                *most = *pivot;
            }
        }
        self.find_noise();
    }

    /// Smallest pivot relative to the largest value that it has had.
    pub(super) fn regularity(&self, pivots: &[f64]) -> f64 {
        let mut smallest = 1.0;
        for (pivot, most) in pivots.iter().zip(&self.values) {
            if *pivot > self.noise {
                if *pivot < smallest * most {
                    smallest = pivot / most;
                }
            } else {
                // A pivot that is not a positive number counts as lost rank.
                smallest = 0.0;
            }
        }
        smallest
    }

    /// Keeps what [`Self::resume`] goes on with; one at a time.
    pub(super) fn put_aside(&mut self) {
        self.aside.0.copy_from_slice(&self.values);
        self.aside.1 = self.noise;
    }

    /// Goes on as if nothing had been noted since.
    pub(super) fn resume(&mut self) {
        self.values.copy_from_slice(&self.aside.0);
        self.noise = self.aside.1;
    }

    /// Passes all values, to be read or written.
    pub(super) fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.values.iter_mut().for_each(visit);
        self.find_noise();
    }

    fn find_noise(&mut self) {
        self.noise = NOISE_PIVOT * largest(&self.values);
    }
}
