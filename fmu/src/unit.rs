//! What a unit's folder of resources holds. In: a program, constants. Out: bytes and back. Never knows files.

use linkwear_tape::Program;
use linkwear_tape::stored::{Damage, sealed, unsealed};

/// Name of the file in the folder `resources`.
pub const PROGRAM_FILE: &str = "mechanism.linkwear";

/// A number that generation folded into the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// Name in the file.
    pub name: String,
    /// SI unit, "1" if it has none.
    pub unit: String,
    /// Value in SI.
    pub value: f64,
}

/// A mechanism as a unit has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Description and equations.
    pub program: Program,
    /// What cannot change any more.
    pub constants: Vec<Constant>,
    /// Tells this unit from all others, as the model description does.
    pub instantiation_token: String,
}

linkwear_tape::stored!(struct Constant { name, unit, value });
linkwear_tape::stored!(struct Unit { program, constants, instantiation_token });

impl Unit {
    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        sealed(self)
    }

    /// From its bytes.
    ///
    /// # Errors
    /// If they are damaged, or another linkwear wrote them.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Damage> {
        unsealed(bytes)
    }
}
