//! What varies and a mission sets anyway. In: how lives are used, points. Out: what is doubtful about it. Never runs anything.

use super::points::Points;
use crate::life::LifeStudy;

/// A warning for everything that varies to which every segment of the mission gives a value of its own: values of a mission count
/// after those of a point, so that lives do not tell the points apart by it.
pub(super) fn set_anyway(life: &LifeStudy<'_>, points: &Points) -> Vec<String> {
    let axes = points.axes().iter().map(|axis| &axis.name);
    let told = |name: &String| {
        let mission = life.set_throughout(name)?;
        Some(format!(
            "every segment of mission `{mission}` sets `{name}`: its lives do not depend on the value of the point; vary something else, \
             or live without the mission"
        ))
    };
    axes.filter_map(told).collect()
}
