//! Actuators that push along joint coordinates. In: elements and joints. Out: a law of each, over a signal from outside. Never knows text.

use super::super::error::ImportError;
use super::super::robot::Actuator;
use super::super::xml::Element;
use super::bodies::Tree;
use super::laws::law;
use super::settings::is_limited;

/// Attributes that make more of an actuator than a force by signal, coordinate and speed.
const MORE: [&str; 8] =
    ["timeconst", "dampratio", "inheritrange", "delay", "nsample", "actlimited", "armature", "damping"];

/// Reads them; what acts otherwise is told.
pub fn read(root: &Element, tree: &mut Tree<'_>) -> Result<Vec<Actuator>, ImportError> {
    let mut actuators: Vec<Actuator> = Vec::new();
    for element in root.all("actuator").flat_map(|actuator| &actuator.children) {
        let element = &tree.classes.applied(element, None)?;
        if tree.settings.disabled.actuation {
            // Told of all by its flag.
            continue;
        }
        let number = actuators.len() + 1;
        let name = element.attribute("name").map_or_else(|| format!("actuator_{number}"), str::to_owned);
        let told = format!("<{}> {name}", element.tag);
        let group = element.number("group", Some(0.0))?;
        if tree.settings.disabled.groups.contains(&group) {
            tree.left_out.push(format!("{told}: its group {group} is disabled"));
            continue;
        }
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
        let control = control.filter(|_| !tree.settings.disabled.clamps);
        if [control, force].into_iter().flatten().any(|[low, high]| low >= high) {
            return Err(element
                .fault(format!("a range of actuator `{name}` is empty"), "the lower limit comes first"));
        }
        let length = gear * tree.references[joint];
        actuators.push(Actuator { name, joint, gear, gain, bias, length, control, force });
    }
    Ok(actuators)
}
