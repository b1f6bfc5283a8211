//! Runs tapes without a compiler, in the same bits as compiled code.
//! In: one tape per entry. Out: a [`System`]. Never allocates while it evaluates.
//!
//! Constants, inputs and registers lie side by side in the workspace, so that an operand is one index.

use std::ops::Range;
use std::sync::Arc;

use linkwear_runtime::{Description, Dual, Entry, Scalar, Sizes, System, angle_over_sine, log_coefficient};

use crate::operation::{Binary, Op, Operand, Unary};
use crate::registers::Registers;
use crate::tape::{Statement, Tape};

/// A mechanism as tapes, ready to be evaluated on any scalar.
#[derive(Clone, Debug)]
pub struct Interpreted {
    routines: Arc<Vec<Routine>>,
    sizes: Sizes,
    description: Arc<Description>,
}

/// One tape, ready to be run on any scalar.
#[derive(Clone, Debug)]
pub struct Routine {
    constants: Vec<f64>,
    inputs: usize,
    outputs: usize,
    /// Outputs that are always zero, as most entries of large matrices.
    zeros: Vec<Range<usize>>,
    instructions: Vec<Instruction>,
    workspace: usize,
}

/// Operands and results are indices into the workspace; `Store` writes an output.
#[derive(Clone, Copy, Debug)]
enum Instruction {
    Add(u32, u32, u32),
    Sub(u32, u32, u32),
    Mul(u32, u32, u32),
    Div(u32, u32, u32),
    Neg(u32, u32),
    Sqrt(u32, u32),
    SinCos { angle: u32, sine: u32, cosine: u32 },
    Exp(u32, u32),
    Ln(u32, u32),
    Floor(u32, u32),
    Atan2(u32, u32, u32),
    AngleOverSine(u32, u32, u32),
    LogCoefficient(u8, u32, u32),
    Select { of: u32, yes: u32, no: u32, result: u32 },
    Store(u32, u32),
}

impl Interpreted {
    /// Prepares tapes in the order of [`Entry::ALL`]. `sizes.workspace` is set here.
    pub fn new(tapes: &[Tape], sizes: Sizes, description: Description) -> Self {
        let mut workspace = 0;
        let routines: Vec<Routine> = tapes
            .iter()
            .map(|tape| {
                let routine = Routine::new(tape);
                workspace = workspace.max(routine.workspace);
                routine
            })
            .collect();
        Self {
            routines: Arc::new(routines),
            sizes: Sizes { workspace, ..sizes },
            description: Arc::new(description),
        }
    }

    /// On numbers. What is generic is compiled by the crate that asks for it; this is compiled here, where it is optimised.
    #[inline(never)]
    pub fn on_numbers(&self) -> &dyn System<f64> {
        self
    }

    /// On numbers with a derivative, as [`Self::on_numbers`].
    #[inline(never)]
    pub fn on_duals(&self) -> &dyn System<Dual<f64>> {
        self
    }

    /// On numbers, for who keeps it.
    #[inline(never)]
    pub fn boxed(self) -> Box<dyn System<f64>> {
        Box::new(self)
    }

    /// Names and units of what is evaluated.
    pub fn description(&self) -> &Description {
        &self.description
    }
}

impl Routine {
    /// Prepares a tape.
    pub fn new(tape: &Tape) -> Self {
        Self::with(tape, &Registers::assign(tape))
    }

    /// The same to be run a few times: with a register for every value, which are found at once.
    pub fn for_a_look(tape: &Tape) -> Self {
        Self::with(tape, &Registers::of_values(tape))
    }

    fn with(tape: &Tape, registers: &Registers) -> Self {
        let mut constants: Vec<f64> = Vec::new();
        let mut positions = std::collections::HashMap::new();
        let mut zeros: Vec<Range<usize>> = Vec::new();
        let mut direct: Vec<(u32, Operand)> = Vec::new();
        for (index, operand) in &tape.direct {
            let place = *index as usize;
            match zeros.last_mut() {
                _ if !is_zero(operand) => direct.push((*index, *operand)),
                Some(last) if last.end == place => last.end += 1,
                _ => zeros.push(place..place + 1),
            }
        }
        let of_direct = direct.iter().map(|(_, operand)| *operand);
        for operand in of_direct.chain(tape.statements.iter().flat_map(Statement::reads)) {
            if let Operand::Constant(number) = operand {
                positions.entry(number.to_bits()).or_insert_with(|| {
                    constants.push(number);
                    constants.len() - 1
                });
            }
        }
        let (first_input, first_register) = (constants.len(), constants.len() + tape.input_len());
        let place = |operand: Operand| -> u32 {
            let index = match operand {
                Operand::Constant(number) => positions[&number.to_bits()],
                Operand::Input(index) => first_input + index as usize,
                Operand::Value(value) => first_register + registers.of_value[value as usize] as usize,
            };
            #[expect(clippy::expect_used, reason = "limits::EXPRESSIONS is far below the reach of 32 bits")]
            u32::try_from(index).expect("a workspace fits 32-bit indices")
        };
        let stores: usize = tape.statements.iter().map(|statement| statement.stores.len()).sum();
        let mut instructions = Vec::with_capacity(direct.len() + tape.statements.len() + stores);
        let store = |instructions: &mut Vec<Instruction>, list: &[(u32, Operand)]| {
            instructions
                .extend(list.iter().map(|(index, operand)| Instruction::Store(*index, place(*operand))));
        };
        store(&mut instructions, &direct);
        for statement in &tape.statements {
            let result = place(Operand::Value(statement.first));
            instructions.push(match statement.op {
                Op::SinCos(angle) => Instruction::SinCos {
                    angle: place(angle),
                    sine: result,
                    cosine: place(Operand::Value(statement.first + 1)),
                },
                Op::Select(of, yes, no) => {
                    Instruction::Select { of: place(of), yes: place(yes), no: place(no), result }
                }
                Op::Unary(operation, a) => unary(operation, place(a), result),
                Op::Binary(operation, a, b) => binary(operation, place(a), place(b), result),
            });
            store(&mut instructions, &statement.stores);
        }
        let workspace = first_register + registers.count as usize;
        let (inputs, outputs) = (tape.input_len(), tape.output_len());
        Self { constants, inputs, outputs, zeros, instructions, workspace }
    }

    /// Length of the output.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Length of the scratch slice that it works in.
    pub fn workspace(&self) -> usize {
        self.workspace
    }
}

/// Whether it is the number zero, of positive sign.
fn is_zero(operand: &Operand) -> bool {
    matches!(operand, Operand::Constant(number) if number.to_bits() == 0)
}

#[expect(clippy::unreachable, reason = "lowering turns sines and cosines into pairs")]
fn unary(operation: Unary, a: u32, result: u32) -> Instruction {
    match operation {
        Unary::Neg => Instruction::Neg(a, result),
        Unary::Sqrt => Instruction::Sqrt(a, result),
        Unary::Exp => Instruction::Exp(a, result),
        Unary::Ln => Instruction::Ln(a, result),
        Unary::Floor => Instruction::Floor(a, result),
        Unary::LogCoefficient(rank) => Instruction::LogCoefficient(rank, a, result),
        Unary::Sin | Unary::Cos => unreachable!("lowering turns sines and cosines into pairs"),
    }
}

fn binary(operation: Binary, a: u32, b: u32, result: u32) -> Instruction {
    match operation {
        Binary::Add => Instruction::Add(a, b, result),
        Binary::Sub => Instruction::Sub(a, b, result),
        Binary::Mul => Instruction::Mul(a, b, result),
        Binary::Div => Instruction::Div(a, b, result),
        Binary::Atan2 => Instruction::Atan2(a, b, result),
        Binary::AngleOverSine => Instruction::AngleOverSine(a, b, result),
    }
}

impl<T: Scalar> System<T> for Interpreted {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[T], output: &mut [T], workspace: &mut [T]) {
        self.routines[entry as usize].run(input, output, workspace);
    }
}

impl Routine {
    /// Runs it.
    ///
    /// # Panics
    /// If a slice is too short.
    pub fn run<T: Scalar>(&self, input: &[T], output: &mut [T], w: &mut [T]) {
        for (place, number) in w.iter_mut().zip(&self.constants) {
            *place = T::constant(*number);
        }
        let first = self.constants.len();
        w[first..first + self.inputs].copy_from_slice(&input[..self.inputs]);
        for zeros in &self.zeros {
            output[zeros.clone()].fill(T::constant(0.0));
        }
        for instruction in &self.instructions {
            match *instruction {
                Instruction::Add(a, b, r) => w[r as usize] = w[a as usize] + w[b as usize],
                Instruction::Sub(a, b, r) => w[r as usize] = w[a as usize] - w[b as usize],
                Instruction::Mul(a, b, r) => w[r as usize] = w[a as usize] * w[b as usize],
                Instruction::Div(a, b, r) => w[r as usize] = w[a as usize] / w[b as usize],
                Instruction::Neg(a, r) => w[r as usize] = -w[a as usize],
                Instruction::Sqrt(a, r) => w[r as usize] = w[a as usize].sqrt(),
                Instruction::SinCos { angle, sine, cosine } => {
                    let (s, c) = w[angle as usize].sin_cos();
                    w[sine as usize] = s;
                    w[cosine as usize] = c;
                }
                Instruction::Exp(a, r) => w[r as usize] = w[a as usize].exp(),
                Instruction::Ln(a, r) => w[r as usize] = w[a as usize].ln(),
                Instruction::Floor(a, r) => w[r as usize] = w[a as usize].floor(),
                Instruction::Select { of, yes, no, result } => {
                    let is_below = w[of as usize].lt(T::constant(0.0));
                    w[result as usize] = T::select(is_below, w[yes as usize], w[no as usize]);
                }
                Instruction::Atan2(a, b, r) => w[r as usize] = w[a as usize].atan2(w[b as usize]),
                Instruction::AngleOverSine(a, b, r) => {
                    w[r as usize] = angle_over_sine(w[a as usize], w[b as usize]);
                }
                Instruction::LogCoefficient(rank, a, r) => {
                    w[r as usize] = log_coefficient(rank, w[a as usize]);
                }
                Instruction::Store(index, a) => output[index as usize] = w[a as usize],
            }
        }
    }
}
