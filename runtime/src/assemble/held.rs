//! Start values that the file demands: what they freeze, and how a message tells them.

use crate::description::VariableInfo;
use crate::evaluate::Evaluator;
use crate::tables::Motion;

/// A variable with both of its values, for a message: rounded to a millionth.
fn wanted_and_reached(variable: &VariableInfo, wanted: f64, reached: f64) -> String {
    // Adding 0 turns -0 into 0.
    let rounded = |value: f64| (value * 1e6).round() / 1e6 + 0.0;
    format!("`{}` ({} {}, reachable {})", variable.name, rounded(wanted), variable.unit, rounded(reached))
}

/// Held variables that are elsewhere when nothing is held, by more than what `slack` says of the wanted value.
pub(super) fn conflicts(
    variables: &[VariableInfo],
    wanted: &[f64],
    reached: &[f64],
    slack: impl Fn(f64) -> f64,
) -> Vec<String> {
    let values = wanted.iter().zip(reached).map(|(wanted, reached)| (*wanted, *reached));
    let moved = variables
        .iter()
        .zip(values)
        .filter(|(variable, (wanted, reached))| variable.held && (wanted - reached).abs() > slack(*wanted));
    moved.map(|(variable, (wanted, reached))| wanted_and_reached(variable, wanted, reached)).collect()
}

/// Free speeds that move a held coordinate.
pub(super) fn frozen_speeds(evaluator: &Evaluator<'_>) -> Vec<bool> {
    let held: Vec<bool> = evaluator.description().coordinates.iter().map(|c| c.held).collect();
    let (mut fixed, rows) = frozen(evaluator, &held);
    rows.iter().for_each(|(_, speed, axis)| fixed[speed + 3 + axis] = true);
    fixed
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
