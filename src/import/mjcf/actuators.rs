//! Actuators that push along joint coordinates. In: elements and joints. Out: a law of each, over a signal from outside. Never knows text.

use super::super::error::ImportError;
use super::super::robot::Actuator;
use super::super::xml::Element;
use super::bodies::Tree;
use super::settings::is_limited;

/// Attributes that make more of an actuator than a force by signal, coordinate and speed.
const MORE: [&str; 8] =
    ["timeconst", "dampratio", "inheritrange", "delay", "nsample", "actlimited", "armature", "damping"];

/// Reads them; what acts otherwise is told.
pub fn read(root: &Element, tree: &mut Tree<'_>) -> Result<Vec<Actuator>, ImportError> {
    let mut actuators: Vec<Actuator> = Vec::new();
    for element in root.all("actuator").flat_map(|actuator| &actuator.children) {
        let element = &tree.classes.applied(element, None)?;
        let number = actuators.len() + 1;
        let name = element.attribute("name").map_or_else(|| format!("actuator_{number}"), str::to_owned);
        let told = format!("<{}> {name}", element.tag);
        let Some(joint) = element.attribute("joint").or_else(|| element.attribute("jointinparent")) else {
            tree.left_out.push(format!("{told}: it does not act on a joint"));
            continue;
        };
        let Some(joint) = tree.joints.iter().position(|other| other.name == joint) else {
            return Err(element.fault(format!("there is no joint `{joint}`"), "names are case-sensitive"));
        };
        let kind = tree.joints[joint].kind;
        let law = law(element)?;
        let more = MORE.iter().find(|key| element.attribute(key).is_some_and(|value| value.trim() != "0"));
        let (Some((gain, bias)), true, None) = (law, kind.is_single(), more) else {
            let why = match more {
                Some(key) => format!("its `{key}` has no counterpart"),
                None if kind.is_single() => "its law has no counterpart; write it as `force`".to_owned(),
                None => "it acts on a joint with several coordinates".to_owned(),
            };
            tree.left_out.push(format!("{told}: {why}"));
            continue;
        };
        let gear = element.up_to("gear", 6)?.first().copied().unwrap_or(1.0);
        let limits = |limited: &str, range: &str| -> Result<Option<[f64; 2]>, ImportError> {
            let is_limited = is_limited(element, limited, range, tree.settings)?;
            is_limited.then(|| element.numbers(range, None)).transpose()
        };
        let (control, force) = (limits("ctrllimited", "ctrlrange")?, limits("forcelimited", "forcerange")?);
        if [control, force].into_iter().flatten().any(|[low, high]| low >= high) {
            return Err(element
                .fault(format!("a range of actuator `{name}` is empty"), "the lower limit comes first"));
        }
        let length = gear * tree.references[joint];
        actuators.push(Actuator { name, joint, gear, gain, bias, length, control, force });
    }
    Ok(actuators)
}

/// Gain of the signal, and force by 1, length and speed; None of laws that are not of this form.
fn law(element: &Element) -> Result<Option<(f64, [f64; 3])>, ImportError> {
    let of = |key: &str, default: f64| element.number(key, Some(default));
    Ok(match &*element.tag {
        "motor" => Some((1.0, [0.0; 3])),
        "position" => {
            let (kp, kv) = (of("kp", 1.0)?, of("kv", 0.0)?);
            Some((kp, [0.0, -kp, -kv]))
        }
        "velocity" => {
            let kv = of("kv", 1.0)?;
            Some((kv, [0.0, 0.0, -kv]))
        }
        "general" => {
            let is = |key: &str, word: &str| element.attribute(key).unwrap_or(word) == word;
            let gain = element.up_to("gainprm", 20)?.first().copied().unwrap_or(1.0);
            let mut bias = element.up_to("biasprm", 20)?;
            bias.resize(3, 0.0);
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
