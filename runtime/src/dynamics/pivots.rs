//! Keeps the largest value that each pivot has had. In: pivots at one state after the other. Out: the smallest one relative to it.
//! Never knows what is done about it.

use crate::regularity::{larger, noise_of, smaller};

/// The largest value that each pivot has had.
#[derive(Clone, Debug)]
pub(super) struct LargestPivots {
    values: Vec<f64>,
    /// Pivots up to here are noise.
    noise: f64,
    /// How often either has changed.
    changes: u64,
    /// During a look aside.
    is_aside: bool,
    /// Both before it, if they have changed since.
    aside: Option<f64>,
    aside_values: Vec<f64>,
}

impl LargestPivots {
    pub(super) fn new(count: usize) -> Self {
        let values = vec![0.0; count];
        Self { aside_values: values.clone(), values, noise: 0.0, changes: 0, is_aside: false, aside: None }
    }

    /// Keeps the largest value of each and says how regular they are.
    pub(super) fn note(&mut self, pivots: &[f64]) -> f64 {
        let (mut has_grown, mut smallest) = (false, 1.0);
        for (pivot, most) in pivots.iter().zip(&self.values) {
            has_grown |= pivot > most;
            smallest = smaller(smallest, (*pivot, *most), self.noise);
        }
        if has_grown {
            self.grow(pivots);
            return self.regularity(pivots);
        }
        smallest
    }

    /// How often they have changed.
    pub(super) fn changes(&self) -> u64 {
        self.changes
    }

    /// The largest values.
    pub(super) fn known(&self) -> &[f64] {
        &self.values
    }

    #[cold]
    fn grow(&mut self, pivots: &[f64]) {
        if self.is_aside && self.aside.is_none() {
            self.aside_values.copy_from_slice(&self.values);
            self.aside = Some(self.noise);
        }
        for (pivot, most) in pivots.iter().zip(&mut self.values) {
            *most = larger(*pivot, *most);
        }
        self.find_noise();
    }

    /// Smallest pivot relative to the largest value that it has had.
    pub(super) fn regularity(&self, pivots: &[f64]) -> f64 {
        self.regularity_of(pivots.iter().copied())
    }

    /// The same of pivots that come one by one.
    pub(super) fn regularity_of(&self, pivots: impl Iterator<Item = f64>) -> f64 {
        let all = pivots.zip(&self.values);
        all.fold(1.0, |smallest, (pivot, most)| smaller(smallest, (pivot, *most), self.noise))
    }

    /// Keeps what [`Self::resume`] goes on with; one at a time.
    pub(super) fn put_aside(&mut self) {
        (self.is_aside, self.aside) = (true, None);
    }

    /// Goes on as if nothing had been noted since.
    pub(super) fn resume(&mut self) {
        self.is_aside = false;
        if let Some(noise) = self.aside.take() {
            self.values.copy_from_slice(&self.aside_values);
            self.noise = noise;
            self.changes += 1;
        }
    }

    /// Passes all values, to be read or written.
    pub(super) fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.values.iter_mut().for_each(visit);
        self.find_noise();
    }

    fn find_noise(&mut self) {
        self.noise = noise_of(&self.values);
        self.changes += 1;
    }
}
