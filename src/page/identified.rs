//! Charts of what was identified: readings beside predictions, residuals. In: what was found. Out: charts. Never knows models.

use super::chart::{Chart, Series, Stroke};
use crate::identify::{GroupFit, Identified};

/// Two charts for each group of readings.
pub fn charts(found: &Identified) -> Vec<Chart> {
    found.groups.iter().flat_map(|group| [beside(group), residuals(group)]).collect()
}

fn points(group: &GroupFit, values: &[f64]) -> Vec<[f64; 2]> {
    group.at.iter().zip(values).map(|(at, value)| [*at, *value]).collect()
}

fn beside(group: &GroupFit) -> Chart {
    Chart {
        title: group.name.clone(),
        x: group.clock.clone(),
        y: format!("[{}]", group.unit),
        series: vec![
            Series::line("measured", 0, points(group, &group.measured)).drawn(Stroke::Points),
            Series::line("model", 1, points(group, &group.predicted)),
        ],
        ..Chart::default()
    }
}

fn residuals(group: &GroupFit) -> Chart {
    let apart: Vec<f64> = group.measured.iter().zip(&group.predicted).map(|(a, b)| a - b).collect();
    let level = |sign: f64| vec![sign * 2.0 * group.noise; group.at.len()];
    Chart {
        title: format!("{}: measured minus model, and twice the noise", group.name),
        x: group.clock.clone(),
        y: format!("[{}]", group.unit),
        series: vec![
            Series::line("residuals", 0, points(group, &apart)).drawn(Stroke::Points),
            Series::line("+2 sigma", 1, points(group, &level(1.0))).drawn(Stroke::Dashed),
            Series::line("-2 sigma", 1, points(group, &level(-1.0))).drawn(Stroke::Dashed),
        ],
        ..Chart::default()
    }
}
