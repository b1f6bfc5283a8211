//! The larger and the smaller of two numbers: one instruction each, with the bits of a comparison and a selection.

use super::random::functions;
use crate::memory::code::Code;
use crate::straight::tests::calls::same_nan;
use crate::straight::tests::extremes::{NUMBERS, extremes, written_down};
use crate::straight::write::{Named, placed, write};
use crate::x86::features::can_run;
use crate::x86::instruction::{Binary, Instruction, Lanes, Target};

fn named() -> Named<'static> {
    Named { name: "extremes", operations: Ok(written_down()) }
}

#[test]
fn extremes_have_the_bits_of_selections() {
    for (lanes, registers) in
        [Lanes::One, Lanes::Four, Lanes::Eight].into_iter().flat_map(|lanes| [(lanes, 16), (lanes, 32)])
    {
        let target = Target { lanes, registers, columns: false };
        if !can_run(target) {
            continue;
        }
        let written = write(named(), target, &functions(lanes)).expect("a function");
        let code = Code::new(vec![written]).expect("executable memory");
        let count = lanes.count();
        let pairs = NUMBERS.iter().flat_map(|a| NUMBERS.map(|b| [*a, b]));
        for (at, [a, b]) in pairs.enumerate() {
            // The other lanes have other numbers.
            let mut input = vec![0.25; 2 * count];
            let lane = at % count;
            (input[lane], input[count + lane]) = (a, b);
            let wanted = extremes([a, b]);
            let mut output = vec![0.0; wanted.len() * count];
            code.run(0, &input, &mut output, &mut vec![0.0; code.workspace()]);
            for (which, (found, wanted)) in output.iter().skip(lane).step_by(count).zip(&wanted).enumerate() {
                let [found, wanted] = [found, wanted].map(|number| same_nan(number.to_bits()));
                assert_eq!(found, wanted, "{which} of {a} and {b}, {target:?}");
            }
        }
    }
}

#[test]
fn one_instruction_is_an_extreme() {
    let target = Target { lanes: Lanes::Four, registers: 16, columns: false };
    let (instructions, _) = placed(named(), target).expect("a function");
    let count = |wanted: &[Binary]| {
        let is_wanted = |instruction: &Instruction| matches!(instruction, Instruction::Binary { operation, .. } if wanted.contains(operation));
        instructions.iter().filter(|wide| is_wanted(&wide.instruction)).count()
    };
    assert_eq!(count(&[Binary::Larger, Binary::Smaller]), 7);
    assert_eq!(count(&[Binary::Less]), 1, "what another selection reads");
}
