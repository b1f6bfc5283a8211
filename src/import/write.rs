//! A robot as a mechanism file. In: links, joints, bodies. Out: TOML. Never knows the format they came from.

use std::fmt::Write as _;

use super::imported::Imported;
use super::inertia::Bodies;
use super::names::Names;
use super::robot::{Base, Joint, Kind, Robot};

/// The file.
pub fn written(robot: &Robot, bodies: &Bodies, base: Base, mut left_out: Vec<String>) -> Imported {
    let mut names = Names::default();
    let mut named = |wanted: &str, what: &str| {
        let name = names.fresh(wanted);
        if name != wanted {
            left_out.push(format!("the name of the {what} `{wanted}`: it is `{name}` here"));
        }
        name
    };
    let name = Names::default().fresh(&robot.name);
    let held = usize::from(base == Base::Fixed);
    let body_names: Vec<String> = bodies
        .bodies
        .iter()
        .enumerate()
        .map(
            |(at, body)| {
                if at < held { "ground".to_owned() } else { named(&robot.links[body.first].name, "link") }
            },
        )
        .collect();
    let places = robot.places();
    let body_of = |link: usize| bodies.of_link[link].map(|body| &*body_names[body]);
    let moving: Vec<(&Joint, String, String)> = robot
        .joints
        .iter()
        .filter(|joint| joint.kind != Kind::Fixed && bodies.of_link[joint.child].is_some())
        .map(|joint| (joint, named(&joint.name, "joint")))
        .map(|(joint, name)| (joint, name.clone(), name))
        .collect();
    let moving: Vec<(&Joint, String, String)> =
        moving.into_iter().map(|(joint, name, at)| (joint, name, names.fresh(&format!("{at}_at")))).collect();
    let mut text = format!(
        "spec = 1\nname = \"{name}\"\n# Reference pose: all joint coordinates 0, in the frame of link {}.\ngravity = [0, 0, \"-9.81 m/s^2\"]\n\n[points]\n",
        comment(&robot.links[robot.root].name)
    );
    let base_at = names.fresh("base_at");
    if base == Base::Floating {
        let _ = writeln!(text, "{base_at} = [0, 0, 0]");
    }
    for (joint, _, at) in &moving {
        let _ = writeln!(text, "{at} = {}", vector(places[joint.child].origin, " m"));
    }
    text.push_str("\n[bodies]\n");
    for (body, name) in bodies.bodies.iter().zip(&body_names).skip(held) {
        let Some(mass) = body.mass else { continue };
        let i = mass.inertia;
        let entries = [i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]];
        let _ = writeln!(
            text,
            "{name} = {{ mass = \"{} kg\", centre = {}, inertia = {} }}",
            mass.mass,
            vector(mass.centre, " m"),
            vector(entries, " kg m^2")
        );
    }
    text.push_str("\n[joints]\n");
    if base == Base::Floating {
        let _ = writeln!(
            text,
            "{} = {{ free = [\"ground\", \"{}\"], at = \"{base_at}\" }}",
            names.fresh("base"),
            body_names[0]
        );
    }
    for (joint, name, at) in &moving {
        let (Some(parent), Some(child)) = (body_of(joint.parent), body_of(joint.child)) else { continue };
        for remark in &joint.remarks {
            let _ = writeln!(text, "# {} {remark}", comment(&joint.name));
        }
        let kind = match joint.kind {
            Kind::Revolute => "revolute",
            Kind::Prismatic => "prismatic",
            Kind::Planar => "planar",
            Kind::Free | Kind::Fixed => "free",
        };
        let mut keys = format!("{kind} = [\"{parent}\", \"{child}\"], at = \"{at}\"");
        if joint.kind != Kind::Free {
            let axis = places[joint.child].direction(joint.axis);
            let _ = write!(keys, ", axis = {}", vector(axis, ""));
        }
        if joint.damping > 0.0 {
            let unit = if joint.kind == Kind::Revolute { "N m s/rad" } else { "N s/m" };
            let _ = write!(keys, ", damping = \"{} {unit}\"", joint.damping);
        }
        let _ = writeln!(text, "{name} = {{ {keys} }}");
    }
    text.push_str(&couplings(robot, &moving, &mut names, &mut left_out));
    let limited = moving.iter().filter(|(joint, ..)| !joint.remarks.is_empty()).count();
    if limited > 0 {
        left_out.push(format!("limits of {limited} joint(s): they stand as comments, nothing stops there"));
    }
    left_out.push("gravity: the format has none; the file has 9.81 m/s^2 downwards along z".to_owned());
    let joints = moving.len() + usize::from(base == Base::Floating);
    Imported { name, text, bodies: bodies.bodies.len() - held, joints, left_out }
}

/// Joints that follow others, as relations.
fn couplings(
    robot: &Robot,
    moving: &[(&Joint, String, String)],
    names: &mut Names,
    left_out: &mut Vec<String>,
) -> String {
    let mut text = String::new();
    for (joint, name, _) in moving {
        let Some(follows) = &joint.follows else { continue };
        let leader = &robot.joints[follows.leader];
        let Some((_, leader_name, _)) = moving.iter().find(|(other, ..)| other.name == leader.name) else {
            left_out.push(format!("mimic of {}: {} is left out, so it moves alone", joint.name, leader.name));
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
        let mut keys = format!("relation = {{ {name} = 1, {leader_name} = {factor} }}");
        if follows.plus != 0.0 {
            let _ = write!(keys, ", offset = \"{:?} {own}\"", follows.plus);
        }
        let _ = writeln!(text, "{} = {{ {keys} }}", names.fresh(&format!("{name}_follows")));
    }
    if text.is_empty() { text } else { format!("\n[couplings]\n{text}") }
}

/// On one line.
fn comment(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

/// In TOML, with a unit or without; 0 needs none.
fn vector<const N: usize>(values: [f64; N], unit: &str) -> String {
    let entry = |value: &f64| match (*value == 0.0, unit.is_empty()) {
        (true, _) => "0".to_owned(),
        (_, true) => format!("{value:?}"),
        _ => format!("\"{value:?}{unit}\""),
    };
    format!("[{}]", values.iter().map(entry).collect::<Vec<_>>().join(", "))
}
