//! Tapes as bytes. What is read is verified elsewhere.

use crate::block::Block;
use crate::operation::{Binary, Op, Operand, Unary};
use crate::stored;
use crate::tape::{Statement, Tape};

stored!(enum Unary { 0: Neg, 1: Sqrt, 2: Sin, 3: Cos, 4: Exp, 5: Ln, 6: LogCoefficient(rank), 7: Floor });
stored!(enum Binary { 0: Add, 1: Sub, 2: Mul, 3: Div, 4: Atan2, 5: AngleOverSine });
stored!(enum Operand { 0: Value(value), 1: Input(index), 2: Constant(number) });
stored!(enum Op { 0: Unary(operation, a), 1: Binary(operation, a, b), 2: SinCos(angle), 3: Select(of, yes, no) });
stored!(struct Statement { op, first, labels, section, stores });
stored!(struct Block { name, doc, citation, rows, columns });
stored!(struct Tape { name, doc, inputs, input_names, outputs, direct, statements, sections, values });
