//! An entry at many states: every state has the bits that it has alone, however many there are and whatever they share; wrong
//! numbers are refused; derivatives are those of dual numbers.

mod support;

use linkwear::batch::{Batch, BatchError};
use linkwear::codegen::compile::Compiled;
use linkwear_runtime::{Entry, System};
use support::compiled;
use support::random::Random;

/// Enough for several rounds of eight lanes, and a rest.
const STATES: usize = 21;

/// A column for each quantity; the first of them one value for all states.
fn columns(batch: &Batch, compiled: &Compiled, entry: Entry, random: &mut Random) -> Vec<Vec<f64>> {
    let parameters = compiled.parameters();
    let of = |at: usize, random: &mut Random| match parameters.get(at) {
        Some(value) => vec![*value],
        None => (0..STATES).map(|_| 2.0 * random.next()).collect(),
    };
    (0..batch.sizes().input(entry)).map(|at| of(at, random)).collect()
}

#[test]
fn every_state_has_the_bits_that_it_has_alone() {
    for name in ["rssr", "rssr_flexible", "four_bar_wear", "pendulum"] {
        let compiled = compiled(name, &[], None);
        let batch = Batch::new(&compiled);
        let alone = compiled.interpreter();
        let sizes = System::<f64>::sizes(&alone);
        let mut random = Random(0x5DEE_CE66_D123_4567);
        for entry in Entry::ALL {
            let inputs = columns(&batch, &compiled, entry, &mut random);
            let named: usize = batch.inputs(entry).iter().map(|group| group.names.len()).sum();
            assert_eq!(named, inputs.len(), "names of the inputs of {} of {name}", entry.name());
            let gives = batch.sizes().output(entry);
            let named: usize = batch.outputs(entry).iter().map(|group| group.names.len()).sum();
            assert_eq!(named, gives, "names of the answers of {} of {name}", entry.name());
            for states in [1, 3, 8, STATES] {
                let given: Vec<&[f64]> =
                    inputs.iter().map(|column| &column[..states.min(column.len())]).collect();
                let mut answers = vec![f64::NAN; gives * states];
                batch.evaluate(entry, &given, states, &mut answers).expect("numbers that fit");
                for state in 0..states {
                    let input: Vec<f64> =
                        given.iter().map(|column| column[state.min(column.len() - 1)]).collect();
                    let mut expected = vec![0.0; gives];
                    alone.evaluate(entry, &input, &mut expected, &mut vec![0.0; sizes.workspace]);
                    let found = answers.iter().skip(state).step_by(states.max(1));
                    let same = found.zip(&expected).all(|(a, b)| a.to_bits() == b.to_bits());
                    assert!(same, "state {state} of {states}, {} of {name}", entry.name());
                }
            }
        }
    }
}

#[test]
fn wrong_numbers_are_refused() {
    let batch = Batch::new(&compiled("pendulum", &[], None));
    let entry = Entry::Energy;
    let column = [0.1; 5];
    let count = batch.sizes().input(entry);
    let mut answers = vec![0.0; 5 * batch.sizes().output(entry)];
    let inputs = vec![&column[..]; count];
    assert_eq!(batch.evaluate(entry, &inputs, 5, &mut answers), Ok(()));
    let few = batch.evaluate(entry, &inputs[1..], 5, &mut answers);
    assert_eq!(few, Err(BatchError::Quantities { entry: "energy", expected: count, found: count - 1 }));
    let short = batch.evaluate(entry, &inputs, 6, &mut answers);
    assert_eq!(short, Err(BatchError::States { quantity: 0, states: 6, found: 5 }));
    let no_room = batch.evaluate(entry, &inputs, 5, &mut answers[1..]);
    assert!(matches!(no_room, Err(BatchError::Room { .. })));
    assert_eq!(batch.evaluate(entry, &vec![&[][..]; count], 0, &mut []), Ok(()));
}

#[test]
fn derivatives_are_those_of_small_steps() {
    let compiled = compiled("pendulum", &[], None);
    let batch = Batch::new(&compiled);
    let entry = Entry::Energy;
    let mut state: Vec<f64> = compiled.parameters();
    let first = state.len();
    state.extend([0.0, 0.4, 1.5]);
    let by: Vec<usize> = (first + 1..state.len()).collect();
    let slopes = batch.derivatives(entry, &state, &by).expect("numbers that fit");
    let at = |state: &[f64]| {
        let columns: Vec<&[f64]> = state.iter().map(std::slice::from_ref).collect();
        let mut answers = vec![0.0; batch.sizes().output(entry)];
        batch.evaluate(entry, &columns, 1, &mut answers).expect("numbers that fit");
        answers
    };
    for (slope, by) in slopes.iter().zip(by) {
        // Central differences of smooth functions of size 1: the error is 1e-10 by curvature and by rounding.
        let step = 1e-5;
        let [ahead, behind] = [step, -step].map(|step| {
            let mut state = state.clone();
            state[by] += step;
            at(&state)
        });
        for ((slope, ahead), behind) in slope.iter().zip(ahead).zip(behind) {
            assert!((slope - (ahead - behind) / (2.0 * step)).abs() < 1e-8, "{slope} by {by}");
        }
    }
    assert!(batch.derivatives(entry, &state[1..], &[0]).is_err());
}
