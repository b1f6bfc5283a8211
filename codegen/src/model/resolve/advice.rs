//! What to write instead of a quantity of the wrong dimension: made from the key that is filled in, because the
//! dimension alone cannot tell a wear coefficient from an angle.

use crate::spec::{Dimension, Turning};

/// A value as one would write it, by key.
const EXAMPLES: &[(&str, &str)] = &[
    ("radius", "\"6 mm\""),
    ("inner_radius", "\"5 mm\""),
    ("width", "\"10 mm\""),
    ("radial", "\"20 um\""),
    ("journal_radius", "\"10 mm\""),
    ("length", "\"20 mm\""),
    ("equation", "\"sqrt(x^2 + y^2) - 30 mm\""),
    ("modulus", "\"115 GPa\""),
    ("young", "\"210 GPa\""),
    ("hardness", "\"3.5 GPa\""),
    ("journal_hardness", "\"7 GPa\""),
    ("threshold", "\"80 um\""),
    ("coefficient", "1e-8"),
    ("restitution", "0.9"),
    ("friction", "0.05"),
    ("static_friction", "0.08"),
    ("poisson", "0.3"),
    ("feedback", "1"),
    ("revolutions_per_cycle", "1e6"),
    ("exponent", "1.5"),
    ("count", "3"),
    ("modes", "6"),
    // Of a flexible body, a ratio.
    ("damping", "0.01"),
    // Of a contact, in N/m^n.
    ("stiffness", "1e9"),
    ("frequencies", "\"120 Hz\""),
];

/// The key that `what` names first: "`radius` of body `crank`".
fn key(what: &str) -> &str {
    what.split('`').nth(1).unwrap_or_default()
}

/// Whether a hardness is filled in.
pub(super) fn is_hardness(what: &str) -> bool {
    matches!(key(what), "hardness" | "journal_hardness")
}

fn example(what: &str, expected: Dimension) -> String {
    if key(what) == "drive" {
        let law = if expected == Dimension::LENGTH { "10 mm*sin(2*pi*speed*t)" } else { "2*pi*speed*t" };
        return format!("\"{law}\"");
    }
    // A key may stand for several dimensions: the friction of a joint is a damping, that of a contact a number.
    let known =
        EXAMPLES.iter().find(|(known, _)| *known == key(what)).map(|(_, example)| (*example).to_owned());
    let is_number = |example: &String| !example.starts_with('"');
    known
        .filter(|example| is_number(example) == (expected == Dimension::NONE))
        .unwrap_or_else(|| format!("\"{}\"", expected.example()))
}

/// Something of the right kind.
pub(super) fn like(what: &str, expected: Dimension) -> String {
    format!("write something like {}", example(what, expected))
}

/// A bare number where a unit is needed.
pub(super) fn missing_unit(what: &str, number: f64, expected: Dimension) -> String {
    let si = expected.si_unit();
    if is_hardness(what) {
        return format!(
            "write \"{number} HB\", \"{number} HV\" or \"{number} HRC\" for a number of Brinell, Vickers or Rockwell, else the \
             pressure: \"{number} MPa\" or \"{number} GPa\"; docs/choosing-values.md has usual values"
        );
    }
    let example = example(what, expected);
    let unit = example.trim_matches('"').split_once(' ').map_or(si.as_str(), |(_, unit)| unit);
    let or = if unit == si { String::new() } else { format!(" or \"{number} {si}\"") };
    format!("write the unit that is meant: \"{number} {unit}\"{or}")
}

/// A quantity of another dimension than needed.
pub(super) fn mismatch(
    what: &str,
    text: &str,
    (found, turning): (Dimension, Turning),
    expected: Dimension,
) -> String {
    let rate = Some(found) == expected.over(Dimension::TIME);
    if key(what) == "drive" && rate {
        let turns = if turning.turns > 0 { "2*pi*" } else { "" };
        return format!("a drive gives the position over time: write \"{turns}{text}*t\"");
    }
    if key(what) == "equation" && found == Dimension::of(2, 0, 0) {
        return "an equation of squares is an area: take the root of it, as in `sqrt(x^2 + y^2) - r`"
            .to_owned();
    }
    if key(what) == "coefficient" && found == Dimension::of(1, -1, 2) {
        return "this is the wear rate k/H: write its product with the hardness, a pure number such as 1e-8, and \
                the hardness apart, `hardness = \"3.5 GPa\"`"
            .to_owned();
    }
    like(what, expected)
}
