//! Start values that the file demands: what they freeze, and how a message tells them.

use crate::description::{Motion, VariableInfo};
use crate::evaluate::Evaluator;

/// A variable with both of its values, for a message: rounded to a millionth.
pub(super) fn wanted_and_reached(variable: &VariableInfo, wanted: f64, reached: f64) -> String {
    // Adding 0 turns -0 into 0.
    let rounded = |value: f64| (value * 1e6).round() / 1e6 + 0.0;
    format!("`{}` ({} {}, reachable {})", variable.name, rounded(wanted), variable.unit, rounded(reached))
}

/// Columns of the Jacobian that held coordinates freeze, and for held positions of poses (in W) the rows
/// that do so: (index of the coordinate, first speed of the group, component).
pub(super) fn frozen(evaluator: &Evaluator<'_>, held: &[bool]) -> (Vec<bool>, Vec<(usize, usize, usize)>) {
    let mut columns = vec![false; evaluator.layout().speeds];
    let mut rows = Vec::new();
    for group in evaluator.layout().free() {
        let at = group.coordinate;
        match group.motion {
            Motion::Scalar { .. } => columns[group.speed] = held[at],
            Motion::Rotation | Motion::Pose => {
                if held[at..at + 4].contains(&true) {
                    columns[group.speed..group.speed + 3].fill(true);
                }
            }
        }
        if group.motion == Motion::Pose {
            rows.extend((0..3).filter(|i| held[at + 4 + i]).map(|i| (at, group.speed, i)));
        }
    }
    (columns, rows)
}
