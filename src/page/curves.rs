//! Curves of a run that people look for first: forces, drive, contact, deflection, energy. In: a run. Out: charts. Never knows
//! how they are drawn.

use linkwear_runtime::Run;

use super::chart::{Chart, Series};

/// Curves of a chart.
const CURVES: usize = 8;

/// Charts of a run over its time.
pub fn charts(run: &Run) -> Vec<Chart> {
    let all = [
        lengths(run, "forces at the joints", |name, unit| unit == "N" && name.ends_with(".Fx")),
        plain(run, "drive", |name, unit| name.contains(".drive") && unit == "N m"),
        plain(run, "drive", |name, unit| name.contains(".drive") && unit == "N"),
        plain(run, "contact force at clearances", |name, _| name.ends_with(".Fn")),
        plain(run, "gap at clearances (below 0: pressed)", |name, _| name.ends_with(".gap")),
        plain(run, "deflection of flexible bodies", |name, unit| {
            unit == "m" && [".ux", ".uy", ".uz"].iter().any(|stem| name.contains(stem))
        }),
        plain(run, "joint angles", |name, unit| unit == "rad" && name.contains(".q")),
        plain(run, "joint speeds", |name, unit| unit == "rad/s" && name.contains(".v") && !is_own(name)),
        plain(run, "joint positions", |name, unit| unit == "m" && name.contains(".q")),
        plain(run, "inputs", |name, _| name.ends_with(".u")),
        plain(run, "energy", |name, unit| unit == "J" && !is_own(name)),
    ];
    all.into_iter().chain(own(run)).filter(|chart| !chart.is_empty()).collect()
}

/// Whether the column is a state of the file's own or a sensor.
fn is_own(name: &str) -> bool {
    name.ends_with(".value")
}

/// States and sensors, a chart for each unit.
fn own(run: &Run) -> Vec<Chart> {
    let mut units: Vec<&str> = Vec::new();
    for channel in run.channels.iter().filter(|channel| is_own(&channel.name)) {
        if !units.contains(&&*channel.unit) {
            units.push(&channel.unit);
        }
    }
    units
        .into_iter()
        .map(|own| plain(run, "states and sensors", |name, unit| is_own(name) && unit == own))
        .collect()
}

fn plain(run: &Run, title: &str, is_meant: impl Fn(&str, &str) -> bool) -> Chart {
    of(run, title, &is_meant, |at| vec![at])
}

/// Of vectors their lengths.
fn lengths(run: &Run, title: &str, is_meant: impl Fn(&str, &str) -> bool) -> Chart {
    of(run, title, &is_meant, |at| vec![at, at + 1, at + 2])
}

fn of(
    run: &Run,
    title: &str,
    is_meant: &dyn Fn(&str, &str) -> bool,
    parts: impl Fn(usize) -> Vec<usize>,
) -> Chart {
    let meant = run.channels.iter().enumerate().filter(|(_, channel)| is_meant(&channel.name, &channel.unit));
    let mut unit = String::new();
    let mut series = Vec::new();
    for (colour, (at, channel)) in meant.take(CURVES).enumerate() {
        let columns = parts(at);
        let value = |row: &Vec<f64>| match &*columns {
            [one] => row[*one],
            many => many.iter().map(|at| row[*at].powi(2)).sum::<f64>().sqrt(),
        };
        let points = run.times.iter().zip(&run.rows).map(|(t, row)| [*t, value(row)]).collect();
        let name = if columns.len() > 1 { channel.name.trim_end_matches(".Fx") } else { &channel.name };
        unit = channel.unit.to_string();
        series.push(Series { columns, ..Series::line(name, colour, points) });
    }
    Chart {
        title: title.to_owned(),
        x: "t [s]".to_owned(),
        y: format!("[{unit}]"),
        series,
        is_time: true,
        ..Chart::default()
    }
}
