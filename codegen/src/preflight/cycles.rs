//! Joints of one machine whose cycles stand for different numbers of revolutions. In: a mechanism. Out: a warning. Never knows how
//! fast they wear.

use crate::diagnostic::{Code, Diagnostic};
use crate::model::Mechanism;
use crate::source::Span;

use super::plausible::shown;

/// The remark, if they differ.
pub(super) fn remark(mechanism: &Mechanism) -> Option<Diagnostic> {
    let joints = mechanism.joints.iter().filter_map(|joint| {
        let clearance = joint.clearance.as_ref()?;
        let wear = clearance.laws.wear.as_ref()?;
        Some((&*joint.name, wear.revolutions_per_cycle, clearance.places.cycle))
    });
    let joints: Vec<(&str, f64, Span)> = joints.collect();
    let by_length = |a: &&(&str, f64, Span), b: &&(&str, f64, Span)| a.1.total_cmp(&b.1);
    let (least, most) = (joints.iter().min_by(by_length)?, joints.iter().max_by(by_length)?);
    (least.1 < most.1).then(|| {
        let [many, few] = [most.1, least.1].map(shown);
        let message = format!(
            "while `{}` wears by {many} revolutions, `{}` wears by {few}: a cycle stands for another number of them",
            most.0, least.0
        );
        Diagnostic::new(Code::UnequalCycles, message)
            .at_each([most.2], &format!("for {many}"))
            .at_each([least.2], &format!("for {few}"))
            .help("joints of one machine turn in one time: write the same `revolutions_per_cycle` into every table [wear], where 1 is the default")
    })
}
