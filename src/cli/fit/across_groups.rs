//! Units whose name is in several groups. In: groups of readings. Out: readings of all with a name for each unit of each group. Never
//! knows files.
//!
//! A unit is that of its group: specimens are numbered anew in each batch. So the fit of all readings has just the increments of the
//! groups, and both sides of the likelihood ratio are of the same data.

use std::collections::{HashMap, HashSet};

use linkwear_gamma::data::Reading;

use super::read::Group;

/// Readings of all groups.
pub struct Pooled {
    pub readings: Vec<Reading>,
    /// Names that are in several groups, in order of the second appearance.
    pub shared: Vec<String>,
}

/// A unit that goes on in another group.
pub struct GoesOn {
    pub unit: String,
    /// Where it goes on.
    pub group: String,
    pub row: usize,
}

/// Readings of all groups, with units of one name in several of them called `name (group)`.
pub fn pooled(groups: &[Group]) -> Pooled {
    let mut seen: HashMap<&str, usize> = HashMap::new();
    let (mut shared, mut is_shared) = (Vec::<String>::new(), HashSet::new());
    for (at, group) in groups.iter().enumerate() {
        for reading in &group.readings {
            let first = *seen.entry(&reading.unit).or_insert(at);
            if first != at && is_shared.insert(reading.unit.as_str()) {
                shared.push(reading.unit.clone());
            }
        }
    }
    let mut readings = Vec::new();
    for group in groups {
        for reading in &group.readings {
            let mut reading = reading.clone();
            if is_shared.contains(reading.unit.as_str()) {
                reading.unit = format!("{} ({})", reading.unit, group.name);
                // Another unit may be called so.
                while seen.contains_key(reading.unit.as_str()) {
                    reading.unit.push('\'');
                }
            }
            readings.push(reading);
        }
    }
    Pooled { readings, shared }
}

/// The first unit that seems to go on in another group: its readings there begin after those before, or with the last of them again.
pub fn goes_on(groups: &[Group]) -> Option<GoesOn> {
    let mut last: HashMap<&str, (f64, f64)> = HashMap::new();
    for group in groups {
        let mut of_group: HashMap<&str, (f64, f64)> = HashMap::new();
        for reading in &group.readings {
            let now = (reading.exposure, reading.wear);
            let before =
                last.get(reading.unit.as_str()).filter(|_| !of_group.contains_key(reading.unit.as_str()));
            if before.is_some_and(|before| before.0 < now.0 || *before == now) {
                let (unit, group, row) = (reading.unit.clone(), group.name.clone(), reading.row);
                return Some(GoesOn { unit, group, row });
            }
            of_group.insert(&reading.unit, now);
        }
        last.extend(of_group);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(name: &str, rows: &[(&str, f64, f64)]) -> Group {
        let reading = |&(unit, exposure, wear): &(&str, f64, f64)| Reading {
            unit: unit.to_owned(),
            exposure,
            wear,
            ..Reading::default()
        };
        Group { name: name.to_owned(), readings: rows.iter().map(reading).collect() }
    }

    #[test]
    fn units_of_one_name_are_told_apart_by_their_groups() {
        let groups = [
            group("A", &[("1", 0.0, 0.0), ("1", 5.0, 2.0), ("own", 1.0, 1.0), ("1 (B)", 1.0, 1.0)]),
            group("B", &[("1", 0.0, 0.0), ("1", 5.0, 2.0)]),
        ];
        let Pooled { readings, shared } = pooled(&groups);
        let names: Vec<&str> = readings.iter().map(|reading| reading.unit.as_str()).collect();
        assert_eq!(names, ["1 (A)", "1 (A)", "own", "1 (B)", "1 (B)'", "1 (B)'"]);
        assert_eq!(shared, ["1"]);
    }

    #[test]
    fn a_unit_goes_on_whose_readings_begin_after_those_before() {
        let first = [("1", 1.0, 1.0), ("1", 5.0, 2.0)];
        let second =
            |exposure, wear| [group("A", &first), group("B", &[("1", exposure, wear), ("1", 9.0, 9.0)])];
        let is_on = |exposure, wear| goes_on(&second(exposure, wear)).is_some();
        assert!(is_on(6.0, 1.0) && is_on(5.0, 2.0));
        // Another specimen, looked at when the first was.
        assert!(!is_on(1.0, 3.0) && !is_on(5.0, 1.9));
    }
}
