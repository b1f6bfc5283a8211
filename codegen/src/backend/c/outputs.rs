//! All columns of a run as one function of C, for a file of its own beside the mechanism's: those of the equations, then those of
//! contacts, by the runtime's own geometry. In: description, joints. Out: text that includes the mechanism's header.

use std::collections::BTreeSet;
use std::fmt::Write;

use linkwear_runtime::clearance_joint::{Clearance, contact_columns};
use linkwear_runtime::contact::bearing_angle;
use linkwear_runtime::{CONTACT_MOTION, Description, Sizes};

use super::laws::ANSWER;
use super::recorder::{Function, Recorder};
use super::step::asking;

/// The function, and what it calls; `pfx_` and `PFX_` stand for the prefix.
pub fn outputs(
    description: &Description,
    sizes: &Sizes,
    joints: &[Clearance],
) -> (String, BTreeSet<Function>) {
    let (columns, called) = contact_values(description, sizes);
    let has_journal = joints.iter().any(|joint| joint.journal_ratio().is_some());
    let has = |word: &str| match word {
        "contacts" => sizes.contacts > 0,
        "journals" => has_journal,
        _ => sizes.all_rows > 0,
    };
    (asking(include_str!("outputs.c"), &has).replace("CONTACT_COLUMNS\n", &columns), called)
}

/// Statements that write the columns of contacts.
fn contact_values(description: &Description, sizes: &Sizes) -> (String, BTreeSet<Function>) {
    let recorder = Recorder::default();
    let columns = contact_columns(description);
    let angles: Vec<_> = (0..sizes.contacts)
        .map(|joint| {
            let [x, y] = [0, 1].map(|axis| recorder.input(CONTACT_MOTION * joint + axis));
            recorder.id(bearing_angle([x, y]))
        })
        .collect();
    let wanted: Vec<usize> = columns
        .iter()
        .filter(|(_, quantity)| quantity.ends_with("_angle"))
        .map(|(joint, _)| angles[*joint])
        .collect();
    let recording = recorder.finish();
    let (statements, results) = recording.statements(&wanted, |index| format!("motions[{index}]"));
    let mut results = results.into_iter();
    let mut text: String = statements.lines().map(|line| format!("        {line}\n")).collect();
    for (place, (joint, quantity)) in columns.iter().enumerate() {
        let motion = |axis: usize| format!("motions[{}]", CONTACT_MOTION * joint + axis);
        let law = |place: usize| format!("laws[{}]", ANSWER * joint + place);
        let value = match *quantity {
            "x" => motion(0),
            "y" => motion(1),
            "z" => motion(2),
            "gap" => format!("-{}", law(10)),
            "Fn" => law(8),
            "vt" => law(12),
            "journal_angle" => {
                format!("pfx_around({} - {})", results.next().unwrap_or_default(), motion(2))
            }
            _ => results.next().unwrap_or_default(),
        };
        let _ = writeln!(text, "            columns[PFX_CHANNELS + {place}] = {value};");
    }
    (text, recording.calls(&wanted))
}
