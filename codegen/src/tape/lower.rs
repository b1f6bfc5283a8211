//! From graph to tape: live nodes in a stable order, signs absorbed, outputs stored as soon as known.
//! In: a graph and one function over it. Out: a tape. The last place where anything is rewritten.
//!
//! Order: small functions keep the order in which the derivation made the nodes, so that sections stay
//! together for readers; functions beyond `READABLE` statements go depth first from output to output,
//! which keeps values short-lived.

use rustc_hash::FxHashMap;

use crate::derive::{Block, Equations, Function};
use crate::expr::{Binary, ExprId, Graph, Node, Signs, Unary};

use super::groups::{groups, of_group};
use super::{Op, Operand, Statement, Tape, verify};

/// Above this many live nodes order serves the machine, not the reader.
const READABLE: usize = 3000;

/// Lowers every function of a set of equations, operation by operation as the derivation made them.
pub fn lower(equations: &Equations) -> Vec<Tape> {
    groups(equations)
        .flat_map(|(graph, group)| of_group(group, &|function| lower_function(graph, function)))
        .collect()
}

/// Lowers a function, operation by operation as the graph has it.
pub fn lower_function(graph: &Graph, function: &Function) -> Tape {
    let roots: Vec<ExprId> =
        function.outputs.iter().flat_map(|block| block.entries.iter().copied()).collect();
    let uses = graph.uses(&roots);
    let live = graph.live(&uses);
    let mut lowerer = Lowerer::new(graph, function, Signs::of(graph, &uses, &live), uses.len());
    let order = order(graph, live, &roots);
    lowerer.find_negations(&order);
    for id in order {
        lowerer.node(id);
    }
    lowerer.finish(&roots)
}

/// The needed nodes, each after those that it is computed from.
fn order(graph: &Graph, by_creation: Vec<ExprId>, roots: &[ExprId]) -> Vec<ExprId> {
    if by_creation.len() <= READABLE {
        return by_creation;
    }
    let mut done = vec![false; by_creation.last().map_or(0, |id| id.index() + 1)];
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
                let below = stack.len();
                stack.extend(graph.node(id).children().map(|child| (child, false)));
                stack[below..].reverse();
            }
        }
    }
    order
}

fn negative(operand: Operand) -> Operand {
    match operand {
        Operand::Constant(number) => Operand::Constant(-number),
        other => other,
    }
}

struct Lowerer<'a> {
    graph: &'a Graph,
    signs: Signs,
    /// By a node that is made with the other sign, the negation that wants it so.
    negations: FxHashMap<ExprId, ExprId>,
    inputs: FxHashMap<ExprId, u32>,
    /// By node; nothing reads those that are not made.
    operands: Vec<Operand>,
    /// Statement of the sine and cosine of an angle.
    angles: FxHashMap<ExprId, usize>,
    /// By node, the statement that defines it.
    defined: Vec<Option<u32>>,
    /// Sections of the graph as those of the tape.
    sections: FxHashMap<u32, usize>,
    /// The same of the last statement, which most others follow in.
    last_section: Option<(u32, usize)>,
    tape: Tape,
}

impl<'a> Lowerer<'a> {
    fn new(graph: &'a Graph, function: &Function, signs: Signs, nodes: usize) -> Self {
        let inputs = || function.inputs.iter().flat_map(|block| block.entries.iter().copied());
        #[expect(clippy::expect_used, reason = "the derivation makes the inputs of functions of symbols")]
        let name = |id| graph.symbol_name(graph.as_symbol(id).expect("inputs are symbols")).to_owned();
        let tape = Tape {
            name: function.name.clone(),
            doc: function.doc.clone(),
            inputs: function.inputs.iter().map(Block::header).collect(),
            input_names: inputs().map(name).collect(),
            outputs: function.outputs.iter().map(Block::header).collect(),
            direct: Vec::new(),
            statements: Vec::new(),
            sections: Vec::new(),
            values: 0,
        };
        let inputs = (0..).zip(inputs()).map(|(index, id)| (id, index)).collect();
        let operands = vec![Operand::Constant(f64::NAN); nodes];
        let defined = vec![None; nodes];
        let (negations, angles, sections) = Default::default();
        let last_section = None;
        Self { graph, signs, negations, inputs, operands, angles, defined, sections, last_section, tape }
    }

    fn operand(&self, id: ExprId) -> Operand {
        self.operands[id.index()]
    }

    fn find_negations(&mut self, live: &[ExprId]) {
        for id in live {
            if let Node::Unary(Unary::Neg, inner) = self.graph.node(*id)
                && self.signs.is_reversed(inner)
            {
                self.negations.insert(inner, *id);
            }
        }
    }

    fn node(&mut self, id: ExprId) {
        let operand = match self.graph.node(id) {
            Node::Constant(bits) => Operand::Constant(f64::from_bits(bits)),
            Node::Symbol(_) => Operand::Input(self.inputs[&id]),
            Node::Unary(Unary::Sin, angle) => self.sine_or_cosine(id, angle, 0),
            Node::Unary(Unary::Cos, angle) => self.sine_or_cosine(id, angle, 1),
            Node::Unary(Unary::Neg, inner) => self.negated(id, inner),
            Node::Unary(operation, a) => self.push(id, Op::Unary(operation, self.operand(a))),
            Node::Select(a, yes, no) => {
                self.push(id, Op::Select(self.operand(a), self.operand(yes), self.operand(no)))
            }
            Node::Binary(operation, ..) if self.signs.is_reversed(id) => self.reversed(id, operation),
            Node::Binary(operation, a, b) => {
                self.push(id, Op::Binary(operation, self.operand(a), self.operand(b)))
            }
        };
        self.operands[id.index()] = operand;
    }

    /// The negative of a binary node, by operands of which one may have its sign changed already: see [`Signs`].
    fn reversed(&mut self, id: ExprId, operation: Binary) -> Operand {
        let below: Vec<ExprId> = self.graph.node(id).children().collect();
        let operands = [below[0], below[1]].map(|child| self.operand(child));
        let turned = [below[0], below[1]].map(|child| self.signs.is_reversed(child));
        let op = match (operation, operands, turned) {
            (Binary::Sub, [a, b], _) => Op::Binary(Binary::Sub, b, a),
            // -(a + b) is (-a) - b.
            (Binary::Add, [a, b], [true, _]) => Op::Binary(Binary::Sub, a, b),
            (Binary::Add, [a, b], [_, true]) => Op::Binary(Binary::Sub, b, a),
            (Binary::Add, [Operand::Constant(a), b], _) => Op::Binary(Binary::Sub, Operand::Constant(-a), b),
            (Binary::Add, [a, Operand::Constant(b)], _) => Op::Binary(Binary::Sub, Operand::Constant(-b), a),
            (_, [a, b], [false, false]) => {
                let (a, b) = match a {
                    Operand::Constant(a) => (Operand::Constant(-a), b),
                    _ => (a, negative(b)),
                };
                Op::Binary(operation, a, b)
            }
            (_, [a, b], _) => Op::Binary(operation, a, b),
        };
        let named = self.negations.get(&id).copied();
        let operand = self.push(named.unwrap_or(id), op);
        if named.is_none() {
            // Its name says the other sign.
            let last = self.tape.statements.len() - 1;
            self.tape.statements[last].labels = [None, None];
        }
        operand
    }

    fn negated(&mut self, id: ExprId, inner: ExprId) -> Operand {
        match self.operand(inner) {
            operand if self.signs.is_reversed(inner) => operand,
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
        let operand = Operand::Value(entry.first + which);
        self.defined[id.index()] = u32::try_from(statement).ok();
        operand
    }

    fn push(&mut self, id: ExprId, op: Op) -> Operand {
        let of_graph = self.graph.section_index(id);
        let section = match self.last_section {
            Some((known, section)) if known == of_graph => section,
            _ => {
                let titles = &mut self.tape.sections;
                *self.sections.entry(of_graph).or_insert_with(|| {
                    titles.push(self.graph.section(id).to_owned());
                    titles.len() - 1
                })
            }
        };
        self.last_section = Some((of_graph, section));
        let label = self.graph.label_of(id).map(str::to_owned);
        let first = self.tape.values;
        let statement = Statement { op, first, labels: [label, None], section, stores: Vec::new() };
        self.tape.values = statement.results().end;
        // Values are counted in 32 bits, and each statement has one.
        self.defined[id.index()] = u32::try_from(self.tape.statements.len()).ok();
        self.tape.statements.push(statement);
        Operand::Value(first)
    }

    fn finish(mut self, roots: &[ExprId]) -> Tape {
        let direct = roots.iter().filter(|root| self.defined[root.index()].is_none()).count();
        self.tape.direct.reserve_exact(direct);
        for (index, root) in (0..).zip(roots) {
            let store = (index, self.operand(*root));
            match self.defined[root.index()] {
                Some(statement) => self.tape.statements[statement as usize].stores.push(store),
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
    use crate::expr::{Expr, Scope};

    fn lowered<const N: usize>(
        build: impl for<'g> Fn(&'g Scope, Expr<'g>, Expr<'g>) -> [Expr<'g>; N],
    ) -> Tape {
        let g = Scope::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let outputs = vec![Block::vector("y", build(&g, a, b))];
        let inputs = vec![Block::vector("x", [a, b])];
        let function = Function { name: "test".into(), doc: String::new(), inputs, outputs, goes_on: false };
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
    fn signs_go_down_to_an_operand_that_can_take_them() {
        let tape = lowered(|_, a, b| [-((a - b) * a), -(1.0 / b), -((a - 3.0 * b) + a.square())]);
        assert_eq!(tape.statements.len(), 7);
        let changes = tape.statements.iter().filter(|one| matches!(one.op, Op::Unary(Unary::Neg, _)));
        assert_eq!(changes.count(), 0);
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
