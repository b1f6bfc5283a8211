//! Whether drivers start with a finite speed and acceleration. In: the mechanism with its drivers, run by the
//! interpreter. Out: diagnostics. Never knows positions; that the laws themselves are finite is known before.

use linkwear_runtime::{Description, Entry, System};

use crate::diagnostic::Diagnostics;
use crate::model::Mechanism;
use crate::source::SourceFile;

use super::failures;
use super::samples::evaluate;

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
    let mut input: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    input.push(0.0);
    let mut output = vec![0.0; system.sizes().output(Entry::Prescribed)];
    evaluate(system, Entry::Prescribed, &input, &mut output);
    let errors: Vec<_> = output
        .chunks_exact(3)
        .zip(description.drivers.iter())
        .filter(|(law, _)| law.iter().any(|value| !value.is_finite()))
        .map(|(law, driver)| {
            let what = if law[1].is_finite() { "acceleration" } else { "speed" };
            failures::abrupt_driver(mechanism, &driver.joint, what)
        })
        .collect();
    if errors.is_empty() { Ok(()) } else { Err(Diagnostics::from_list(errors).located(source)) }
}
