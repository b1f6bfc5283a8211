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
