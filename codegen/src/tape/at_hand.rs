//! Entry points by tapes as the derivation made them, each lowered when it is first asked for: looks at a state or two ask for few.
//! In: equations. Out: a [`System`]. Never knows who looks.

use std::cell::RefCell;
use std::sync::OnceLock;

use linkwear_runtime::{Entry, Sizes, System};

use crate::derive::Equations;

use super::Routine;
use super::groups::of_group;
use super::lower::lower_function;

/// What has been lowered: by a function, its routine and that of the one that goes on from it.
#[derive(Clone, Debug, Default)]
pub struct Lowered([OnceLock<Vec<Routine>>; Entry::ALL.len()]);

/// Equations, to be evaluated at once.
#[derive(Debug)]
pub struct AtHand<'a> {
    equations: &'a Equations,
    lowered: &'a Lowered,
    sizes: Sizes,
    /// Its length is known when a function is lowered, too late for those who ask for the sizes.
    workspace: RefCell<Vec<f64>>,
}

impl<'a> AtHand<'a> {
    /// What was lowered before is not lowered again.
    pub fn new(equations: &'a Equations, lowered: &'a Lowered, sizes: Sizes) -> Self {
        let workspace = RefCell::default();
        let mut system = Self { equations, lowered, sizes: Sizes { workspace: 0, ..sizes }, workspace };
        // Without contacts nothing is held.
        if sizes.contacts > 0 {
            system.sizes.held = system.routine(Entry::Contacts).outputs() - sizes.output(Entry::Contacts);
        }
        system
    }

    fn routine(&self, entry: Entry) -> &Routine {
        let functions = &self.equations.functions;
        let at = entry as usize;
        let goes_on = usize::from(functions[at].goes_on);
        let first = at - goes_on;
        let routines = self.lowered.0[first].get_or_init(|| {
            let next = functions.get(first + 1).filter(|next| next.goes_on);
            let lower = |function: &_| lower_function(&self.equations.graph, function);
            of_group((&functions[first], next), &lower).iter().map(Routine::for_a_look).collect()
        });
        &routines[goes_on]
    }
}

impl System<f64> for AtHand<'_> {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], _: &mut [f64]) {
        let routine = self.routine(entry);
        let mut workspace = self.workspace.borrow_mut();
        if workspace.len() < routine.workspace() {
            workspace.resize(routine.workspace(), 0.0);
        }
        routine.run(input, output, &mut workspace);
    }
}
