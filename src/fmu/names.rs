//! Names and units of a unit's variables. In: a unit, its columns. Out: both by reference, no name twice. Never knows XML.

use std::collections::BTreeSet;

use linkwear_fmu::{Unit, Variable, Variables};
use linkwear_runtime::{Channel, Description};

use super::si::rate;

/// Name and unit of every variable, in the order of their references.
///
/// Parameters and columns have the names of the file. What a unit adds gives way where the file has its name, by a `_` behind it:
/// a parameter `time` leaves `time_` to the independent variable.
pub fn names(unit: &Unit, channels: &[Channel]) -> Vec<(String, String)> {
    let variables: Vec<Variable> =
        Variables::new(unit, channels).all().map(|(_, variable)| variable).collect();
    let is_of_file = |variable: &Variable| matches!(variable, Variable::Parameter(_) | Variable::Output(_));
    let of_file = variables.iter().filter(|variable| is_of_file(variable));
    let mut taken: BTreeSet<String> = of_file.map(|variable| plain(*variable, unit, channels).0).collect();
    let mut states = Vec::new();
    let mut all = Vec::with_capacity(variables.len());
    for variable in variables {
        let (mut name, mut si) = plain(variable, unit, channels);
        if let Variable::Derivative(index) = variable {
            // Of the name that its state has come to.
            let (state, of_state): &(String, String) = &states[index];
            (name, si) = (format!("der({state})"), rate(of_state).unwrap_or_else(|| "1".to_owned()));
        } else if !is_of_file(&variable) {
            while !taken.insert(name.clone()) {
                name.push('_');
            }
        }
        if matches!(variable, Variable::State(_)) {
            states.push((name.clone(), si.clone()));
        }
        all.push((name, si));
    }
    all
}

/// Name and SI unit, whatever other variables are called; of a derivative those of its state.
fn plain(variable: Variable, unit: &Unit, channels: &[Channel]) -> (String, String) {
    let description = unit.program.description();
    match variable {
        Variable::Time => ("time".to_owned(), "s".to_owned()),
        Variable::Parameter(index) => {
            let info = &description.parameters[index];
            (info.name.to_string(), info.unit.to_string())
        }
        Variable::Output(index) => (channels[index].name.to_string(), channels[index].unit.to_string()),
        Variable::State(index) | Variable::Derivative(index) => {
            let (name, unit) = state(description, index);
            let kind = if index < description.coordinates.len() { "q" } else { "v" };
            (format!("state.{kind}.{name}"), unit.to_owned())
        }
        Variable::Indicator(index) => {
            (format!("penetration.{}", description.contacts[index].joint), "m".to_owned())
        }
        Variable::Constant(index) => {
            let constant = &unit.constants[index];
            (format!("constant.{}", constant.name), constant.unit.clone())
        }
    }
}

/// Name and SI unit of a state.
fn state(description: &Description, index: usize) -> (&str, &str) {
    let info = description.coordinates.iter().chain(&*description.speeds).nth(index);
    info.map_or(("", ""), |info| (&info.name, &info.unit))
}
