//! Sines of several angles of one state: side by side in one register, in the bits that each has alone.

use linkwear_runtime::Scalar;
use linkwear_tape::{Binary as Of, Op, Operand, Tape};

use crate::memory::code::Code;
use crate::straight::tests::random_tape::{of_statements, statement};
use crate::straight::write::{placed, write};
use crate::x86::features::{can_run, target};
use crate::x86::instruction::{Binary, Instruction, Lanes, Target};

const NO_CALLS: fn(crate::straight::graph::Function) -> usize = |_| 0;

/// Sine and cosine of every input, and of the sum of these two: an angle that waits for the first.
fn sines(count: u32) -> Tape {
    let mut statements = Vec::new();
    for angle in 0..count {
        let (first, output) = (5 * angle, 4 * angle);
        let [sine, cosine, sum] = [0, 1, 2].map(|value| Operand::Value(first + value));
        statements.push(statement(Op::SinCos(Operand::Input(angle)), first, &[output, output + 1]));
        statements.push(statement(Op::Binary(Of::Add, sine, cosine), first + 2, &[]));
        statements.push(statement(Op::SinCos(sum), first + 3, &[output + 2, output + 3]));
    }
    of_statements([1, 4].map(|each| each * count as usize), Vec::new(), statements)
}

#[test]
fn any_number_of_angles_has_the_bits_of_each_alone() {
    for (count, registers) in (1..10).flat_map(|count| [5, 16, 32].map(|registers| (count, registers))) {
        let target = Target { lanes: Lanes::One, registers, columns: false };
        if !can_run(target) {
            continue;
        }
        let code = Code::new(vec![write(&sines(count), target, &NO_CALLS).expect("a tape")]);
        let code = code.expect("executable memory");
        // One angle of many turns, one of none, one that is infinite.
        let special = [1e5, 0.0, f64::INFINITY];
        let angles: Vec<f64> =
            (0..count).map(|k| special.get(k as usize).copied().unwrap_or(1.7 * f64::from(k))).collect();
        let mut found = vec![0.0; 4 * count as usize];
        code.run(0, &angles, &mut found, &mut vec![0.0; code.workspace()]);
        for (angle, found) in angles.iter().zip(found.chunks_exact(4)) {
            let (sine, cosine) = Scalar::sin_cos(*angle);
            let (second_sine, second_cosine) = Scalar::sin_cos(sine + cosine);
            for (found, expected) in found.iter().zip([sine, cosine, second_sine, second_cosine]) {
                assert!(
                    found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(),
                    "{count} angles"
                );
            }
        }
    }
}

#[test]
fn four_angles_take_the_products_of_one() {
    let Some(target) = target(Lanes::One) else { return };
    let products = |count| {
        let (instructions, _) = placed(&sines(count), target).expect("a tape");
        let is_product =
            |instruction| matches!(instruction, Instruction::Binary { operation: Binary::Multiply, .. });
        instructions.iter().filter(|wide| is_product(wide.instruction)).count()
    };
    assert!(products(1) > 30);
    assert_eq!([products(2), products(4), products(5)], [products(1), products(1), 2 * products(1)]);
}
