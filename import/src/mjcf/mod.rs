//! MJCF: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>. In: its elements and the files they name. Out: a robot, and what is
//! left out of it.

mod actuators;
mod bodies;
mod classes;
mod equality;
mod geoms;
mod include;
mod joints;
mod laws;
mod settings;

use std::collections::{BTreeMap, HashMap};

use self::bodies::Tree;
use self::classes::Classes;
use self::geoms::Assets;
use self::settings::Settings;
use super::error::ImportError;
use super::files::Files;
use super::mass::Mass;
use super::meshes::Meshes;
use super::robot::Robot;
use super::xml::Element;

/// Sections and elements that are not carried over, and what they are.
const IGNORED: [(&str, &str); 11] = [
    ("tendon", "cables and sums of coordinates"),
    ("contact", "pairs that touch or do not"),
    ("sensor", "sensors"),
    ("keyframe", "stored states"),
    ("deformable", "bodies that bend"),
    ("extension", "plugins"),
    ("custom", "data of users"),
    ("skin", "shapes to look at"),
    ("light", "lights"),
    ("camera", "cameras"),
    ("geom", "nothing touches here: shapes gave masses where there is no <inertial>"),
];

/// The robot of a file, and what is not carried over.
pub fn read(root: Element, files: &dyn Files) -> Result<(Robot, Vec<String>), ImportError> {
    let root = include::whole(root, files)?;
    let mut left_out = Vec::new();
    let settings = Settings::of(&root, &mut left_out)?;
    let classes = Classes::of(&root)?;
    let assets = Assets::of(&root, &classes, &settings, Meshes::new(files))?;
    let named = |tag: &str| matches!(tag, "body" | "joint" | "freejoint");
    let all = root.descendants();
    let names =
        all.iter().filter(|element| named(&element.tag)).filter_map(|element| element.attribute("name"));
    let mut tree = Tree {
        classes: &classes,
        settings: &settings,
        assets: &assets,
        links: Vec::new(),
        joints: Vec::new(),
        references: Vec::new(),
        bodies: HashMap::new(),
        sites: HashMap::new(),
        taken: names.map(str::to_owned).collect(),
        hulls: 0,
        left_out,
    };
    let worlds: Vec<&Element> = root.all("worldbody").collect();
    let [first, more @ ..] = &worlds[..] else {
        return Err(root.fault("the model has no <worldbody>", "give its bodies there"));
    };
    // Several of them, of included files, are one.
    let mut world = Element { tag: first.tag.clone(), line: first.line, ..Element::default() };
    world.attributes.clone_from(&first.attributes);
    for part in std::iter::once(first).chain(more) {
        world.children.extend(part.children.iter().cloned());
    }
    tree.world(&world)?;
    scale(&mut tree, settings.total_mass);
    let model = root.attribute("model").unwrap_or("model").to_owned();
    let draft = Robot::new(model, tree.links.clone(), tree.joints.clone(), 0);
    let closures = equality::read(&root, &mut tree, &draft.places())?;
    let actuators = actuators::read(&root, &mut tree)?;
    if tree.hulls > 0 {
        tree.left_out.push(format!(
            "`inertia` \"convex\" of {} mesh(es): masses are of what they enclose, not of their convex hulls",
            tree.hulls
        ));
    }
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for element in &all {
        *count.entry(&element.tag).or_default() += 1;
    }
    for (name, what) in IGNORED {
        if let Some(found) = count.get(name) {
            tree.left_out.push(format!("<{name}>, {found} times: {what}"));
        }
    }
    let robot = Robot {
        is_on_ground: true,
        gravity: Some(settings.gravity),
        links: tree.links,
        joints: tree.joints,
        closures,
        actuators,
        ..draft
    };
    Ok((robot, tree.left_out))
}

/// All masses by one factor, so that they come to a total.
fn scale(tree: &mut Tree<'_>, total: Option<f64>) {
    let masses = || tree.links.iter().filter_map(|link| link.mass);
    let sum: f64 = masses().map(|mass: Mass| mass.mass).sum();
    let Some(total) = total.filter(|_| sum > 0.0) else { return };
    for link in &mut tree.links {
        link.mass = link.mass.map(|mass| mass.scaled(total / sum));
    }
}
