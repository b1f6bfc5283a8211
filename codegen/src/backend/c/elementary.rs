//! Functions that the file brings along: the runtime's own, written down operation by operation, so that they give its bits; and
//! what they need of the bits of a number. In: which are called. Out: text.

use std::collections::BTreeSet;

use linkwear_runtime::{Scalar, angle_over_sine, elementary, log_coefficient, sin_cos};

use crate::tape::{Binary, Op, Split, Tape, Unary};

use super::angles;
use super::recorder::{Function, Number, Recorder};

/// What reads and writes bits, each after what it needs.
const BITS: &str = "\
/* A number and its bits. */
typedef union {
    double number;
    uint64_t bits;
} number_bits;
";

/// Several angles at once. A loop of so many rounds as a vector has places becomes vector operations.
const SEVERAL: &str = "\
/* Sines and cosines of some angles [rad], side by side. */
static LINKWEAR_INLINE void sines_and_cosines(int count, const double *restrict angles, double *restrict sines,
                                              double *restrict cosines)
{
    for (int i = 0; i < count; i++) {
        const sine_cosine_pair pair = sine_cosine(angles[i]);
        sines[i] = pair.sine;
        cosines[i] = pair.cosine;
    }
}
";

impl Function {
    /// Its name in the file.
    pub fn name(self) -> String {
        match self {
            Self::WithSignOf => "with_sign_of".to_owned(),
            Self::PowerOfTwo => "power_of_two".to_owned(),
            Self::Significand => "significand".to_owned(),
            Self::BinaryExponent => "binary_exponent".to_owned(),
            Self::Sine | Self::Cosine => "sine_cosine".to_owned(),
            Self::SinesAndCosines => "sines_and_cosines".to_owned(),
            Self::Exponential => "exponential".to_owned(),
            Self::Logarithm => "logarithm".to_owned(),
            Self::Angle => "angle".to_owned(),
            Self::Floor => "whole_part".to_owned(),
            Self::AngleOverSine => "angle_over_sine".to_owned(),
            Self::LogCoefficient(rank) => format!("log_coefficient_{rank}"),
        }
    }
}

/// All of these functions and those that they call.
pub fn functions(called: &BTreeSet<Function>) -> String {
    let mut all: BTreeSet<Function> = BTreeSet::new();
    let mut next: Vec<Function> = called.iter().copied().collect();
    while let Some(function) = next.pop() {
        // Both come by one call.
        let function = if function == Function::Cosine { Function::Sine } else { function };
        if all.insert(function) {
            next.extend(definition(function).1);
        }
    }
    let needs_bits = |function: &Function| *function < Function::Sine;
    let bits = if all.iter().any(needs_bits) { BITS } else { "" };
    // Declared in an order in which each calls earlier ones only.
    let parts = [bits.to_owned()].into_iter().chain(all.into_iter().map(|function| definition(function).0));
    parts.filter(|part| !part.is_empty()).map(|part| format!("\n{part}")).collect()
}

/// Text of a function, and the functions that it calls.
fn definition(function: Function) -> (String, BTreeSet<Function>) {
    match function {
        Function::WithSignOf => {
            let text = bits(
                "double size, double other",
                "The magnitude of a number with the sign of another.",
                &[
                    "number_bits a, b;",
                    "a.number = size;",
                    "b.number = other;",
                    "a.bits = (a.bits & 0x7fffffffffffffffu) | (b.bits & 0x8000000000000000u);",
                ],
            );
            (text.replace("NAME", "with_sign_of"), BTreeSet::new())
        }
        Function::PowerOfTwo => {
            let text = bits(
                "double power",
                "2 to a whole power from -1022 to 1023.",
                &["number_bits a;", "a.number = power + (6755399441055744.0 + 1023.0);", "a.bits <<= 52;"],
            );
            (text.replace("NAME", "power_of_two"), BTreeSet::new())
        }
        Function::Significand => {
            let text = bits(
                "double value",
                "The significand of a positive normal number, in [1, 2).",
                &[
                    "number_bits a;",
                    "a.number = value;",
                    "a.bits = (a.bits & 0x000fffffffffffffu) | 0x3ff0000000000000u;",
                ],
            );
            (text.replace("NAME", "significand"), BTreeSet::new())
        }
        Function::BinaryExponent => {
            let text = bits(
                "double value",
                "The exponent of two of a positive normal number.",
                &[
                    "number_bits a;",
                    "a.number = value;",
                    "a.bits = (a.bits >> 52) | 0x4330000000000000u;",
                    "a.number -= 4503599627370496.0 + 1023.0;",
                ],
            );
            (text.replace("NAME", "binary_exponent"), BTreeSet::new())
        }
        Function::Sine | Function::Cosine => pair(),
        Function::SinesAndCosines => (SEVERAL.to_owned(), BTreeSet::from([Function::Sine])),
        Function::Exponential => recorded(function, "e to a power.", &["a"], |[a, _]| elementary::exp(a)),
        Function::Logarithm => {
            recorded(function, "The natural logarithm.", &["a"], |[a, _]| elementary::ln(a))
        }
        Function::Angle => recorded(function, "Angle of the vector (b, a) [rad].", &["a", "b"], |[a, b]| {
            elementary::atan2(a, b)
        }),
        Function::AngleOverSine => {
            let doc = "theta / sin theta by sin^2 theta (a) and cos theta (b).";
            recorded(function, doc, &["a", "b"], |[a, b]| angle_over_sine(a, b))
        }
        Function::Floor => {
            let doc = "The largest whole number that is not above a number below 2^51.";
            recorded(function, doc, &["a"], |[a, _]| a.floor())
        }
        Function::LogCoefficient(rank) => {
            let doc = "Coefficient of the inverse right Jacobian of SO(3), by theta^2.";
            recorded(function, doc, &["a"], |[a, _]| log_coefficient(rank, a))
        }
    }
}

fn bits(arguments: &str, doc: &str, lines: &[&str]) -> String {
    let lines: String = lines.iter().map(|line| format!("    {line}\n")).collect();
    format!("/* {doc} */\nstatic double NAME({arguments})\n{{\n{lines}    return a.number;\n}}\n")
}

fn recorded(
    function: Function,
    doc: &str,
    arguments: &[&str],
    run: impl for<'r> Fn([Number<'r>; 2]) -> Number<'r>,
) -> (String, BTreeSet<Function>) {
    let recorder = Recorder::default();
    let output = recorder.id(run([recorder.input(0), recorder.input(1)]));
    let recording = recorder.finish();
    let (statements, results) =
        recording.statements(&[output], |index| arguments.get(index).copied().unwrap_or_default().to_owned());
    let list: Vec<String> = arguments.iter().map(|argument| format!("double {argument}")).collect();
    let text = format!(
        "/* {doc} */\nstatic double {}({})\n{{\n{statements}    return {};\n}}\n",
        function.name(),
        list.join(", "),
        results[0]
    );
    (text, recording.calls(&[output]))
}

fn pair() -> (String, BTreeSet<Function>) {
    let recorder = Recorder::default();
    let (sine, cosine) = sin_cos(recorder.input(0));
    let outputs = [recorder.id(sine), recorder.id(cosine)];
    let recording = recorder.finish();
    let (statements, results) = recording.statements(&outputs, |_| "a".to_owned());
    let text = format!(
        "/* Sine and cosine of an angle [rad], at most 1 ulp off up to 1e6. */\n\
         typedef struct {{\n    double sine;\n    double cosine;\n}} sine_cosine_pair;\n\n\
         static LINKWEAR_INLINE sine_cosine_pair sine_cosine(double a)\n{{\n    sine_cosine_pair pair;\n{statements}    \
         pair.sine = {};\n    pair.cosine = {};\n    return pair;\n}}\n",
        results[0], results[1]
    );
    (text, recording.calls(&outputs))
}

/// What a tape's operations call.
pub fn of_tape(tape: &Tape, split: &Split) -> BTreeSet<Function> {
    let several = split.parts.iter().any(|part| !angles::groups(tape, part).is_empty());
    let several = several.then_some(Function::SinesAndCosines);
    tape.statements
        .iter()
        .filter_map(|statement| match statement.op {
            Op::SinCos(_) => Some(Function::Sine),
            Op::Unary(Unary::Exp, _) => Some(Function::Exponential),
            Op::Unary(Unary::Ln, _) => Some(Function::Logarithm),
            Op::Unary(Unary::Floor, _) => Some(Function::Floor),
            Op::Unary(Unary::LogCoefficient(rank), _) => Some(Function::LogCoefficient(rank)),
            Op::Binary(Binary::Atan2, ..) => Some(Function::Angle),
            Op::Binary(Binary::AngleOverSine, ..) => Some(Function::AngleOverSine),
            Op::Unary(..) | Op::Binary(..) | Op::Select(..) => None,
        })
        .chain(several)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_come_with_all_that_they_call_and_no_others() {
        let text = functions(&BTreeSet::from([Function::AngleOverSine]));
        for wanted in ["double angle_over_sine(", "double angle(", "double with_sign_of(", "} number_bits;"] {
            assert_eq!(text.matches(wanted).count(), 1, "{wanted}");
        }
        assert!(!text.contains("logarithm("));
        assert!(!text.contains("power_of_two("));
    }

    #[test]
    fn recorded_numbers_and_known_ones_agree() {
        let known = Number::Known(2.0).exp().ln().atan2(Number::Known(3.0));
        assert!(
            matches!(known, Number::Known(value) if value == Scalar::atan2(Scalar::ln(Scalar::exp(2.0_f64)), 3.0))
        );
    }
}
