//! Joints that follow others, as relations. In: a robot and the names of its joints. Out: TOML.

use std::fmt::Write as _;

use super::super::names::Names;
use super::super::robot::{Kind, Robot};
use super::joint::Written;

/// The table of couplings; empty without any.
pub fn written(
    robot: &Robot,
    moving: &[Written<'_>],
    names: &mut Names,
    left_out: &mut Vec<String>,
) -> String {
    let mut text = String::new();
    for Written { joint, name, .. } in moving {
        let Some(follows) = &joint.follows else { continue };
        let leader = &robot.joints[follows.leader];
        let Some(leads) = moving.iter().find(|other| other.number == follows.leader) else {
            left_out
                .push(format!("what {} follows: {} is left out, so it moves alone", joint.name, leader.name));
            continue;
        };
        // The sum is in the unit of the follower, so the factor turns the leader's unit into it.
        let (own, per) = match (joint.kind, leader.kind) {
            (Kind::Revolute, Kind::Prismatic) => ("rad", " 1/m"),
            (Kind::Prismatic, Kind::Revolute) => ("m", " m"),
            (Kind::Revolute, _) => ("rad", ""),
            _ => ("m", ""),
        };
        let factor = match per {
            "" => format!("{:?}", -follows.times),
            unit => format!("\"{:?}{unit}\"", -follows.times),
        };
        let mut keys = format!("relation = {{ {name} = 1, {} = {factor} }}", leads.name);
        if follows.plus != 0.0 {
            let _ = write!(keys, ", offset = \"{:?} {own}\"", follows.plus);
        }
        let _ = writeln!(text, "{} = {{ {keys} }}", names.fresh(&format!("{name}_follows")));
    }
    if text.is_empty() { text } else { format!("\n[couplings]\n{text}") }
}
