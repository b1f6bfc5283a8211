//! Table 1: the parameters of the study, the paper's beside those of the file, every assumed value marked.
//! In: the file of the mechanism. Out: [`ParameterRow`]s. Never runs anything.

use linkwear::mechanism::LoadError;
use linkwear_codegen::Compiled;
use linkwear_codegen::spec::{self, Literal, Quantity};
use serde::Serialize;

use super::error::StudyError;

/// One parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterRow {
    /// What it is.
    pub name: String,
    /// Symbol of the paper, or name in the file.
    pub symbol: String,
    /// Value in the paper; nothing if it gives none.
    pub paper: Option<String>,
    /// Value in the file; nothing if the model has no such number.
    pub ours: Option<String>,
    /// Marked as assumed in the file: ours, because the paper is silent.
    pub assumed: bool,
}

/// A row of the paper's Table 1: what it is, symbol, value, unit; name in the file, and how many units are one SI unit, or
/// nothing if the model does not use it.
type Printed = (&'static str, &'static str, f64, &'static str, Option<(&'static str, f64)>);

const PAPER: [Printed; 15] = [
    ("Link 1 length", "L1", 120.0, "mm", Some(("L1", 1e3))),
    ("Link 2 length", "L2", 420.0, "mm", Some(("L2", 1e3))),
    ("Link 3 length", "L3", 260.0, "mm", Some(("L3", 1e3))),
    ("Link 2 cross-section radius", "r2", 6.0, "mm", Some(("r", 1e3))),
    ("Young's modulus", "E", 210.0, "GPa", Some(("E", 1e-9))),
    ("Poisson's ratio", "ν", 0.3, "", Some(("nu", 1.0))),
    ("Density", "ρ", 7850.0, "kg/m³", Some(("steel", 1.0))),
    ("Modal truncation order of link 2", "n_f", 6.0, "", Some(("modes", 1.0))),
    ("Initial radial clearance of R1", "c0", 10.0, "µm", Some(("c0", 1e6))),
    ("Equivalent elastic modulus", "E*", 115.0, "GPa", Some(("E_contact", 1e-9))),
    ("Equivalent Poisson's ratio", "ν*", 0.3, "", None),
    ("Wear coefficient", "k_wear", 1e-8, "", Some(("k_wear", 1.0))),
    ("Contact hardness", "H_mat", 3.5, "GPa", Some(("hardness", 1e-9))),
    ("Critical wear depth", "W_crit", 80.0, "µm", Some(("W_crit", 1e6))),
    // The drive is in the paper's text, not in its table.
    ("Crank frequency (section 5)", "f", 2.0, "Hz", Some(("speed", 1.0))),
];

/// Rows of the paper first, then what the file marks as assumed.
pub(super) fn parameters(compiled: &Compiled) -> Result<Vec<ParameterRow>, StudyError> {
    let file = spec::parse(&compiled.source).map_err(LoadError::Mechanism)?.file;
    let known = &compiled.mechanism.parameters;
    let mut rows = Vec::new();
    for (name, symbol, value, unit, file) in PAPER {
        let ours = |(name, factor): (&str, f64)| {
            let missing = || StudyError::Missing { kind: "parameter", name: name.to_owned() };
            let found = known.iter().find(|parameter| parameter.name == name).ok_or_else(missing)?;
            Ok::<_, StudyError>((with_unit(factor * found.value, unit), found.assumed))
        };
        let ours = file.map(ours).transpose()?;
        rows.push(ParameterRow {
            name: name.to_owned(),
            symbol: symbol.to_owned(),
            paper: Some(with_unit(value, unit)),
            assumed: ours.as_ref().is_some_and(|ours| ours.1),
            ours: ours.map(|ours| ours.0),
        });
    }
    for parameter in known.iter().filter(|parameter| parameter.assumed) {
        let written = file.parameters.0.iter().find(|(name, _)| name.value == parameter.name);
        let text = written.and_then(|(_, written)| written.value.value()).map(text);
        rows.push(assumption(meaning(&parameter.name), &parameter.name, text.unwrap_or_default()));
    }
    for point in compiled.mechanism.points.iter().filter(|point| point.assumed) {
        let values = compiled.mechanism.parameter_values();
        let at = point.position_for(point.carrier).iter().map(|formula| formula.value(&values));
        let at: Vec<String> = at.map(|value| number(1e3 * value.unwrap_or(f64::NAN))).collect();
        rows.push(assumption("Position of a point", &point.name, format!("({}) mm", at.join(", "))));
    }
    let quantity = |value: &Option<Quantity>| value.as_ref().map(text);
    let mut keys = Vec::new();
    for (joint, spec) in file.clearance.0.iter().filter(|(_, spec)| spec.value.assumed) {
        let spec = &spec.value;
        let listed = |speeds: &[Quantity]| speeds.iter().map(text).collect::<Vec<_>>().join(", ");
        let law = spec.law.as_ref().map(|law| law.value.to_string());
        let speeds = spec.friction_speed.as_ref().map(|speeds| listed(speeds.value.as_slice()));
        keys.extend([
            (joint, "Journal radius", quantity(&spec.journal_radius)),
            (joint, "Bearing length", quantity(&spec.length)),
            (joint, "Law of the normal force (as in the paper)", law),
            (joint, "Restitution", quantity(&spec.restitution)),
            (joint, "Least impact speed", quantity(&spec.impact_speed_floor)),
            (joint, "Friction", quantity(&spec.friction)),
            (joint, "Friction smoothed below", speeds),
        ]);
    }
    for (joint, spec) in file.wear.0.iter().filter(|(_, spec)| spec.value.assumed) {
        let spec = &spec.value;
        let area = spec.area.as_ref().map(|area| area.value.to_string());
        keys.extend([
            (joint, "Contact area of Archard's law", area),
            (joint, "Feedback γ", quantity(&spec.feedback)),
            (joint, "Revolutions per cycle (before calibration)", quantity(&spec.revolutions_per_cycle)),
        ]);
    }
    let written = keys.into_iter().filter_map(|(joint, name, text)| Some((joint, name, text?)));
    // A value that is a parameter has its own row.
    let ours = written.filter(|(_, _, text)| known.iter().all(|parameter| parameter.name != *text));
    rows.extend(ours.map(|(joint, name, text)| assumption(name, &joint.value, text)));
    Ok(rows)
}

fn assumption(name: &str, symbol: &str, value: String) -> ParameterRow {
    let (name, symbol) = (name.to_owned(), symbol.to_owned());
    ParameterRow { name, symbol, paper: None, ours: Some(value), assumed: true }
}

/// What the assumed parameters of the file are; others keep their names.
fn meaning(name: &str) -> &str {
    match name {
        "zeta" => "Damping ratio of every mode",
        "wear_rate" => "Gamma process: shape α per wear = rate β",
        "c_rocker" => "Damper at R4",
        "c_ball" => "Viscous friction of the spherical joints",
        other => other,
    }
}

/// As written in the file.
fn text(quantity: &Quantity) -> String {
    match &quantity.value {
        Literal::Number(value) => number(*value),
        Literal::Text(text) => text.clone(),
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    let number = number(value);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// Six digits: conversion of units leaves rounding behind.
fn number(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && !(1e-3..1e6).contains(&size) {
        return format!("{value:e}");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::compiled;

    #[test]
    fn the_file_has_the_papers_numbers_and_marks_its_own() {
        let rows = parameters(&compiled().expect("the shipped file")).expect("a table");
        for row in &rows {
            match (&row.paper, &row.ours) {
                (Some(paper), Some(ours)) => assert_eq!((paper, row.assumed), (ours, false), "{}", row.name),
                (Some(_), None) => assert_eq!(row.symbol, "ν*"),
                (None, _) => assert!(row.assumed, "{}", row.name),
            }
        }
        let value = |name: &str| {
            rows.iter().find(|row| row.name == name).and_then(|row| row.ours.clone()).unwrap_or_default()
        };
        assert_eq!(value("Damper at R4"), "2 N m s/rad");
        assert_eq!(value("Journal radius"), "10 mm");
        assert_eq!(value("Contact area of Archard's law"), "Hertz, 2 b L");
        assert_eq!(value("Position of a point"), "(350, 50, -300) mm");
    }
}
