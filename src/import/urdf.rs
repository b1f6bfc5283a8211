//! URDF: <https://wiki.ros.org/urdf/XML>. In: its text. Out: a robot, and what is left out of it.

use std::collections::{BTreeMap, HashMap};

use roxmltree::Node;

use super::error::ImportError;
use super::place::Place;
use super::robot::{Follows, Joint, Kind, Link, Mass, Robot};
use super::xml::{child, children, document, line, needed, number, numbers};

/// Elements that say nothing of how a robot moves, and what they are.
const IGNORED: [(&str, &str); 5] = [
    ("transmission", "gears between motors and joints"),
    ("gazebo", "settings of a simulator"),
    ("material", "colours"),
    ("sensor", "sensors"),
    ("ros2_control", "interfaces of control"),
];

/// The robot of a file, and what is not carried over.
pub fn read(text: &str) -> Result<(Robot, Vec<String>), ImportError> {
    let file = document(text)?;
    let root = file.root_element();
    if root.tag_name().name() != "robot" {
        let message = format!("the file is of <{}>, not of <robot>", root.tag_name().name());
        return Err(ImportError::new(line(root), message, "give a URDF file"));
    }
    if let Some(macros) = root
        .descendants()
        .find(|node| node.tag_name().namespace().is_some_and(|space| space.contains("xacro")))
    {
        let cure = "write it out first: `xacro FILE.xacro > FILE.urdf`";
        return Err(ImportError::new(line(macros), "the file has macros of xacro", cure));
    }
    let mut left_out = Vec::new();
    let mut by_name = HashMap::new();
    let mut links = Vec::new();
    for node in children(root, "link") {
        let link = link(node)?;
        if by_name.insert(link.name.clone(), links.len()).is_some() {
            let message = format!("two links are called `{}`", link.name);
            return Err(ImportError::new(line(node), message, "give each a name of its own"));
        }
        links.push(link);
    }
    let mut joints: Vec<Joint> = Vec::new();
    for node in children(root, "joint") {
        let joint = joint(node, &by_name, &mut left_out)?;
        if joints.iter().any(|other| other.name == joint.name) {
            let message = format!("two joints are called `{}`", joint.name);
            return Err(ImportError::new(line(node), message, "give each a name of its own"));
        }
        if let Some(other) = joints.iter().find(|other| other.child == joint.child) {
            let name = &links[joint.child].name;
            let message =
                format!("link `{name}` is the child of the joints `{}` and `{}`", other.name, joint.name);
            return Err(ImportError::new(
                line(node),
                message,
                "URDF is for trees; close the loop in the mechanism file",
            ));
        }
        joints.push(joint);
    }
    for (at, node) in children(root, "joint").enumerate() {
        joints[at].follows = follows(node, at, &joints, &mut left_out)?;
    }
    let robot = Robot {
        name: root.attribute("name").unwrap_or("robot").to_owned(),
        root: tree(&links, &joints, line(root))?,
        links,
        joints,
    };
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for node in root.descendants().filter(Node::is_element) {
        *count.entry(node.tag_name().name()).or_default() += 1;
    }
    for (name, what) in
        [("visual", "shapes to look at"), ("collision", "shapes to touch")].into_iter().chain(IGNORED)
    {
        if let Some(found) = count.get(name) {
            left_out.push(format!("<{name}>, {found} times: {what}"));
        }
    }
    Ok((robot, left_out))
}

/// The link that everything hangs on.
fn tree(links: &[Link], joints: &[Joint], at: usize) -> Result<usize, ImportError> {
    let is_child = |link: usize| joints.iter().any(|joint| joint.child == link);
    let roots: Vec<usize> = (0..links.len()).filter(|link| !is_child(*link)).collect();
    let [root] = roots[..] else {
        let names: Vec<&str> = roots.iter().take(5).map(|link| &*links[*link].name).collect();
        let message = match roots.len() {
            0 if links.is_empty() => "the robot has no links".to_owned(),
            0 => "every link is the child of another: the joints form a circle".to_owned(),
            _ => format!("{} links are the child of no joint: {}", roots.len(), names.join(", ")),
        };
        return Err(ImportError::new(
            at,
            message,
            "one link is the root, every other the child of one joint",
        ));
    };
    let robot = Robot { name: String::new(), links: links.to_vec(), joints: joints.to_vec(), root };
    if robot.order().len() < joints.len() {
        let message = "some joints hang on each other and not on the root: they form a circle";
        return Err(ImportError::new(
            at,
            message,
            "one link is the root, every other the child of one joint",
        ));
    }
    Ok(root)
}

fn place(node: Node<'_, '_>) -> Result<Place, ImportError> {
    let Some(origin) = child(node, "origin") else { return Ok(Place::default()) };
    let zero = Some([0.0; 3]);
    Ok(Place::of(numbers(origin, "xyz", zero)?, numbers(origin, "rpy", zero)?))
}

fn link(node: Node<'_, '_>) -> Result<Link, ImportError> {
    let name = needed(node, "name")?.to_owned();
    let mut link = Link { name, line: line(node), mass: None };
    let Some(inertial) = child(node, "inertial") else { return Ok(link) };
    let part = |tag: &'static str| {
        child(inertial, tag).ok_or_else(|| {
            let message = format!("<inertial> of link `{}` has no <{tag}>", link.name);
            ImportError::new(line(inertial), message, "give mass and inertia, or take <inertial> away")
        })
    };
    let mass = number(part("mass")?, "value", None)?;
    let tensor = part("inertia")?;
    let entry = |key: &str| {
        number(tensor, key, if key.as_bytes()[1] == key.as_bytes()[2] { None } else { Some(0.0) })
    };
    let (xx, yy, zz) = (entry("ixx")?, entry("iyy")?, entry("izz")?);
    let (xy, xz, yz) = (entry("ixy")?, entry("ixz")?, entry("iyz")?);
    if mass < 0.0 {
        let message = format!("the mass of link `{}` is {mass} kg", link.name);
        return Err(ImportError::new(line(inertial), message, "a mass is positive"));
    }
    if mass > 0.0 {
        let place = place(inertial)?;
        let inertia = place.tensor(&[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
        link.mass = Some(Mass { mass, centre: place.origin, inertia });
    } else if [xx, yy, zz].iter().any(|value| *value != 0.0) {
        let message = format!("link `{}` has an inertia and no mass", link.name);
        return Err(ImportError::new(line(inertial), message, "give both, or take <inertial> away"));
    }
    Ok(link)
}

fn joint(
    node: Node<'_, '_>,
    links: &HashMap<String, usize>,
    left_out: &mut Vec<String>,
) -> Result<Joint, ImportError> {
    let name = needed(node, "name")?.to_owned();
    let kind = match needed(node, "type")? {
        "revolute" | "continuous" => Kind::Revolute,
        "prismatic" => Kind::Prismatic,
        "fixed" => Kind::Fixed,
        "floating" => Kind::Free,
        "planar" => Kind::Planar,
        other => {
            let message = format!("joint `{name}` is of the type \"{other}\"");
            let cure = "types are revolute, continuous, prismatic, fixed, floating, planar";
            return Err(ImportError::new(line(node), message, cure));
        }
    };
    let side = |tag: &'static str| {
        let element = child(node, tag).ok_or_else(|| {
            let message = format!("joint `{name}` has no <{tag}>");
            ImportError::new(line(node), message, format!("add `<{tag} link=\"..\"/>`"))
        })?;
        let link = needed(element, "link")?;
        links.get(link).copied().ok_or_else(|| {
            let message = format!("joint `{name}` names the link `{link}`, which is not in the file");
            ImportError::new(line(element), message, "names are case-sensitive")
        })
    };
    let (parent, child_link) = (side("parent")?, side("child")?);
    let axis = child(node, "axis")
        .map_or(Ok([1.0, 0.0, 0.0]), |axis| numbers(axis, "xyz", Some([1.0, 0.0, 0.0])))?;
    let needs_axis = matches!(kind, Kind::Revolute | Kind::Prismatic | Kind::Planar);
    if needs_axis && axis == [0.0; 3] {
        return Err(ImportError::new(
            line(node),
            format!("the axis of joint `{name}` is 0 0 0"),
            "give its direction",
        ));
    }
    let mut joint = Joint {
        name,
        kind,
        parent,
        child: child_link,
        place: place(node)?,
        axis,
        damping: 0.0,
        follows: None,
        remarks: Vec::new(),
    };
    let is_one = kind.is_single();
    if let Some(dynamics) = child(node, "dynamics").filter(|_| is_one) {
        joint.damping = number(dynamics, "damping", Some(0.0))?;
        if joint.damping < 0.0 {
            let message = format!("the damping of joint `{}` is {}", joint.name, joint.damping);
            return Err(ImportError::new(
                line(dynamics),
                message,
                "damping takes energy away: it is positive",
            ));
        }
        let friction = number(dynamics, "friction", Some(0.0))?;
        if friction != 0.0 {
            left_out.push(format!("friction of {}: a law that jumps at rest; write a smooth one as `force`, such as \"-{friction} {}*tanh({}.v/(0.01 {}))\"", joint.name, force_unit(kind), joint.name, speed_unit(kind)));
        }
    }
    if let Some(limit) = child(node, "limit").filter(|_| is_one) {
        let of = |key: &str| number(limit, key, Some(0.0));
        let (effort, velocity) = (of("effort")?, of("velocity")?);
        let unit = if kind == Kind::Revolute { "rad" } else { "m" };
        let range = if node.attribute("type") == Some("continuous") {
            String::new()
        } else {
            format!("{} to {} {unit}, ", of("lower")?, of("upper")?)
        };
        joint.remarks.push(format!(
            "limits: {range}{effort} {}, {velocity} {}",
            force_unit(kind),
            speed_unit(kind)
        ));
    }
    Ok(joint)
}

/// The joint that the joint `at` mimics.
fn follows(
    node: Node<'_, '_>,
    at: usize,
    joints: &[Joint],
    left_out: &mut Vec<String>,
) -> Result<Option<Follows>, ImportError> {
    let Some(mimic) = child(node, "mimic") else { return Ok(None) };
    let (own, other) = (&joints[at], needed(mimic, "joint")?);
    let (times, plus) = (number(mimic, "multiplier", Some(1.0))?, number(mimic, "offset", Some(0.0))?);
    let wrong = |message: String| ImportError::new(line(mimic), message, "name the joint that it moves with");
    let leader = joints
        .iter()
        .position(|joint| joint.name == other)
        .ok_or_else(|| wrong(format!("joint `{}` mimics `{other}`, which is not in the file", own.name)))?;
    if leader == at {
        return Err(wrong(format!("joint `{other}` mimics itself")));
    }
    if !own.kind.is_single() || !joints[leader].kind.is_single() || times == 0.0 {
        left_out.push(format!(
            "mimic of {}: it should follow {other} times {times} plus {plus}, and moves alone",
            own.name
        ));
        return Ok(None);
    }
    Ok(Some(Follows { leader, times, plus }))
}

fn force_unit(kind: Kind) -> &'static str {
    if kind == Kind::Revolute { "N m" } else { "N" }
}

fn speed_unit(kind: Kind) -> &'static str {
    if kind == Kind::Revolute { "rad/s" } else { "m/s" }
}
