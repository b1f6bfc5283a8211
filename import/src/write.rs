//! A robot as a mechanism file. In: links, joints, bodies. Out: TOML. Never knows the format they came from.

mod actuators;
mod couplings;
mod joint;

use std::fmt::Write as _;

use super::imported::Imported;
use super::inertia::Bodies;
use super::mass::{Mass, diagonal_matrix};
use super::names::Names;
use super::robot::{Base, Closure, Joint, Kind, Robot};
use joint::Written;

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
    let moves = |joint: &Joint| joint.kind != Kind::Fixed && bodies.of_link[joint.child].is_some();
    let moving: Vec<(usize, &Joint, String)> = robot
        .joints
        .iter()
        .enumerate()
        .filter(|(_, joint)| moves(joint))
        .map(|(number, joint)| (number, joint, named(&joint.name, "joint")))
        .collect();
    let moving: Vec<Written<'_>> = moving
        .into_iter()
        .map(|(number, joint, name)| Written { joint, number, at: names.fresh(&format!("{name}_at")), name })
        .collect();
    let closing = closing(robot, bodies, &mut names, &mut left_out);
    let laws = actuators::written(robot, &moving, &mut names, &mut left_out);
    let root = comment(&robot.links[robot.root].name);
    let gravity = robot.gravity.unwrap_or([0.0, 0.0, -9.81]);
    let mut text = format!(
        "spec = 1\nname = \"{name}\"\n# Reference pose: all joint coordinates 0, in the frame of link {root}.\ngravity = {}\n{}\n[points]\n",
        vector(gravity, " m/s^2"),
        laws.inputs
    );
    let base_at = names.fresh("base_at");
    if base == Base::Floating {
        let _ = writeln!(text, "{base_at} = [0, 0, 0]");
    }
    for Written { joint, at, .. } in &moving {
        let _ = writeln!(text, "{at} = {}", vector(places[joint.child].point(joint.at), " m"));
    }
    for (closure, name, at) in &closing {
        let of = |side: usize| places[closure.links[side]].point(closure.at[side]);
        let (a, b) = (of(0), of(1));
        // Rounding of the frames along both ways.
        let size = a.iter().chain(&b).fold(1.0, |size: f64, x| size.max(x.abs()));
        let _ = match (0..3).all(|i| (a[i] - b[i]).abs() < 1e-9 * size) {
            true => writeln!(text, "{at} = {}", vector(a, " m")),
            false => {
                let side = |side: usize| body_of(closure.links[side]).unwrap_or("ground");
                let _ = writeln!(text, "# {name} is open as drawn; assembly closes it.");
                let (first, second) = (vector(a, " m"), vector(b, " m"));
                writeln!(text, "{at} = {{ {} = {first}, {} = {second} }}", side(0), side(1))
            }
        };
    }
    text.push_str("\n[bodies]\n");
    for (body, name) in bodies.bodies.iter().zip(&body_names).skip(held) {
        let keys = match body.mass {
            Some(mass) => mass_keys(&mass),
            None => {
                let own = moving.iter().find(|one| one.joint.child == body.first);
                format!("massless = true, centre = \"{}\"", own.map_or("", |one| &one.at))
            }
        };
        let _ = writeln!(text, "{name} = {{ {keys} }}");
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
    for one in &moving {
        let joint = one.joint;
        let (Some(parent), Some(child)) = (body_of(joint.parent), body_of(joint.child)) else { continue };
        for remark in &joint.remarks {
            let _ = writeln!(text, "# {} {remark}", comment(&joint.name));
        }
        let mut keys = format!("{} = [\"{parent}\", \"{child}\"], at = \"{}\"", kind(joint.kind), one.at);
        if !matches!(joint.kind, Kind::Free | Kind::Spherical) {
            let axis = places[joint.child].direction(joint.axis);
            let _ = write!(keys, ", axis = {}", vector(axis, ""));
        }
        keys.push_str(&passive(joint));
        if let Some(force) = &laws.forces[one.number] {
            let _ = write!(keys, ", force = \"{force}\"");
        }
        let _ = writeln!(text, "{} = {{ {keys} }}", one.name);
    }
    for (closure, name, at) in &closing {
        let [Some(first), Some(second)] = closure.links.map(body_of) else { continue };
        let kind = kind(closure.kind);
        let _ =
            writeln!(text, "{name} = {{ {kind} = [\"{first}\", \"{second}\"], at = \"{at}\", cut = true }}");
    }
    text.push_str(&couplings::written(robot, &moving, &mut names, &mut left_out));
    let is_limit = |remark: &String| remark.starts_with("limit");
    let limited = moving.iter().filter(|one| one.joint.remarks.iter().any(is_limit)).count();
    if limited > 0 {
        left_out.push(format!("limits of {limited} joint(s): they stand as comments, nothing stops there"));
    }
    if robot.gravity.is_none() {
        left_out.push("gravity: the format has none; the file has 9.81 m/s^2 downwards along z".to_owned());
    }
    let joints = moving.len() + closing.len() + usize::from(base == Base::Floating);
    Imported { name, text, bodies: bodies.bodies.len() - held, joints, left_out }
}

/// Joints that close loops, each with its name and that of its point.
fn closing<'a>(
    robot: &'a Robot,
    bodies: &Bodies,
    names: &mut Names,
    left_out: &mut Vec<String>,
) -> Vec<(&'a Closure, String, String)> {
    let mut closing = Vec::new();
    for closure in &robot.closures {
        let [first, second] = closure.links.map(|link| bodies.of_link[link]);
        if first == second || first.is_none() || second.is_none() {
            left_out.push(format!("<{}> {}: it holds nothing that moves", closure.what, closure.name));
            continue;
        }
        let name = names.fresh(&closure.name);
        let at = names.fresh(&format!("{name}_at"));
        closing.push((closure, name, at));
    }
    closing
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Revolute => "revolute",
        Kind::Prismatic => "prismatic",
        Kind::Planar => "planar",
        Kind::Spherical => "spherical",
        Kind::Free => "free",
        Kind::Fixed => "fixed",
    }
}

/// Damper, spring and what holds a joint.
fn passive(joint: &Joint) -> String {
    let mut keys = String::new();
    let (per_speed, per_way, unit) = match joint.kind {
        Kind::Prismatic => ("N s/m", "N/m", "m"),
        _ => ("N m s/rad", "N m/rad", "rad"),
    };
    if joint.damping > 0.0 {
        let _ = write!(keys, ", damping = \"{} {per_speed}\"", joint.damping);
    }
    if let Some(spring) = joint.spring {
        let _ = write!(keys, ", spring = {{ stiffness = \"{:?} {per_way}\"", spring.stiffness);
        if spring.rest != 0.0 {
            let _ = write!(keys, ", rest = \"{:?} {unit}\"", spring.rest);
        }
        keys.push_str(" }");
    }
    if let Some(held) = joint.held {
        let _ = write!(keys, ", drive = \"{held:?} {unit}\"");
    }
    keys
}

/// Keys of a body.
pub fn mass_keys(mass: &Mass) -> String {
    let i = mass.inertia;
    let entries = [i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]];
    let mut keys = format!("mass = \"{} kg\", centre = {}", mass.mass, vector(mass.centre, " m"));
    if mass.inertia != diagonal_matrix([0.0; 3]) {
        let _ = write!(keys, ", inertia = {}", vector(entries, " kg m^2"));
    }
    keys
}

/// On one line.
pub fn comment(text: &str) -> String {
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
