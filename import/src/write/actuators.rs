//! What pushes along joint coordinates by formula: actuators over signals from outside, and the inertia of rotors. In: a robot and the
//! names of its joints. Out: inputs as TOML, a formula for each joint.

use std::fmt::Write as _;

use super::super::names::Names;
use super::super::robot::{Actuator, Kind, Robot};
use super::joint::Written;

/// What is written of them.
pub struct Laws {
    /// The table of inputs; empty without any.
    pub inputs: String,
    /// By joint of the robot.
    pub forces: Vec<Option<String>>,
}

/// Laws of all joints.
pub fn written(robot: &Robot, moving: &[Written<'_>], names: &mut Names, left_out: &mut Vec<String>) -> Laws {
    let mut inputs = String::new();
    let mut forces: Vec<Option<String>> = vec![None; robot.joints.len()];
    let mut add = |joint: usize, term: String| {
        forces[joint] = Some(match forces[joint].take() {
            Some(before) => format!("{before} + {term}"),
            None => term,
        });
    };
    for one in moving {
        if one.joint.armature > 0.0 {
            let unit = if one.joint.kind == Kind::Prismatic { "kg" } else { "kg m^2" };
            add(one.number, format!("-({:?} {unit})*{}.a", one.joint.armature, one.name));
        }
    }
    let mut sums: Vec<Vec<String>> = vec![Vec::new(); robot.joints.len()];
    for actuator in &robot.actuators {
        let Some(one) = moving.iter().find(|one| one.number == actuator.joint) else {
            left_out.push(format!("the actuator {}: its joint is left out", actuator.name));
            continue;
        };
        let wanted = match actuator.name == one.joint.name {
            true => format!("{}_signal", one.name),
            false => actuator.name.clone(),
        };
        let input = names.fresh(&wanted);
        if input != actuator.name {
            left_out
                .push(format!("the name of the actuator `{}`: its input is `{input}` here", actuator.name));
        }
        let (unit, force) = law(actuator, one.joint.kind, &one.name, &input);
        let _ = writeln!(inputs, "{input} = {{ default = 0, unit = \"{unit}\" }}");
        sums[one.number].push(force);
    }
    for one in moving {
        let sum = sums[one.number].join(" + ");
        match one.joint.actuated {
            Some(_) if sum.is_empty() => left_out.push(format!(
                "`actuatorfrcrange` of {}: no actuator that is carried over acts on it",
                one.joint.name
            )),
            _ if sum.is_empty() => {}
            limits => add(one.number, clamped(sum, limits, units(one.joint.kind)[0])),
        }
    }
    if !inputs.is_empty() {
        inputs = format!("\n# Signals of actuators.\n[inputs]\n{inputs}");
    }
    Laws { inputs, forces }
}

/// Units of a force along a coordinate, of its springs and dampers, of the coordinate and its speed.
fn units(kind: Kind) -> [&'static str; 5] {
    match kind {
        Kind::Prismatic => ["N", "N/m", "N s/m", "m", "m/s"],
        _ => ["N m", "N m/rad", "N m s/rad", "rad", "rad/s"],
    }
}

fn clamped(inner: String, limits: Option<[f64; 2]>, unit: &str) -> String {
    match limits {
        Some([low, high]) => format!("clamp({inner}, {low:?} {unit}, {high:?} {unit})"),
        None => inner,
    }
}

/// The unit of an actuator's signal, and its force along the coordinate.
fn law(actuator: &Actuator, kind: Kind, joint: &str, input: &str) -> (&'static str, String) {
    let Actuator { gear, gain, bias: [constant, by_way, by_speed], .. } = *actuator;
    let [force, per_way, per_speed, way, speed] = units(kind);
    // A signal that is compared with the coordinate or its speed is one of them.
    let (unit, of_gain) = if by_way != 0.0 && gain == -by_way {
        (way, per_way)
    } else if by_way == 0.0 && by_speed != 0.0 && gain == -by_speed {
        (speed, per_speed)
    } else {
        (force, "")
    };
    let factor = |value: f64, unit: &str| match unit {
        "" => format!("({value:?})"),
        unit => format!("({value:?} {unit})"),
    };
    let signal = clamped(input.to_owned(), actuator.control, unit);
    let mut sum = match (gain == 1.0, of_gain) {
        (true, "") => signal,
        _ => format!("{}*{signal}", factor(gain, of_gain)),
    };
    if constant != 0.0 {
        let _ = write!(sum, " + {}", factor(constant, force));
    }
    let geared =
        |of: &str| if gear == 1.0 { format!("{joint}.{of}") } else { format!("{gear:?}*{joint}.{of}") };
    if by_way != 0.0 {
        let way_now = match actuator.length == 0.0 {
            true => geared("q"),
            false => format!("({} + {:?} {way})", geared("q"), actuator.length),
        };
        let _ = write!(sum, " + {}*{way_now}", factor(by_way, per_way));
    }
    if by_speed != 0.0 {
        let _ = write!(sum, " + {}*{}", factor(by_speed, per_speed), geared("v"));
    }
    let felt = match actuator.force {
        None if sum.contains(" + ") => format!("({sum})"),
        limits => clamped(sum, limits, force),
    };
    (unit, if gear == 1.0 { felt } else { format!("({gear:?})*{felt}") })
}
