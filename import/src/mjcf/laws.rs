//! Laws of actuators. In: elements with their defaults. Out: gain of the signal and force by 1, length and speed; defaults as those that all
//! kinds of actuators read. Never knows joints.
//!
//! In MuJoCo `kp`, `kv`, `gainprm` and `biasprm` are names of one store: what any kind of actuator in `<default>` writes there, any kind
//! that takes it goes on from.

use super::super::error::ImportError;
use super::super::xml::Element;

/// Kinds of actuators.
pub const KINDS: [&str; 10] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "plugin",
];

/// Attributes that are in the store under other names.
const SHORT: [&str; 2] = ["kp", "kv"];

/// Gain of the signal, and force by 1, length and speed.
pub type Law = (f64, [f64; 3]);

/// The law of an element; None of laws that are not of this form.
pub fn law(element: &Element) -> Result<Option<Law>, ImportError> {
    let gain = element.up_to("gainprm", 20)?.first().copied().unwrap_or(1.0);
    let mut bias = element.up_to("biasprm", 20)?;
    bias.resize(3, 0.0);
    Ok(match &*element.tag {
        "motor" => Some((1.0, [0.0; 3])),
        "position" => {
            let kp = element.number("kp", Some(gain))?;
            let kv = element.number("kv", Some(-bias[2]))?;
            Some((kp, [bias[0], -kp, -kv]))
        }
        "velocity" => {
            let kv = element.number("kv", Some(gain))?;
            Some((kv, [0.0, 0.0, -kv]))
        }
        "general" => {
            let is = |key: &str, word: &str| element.attribute(key).unwrap_or(word) == word;
            match element.attribute("biastype").unwrap_or("none") {
                _ if !is("dyntype", "none") || !is("gaintype", "fixed") => None,
                "none" => Some((gain, [0.0; 3])),
                "affine" => Some((gain, [bias[0], bias[1], bias[2]])),
                _ => None,
            }
        }
        _ => None,
    })
}

/// Attributes of an element of `<default>`, what is before it included, by the names of the store.
pub fn stored(element: &Element) -> Result<Vec<(String, String)>, ImportError> {
    let mut all = element.attributes.clone();
    if element.tag == "general" {
        return Ok(all);
    }
    let mut put = |key: &str, value: String| {
        all.retain(|(name, _)| name != key);
        all.push((key.to_owned(), value));
    };
    match law(element)? {
        Some((gain, [a, b, c])) => {
            put("gainprm", gain.to_string());
            put("biasprm", format!("{a} {b} {c}"));
            put("dyntype", "none".to_owned());
            put("gaintype", "fixed".to_owned());
            put("biastype", if element.tag == "motor" { "none" } else { "affine" }.to_owned());
        }
        // A law of its own, whatever kind reads it.
        None => put("gaintype", element.tag.clone()),
    }
    all.retain(|(name, _)| !SHORT.contains(&name.as_str()));
    Ok(all)
}
