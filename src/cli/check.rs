//! `check`: what a mechanism is, before anything moves.

mod contacts;
mod elements;
mod missions;
mod start;
mod unit;

use std::fmt::Write as _;

use crate::mechanism::told;
use crate::number::number;
use crate::provenance::Provenance;
use crate::wear_measure::{paragraph, wear_measures};
use linkwear_codegen::model::{Body, Flexible, Joint, Parameter};
use linkwear_codegen::preflight::{Analysis, Assemblies, Coordinate, Redundant, as_guesses};
use linkwear_codegen::{Compiled, Options};
use serde_json::{Map, Value, json};

use super::answer::Answer;
use super::answer::check::{
    AssemblyAnswer, CheckAnswer, FlexibleAnswer, ModeAnswer, ParameterAnswer, RedundantAnswer,
};
use super::failure::Failure;
use super::input::{load, options};
use super::options::Input;
use super::table::{plural, short_table, table};
use contacts::{Contact, contacts};
use elements::Elements;
use start::Start;
use unit::unit;

pub fn run(input: &Input) -> Result<Answer, Failure> {
    let (compiled, warnings) = load(input)?;
    Ok(answer(&compiled, &options(input, false), &warnings))
}

/// What a compiled mechanism is.
pub fn answer(compiled: &Compiled, options: &Options, warnings: &[Value]) -> Answer {
    let assemblies = compiled.assemblies();
    let description = compiled.description();
    let mut provenance = Provenance::new(compiled.sha256(), None, Value::Null);
    provenance.options = told(options);
    let parameters = description.parameters.iter();
    provenance.parameters = parameters.map(|known| (known.name.to_string(), json!(known.default))).collect();
    let start = Start::of(compiled);
    let contacts = contacts(compiled, start.as_ref().map_or(&[], |start| &start.clearances));
    let found = Found { compiled, assemblies, start, contacts };
    let told = told_of(&found, warnings);
    Answer::new(text(&found), told, Some(&provenance))
}

/// All that is told about.
struct Found<'a> {
    compiled: &'a Compiled,
    assemblies: Assemblies,
    start: Option<Start>,
    contacts: Vec<Contact<'a>>,
}

fn told_of<'a>(found: &'a Found<'_>, warnings: &'a [Value]) -> CheckAnswer<'a> {
    let Found { compiled, assemblies, start, contacts } = found;
    let values = |coordinates: &Vec<Coordinate>| -> Map<String, Value> {
        coordinates.iter().map(|at| (format!("{}.{}", at.joint, at.name), json!(at.value))).collect()
    };
    let (mechanism, analysis) = (&compiled.mechanism, &compiled.analysis);
    let elements = Elements::of(mechanism);
    let redundant = analysis.redundant.iter();
    let redundant = redundant.map(|Redundant { joint, row, reason }| RedundantAnswer { joint, row, reason });
    let cuts = compiled.topology.cuts.iter().map(|id| mechanism.joint(*id).name.as_str());
    CheckAnswer {
        name: &mechanism.name,
        bodies: mechanism.bodies.len(),
        joints: mechanism.joints.len(),
        coordinates: analysis.coordinates,
        speeds: analysis.speeds,
        constraint_rows: analysis.constraint_rows,
        independent_rows: analysis.independent_rows,
        mobility: analysis.mobility,
        grubler: analysis.grubler,
        drivers: &analysis.drivers,
        idle: &analysis.idle,
        redundant: redundant.collect(),
        non_unique: &analysis.non_unique,
        cut_joints: cuts.collect(),
        assembly: AssemblyAnswer {
            taken: values(&assemblies.taken),
            others: assemblies.others.iter().map(values).collect(),
        },
        start: start.as_ref().map(Start::by_column).unwrap_or_default(),
        clearances: contacts.iter().map(Contact::clearance_answer).collect(),
        wear: contacts.iter().filter_map(Contact::wear_answer).collect(),
        couplings: elements.couplings(),
        stops: elements.stops(),
        states: elements.states(),
        sensors: elements.sensors(),
        modal_coordinates: analysis.modes,
        flexible: mechanism.bodies.iter().filter_map(flexible_entry).collect(),
        parameters: parameters(compiled, false).map(parameter_entry).collect(),
        inputs: parameters(compiled, true).map(parameter_entry).collect(),
        wear_measures: wear_measures(compiled.description()),
        missions: missions::answers(compiled.description()),
        warnings,
    }
}

/// The parameters of the file, or its inputs.
fn parameters(compiled: &Compiled, inputs: bool) -> impl Iterator<Item = &Parameter> {
    compiled.mechanism.parameters.iter().filter(move |parameter| parameter.input == inputs)
}

fn flexible_entry(body: &Body) -> Option<FlexibleAnswer<'_>> {
    let flexible = body.flexible.as_ref()?;
    let modes = flexible.data.modes.iter().map(|mode| (&*mode.name, mode.frequency));
    let left_out = flexible.left_out.iter().map(|mode| (&*mode.name, mode.frequency));
    let told = |(name, frequency)| ModeAnswer { name, frequency_Hz: frequency };
    Some(FlexibleAnswer {
        body: &body.name,
        modes: modes.map(told).collect(),
        left_out: left_out.map(told).collect(),
    })
}

fn parameter_entry(parameter: &Parameter) -> ParameterAnswer<'_> {
    let written = parameter.written.as_ref();
    ParameterAnswer {
        name: &parameter.name,
        value: parameter.value,
        unit: unit(parameter.dimension),
        tunable: parameter.tunable,
        assumed: parameter.assumed,
        written: written.map(|(number, unit)| format!("{number} {unit}").trim_end().to_owned()),
    }
}

fn text(Found { compiled, assemblies, start, contacts }: &Found<'_>) -> String {
    let (mechanism, analysis) = (&compiled.mechanism, &compiled.analysis);
    let mut text = format!(
        "{}: {}, {}\n\n",
        mechanism.name,
        plural(mechanism.bodies.len() as u64, "body", "bodies"),
        plural(mechanism.joints.len() as u64, "joint", "joints"),
    );
    let dropped = analysis.constraint_rows - analysis.independent_rows;
    let facts = [
        ("coordinates", analysis.coordinates.to_string(), coordinates_note(analysis)),
        ("speeds", analysis.speeds.to_string(), speeds_note(analysis)),
        (
            "constraint rows",
            analysis.constraint_rows.to_string(),
            match dropped {
                _ if analysis.constraint_rows == 0 => "no loops".into(),
                0 => "all independent".into(),
                _ => format!("{} independent, {dropped} redundant", analysis.independent_rows),
            },
        ),
        ("mobility", analysis.mobility.to_string(), mobility_note(compiled)),
    ];
    let facts = facts.map(|(name, value, note)| vec![name.to_owned(), value, note]);
    text.push_str(&table(&["", "", ""], &facts));
    list(&mut text, "Driven", &analysis.drivers);
    list(&mut text, "Idle freedoms", &analysis.idle);
    for (reason, rows) in redundant_by_joint(analysis) {
        let _ = write!(text, "\nRedundant rows: {reason}\n{}", short_table(&["", ""], rows));
    }
    if !analysis.non_unique.is_empty() {
        let rows = non_unique_by_joint(analysis);
        let _ = write!(text, "\nReactions that are not unique\n{}", short_table(&["", ""], rows));
    }
    if !assemblies.others.is_empty() {
        let others = assemblies.others.iter().map(|other| ("or", other));
        let rows = [("taken", &assemblies.taken)].into_iter().chain(others);
        let rows = rows.map(|(word, way)| vec![word.to_owned(), as_guesses(way)]).collect();
        let _ = write!(
            text,
            "\nThe loops close in more than one way; [assembly] chooses\n{}",
            short_table(&["", ""], rows)
        );
    }
    for body in &mechanism.bodies {
        if let Some(flexible) = &body.flexible {
            let _ =
                write!(text, "\nModes of {}\n{}", body.name, short_table(&["", "Hz"], mode_rows(flexible)));
        }
    }
    if !mechanism.joints.is_empty() {
        let row = |joint| joint_row(compiled, joint, start.as_ref());
        let rows: Vec<_> = mechanism.joints.iter().map(row).collect();
        let head = ["name", "kind", "parent", "child", "start", ""];
        let _ = write!(text, "\nJoints\n{}", short_table(&head, rows));
    }
    text.push_str(&Elements::of(mechanism).text());
    text.push_str(&contacts::text(contacts));
    text.push_str(&paragraph(&wear_measures(compiled.description())));
    text.push_str(&missions::text(compiled.description()));
    for (title, column, inputs) in [("Parameters", "value", false), ("Inputs", "default", true)] {
        let rows: Vec<_> = parameters(compiled, inputs).map(parameter_row).collect();
        if !rows.is_empty() {
            let _ = write!(text, "\n{title}\n{}", table(&["name", column, "unit", ""], &rows));
        }
    }
    text
}

fn speeds_note(analysis: &Analysis) -> String {
    match analysis.modes {
        0 => String::new(),
        modes => format!("{modes} of them of modes, which mobility does not count"),
    }
}

/// Kept modes, those of one frequency together, then what comes next in every family.
fn mode_rows(flexible: &Flexible) -> Vec<Vec<String>> {
    let mut rows: Vec<(String, f64)> = Vec::new();
    for mode in &flexible.data.modes {
        match rows.last_mut() {
            Some((names, frequency)) if *frequency == mode.frequency => {
                names.push(' ');
                names.push_str(&mode.name);
            }
            _ => rows.push((mode.name.clone(), mode.frequency)),
        }
    }
    rows.extend(flexible.left_out.iter().map(|mode| (format!("left out: {}", mode.name), mode.frequency)));
    rows.into_iter().map(|(name, frequency)| vec![name, format!("{frequency:.3}")]).collect()
}

/// Why there are more coordinates than speeds, where there are.
fn coordinates_note(analysis: &Analysis) -> String {
    match analysis.coordinates - analysis.speeds {
        0 => String::new(),
        1 => "one more than speeds: a quaternion has four numbers for three freedoms".to_owned(),
        more => format!("{more} more than speeds: a quaternion has four numbers for three freedoms"),
    }
}

fn mobility_note(compiled: &Compiled) -> String {
    let analysis = &compiled.analysis;
    let mut note = format!("Grübler counts {}", analysis.grubler);
    match analysis.drivers.len() {
        0 => {}
        driven => {
            let _ = write!(note, "; {driven} driven");
        }
    }
    if !analysis.idle.is_empty() {
        let _ = write!(note, ", {} idle", analysis.idle.len());
    }
    note
}

/// Each reason with the rows it holds for, joint by joint.
fn redundant_by_joint(analysis: &Analysis) -> Vec<(&str, Vec<Vec<String>>)> {
    let mut reasons: Vec<(&str, Vec<Vec<String>>)> = Vec::new();
    for row in &analysis.redundant {
        let at = reasons.iter().position(|(reason, _)| *reason == row.reason).unwrap_or_else(|| {
            reasons.push((&row.reason, Vec::new()));
            reasons.len() - 1
        });
        add_to_joint(&mut reasons[at].1, &row.joint, &row.row, "; ");
    }
    reasons
}

/// `R1.Fz`, `R1.Mx` -> `R1  Fz Mx`.
fn non_unique_by_joint(analysis: &Analysis) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for name in &analysis.non_unique {
        let (joint, component) = name.rsplit_once('.').unwrap_or((name, ""));
        add_to_joint(&mut rows, joint, component, " ");
    }
    rows
}

fn add_to_joint(rows: &mut Vec<Vec<String>>, joint: &str, item: &str, separator: &str) {
    match rows.iter_mut().find(|row| row[0] == joint) {
        Some(row) => {
            row[1].push_str(separator);
            row[1].push_str(item);
        }
        None => rows.push(vec![joint.to_owned(), item.to_owned()]),
    }
}

fn list(text: &mut String, title: &str, items: &[String]) {
    if !items.is_empty() {
        let _ = writeln!(text, "\n{title}");
        for item in items {
            let _ = writeln!(text, "  {item}");
        }
    }
}

fn joint_row(compiled: &Compiled, joint: &Joint, start: Option<&Start>) -> Vec<String> {
    let mechanism = &compiled.mechanism;
    let is_cut = compiled.topology.cuts.iter().any(|id| mechanism.joint(*id).name == joint.name);
    let clearance = if joint.model.clearance { ", clearance" } else { "" };
    let kind = format!("{}{clearance}", joint.model.kind.name);
    let note = match (is_cut, joint.drives.is_empty()) {
        (true, _) => "closes a loop",
        (false, false) => "driven",
        (false, true) => "",
    };
    let carrier = |carrier| mechanism.carrier_name(carrier).to_owned();
    let start = start.map_or_else(String::new, |start| start.of_joint(&joint.name));
    vec![joint.name.clone(), kind, carrier(joint.parent), carrier(joint.child), start, note.into()]
}

fn parameter_row(parameter: &Parameter) -> Vec<String> {
    let marks: Vec<&str> = [(parameter.tunable, "tunable"), (parameter.assumed, "assumed")]
        .into_iter()
        .filter_map(|(holds, mark)| holds.then_some(mark))
        .collect();
    let (value, unit) = match &parameter.written {
        Some((value, unit)) if !unit.is_empty() => (*value, unit.clone()),
        _ => (parameter.value, unit(parameter.dimension)),
    };
    vec![parameter.name.clone(), number(value), unit, marks.join(", ")]
}
