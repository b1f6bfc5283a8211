//! What every code means, with an example that has the fault and the same one cured. In: a code. Out: words, lines of a
//! mechanism file. A test compiles all examples. Never knows what is wrong with a user's file.

mod assembly;
mod example;
mod flexible;
mod form;
mod mechanics;
mod names;
mod quantities;
mod structure;
mod warnings;

use super::Code;
pub use example::Explanation;

impl Code {
    /// What it means, with an example; every code has one.
    pub fn explanation(self) -> Option<&'static Explanation> {
        let groups = [
            form::FORM,
            names::NAMES,
            quantities::QUANTITIES,
            mechanics::MECHANICS,
            structure::STRUCTURE,
            assembly::ASSEMBLY,
            warnings::WARNINGS,
            warnings::PLAUSIBILITY,
            flexible::FLEXIBLE,
        ];
        groups.into_iter().flatten().find(|explanation| explanation.code == self)
    }
}
