//! x86-64 processors: what they have, their instructions, which of them do an operation, their bytes.

mod bounds;
mod emit;
mod encode;
mod features;
mod instruction;
mod masks;
mod select;
#[cfg(test)]
mod tests;

use crate::memory::called::address;
use crate::refusal::Refusal;
use crate::straight::graph::Function;

use instruction::{Lanes, Target};

/// What code for one, four or eight states side by side may use here.
pub(crate) fn target<const LANES: usize>() -> Result<Target, Refusal> {
    let lanes = const {
        match LANES {
            1 => Lanes::One,
            4 => Lanes::Four,
            8 => Lanes::Eight,
            _ => panic!("one, four or eight lanes"),
        }
    };
    let needed = match lanes {
        Lanes::Eight => "an x86-64 processor with AVX-512 (F, DQ, VL)",
        _ => "an x86-64 processor with AVX",
    };
    features::target(lanes).ok_or(Refusal::Processor { needed })
}

/// The same for code that reads and writes columns, each behind its pointer in a table.
pub(crate) fn target_of_columns<const LANES: usize>() -> Result<Target, Refusal> {
    Ok(Target { columns: true, ..target::<LANES>()? })
}

/// Where the functions lie that this code calls.
pub(crate) fn functions<const LANES: usize>() -> impl Fn(Function) -> usize + Sync {
    address::<LANES>
}
