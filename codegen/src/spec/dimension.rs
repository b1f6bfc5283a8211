//! Physical dimensions as integer exponents.

/// Exponents of length, mass, time. Angles carry none; `rad` and `deg` are units of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    /// Exponent of m.
    pub length: i8,
    /// Exponent of kg.
    pub mass: i8,
    /// Exponent of s.
    pub time: i8,
}

impl Dimension {
    /// Placeholder until the front end lands.
    #[must_use]
    pub fn si_unit(self) -> String {
        "1".to_owned()
    }
}
