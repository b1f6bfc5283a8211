//! Right-hand side and fixed step as functions of C around the entry points. In: layout, laws. Out: text, and what it calls.

use std::collections::BTreeSet;
use std::fmt::Write;

use linkwear_runtime::clearance_joint::Clearance;
use linkwear_runtime::{Description, Layout, Motion, Sizes};

use super::laws::laws;
use super::recorder::Function;

/// What of a template is wanted: lines after `//? word` up to the next `//?` or `//.`, or after `//? no word` without it.
pub fn chosen(template: &str, has: &dyn Fn(&str) -> bool) -> String {
    let mut is_wanted = true;
    let mut text = String::new();
    for line in template.lines() {
        if let Some(condition) = line.strip_prefix("//? ") {
            is_wanted = condition.strip_prefix("no ").map_or_else(|| has(condition), |word| !has(word));
        } else if line == "//." {
            is_wanted = true;
        } else if is_wanted {
            text.extend([line, "\n"]);
        }
    }
    text
}

/// The same, with the statements that put a flat state into the input of an entry point.
pub fn asking(template: &str, has: &dyn Fn(&str) -> bool) -> String {
    chosen(template, has).replace("QUESTION\n", include_str!("question.c"))
}

/// The functions, and what they call; `pfx_` and `PFX_` stand for the prefix.
pub fn functions(
    description: &Description,
    sizes: &Sizes,
    joints: &[Clearance],
    has_start: bool,
) -> (String, BTreeSet<Function>) {
    let layout = Layout::new(&description.motions);
    let free: Vec<Motion> = layout.free().map(|group| group.motion).collect();
    let has_pose = free.contains(&Motion::Pose);
    let has_quaternions = has_pose || free.contains(&Motion::Rotation);
    let moves = sizes.rows > 0 && has_quaternions;
    let has = |word: &str| match word {
        "contacts" => sizes.contacts > 0,
        "rows" => sizes.rows > 0,
        "rotation" => moves,
        "pose" => moves && has_pose,
        "start" => has_start,
        "start contacts" => has_start && sizes.contacts > 0,
        "start loops" => has_start && sizes.contacts == 0 && sizes.rows > 0,
        "start open" => has_start && sizes.contacts == 0 && sizes.rows == 0,
        "parameters" => !description.parameters.is_empty(),
        _ => has_quaternions,
    };
    let mut called = BTreeSet::new();
    let mut text = String::new();
    if sizes.rows > 0 {
        let kept: Vec<String> = (0..sizes.rows)
            .filter_map(|kept| description.rows.iter().position(|row| row.kept == Some(kept)))
            .map(|row| row.to_string())
            .collect();
        let _ = write!(
            text,
            "/* Of every kept row, its row among all. */\nstatic const int pfx_kept[] = {{{}}};\n\n",
            kept.join(", ")
        );
    }
    if has("start loops") {
        let given = description.coordinates.iter().map(|one| one.held);
        let given = given.chain(description.speeds.iter().map(|one| one.held));
        let list: Vec<String> = given.map(|is_given| u8::from(is_given).to_string()).collect();
        let doc = "Of every coordinate and speed, whether the file gives its start value.";
        let list = list.join(", ");
        let _ = write!(text, "/* {doc} */\nstatic const unsigned char pfx_is_given[] = {{{list}}};\n\n");
    }
    text.push_str(&chosen(include_str!("motion.c"), &has));
    text.push_str(&on_manifold(&layout, sizes.rows > 0));
    if has("rotation") {
        called.insert(Function::Sine);
    }
    if sizes.contacts > 0 {
        let (statements, calls) = laws(joints);
        called.extend(calls);
        let _ = write!(
            text,
            "void pfx_contact_laws(const double *motions, const double *contacts, double *answers)\n{{\n{statements}}}\n\n"
        );
    }
    text.push_str(&asking(include_str!("step.c"), &has));
    (text, called)
}

/// How coordinates move with speeds, and their quaternions stay of unit length.
fn on_manifold(layout: &Layout, advances: bool) -> String {
    let mut normalize = String::new();
    let mut advance = String::new();
    for group in layout.free() {
        let (q, v) = (group.coordinate, group.speed);
        let _ = match group.motion {
            Motion::Scalar { .. } => writeln!(advance, "    q[{q}] += delta[{v}];"),
            Motion::Rotation => {
                writeln!(advance, "    pfx_rotate(q + {q}, delta[{v}], delta[{}], delta[{}]);", v + 1, v + 2)
            }
            Motion::Pose => writeln!(advance, "    pfx_displace(q + {q}, delta + {v}, delta + {});", v + 3),
        };
        if !matches!(group.motion, Motion::Scalar { .. }) {
            let _ = writeln!(normalize, "    pfx_unit(q + {q});");
        }
    }
    if normalize.is_empty() {
        normalize.push_str("    (void)q;\n");
    }
    let mut text = format!(
        "/* Scales quaternions to unit length. */\nstatic void pfx_normalize(double *q)\n{{\n{normalize}}}\n\n"
    );
    if advances {
        let doc = "Moves the free coordinates as constant speeds would in unit time.";
        let _ = write!(
            text,
            "/* {doc} */\nstatic void pfx_advance(double *q, const double *delta)\n{{\n{advance}}}\n\n"
        );
    }
    text
}
