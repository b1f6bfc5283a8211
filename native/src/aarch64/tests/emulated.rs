//! Code that runs under an emulator: single instructions on numbers of every kind, random tapes with few registers and
//! with many, all mechanisms. The bits of the same operations here, of plain evaluation, of the interpreter.

use std::fs;

use linkwear_codegen::{Options, SourceFile, compile};
use linkwear_runtime::{Entry, System};
use linkwear_tape::Tape;

use super::emulator::{Case, function, run};
use super::targets::{NUMBERS, TARGETS};
use crate::aarch64::instruction::{Binary, Instruction, Lanes, REGISTERS, Target, Unary};
use crate::straight::allocate::Processor;
use crate::straight::place::{Address, Base};
use crate::straight::tests::calls::{calls, same_nan};
use crate::straight::tests::random_tape::{Random, evaluated};
use crate::straight::write::{Written, write};

/// Code that runs instructions on three numbers in registers 1 to 3, and stores what is in `result` then.
fn of_three(lanes: Lanes, instructions: &[Instruction], result: u8) -> Written {
    let value = lanes.bytes() as i32;
    let address = |base, place: u8| Address { base, offset: value * i32::from(place) };
    let load = |to: u8| Instruction::Load { to, from: address(Base::Input, to - 1) };
    let mut all = vec![Instruction::Keep, load(1), load(2), load(3)];
    all.extend(instructions);
    all.push(Instruction::Store { from: result, to: address(Base::Output, 0) });
    all.extend([Instruction::GiveBack, Instruction::Return]);
    let count = lanes.count();
    let target = Target { lanes, states: count, registers: REGISTERS };
    Written {
        code: target.encode(&all, &function),
        pool: Vec::new(),
        inputs: 3 * count,
        outputs: count,
        workspace: 0,
        slack: 0,
        passes: 1,
        advance: count,
        columns: false,
    }
}

/// Instructions on registers 1, 2, 3, the register of their result, what they mean.
struct Meaning {
    instructions: Vec<Instruction>,
    result: u8,
    /// Whether the result is a number, not bits: then a NaN may be any.
    is_number: bool,
    meaning: fn([u64; 3]) -> u64,
}

fn less([a, b, _]: [u64; 3]) -> u64 {
    u64::from(f64::from_bits(a) < f64::from_bits(b)).wrapping_neg()
}

fn meanings() -> Vec<Meaning> {
    fn number([a, b, _]: [u64; 3], operation: fn(f64, f64) -> f64) -> u64 {
        operation(f64::from_bits(a), f64::from_bits(b)).to_bits()
    }
    let unary = |operation, is_number, meaning| {
        let instructions = vec![Instruction::Unary { operation, to: 4, of: 1 }];
        Meaning { instructions, result: 4, is_number, meaning }
    };
    let binary = |operation, is_number, meaning| {
        let instructions = vec![Instruction::Binary { operation, to: 4, first: 1, second: 2 }];
        Meaning { instructions, result: 4, is_number, meaning }
    };
    let select = |to| {
        let mask = Instruction::Binary { operation: Binary::Less, to: 0, first: 1, second: 2 };
        let instructions = vec![mask, Instruction::Select { to, no: 3, yes: 1, mask: 0 }];
        let meaning = |numbers: [u64; 3]| if less(numbers) == 0 { numbers[2] } else { numbers[0] };
        Meaning { instructions, result: to, is_number: false, meaning }
    };
    let mut all = vec![
        unary(Unary::SquareRoot, true, |numbers| number(numbers, |a, _| a.sqrt())),
        unary(Unary::Negate, false, |[a, ..]| a ^ 1 << 63),
        unary(Unary::Absolute, false, |[a, ..]| a & !(1 << 63)),
        binary(Binary::Add, true, |numbers| number(numbers, |a, b| a + b)),
        binary(Binary::Subtract, true, |numbers| number(numbers, |a, b| a - b)),
        binary(Binary::Multiply, true, |numbers| number(numbers, |a, b| a * b)),
        binary(Binary::Divide, true, |numbers| number(numbers, |a, b| a / b)),
        binary(Binary::And, false, |[a, b, _]| a & b),
        binary(Binary::AndNot, false, |[a, b, _]| !a & b),
        binary(Binary::Xor, false, |[a, b, _]| a ^ b),
        binary(Binary::Less, false, less),
    ];
    // The result over the mask, over either choice, elsewhere, in a register that the caller wants back.
    all.extend([0, 1, 3, 4, 31].map(select));
    all
}

#[test]
#[ignore = "needs an emulator: apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user"]
fn every_instruction_does_what_it_means() {
    let pairs = NUMBERS.into_iter().flat_map(|a| NUMBERS.into_iter().map(move |b| (a, b)));
    let third = NUMBERS.into_iter().cycle().skip(5);
    let triples = pairs.zip(third).map(|((a, b), c)| [a, b, c].map(f64::to_bits));
    let triples: Vec<[u64; 3]> = triples.collect();
    let (mut cases, mut meant) = (Vec::new(), Vec::new());
    for lanes in [Lanes::One, Lanes::Two] {
        for Meaning { instructions, result, is_number, meaning } in meanings() {
            let written = of_three(lanes, &instructions, result);
            for at in 0..triples.len() {
                // The other lane has other numbers.
                let state = |lane: usize| triples[(at + 37 * lane) % triples.len()];
                let states: Vec<[u64; 3]> = (0..lanes.count()).map(state).collect();
                let input = (0..3).flat_map(|place| states.iter().map(move |state| state[place])).collect();
                cases.push(Case { written: written.clone(), input, calls: Vec::new() });
                let numbers = states.into_iter().map(meaning).collect::<Vec<u64>>();
                meant.push((format!("{instructions:x?}"), is_number, numbers));
            }
        }
    }
    for ((found, case), (name, is_number, meant)) in run("instructions", &cases).iter().zip(&cases).zip(meant)
    {
        let bits = |bits: &u64| if is_number { same_nan(*bits) } else { *bits };
        let [found, meant] = [found, &meant].map(|all| all.iter().map(bits).collect::<Vec<u64>>());
        assert_eq!(found, meant, "{name} of {:x?}", case.input);
    }
    println!("{} cases", cases.len());
}

/// Functions of tapes on states, and what they must give.
#[derive(Default)]
struct Expected {
    cases: Vec<Case>,
    /// By state.
    outputs: Vec<Vec<Vec<f64>>>,
    names: Vec<String>,
}

impl Expected {
    fn add(
        &mut self,
        name: String,
        tape: &Tape,
        target: Target,
        mut number: impl FnMut() -> f64,
        meaning: impl Fn(&[f64]) -> Vec<f64>,
    ) {
        let written = write(tape, target, &function).expect("a tape");
        let input: Vec<f64> = (0..written.inputs).map(|_| number()).collect();
        let state = |lane: usize| input.iter().skip(lane).step_by(target.states).copied().collect();
        let states: Vec<Vec<f64>> = (0..target.states).map(state).collect();
        let calls = states.iter().flat_map(|state| calls(tape, state)).collect();
        let input = input.iter().map(|number| number.to_bits()).collect();
        self.cases.push(Case { written, input, calls });
        self.outputs.push(states.iter().map(|state| meaning(state)).collect());
        self.names.push(format!("{name}, {target:?}"));
    }

    /// Runs all; how many numbers are equal in every bit, and how many are undefined in both.
    fn compare(&self, name: &str) -> (usize, usize) {
        let (mut equal, mut undefined) = (0, 0);
        for ((found, states), name) in run(name, &self.cases).iter().zip(&self.outputs).zip(&self.names) {
            for (lane, meant) in states.iter().enumerate() {
                let found: Vec<u64> = found.iter().skip(lane).step_by(states.len()).copied().collect();
                assert_eq!(found.len(), meant.len(), "{name}");
                for (index, (found, meant)) in found.into_iter().zip(meant).enumerate() {
                    assert_eq!(
                        same_nan(found),
                        same_nan(meant.to_bits()),
                        "{name}, output {index}, lane {lane}: {}, not {meant}",
                        f64::from_bits(found)
                    );
                    *(if meant.is_nan() { &mut undefined } else { &mut equal }) += 1;
                }
            }
        }
        println!("{equal} numbers equal in every bit, {undefined} undefined in both");
        (equal, undefined)
    }
}

/// `ROUNDS=3000` runs more than 300 tapes.
#[test]
#[ignore = "needs an emulator: apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user"]
fn random_tapes_have_the_bits_of_plain_evaluation() {
    let rounds = std::env::var("ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(300_u64);
    let mut expected = Expected::default();
    for seed in 1..=rounds {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let size = 1 + random.below(400);
        let tape = random.tape(size, seed % 2 == 0);
        for target in TARGETS {
            // Now and then an angle of which no turn is left, or a number of any kind.
            let number = || match random.below(60) {
                0 => 1e19 * random.unit(),
                1 => NUMBERS[random.below(NUMBERS.len())],
                _ => 4.0 * (random.unit() - 0.5),
            };
            expected.add(format!("seed {seed}"), &tape, target, number, |state| evaluated(&tape, state));
        }
    }
    let (equal, undefined) = expected.compare("random");
    assert!(equal > undefined);
}

#[test]
#[ignore = "needs an emulator: apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user"]
fn all_mechanisms_have_the_bits_of_the_interpreter() {
    let files = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../mechanisms")).expect("a folder");
    let files = files.map(|entry| entry.expect("a file").path());
    let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let mut expected = Expected::default();
    for path in files {
        let name = path.display().to_string();
        let text = fs::read_to_string(&path).expect("a shipped mechanism");
        let source = SourceFile { name: name.clone(), text };
        let compiled = compile(&source, &Options::default()).expect("shipped mechanisms compile");
        let interpreter = compiled.interpreter();
        let sizes = System::<f64>::sizes(&interpreter);
        for (entry, tape) in Entry::ALL.into_iter().zip(compiled.tapes()) {
            for target in TARGETS {
                let meaning = |state: &[f64]| {
                    let mut output = vec![0.0; sizes.output(entry)];
                    interpreter.evaluate(entry, state, &mut output, &mut vec![0.0; sizes.workspace]);
                    output
                };
                let name = format!("{} of {name}", entry.name());
                expected.add(name, tape, target, || 6.0 * (random.unit() - 0.5), meaning);
            }
        }
    }
    assert!(!expected.cases.is_empty());
    let (equal, undefined) = expected.compare("mechanisms");
    assert!(equal > undefined);
}
