//! Numbers of several trajectories side by side. In: what one lane has. Out: what all lanes have. Never knows what it is.

/// Numbers of all lanes, beginning where a line of the cache does: values of several lanes that cross lines cost twice.
#[derive(Debug)]
pub(super) struct Room<const N: usize> {
    numbers: Vec<f64>,
    first: usize,
    values: usize,
}

/// Bytes of a line of the cache.
const LINE: usize = 64;

impl<const N: usize> Room<N> {
    pub(super) fn new(values: usize) -> Self {
        let numbers = vec![0.0_f64; values * N + LINE / size_of::<f64>()];
        let first = numbers.as_ptr().align_offset(LINE).min(LINE / size_of::<f64>());
        Self { numbers, first, values }
    }

    pub(super) fn all(&self) -> &[[f64; N]] {
        self.numbers[self.first..][..self.values * N].as_chunks().0
    }

    pub(super) fn all_mut(&mut self) -> &mut [[f64; N]] {
        self.numbers[self.first..][..self.values * N].as_chunks_mut().0
    }

    /// Writes what one lane has, from value `from` on.
    pub(super) fn put(&mut self, lane: usize, from: usize, numbers: &[f64]) {
        for (value, number) in self.all_mut()[from..].iter_mut().zip(numbers) {
            value[lane] = *number;
        }
    }

    /// Reads what one lane has, from value `from` on.
    pub(super) fn get(&self, lane: usize, from: usize, numbers: &mut [f64]) {
        for (value, number) in self.all()[from..].iter().zip(numbers) {
            *number = value[lane];
        }
    }
}
