//! URDF: <https://wiki.ros.org/urdf/XML>. In: its text. Out: a robot, and what is left out of it.

use std::collections::{BTreeMap, HashMap};

use super::error::{Faults, ImportError};
use super::files::Files;
use super::mass::{Mass, Shape, together};
use super::meshes::Meshes;
use super::names;
use super::place::Place;
use super::robot::{Follows, Joint, Kind, Link, MOST, Robot};
use super::xml::Element;

/// Elements that say nothing of how a robot moves, and what they are.
const IGNORED: [(&str, &str); 7] = [
    ("safety_controller", "limits of a controller"),
    ("calibration", "where a joint's sensor has its marks"),
    ("transmission", "gears between motors and joints"),
    ("gazebo", "settings of a simulator"),
    ("material", "colours"),
    ("sensor", "sensors"),
    ("ros2_control", "interfaces of control"),
];

/// The robot of a file, and what is not carried over.
pub fn read(
    root: &Element,
    density: Option<f64>,
    files: &dyn Files,
) -> Result<(Robot, Vec<String>), ImportError> {
    let meshes = Meshes::new(files);
    let all = root.descendants();
    if let Some(macros) = all.iter().find(|element| element.is_macro) {
        let cure = "write it out first: `xacro FILE.xacro > FILE.urdf`";
        return Err(macros.fault("the file has macros of xacro", cure));
    }
    let mut left_out = Vec::new();
    let mut shaped = 0;
    let mut by_name = HashMap::new();
    let mut links = Vec::new();
    let mut faults = Faults::default();
    if let Some(node) = root.all("link").nth(MOST) {
        return Err(node.fault(format!("there are more than {MOST} links"), "import a part of them"));
    }
    for node in root.all("link") {
        // Joints may name one with a fault.
        let named = || {
            let name = node.attribute("name").unwrap_or_default().to_owned();
            Link { name, line: node.line, mass: None, is_between: false }
        };
        let mut link = faults.keep(link(node)).unwrap_or_else(named);
        if let Some(density) = density.filter(|_| node.first("inertial").is_none()) {
            link.mass = faults.keep(shapes(node, density, &meshes)).flatten();
            shaped += usize::from(link.mass.is_some());
        }
        if by_name.insert(link.name.clone(), links.len()).is_some() {
            let message = format!("two links are called `{}`", link.name);
            faults.push(node.fault(message, "give each a name of its own"));
        }
        links.push(link);
    }
    let mut joints: Vec<Joint> = Vec::new();
    // Places of joints by their names, and by the links that are their children.
    let (mut named, mut above) = (HashMap::new(), HashMap::new());
    for node in root.all("joint") {
        let Some(joint) = faults.keep(joint(node, &by_name, &mut left_out)) else { continue };
        if named.contains_key(&joint.name) {
            let message = format!("two joints are called `{}`", joint.name);
            faults.push(node.fault(message, "give each a name of its own"));
            continue;
        }
        if let Some(other) = above.get(&joint.child).map(|other: &usize| &joints[*other]) {
            let name = &links[joint.child].name;
            let message =
                format!("link `{name}` is the child of the joints `{}` and `{}`", other.name, joint.name);
            faults.push(node.fault(message, "URDF is for trees; close the loop in the mechanism file"));
        }
        named.insert(joint.name.clone(), joints.len());
        above.entry(joint.child).or_insert(joints.len());
        joints.push(joint);
    }
    faults.none()?;
    for (at, node) in root.all("joint").enumerate() {
        joints[at].follows = follows(node, at, (&joints, &named), &mut left_out)?;
    }
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    let tree_root = tree(&links, &joints, root)?;
    let robot = Robot::new(name, links, joints, tree_root);
    if let Some(density) = density {
        left_out.push(if shaped == 0 {
            "--density: not used, no mass is made of a shape".to_owned()
        } else {
            format!(
                "masses of {shaped} link(s) without <inertial>: of their shapes to touch, else to look at, at {density} kg/m^3"
            )
        });
    }
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for element in all {
        *count.entry(&element.tag).or_default() += 1;
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
fn tree(links: &[Link], joints: &[Joint], at: &Element) -> Result<usize, ImportError> {
    let mut is_child = vec![false; links.len()];
    joints.iter().for_each(|joint| is_child[joint.child] = true);
    let roots: Vec<usize> = (0..links.len()).filter(|link| !is_child[*link]).collect();
    let [root] = roots[..] else {
        let names: Vec<&str> = roots.iter().take(5).map(|link| &*links[*link].name).collect();
        let message = match roots.len() {
            0 if links.is_empty() => "the robot has no links".to_owned(),
            0 => "every link is the child of another: the joints form a circle".to_owned(),
            _ => format!("{} links are the child of no joint: {}", roots.len(), names.join(", ")),
        };
        return Err(at.fault(message, "one link is the root, every other the child of one joint"));
    };
    let robot = Robot::new(String::new(), links.to_vec(), joints.to_vec(), root);
    if robot.order().len() < joints.len() {
        let message = "some joints hang on each other and not on the root: they form a circle";
        return Err(at.fault(message, "one link is the root, every other the child of one joint"));
    }
    Ok(root)
}

fn place(node: &Element) -> Result<Place, ImportError> {
    let Some(origin) = node.first("origin") else { return Ok(Place::default()) };
    let zero = Some([0.0; 3]);
    Ok(Place::of(origin.numbers("xyz", zero)?, origin.numbers("rpy", zero)?))
}

fn link(node: &Element) -> Result<Link, ImportError> {
    let name = node.needed("name")?.to_owned();
    let mut link = Link { name, line: node.line, mass: None, is_between: false };
    let Some(inertial) = node.first("inertial") else { return Ok(link) };
    let part = |tag: &'static str| {
        inertial.first(tag).ok_or_else(|| {
            let message = format!("<inertial> of link `{}` has no <{tag}>", link.name);
            inertial.fault(message, "give mass and inertia, or take <inertial> away")
        })
    };
    let mass = part("mass")?.number("value", None)?;
    let tensor = part("inertia")?;
    let entry =
        |key: &str| tensor.number(key, if key.as_bytes()[1] == key.as_bytes()[2] { None } else { Some(0.0) });
    let (xx, yy, zz) = (entry("ixx")?, entry("iyy")?, entry("izz")?);
    let (xy, xz, yz) = (entry("ixy")?, entry("ixz")?, entry("iyz")?);
    if mass < 0.0 {
        let message = format!("the mass of link `{}` is {mass} kg", link.name);
        return Err(inertial.fault(message, "a mass is positive"));
    }
    if mass > 0.0 {
        let place = place(inertial)?;
        let inertia = place.tensor(&[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
        link.mass = Some(Mass { mass, centre: place.origin, inertia });
    } else if [xx, yy, zz].iter().any(|value| *value != 0.0) {
        let message = format!("link `{}` has an inertia and no mass", link.name);
        return Err(inertial.fault(message, "give both, or take <inertial> away"));
    }
    Ok(link)
}

/// Mass of the shapes of a link: those to touch, else those to look at.
fn shapes(node: &Element, density: f64, meshes: &Meshes<'_>) -> Result<Option<Mass>, ImportError> {
    let kind = if node.first("collision").is_some() { "collision" } else { "visual" };
    let mut all: Option<Mass> = None;
    for part in node.all(kind) {
        let Some(shape) = part.first("geometry").and_then(|geometry| geometry.children.first()) else {
            continue;
        };
        let place = place(part)?;
        let positive = |key: &str| {
            let value = shape.number(key, None)?;
            let fault =
                || shape.fault(format!("`{key}` of <{}> is {value}", shape.tag), "it is positive, in metres");
            if value > 0.0 { Ok(value) } else { Err(fault()) }
        };
        let plain = |shape: Shape| shape.of_mass(density * shape.volume());
        let mass = match &*shape.tag {
            "box" => {
                let size: [f64; 3] = shape.numbers("size", None)?;
                if size.iter().any(|x| *x <= 0.0) {
                    return Err(
                        shape.fault("`size` of <box> is not positive", "give three lengths in metres")
                    );
                }
                plain(Shape::Box { half: size.map(|x| 0.5 * x) })
            }
            "cylinder" => {
                plain(Shape::Cylinder { radius: positive("radius")?, half: 0.5 * positive("length")? })
            }
            "sphere" => plain(Shape::Sphere { radius: positive("radius")? }),
            "mesh" => {
                let name = shape.needed("filename")?;
                let scale: [f64; 3] = shape.numbers("scale", Some([1.0; 3]))?;
                let moved = |corner: [f64; 3]| std::array::from_fn(|i| corner[i] * scale[i]);
                let solid = meshes.solid(name, moved).map_err(|why| {
                    let message = format!("the mass of the mesh `{name}` is not known: {why}");
                    shape.fault(message, "give the link an <inertial> with its mass and inertia; files outside the folder are read with --allow-outside-data")
                })?;
                solid.of_density(density)
            }
            other => {
                let cure = "shapes are box, cylinder, sphere and mesh; else give the link an <inertial>";
                return Err(shape.fault(format!("a shape is a <{other}>"), cure));
            }
        };
        let mass = mass.seen_from(&place);
        all = Some(all.map_or(mass, |before| together(&before, &mass)));
    }
    Ok(all)
}

fn joint(
    node: &Element,
    links: &HashMap<String, usize>,
    left_out: &mut Vec<String>,
) -> Result<Joint, ImportError> {
    let name = node.needed("name")?.to_owned();
    let kind = match node.needed("type")? {
        "revolute" | "continuous" => Kind::Revolute,
        "prismatic" => Kind::Prismatic,
        "fixed" => Kind::Fixed,
        "floating" => Kind::Free,
        "planar" => Kind::Planar,
        other => {
            let message = format!("joint `{name}` is of the type \"{other}\"");
            let cure = "types are revolute, continuous, prismatic, fixed, floating, planar";
            return Err(node.fault(message, cure));
        }
    };
    let side = |tag: &'static str| {
        let element = node.first(tag).ok_or_else(|| {
            let message = format!("joint `{name}` has no <{tag}>");
            node.fault(message, format!("add `<{tag} link=\"..\"/>`"))
        })?;
        let link = element.needed("link")?;
        links.get(link).copied().ok_or_else(|| {
            let message = format!("joint `{name}` names the link `{link}`, which is not in the file");
            element.fault(message, "names are case-sensitive")
        })
    };
    let (parent, child_link) = (side("parent")?, side("child")?);
    let axis =
        node.first("axis").map_or(Ok([1.0, 0.0, 0.0]), |axis| axis.numbers("xyz", Some([1.0, 0.0, 0.0])))?;
    let needs_axis = matches!(kind, Kind::Revolute | Kind::Prismatic | Kind::Planar);
    if needs_axis && axis == [0.0; 3] {
        return Err(node.fault(format!("the axis of joint `{name}` is 0 0 0"), "give its direction"));
    }
    let mut joint = Joint {
        name,
        kind,
        parent,
        child: child_link,
        place: place(node)?,
        axis,
        at: [0.0; 3],
        damping: 0.0,
        spring: None,
        armature: 0.0,
        actuated: None,
        follows: None,
        held: None,
        remarks: Vec::new(),
    };
    let is_one = kind.is_single();
    if matches!(kind, Kind::Planar | Kind::Free) {
        for tag in ["dynamics", "limit"] {
            if let Some(element) = node.first(tag) {
                let values: Vec<String> =
                    element.attributes.iter().map(|(key, value)| format!("{key} {value}")).collect();
                left_out.push(format!(
                    "<{tag}> of {}, a joint with several coordinates: {}",
                    joint.name,
                    values.join(", ")
                ));
            }
        }
    }
    if let Some(dynamics) = node.first("dynamics").filter(|_| is_one) {
        joint.damping = dynamics.number("damping", Some(0.0))?;
        if joint.damping < 0.0 {
            let message = format!("the damping of joint `{}` is {}", joint.name, joint.damping);
            return Err(dynamics.fault(message, "damping takes energy away: it is positive"));
        }
        let friction = dynamics.number("friction", Some(0.0))?;
        if friction != 0.0 {
            left_out.push(format!("friction of {}: a law that jumps at rest; write a smooth one as `force`, such as \"-{friction} {}*tanh({}.v/(0.01 {}))\"", joint.name, force_unit(kind), names::plain(&joint.name), speed_unit(kind)));
        }
    }
    if let Some(limit) = node.first("limit").filter(|_| is_one) {
        let of = |key: &str| limit.number(key, Some(0.0));
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
    node: &Element,
    at: usize,
    (joints, named): (&[Joint], &HashMap<String, usize>),
    left_out: &mut Vec<String>,
) -> Result<Option<Follows>, ImportError> {
    let Some(mimic) = node.first("mimic") else { return Ok(None) };
    let (own, other) = (&joints[at], mimic.needed("joint")?);
    let (times, plus) = (mimic.number("multiplier", Some(1.0))?, mimic.number("offset", Some(0.0))?);
    let wrong = |message: String| mimic.fault(message, "name the joint that it moves with");
    let leader = named
        .get(other)
        .copied()
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
