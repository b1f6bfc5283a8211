//! Drive forces of links whose bearing is free to slide: the force that the bearing transmits along its slides is known from
//! these, so that nothing outboard of the driven link has to be summed up.
//! In: motion with all accelerations, loads. Out: a drive force, for links that are such. Never knows multipliers.
//!
//! With T the force that the driven link passes to the only link outboard of it, rows of loops included, the slides u say
//! `u . (own + T) = force of the slide`; about the driven axis, `drive = own moment + (p x T)_z + moment of the joint there`.

use crate::expr::Expr;

use super::dynamics::{inertial_wrench, rigid_force_in_ground};
use super::kept_rows::Partition;
use super::link_mass::LinkMass;
use super::linkage::Freedom;
use super::loads::Loads;
use super::motion::Motion;

/// Directions are numbers, right to a few roundings.
const PARALLEL: f64 = 1e-12;

/// Force of the driver of a speed; nothing where its link does not slide across the driven axis or passes more than a force.
pub fn slid_drive<'g>(
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    loads: &Loads<'g>,
    partition: &Partition,
    driven: usize,
) -> Option<Expr<'g>> {
    let poses = &motion.poses;
    let (linkage, mechanism) = (poses.geometry.linkage, poses.geometry.mechanism);
    let at = linkage.links.iter().position(|link| {
        link.first_speed == driven
            && matches!(link.freedom, Freedom::Rotation { advance, .. } if advance == 0.0)
    })?;
    let mut outboard = (0..linkage.links.len()).filter(|other| linkage.links[*other].parent == Some(at));
    let (next, None) = (outboard.next()?, outboard.next()) else { return None };
    let chain: Vec<usize> = linkage.path(Some(at)).collect();
    let on_chain = linkage.cuts.iter().flat_map(|cut| [cut.parent, cut.child]);
    let held = on_chain.flatten().any(|link| chain.contains(&link)) || !mechanism.couplings.is_empty();
    let rigid = chain.iter().all(|link| masses[*link].modal.is_none() && linkage.links[*link].node.is_none());
    if held || !rigid {
        return None;
    }
    let number = |x: Expr<'g>| x.as_number();
    let axis = |turn: [Expr<'g>; 3]| Some([number(turn[0])?, number(turn[1])?, number(turn[2])?]);
    let turn = poses.world[at].rotation;
    let about = axis([turn[0][2], turn[1][2], turn[2][2]])?;
    // Force that is passed on, along the axes of W, across the driven axis.
    let mut passed = poses.geometry.g.zero_vector();
    let mut own = passed;
    let mut slides: Vec<[f64; 3]> = Vec::new();
    for link in chain {
        let applied = loads.external[link] + loads.reactions[link];
        own += rigid_force_in_ground(motion, masses, link, applied.force);
        if link == at {
            continue;
        }
        let Freedom::Translation { axis } = linkage.links[link].freedom else { return None };
        let speed = linkage.links[link].first_speed;
        let across = slides.iter().chain([&about]).all(|other| dot(&axis, other).abs() < PARALLEL);
        if !across || !partition.free.contains(&speed) {
            return None;
        }
        slides.push(axis);
        let direction = poses.geometry.g.vector(axis);
        passed += (loads.joint[speed] - direction.dot(own)) * direction;
    }
    if slides.len() != 2 {
        return None;
    }
    let moment = match linkage.links[next].freedom {
        Freedom::Ball => poses.geometry.g.zero(),
        Freedom::Rotation { advance: 0.0, .. } => {
            let speed = linkage.links[next].first_speed;
            let along = number(poses.relative[next].rotation[2][2])?;
            if (along.abs() - 1.0).abs() > PARALLEL || !partition.free.contains(&speed) {
                return None;
            }
            along * loads.joint[speed]
        }
        _ => return None,
    };
    let lever = poses.relative[next].offset.cross(poses.world[at].inwards(passed));
    let inertial = inertial_wrench(motion, masses, at).moment;
    let applied = loads.external[at].moment + loads.reactions[at].moment;
    Some((inertial - applied)[2] + lever[2] + moment - loads.joint[driven])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
