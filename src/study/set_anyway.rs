//! What varies and a mission sets anyway. In: how lives are used, points. Out: what is doubtful about it. Never runs anything.

use super::points::Points;
use crate::life::LifeStudy;

/// A warning for everything that varies to which every segment of the mission gives a value of its own: values of a mission count
/// after those of a point, so that lives do not tell the points apart by it.
pub(super) fn set_anyway(life: &LifeStudy<'_>, points: &Points) -> Vec<String> {
    // A mission that cannot be chosen is told by the life itself.
    let Ok(Some(mission)) = life.chosen_mission() else { return Vec::new() };
    let parameters = &life.mechanism.description.parameters;
    let is_set = |name: &str| {
        let place = parameters.iter().position(|known| known.name == *name);
        place.is_some_and(|place| {
            mission.segments.iter().all(|segment| segment.values.iter().any(|(at, _)| *at == place))
        })
    };
    let set = points.axes().iter().map(|axis| &axis.name).filter(|name| is_set(name));
    let told = |name| {
        format!(
            "every segment of mission `{}` sets `{name}`: its lives do not depend on the value of the point; vary something else, or \
             live without the mission",
            mission.name
        )
    };
    set.map(told).collect()
}
