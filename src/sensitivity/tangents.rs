//! Numbers with tangents along several directions. Never knows what varies.

/// A value and its tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Varied<const N: usize> {
    pub value: f64,
    pub tangents: [f64; N],
}

impl<const N: usize> Varied<N> {
    pub(super) const ZERO: Self = Self { value: 0.0, tangents: [0.0; N] };

    /// As a function answers: a value, the same in all lanes, and its tangents.
    pub(super) fn answered(value: &[f64; N], tangents: &[f64; N]) -> Self {
        Self { value: value[0], tangents: *tangents }
    }

    /// A multiple.
    pub(super) fn times(&self, factor: f64) -> Self {
        Self { value: factor * self.value, tangents: self.tangents.map(|x| factor * x) }
    }

    /// Plus a multiple of another.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let tangents = std::array::from_fn(|lane| self.tangents[lane] + factor * other.tangents[lane]);
        Self { value: self.value + factor * other.value, tangents }
    }

    /// What a rate adds up to in a time that varies too.
    pub(super) fn over(&self, time: &Self) -> Self {
        let tangents =
            std::array::from_fn(|lane| time.value * self.tangents[lane] + time.tangents[lane] * self.value);
        Self { value: time.value * self.value, tangents }
    }
}

/// Numbers with tangents as functions take and give them: values, each the same in all lanes, then tangents. Copied in one go.
#[derive(Clone, Debug)]
pub(super) struct Many<const N: usize> {
    pub values: Vec<[f64; N]>,
    pub tangents: Vec<[f64; N]>,
}

impl<const N: usize> Many<N> {
    pub(super) fn of(all: &[Varied<N>]) -> Self {
        let values = all.iter().map(|one| [one.value; N]).collect();
        Self { values, tangents: all.iter().map(|one| one.tangents).collect() }
    }

    /// The same one by one.
    pub(super) fn write_to(&self, all: &mut [Varied<N>]) {
        for ((one, value), tangents) in all.iter_mut().zip(&self.values).zip(&self.tangents) {
            *one = Varied::answered(value, tangents);
        }
    }

    /// Takes over the first of what a function answers.
    pub(super) fn take(&mut self, (values, tangents): (&[[f64; N]], &[[f64; N]])) {
        let count = self.values.len();
        self.values.copy_from_slice(&values[..count]);
        self.tangents.copy_from_slice(&tangents[..count]);
    }

    pub(super) fn is_finite(&self) -> bool {
        self.values.iter().all(|value| value[0].is_finite())
    }
}
