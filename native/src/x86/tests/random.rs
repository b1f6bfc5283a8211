//! Random tapes, with few registers and with many: the bits of plain evaluation.

use super::guarded::Guarded;
use super::hostile::hostile;
use crate::memory::code::Code;
use crate::straight::graph::Function;
use crate::straight::tests::random_tape::{Random, evaluated};
use crate::straight::write::write;
use crate::x86::features::can_run;
use crate::x86::instruction::{Lanes, Target};

/// 5 and 6 registers are fewer than any processor has: nearly every value is spilled.
const TARGETS: [(Lanes, u8); 7] = [
    (Lanes::One, 5),
    (Lanes::One, 16),
    (Lanes::One, 32),
    (Lanes::Four, 6),
    (Lanes::Four, 16),
    (Lanes::Four, 32),
    (Lanes::Eight, 32),
];

pub(super) fn functions(lanes: Lanes) -> fn(Function) -> usize {
    match lanes {
        Lanes::One => hostile::<1>,
        Lanes::Two => hostile::<2>,
        Lanes::Four => hostile::<4>,
        Lanes::Eight => hostile::<8>,
    }
}

/// `cargo test` runs 300 tapes; `ROUNDS=20000` runs more.
#[test]
fn random_tapes_have_the_bits_of_plain_evaluation() {
    let rounds = std::env::var("ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(300_u64);
    let (mut compared, mut undefined) = (0_usize, 0_usize);
    for seed in 1..=rounds {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let size = 1 + random.below(400);
        let tape = random.tape(size, seed % 2 == 0);
        for (lanes, registers) in TARGETS {
            let target = Target { lanes, registers, columns: false };
            if !can_run(target) {
                continue;
            }
            let written = write(&tape, target, &functions(lanes)).expect("a tape");
            let code = Code::new(vec![written]).expect("executable memory");
            let count = lanes.count();
            let mut input = Guarded::new(tape.input_len() * count, 0.0);
            input.numbers().fill_with(|| {
                // Now and then an angle of which no turn is left.
                let scale = if random.below(40) == 0 { 1e19 } else { 4.0 };
                scale * (random.unit() - 0.5)
            });
            let mut output = Guarded::new(tape.output_len() * count, f64::MAX);
            let mut workspace = Guarded::new(code.workspace(), f64::MAX);
            code.run(0, input.numbers(), output.numbers(), workspace.numbers());
            if lanes != Lanes::One {
                let columns = Target { columns: true, ..target };
                let code = Code::new(vec![write(&tape, columns, &functions(lanes)).expect("a tape")]);
                let code = code.expect("executable memory");
                columns_have_the_bits_of_lanes(&code, count, input.numbers(), output.numbers());
            }
            for lane in 0..count {
                let state: Vec<f64> = input.numbers().iter().skip(lane).step_by(count).copied().collect();
                let found = output.numbers().iter().skip(lane).step_by(count);
                for (index, (found, expected)) in found.zip(evaluated(&tape, &state)).enumerate() {
                    if expected.is_nan() {
                        // Signs and payloads of NaN are nobody's promise.
                        undefined += 1;
                        assert!(
                            found.is_nan(),
                            "seed {seed}, {target:?}, output {index}, lane {lane}: {found}"
                        );
                    } else {
                        compared += 1;
                        assert_eq!(
                            found.to_bits(),
                            expected.to_bits(),
                            "seed {seed}, {target:?}, output {index}, lane {lane}: {found}, not {expected}"
                        );
                    }
                }
            }
        }
    }
    assert!(compared > undefined, "{compared} numbers compared, {undefined} undefined");
    println!("{compared} numbers equal in every bit, {undefined} undefined in both");
}

/// The same numbers in columns: twice as many states, the second half as the first, and a column of one value.
fn columns_have_the_bits_of_lanes(code: &Code, count: usize, input: &mut [f64], output: &[f64]) {
    let column = |values: &[f64]| Guarded::holding(&[values, values].concat());
    let mut columns: Vec<Guarded> = input.chunks_exact(count).map(column).collect();
    let mut answers: Vec<Guarded> =
        (0..output.len() / count).map(|_| Guarded::new(2 * count, f64::MAX)).collect();
    let mut workspace = Guarded::new(code.workspace(), f64::MAX);
    let columns: Vec<&[f64]> = columns.iter_mut().map(|column| &*column.numbers()).collect();
    let mut places: Vec<&mut [f64]> = answers.iter_mut().map(Guarded::numbers).collect();
    match count {
        4 => code.run_columns::<4>(0, &columns, &mut places, workspace.numbers()),
        _ => code.run_columns::<8>(0, &columns, &mut places, workspace.numbers()),
    }
    for (found, expected) in places.iter().zip(output.chunks_exact(count)) {
        for (found, expected) in found.iter().zip(expected.iter().chain(expected)) {
            assert!(found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan());
        }
    }
}
