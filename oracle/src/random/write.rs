//! A random plan as TOML, one function per table. What the format calls things is said here only.
//! In: a plan and dice for the numbers. Out: text. Never knows mechanics beyond what numbers make sense.

use std::fmt::Write as _;

use super::dice::Dice;
use super::plan::{Plan, PlannedJoint};
use super::recipe::Recipe;
use crate::kind::Kind;

/// Half the edge of the cube in which points are drawn [m].
const ROOM: f64 = 0.6;
/// Shortest rod [m].
const SHORTEST: f64 = 0.15;

pub fn mechanism(recipe: &Recipe, plan: &Plan, dice: &mut Dice) -> String {
    let mut text = String::new();
    header(recipe, dice, &mut text);
    parameters(dice, &mut text);
    let shapes = points(recipe, plan, dice, &mut text);
    bodies(&shapes, dice, &mut text);
    joints(recipe, plan, dice, &mut text);
    if recipe.forces {
        forces(recipe, dice, &mut text);
    }
    starts(plan, dice, &mut text);
    text
}

fn line(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{arguments}");
}

/// A number with at most four decimals.
fn short(x: f64) -> f64 {
    (x * 1e4).round() / 1e4
}

fn vector(v: [f64; 3], unit: &str) -> String {
    let [x, y, z] = v.map(|c| format!("\"{:?}{unit}\"", short(c)));
    format!("[{x}, {y}, {z}]")
}

fn direction(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(short);
    format!("[{x:?}, {y:?}, {z:?}]")
}

/// Main axes of joints. Now and then one of the ground frame, because the generator treats zeros and ones
/// specially; but each only once, because parallel axes in a loop may lock it or let a part idle.
fn random_axis(spare: &mut Vec<usize>, dice: &mut Dice) -> [f64; 3] {
    if dice.chance(0.3) && !spare.is_empty() {
        let mut v = [0.0; 3];
        v[spare.swap_remove(dice.below(spare.len()))] = if dice.chance(0.5) { 1.0 } else { -1.0 };
        return v;
    }
    loop {
        let v = dice.point(1.0);
        if v.iter().map(|c| c * c).sum::<f64>() > 0.1 {
            return v;
        }
    }
}

/// A direction at right angles to `v`, exact in the four decimals that are written.
fn at_right_angles(v: [f64; 3], dice: &mut Dice) -> [f64; 3] {
    let [x, y, z] = v;
    let choices: Vec<[f64; 3]> = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
        .into_iter()
        .filter(|w| w.iter().any(|c| c.abs() > 1e-3))
        .collect();
    *dice.pick(&choices)
}

fn header(recipe: &Recipe, dice: &mut Dice, text: &mut String) {
    line(text, format_args!("spec = 1\nname = \"random_{}\"", recipe.seed));
    line(text, format_args!("gravity = {}", vector(dice.point(9.81), " m/s^2")));
}

fn parameters(dice: &mut Dice, text: &mut String) {
    line(text, format_args!("\n[parameters]"));
    line(text, format_args!("rho = \"{:?} kg/m^3\"", short(dice.between(1e3, 8e3))));
    line(text, format_args!("r = \"{:?} mm\"", short(dice.between(4.0, 12.0))));
    let pace = short(dice.between(0.5, 3.0));
    line(text, format_args!("pace = {{ value = \"{pace:?} Hz\", tunable = true }}"));
    let stiff = short(dice.between(1.0, 6.0));
    line(text, format_args!("stiff = {{ value = \"{stiff:?} N m\", tunable = true }}"));
    let drag = short(dice.between(0.01, 0.2));
    line(text, format_args!("drag = {{ value = \"{drag:?} N m s\", tunable = true, assumed = true }}"));
}

/// Writes joint points `p..`, body tips `e..` and force points `f..`; returns the points of each body.
fn points(recipe: &Recipe, plan: &Plan, dice: &mut Dice, text: &mut String) -> Vec<[String; 2]> {
    line(text, format_args!("\n[points]"));
    let mut places = Vec::new();
    for joint in &plan.joints {
        let place = dice.point(ROOM);
        line(text, format_args!("p_{} = {}", joint.name, vector(place, " m")));
        places.push(place);
    }
    let mut shapes = Vec::new();
    for (body, start) in places.iter().enumerate().take(recipe.bodies) {
        let tip = loop {
            let tip = dice.point(ROOM);
            let square: f64 = tip.iter().zip(start).map(|(a, b)| (a - b) * (a - b)).sum();
            if square > SHORTEST * SHORTEST {
                break tip;
            }
        };
        line(text, format_args!("e{body} = {{ at = {}, on = \"b{body}\" }}", vector(tip, " m")));
        shapes.push([format!("p_j{body}"), format!("e{body}")]);
    }
    shapes
}

fn bodies(shapes: &[[String; 2]], dice: &mut Dice, text: &mut String) {
    line(text, format_args!("\n[bodies]"));
    for (body, [start, tip]) in shapes.iter().enumerate() {
        let ends = format!("[\"{start}\", \"{tip}\"]");
        let shape = match dice.below(4) {
            0 => format!("rod = {ends}, radius = \"r\", density = \"rho\""),
            1 => format!("tube = {ends}, radius = \"2*r\", inner_radius = \"r\", density = \"rho\""),
            2 => format!("rod = {ends}, radius = \"3*r\", mass = \"{:?} kg\"", short(dice.between(0.3, 2.0))),
            _ => {
                let mass = short(dice.between(0.3, 2.0));
                // Between 1 and 1.5 each, so that no sum of two is below the third.
                let [xx, yy, zz] = [0; 3].map(|_| short(0.05 * mass * dice.between(1.0, 1.5)));
                let [xy, xz, yz] = [0; 3].map(|_| short(0.005 * mass * dice.between(-1.0, 1.0)));
                let inertia = [xx, yy, zz, xy, xz, yz].map(|x| format!("\"{x:?} kg m^2\"")).join(", ");
                format!("mass = \"{mass:?} kg\", centre = \"{tip}\", inertia = [{inertia}]")
            }
        };
        line(text, format_args!("b{body} = {{ {shape} }}"));
    }
}

fn joints(recipe: &Recipe, plan: &Plan, dice: &mut Dice, text: &mut String) {
    line(text, format_args!("\n[joints]"));
    let mut spare = vec![0, 1, 2];
    for joint in &plan.joints {
        let name = |body: Option<usize>| body.map_or_else(|| "ground".to_owned(), |b| format!("b{b}"));
        let (inner, outer) = (name(joint.inner), name(Some(joint.outer)));
        let pair = if joint.reversed { [outer, inner] } else { [inner, outer] };
        let mut keys = format!("{} = {pair:?}, at = \"p_{}\"", joint.kind.key(), joint.name);
        keys += &geometry(joint.kind, &mut spare, dice);
        // The generator cuts loops where it likes, or here; never at a driven joint.
        if joint.name.starts_with("close") && joint.drive.is_none() && dice.chance(0.5) {
            keys += ", cut = true";
        }
        if let Some(coordinate) = joint.drive {
            keys += &drive(joint, coordinate, dice);
        }
        if recipe.forces {
            keys += &passive(joint, dice);
        }
        line(text, format_args!("{} = {{ {keys} }}", joint.name));
    }
}

fn geometry(kind: Kind, spare: &mut Vec<usize>, dice: &mut Dice) -> String {
    if matches!(kind, Kind::Spherical | Kind::Fixed | Kind::Free) {
        return String::new();
    }
    let main = random_axis(spare, dice);
    match kind {
        Kind::Revolute | Kind::Prismatic | Kind::Cylindrical | Kind::Inline => {
            format!(", axis = {}", direction(main))
        }
        Kind::Screw => {
            let lead = short(dice.between(40.0, 200.0)) * if dice.chance(0.5) { 1.0 } else { -1.0 };
            format!(", axis = {}, lead = \"{lead:?} mm\"", direction(main))
        }
        Kind::Universal => {
            let other = at_right_angles(main, dice);
            format!(", axes = [{}, {}]", direction(main), direction(other))
        }
        Kind::Planar | Kind::Slot | Kind::Inplane => {
            let first = at_right_angles(main, dice);
            format!(", axis = {}, first = {}", direction(main), direction(first))
        }
        Kind::Spherical | Kind::Fixed | Kind::Free | Kind::Distance | Kind::OnSurface => String::new(),
    }
}

/// Values by coordinate: plain for a single one, a table otherwise.
fn by_coordinate(values: &[(usize, String)], count: usize) -> String {
    if count == 1 {
        return values[0].1.clone();
    }
    let parts: Vec<String> = values.iter().map(|(k, value)| format!("q{} = {value}", k + 1)).collect();
    format!("{{ {} }}", parts.join(", "))
}

/// A law that is zero at t = 0: there the loops are closed.
fn drive(joint: &PlannedJoint, coordinate: usize, dice: &mut Dice) -> String {
    let angle = joint.kind.coordinates()[coordinate];
    let size = if angle { "0.5 rad" } else { "50 mm" };
    let law =
        *dice.pick(&["sin(pace*t)", "(1 - cos(2*pace*t))", "tanh(pace*t)", "(pace*t)^2/(1 + (pace*t)^2)"]);
    let value = format!("\"{size}*{law}\"");
    format!(", drive = {}", by_coordinate(&[(coordinate, value)], joint.kind.coordinates().len()))
}

fn passive(joint: &PlannedJoint, dice: &mut Dice) -> String {
    let coordinates = joint.kind.coordinates();
    let count = coordinates.len();
    if joint.kind == Kind::Spherical && dice.chance(0.5) {
        return ", friction = \"drag\"".to_owned();
    }
    if count == 0 {
        return String::new();
    }
    // Per metre where the coordinate is a length.
    let scaled = |value: &str, angle: bool| {
        if angle { format!("\"{value}\"") } else { format!("\"{value}/(0.1 m)^2\"") }
    };
    let each = |form: &dyn Fn(bool) -> String| -> Vec<(usize, String)> {
        coordinates.iter().enumerate().map(|(k, angle)| (k, form(*angle))).collect()
    };
    let mut keys = String::new();
    if dice.chance(0.5) {
        keys += &format!(", damping = {}", by_coordinate(&each(&|angle| scaled("drag", angle)), count));
    }
    if dice.chance(0.4) {
        let spring = |angle: bool| {
            let rest = if angle { "0.2 rad" } else { "20 mm" };
            format!("{{ stiffness = {}, rest = \"{rest}\" }}", scaled("stiff", angle))
        };
        keys += &format!(", spring = {}", by_coordinate(&each(&spring), count));
    }
    if dice.chance(0.4) {
        let force = |angle: bool| {
            if angle { "\"0.3 N m*cos(3*pace*t)\"".to_owned() } else { "\"2 N*cos(3*pace*t)\"".to_owned() }
        };
        keys += &format!(", force = {}", by_coordinate(&each(&force), count));
    }
    keys
}

fn forces(recipe: &Recipe, dice: &mut Dice, text: &mut String) {
    line(text, format_args!("\n[forces]"));
    let two = |dice: &mut Dice| {
        let a = dice.below(recipe.bodies);
        let b = (a + 1 + dice.below(recipe.bodies - 1)) % recipe.bodies;
        (a, b)
    };
    let (a, b) = two(dice);
    line(
        text,
        format_args!(
            "tie = {{ spring = [\"b{a}\", \"b{b}\"], at = [\"e{a}\", \"e{b}\"], stiffness = \"40 N/m\", \
             length = \"0.3 m\", damping = \"1.5 N s/m\", preload = \"2 N\" }}"
        ),
    );
    line(
        text,
        format_args!(
            "mount = {{ bushing = [\"b{a}\", \"b{b}\"], at = \"e{a}\", directions = [[3, 4, 0], [-4, 3, 0]], \
             translation = {{ stiffness = [\"30 N/m\", \"12 N/m\", \"7 N/m\"], damping = [\"0.3 N s/m\", 0, \"0.4 N s/m\"] }}, \
             rotation = {{ stiffness = [\"stiff\", \"2*stiff\", 0], damping = [\"drag\", 0, \"drag\"] }} }}"
        ),
    );
    let (a, b) = two(dice);
    let components = format!("[\"3 N*cos(pace*t)\", \"-2 N*tanh(e{a}.vy/(1 m/s))\", \"4 N*e{a}.x/(1 m)\"]");
    line(
        text,
        format_args!(
            "push = {{ force = \"b{a}\", at = \"e{a}\", components = {components}, axes = \"b{b}\", \
             reaction = \"b{b}\" }}"
        ),
    );
    let (a, _) = two(dice);
    line(
        text,
        format_args!(
            "twist = {{ torque = \"b{a}\", components = [\"0.2 N m\", \"0.3 N m*sin(pace*t)\", 0], \
             axes = \"b{a}\" }}"
        ),
    );
}

/// Free coordinates of trees start somewhere; loops start from the reference pose, where they are closed.
fn starts(plan: &Plan, dice: &mut Dice, text: &mut String) {
    line(text, format_args!("\n[initial]"));
    for joint in plan.joints.iter().filter(|joint| joint.ring.is_none()) {
        let coordinates = joint.kind.coordinates();
        let mut values = Vec::new();
        for (k, angle) in coordinates.iter().enumerate().filter(|(k, _)| joint.drive != Some(*k)) {
            // With the rotation vector, an inline joint starts from several values.
            let several = coordinates.len() > 1 || joint.kind.is_round();
            let suffix = if several { (k + 1).to_string() } else { String::new() };
            let unit = if *angle { "rad" } else { "m" };
            let reach = if *angle { 1.0 } else { 0.1 };
            let q = short(dice.between(-reach, reach));
            let v = short(dice.between(-2.0 * reach, 2.0 * reach));
            values.push(format!("q{suffix} = \"{q:?} {unit}\", v{suffix} = \"{v:?} {unit}/s\""));
        }
        if !values.is_empty() {
            line(text, format_args!("{} = {{ {} }}", joint.name, values.join(", ")));
        }
    }
}
