//! The equations for people: named steps and outputs as text, Markdown or LaTeX, with operation counts.
//! In: [`Equations`]. Out: text. Never knows tapes' order or Rust syntax.

mod format;
mod formula;

use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;

use linkwear_runtime::Entry;

use crate::derive::{Block, Equations, Function};
use crate::expr::{ExprId, Graph, Node};
use crate::tape::{Operations, Tape, unshared_operations};

pub use format::TextFormat;
use formula::Formula;

/// One output of one function, with its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputInfo {
    /// Function that computes it.
    pub function: String,
    /// Name of the output.
    pub name: String,
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// Operations it needs on its own, common subexpressions computed once.
    pub operations: Operations,
    /// Operations with every formula written out in full.
    pub operations_unshared: Operations,
}

/// All outputs with their costs, in the order of the functions.
pub fn outputs(equations: &Equations, tapes: &[Tape]) -> Vec<OutputInfo> {
    let mut list = Vec::new();
    for ((graph, function), tape) in equations.functions().zip(tapes) {
        for (index, block) in function.outputs.iter().enumerate() {
            list.push(OutputInfo {
                function: function.name.clone(),
                name: block.name.clone(),
                rows: block.rows,
                cols: block.columns,
                operations: tape.operations_of(index),
                operations_unshared: unshared_operations(graph, &block.entries),
            });
        }
    }
    list
}

/// Whether a user's name means an output: its name, its function's, or `function.output`.
pub fn is_meant(function: &str, output: &str, name: &str) -> bool {
    output == name || function == name || name.split_once('.') == Some((function, output))
}

/// Formulas longer than this become a named step.
const LONG: usize = 48;

/// Entries that answer what others do, for machines: not written unless they are asked for by name.
const REPEATING: [Entry; 2] = [Entry::Accelerations, Entry::Derivative];

/// Writes the chosen outputs (if `only` is empty, all that do not repeat others).
pub fn render(equations: &Equations, tapes: &[Tape], only: &[String], format: TextFormat) -> String {
    let costs = outputs(equations, tapes);
    let mut text = String::new();
    let repeating = |function: &Function| REPEATING.iter().any(|entry| entry.name() == function.name);
    let asked = |function: &Function| only.iter().any(|name| name.split('.').next() == Some(&function.name));
    let written = |function: &Function| !repeating(function) || asked(function);
    for (graph, function) in equations.functions().filter(|(_, function)| written(function)) {
        let chosen: Vec<&Block> = function
            .outputs
            .iter()
            .filter(|block| {
                !block.entries.is_empty()
                    && (only.is_empty()
                        || only.iter().any(|name| is_meant(&function.name, &block.name, name)))
            })
            .collect();
        if !chosen.is_empty() {
            let writer = Writer::new(equations, (graph, function), &chosen, format);
            writer.write(&mut text, &costs);
        }
    }
    text
}

/// Whether a block stands for a mass matrix that is left out: to write so many zeros tells less than its comment.
fn mass_is_left_out(equations: &Equations, function: &Function, block: &Block) -> bool {
    function.name == Entry::EquationsOfMotion.name() && block.name == "mass" && equations.mass_is_left_out()
}

struct Writer<'a> {
    graph: &'a Graph,
    equations: &'a Equations,
    function: &'a Function,
    chosen: &'a [&'a Block],
    format: TextFormat,
    /// Steps in order, with their names.
    steps: Vec<ExprId>,
    names: HashMap<ExprId, String>,
}

impl<'a> Writer<'a> {
    fn new(
        equations: &'a Equations,
        (graph, function): (&'a Graph, &'a Function),
        chosen: &'a [&'a Block],
        format: TextFormat,
    ) -> Self {
        let mut writer =
            Self { graph, equations, function, chosen, format, steps: Vec::new(), names: HashMap::new() };
        writer.choose_steps();
        writer
    }

    /// Shared, labelled and long formulas become steps.
    fn choose_steps(&mut self) {
        let roots: Vec<ExprId> = self.chosen.iter().flat_map(|block| block.entries.clone()).collect();
        let mut uses = self.graph.uses(&roots);
        let live: Vec<ExprId> = (0..uses.len()).filter(|index| uses[*index] > 0).map(ExprId::new).collect();
        // An output is written where it stands: that is no use of a name.
        for root in &roots {
            uses[root.index()] -= 1;
        }
        let mut taken: BTreeSet<String> = BTreeSet::new();
        let mut lengths: HashMap<ExprId, usize> = HashMap::new();
        let mut number = 0;
        for id in live {
            let node = self.graph.node(id);
            let below: Vec<ExprId> = node.children().collect();
            if below.is_empty() {
                lengths.insert(id, 4);
                continue;
            }
            let length = below.iter().map(|child| lengths[child]).sum::<usize>() + 3;
            let shared = uses[id.index()] > 1 && !self.is_cheap(id);
            if shared || self.graph.label_of(id).is_some() || length > LONG {
                let wanted = self.graph.label_of(id).map_or_else(
                    || {
                        number += 1;
                        format!("t{number}")
                    },
                    str::to_owned,
                );
                let mut name = wanted.clone();
                let mut again = 2;
                while !taken.insert(name.clone()) {
                    name = format!("{wanted}_{again}");
                    again += 1;
                }
                self.names.insert(id, name);
                self.steps.push(id);
                lengths.insert(id, 4);
            } else {
                lengths.insert(id, length);
            }
        }
    }

    /// A change of sign reads well anywhere.
    fn is_cheap(&self, id: ExprId) -> bool {
        matches!(self.graph.node(id), Node::Unary(crate::expr::Unary::Neg, _))
    }

    fn write(&self, text: &mut String, costs: &[OutputInfo]) {
        self.heading(text, &self.function.name, &self.function.doc);
        self.begin_block(text);
        let mut section = "";
        for id in &self.steps {
            let title = self.graph.section(*id);
            if title != section {
                section = title;
                self.comment(text, title);
            }
            let right = self.formula().without_name(*id);
            self.line(text, &self.formula().name(&self.names[id]), &right);
        }
        for block in self.chosen {
            #[expect(clippy::expect_used, reason = "the costs are those of the same outputs")]
            let cost = costs
                .iter()
                .find(|info| info.function == self.function.name && info.name == block.name)
                .expect("every output has a cost");
            let header = block.header();
            let (shape, citation) = (header.shape(), header.cited());
            self.comment(
                text,
                &format!(
                    "{} ({shape}){citation}: {} {} operations shared, {} written out",
                    block.name, block.doc, cost.operations.total, cost.operations_unshared.total
                ),
            );
            if mass_is_left_out(self.equations, self.function, block) {
                continue;
            }
            for (index, id) in block.entries.iter().enumerate() {
                let left = self.formula().entry(&block.name, &self.entry_name(block, index));
                self.line(text, &left, &self.formula().write(*id));
            }
        }
        self.end_block(text);
    }

    fn formula(&self) -> Formula<'_> {
        Formula { graph: self.graph, names: &self.names, format: self.format }
    }

    /// What an entry is called: after the symbol of the same block where another function reads it.
    fn entry_name(&self, block: &Block, index: usize) -> String {
        if let Some(name) = block.names.get(index) {
            return name.clone();
        }
        let functions = self.equations.functions();
        let mut inputs =
            functions.flat_map(|(graph, function)| function.inputs.iter().map(move |input| (graph, input)));
        let read = inputs.find(|(_, input)| {
            input.entries.len() == block.entries.len()
                && (input.name == block.name || format!("{}_dot", input.name) == block.name)
        });
        let symbol = read.and_then(|(graph, input)| Some((graph, graph.as_symbol(input.entries[index])?)));
        match symbol {
            Some((graph, symbol)) => graph.symbol_name(symbol).to_owned(),
            None if block.columns > 1 => {
                format!("{},{}", index / block.columns + 1, index % block.columns + 1)
            }
            None => (index + 1).to_string(),
        }
    }

    fn heading(&self, text: &mut String, name: &str, doc: &str) {
        let escaped = self.formula().plain(doc);
        let _ = match self.format {
            TextFormat::Text => writeln!(text, "{name}: {doc}"),
            TextFormat::Markdown => writeln!(text, "## {name}\n\n{escaped}\n"),
            TextFormat::Latex => {
                writeln!(text, "\\subsection*{{{}}}\n{escaped}", self.formula().plain(name))
            }
        };
    }

    fn begin_block(&self, text: &mut String) {
        match self.format {
            TextFormat::Text => {}
            TextFormat::Markdown => text.push_str("```text\n"),
            TextFormat::Latex => text.push_str("\\begin{flalign*}\n"),
        }
    }

    fn end_block(&self, text: &mut String) {
        text.push_str(match self.format {
            TextFormat::Text => "\n",
            TextFormat::Markdown => "```\n\n",
            TextFormat::Latex => "\\end{flalign*}\n\n",
        });
    }

    fn comment(&self, text: &mut String, comment: &str) {
        let _ = match self.format {
            TextFormat::Latex => {
                writeln!(text, "&\\text{{{}}}&\\\\", self.formula().plain(comment))
            }
            _ => writeln!(text, "  # {comment}"),
        };
    }

    fn line(&self, text: &mut String, left: &str, right: &str) {
        let _ = match self.format {
            TextFormat::Latex => writeln!(text, "&{left} = {right}&\\\\"),
            _ => writeln!(text, "  {left} = {right}"),
        };
    }
}
