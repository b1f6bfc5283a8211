//! What `check` says of missions: their segments as they were read. In: a description. Out: tables, entries for machines.

use std::fmt::Write as _;

use linkwear_runtime::{Description, MissionInfo, SegmentInfo};
use serde_json::{Map, Value};

use super::super::answer::check::{MissionAnswer, SegmentAnswer};
use super::super::table::table;
use crate::number::number;

/// For machines.
pub fn answers(description: &Description) -> Vec<MissionAnswer<'_>> {
    let missions = description.missions.iter().map(|mission| {
        let segments = mission.segments.iter().map(|segment| answer(description, mission, segment));
        MissionAnswer { name: &mission.name, segments: segments.collect() }
    });
    missions.collect()
}

fn answer<'a>(
    description: &Description,
    mission: &MissionInfo,
    segment: &'a SegmentInfo,
) -> SegmentAnswer<'a> {
    let by_joint = |of: fn(&(f64, f64)) -> f64| -> Map<String, Value> {
        let joints = description.contacts.iter().zip(&segment.factors);
        joints.map(|(contact, factors)| (contact.joint.to_string(), of(factors).into())).collect()
    };
    let set = segment.values.iter().filter_map(|(place, value)| {
        Some((description.parameters.get(*place)?.name.to_string(), (*value).into()))
    });
    SegmentAnswer {
        name: &segment.name,
        share: (!mission.ordered).then_some(segment.amount),
        duration: mission.ordered.then_some(segment.amount),
        set: set.collect(),
        friction: by_joint(|factors| factors.0),
        wear: by_joint(|factors| factors.1),
    }
}

/// A table for each mission.
pub fn text(description: &Description) -> String {
    let mut text = String::new();
    for mission in description.missions.iter() {
        let rows = mission.segments.iter().map(|segment| {
            let amount = match mission.ordered {
                true => format!("{} s", number(segment.amount)),
                false => format!("{:.1} %", 100.0 * segment.amount),
            };
            vec![segment.name.to_string(), amount, differences(description, segment)]
        });
        let amount = if mission.ordered { "duration" } else { "time" };
        let name = format!("Mission {}", mission.name);
        let _ = write!(text, "\n{}", table(&[&name, amount, ""], &rows.collect::<Vec<_>>()));
    }
    text
}

/// What is other than in the mechanism.
fn differences(description: &Description, segment: &SegmentInfo) -> String {
    let set = segment.values.iter().filter_map(|(place, value)| {
        let known = description.parameters.get(*place)?;
        Some(format!("{} = {} {}", known.name, number(*value), known.unit))
    });
    let joints = description.contacts.iter().zip(&segment.factors);
    let factors = joints.flat_map(|(contact, (friction, wear))| {
        [("friction", *friction), ("wear", *wear)]
            .into_iter()
            .filter(|(_, factor)| *factor != 1.0)
            .map(|(what, factor)| format!("{what} of {} times {}", contact.joint, number(factor)))
    });
    set.chain(factors).collect::<Vec<_>>().join(", ")
}
