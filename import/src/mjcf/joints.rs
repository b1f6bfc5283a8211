//! `<joint>` elements. In: elements with their defaults. Out: a joint, and its coordinate as drawn. Never knows bodies.

use super::super::error::ImportError;
use super::super::names;
use super::super::place::Place;
use super::super::robot::{Joint, Kind, Spring};
use super::super::xml::Element;
use super::settings::{Settings, is_limited};

/// A joint in a body, or in a frame that is at a place in it; and its coordinate while it is as drawn [rad or m], as the file counts it.
pub fn read(
    element: &Element,
    name: String,
    frame: &Place,
    settings: &Settings,
    left_out: &mut Vec<String>,
) -> Result<(Joint, f64), ImportError> {
    if element.tag == "freejoint" {
        return Ok((plain(name, Kind::Free, [0.0; 3], [0.0; 3]), 0.0));
    }
    let kind = match element.attribute("type").unwrap_or("hinge") {
        "hinge" => Kind::Revolute,
        "slide" => Kind::Prismatic,
        "ball" => Kind::Spherical,
        "free" => Kind::Free,
        other => {
            let message = format!("joint `{name}` is of the type \"{other}\"");
            return Err(element.fault(message, "types are hinge, slide, ball, free"));
        }
    };
    let axis = element.numbers("axis", Some([0.0, 0.0, 1.0]))?;
    if kind.is_single() && axis == [0.0; 3] {
        return Err(element.fault(format!("the axis of joint `{name}` is 0 0 0"), "give its direction"));
    }
    let at = frame.point(element.numbers("pos", Some([0.0; 3]))?);
    // A free joint is at the body's origin, whatever it says.
    let at = if kind == Kind::Free { [0.0; 3] } else { at };
    let mut joint = plain(name, kind, at, frame.direction(axis));
    let reference = passive(element, &mut joint, settings, left_out)?;
    Ok((joint, reference))
}

/// What acts along the coordinate, and its value as drawn.
fn passive(
    element: &Element,
    joint: &mut Joint,
    settings: &Settings,
    left_out: &mut Vec<String>,
) -> Result<f64, ImportError> {
    let name = joint.name.clone();
    // Only angles of hinges are in the unit of angles; the rest is in radians.
    let unit = if joint.kind == Kind::Revolute { settings.angle } else { 1.0 };
    let mut first = |key: &str| -> Result<f64, ImportError> {
        let numbers = element.up_to(key, 8)?;
        if numbers.iter().skip(1).any(|number| *number != 0.0) {
            left_out.push(format!("`{key}` of {name}: a polynomial, of which its first number is here"));
        }
        let value = numbers.first().copied().unwrap_or(0.0);
        if value < 0.0 {
            return Err(element.fault(format!("`{key}` of joint `{name}` is {value}"), "it is 0 or positive"));
        }
        Ok(value)
    };
    let (damping, stiffness, armature, friction) =
        (first("damping")?, first("stiffness")?, first("armature")?, first("frictionloss")?);
    let disabled = &settings.disabled;
    let damping = if disabled.dampers { 0.0 } else { damping };
    let stiffness = if disabled.springs { 0.0 } else { stiffness };
    let reference = unit * element.number("ref", Some(0.0))?;
    let rest = unit * element.number("springref", Some(0.0))? - reference;
    let mut lose = |what: &str| left_out.push(format!("{what} of {name}"));
    match joint.kind {
        Kind::Free => {
            for (key, value) in [("damping", damping), ("stiffness", stiffness), ("armature", armature)] {
                if value > 0.0 {
                    lose(&format!("`{key}`"));
                }
            }
            return Ok(0.0);
        }
        Kind::Spherical if armature > 0.0 => lose("`armature`, of a ball,"),
        _ => joint.armature = armature,
    }
    joint.damping = damping;
    if stiffness > 0.0 {
        let rest = if joint.kind.is_single() { rest } else { 0.0 };
        joint.spring = Some(Spring { stiffness, rest });
    }
    let (force, speed, length) = match joint.kind {
        Kind::Prismatic => ("N", "m/s", "m"),
        _ => ("N m", "rad/s", "rad"),
    };
    if friction > 0.0 && joint.kind.is_single() {
        left_out.push(format!("friction of {name}: a law that jumps at rest; write a smooth one as `force`, such as \"-{friction} {force}*tanh({}.v/(0.01 {speed}))\"", names::plain(&name)));
    } else if friction > 0.0 {
        lose("`frictionloss`");
    }
    for key in ["springdamper", "springyield"] {
        if element.up_to(key, 8)?.iter().any(|number| *number != 0.0) {
            left_out.push(format!("`{key}` of {name}"));
        }
    }
    if is_limited(element, "limited", "range", settings)? {
        let [low, high] = element.numbers("range", None)?;
        if joint.kind.is_single() {
            let [low, high] = [low, high].map(|limit| unit * limit - reference);
            joint.remarks.push(format!("limits: {low} to {high} {length}"));
        } else {
            joint.remarks.push(format!("limit: {} rad from where it is drawn", settings.angle * high));
        }
    }
    // MuJoCo knows no such limit of balls and free joints.
    if joint.kind.is_single() && is_limited(element, "actuatorfrclimited", "actuatorfrcrange", settings)? {
        let [low, high] = element.numbers("actuatorfrcrange", None)?;
        if low >= high {
            let message = format!("`actuatorfrcrange` of joint `{name}` is empty");
            return Err(element.fault(message, "the lower limit comes first"));
        }
        joint.actuated = Some([low, high]);
    }
    if joint.kind.is_single() && reference != 0.0 {
        joint.remarks.push(format!("as drawn is {reference} {length} in the file it is from, 0 here"));
    }
    Ok(if joint.kind.is_single() { reference } else { 0.0 })
}

/// A joint that nothing acts on.
pub fn plain(name: String, kind: Kind, at: [f64; 3], axis: [f64; 3]) -> Joint {
    Joint {
        name,
        kind,
        parent: 0,
        child: 0,
        place: Place::default(),
        at,
        axis,
        damping: 0.0,
        spring: None,
        armature: 0.0,
        actuated: None,
        follows: None,
        held: None,
        remarks: Vec::new(),
    }
}
