//! Random tapes as instructions, run one by one by what they mean: the bits of plain evaluation, on any machine.

use std::array::from_fn;

use linkwear_runtime::Scalar;

use super::targets::{NUMBERS, TARGETS};
use crate::aarch64::instruction::{Binary, Instruction, KEPT, Target, Unary};
use crate::straight::graph::Function;
use crate::straight::place::{Address, Base};
use crate::straight::tests::calls::same_nan;
use crate::straight::tests::random_tape::{Random, evaluated};
use crate::straight::write::{Written, placed};

/// A value: the numbers of two lanes, by their bits.
type Value = [u64; 2];

/// Registers and memory.
struct Simulation {
    lanes: usize,
    registers: [Value; 32],
    input: Vec<u64>,
    output: Vec<u64>,
    pool: Vec<u64>,
    frame: Vec<u64>,
    /// How many numbers further inputs and outputs begin.
    pass: usize,
    /// Addresses of the result and the arguments of a call.
    arguments: [Option<Address>; 4],
    entered: bool,
    kept: bool,
}

impl Simulation {
    fn place(&mut self, Address { base, offset }: Address) -> &mut [u64] {
        let at = offset as usize / 8;
        let (numbers, at) = match base {
            Base::Input => (&mut self.input, at + self.pass),
            Base::Output => (&mut self.output, at + self.pass),
            Base::Pool => (&mut self.pool, at),
            Base::Frame => (&mut self.frame, at),
        };
        &mut numbers[at..][..self.lanes]
    }

    fn load(&mut self, from: Address) -> Value {
        let mut value = [0; 2];
        let lanes = self.lanes;
        value[..lanes].copy_from_slice(self.place(from));
        value
    }

    fn set(&mut self, to: u8, value: impl Fn(usize) -> u64) {
        assert!(to < KEPT || self.kept, "register {to} is the caller's");
        self.registers[usize::from(to)] = from_fn(value);
    }

    fn run(&mut self, instruction: Instruction) {
        let of = |register: u8| self.registers[usize::from(register)];
        match instruction {
            Instruction::Unary { operation, to, of: a } => {
                let a = of(a);
                self.set(to, |lane| match operation {
                    Unary::SquareRoot => f64::from_bits(a[lane]).sqrt().to_bits(),
                    Unary::Negate => a[lane] ^ 1 << 63,
                    Unary::Absolute => a[lane] & !(1 << 63),
                });
            }
            Instruction::Binary { operation, to, first, second } => {
                let (a, b) = (of(first), of(second));
                self.set(to, |lane| binary(operation, a[lane], b[lane]));
            }
            Instruction::Select { to, no, yes, mask } => {
                let (no, yes, mask) = (of(no), of(yes), of(mask));
                self.set(to, |lane| yes[lane] & mask[lane] | no[lane] & !mask[lane]);
            }
            Instruction::Load { to, from } => {
                let value = self.load(from);
                self.set(to, |lane| value[lane]);
            }
            Instruction::Store { from, to } => {
                let (value, lanes) = (of(from), self.lanes);
                self.place(to).copy_from_slice(&value[..lanes]);
            }
            Instruction::Argument { number, address } => self.arguments[usize::from(number)] = Some(address),
            Instruction::Call(function) => self.call(function),
            Instruction::Enter => self.entered = true,
            Instruction::Leave => self.entered = false,
            Instruction::Keep => self.kept = true,
            Instruction::GiveBack => self.kept = false,
            Instruction::Return => assert!(!self.entered && !self.kept, "something is not undone"),
        }
    }

    /// Leaves rubbish in all registers: a function may use them, and the upper halves of those that it gives back.
    fn call(&mut self, function: Function) {
        assert!(self.entered, "a call would lose the way back");
        let [result, a, b, c] = self.arguments;
        let arguments = [a, b, c].map(|address| address.map_or([0; 2], |address| self.load(address)));
        let numbers = |lane: usize| arguments.map(|argument| f64::from_bits(argument[lane]));
        let value: Value = from_fn(|lane| {
            let [a, b, c] = numbers(lane);
            match function {
                Function::Exp => Scalar::exp(a),
                Function::Ln => Scalar::ln(a),
                Function::Atan2 => Scalar::atan2(a, b),
                Function::MulAdd => Scalar::mul_add(a, b, c),
            }
            .to_bits()
        });
        let lanes = self.lanes;
        self.place(result.expect("a place for the result")).copy_from_slice(&value[..lanes]);
        (self.registers, self.arguments) = ([[u64::MAX; 2]; 32], [None; 4]);
    }
}

fn binary(operation: Binary, a: u64, b: u64) -> u64 {
    let (x, y) = (f64::from_bits(a), f64::from_bits(b));
    match operation {
        Binary::Add => (x + y).to_bits(),
        Binary::Subtract => (x - y).to_bits(),
        Binary::Multiply => (x * y).to_bits(),
        Binary::Divide => (x / y).to_bits(),
        Binary::And => a & b,
        Binary::AndNot => !a & b,
        Binary::Xor => a ^ b,
        Binary::Less => u64::from(x < y).wrapping_neg(),
    }
}

fn simulated(instructions: &[Instruction], written: &Written, target: Target, input: &[f64]) -> Vec<f64> {
    let mut simulation = Simulation {
        lanes: target.lanes.count(),
        registers: [[u64::MAX; 2]; 32],
        input: input.iter().map(|number| number.to_bits()).collect(),
        output: vec![u64::MAX; written.outputs],
        pool: written.pool.clone(),
        frame: vec![u64::MAX; written.workspace],
        pass: 0,
        arguments: [None; 4],
        entered: false,
        kept: false,
    };
    for pass in 0..written.passes {
        simulation.pass = pass * written.advance;
        instructions.iter().for_each(|instruction| simulation.run(*instruction));
    }
    simulation.output.into_iter().map(f64::from_bits).collect()
}

/// `cargo test` runs 300 tapes; `ROUNDS=20000` runs more.
#[test]
fn random_tapes_have_the_bits_of_plain_evaluation() {
    let rounds = std::env::var("ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(300_u64);
    let (mut equal, mut undefined) = (0_usize, 0_usize);
    for seed in 1..=rounds {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let size = 1 + random.below(400);
        let tape = random.tape(size, seed % 2 == 0);
        for target in TARGETS {
            let (instructions, written) = placed(&tape, target).expect("a tape");
            let mut number = || match random.below(60) {
                0 => NUMBERS[random.below(NUMBERS.len())],
                _ => 4.0 * (random.unit() - 0.5),
            };
            let input: Vec<f64> = (0..written.inputs).map(|_| number()).collect();
            let found = simulated(&instructions, &written, target, &input);
            for lane in 0..target.states {
                let of_lane = |all: &[f64]| all.iter().skip(lane).step_by(target.states).copied().collect();
                let (state, found): (Vec<f64>, Vec<f64>) = (of_lane(&input), of_lane(&found));
                for (index, (found, meant)) in found.iter().zip(evaluated(&tape, &state)).enumerate() {
                    let bits = |number: f64| same_nan(number.to_bits());
                    let place = format!("seed {seed}, {target:?}, output {index}, lane {lane}");
                    assert_eq!(bits(*found), bits(meant), "{place}: {found}, not {meant}");
                    *(if meant.is_nan() { &mut undefined } else { &mut equal }) += 1;
                }
            }
        }
    }
    assert!(equal > undefined, "{equal} numbers compared, {undefined} undefined");
}
