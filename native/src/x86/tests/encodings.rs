//! Every instruction in every form, with every register and many offsets, read back by an independent decoder.

use iced_x86::{Decoder, DecoderOptions, Formatter, MemorySizeOptions, NasmFormatter};

use crate::straight::graph::Function;
use crate::straight::place::{Address, Base, Register};
use crate::x86::encode::Encoder;
use crate::x86::instruction::{Binary, Instruction, Lanes, Operand, Target, Wide};

const FUNCTION: usize = 0x1234_5678_9ABC;

/// Instructions as assembly text, one line for each of the machine's.
struct Assembly {
    lanes: Lanes,
    columns: bool,
    entered: bool,
}

impl Assembly {
    fn register(&self, number: Register) -> String {
        let name = match self.lanes {
            Lanes::One | Lanes::Two => "xmm",
            Lanes::Four => "ymm",
            Lanes::Eight => "zmm",
        };
        format!("{name}{number}")
    }

    fn is_column(&self, base: Base) -> bool {
        self.columns && matches!(base, Base::Input | Base::Output)
    }

    /// What an instruction names; before it, its pointer is fetched from a table.
    fn fetched(&self, to: &str, Address { base, offset }: Address) -> String {
        let number = offset / (8 * self.lanes.count() as i32);
        let table = Self { columns: false, ..*self }.address(Address { base, offset: 8 * number });
        format!("mov {to},{table}")
    }

    fn address(&self, Address { base: of, offset }: Address) -> String {
        let [passed, kept] = match of {
            Base::Input => ["rdi", "rbx"],
            Base::Output => ["rsi", "rbp"],
            Base::Pool => ["rdx", "r14"],
            Base::Frame => ["rcx", "r15"],
        };
        let base = if self.entered { kept } else { passed };
        if self.is_column(of) {
            return "[rax]".into();
        }
        match offset {
            0 => format!("[{base}]"),
            1.. => format!("[{base}+{offset:X}h]"),
            _ => format!("[{base}-{:X}h]", offset.unsigned_abs()),
        }
    }

    fn operand(&self, operand: Operand) -> String {
        match operand {
            Operand::Register(number) => self.register(number),
            Operand::Memory(address) => self.address(address),
            Operand::Broadcast(address) => format!("{}{{1to{}}}", self.address(address), self.lanes.count()),
        }
    }

    fn lines(&mut self, instruction: Instruction) -> Vec<String> {
        let named = match instruction {
            Instruction::Binary { second: operand, .. }
            | Instruction::SquareRoot { of: operand, .. }
            | Instruction::Select { yes: operand, .. }
            | Instruction::LessToMask { second: operand, .. }
            | Instruction::SelectByMask { yes: operand, .. }
            | Instruction::Pair { high: operand, .. }
            | Instruction::Load { from: operand, .. } => Some(operand),
            Instruction::Store { to, .. } => Some(Operand::Memory(to)),
            _ => None,
        };
        let pointer = match named {
            Some(Operand::Memory(address) | Operand::Broadcast(address)) if self.is_column(address.base) => {
                Some(self.fetched("rax", address))
            }
            _ => None,
        };
        pointer.into_iter().chain(self.line(instruction)).collect()
    }

    fn line(&mut self, instruction: Instruction) -> Vec<String> {
        let scalar = self.lanes == Lanes::One;
        let suffix = if scalar { "sd" } else { "pd" };
        let of_moves = if scalar { "vmovsd" } else { "vmovupd" };
        let line = match instruction {
            Instruction::Binary { operation, to, first, second } => {
                let name = match operation {
                    Binary::Add => format!("vadd{suffix}"),
                    Binary::Subtract => format!("vsub{suffix}"),
                    Binary::Multiply => format!("vmul{suffix}"),
                    Binary::Divide => format!("vdiv{suffix}"),
                    Binary::And => "vandpd".into(),
                    Binary::AndNot => "vandnpd".into(),
                    Binary::Xor => "vxorpd".into(),
                    Binary::Larger => format!("vmax{suffix}"),
                    Binary::Smaller => format!("vmin{suffix}"),
                    Binary::Less => format!("vcmplt_oq{suffix}"),
                };
                format!("{name} {},{},{}", self.register(to), self.register(first), self.operand(second))
            }
            Instruction::SquareRoot { to, of: of @ Operand::Register(_) } if scalar => {
                format!("vsqrtsd {},{},{}", self.register(to), self.operand(of), self.operand(of))
            }
            Instruction::SquareRoot { to, of } => {
                format!("vsqrt{suffix} {},{}", self.register(to), self.operand(of))
            }
            Instruction::Select { to, no, yes, mask } => {
                let [to, no, mask] = [to, no, mask].map(|number| self.register(number));
                format!("vblendvpd {to},{no},{},{mask}", self.operand(yes))
            }
            Instruction::LessToMask { mask, first, second } => {
                format!("vcmplt_oq{suffix} k{mask},{},{}", self.register(first), self.operand(second))
            }
            Instruction::SignToMask { mask, of } => format!("vpmovq2m k{mask},{}", self.register(of)),
            Instruction::MaskToRegister { to, mask } => format!("vpmovm2q {},k{mask}", self.register(to)),
            Instruction::SelectByMask { to, no, yes, mask } => {
                format!(
                    "vblendmpd {}{{k{mask}}},{},{}",
                    self.register(to),
                    self.register(no),
                    self.operand(yes)
                )
            }
            Instruction::Load { to, from: Operand::Broadcast(from) } => {
                format!("vbroadcastsd {},{}", self.register(to), self.address(from))
            }
            Instruction::Load { to, from } => {
                format!("{of_moves} {},{}", self.register(to), self.operand(from))
            }
            Instruction::Store { from, to } => {
                format!("{of_moves} {},{}", self.address(to), self.register(from))
            }
            Instruction::Pair { to, low, high } => self.pair(to, low, high),
            Instruction::Low { to, of } => format!("vmovapd {},{}", half(to), half(of)),
            Instruction::High { to, of } if self.lanes == Lanes::Two => {
                format!("vunpckhpd {},{},{}", half(to), half(of), half(of))
            }
            Instruction::High { to, of } => {
                format!("vextractf{} {},{},1h", halves(to, of), half(to), self.register(of))
            }
            Instruction::Enter => {
                self.entered = true;
                let lines = ["push rbx", "push rbp", "push r14", "push r15", "sub rsp,8h"];
                let moves = ["mov rbx,rdi", "mov rbp,rsi", "mov r14,rdx", "mov r15,rcx"];
                return lines.into_iter().chain(moves).map(str::to_owned).collect();
            }
            Instruction::Leave => {
                return ["add rsp,8h", "pop r15", "pop r14", "pop rbp", "pop rbx"].map(str::to_owned).into();
            }
            Instruction::Argument { number, address } => {
                let to = ["rdi", "rsi", "rdx", "rcx"][usize::from(number)];
                if self.is_column(address.base) {
                    self.fetched(to, address)
                } else {
                    format!("lea {to},{}", self.address(address))
                }
            }
            Instruction::Call(_) => return vec![format!("mov rax,{FUNCTION:X}h"), "call rax".into()],
            Instruction::ClearUpper => "vzeroupper".into(),
            Instruction::Return => "ret".into(),
        };
        vec![line]
    }

    fn pair(&self, to: Register, low: Register, high: Operand) -> String {
        match (self.lanes, high) {
            (Lanes::Two, Operand::Register(high)) => {
                format!("vunpcklpd {},{},{}", half(to), half(low), half(high))
            }
            (Lanes::Two, high) => format!("vmovhpd {},{},{}", half(to), half(low), self.operand(high)),
            (_, high) => {
                let (name, high) = match high {
                    Operand::Register(high) => (halves(to.max(low), high), half(high)),
                    high => (halves(to, low), self.operand(high)),
                };
                format!("vinsertf{name} {},{},{high},1h", self.register(to), self.register(low))
            }
        }
    }
}

/// A register's first 16 bytes.
fn half(number: Register) -> String {
    format!("xmm{number}")
}

/// What instructions on halves of 32 bytes are called: otherwise where a register above 15 is among them.
fn halves(a: Register, b: Register) -> &'static str {
    if a.max(b) > 15 { "64x2" } else { "128" }
}

/// Encodes and decodes; returns how many instructions there were.
fn read_back(lanes: Lanes, columns: bool, instructions: &[Instruction]) -> usize {
    let functions = |_: Function| FUNCTION;
    let mut encoder = Encoder::new(Target { lanes, registers: 32, columns }, &functions);
    let mut assembly = Assembly { lanes, columns, entered: false };
    let mut meant = Vec::new();
    for instruction in instructions {
        encoder.instruction(Wide { lanes, instruction: *instruction });
        meant.extend(assembly.lines(*instruction));
    }
    let code = encoder.finish();
    let mut formatter = NasmFormatter::new();
    let options = formatter.options_mut();
    options.set_memory_size_options(MemorySizeOptions::Never);
    options.set_small_hex_numbers_in_decimal(false);
    options.set_add_leading_zero_to_hex_numbers(false);
    options.set_show_useless_prefixes(true);
    let mut found = Decoder::with_ip(64, &code, 0, DecoderOptions::NONE);
    for meant in &meant {
        let instruction = found.decode();
        assert!(!instruction.is_invalid(), "{meant}: invalid bytes at {}", instruction.ip());
        let mut text = String::new();
        formatter.format(&instruction, &mut text);
        // An offset of zero may be written out where the base has no form without.
        assert_eq!(text.replace("+0]", "]"), *meant);
    }
    assert!(!found.can_decode(), "bytes are left");
    meant.len()
}

/// Offsets about the borders of every short form, whatever the unit it counts in.
const OFFSETS: [i32; 24] = [
    0,
    8,
    16,
    64,
    120,
    127,
    128,
    136,
    512,
    1008,
    1016,
    1024,
    2032,
    4064,
    4096,
    8128,
    8192,
    65536,
    1 << 30,
    -8,
    -64,
    -128,
    -1024,
    -8192,
];

const BASES: [Base; 4] = [Base::Input, Base::Output, Base::Pool, Base::Frame];

fn addresses() -> impl Iterator<Item = Address> {
    BASES.into_iter().flat_map(|base| OFFSETS.into_iter().map(move |offset| Address { base, offset }))
}

/// Forms that every register may be in.
fn with_registers(lanes: Lanes, a: Register, b: Register, c: Register) -> Vec<Instruction> {
    let mut all = Vec::new();
    let mask = 1 + a % 7;
    let operations = [
        Binary::Add,
        Binary::Subtract,
        Binary::Multiply,
        Binary::Divide,
        Binary::And,
        Binary::AndNot,
        Binary::Xor,
        Binary::Larger,
        Binary::Smaller,
    ];
    let low = a.max(b).max(c) < 16 && lanes != Lanes::Eight;
    let operations = operations.into_iter().chain(low.then_some(Binary::Less));
    let memory = addresses().map(Operand::Memory);
    let spread = addresses().map(Operand::Broadcast).filter(|_| lanes == Lanes::Eight);
    let anywhere: Vec<Operand> = std::iter::once(Operand::Register(c)).chain(memory).chain(spread).collect();
    for operation in operations {
        let binary = |second: &Operand| Instruction::Binary { operation, to: a, first: b, second: *second };
        all.extend(anywhere.iter().map(binary));
    }
    for operand in &anywhere {
        all.push(Instruction::LessToMask { mask, first: b, second: *operand });
        all.push(Instruction::SelectByMask { to: a, no: b, yes: *operand, mask });
        // One lane takes the root of registers only.
        if lanes != Lanes::One || matches!(operand, Operand::Register(_)) {
            all.push(Instruction::SquareRoot { to: a, of: *operand });
        }
        if low && !matches!(operand, Operand::Broadcast(_)) {
            all.push(Instruction::Select { to: a, no: b, yes: *operand, mask: (a + 1) % 16 });
        }
    }
    for address in addresses() {
        all.push(Instruction::Load { to: a, from: Operand::Memory(address) });
        all.push(Instruction::Store { from: a, to: address });
        if lanes == Lanes::Eight {
            all.push(Instruction::Load { to: a, from: Operand::Broadcast(address) });
        }
    }
    all.extend([Instruction::SignToMask { mask, of: a }, Instruction::MaskToRegister { to: a, mask }]);
    if matches!(lanes, Lanes::Two | Lanes::Four) {
        let whole = anywhere.iter().filter(|operand| !matches!(operand, Operand::Broadcast(_)));
        all.extend(whole.map(|high| Instruction::Pair { to: a, low: b, high: *high }));
        all.extend([Instruction::Low { to: a, of: b }, Instruction::High { to: a, of: b }]);
    }
    all
}

#[test]
fn every_form_is_read_back_as_it_was_meant() {
    let mut count = 0;
    let targets = [Lanes::One, Lanes::Two, Lanes::Four, Lanes::Eight].into_iter();
    for (lanes, columns) in targets.flat_map(|lanes| [(lanes, false), (lanes, true)]) {
        for register in 0..32_u16 {
            // The two others go through all registers in other orders.
            let [b, c] = [register * 7 + 3, register * 13 + 5].map(|number| (number % 32) as Register);
            let register = register as Register;
            // Where pointers lie as they are passed, and where calls leave them.
            for (first, last) in [(None, None), (Some(Instruction::Enter), Some(Instruction::Leave))] {
                for (a, b, c) in [(register, b, c), (b, c, register), (register % 16, b % 16, c % 16)] {
                    let forms = with_registers(lanes, a, b, c);
                    let all: Vec<Instruction> = first.into_iter().chain(forms).chain(last).collect();
                    count += read_back(lanes, columns, &all);
                }
            }
        }
    }
    println!("{count} instructions");
}

#[test]
fn calls_are_read_back_as_they_were_meant() {
    let arguments = |number| addresses().map(move |address| Instruction::Argument { number, address });
    let mut all = vec![Instruction::Enter];
    all.extend((0..4).flat_map(arguments));
    all.extend([Instruction::ClearUpper, Instruction::Call(Function::Ln)]);
    all.extend([Instruction::Leave, Instruction::Return]);
    for columns in [false, true] {
        read_back(Lanes::Four, columns, &all);
    }
}
