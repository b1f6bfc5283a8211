//! Which values of a tape are made with the other sign, so that the fewest changes of sign are left.
//! In: a tape. Out: the same with values of the same size, some with the other sign. Never changes what is stored.
//!
//! A sum takes any signs of its terms but two negative ones, a product those whose product is positive, or any if one factor is
//! a number. What cannot be taken is an operation more. Such a change of sign is passed on from statement to statement, a value
//! turned each time, to one that takes it or has another.

use linkwear_tape::{Binary, Op, Operand, Statement, Tape, Unary, Value, verify};

/// Sweeps over all values at most.
const SWEEPS: usize = 8;

/// Values that are turned to be rid of one change of sign at most; nothing shipped gains by more.
const LONGEST: usize = 6;

/// A tape without changes of sign, which its operands have instead.
struct Signed<'a> {
    tape: &'a Tape,
    /// By value: where it is made.
    made: Vec<usize>,
    /// By value: of which value it is the negative, or itself.
    is: Vec<(Value, bool)>,
    /// Those that read a statement, in order, statement by statement; and where those of each begin.
    readers: Vec<usize>,
    first_readers: Vec<usize>,
    /// By value: whether it is made with the other sign.
    turned: Vec<bool>,
    /// By statement: how often it is stored as it is, and with the other sign.
    stored: Vec<[usize; 2]>,
    /// By statement: changes of sign that it needs as values are made now.
    costs: Vec<usize>,
}

/// The tape with as few changes of sign as this finds; the tape itself if that is not fewer.
pub fn with_fewer_signs(tape: Tape) -> Tape {
    let is_negation =
        |statement: &Statement| matches!(statement.op, Op::Unary(Unary::Neg, Operand::Value(_)));
    if !tape.statements.iter().any(is_negation) {
        return tape;
    }
    let mut signed = Signed::new(&tape);
    signed.turn();
    let shorter = signed.written();
    debug_assert_eq!(verify(&shorter), Ok(()));
    if shorter.statements.len() < tape.statements.len() { shorter } else { tape }
}

impl<'a> Signed<'a> {
    fn new(tape: &'a Tape) -> Self {
        let values = tape.values as usize;
        let mut signed = Self {
            tape,
            made: vec![0; values],
            is: (0..tape.values).map(|value| (value, false)).collect(),
            readers: Vec::new(),
            first_readers: Vec::new(),
            turned: vec![false; values],
            stored: vec![[0; 2]; tape.statements.len()],
            costs: Vec::new(),
        };
        let mut reads: Vec<(usize, usize)> = Vec::with_capacity(2 * tape.statements.len());
        for (at, statement) in tape.statements.iter().enumerate() {
            statement.results().for_each(|value| signed.made[value as usize] = at);
            if let Op::Unary(Unary::Neg, Operand::Value(value)) = statement.op {
                let (value, negative) = signed.is[value as usize];
                signed.is[statement.first as usize] = (value, !negative);
            } else {
                for operand in statement.op.operands() {
                    if let Operand::Value(value) = operand {
                        reads.push((signed.made[signed.is[value as usize].0 as usize], at));
                    }
                }
            }
            for (_, operand) in &statement.stores {
                if let Operand::Value(value) = operand {
                    let (value, negative) = signed.is[*value as usize];
                    signed.stored[signed.made[value as usize]][usize::from(negative)] += 1;
                }
            }
        }
        // What reads a value twice was noted twice.
        reads.sort_unstable();
        reads.dedup();
        let mut next = reads.iter().enumerate().peekable();
        for at in 0..=tape.statements.len() {
            while next.next_if(|(_, (read, _))| *read < at).is_some() {}
            signed.first_readers.push(next.peek().map_or(reads.len(), |(first, _)| *first));
        }
        signed.readers = reads.into_iter().map(|(_, reader)| reader).collect();
        signed.costs = (0..tape.statements.len()).map(|at| signed.cost(at)).collect();
        signed
    }

    /// An operand without its sign, and its sign as it is made now.
    fn operand(&self, operand: Operand) -> (Operand, bool) {
        match operand {
            Operand::Value(value) => {
                let (value, negative) = self.is[value as usize];
                (Operand::Value(value), negative != self.turned[value as usize])
            }
            other => (other, false),
        }
    }

    fn readers(&self, at: usize) -> &[usize] {
        &self.readers[self.first_readers[at]..self.first_readers[at + 1]]
    }

    /// Whether a statement may be made with the other sign at all.
    fn turns(&self, at: usize) -> bool {
        matches!(
            self.tape.statements[at].op,
            Op::Binary(Binary::Add | Binary::Sub | Binary::Mul | Binary::Div, ..)
        )
    }

    /// Changes of sign that a statement needs.
    fn cost(&self, at: usize) -> usize {
        let statement = &self.tape.statements[at];
        let turned = self.turned[statement.first as usize];
        let stores = self.stored[at];
        let stores = usize::from(stores[usize::from(!turned)] > 0);
        let own = match statement.op {
            Op::Unary(Unary::Neg, Operand::Value(_)) => 0,
            Op::Binary(operation @ (Binary::Add | Binary::Sub), a, b) => {
                let ((a, minus_a), (b, minus_b)) = (self.operand(a), self.operand(b));
                let negative = [minus_a != turned, (minus_b != (operation == Binary::Sub)) != turned];
                usize::from(negative == [true, true] && !is_number(a) && !is_number(b))
            }
            Op::Binary(Binary::Mul | Binary::Div, a, b) => {
                let ((a, minus_a), (b, minus_b)) = (self.operand(a), self.operand(b));
                usize::from((minus_a != minus_b) != turned && !is_number(a) && !is_number(b))
            }
            op => op.operands().filter(|operand| self.operand(*operand).1).count(),
        };
        own + stores
    }

    /// Turns values until no change of sign can be passed on to where it ends.
    fn turn(&mut self) {
        for _ in 0..SWEEPS {
            let mut changed = false;
            for at in 0..self.costs.len() {
                while self.costs[at] > 0 && self.passes_on(at, &mut Vec::new()) {
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Rids a statement of a change of sign by turning its value or an operand. A change that is left to another for it is passed
    /// on likewise, until there are fewer; if that does not come about, nothing is turned.
    fn passes_on(&mut self, at: usize, path: &mut Vec<usize>) -> bool {
        let made = |operand| match operand {
            Operand::Value(value) => Some(self.made[self.is[value as usize].0 as usize]),
            Operand::Constant(_) | Operand::Input(_) => None,
        };
        let operands = self.tape.statements[at].op.operands().filter_map(made);
        let candidates: Vec<usize> = std::iter::once(at).chain(operands).collect();
        for candidate in candidates {
            if !self.turns(candidate) || path.contains(&candidate) {
                continue;
            }
            let more = self.flip(candidate);
            if more < 0 {
                return true;
            }
            path.push(candidate);
            if more == 0 && path.len() < LONGEST {
                let left: Vec<usize> = self.around(candidate).filter(|at| self.costs[*at] > 0).collect();
                if left.into_iter().any(|at| self.passes_on(at, path)) {
                    return true;
                }
            }
            path.pop();
            self.flip(candidate);
        }
        false
    }

    /// A statement and all that read it: each once.
    fn around(&self, at: usize) -> impl Iterator<Item = usize> {
        std::iter::once(at).chain(self.readers(at).iter().copied())
    }

    /// Turns a statement; how many changes of sign more that takes.
    fn flip(&mut self, at: usize) -> isize {
        let value = self.tape.statements[at].first as usize;
        self.turned[value] = !self.turned[value];
        let mut more = 0;
        for at in self.around(at).collect::<Vec<_>>() {
            let cost = self.cost(at);
            more += cost.cast_signed() - self.costs[at].cast_signed();
            self.costs[at] = cost;
        }
        more
    }

    fn written(&self) -> Tape {
        let mut writer = Writer {
            tape: Tape {
                statements: Vec::new(),
                values: 0,
                direct: self.tape.direct.clone(),
                ..self.tape.clone()
            },
            values: vec![None; self.made.len()],
            negatives: vec![None; self.made.len()],
            made: Vec::new(),
        };
        for statement in &self.tape.statements {
            self.write(&mut writer, statement);
        }
        writer.tape
    }

    fn write(&self, writer: &mut Writer, statement: &Statement) {
        let section = statement.section;
        let mut labels = statement.labels.clone();
        if !matches!(statement.op, Op::Unary(Unary::Neg, Operand::Value(_))) {
            let turned = self.turned[statement.first as usize];
            let op = self.op(writer, statement, turned);
            // Its name says the other sign.
            let labels = if turned { [None, None] } else { std::mem::take(&mut labels) };
            let first = writer.push(op, labels, section);
            for (new, old) in (first..).zip(statement.results()) {
                writer.values[old as usize] = Some(new);
            }
        }
        for (place, operand) in &statement.stores {
            let (operand, negative) = self.operand(*operand);
            let operand = writer.operand(operand, negative, section);
            let Operand::Value(value) = operand else {
                writer.tape.direct.push((*place, operand));
                continue;
            };
            let made = &mut writer.tape.statements[writer.made[value as usize]];
            if made.labels == [None, None] {
                made.labels.clone_from(&labels);
            }
            made.stores.push((*place, operand));
        }
    }

    /// The operation of a statement, by what its operands have become.
    fn op(&self, writer: &mut Writer, statement: &Statement, turned: bool) -> Op {
        let section = statement.section;
        match statement.op {
            Op::Binary(operation @ (Binary::Add | Binary::Sub), a, b) => {
                let ((a, minus_a), (b, minus_b)) = (self.operand(a), self.operand(b));
                let negative = [minus_a != turned, (minus_b != (operation == Binary::Sub)) != turned];
                let sign = |operand: Operand| match operand {
                    Operand::Constant(number) => Operand::Constant(-number),
                    other => other,
                };
                let [x, y] = [a, b].map(|operand| writer.operand(operand, false, section));
                match negative {
                    [false, false] => Op::Binary(Binary::Add, x, y),
                    [false, true] => Op::Binary(Binary::Sub, x, y),
                    [true, false] => Op::Binary(Binary::Sub, y, x),
                    [true, true] if is_number(a) => Op::Binary(Binary::Sub, sign(x), y),
                    [true, true] if is_number(b) => Op::Binary(Binary::Sub, sign(y), x),
                    [true, true] => Op::Binary(Binary::Sub, writer.operand(a, true, section), y),
                }
            }
            Op::Binary(operation @ (Binary::Mul | Binary::Div), a, b) => {
                let ((a, minus_a), (b, minus_b)) = (self.operand(a), self.operand(b));
                let negative = (minus_a != minus_b) != turned;
                let by_second = negative && is_number(b);
                let x = writer.operand(a, negative && !by_second, section);
                Op::Binary(operation, x, writer.operand(b, by_second, section))
            }
            op => {
                let mut made = |operand: Operand| {
                    let (operand, negative) = self.operand(operand);
                    writer.operand(operand, negative, section)
                };
                match op {
                    Op::Unary(operation, a) => Op::Unary(operation, made(a)),
                    Op::SinCos(a) => Op::SinCos(made(a)),
                    Op::Binary(operation, a, b) => Op::Binary(operation, made(a), made(b)),
                    Op::Select(a, yes, no) => Op::Select(made(a), made(yes), made(no)),
                }
            }
        }
    }
}

fn is_number(operand: Operand) -> bool {
    matches!(operand, Operand::Constant(_))
}

/// The new tape.
struct Writer {
    tape: Tape,
    /// By old value.
    values: Vec<Option<Value>>,
    /// Its negative, where something needs that.
    negatives: Vec<Option<Value>>,
    /// By new value: the statement that makes it.
    made: Vec<usize>,
}

impl Writer {
    fn push(&mut self, op: Op, labels: [Option<String>; 2], section: usize) -> Value {
        let first = self.tape.values;
        let statement = Statement { op, first, labels, section, stores: Vec::new() };
        self.tape.values = statement.results().end;
        self.made.resize(self.tape.values as usize, self.tape.statements.len());
        self.tape.statements.push(statement);
        first
    }

    /// An old operand in the new tape, with the other sign if `negative`.
    fn operand(&mut self, operand: Operand, negative: bool, section: usize) -> Operand {
        match operand {
            Operand::Constant(number) if negative => Operand::Constant(-number),
            Operand::Value(old) => {
                let value = self.values[old as usize].unwrap_or(old);
                if !negative {
                    return Operand::Value(value);
                }
                let made = self.negatives[old as usize];
                Operand::Value(made.unwrap_or_else(|| {
                    let negative = self.negated(Operand::Value(value), section);
                    self.negatives[old as usize] = Some(negative);
                    negative
                }))
            }
            Operand::Input(_) if negative => Operand::Value(self.negated(operand, section)),
            other => other,
        }
    }

    fn negated(&mut self, operand: Operand, section: usize) -> Value {
        self.push(Op::Unary(Unary::Neg, operand), [None, None], section)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwear_tape::Block;

    /// A tape over four inputs that stores these values.
    fn tape(ops: &[Op], stored: &[Value]) -> Tape {
        let statements = (0..).zip(ops).map(|(first, op)| Statement {
            op: *op,
            first,
            labels: [None, None],
            section: 0,
            stores: (0..)
                .zip(stored)
                .filter(|(_, value)| **value == first)
                .map(|(at, value)| (at, Operand::Value(*value)))
                .collect(),
        });
        Tape {
            name: "f".to_owned(),
            doc: String::new(),
            inputs: vec![Block::vector("x", 4)],
            input_names: ["a", "b", "c", "d"].map(str::to_owned).to_vec(),
            outputs: vec![Block::vector("y", stored.len())],
            direct: Vec::new(),
            statements: statements.collect(),
            sections: vec!["all".to_owned()],
            values: ops.len() as u32,
        }
    }

    fn values(tape: &Tape) -> Vec<f64> {
        let mut output = vec![0.0; tape.output_len()];
        let mut made = vec![0.0; tape.values as usize];
        let inputs = [1.5, -2.25, 0.75, 3.0];
        for statement in &tape.statements {
            let of = |operand: Operand| match operand {
                Operand::Constant(number) => number,
                Operand::Input(at) => inputs[at as usize],
                Operand::Value(value) => made[value as usize],
            };
            made[statement.first as usize] = match statement.op {
                Op::Binary(Binary::Add, a, b) => of(a) + of(b),
                Op::Binary(Binary::Sub, a, b) => of(a) - of(b),
                Op::Binary(Binary::Mul, a, b) => of(a) * of(b),
                Op::Binary(Binary::Div, a, b) => of(a) / of(b),
                Op::Unary(Unary::Neg, a) => -of(a),
                Op::Unary(Unary::Sqrt, a) => of(a).sqrt(),
                op => panic!("{op:?} is in no test"),
            };
            for (place, operand) in &statement.stores {
                let Operand::Value(value) = operand else { panic!("values are stored") };
                output[*place as usize] = made[*value as usize];
            }
        }
        output
    }

    #[test]
    fn signs_pass_through_what_several_values_read() {
        use Binary::{Add, Mul, Sub};
        let [a, b, c, d] = [0, 1, 2, 3].map(Operand::Input);
        let v = Operand::Value;
        // u = a - b, read twice; y = -u, z = c - u d: by b - a, no change of sign is left.
        let ops = [
            Op::Binary(Sub, a, b),
            Op::Unary(Unary::Neg, v(0)),
            Op::Binary(Mul, v(0), d),
            Op::Binary(Sub, c, v(2)),
        ];
        let before = tape(&ops, &[1, 3]);
        let after = with_fewer_signs(before.clone());
        assert_eq!(after.statements.len(), 3);
        assert_eq!(values(&after), values(&before));
        // A root wants its operand as it is, and a stored sum both signs: one change stays.
        let ops = [
            Op::Binary(Add, a, d),
            Op::Unary(Unary::Sqrt, v(0)),
            Op::Unary(Unary::Neg, v(0)),
            Op::Binary(Mul, v(2), Operand::Constant(3.0)),
        ];
        let before = tape(&ops, &[0, 1, 2, 3]);
        let after = with_fewer_signs(before.clone());
        assert_eq!(after.statements.len(), 4);
        assert_eq!(values(&after), values(&before));
    }

    #[test]
    fn signs_are_passed_on_to_what_takes_them() {
        use Binary::{Add, Mul, Sub};
        let [a, b, c, d] = [0, 1, 2, 3].map(Operand::Input);
        let v = Operand::Value;
        // -(n b + c d) and (n - d) + c, where n is 3 a: by -3 a, no change of sign is left, though n, n b, the sum, n - d turn.
        let ops = [
            Op::Binary(Mul, a, Operand::Constant(3.0)),
            Op::Binary(Mul, v(0), b),
            Op::Binary(Mul, c, d),
            Op::Binary(Add, v(1), v(2)),
            Op::Unary(Unary::Neg, v(3)),
            Op::Binary(Sub, v(0), d),
            Op::Binary(Add, v(5), c),
        ];
        let before = tape(&ops, &[4, 6]);
        let after = with_fewer_signs(before.clone());
        assert_eq!(after.statements.len(), 6);
        assert_eq!(values(&after), values(&before));
    }
}
