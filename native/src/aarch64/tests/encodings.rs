//! Every instruction in every form, with every register and many offsets: the words that binutils writes for the same
//! text. A part of them is recorded, so that it is compared where binutils is not.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use super::assembly::{Assembly, FUNCTION};
use super::emulator::{Folder, program};
use crate::aarch64::encode::Encoder;
use crate::aarch64::instruction::{Binary, Instruction, Lanes, Unary};
use crate::straight::graph::Function;
use crate::straight::place::{Address, Base, Register};

/// Words and their text, from binutils.
const RECORDED: &str = include_str!("words.txt");

const UNARY: [Unary; 3] = [Unary::SquareRoot, Unary::Negate, Unary::Absolute];
const BINARY: [Binary; 8] = [
    Binary::Add,
    Binary::Subtract,
    Binary::Multiply,
    Binary::Divide,
    Binary::And,
    Binary::AndNot,
    Binary::Xor,
    Binary::Less,
];
const BASES: [Base; 4] = [Base::Input, Base::Output, Base::Pool, Base::Frame];
/// Offsets about the borders of every short form, whatever the unit it counts in.
const OFFSETS: [i32; 20] = [
    0,
    4,
    8,
    16,
    24,
    4080,
    4088,
    4096,
    32752,
    32760,
    32768,
    65520,
    65528,
    65536,
    65544,
    1 << 24,
    1 << 30,
    -8,
    -4096,
    -65536,
];

fn arithmetic(a: Register, b: Register, c: Register, d: Register) -> Vec<Instruction> {
    let mut all: Vec<Instruction> =
        UNARY.map(|operation| Instruction::Unary { operation, to: a, of: b }).into();
    all.extend(BINARY.map(|operation| Instruction::Binary { operation, to: a, first: b, second: c }));
    let select = |to| Instruction::Select { to, no: b, yes: c, mask: d };
    all.extend([a, b, c, d].map(select));
    all
}

fn moves(register: Register, offsets: &[i32]) -> Vec<Instruction> {
    let addresses = BASES.into_iter().flat_map(|base| offsets.iter().map(move |offset| (base, *offset)));
    let both = |(base, offset)| {
        let address = Address { base, offset };
        [
            Instruction::Load { to: register, from: address },
            Instruction::Store { from: register, to: address },
        ]
    };
    addresses.flat_map(both).collect()
}

fn arguments(offsets: &[i32]) -> impl Iterator<Item = Instruction> {
    let addresses = BASES.into_iter().flat_map(|base| offsets.iter().map(move |offset| (base, *offset)));
    addresses.flat_map(|(base, offset)| {
        (0..4).map(move |number| Instruction::Argument { number, address: Address { base, offset } })
    })
}

/// Text and words of instructions, as they are written here: before `Enter` and after it.
fn written(lanes: Lanes, instructions: &[Instruction]) -> Vec<(u32, String)> {
    let functions = |_: Function| FUNCTION as usize;
    let mut encoder = Encoder::new(lanes, &functions);
    let mut assembly = Assembly::new(lanes);
    let mut text = Vec::new();
    let ends = [Instruction::GiveBack, Instruction::Leave, Instruction::Return];
    let enters = [Instruction::Enter, Instruction::Keep];
    let all = instructions.iter().chain(&enters).chain(instructions);
    for instruction in all.chain(&[Instruction::Call(Function::Ln)]).chain(&ends) {
        encoder.instruction(*instruction);
        text.extend(assembly.lines(*instruction));
    }
    let code = encoder.finish();
    let words = code.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    let words: Vec<u32> = words.collect();
    assert_eq!(words.len(), text.len(), "a word for every line");
    words.into_iter().zip(text).collect()
}

/// Every form once or a few times.
fn some() -> Vec<(u32, String)> {
    let mut all = Vec::new();
    for lanes in [Lanes::One, Lanes::Two] {
        let mut instructions = arithmetic(0, 7, 8, 15);
        instructions.extend(arithmetic(31, 24, 23, 16));
        instructions.extend(moves(9, &[0, 16, 32760, 65520, 65536, -8]));
        instructions.extend(arguments(&[0, 4088, 4096, 1 << 30]));
        all.extend(written(lanes, &instructions));
    }
    all
}

/// Every form with every register and every offset.
fn all() -> Vec<(u32, String)> {
    let mut all = some();
    for lanes in [Lanes::One, Lanes::Two] {
        let mut instructions: Vec<Instruction> = arguments(&OFFSETS).collect();
        for register in 0..32_u8 {
            // The others go through all registers in other orders.
            let [b, c, d] = [7, 13, 19].map(|factor| register.wrapping_mul(factor).wrapping_add(5) % 32);
            for (a, b, c, d) in [(register, b, c, d), (b, c, d, register), (c, register, register, b)] {
                instructions.extend(arithmetic(a, b, c, d));
            }
            instructions.extend(moves(register, &OFFSETS));
        }
        all.extend(written(lanes, &instructions));
    }
    all
}

#[test]
fn every_form_has_the_recorded_words() {
    let mut lines = RECORDED.lines();
    for (word, text) in some() {
        assert_eq!(lines.next(), Some(format!("{word:08x} {text}").as_str()));
    }
    assert_eq!(lines.next(), None);
}

/// `LINKWEAR_WRITE_WORDS=1` records them.
#[test]
#[ignore = "needs an assembler: apt-get install binutils-aarch64-linux-gnu"]
fn every_form_has_the_words_of_an_assembler() {
    let written = all();
    let text: String = written.iter().map(|(_, text)| format!("{text}\n")).collect();
    let folder = Folder::new("words");
    let [source, object, binary] = ["words.s", "words.o", "words.bin"].map(|name| folder.file(name));
    fs::write(&source, text).expect("a file");
    program(Command::new("aarch64-linux-gnu-as").arg("-o").args([&object, &source]));
    let copy = ["-O", "binary", "-j", ".text"];
    program(Command::new("aarch64-linux-gnu-objcopy").args(copy).args([&object, &binary]));
    let meant = fs::read(&binary).expect("words");
    assert_eq!(meant.len(), 4 * written.len());
    let mut recorded = String::new();
    let recorded_ones = some().len();
    for (at, ((word, text), meant)) in written.iter().zip(meant.chunks_exact(4)).enumerate() {
        let meant = u32::from_le_bytes([meant[0], meant[1], meant[2], meant[3]]);
        assert_eq!(format!("{word:08x}"), format!("{meant:08x}"), "{text}");
        if at < recorded_ones {
            writeln!(recorded, "{meant:08x} {text}").expect("a string");
        }
    }
    println!("{} instructions", written.len());
    if env::var_os("LINKWEAR_WRITE_WORDS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/aarch64/tests/words.txt");
        fs::write(path, recorded).expect("the recorded words");
    }
}
