//! Forward dynamics of a compiled mechanism: what it costs, what it says.

use linkwear_codegen::compile::Compiled;
use linkwear_runtime::{Evaluator, State};

pub fn forward_operations(compiled: &Compiled) -> u64 {
    let counts = compiled.operations();
    let forward = counts.iter().find(|count| count.name == "forward_dynamics").expect("it is there");
    forward.operations.total
}

/// Accelerations, multipliers and drives.
pub fn solved(compiled: &Compiled, t: f64, state: &State) -> [Vec<f64>; 3] {
    let system = compiled.interpreter();
    let parameters = compiled.parameters();
    let mut evaluator = Evaluator::new(&system, compiled.description(), &parameters).expect("parameters");
    let forward = evaluator.forward(t, &state.q, &state.v);
    [forward.accelerations, forward.multipliers, forward.drives].map(<[f64]>::to_vec)
}
