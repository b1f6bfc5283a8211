//! aarch64 processors: their instructions, which of them do an operation, their bytes. Compiled for tests everywhere, so
//! that it can be worked on where no such processor is.

mod bounds;
mod encode;
mod instruction;
mod select;
#[cfg(test)]
mod tests;

#[cfg(target_arch = "aarch64")]
pub(crate) use here::{functions, target, target_of_columns};

/// What this processor runs.
#[cfg(target_arch = "aarch64")]
mod here {
    use crate::memory::called::address;
    use crate::refusal::Refusal;
    use crate::straight::graph::Function;

    use super::instruction::{Lanes, REGISTERS, Target};

    /// What code for one, four or eight states side by side may use here; several go two by two.
    pub(crate) fn target<const LANES: usize>() -> Result<Target, Refusal> {
        let lanes = const {
            match LANES {
                1 => Lanes::One,
                4 | 8 => Lanes::Two,
                _ => panic!("one, four or eight lanes"),
            }
        };
        // Every such processor has all of it; elsewhere a program may not make the caches agree by itself.
        if !cfg!(target_os = "linux") {
            return Err(Refusal::Processor { needed: "an aarch64 processor under Linux" });
        }
        Ok(Target { lanes, states: LANES, registers: REGISTERS })
    }

    /// Code that reads columns where they lie is not written for these processors yet.
    pub(crate) fn target_of_columns<const LANES: usize>() -> Result<Target, Refusal> {
        Err(Refusal::Processor { needed: "an x86-64 processor" })
    }

    /// Where the functions lie that this code calls.
    pub(crate) fn functions<const LANES: usize>() -> impl Fn(Function) -> usize + Sync {
        if LANES == 1 { address::<1> } else { address::<2> }
    }
}
