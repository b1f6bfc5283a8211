//! How units of a process differ: one of its two parameters has a law of its own over the units. In: nothing but numbers.
//! Never knows which processes there are.
//!
//! Given its parameter, the total of a unit's wear over its total exposure says all that the unit tells of it. So the
//! likelihood of the unit is that of the plain process times the mixed density of its total over the plain one, and its
//! parameter has the same kind of law after readings as before.

use std::fmt::Debug;

use crate::random::Stream;

/// The law by which one parameter differs between units. `logs`: logarithms of the process's parameters, the random one at
/// the mean of its law (of the reciprocal, where that is random); `cv`: standard deviation over mean of that law, positive. The
/// law of an increment over an exposure is that over exposure 1 with other `logs`, as in [`super::Process`], and the same `cv`.
pub trait RandomEffect: Debug + Sync {
    /// What differs, in the process's own names.
    fn parameter(&self) -> &'static str;

    /// Name of its law.
    fn law(&self) -> &'static str;

    /// The law in numbers.
    fn numbers(&self, logs: [f64; 2], cv: f64) -> RandomLaw;

    /// ln density of an increment over exposure 1 of a unit of which nothing is known.
    fn ln_density(&self, logs: [f64; 2], cv: f64, wear: f64) -> f64;

    /// Probabilities that such an increment over an exposure is at most `wear`, and above it; each has its digits where small.
    fn tails(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> (f64, f64);

    /// Probabilities that wear of such a unit stays below `left` > 0 throughout an exposure > 0, and that it does not. Wear that
    /// does not fall does so exactly if it is below in the end.
    fn survival(&self, logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> (f64, f64) {
        self.tails(logs, cv, exposure, left)
    }

    /// ln of the first of them, for where it is too small for a number.
    fn ln_survival(&self, logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> f64;

    /// The law of a unit that wore so much over an exposure; None where it is none of this kind.
    fn after(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> Option<([f64; 2], f64)>;

    /// Logarithms of the parameters of a unit at a place of the law of its own, and ln of that law's density over the places, which
    /// are about one standard deviation apart from each other; None where a unit's parameter may have no logarithm.
    fn place(&self, _logs: [f64; 2], _cv: f64, _place: f64) -> Option<([f64; 2], f64)> {
        None
    }

    /// Where [`Self::place`] has those logarithms.
    fn place_of(&self, _logs: [f64; 2], _cv: f64, _own: [f64; 2]) -> f64 {
        0.0
    }

    /// Parameters of one unit, drawn.
    fn draw(&self, logs: [f64; 2], cv: f64, stream: &mut Stream) -> [f64; 2];

    /// By what part the variance of the score for differences exceeds that of a normal law, for a unit of exposure 1, whose
    /// mean is estimated: the excess falls as 1 / exposure.
    fn excess(&self, _logs: [f64; 2]) -> f64 {
        0.0
    }

    /// Whether lives have a mean and a standard deviation.
    fn has_moments(&self) -> bool {
        true
    }
}

/// A law of a parameter over units, in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomLaw {
    /// Shape, of a Gamma law.
    pub shape: Option<f64>,
    /// Rate, of a Gamma law.
    pub rate: Option<f64>,
    /// Mean; of a truncated normal law that of the law before truncation.
    pub mean: f64,
    /// Standard deviation, likewise.
    pub std: f64,
}
