//! Whether the mechanism as it runs can be put together with its clearances open. In: the mechanism with its drivers, run
//! by the interpreter. Out: diagnostics. Never knows how journals find their places.

use linkwear_runtime::{Description, Evaluator, State, System, assemble_static_contact};

use crate::diagnostic::Diagnostics;
use crate::model::Mechanism;
use crate::source::SourceFile;

use super::failures;

/// Where a mechanism with clearance starts, assembled as every run does it, with what its contacts remember; without
/// clearance there is nothing to find.
///
/// # Errors
/// If a run could not start.
pub fn check_start<'a>(
    source: &SourceFile,
    mechanism: &Mechanism,
    description: &'a Description,
    system: &'a dyn System<f64>,
) -> Result<Option<(Evaluator<'a>, State)>, Diagnostics> {
    if description.contacts.is_empty() {
        return Ok(None);
    }
    assembled(source, mechanism, description, system).map(Some)
}

/// Where a mechanism starts, assembled as every run does it.
///
/// # Errors
/// If a run could not start.
pub fn assembled<'a>(
    source: &SourceFile,
    mechanism: &Mechanism,
    description: &'a Description,
    system: &'a dyn System<f64>,
) -> Result<(Evaluator<'a>, State), Diagnostics> {
    let parameters: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    let start =
        Evaluator::new(system, description, &parameters).map_err(Into::into).and_then(|mut evaluator| {
            assemble_static_contact(&mut evaluator, 0.0).map(|state| (evaluator, state))
        });
    let refused =
        |error| Diagnostics::from_list(vec![failures::cannot_close(mechanism, &error)]).located(source);
    start.map_err(refused)
}
