//! Measurements from CSV files. In: paths, names of columns. Out: curves and inspections in SI; or what is wrong, where. Never knows
//! what is sought.

use std::path::Path;

use linkwear_codegen::diagnostic::nearest;
use linkwear_codegen::spec::{Dimension, UnitSize, as_written, unit_size};
use linkwear_runtime::{Channel, Description, Integrator, Span, channels};

use super::arguments::IdentifyArguments;
use crate::cli::failure::Failure;
use crate::csv_table::{CsvError, CsvTable};
use crate::identify::{Curve, CurveColumn, Inspections};
use crate::inputs::parts;

/// The measured curve in SI, with the SHA-256 of its file.
pub fn curve(
    arguments: &IdentifyArguments,
    description: &Description,
    integrator: Integrator,
) -> Result<Option<(Curve, String)>, Failure> {
    let Some(file) = &arguments.measured else { return Ok(None) };
    let table = CsvTable::read(file)?;
    let channels = channels(description);
    let header = table.header().to_vec();
    let mut times = None;
    let mut columns: Vec<CurveColumn> = Vec::new();
    for (place, title) in header.iter().enumerate() {
        let (name, _) = parts(title);
        if matches!(name, "t" | "time") {
            if times.replace(in_si(&table, place, "s")?).is_some() {
                return Err(twice(&table, "the time"));
            }
            continue;
        }
        if !arguments.of.is_empty() && !arguments.of.iter().any(|of| of.trim() == name) {
            continue;
        }
        let channel = known(&table, &channels, name)?;
        if columns.iter().any(|column| column.name == name) {
            return Err(twice(&table, name));
        }
        let values = in_si(&table, place, &channel.unit)?;
        columns.push(CurveColumn { name: name.to_owned(), values, noise: None });
    }
    for name in arguments.of.iter().map(|name| name.trim()) {
        if !columns.iter().any(|column| column.name == name) {
            let message = format!("--of: the curve has no column `{name}`");
            return Err(fault(&table, message, &there_are(&header, name)));
        }
    }
    let Some(times) = times else {
        return Err(fault(&table, "no column gives the time".to_owned(), "begin the header with `t [s]`"));
    };
    if columns.is_empty() {
        let help = "add a column that `simulate --out` has too, as `R1.drive [N m]`";
        return Err(fault(&table, "nothing but the time was measured".to_owned(), help));
    }
    for (name, level) in &arguments.noise {
        let Some(column) = columns.iter_mut().find(|column| column.name == *name) else {
            let message = format!("--noise: no column `{name}` is compared");
            let names: Vec<String> = columns.iter().map(|column| column.name.clone()).collect();
            return Err(Failure::usage(message, there_are(&names, name)));
        };
        let unit = channels.iter().find(|channel| channel.name == *name).map_or("1", |one| &*one.unit);
        column.noise = Some(level_in_si("--noise", level, unit)?);
    }
    rising(&table, &times, "times")?;
    if times.first().is_some_and(|first| *first < 0.0) {
        let help = "count the time from where the run begins, or give the turns before it by --settle";
        return Err(Failure::data(file, table.lines().next(), "the first time is negative", help));
    }
    let settle = arguments.settle.map_or(Span::Time(0.0), Span::Turns);
    if settle != Span::Time(0.0) && description.turn_driver.is_none() {
        let message = "--settle: this mechanism has no driven revolute joint to count turns of";
        return Err(Failure::usage(message, "leave it out: the run begins at the time 0 of the curve"));
    }
    Ok(Some((Curve { times, columns, settle, integrator }, table.sha256().to_owned())))
}

/// Inspections in SI, with the SHA-256 of their files.
pub fn inspections(
    arguments: &IdentifyArguments,
    description: &Description,
) -> Result<Vec<(Inspections, String)>, Failure> {
    let wearing = description.contacts.iter().filter(|contact| contact.wear.is_some());
    let names: Vec<String> = wearing.map(|contact| contact.joint.to_string()).collect();
    let gauge = arguments.gauge.as_deref().map(|gauge| level_in_si("--gauge", gauge, "m")).transpose()?;
    let mut all: Vec<(Inspections, String)> = Vec::new();
    for (joint, file) in &arguments.inspections {
        if !names.contains(joint) {
            let none = ["none: give a joint with clearance a [wear] section".to_owned()];
            let listed = if names.is_empty() { &none[..] } else { &names[..] };
            return Err(Failure::unknown_name("wearing joint", joint, &names, listed));
        }
        if all.iter().any(|(known, _)| known.joint == *joint) {
            let message = format!("--inspections: {joint} is given twice");
            return Err(Failure::usage(message, "write all readings of a joint into one file"));
        }
        let table = CsvTable::read(Path::new(file))?;
        let of = |name: &Option<String>, unit: &str| {
            let name = name.as_deref().unwrap_or_default();
            let titles = table.header().iter().enumerate();
            let mut found = titles.filter(|(_, title)| *title == name || parts(title).0 == name);
            match (found.next(), found.next()) {
                (Some((place, _)), None) => in_si(&table, place, unit),
                (Some(_), Some(_)) => Err(twice(&table, name)),
                _ => {
                    let message = format!("there is no column `{name}`");
                    Err(fault(&table, message, &there_are(table.header(), name)))
                }
            }
        };
        let by_time = arguments.time.is_some();
        let at = if by_time { of(&arguments.time, "s")? } else { of(&arguments.revolutions, "1")? };
        let wear = of(&arguments.wear, "m")?;
        rising(&table, &at, "inspections")?;
        if let Some((line, _)) = table.lines().zip(&at).find(|(_, at)| **at < 0.0) {
            let help = "count from the new joint on";
            return Err(Failure::data(
                Path::new(file),
                Some(line),
                "an inspection before the joint was new",
                help,
            ));
        }
        if !wear.iter().any(|wear| *wear > 0.0) {
            let help = "inspections of a joint that has not worn tell nothing of its wear";
            return Err(Failure::data(Path::new(file), None, "no reading of wear is positive", help));
        }
        let one = Inspections { joint: joint.clone(), at, by_time, wear, gauge };
        all.push((one, table.sha256().to_owned()));
    }
    Ok(all)
}

/// Numbers of a unit in an SI unit; nothing if it is of another kind. The machine's speed is one, whether a gauge counts turns
/// of it or radians.
fn in_terms_of(si: &str, unit: UnitSize) -> Option<impl Fn(f64) -> f64> {
    let own = unit_size(si).unwrap_or(UnitSize::ONE);
    let turns = unit.turning.in_terms_of(own.turning);
    (unit.dimension == own.dimension).then_some(move |number| unit.to_si(number) * turns)
}

/// A column in SI; its unit stands in its title, or it has none where there is none. Degrees and radians are of the dimension of a pure
/// number: only the file knows which of them it has.
fn in_si(table: &CsvTable<'_>, place: usize, si: &str) -> Result<Vec<f64>, Failure> {
    let title = table.header().get(place).cloned().unwrap_or_default();
    let (name, unit) = parts(&title);
    let needed = unit_size(si).map_or(Dimension::NONE, |own| own.dimension);
    let unit = match unit {
        Some(unit) => unit,
        None if si == "1" => "1",
        None => {
            let or = if needed == Dimension::NONE { ", or that in which it was measured" } else { "" };
            let help = format!("write its unit into the header: `{name} [{si}]`{or}");
            return Err(fault(table, format!("column `{title}` has no unit"), &help));
        }
    };
    let Some(own) = unit_size(unit).and_then(|unit| in_terms_of(si, unit)) else {
        let help = format!("a unit of the same kind as {si} is needed");
        return Err(fault(table, format!("column `{title}`: `{unit}` is no unit of `{name}`"), &help));
    };
    Ok(table.numbers_at(place)?.into_iter().map(own).collect())
}

/// The channel of a column's name.
fn known<'c>(table: &CsvTable<'_>, channels: &'c [Channel], name: &str) -> Result<&'c Channel, Failure> {
    channels.iter().find(|channel| channel.name == *name).ok_or_else(|| {
        let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
        let help = format!("{}; --of names the columns that are compared", there_are(&names, name));
        fault(table, format!("a run has no column `{name}`"), &help)
    })
}

fn there_are(names: &[String], name: &str) -> String {
    match nearest(name, names.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there are: {}", linkwear_codegen::diagnostic::cut(&names.join(", "), 300)),
    }
}

fn rising(table: &CsvTable<'_>, at: &[f64], what: &str) -> Result<(), Failure> {
    let lines: Vec<usize> = table.lines().collect();
    let fall = at.windows(2).position(|pair| pair[1] <= pair[0]);
    let Some(before) = fall else { return Ok(()) };
    let message = format!("{what} do not rise: {} after {}", at[before + 1], at[before]);
    let help = "one row per instant, in the order in which they were read";
    let wrong: CsvError = table.fault_at(lines.get(before + 1).copied(), message, help);
    Err(wrong.into())
}

/// `0.02 N m`, positive. As in a column, a number alone is one of what has no unit, not an angle.
fn level_in_si(option: &str, text: &str, si: &str) -> Result<f64, Failure> {
    let found = as_written(text).and_then(|(value, unit)| {
        let unit = match unit {
            "" if si == "1" => UnitSize::ONE,
            "" => return None,
            unit => unit_size(unit)?,
        };
        in_terms_of(si, unit).map(|own| own(value))
    });
    found.filter(|level| *level > 0.0 && level.is_finite()).ok_or_else(|| {
        let help = if si == "1" {
            "a positive number is needed".to_owned()
        } else {
            format!("a positive number with its unit is needed, {si} or another of the same kind")
        };
        Failure::usage(format!("{option}: `{text}` is no standard deviation here"), help)
    })
}

fn twice(table: &CsvTable<'_>, name: &str) -> Failure {
    fault(table, format!("two columns give {name}"), "delete one of them")
}

fn fault(table: &CsvTable<'_>, message: String, help: &str) -> Failure {
    table.fault_in_header(message, help).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_in_turns_and_in_radians_are_taken_as_the_output_has_them() {
        let size = |si: &str, unit: &str| {
            unit_size(unit).and_then(|unit| in_terms_of(si, unit)).map_or(0.0, |own| own(1.0))
        };
        let tau = std::f64::consts::TAU;
        for (si, unit, expected) in [
            ("rad/s", "rpm", tau / 60.0),
            ("rad/s", "Hz", tau),
            ("Hz", "rad/s", 1.0 / tau),
            ("rad/s", "rad/s", 1.0),
            ("rad/s", "1/s", 1.0),
            ("1/s", "Hz", 1.0),
            ("rad", "deg", tau / 360.0),
            ("rad/s", "m", 0.0),
        ] {
            let found = size(si, unit);
            assert!((found - expected).abs() <= 1e-15 * expected, "{unit} in {si}: {found}");
        }
    }
}
