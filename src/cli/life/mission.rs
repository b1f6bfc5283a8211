//! What `life` says of a mission. In: a life. Out: a table of its segments. Never knows how they were lived.

use std::fmt::Write as _;

use crate::life::{LifeResult, SegmentResult};
use crate::number::{decimals, number};

use super::super::table::table;
use super::hours::hours;

/// The segments with their shares; nothing without a mission.
pub fn mission_text(life: &LifeResult) -> String {
    let Some(mission) = &life.mission else { return String::new() };
    let names = life.names();
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let mut head: Vec<String> =
        vec![format!("mission {}", mission.name), "time".to_owned(), "revolutions".to_owned()];
    head.extend(names.iter().map(|name| format!("wear of {name}")));
    head.extend(["alone [cycles]", "alone [hours]"].map(str::to_owned));
    let row = |segment: &SegmentResult| {
        let alone = |of: &dyn Fn(f64, f64) -> Option<String>| {
            let found = segment.alone.and_then(|alone| {
                of(alone.cycles, alone.cycles * life.joints[alone.joint].revolutions_per_cycle)
            });
            found.unwrap_or_else(|| "?".to_owned())
        };
        let mut row = vec![segment.name.clone(), percent(segment.time), percent(segment.revolutions)];
        row.extend(segment.wear.iter().map(|share| percent(*share)));
        row.push(alone(&|cycles, _| Some(decimals(cycles, 3))));
        row.push(alone(&|_, revolutions| Some(hours(revolutions * segment.seconds_per_revolution?))));
        row
    };
    let rows: Vec<Vec<String>> = mission.segments.iter().map(row).collect();
    let mut text = format!("\n{}", table(&head, &rows));
    if let (Some(missions), Some(seconds)) = (life.missions(), mission.seconds) {
        let _ = writeln!(
            text,
            "\nthe mean path has {} missions of {} hours; the order within one changes it by less than a mission",
            number(missions),
            hours(seconds)
        );
    }
    if let Some(error) = mission.binning {
        let _ = writeln!(
            text,
            "\nin half as many bins the mean path's life is another by {:.2} %",
            100.0 * error
        );
    }
    text
}
