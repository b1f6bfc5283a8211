//! Screws of speeds along the axes of the links that they carry. In: poses. Out: by link, the screws of the speeds inboard of it.
//! Never knows mass.

use crate::expr::Vec3;

use super::geometry::Geometry;
use super::kinematics::Poses;
use super::linkage::Freedom;

/// Angular velocity of a link and velocity of its origin per unit of a speed, along the link's axes.
pub type Screw<'g> = [Vec3<'g>; 2];

/// By link, the speeds inboard of its joint, with their screws. A flexible body is met twice, at its node and at its frame.
pub fn inboard_screws<'g>(poses: &Poses<'g>) -> Vec<Vec<(usize, Screw<'g>)>> {
    let linkage = poses.geometry.linkage;
    let mut all: Vec<Vec<(usize, Screw<'g>)>> = Vec::with_capacity(linkage.links.len());
    for (at, link) in linkage.links.iter().enumerate() {
        let Some(parent) = link.parent else {
            all.push(Vec::new());
            continue;
        };
        let pose = &poses.relative[at];
        let carried = |(speed, screw): (usize, Screw<'g>)| (speed, pose.screw_outboard(link.freedom, screw));
        let own = linkage.links[parent].speeds().zip(own_screws(poses, parent));
        all.push(own.chain(all[parent].iter().copied()).map(carried).collect());
    }
    all
}

/// Of the speeds that move a link relative to its parent; of a flexible body's frame and nodes those of their motion.
fn own_screws<'g>(poses: &Poses<'g>, at: usize) -> Vec<Screw<'g>> {
    let Geometry { g, linkage, .. } = poses.geometry;
    let freedom = linkage.links[at].freedom;
    let unit = |axis: usize| Vec3::from_fn(|i| g.number(f64::from(u8::from(i == axis))));
    let zero = g.zero_vector();
    if let Some(node) = &poses.nodes[at] {
        return if freedom == Freedom::Node { node.section_screws() } else { node.frame_screws() };
    }
    if let Some(screw) = freedom.screw() {
        return vec![screw.map(|part| g.vector(part))];
    }
    let turns = (0..3).map(|axis| [unit(axis), zero]);
    match freedom {
        Freedom::Ball => turns.collect(),
        Freedom::Free => turns.chain((0..3).map(|axis| [zero, unit(axis)])).collect(),
        _ => Vec::new(),
    }
}
