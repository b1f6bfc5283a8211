//! Entry points by tapes as the derivation made them, each lowered when it is first asked for: looks at a state or two ask for few.
//! In: equations. Out: a [`System`]. Never knows who looks.

use std::cell::{OnceCell, RefCell};

use linkwear_runtime::{Entry, Sizes, System};

use crate::derive::{Block, Equations, Function};

use super::Routine;
use super::groups::{WhenAsked, of_group};
use super::lower::lower_function;

/// What has been lowered.
pub type Lowered = WhenAsked<Routine>;

/// Equations, to be evaluated at once.
#[derive(Debug)]
pub struct AtHand<'a> {
    equations: &'a Equations,
    lowered: &'a Lowered,
    sizes: Sizes,
    /// The position residuals of all rows and their Jacobian by all speeds alone.
    rows: OnceCell<Routine>,
    /// Its length is known when a function is lowered, too late for those who ask for the sizes.
    workspace: RefCell<Vec<f64>>,
}

impl<'a> AtHand<'a> {
    /// What was lowered before is not lowered again.
    pub fn new(equations: &'a Equations, lowered: &'a Lowered, sizes: Sizes) -> Self {
        let (rows, workspace) = (OnceCell::new(), RefCell::default());
        let mut system = Self { equations, lowered, sizes: Sizes { workspace: 0, ..sizes }, rows, workspace };
        // Without contacts nothing is held.
        if sizes.contacts > 0 {
            system.sizes = system.sizes.with_held(system.routine(Entry::Contacts).outputs());
        }
        system
    }

    /// Of the answer of [`Entry::EquationsOfMotion`] the position residuals and the Jacobian, bit by bit: an analysis asks for them
    /// hundreds of times, and they are a small part of it.
    pub fn rows(&self, input: &[f64]) -> Vec<f64> {
        let routine = self.rows.get_or_init(|| {
            #[expect(clippy::expect_used, reason = "the derivation makes a function for every entry")]
            let (graph, whole) =
                self.equations.function(Entry::EquationsOfMotion).expect("a function for every entry");
            let is_of_rows = |block: &&Block| ["phi", "phi_q"].contains(&&*block.name);
            let outputs = whole.outputs.iter().filter(is_of_rows).cloned().collect();
            Routine::for_a_look(&lower_function(graph, &Function { outputs, ..whole.clone() }))
        });
        let mut output = vec![0.0; routine.outputs()];
        self.run(routine, input, &mut output);
        output
    }

    fn run(&self, routine: &Routine, input: &[f64], output: &mut [f64]) {
        let mut workspace = self.workspace.borrow_mut();
        if workspace.len() < routine.workspace() {
            workspace.resize(routine.workspace(), 0.0);
        }
        routine.run(input, output, &mut workspace);
    }

    fn routine(&self, entry: Entry) -> &Routine {
        let routine = self.lowered.get(self.equations, entry, |(graph, group)| {
            let lower = |function: &_| lower_function(graph, function);
            of_group(group, &lower).iter().map(Routine::for_a_look).collect()
        });
        #[expect(clippy::expect_used, reason = "the derivation makes a function for every entry")]
        routine.expect("a function for every entry")
    }
}

impl System<f64> for AtHand<'_> {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], _: &mut [f64]) {
        self.run(self.routine(entry), input, output);
    }
}
