//! Links that are fixed to each other as one body. In: a robot. Out: bodies with mass, centre and inertia in the root's frame. Never
//! knows text.

use super::error::ImportError;
use super::mass::{Mass, together};
use super::robot::{Base, Kind, Robot};

/// Links that move as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The link nearest to the root, after which the body is called.
    pub first: usize,
    /// All together, in the root's frame; None without mass: the ground, and links between two joints.
    pub mass: Option<Mass>,
}

/// Bodies and which link belongs to which; the first body is that of the root.
#[derive(Clone, Debug, PartialEq)]
pub struct Bodies {
    pub bodies: Vec<Body>,
    /// By link: its body; None for one that is left out.
    pub of_link: Vec<Option<usize>>,
}

/// The bodies that move. One without mass that carries nothing is left out; one that carries something is a fault.
pub fn merged(robot: &Robot, base: Base, left_out: &mut Vec<String>) -> Result<Bodies, ImportError> {
    let places = robot.places();
    let mut own = vec![0; robot.links.len()];
    let mut bodies = vec![Body { first: robot.root, mass: None }];
    let mut fixed = Vec::new();
    for at in robot.order() {
        let joint = &robot.joints[at];
        own[joint.child] = match joint.kind {
            Kind::Fixed => {
                fixed
                    .push(format!("{} to {}", robot.links[joint.child].name, robot.links[joint.parent].name));
                own[joint.parent]
            }
            _ => {
                bodies.push(Body { first: joint.child, mass: None });
                bodies.len() - 1
            }
        };
    }
    for (link, place) in places.iter().enumerate() {
        let Some(mass) = robot.links[link].mass else { continue };
        let moved = mass.seen_from(place);
        let body = &mut bodies[own[link]];
        body.mass = Some(body.mass.map_or(moved, |before| together(&before, &moved)));
    }
    if !fixed.is_empty() {
        left_out.push(format!(
            "fixed joints, {}: their links are one body ({})",
            fixed.len(),
            shortened(&fixed)
        ));
    }
    let mut parents = vec![None; bodies.len()];
    for joint in robot.joints.iter().filter(|joint| bodies[own[joint.child]].first == joint.child) {
        parents[own[joint.child]].get_or_insert(own[joint.parent]);
    }
    // Whether a body that is kept hangs on it.
    let mut carries = vec![false; bodies.len()];
    let mut kept = vec![true; bodies.len()];
    // Children come behind their parents.
    for body in (0..bodies.len()).rev() {
        let link = &robot.links[bodies[body].first];
        let (carries_one, is_held) = (carries[body], body == 0 && base == Base::Fixed);
        if bodies[body].mass.is_some() || is_held || (carries_one && link.is_between) {
            if let Some(parent) = parents[body] {
                carries[parent] = true;
            }
            continue;
        }
        if carries_one || body == 0 {
            let message = format!("link `{}` moves and has no mass", link.name);
            let cure = if body == 0 {
                "give it an <inertial>, or hold it: without --floating it is the ground"
            } else {
                "give it an <inertial> with its mass and inertia, or its shapes a density (--density, for URDF)"
            };
            return Err(ImportError::new(link.line, message, cure));
        }
        kept[body] = false;
        if link.is_between {
            continue;
        }
        left_out.push(format!("{}: a link without mass that carries nothing, with its joint", link.name));
    }
    if base == Base::Fixed && bodies[0].mass.is_some() {
        let cure = if robot.is_on_ground { "" } else { " (--floating lets it move)" };
        left_out.push(format!("mass of {}: the root is the ground{cure}", robot.links[robot.root].name));
    }
    let mut number = Vec::new();
    let mut next = 0;
    for is_kept in &kept {
        number.push(is_kept.then_some(next));
        next += usize::from(*is_kept);
    }
    let bodies = bodies.into_iter().zip(&kept).filter(|(_, kept)| **kept).map(|(body, _)| body).collect();
    Ok(Bodies { bodies, of_link: own.into_iter().map(|body| number[body]).collect() })
}

/// The first of many.
fn shortened(names: &[String]) -> String {
    let most = 6;
    let more = if names.len() > most { ", .." } else { "" };
    format!("{}{more}", names[..names.len().min(most)].join(", "))
}
