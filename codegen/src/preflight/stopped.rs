//! Whether a mechanism starts between its stops. In: its start, closed. Out: diagnostics. Never judges what the file gives: that is done
//! where it is read.

use crate::derive::number_among;
use crate::diagnostic::{Code, Diagnostic};
use crate::model::Stop;

use super::case::Case;
use super::samples::Position;

/// How far beyond a stop loops may leave a joint that starts at it [rad, m].
const CLOSED: f64 = 1e-8;

/// Joints that start beyond a stop: where loops put them, or at zero, where nothing is given.
pub fn starts_beyond(case: &Case<'_>, start: &Position) -> Vec<Diagnostic> {
    let mechanism = case.mechanism;
    if mechanism.stops.is_empty() {
        return Vec::new();
    }
    let sizes = case.system.sizes();
    let channels = case.observe(&start.q, &vec![0.0; sizes.all_speeds], &vec![0.0; sizes.rows]);
    let values = mechanism.parameter_values();
    let beyond = |stop: &Stop| {
        let joint = mechanism.joint(stop.joint);
        let number = number_among(joint.model.coordinates().len(), stop.coordinate);
        let column = case.channel(&format!("{}.q{number}", joint.name))?;
        let position = channels[column];
        let limits = stop.limits.each_ref().map(|limit| limit.as_ref()?.value_at_time(&values, 0.0));
        let passed = stop.passed(position, limits, CLOSED)?;
        let message = stop.starts_beyond(&joint.name, position, passed);
        Some(Diagnostic::new(Code::BadStop, message).at(stop.span, "stopped here").help(Stop::START_BETWEEN))
    };
    mechanism.stops.iter().filter_map(beyond).collect()
}
