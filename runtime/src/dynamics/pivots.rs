//! How regular loops are by their pivots. In: pivots at one state after the other. Out: the smallest one relative to the
//! largest value it has had. Never knows what is done about it.

use crate::scalar::Scalar;

/// Pivots below this part of the largest of all pivots are noise, whatever they were before.
const NOISE_PIVOT: f64 = 1e-13;

/// Keeps the largest value that each pivot has had, and says how regular these are: [`LargestPivots::note`] without branches.
pub(crate) fn note_pivots<T: Scalar>(pivots: &[T], values: &mut [T]) -> T {
    for (pivot, most) in pivots.iter().zip(&mut *values) {
        *most = larger(*pivot, *most);
    }
    let noise = noise_of(values);
    let all = pivots.iter().zip(values);
    all.fold(T::constant(1.0), |smallest, (pivot, most)| smaller(smallest, (*pivot, *most), noise))
}

/// The larger of a pivot, if it is finite, and the largest value that it has had.
#[inline]
fn larger<T: Scalar>(pivot: T, most: T) -> T {
    let finite = T::select(pivot.lt(T::constant(f64::INFINITY)), pivot, most);
    T::select(most.lt(pivot), finite, most)
}

/// Up to where pivots are noise, by their largest values.
fn noise_of<T: Scalar>(values: &[T]) -> T {
    T::constant(NOISE_PIVOT) * values.iter().fold(T::constant(0.0), |most, value| most.max(value.abs()))
}

/// The smaller of a regularity and that of a pivot with the largest value that it has had.
#[inline]
fn smaller<T: Scalar>(smallest: T, (pivot, most): (T, T), noise: T) -> T {
    let least = T::select(pivot.lt(smallest * most), pivot / most, smallest);
    // A pivot that is not a positive number counts as lost rank.
    T::select(noise.lt(pivot), least, T::constant(0.0))
}

/// The largest value that each pivot has had.
#[derive(Clone, Debug)]
pub(super) struct LargestPivots {
    values: Vec<f64>,
    /// Pivots up to here are noise.
    noise: f64,
    /// During a look aside.
    is_aside: bool,
    /// Both before it, if they have changed since.
    aside: Option<f64>,
    aside_values: Vec<f64>,
}

impl LargestPivots {
    pub(super) fn new(count: usize) -> Self {
        let values = vec![0.0; count];
        Self { aside_values: values.clone(), values, noise: 0.0, is_aside: false, aside: None }
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
        let all = pivots.iter().zip(&self.values);
        all.fold(1.0, |smallest, (pivot, most)| smaller(smallest, (*pivot, *most), self.noise))
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
        }
    }

    /// Passes all values, to be read or written.
    pub(super) fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.values.iter_mut().for_each(visit);
        self.find_noise();
    }

    fn find_noise(&mut self) {
        self.noise = noise_of(&self.values);
    }
}
