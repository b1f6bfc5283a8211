//! A mechanism as machine code. In: one tape per entry. Out: a [`System`]. Never knows how code is written.

use std::fmt;
use std::sync::Arc;

use linkwear_codegen::tape::Tape;
use linkwear_runtime::{Entry, Sizes, System};

use crate::refusal::Refusal;
#[cfg(not(target_arch = "x86_64"))]
use crate::unsupported::Functions;
#[cfg(target_arch = "x86_64")]
use crate::x86::Functions;

/// A mechanism as machine code of this processor. Clones share the code.
#[derive(Clone)]
pub struct Native {
    functions: Arc<Functions>,
    sizes: Sizes,
}

impl fmt::Debug for Native {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Native").field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl Native {
    /// Writes the code of tapes, in the order of [`Entry::ALL`]. `sizes.workspace` is set here.
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or a tape makes no sense.
    pub fn new(tapes: &[Tape], sizes: Sizes) -> Result<Self, Refusal> {
        if let Some(entry) = Entry::ALL.get(tapes.len()) {
            let (function, defect) = (entry.name().to_owned(), "there is none".to_owned());
            return Err(Refusal::Tape { function, defect });
        }
        let functions = Functions::new(tapes)?;
        let sizes = Sizes { workspace: functions.workspace(), ..sizes };
        Ok(Self { functions: Arc::new(functions), sizes })
    }
}

impl System<f64> for Native {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], workspace: &mut [f64]) {
        self.functions.run(entry as usize, input, output, workspace);
    }
}
