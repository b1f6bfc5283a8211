//! From graph to tape: live nodes in a stable order, signs absorbed, outputs stored as soon as known.
//! In: a graph and one function over it. Out: a tape. The last place where anything is rewritten.
//!
//! Order: small functions keep the order in which the derivation made the nodes, so that sections stay
//! together for readers; functions beyond `READABLE` statements go depth first from output to output,
//! which keeps values short-lived.

use std::collections::HashMap;

use crate::derive::{Block, Equations, Function};
use crate::expr::{Binary, ExprId, Graph, Node, Unary};

use super::{Op, Operand, Slot, Statement, Tape, Value};

/// Above this many live nodes order serves the machine, not the reader.
const READABLE: usize = 3000;

/// Lowers every function of a set of equations.
pub fn lower(equations: &Equations) -> Vec<Tape> {
    equations.functions.iter().map(|function| lower_function(&equations.graph, function)).collect()
}

fn lower_function(graph: &Graph, function: &Function) -> Tape {
    let roots: Vec<ExprId> =
        function.outputs.iter().flat_map(|block| block.entries.iter().copied()).collect();
    let live = Live::new(graph, &roots);
    let mut lowerer = Lowerer::new(graph, function, &live);
    for id in live.order(graph, &roots) {
        lowerer.node(id);
    }
    lowerer.finish(function, &roots)
}

/// Which nodes are needed and how often.
struct Live {
    uses: Vec<u32>,
}

impl Live {
    fn new(graph: &Graph, roots: &[ExprId]) -> Self {
        let mut uses = vec![0_u32; graph.len()];
        for root in roots {
            uses[root.index()] += 1;
        }
        // Children come before parents, so one sweep from the end counts every use.
        for index in (0..graph.len()).rev() {
            if uses[index] > 0 {
                for child in graph.node(ExprId::new(index)).children() {
                    uses[child.index()] += 1;
                }
            }
        }
        Self { uses }
    }

    fn order(&self, graph: &Graph, roots: &[ExprId]) -> Vec<ExprId> {
        let by_creation: Vec<ExprId> =
            (0..graph.len()).filter(|index| self.uses[*index] > 0).map(ExprId::new).collect();
        if by_creation.len() <= READABLE {
            return by_creation;
        }
        let mut done = vec![false; graph.len()];
        let mut order = Vec::with_capacity(by_creation.len());
        let mut stack: Vec<(ExprId, bool)> = Vec::new();
        for root in roots {
            stack.push((*root, false));
            while let Some((id, visited)) = stack.pop() {
                if done[id.index()] {
                    continue;
                }
                if visited {
                    done[id.index()] = true;
                    order.push(id);
                } else {
                    stack.push((id, true));
                    let mut below: Vec<ExprId> = graph.node(id).children().collect();
                    below.reverse();
                    stack.extend(below.into_iter().map(|child| (child, false)));
                }
            }
        }
        order
    }
}

struct Lowerer<'a> {
    graph: &'a Graph,
    live: &'a Live,
    inputs: HashMap<ExprId, u32>,
    operands: HashMap<ExprId, Operand>,
    /// Statement of the sine and cosine of an angle.
    angles: HashMap<ExprId, usize>,
    /// Statement that defines a node.
    defined: HashMap<ExprId, usize>,
    statements: Vec<Statement>,
    sections: Vec<String>,
    values: Value,
}

impl<'a> Lowerer<'a> {
    fn new(graph: &'a Graph, function: &Function, live: &'a Live) -> Self {
        let inputs = function.inputs.iter().flat_map(|block| block.entries.iter().copied());
        Self {
            graph,
            live,
            inputs: (0..).zip(inputs).map(|(index, id)| (id, index)).collect(),
            operands: HashMap::new(),
            angles: HashMap::new(),
            defined: HashMap::new(),
            statements: Vec::new(),
            sections: Vec::new(),
            values: 0,
        }
    }

    fn node(&mut self, id: ExprId) {
        let operand = match self.graph.node(id) {
            Node::Constant(bits) => Operand::Constant(f64::from_bits(bits)),
            Node::Symbol(_) => Operand::Input(
                *self.inputs.get(&id).expect("a function reads only symbols that are among its inputs"),
            ),
            Node::Unary(Unary::Sin, angle) => self.sine_or_cosine(id, angle, 0),
            Node::Unary(Unary::Cos, angle) => self.sine_or_cosine(id, angle, 1),
            Node::Unary(Unary::Neg, inner) => self.negated(id, inner),
            // A product or difference that only its negative needs is made by that.
            _ if self.made_by_negative(id) => return,
            Node::Unary(operation, a) => self.push(id, Op::Unary(operation, self.operands[&a])),
            Node::Binary(operation, a, b) => {
                self.push(id, Op::Binary(operation, self.operands[&a], self.operands[&b]))
            }
        };
        self.operands.insert(id, operand);
    }

    /// Whether the node's only user is a negation that can absorb its sign.
    fn made_by_negative(&self, id: ExprId) -> bool {
        self.live.uses[id.index()] == 1 && self.absorbs_sign(id) && self.negated_only(id)
    }

    fn absorbs_sign(&self, id: ExprId) -> bool {
        match self.graph.node(id) {
            Node::Binary(Binary::Sub, ..) => true,
            Node::Binary(Binary::Mul, a, b) => {
                self.graph.as_constant(a).is_some() || self.graph.as_constant(b).is_some()
            }
            _ => false,
        }
    }

    fn negated_only(&self, id: ExprId) -> bool {
        self.graph.negation_of(id).is_some_and(|negation| self.live.uses[negation.index()] > 0)
    }

    fn negated(&mut self, id: ExprId, inner: ExprId) -> Operand {
        if self.made_by_negative(inner) {
            let op = match self.graph.node(inner) {
                Node::Binary(Binary::Sub, a, b) => {
                    Op::Binary(Binary::Sub, self.operands[&b], self.operands[&a])
                }
                Node::Binary(operation, a, b) => {
                    let flip = |operand: Operand| match operand {
                        Operand::Constant(number) => Operand::Constant(-number),
                        other => other,
                    };
                    Op::Binary(operation, flip(self.operands[&a]), flip(self.operands[&b]))
                }
                _ => unreachable!("only differences and products absorb a sign"),
            };
            return self.push(id, op);
        }
        match self.operands[&inner] {
            Operand::Constant(number) => Operand::Constant(-number),
            operand => self.push(id, Op::Unary(Unary::Neg, operand)),
        }
    }

    fn sine_or_cosine(&mut self, id: ExprId, angle: ExprId, which: u32) -> Operand {
        let statement = match self.angles.get(&angle) {
            Some(statement) => *statement,
            None => {
                self.push(id, Op::SinCos(self.operands[&angle]));
                let statement = self.statements.len() - 1;
                self.statements[statement].labels = [None, None];
                self.angles.insert(angle, statement);
                statement
            }
        };
        let label = self.graph.label_of(id).map(str::to_owned);
        let entry = &mut self.statements[statement];
        entry.labels[which as usize] = label;
        self.defined.insert(id, statement);
        Operand::Value(entry.first + which)
    }

    fn push(&mut self, id: ExprId, op: Op) -> Operand {
        let title = self.graph.section(id);
        let section = self.sections.iter().position(|known| known == title).unwrap_or_else(|| {
            self.sections.push(title.to_owned());
            self.sections.len() - 1
        });
        let label = self.graph.label_of(id).map(str::to_owned);
        let first = self.values;
        self.values += op.results();
        self.defined.insert(id, self.statements.len());
        self.statements.push(Statement { op, first, labels: [label, None], section, stores: Vec::new() });
        Operand::Value(first)
    }

    fn finish(mut self, function: &Function, roots: &[ExprId]) -> Tape {
        let mut direct = Vec::new();
        for (index, root) in (0..).zip(roots) {
            let operand = self.operands[root];
            match self.defined.get(root) {
                Some(statement) => self.statements[*statement].stores.push((index, operand)),
                None => direct.push((index, operand)),
            }
        }
        let input_names = function.inputs.iter().flat_map(|block| {
            block.entries.iter().map(|id| {
                let symbol = self.graph.as_symbol(*id).expect("inputs are symbols");
                self.graph.symbol_name(symbol).to_owned()
            })
        });
        Tape {
            name: function.name.clone(),
            doc: function.doc.clone(),
            inputs: slots(&function.inputs),
            input_names: input_names.collect(),
            outputs: slots(&function.outputs),
            direct,
            statements: self.statements,
            sections: self.sections,
            values: self.values,
        }
    }
}

fn slots(blocks: &[Block]) -> Vec<Slot> {
    let mut first = 0;
    blocks
        .iter()
        .map(|block| {
            let slot = Slot {
                name: block.name.clone(),
                doc: block.doc.clone(),
                citation: block.citation.clone(),
                first,
                rows: block.rows,
                columns: block.columns,
            };
            first += slot.len();
            slot
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tape::verify;

    fn function(outputs: Vec<ExprId>, inputs: Vec<ExprId>) -> Function {
        Function {
            name: "test".into(),
            doc: String::new(),
            inputs: vec![Block::vector("x", "", "", inputs)],
            outputs: vec![Block::vector("y", "", "", outputs)],
        }
    }

    #[test]
    fn a_negated_difference_is_one_operation() {
        let mut g = Graph::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let backward = g.sub(b, a);
        let tape = lower_function(&g, &function(vec![backward], vec![a, b]));
        assert_eq!(tape.statements.len(), 1);
        assert_eq!(verify(&tape), Ok(()));
        assert!(matches!(
            tape.statements[0].op,
            Op::Binary(Binary::Sub, Operand::Input(1), Operand::Input(0))
        ));
    }

    #[test]
    fn sine_and_cosine_of_one_angle_are_one_operation() {
        let mut g = Graph::new();
        let a = g.symbol("a");
        let (s, c) = (g.sin(a), g.cos(a));
        let tape = lower_function(&g, &function(vec![s, c], vec![a]));
        assert_eq!(tape.statements.len(), 1);
        assert_eq!(tape.values, 2);
    }

    #[test]
    fn outputs_that_are_numbers_or_inputs_need_no_statement() {
        let mut g = Graph::new();
        let a = g.symbol("a");
        let two = g.constant(2.0);
        let tape = lower_function(&g, &function(vec![two, a], vec![a]));
        assert_eq!(tape.direct, vec![(0, Operand::Constant(2.0)), (1, Operand::Input(0))]);
    }
}
