//! Cuts a tape in two that are asked one after the other: what the first outputs need, and the rest.
//! In: a tape of both. Out: two tapes. Values that cross are outputs of the first and inputs of the second.
//!
//! The first takes no more than its own outputs need: what crosses is stored and read again, which costs more than a
//! shorter second tape would gain.

use std::collections::BTreeMap;

use crate::derive::Function;

use super::{Block, Op, Operand, Statement, Tape, Value};

/// Name of the block of values that cross without being an answer.
const HELD: &str = "held";

/// A tape of two functions, to be cut.
pub(super) struct Joined<'a> {
    /// Its inputs are those of the second, its outputs those of the first, then those of the second.
    pub(super) tape: Tape,
    pub(super) functions: [&'a Function; 2],
}

/// The two tapes. Inputs of the second after its own: outputs of the first, in order.
pub(super) fn cut(joined: Joined<'_>) -> [Tape; 2] {
    let Joined { tape: whole, functions } = joined;
    let blocks = functions[0].outputs.len();
    let answers = length(&whole.outputs[..blocks]);
    let is_first = |store: &(u32, Operand)| store.0 < answers;
    let in_first = needed(&whole, answers);
    let mut crossing = Crossing::new(&whole, answers, &in_first);
    let held = crossing.held.len();
    let own = length(&whole.inputs);
    let [mut first, mut second] = functions.map(|function| Part::new(function, whole.values));
    for (value, index) in &crossing.places {
        second.known[*value as usize] = Some(Operand::Input(own + index));
    }
    for (index, operand) in &whole.direct {
        if *index < answers {
            first.tape.direct.push((*index, *operand));
        } else {
            second.tape.direct.push((index - answers, *operand));
        }
    }
    for (statement, is_needed) in whole.statements.iter().zip(in_first) {
        let (mut early, late): (Vec<_>, Vec<_>) = statement.stores.iter().copied().partition(is_first);
        let late = late.into_iter().map(|(index, operand)| (index - answers, operand));
        if is_needed {
            let held =
                statement.results().filter_map(|value| crossing.held.remove(&value).map(|at| (at, value)));
            early.extend(held.map(|(at, value)| (at, Operand::Value(value))));
            first.push(&whole, statement, early);
            second
                .tape
                .direct
                .extend(late.map(|(index, operand)| (index, second.known(operand))).collect::<Vec<_>>());
        } else {
            second.push(&whole, statement, late.collect());
        }
    }
    let mut answers_of_first = whole.outputs[..blocks].to_vec();
    let held = Block::vector(HELD, held).doc(&format!("Values that {} takes over.", functions[1].name));
    answers_of_first.extend((!held.is_empty()).then_some(held));
    second.tape.outputs = whole.outputs[blocks..].to_vec();
    second.tape.inputs = whole.inputs.iter().chain(&answers_of_first).cloned().collect();
    let names =
        answers_of_first.iter().flat_map(|block| (0..block.len()).map(|i| format!("{}{i}", block.name)));
    second.tape.input_names = whole.input_names.iter().cloned().chain(names).collect();
    let inputs = functions[0].inputs.len();
    first.tape.inputs = whole.inputs[..inputs].to_vec();
    first.tape.input_names = whole.input_names[..length(&first.tape.inputs) as usize].to_vec();
    first.tape.outputs = answers_of_first;
    [first.tape, second.tape]
}

#[expect(clippy::cast_possible_truncation, reason = "limits::EXPRESSIONS is far below the reach of 32 bits")]
fn length(blocks: &[Block]) -> u32 {
    blocks.iter().map(|block| block.len()).sum::<usize>() as u32
}

/// By statement: whether one of the outputs before `end` needs it.
fn needed(tape: &Tape, end: u32) -> Vec<bool> {
    let mut values = vec![false; tape.values as usize];
    let mut statements = vec![false; tape.statements.len()];
    for (at, statement) in tape.statements.iter().enumerate().rev() {
        for (index, operand) in &statement.stores {
            if let (true, Operand::Value(value)) = (*index < end, operand) {
                values[*value as usize] = true;
            }
        }
        statements[at] = statement.results().any(|value| values[value as usize]);
        if statements[at] {
            for value in statement.op.operands().filter_map(value_of) {
                values[value as usize] = true;
            }
        }
    }
    statements
}

fn value_of(operand: Operand) -> Option<Value> {
    match operand {
        Operand::Value(value) => Some(value),
        Operand::Input(_) | Operand::Constant(_) => None,
    }
}

/// Values of the first tape that the second one reads.
struct Crossing {
    /// Output of the first tape that has the value.
    places: BTreeMap<Value, u32>,
    /// Of these, by value, those that are no answers.
    held: BTreeMap<Value, u32>,
}

impl Crossing {
    fn new(whole: &Tape, answers: u32, in_first: &[bool]) -> Self {
        let mut home = vec![false; whole.values as usize];
        let mut answered = BTreeMap::new();
        for (statement, is_first) in whole.statements.iter().zip(in_first) {
            for value in statement.results() {
                home[value as usize] = *is_first;
            }
            for (index, operand) in statement.stores.iter().filter(|(index, _)| *index < answers) {
                answered.extend(value_of(*operand).map(|value| (value, *index)));
            }
        }
        let late = whole.statements.iter().zip(in_first).flat_map(|(statement, is_first)| {
            let stores = statement.stores.iter().filter(move |(index, _)| *index >= answers);
            let operands = statement.op.operands().filter(move |_| !is_first);
            operands.chain(stores.map(|(_, operand)| *operand))
        });
        let mut crossing = Self { places: BTreeMap::new(), held: BTreeMap::new() };
        let mut wanted: Vec<Value> =
            late.filter_map(value_of).filter(|value| home[*value as usize]).collect();
        wanted.sort_unstable();
        wanted.dedup();
        let mut next = answers;
        for value in wanted {
            let index = answered.get(&value).copied().unwrap_or_else(|| {
                crossing.held.insert(value, next);
                next += 1;
                next - 1
            });
            crossing.places.insert(value, index);
        }
        crossing
    }
}

/// One of the two tapes under construction.
struct Part {
    tape: Tape,
    /// Where a value of the whole is found.
    known: Vec<Option<Operand>>,
    /// Sections of the whole as those of the part.
    sections: BTreeMap<usize, usize>,
}

impl Part {
    fn new(function: &Function, values: u32) -> Self {
        let tape = Tape {
            name: function.name.clone(),
            doc: function.doc.clone(),
            inputs: Vec::new(),
            input_names: Vec::new(),
            outputs: Vec::new(),
            direct: Vec::new(),
            statements: Vec::new(),
            sections: Vec::new(),
            values: 0,
        };
        Self { tape, known: vec![None; values as usize], sections: BTreeMap::new() }
    }

    fn known(&self, operand: Operand) -> Operand {
        value_of(operand).and_then(|value| self.known[value as usize]).unwrap_or(operand)
    }

    fn push(&mut self, whole: &Tape, statement: &Statement, stores: Vec<(u32, Operand)>) {
        let op = match statement.op {
            Op::Unary(operation, a) => Op::Unary(operation, self.known(a)),
            Op::Binary(operation, a, b) => Op::Binary(operation, self.known(a), self.known(b)),
            Op::SinCos(a) => Op::SinCos(self.known(a)),
            Op::Select(a, yes, no) => Op::Select(self.known(a), self.known(yes), self.known(no)),
        };
        let titles = &mut self.tape.sections;
        let section = *self.sections.entry(statement.section).or_insert_with(|| {
            titles.push(whole.sections[statement.section].clone());
            titles.len() - 1
        });
        let first = self.tape.values;
        for (value, now) in statement.results().zip(first..) {
            self.known[value as usize] = Some(Operand::Value(now));
        }
        let stores = stores.into_iter().map(|(index, operand)| (index, self.known(operand))).collect();
        let statement = Statement { op, first, section, stores, ..statement.clone() };
        self.tape.values = statement.results().end;
        self.tape.statements.push(statement);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derive::{Block, Equations};
    use crate::expr::Scope;
    use crate::tape::{lower, verify};

    fn function(name: &str, inputs: Vec<Block>, outputs: Vec<Block>, goes_on: bool) -> Function {
        Function { name: name.into(), doc: String::new(), inputs, outputs, goes_on }
    }

    #[test]
    fn what_the_first_has_computed_is_not_computed_again() {
        let g = Scope::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let inner = a.square() + 1.0;
        let (answer, other) = (inner.sqrt(), a.cos());
        // The second reads the answer and what is in it, hands on a value of the first, and has its own.
        let results = [answer * b, inner - b, inner, other, a];
        let first = vec![Block::vector("x", [a])];
        let second = vec![Block::vector("x", [a]), Block::vector("late", [b])];
        let functions = vec![
            function("contacts", first, vec![Block::vector("answer", [answer])], false),
            function("derivative", second, vec![Block::vector("results", results)], true),
        ];
        let tapes = lower(&Equations::of(g.into_graph(), functions));
        let [first, second] = &tapes[..] else { panic!("two tapes: {}", tapes.len()) };
        assert_eq!((verify(first), verify(second)), (Ok(()), Ok(())));
        assert_eq!((first.input_len(), first.output_len()), (1, 2));
        assert_eq!((second.input_len(), second.output_len()), (4, 5));
        assert_eq!(first.statements.len(), 3);
        assert_eq!(second.statements.len(), 3);
        assert_eq!(second.direct, vec![(4, Operand::Input(0)), (2, Operand::Input(3))]);
        assert_eq!(second.input_names, ["a", "b", "answer0", "held0"]);
    }
}
