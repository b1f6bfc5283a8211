//! The header: sizes, places, types, tables, functions. In: what is emitted. Out: text in which `pfx_` and `PFX_` stand for the
//! prefix.

use std::fmt::Write;

use linkwear_runtime::{CORRECTIONS, Description, Entry, Sizes};

use crate::tape::{Split, Tape};

use super::describe;
use super::function::declaration;
use super::laws::{ANSWER, MEMORY};
use super::names::Names;
use super::text::{comment, number};

/// What is declared, without guards.
pub fn declarations(description: &Description, sizes: &Sizes, tapes: &[Tape], splits: &[Split]) -> String {
    let mut text = lengths(description, sizes, true);
    text.push_str(&places(description));
    text.push_str(&parameters(description));
    text.push_str(describe::TYPES);
    text.push('\n');
    text.push_str(&tables(description));
    for (tape, split) in tapes.iter().zip(splits) {
        text.push_str(&declaration(tape, split));
    }
    text + include_str!("step.h")
}

/// Lengths of all arrays; `steps`: those of steps and scratch too.
pub fn lengths(description: &Description, sizes: &Sizes, steps: bool) -> String {
    let counts = [
        ("PARAMETERS", sizes.parameters, "tunable parameters, then inputs"),
        ("INPUTS", description.inputs.len(), "of these the last: inputs, which may change from step to step"),
        ("COORDINATES", sizes.coordinates, "free coordinates q"),
        ("SPEEDS", sizes.speeds, "free speeds v"),
        ("ALL_COORDINATES", sizes.all_coordinates, "all coordinates, driven ones included"),
        ("ALL_SPEEDS", sizes.all_speeds, "all speeds, driven ones included"),
        ("ROWS", sizes.rows, "constraint rows that are kept"),
        ("ALL_ROWS", sizes.all_rows, "constraint rows"),
        ("DRIVERS", sizes.drivers, "drivers"),
        ("CONTACTS", sizes.contacts, "joints with clearance"),
        ("CHANNELS", sizes.channels, "output channels of pfx_observe"),
        ("WORKSPACE", sizes.workspace, "numbers of scratch that every entry point is content with"),
        (
            "STATE",
            sizes.flat_state(),
            "numbers of a flat state: q, v, work supplied and dissipated [J], per joint with clearance wear integral [J], depth [m], impulse [N s], energy lost [J]",
        ),
        (
            "CONTACT_MEMORY",
            MEMORY,
            "numbers that a contact remembers: wear on top of its clearance [m], 1 while it touches, speed at which it closed [m/s]",
        ),
        (
            "CONTACT_ANSWER",
            ANSWER,
            "numbers that laws answer: force (3) [N] and moment (3) [N m] on the journal, wear power [W], depth rate [m/s], normal force [N], power lost [W], penetration [m], its rate [m/s], sliding speed [m/s], energy stored [J]",
        ),
        ("CORRECTIONS", CORRECTIONS, "corrections of positions in a step at most"),
    ];
    let mut text = "/* Lengths. */\nenum {\n".to_owned();
    const OF_STEPS: [&str; 5] = ["WORKSPACE", "STATE", "CONTACT_MEMORY", "CONTACT_ANSWER", "CORRECTIONS"];
    for (name, count, doc) in counts.into_iter().filter(|(name, ..)| steps || !OF_STEPS.contains(name)) {
        let _ = writeln!(text, "    /* {doc} */\n    PFX_{name} = {count},");
    }
    text.push_str("    /* numbers that every entry point reads and writes */\n");
    let mut lines = Vec::new();
    for entry in Entry::ALL {
        let name = entry.name().to_ascii_uppercase();
        let output = sizes.output(entry);
        lines.push(format!("    PFX_{name}_IN = {}", sizes.input(entry)));
        lines.push(format!("    PFX_{name}_OUT = {output}"));
    }
    text + &lines.join(",\n") + "\n};\n\n"
}

/// Places by name.
pub fn places(description: &Description) -> String {
    let contacts = description.contacts.iter().map(|contact| contact.joint.to_string());
    let lists: [(&str, &str, Vec<String>); 6] = [
        (
            "PARAMETER",
            "Places among the parameters",
            names(description.parameters.iter().map(|own| &*own.name)),
        ),
        ("Q", "Places among the coordinates", names(description.coordinates.iter().map(|own| &*own.name))),
        ("V", "Places among the speeds", names(description.speeds.iter().map(|own| &*own.name))),
        ("DRIVER", "Places among the drivers", names(description.drivers.iter().map(|own| &*own.joint))),
        ("CONTACT_OF", "Places among the joints with clearance", contacts.collect()),
        ("CHANNEL", "Places among the channels", names(description.channels.iter().map(|own| &*own.name))),
    ];
    let mut text = String::new();
    for (kind, doc, list) in lists.into_iter().filter(|(.., list)| !list.is_empty()) {
        let mut unique = Names::default();
        let lines: Vec<String> = list
            .iter()
            .enumerate()
            .map(|(index, name)| {
                format!(
                    "    PFX_{kind}_{} = {index}",
                    unique.unique(&format!("of {name}")).replacen("of_", "", 1)
                )
            })
            .collect();
        let _ = write!(text, "/* {doc}. */\nenum {{\n{}\n}};\n\n", lines.join(",\n"));
    }
    text
}

fn names<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    names.map(str::to_owned).collect()
}

/// The struct of parameters.
fn parameters(description: &Description) -> String {
    if description.parameters.is_empty() {
        return String::new();
    }
    let mut unique = Names::default();
    let mut text =
        "/* Tunable parameters, SI, in the order of the input arrays. */\ntypedef struct {\n".to_owned();
    for own in description.parameters.iter() {
        let doc = format!("[{}], {} in the file", comment(&own.unit), number(own.default));
        let _ = writeln!(text, "    /* {doc} */\n    double {};", unique.unique(&own.name));
    }
    text.push_str("} pfx_parameters;\n\n/* Values in the file. */\nextern const pfx_parameters pfx_default_parameters;\n\n");
    text.push_str("/* Writes parameters to where an input array, or a step, wants them. */\n");
    text.push_str("void pfx_set_parameters(const pfx_parameters *parameters, double *x);\n\n");
    text
}

fn tables(description: &Description) -> String {
    let lists = [
        ("parameter_info", "parameter_table", description.parameters.len()),
        ("variable_info", "coordinates", description.coordinates.len()),
        ("variable_info", "speeds", description.speeds.len()),
        ("motion_info", "motions", description.motions.len()),
        ("row_info", "rows", description.rows.len()),
        ("driver_info", "drivers", description.drivers.len()),
        ("channel_info", "channels", description.channels.len()),
        ("contact_info", "contact_table", description.contacts.len()),
    ];
    let mut text = "/* The mechanism's description. Lists without entries are left out. */\nextern const char *const pfx_name;\nextern const char *const pfx_source_sha256;\n".to_owned();
    for (of, name, length) in lists.into_iter().filter(|(.., length)| *length > 0) {
        let _ = writeln!(text, "extern const pfx_{of} pfx_{name}[{length}];");
    }
    text.push('\n');
    text
}
