//! `examples/bare` gives the bits of a build with std: what its C program prints stands in a file of the example, and here the
//! compiled mechanism answers the same questions. `.ci/run` builds the example and compares the print with the file.

use std::fs;

use linkwear::mechanisms::rssr_rigid;
use linkwear_runtime::{Entry, System};

#[test]
fn code_without_std_gives_the_bits_of_code_with_it() {
    let mechanism = rssr_rigid::Mechanism::default();
    let ask = |entry: Entry, state: &[f64]| {
        let input = [&mechanism.parameters()[..], &[0.0], state].concat();
        let mut answer = vec![0.0; rssr_rigid::SIZES.output(entry)];
        mechanism.evaluate(entry, &input, &mut answer, &mut [0.0; rssr_rigid::SIZES.workspace]);
        answer
    };
    let state = ask(Entry::Start, &[]);
    let bits: Vec<String> =
        ask(Entry::ForwardDynamics, &state).iter().map(|value| format!("{:016x}", value.to_bits())).collect();
    let printed = fs::read_to_string("examples/bare/printed.txt").expect("what the C program prints");
    assert_eq!(printed.lines().collect::<Vec<_>>(), bits);
}
