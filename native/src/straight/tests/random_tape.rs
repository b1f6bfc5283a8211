//! Random tapes and what they mean, by plain evaluation.

use linkwear_runtime::{Scalar, angle_over_sine, log_coefficient};
use linkwear_tape::{Binary, Block, Op, Operand, Statement, Tape, Unary};

/// A small generator (xorshift), so that tapes repeat.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 11
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.next() as f64 / (1_u64 << 53) as f64
    }

    fn operand(&mut self, inputs: usize, values: u32) -> Operand {
        const CONSTANTS: [f64; 9] = [0.5, -1.0, 1.0, 2.0, 0.0, -0.0, 3.7, 1e-3, 1e17];
        let recent = values.min(8) as usize;
        match self.below(8) {
            0 => Operand::Input(self.below(inputs) as u32),
            1 => Operand::Constant(CONSTANTS[self.below(CONSTANTS.len())]),
            _ if values == 0 => Operand::Input(0),
            2..5 => Operand::Value(self.below(values as usize) as u32),
            _ => Operand::Value(values - 1 - self.below(recent) as u32),
        }
    }

    fn op(&mut self, inputs: usize, values: u32, calls: bool) -> Op {
        let (a, b) = (self.operand(inputs, values), self.operand(inputs, values));
        match self.below(if calls { 28 } else { 24 }) {
            0..6 => Op::Binary(Binary::Add, a, b),
            6..11 => Op::Binary(Binary::Sub, a, b),
            11..17 => Op::Binary(Binary::Mul, a, b),
            17 => Op::Binary(Binary::Div, a, b),
            18 => Op::Unary(Unary::Neg, a),
            19 => Op::Unary(Unary::Sqrt, a),
            20 => Op::SinCos(a),
            21 => Op::Unary(Unary::LogCoefficient(self.below(3) as u8), a),
            22 => Op::Select(a, b, self.operand(inputs, values)),
            23 => Op::Unary(Unary::Floor, a),
            24 => Op::Unary(Unary::Exp, a),
            25 => Op::Unary(Unary::Ln, a),
            26 => Op::Binary(Binary::Atan2, a, b),
            _ => Op::Binary(Binary::AngleOverSine, a, b),
        }
    }

    pub(crate) fn tape(&mut self, size: usize, calls: bool) -> Tape {
        let (inputs, outputs) = (1 + self.below(12), 1 + self.below(20));
        let mut statements = Vec::new();
        let mut values = 0;
        for _ in 0..size {
            let op = self.op(inputs, values, calls);
            let statement = statement(op, values, &[]);
            values = statement.results().end;
            statements.push(statement);
        }
        let mut direct = Vec::new();
        for index in 0..outputs as u32 {
            match self.operand(inputs, values) {
                operand @ Operand::Value(value) => {
                    let at = statements.iter().position(|statement| statement.results().contains(&value));
                    statements[at.expect("a statement")].stores.push((index, operand));
                }
                operand => direct.push((index, operand)),
            }
        }
        of_statements([inputs, outputs], direct, statements)
    }
}

/// A tape of so many inputs and outputs.
pub(crate) fn of_statements(
    [inputs, outputs]: [usize; 2],
    direct: Vec<(u32, Operand)>,
    statements: Vec<Statement>,
) -> Tape {
    Tape {
        name: "statements".into(),
        doc: String::new(),
        inputs: vec![Block::vector("x", inputs)],
        input_names: (0..inputs).map(|index| format!("x{index}")).collect(),
        outputs: vec![Block::vector("y", outputs)],
        direct,
        values: statements.last().map_or(0, |last| last.results().end),
        statements,
        sections: vec![String::new()],
    }
}

/// A statement that defines values from `first` on, each stored where `outputs` say.
pub(crate) fn statement(op: Op, first: u32, outputs: &[u32]) -> Statement {
    let stores = outputs.iter().zip(first..).map(|(output, value)| (*output, Operand::Value(value)));
    Statement { op, first, labels: [None, None], section: 0, stores: stores.collect() }
}

/// What a tape means.
pub(crate) fn evaluated(tape: &Tape, input: &[f64]) -> Vec<f64> {
    let mut output = vec![0.0; tape.output_len()];
    let mut values: Vec<f64> = Vec::new();
    let number = |operand: Operand, values: &[f64]| match operand {
        Operand::Value(value) => values[value as usize],
        Operand::Input(index) => input[index as usize],
        Operand::Constant(number) => number,
    };
    for (index, operand) in &tape.direct {
        output[*index as usize] = number(*operand, &values);
    }
    for statement in &tape.statements {
        let get = |operand: Operand| number(operand, &values);
        let results = match statement.op {
            Op::SinCos(a) => Vec::from(<[f64; 2]>::from(Scalar::sin_cos(get(a)))),
            Op::Unary(operation, a) => vec![match operation {
                Unary::Neg => -get(a),
                Unary::Sqrt => get(a).sqrt(),
                Unary::Exp => Scalar::exp(get(a)),
                Unary::Ln => Scalar::ln(get(a)),
                Unary::Floor => Scalar::floor(get(a)),
                Unary::LogCoefficient(rank) => log_coefficient(rank, get(a)),
                Unary::Sin | Unary::Cos => panic!("tapes have pairs"),
            }],
            Op::Select(of, yes, no) => vec![if get(of) < 0.0 { get(yes) } else { get(no) }],
            Op::Binary(operation, a, b) => {
                let (a, b) = (get(a), get(b));
                vec![match operation {
                    Binary::Add => a + b,
                    Binary::Sub => a - b,
                    Binary::Mul => a * b,
                    Binary::Div => a / b,
                    Binary::Atan2 => Scalar::atan2(a, b),
                    Binary::AngleOverSine => angle_over_sine(a, b),
                }]
            }
        };
        values.extend(results);
        for (index, operand) in &statement.stores {
            output[*index as usize] = number(*operand, &values);
        }
    }
    output
}
