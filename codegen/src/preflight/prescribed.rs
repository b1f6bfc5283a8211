//! Whether drivers start with a finite speed and acceleration. In: the mechanism with its drivers, run by the
//! interpreter. Out: diagnostics. Never knows positions; that the laws themselves are finite is known before.

use linkwear_runtime::{Description, Entry, System};

use crate::diagnostic::Diagnostics;
use crate::model::Mechanism;
use crate::source::SourceFile;

use super::failures;
use super::samples::evaluate;

/// Position, speed and acceleration that every driver prescribes at a time [rad or m, s].
pub(super) fn laws_at(t: f64, description: &Description, system: &dyn System<f64>) -> Vec<[f64; 3]> {
    let defaults = description.parameters.iter().map(|parameter| parameter.default);
    let input: Vec<f64> = defaults.chain([t]).collect();
    let mut output = vec![0.0; system.sizes().output(Entry::Prescribed)];
    evaluate(system, Entry::Prescribed, &input, &mut output);
    output.as_chunks().0.to_vec()
}

/// Evaluates the laws of all drivers at t = 0, where every run starts.
///
/// # Errors
/// For every driver whose speed or acceleration there is infinite or not a number, as that of `sqrt(t)`.
pub fn check_prescribed(
    source: &SourceFile,
    mechanism: &Mechanism,
    description: &Description,
    system: &dyn System<f64>,
) -> Result<(), Diagnostics> {
    let errors: Vec<_> = laws_at(0.0, description, system)
        .iter()
        .zip(description.drivers.iter())
        .filter(|(law, _)| law.iter().any(|value| !value.is_finite()))
        .map(|(law, driver)| {
            let what = if law[1].is_finite() { "acceleration" } else { "speed" };
            failures::abrupt_driver(mechanism, &driver.joint, what)
        })
        .collect();
    if errors.is_empty() { Ok(()) } else { Err(Diagnostics::from_list(errors).located(source)) }
}
