//! Entries that few runs ask for, each written when it is first asked for. In: tapes. Out: answers. Never knows which entries.

use std::sync::{Mutex, OnceLock, PoisonError};

use linkwear_runtime::Entry;
use linkwear_tape::{Routine, Tapes};

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
use crate::functions::Functions;
#[cfg(not(any(target_arch = "aarch64", target_arch = "x86_64")))]
use crate::unsupported::Functions;

/// What answers an entry.
enum Written {
    Code(Functions),
    /// Where the system gives no more memory that may be run: in the same bits.
    Interpreted(Routine),
    /// Without a tape there are no values.
    Nothing,
}

impl Written {
    fn new(tapes: &dyn Tapes, entry: Entry) -> Self {
        let Some(tape) = tapes.tape(entry) else { return Self::Nothing };
        let code = Functions::of_entries::<1>(tapes, &[entry]);
        code.map_or_else(|_| Self::Interpreted(Routine::new(tape)), Self::Code)
    }

    fn workspace(&self) -> usize {
        match self {
            Self::Code(functions) => functions.workspace(),
            Self::Interpreted(routine) => routine.workspace(),
            Self::Nothing => 0,
        }
    }

    fn run(&self, input: &[f64], output: &mut [f64], workspace: &mut [f64]) {
        match self {
            Self::Code(functions) => functions.run(0, input, output, workspace),
            Self::Interpreted(routine) => routine.run(input, output, workspace),
            Self::Nothing => output.fill(f64::NAN),
        }
    }
}

/// What answers an entry, and a scratch slice for those who have none that is long enough.
type Answer = (Written, Mutex<Vec<f64>>);

/// By entry, what answers it, once it was asked for.
#[derive(Default)]
pub(crate) struct Seldom([OnceLock<Answer>; Entry::ALL.len()]);

impl Seldom {
    /// Evaluates an entry. Allocates when it is asked for first.
    ///
    /// # Panics
    /// If input or output is too short.
    pub(crate) fn evaluate(
        &self,
        tapes: &dyn Tapes,
        entry: Entry,
        (input, output, workspace): (&[f64], &mut [f64], &mut [f64]),
    ) {
        let (written, own) = self.0[entry as usize].get_or_init(|| {
            let written = Written::new(tapes, entry);
            let own = Mutex::new(vec![0.0; written.workspace()]);
            (written, own)
        });
        if workspace.len() < written.workspace() {
            written.run(input, output, &mut own.lock().unwrap_or_else(PoisonError::into_inner));
        } else {
            written.run(input, output, workspace);
        }
    }
}
