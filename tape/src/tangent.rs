//! Derivatives of a tape along a direction, as a tape. In: a tape. Out: one that computes outputs and their tangents from inputs and
//! theirs. Never knows what is varied.
//!
//! Every operation is followed by its tangent; what no input that varies reaches has none. Lanes of the tape are directions.

use linkwear_runtime::Scalar;

use crate::operation::{Binary, Op, Operand, Unary};
use crate::recorder::{Number, Recorder};
use crate::tape::{Statement, Tape};

/// A number and its tangent; nothing where it does not vary.
type Varied<'r> = (Number<'r>, Option<Number<'r>>);

impl Tape {
    /// Inputs, then the tangent of each; outputs, then the tangent of each.
    ///
    /// ```
    /// use linkwear_runtime::Scalar;
    /// use linkwear_tape::{Recorder, Routine};
    ///
    /// // y = x^2 sin x, along dx = 1: 2 x sin x + x^2 cos x.
    /// let recorder = Recorder::default();
    /// let x = recorder.input(0);
    /// let output = Recorder::operand(x * x * x.sin_cos().0);
    /// let wave = Routine::new(&recorder.finish("wave", 1, &[output]).tangent());
    /// let mut answer = [0.0; 2];
    /// wave.run(&[0.5, 1.0], &mut answer, &mut vec![0.0; wave.workspace()]);
    /// assert!((answer[1] - (0.5_f64.sin() + 0.25 * 0.5_f64.cos())).abs() < 1e-15);
    /// ```
    pub fn tangent(&self) -> Self {
        let (recorder, count) = (Recorder::default(), self.input_len() as u32);
        let mut values: Vec<Varied<'_>> = Vec::with_capacity(self.values as usize);
        let mut outputs: Vec<Varied<'_>> = vec![(Number::Known(0.0), None); self.output_len()];
        for (index, operand) in &self.direct {
            outputs[*index as usize] = find(&recorder, count, *operand, &[]);
        }
        for Statement { op, stores, .. } in &self.statements {
            let get = |operand| find(&recorder, count, operand, &values);
            match *op {
                Op::Unary(operation, a) => values.push(unary(&recorder, operation, get(a))),
                Op::Binary(operation, a, b) => values.push(binary(&recorder, operation, get(a), get(b))),
                Op::Select(of, yes, no) => values.push(select(get(of), get(yes), get(no))),
                Op::SinCos(angle) => {
                    let (angle, rate) = get(angle);
                    let (sine, cosine) = angle.sin_cos();
                    values.push((sine, rate.map(|rate| cosine * rate)));
                    values.push((cosine, rate.map(|rate| -(sine * rate))));
                }
            }
            for (index, operand) in stores {
                outputs[*index as usize] = find(&recorder, count, *operand, &values);
            }
        }
        let still = Number::Known(0.0);
        let tangents = outputs.iter().map(|(_, tangent)| tangent.unwrap_or(still));
        let all = outputs.iter().map(|(value, _)| *value).chain(tangents).map(Recorder::operand);
        let all: Vec<Operand> = all.collect();
        recorder.finish(&self.name, 2 * count as usize, &all)
    }
}

fn find<'r>(recorder: &'r Recorder, inputs: u32, operand: Operand, values: &[Varied<'r>]) -> Varied<'r> {
    match operand {
        Operand::Constant(number) => (Number::Known(number), None),
        Operand::Input(index) => (recorder.input(index), Some(recorder.input(inputs + index))),
        Operand::Value(value) => values[value as usize],
    }
}

/// Sum of tangents, of which each may be none.
fn sum<'r>(a: Option<Number<'r>>, b: Option<Number<'r>>) -> Option<Number<'r>> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (one, None) | (None, one) => one,
    }
}

fn unary<'r>(recorder: &'r Recorder, operation: Unary, (x, rate): Varied<'r>) -> Varied<'r> {
    let value = recorder.unary(operation, x);
    let Some(rate) = rate else { return (value, None) };
    let tangent = match operation {
        Unary::Neg => -rate,
        Unary::Sqrt => rate / (value + value),
        Unary::Exp => value * rate,
        Unary::Ln => rate / x,
        // As between its jumps.
        Unary::Floor => return (value, None),
        Unary::LogCoefficient(rank) => recorder.unary(Unary::LogCoefficient(rank + 1), x) * rate,
        Unary::Sin => x.sin_cos().1 * rate,
        Unary::Cos => -(x.sin_cos().0 * rate),
    };
    (value, Some(tangent))
}

fn binary<'r>(
    recorder: &'r Recorder,
    operation: Binary,
    (a, da): Varied<'r>,
    (b, db): Varied<'r>,
) -> Varied<'r> {
    let value = recorder.binary(operation, a, b);
    let tangent = match operation {
        Binary::Add => sum(da, db),
        Binary::Sub => sum(da, db.map(|db| -db)),
        Binary::Mul => sum(da.map(|da| da * b), db.map(|db| a * db)),
        Binary::Div => {
            let change = db.map(|db| -(value * db));
            sum(da, change).map(|change| change / b)
        }
        Binary::Atan2 => {
            let square = a * a + b * b;
            sum(da.map(|da| b * da), db.map(|db| -(a * db))).map(|change| change / square)
        }
        Binary::AngleOverSine => angle_over_sine(value, (a, da), (b, db)),
    };
    (value, tangent)
}

/// Sine squared below which theta / sin theta goes by its series: the terms left out are below 1e-16 of it there.
const SMALL: f64 = 1e-4;

/// The tangent of theta / sin theta, from sine squared and cosine: near zero by the sine alone, as its value is.
fn angle_over_sine<'r>(
    value: Number<'r>,
    (square, by_square): Varied<'r>,
    (cosine, by_cosine): Varied<'r>,
) -> Option<Number<'r>> {
    let c = Number::Known;
    // Past a right angle a small sine is not a small angle.
    let size = Number::select(cosine.lt(c(0.0)), c(1.0), square);
    let is_small = size.lt(c(SMALL));
    let safe = Number::select(is_small, c(1.0), square);
    let length = safe + cosine * cosine;
    let far = sum(
        by_square.map(|rate| (cosine / length - value) / (safe + safe) * rate),
        by_cosine.map(|rate| -(rate / length)),
    );
    // 1/6 + 3/20 s + 15/112 s^2 + 35/288 s^3, the derivative of asin(sqrt s) / sqrt s.
    let series = ((c(35.0 / 288.0) * square + c(15.0 / 112.0)) * square + c(0.15)) * square + c(1.0 / 6.0);
    let near = by_square.map_or(c(0.0), |rate| series * rate);
    far.map(|far| Number::select(is_small, near, far))
}

fn select<'r>((of, _): Varied<'r>, (yes, dyes): Varied<'r>, (no, dno): Varied<'r>) -> Varied<'r> {
    let still = Number::Known(0.0);
    let value = Number::select(of.lt(still), yes, no);
    let varies = dyes.is_some() || dno.is_some();
    let tangent = || Number::select(of.lt(still), dyes.unwrap_or(still), dno.unwrap_or(still));
    (value, varies.then(tangent))
}

#[cfg(test)]
mod tests {
    use linkwear_runtime::Dual;

    use super::*;
    use crate::interpreter::Routine;

    /// Every operation, on both sides of every choice: as dual numbers carry it through the interpreter.
    #[test]
    fn tangents_are_those_of_dual_numbers() {
        let recorder = Recorder::default();
        let [x, y, z] = [0, 1, 2].map(|index| recorder.input(index));
        let (sine, cosine) = x.sin_cos();
        let by_angle = recorder.binary(Binary::AngleOverSine, sine * sine, cosine);
        let coefficient = recorder.unary(Unary::LogCoefficient(0), x * x);
        let outputs = [
            x * y + z / y - x,
            -(y.sqrt() + z.exp() * y.ln()),
            x.atan2(y),
            by_angle + coefficient,
            x.abs() + x.max(y) + (z + z).floor() * x,
        ];
        let outputs = outputs.map(Recorder::operand);
        let tape = recorder.finish("all", 3, &outputs);
        let (plain, tangent) = (Routine::new(&tape), Routine::new(&tape.tangent()));
        for [a, b, c] in [[0.4, 1.3, 0.2], [-2.5, 0.7, -1.1], [1e-3, 2.0, 3.3]] {
            let seeds = [0.3, -1.2, 0.8];
            let input = [Dual::new(a, seeds[0]), Dual::new(b, seeds[1]), Dual::new(c, seeds[2])];
            let mut expected = [Dual::new(0.0, 0.0); 5];
            plain.run(&input, &mut expected, &mut vec![Dual::new(0.0, 0.0); plain.workspace()]);
            let mut found = [0.0; 10];
            let question = [a, b, c, seeds[0], seeds[1], seeds[2]];
            tangent.run(&question, &mut found, &mut vec![0.0; tangent.workspace()]);
            for (place, dual) in expected.iter().enumerate() {
                assert_eq!(found[place], dual.value);
                let size = dual.derivative.abs().max(1.0);
                // The series of theta / sin theta ends at 1e-12 of it; all else rounds a few times.
                assert!((found[5 + place] - dual.derivative).abs() < 1e-11 * size, "{place} at {a} {b} {c}");
            }
        }
    }

    /// What differs between two tapes of one form becomes an input; nothing else does.
    #[test]
    fn constants_that_differ_become_inputs() {
        let tape = |factor: f64| {
            let recorder = Recorder::default();
            let x = recorder.input(0);
            let output = Recorder::operand(x * Number::Known(factor) + Number::Known(2.0) * x);
            recorder.finish("line", 1, &[output])
        };
        let (base, other) = (tape(3.0), tape(3.5));
        assert!(base.has_form_of(&other));
        let (lifted, values) = base.lifted(&[&other]);
        assert_eq!((lifted.input_len(), values), (2, vec![vec![3.0, 3.5]]));
        let routine = Routine::new(&lifted);
        let mut answer = [0.0];
        routine.run(&[2.0, 3.5], &mut answer, &mut vec![0.0; routine.workspace()]);
        assert_eq!(answer, [11.0]);
    }

    /// Where a sum or product has its constant is no form, and changes no bit.
    #[test]
    fn constants_have_one_place() {
        let tape = |swapped: bool| {
            let recorder = Recorder::default();
            let x = recorder.input(0);
            let [two, three] = [2.1, 3.3].map(Number::Known);
            let output = if swapped { two + three * x - x * x } else { x * three + two - x * x };
            let output = Recorder::operand(output);
            recorder.finish("line", 1, &[output])
        };
        let (one, other) = (tape(false), tape(true));
        assert!(one.clone().constants_first().has_form_of(&other.clone().constants_first()));
        let answers = [one.clone().constants_first(), one, other].map(|tape| {
            let (routine, mut answer) = (Routine::new(&tape), [0.0]);
            routine.run(&[0.7], &mut answer, &mut vec![0.0; routine.workspace()]);
            answer[0].to_bits()
        });
        assert_eq!(answers, [answers[0]; 3]);
    }
}
