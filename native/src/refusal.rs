//! Why there is no machine code. In: what was found. Out: [`Refusal`].

use linkwear_runtime::Entry;
use thiserror::Error;

/// Why a mechanism does not run as machine code here; the interpreter runs it, in the same bits.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum Refusal {
    /// It is written for other processors.
    #[error("machine code needs {needed}, and this is another")]
    Processor {
        /// A processor, and what it must have.
        needed: &'static str,
    },
    /// The system gives no memory that may be run: it is hardened, or there is none left.
    #[error("the system gives no executable memory ({reason}); hardened systems and services may forbid it")]
    Memory {
        /// What the system says.
        reason: String,
    },
    /// The equations are longer than addresses reach.
    #[error("the equations need more than 2 GB of addresses")]
    TooLong,
    /// Trajectories side by side have laws that no lane can look up a profile in.
    #[error("wear by bearing angle runs one trajectory at a time")]
    Profile,
    /// A tape makes no sense.
    #[error("the tape of `{function}` is wrong: {defect}")]
    Tape {
        /// Its function.
        function: String,
        /// Its first defect.
        defect: String,
    },
}

impl Refusal {
    pub(crate) fn missing(entry: Entry) -> Self {
        Self::Tape { function: entry.name().to_owned(), defect: "there is none".to_owned() }
    }
}
