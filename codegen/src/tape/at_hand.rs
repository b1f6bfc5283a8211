//! Entry points by tapes as the derivation made them, each lowered when it is first asked for: looks at a state or two ask for few.
//! In: equations. Out: a [`System`]. Never knows who looks.

use std::cell::{OnceCell, RefCell};

use linkwear_runtime::{Entry, Sizes, System};

use crate::derive::{Block, Equations, Function};
use crate::expr::{ExprId, Graph};
use crate::sparse_rows::SparseRows;

use super::Routine;
use super::groups::{WhenAsked, of_group};
use super::lower::lower_function;

/// What has been lowered.
pub type Lowered = WhenAsked<Routine>;

/// The position residuals of all rows, then what is not always zero of their Jacobian by all speeds.
#[derive(Debug)]
struct Rows {
    routine: Routine,
    residuals: usize,
    /// By row, the speeds of these entries.
    speeds: Vec<Vec<usize>>,
}

impl Rows {
    fn new((graph, whole): (&Graph, &Function), all_speeds: usize) -> Self {
        let entries_of = |name: &str| {
            let block = whole.outputs.iter().find(|block| block.name == name);
            block.map_or(&[][..], |block| &block.entries)
        };
        let residuals = entries_of("phi");
        let mut outputs = residuals.to_vec();
        let mut speeds = Vec::with_capacity(residuals.len());
        let jacobian = entries_of("phi_q");
        for row in 0..residuals.len() {
            let row = &jacobian[row * all_speeds..][..all_speeds];
            let entries = row.iter().enumerate().filter(|(_, entry)| graph.as_constant(**entry) != Some(0.0));
            let (of_row, entries): (Vec<usize>, Vec<ExprId>) = entries.unzip();
            outputs.extend(entries);
            speeds.push(of_row);
        }
        let residuals = residuals.len();
        let function = Function { outputs: vec![Block::vector("rows", outputs)], ..whole.clone() };
        Self { routine: Routine::for_a_look(&lower_function(graph, &function)), residuals, speeds }
    }
}

/// Equations, to be evaluated at once.
#[derive(Debug)]
pub struct AtHand<'a> {
    equations: &'a Equations,
    lowered: &'a Lowered,
    sizes: Sizes,
    rows: OnceCell<Rows>,
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
    pub fn rows(&self, input: &[f64]) -> (Vec<f64>, SparseRows) {
        let all_speeds = self.sizes.all_speeds;
        let Rows { routine, residuals, speeds } = self.rows.get_or_init(|| {
            #[expect(clippy::expect_used, reason = "the derivation makes a function for every entry")]
            let of_entry =
                self.equations.function(Entry::EquationsOfMotion).expect("a function for every entry");
            Rows::new(of_entry, all_speeds)
        });
        let mut output = vec![0.0; routine.outputs()];
        self.run(routine, input, &mut output);
        let mut entries = output.split_off(*residuals).into_iter();
        let row = |speeds: &Vec<usize>| speeds.iter().copied().zip(entries.by_ref()).collect();
        (output, SparseRows::new(all_speeds, speeds.iter().map(row).collect()))
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
