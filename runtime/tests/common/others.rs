//! Entries that are made of others, for hand-written mechanisms.

use linkwear_runtime::{Entry, System};

/// Accelerations alone, or the whole derivative, by forward dynamics and rates.
pub fn by_others(system: &dyn System<f64>, entry: Entry, input: &[f64], output: &mut [f64]) {
    let sizes = system.sizes();
    let mut forward = vec![0.0; sizes.output(Entry::ForwardDynamics)];
    let state = &input[..sizes.input(Entry::Energy)];
    system.evaluate(
        Entry::ForwardDynamics,
        &input[..sizes.input(Entry::ForwardDynamics)],
        &mut forward,
        &mut [],
    );
    let (accelerations, forces) = forward.split_at(sizes.speeds);
    let drives = &forces[sizes.rows..][..sizes.drivers];
    if entry == Entry::Accelerations {
        let pivots = &forces[sizes.rows + sizes.drivers..];
        output.copy_from_slice(&[accelerations, pivots].concat());
        return;
    }
    let mut rates = vec![0.0; sizes.output(Entry::Rates)];
    system.evaluate(Entry::Rates, &[state, drives].concat(), &mut rates, &mut []);
    let (coordinates, powers) = rates.split_at(sizes.coordinates);
    output.copy_from_slice(&[coordinates, &forward, powers].concat());
}
