//! From graph to tape: live nodes in a stable order, signs absorbed, outputs stored as soon as known.
//! In: a graph and one function over it. Out: a tape. The last place where anything is rewritten.
//!
//! Order: small functions keep the order in which the derivation made the nodes, so that sections stay
//! together for readers; functions beyond `READABLE` statements go depth first from output to output,
//! which keeps values short-lived.

use rustc_hash::FxHashMap;

use crate::derive::{Equations, Function};
use crate::expr::{Binary, ExprId, Graph, Node, Unary};

use super::{Op, Operand, Statement, Tape, verify};

/// Above this many live nodes order serves the machine, not the reader.
const READABLE: usize = 3000;

/// Lowers every function of a set of equations.
pub fn lower(equations: &Equations) -> Vec<Tape> {
    equations.functions.iter().map(|function| lower_function(&equations.graph, function)).collect()
}

fn lower_function(graph: &Graph, function: &Function) -> Tape {
    let roots: Vec<ExprId> =
        function.outputs.iter().flat_map(|block| block.entries.iter().copied()).collect();
    let uses = graph.uses(&roots);
    let mut lowerer = Lowerer::new(graph, function, &uses);
    for id in order(graph, &uses, &roots) {
        lowerer.node(id);
    }
    lowerer.finish(&roots)
}

/// The needed nodes, each after those that it is computed from.
fn order(graph: &Graph, uses: &[u32], roots: &[ExprId]) -> Vec<ExprId> {
    let by_creation: Vec<ExprId> =
        (0..uses.len()).filter(|index| uses[*index] > 0).map(ExprId::new).collect();
    if by_creation.len() <= READABLE {
        return by_creation;
    }
    let mut done = vec![false; uses.len()];
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

struct Lowerer<'a> {
    graph: &'a Graph,
    /// See [`Graph::uses`].
    uses: &'a [u32],
    inputs: FxHashMap<ExprId, u32>,
    /// By node; nothing reads those that are not made.
    operands: Vec<Operand>,
    /// Statement of the sine and cosine of an angle.
    angles: FxHashMap<ExprId, usize>,
    /// Statement that defines a node.
    defined: FxHashMap<ExprId, usize>,
    /// Sections of the graph as those of the tape.
    sections: FxHashMap<usize, usize>,
    tape: Tape,
}

impl<'a> Lowerer<'a> {
    fn new(graph: &'a Graph, function: &Function, uses: &'a [u32]) -> Self {
        let inputs = || function.inputs.iter().flat_map(|block| block.entries.iter().copied());
        #[expect(clippy::expect_used, reason = "the derivation makes the inputs of functions of symbols")]
        let name = |id| graph.symbol_name(graph.as_symbol(id).expect("inputs are symbols")).to_owned();
        let tape = Tape {
            name: function.name.clone(),
            doc: function.doc.clone(),
            inputs: function.inputs.clone(),
            input_names: inputs().map(name).collect(),
            outputs: function.outputs.clone(),
            direct: Vec::new(),
            statements: Vec::new(),
            sections: Vec::new(),
            values: 0,
        };
        let inputs = (0..).zip(inputs()).map(|(index, id)| (id, index)).collect();
        let operands = vec![Operand::Constant(f64::NAN); uses.len()];
        let (angles, defined, sections) = Default::default();
        Self { graph, uses, inputs, operands, angles, defined, sections, tape }
    }

    fn operand(&self, id: ExprId) -> Operand {
        self.operands[id.index()]
    }

    fn node(&mut self, id: ExprId) {
        let operand = match self.graph.node(id) {
            Node::Constant(bits) => Operand::Constant(f64::from_bits(bits)),
            Node::Symbol(_) => Operand::Input(self.inputs[&id]),
            Node::Unary(Unary::Sin, angle) => self.sine_or_cosine(id, angle, 0),
            Node::Unary(Unary::Cos, angle) => self.sine_or_cosine(id, angle, 1),
            Node::Unary(Unary::Neg, inner) => self.negated(id, inner),
            // A product or difference that only its negative needs is made by that.
            _ if self.made_by_negative(id) => return,
            Node::Unary(operation, a) => self.push(id, Op::Unary(operation, self.operand(a))),
            Node::Binary(operation, a, b) => {
                self.push(id, Op::Binary(operation, self.operand(a), self.operand(b)))
            }
        };
        self.operands[id.index()] = operand;
    }

    /// Whether the node's only user is a negation that can absorb its sign.
    fn made_by_negative(&self, id: ExprId) -> bool {
        self.uses[id.index()] == 1 && self.absorbs_sign(id) && self.negated_only(id)
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
        self.graph.negation_of(id).is_some_and(|negation| self.uses[negation.index()] > 0)
    }

    fn negated(&mut self, id: ExprId, inner: ExprId) -> Operand {
        if self.made_by_negative(inner) {
            let flip = |operand: Operand| match operand {
                Operand::Constant(number) => Operand::Constant(-number),
                other => other,
            };
            if let Node::Binary(operation, a, b) = self.graph.node(inner) {
                let (a, b) = (self.operand(a), self.operand(b));
                let (a, b) = if operation == Binary::Sub { (b, a) } else { (flip(a), flip(b)) };
                return self.push(id, Op::Binary(operation, a, b));
            }
        }
        match self.operand(inner) {
            Operand::Constant(number) => Operand::Constant(-number),
            operand => self.push(id, Op::Unary(Unary::Neg, operand)),
        }
    }

    fn sine_or_cosine(&mut self, id: ExprId, angle: ExprId, which: u32) -> Operand {
        let statement = match self.angles.get(&angle) {
            Some(statement) => *statement,
            None => {
                self.push(id, Op::SinCos(self.operand(angle)));
                let statement = self.tape.statements.len() - 1;
                self.tape.statements[statement].labels = [None, None];
                self.angles.insert(angle, statement);
                statement
            }
        };
        let label = self.graph.label_of(id).map(str::to_owned);
        let entry = &mut self.tape.statements[statement];
        entry.labels[which as usize] = label;
        self.defined.insert(id, statement);
        Operand::Value(entry.first + which)
    }

    fn push(&mut self, id: ExprId, op: Op) -> Operand {
        let titles = &mut self.tape.sections;
        let section = *self.sections.entry(self.graph.section_index(id)).or_insert_with(|| {
            titles.push(self.graph.section(id).to_owned());
            titles.len() - 1
        });
        let label = self.graph.label_of(id).map(str::to_owned);
        let first = self.tape.values;
        let statement = Statement { op, first, labels: [label, None], section, stores: Vec::new() };
        self.tape.values = statement.results().end;
        self.defined.insert(id, self.tape.statements.len());
        self.tape.statements.push(statement);
        Operand::Value(first)
    }

    fn finish(mut self, roots: &[ExprId]) -> Tape {
        for (index, root) in (0..).zip(roots) {
            let store = (index, self.operand(*root));
            match self.defined.get(root) {
                Some(statement) => self.tape.statements[*statement].stores.push(store),
                None => self.tape.direct.push(store),
            }
        }
        debug_assert_eq!(verify(&self.tape), Ok(()));
        self.tape
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derive::Block;
    use crate::expr::{Expr, Scope};

    fn lowered<const N: usize>(
        build: impl for<'g> Fn(&'g Scope, Expr<'g>, Expr<'g>) -> [Expr<'g>; N],
    ) -> Tape {
        let g = Scope::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let outputs = vec![Block::vector("y", build(&g, a, b))];
        let inputs = vec![Block::vector("x", [a, b])];
        let function = Function { name: "test".into(), doc: String::new(), inputs, outputs };
        lower_function(&g.into_graph(), &function)
    }

    #[test]
    fn a_negated_difference_is_one_operation() {
        let tape = lowered(|_, a, b| [b - a]);
        assert_eq!(tape.statements.len(), 1);
        assert!(matches!(
            tape.statements[0].op,
            Op::Binary(Binary::Sub, Operand::Input(1), Operand::Input(0))
        ));
    }

    #[test]
    fn sine_and_cosine_of_one_angle_are_one_operation() {
        let tape = lowered(|_, a, _| [a.sin(), a.cos()]);
        assert_eq!(tape.statements.len(), 1);
        assert_eq!(tape.values, 2);
    }

    #[test]
    fn outputs_that_are_numbers_or_inputs_need_no_statement() {
        let tape = lowered(|g, a, _| [g.number(2.0), a]);
        assert_eq!(tape.direct, vec![(0, Operand::Constant(2.0)), (1, Operand::Input(0))]);
    }
}
