//! Statements of a tape as lines of C, four spaces deep. In: a tape and one of its parts. Out: text.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

use crate::tape::{Binary, Op, Operand, Part, Statement, Tape, Unary};

use super::angles::{self, Group};
use super::names::Names;
use super::text::{comment, number};

/// Stores of outputs that need no statement.
pub fn direct(tape: &Tape) -> String {
    let mut text = String::new();
    for (index, operand) in &tape.direct {
        let value = match operand {
            Operand::Input(input) => format!("x[{input}]"),
            Operand::Constant(value) => number(*value),
            Operand::Value(_) => String::new(),
        };
        let _ = writeln!(text, "    y[{index}] = {value};");
    }
    text
}

/// By value: whether anything reads it. Compilers warn of those that nothing reads, one of a sine and a cosine.
pub fn read(tape: &Tape) -> Vec<bool> {
    let mut read = vec![false; tape.values as usize];
    for operand in tape.statements.iter().flat_map(Statement::reads) {
        if let Operand::Value(value) = operand {
            read[value as usize] = true;
        }
    }
    read
}

/// Statements of one part, with its loads and saves.
pub fn part(tape: &Tape, part: &Part, read: &[bool]) -> String {
    let mut writer = Writer {
        read,
        groups: angles::groups(tape, part),
        names: Names::default(),
        inputs: HashMap::new(),
        values: HashMap::new(),
        arrays: HashMap::new(),
        text: String::new(),
    };
    let statements = &tape.statements[part.statements.clone()];
    writer.inputs(tape, statements);
    writer.values.extend(part.loads.iter().map(|(value, slot)| (*value, format!("w[{slot}]"))));
    let mut section = None;
    for statement in statements {
        if section != Some(statement.section) {
            section = Some(statement.section);
            writer.line(&format!("/* {} */", comment(&tape.sections[statement.section])));
        }
        writer.statement(statement);
    }
    for (value, slot) in &part.saves {
        let line = format!("w[{slot}] = {};", writer.values[value]);
        writer.line(&line);
    }
    writer.text
}

struct Writer<'a> {
    read: &'a [bool],
    groups: Vec<Group>,
    names: Names,
    inputs: HashMap<u32, String>,
    values: HashMap<u32, String>,
    /// By group that is computed: its sines, its cosines.
    arrays: HashMap<usize, [String; 2]>,
    text: String,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "    {line}");
    }

    /// Names for the inputs that are read, in the order of the first reading; lines in the order of the input.
    fn inputs(&mut self, tape: &Tape, statements: &[Statement]) {
        let mut read = BTreeMap::new();
        for operand in statements.iter().flat_map(Statement::reads) {
            if let Operand::Input(index) = operand {
                let name = || self.names.unique(&tape.input_names[index as usize]);
                read.entry(index).or_insert_with(name);
            }
        }
        for (index, name) in &read {
            self.line(&format!("const double {name} = x[{index}];"));
        }
        self.inputs.extend(read);
    }

    fn statement(&mut self, statement: &Statement) {
        match statement.op {
            Op::SinCos(a) => {
                for (which, right) in (0..).zip(self.sine_and_cosine(statement.first, a)) {
                    self.declare(statement, which, &right);
                }
            }
            Op::Select(a, yes, no) => {
                let [a, yes, no] = [a, yes, no].map(|operand| self.operand(operand));
                self.declare(statement, 0, &format!("{a} < 0.0 ? {yes} : {no}"));
            }
            Op::Unary(operation, a) => {
                let right = unary(operation, &self.operand(a));
                self.declare(statement, 0, &right);
            }
            Op::Binary(operation, a, b) => {
                let right = binary(operation, &self.operand(a), &self.operand(b));
                self.declare(statement, 0, &right);
            }
        }
        for (index, operand) in &statement.stores {
            let line = format!("y[{index}] = {};", self.operand(*operand));
            self.line(&line);
        }
    }

    /// Where sine and cosine of an angle are found, after the lines that compute them.
    fn sine_and_cosine(&mut self, first: u32, angle: Operand) -> [String; 2] {
        let place = |group: &Group| group.firsts.iter().position(|other| *other == first);
        let found = (0..).zip(&self.groups).find_map(|(number, group)| Some((number, place(group)?)));
        let Some((number, place)) = found else {
            let angle = self.operand(angle);
            let pair = self.names.unique(&format!("pair_{first}"));
            self.line(&format!("const sine_cosine_pair {pair} = sine_cosine({angle});"));
            return [format!("{pair}.sine"), format!("{pair}.cosine")];
        };
        if place == 0 {
            let angles: Vec<String> =
                self.groups[number].angles.iter().map(|angle| self.operand(*angle)).collect();
            let names =
                ["angles", "sines", "cosines"].map(|word| self.names.unique(&format!("{word}_{first}")));
            let [list, sines, cosines] = &names;
            let count = angles.len();
            self.line(&format!("const double {list}[] = {{{}}};", angles.join(", ")));
            self.line(&format!("double {sines}[{count}], {cosines}[{count}];"));
            self.line(&format!("sines_and_cosines({count}, {list}, {sines}, {cosines});"));
            self.arrays.insert(number, [sines.clone(), cosines.clone()]);
        }
        self.arrays[&number].clone().map(|array| format!("{array}[{place}]"))
    }

    fn declare(&mut self, statement: &Statement, which: u32, right: &str) {
        let value = statement.first + which;
        if !self.read[value as usize] {
            return;
        }
        let name = match &statement.labels[which as usize] {
            Some(label) => self.names.unique(label),
            None => self.names.unique(&format!("t{value}")),
        };
        self.line(&format!("const double {name} = {right};"));
        self.values.insert(value, name);
    }

    fn operand(&self, operand: Operand) -> String {
        match operand {
            Operand::Constant(value) => number(value),
            Operand::Input(index) => self.inputs[&index].clone(),
            Operand::Value(value) => self.values[&value].clone(),
        }
    }
}

#[expect(clippy::unreachable, reason = "lowering turns sines and cosines into pairs")]
fn unary(operation: Unary, a: &str) -> String {
    match operation {
        Unary::Neg if a.starts_with('-') => format!("-({a})"),
        Unary::Neg => format!("-{a}"),
        Unary::Sqrt => format!("sqrt({a})"),
        Unary::Exp => format!("exponential({a})"),
        Unary::Ln => format!("logarithm({a})"),
        Unary::Floor => format!("whole_part({a})"),
        Unary::LogCoefficient(rank) => format!("log_coefficient_{rank}({a})"),
        Unary::Sin | Unary::Cos => unreachable!("lowering turns sines and cosines into pairs"),
    }
}

fn binary(operation: Binary, a: &str, b: &str) -> String {
    match operation {
        Binary::Add => format!("{a} + {b}"),
        Binary::Sub => format!("{a} - {b}"),
        Binary::Mul => format!("{a} * {b}"),
        Binary::Div => format!("{a} / {b}"),
        Binary::Atan2 => format!("angle({a}, {b})"),
        Binary::AngleOverSine => format!("angle_over_sine({a}, {b})"),
    }
}
