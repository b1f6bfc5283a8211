//! Where a joint is on its two links, and how its axes lie there.
//! In: a joint, its links. Out: [`Marker`]s. Never knows how they move.

use crate::id::JointId;
use crate::model::{Axis, Carrier};

use super::frame::{Frame, canonical_frame};
use super::geometry::Geometry;
use super::linkage::LinkIndex;
use super::relative_motion::{Marker, seen_from_child};

/// The links of a joint's parent and child, as the joint sees them (through a body's copy for closure `log`).
pub fn joint_links(geometry: &Geometry<'_>, joint: JointId) -> [LinkIndex; 2] {
    let linkage = geometry.linkage;
    let data = geometry.mechanism.joint(joint);
    let turns = !data.model.turns_freely();
    let [on_parent, on_child] = data.points();
    let mut parent = linkage.link_at(data.parent, on_parent, turns);
    let mut child = linkage.link_at(data.child, on_child, turns);
    if let Some(last) = linkage.link_of_joint[joint.index()] {
        // The chain's end is the outboard body, which may be a copy of it on this branch.
        if linkage.reversed[joint.index()] { parent = Some(last) } else { child = Some(last) }
    }
    debug_assert!(data.parent != Carrier::Ground || parent.is_none());
    [parent, child]
}

/// In whose link's frame a joint is looked at: see [`seen_from_child`]. But a line that holds a freely turning child
/// is fixed in the parent, as is a surface.
pub fn joint_in_child(geometry: &Geometry<'_>, joint: JointId, [parent, child]: [LinkIndex; 2]) -> bool {
    let model = &geometry.mechanism.joint(joint).model;
    let is_cut = || geometry.linkage.cuts.iter().any(|cut| cut.joint == joint);
    let off_balls = geometry.linkage.rows_off_balls && model.turns_freely() && is_cut();
    !model.is_held_in_parent() && seen_from_child(geometry.linkage, [parent, child], off_balls)
}

/// Markers at a joint on the links of its parent and child. They are parallel when all coordinates are zero;
/// `in_child` says in whose link's frame the axes shall be simple numbers.
pub fn joint_markers<'g>(
    geometry: &Geometry<'g>,
    joint: JointId,
    links: [LinkIndex; 2],
    in_child: bool,
) -> [Marker<'g>; 2] {
    let [parent, child] = links.map(|link| geometry.linkage.frame(link));
    let (outer_parent, outer_child) = match geometry.mechanism.joint(joint).model.axes[..] {
        [] => {
            let frame = if in_child { child } else { parent };
            (frame, frame)
        }
        [axis] => about(axis, &parent, &child, in_child),
        [axis, second, ..] => {
            let frame = Frame::with_z_and_x(axis.parent, second.parent);
            (frame, Frame::between(axis.parent, axis.child).times(&frame))
        }
    };
    let frames = [
        parent.transposed().times(&outer_parent).snapped(),
        child.transposed().times(&outer_child).snapped(),
    ];
    at_joint(geometry, joint, links, frames)
}

/// Markers on a body that two branches reach: on its own link and on its copy, with the axes of the copy.
pub fn split_body_markers<'g>(
    geometry: &Geometry<'g>,
    joint: JointId,
    links: [LinkIndex; 2],
) -> [Marker<'g>; 2] {
    let [body, copy] = links.map(|link| geometry.linkage.frame(link));
    at_joint(geometry, joint, links, [body.transposed().times(&copy).snapped(), Frame::IDENTITY])
}

fn at_joint<'g>(
    geometry: &Geometry<'g>,
    joint: JointId,
    [parent, child]: [LinkIndex; 2],
    frames: [Frame; 2],
) -> [Marker<'g>; 2] {
    let points = geometry.mechanism.joint(joint).points();
    let child = Marker { link: child, point: geometry.local(child, points[1]), frame: frames[1] };
    [Marker { link: parent, point: geometry.local(parent, points[0]), frame: frames[0] }, child]
}

/// A frame with e_z on the axis, simple in the frame of the chosen side, and its image on the other.
fn about(axis: Axis, parent: &Frame, child: &Frame, in_child: bool) -> (Frame, Frame) {
    let simple = |side: &Frame, direction: [f64; 3]| {
        side.times(&canonical_frame(side.local(direction), |_| None).0).snapped()
    };
    if in_child {
        let frame = simple(child, axis.child);
        (Frame::between(axis.child, axis.parent).times(&frame), frame)
    } else {
        let frame = simple(parent, axis.parent);
        (frame, Frame::between(axis.parent, axis.child).times(&frame))
    }
}
