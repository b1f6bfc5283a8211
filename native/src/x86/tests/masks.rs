//! More comparisons than there are mask registers, read again when others have taken their place.

use linkwear_tape::{Op, Operand, Tape, Unary};

use super::random::functions;
use crate::memory::code::Code;
use crate::straight::tests::random_tape::{Random, evaluated, of_statements, statement};
use crate::straight::write::write;
use crate::x86::features::can_run;
use crate::x86::instruction::{Lanes, Target};

const INPUTS: u32 = 20;

/// Of every input's sign a choice, then one more; with a call between them if `calls`.
fn choices(calls: bool) -> Tape {
    let input = |at: u32| Operand::Input(at % INPUTS);
    let mut ops: Vec<Op> =
        (0..INPUTS).map(|at| Op::Select(input(at), input(at + 3), input(at + 7))).collect();
    if calls {
        ops.push(Op::Unary(Unary::Exp, input(1)));
    }
    let first = |at: u32| Operand::Value(at % INPUTS);
    ops.extend((0..INPUTS).map(|at| Op::Select(input(at), first(at + 2), first(at + 5))));
    let count = ops.len();
    let statements = (0..).zip(ops).map(|(value, op)| statement(op, value, &[value])).collect();
    of_statements([INPUTS as usize, count], Vec::new(), statements)
}

#[test]
fn comparisons_outlive_their_mask_registers() {
    for (lanes, calls) in
        [Lanes::One, Lanes::Four, Lanes::Eight].into_iter().flat_map(|lanes| [(lanes, false), (lanes, true)])
    {
        let target = Target { lanes, registers: 32, columns: false };
        if !can_run(target) {
            continue;
        }
        let tape = choices(calls);
        let written = write(&tape, target, &functions(lanes)).expect("a tape");
        let code = Code::new(vec![written]).expect("executable memory");
        let mut random = Random(7);
        for _ in 0..50 {
            let count = lanes.count();
            let input: Vec<f64> = (0..INPUTS as usize * count).map(|_| random.unit() - 0.5).collect();
            let mut output = vec![0.0; tape.output_len() * count];
            code.run(0, &input, &mut output, &mut vec![0.0; code.workspace()]);
            for lane in 0..count {
                let of =
                    |numbers: &[f64]| numbers.iter().skip(lane).step_by(count).copied().collect::<Vec<f64>>();
                assert_eq!(of(&output), evaluated(&tape, &of(&input)), "{target:?}");
            }
        }
    }
}
