//! Joints with clearance: motion of the journal in its bearing, and what contact forces do, [CS (7)-(12)].
//! In: link motion, wrenches handed in from outside. Out: [`linkwear_runtime::Entry::Contacts`], loads. Never
//! knows laws of contact: those have branches and live in the runtime.
//!
//! A revolute with clearance is free along two directions of the bearing; a ball and the cross of a universal joint along all three.
//! Rods that slide along their bushes or tilt in them touch at places of their own: [`super::guide_contacts`]. Offset and turn
//! are coordinates of the joint, so the generalised force of a contact wrench on the journal (its opposite acts on
//! the bearing at the same place) is the wrench itself: J_rel of [CS (8)] is a selection.

use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;
use crate::model::Axis;

use super::contact_wrench::ContactWrench;
use super::guide_contacts::GuidePlace;
use super::joint_state::JointStates;
use super::loads::Loads;

/// Offset, its rate, relative angular velocity, clearance: ten values of one joint, as [`linkwear_runtime::CONTACT_MOTION`] has
/// them.
pub fn contact_motion<'g>(
    g: &'g Scope,
    state: &JointStates<'g>,
    contact: &ContactWrench<'g>,
) -> Vec<Expr<'g>> {
    let joint = contact.joint;
    let linkage = state.geometry.linkage;
    let data = state.geometry.mechanism.joint(joint);
    // A journal that wears tells its angle: which place of it touches.
    let wears = data.clearance.as_ref().is_some_and(|clearance| clearance.journal.is_some());
    let (mut offset, mut rate, mut turn) = (g.zero_vector(), g.zero_vector(), g.zero_vector());
    if data.model.is_loose_guide() {
        [offset, rate, turn] = GuidePlace::new(g, state, contact).motion(g);
    } else if linkage.link_of_joint[joint.index()].is_some() {
        for (axis, coordinate) in data.model.offsets().enumerate() {
            let link = linkage.moved_link(joint, coordinate);
            offset[axis] = state.q[link.first_coordinate];
            rate[axis] = state.v[link.first_speed];
        }
        if let Some(ball) = linkage.ball_of(joint) {
            let relative = state.motion.relative_omega(linkage, ball);
            turn = if linkage.reversed[joint.index()] {
                -relative
            } else {
                state.motion.poses.relative[ball].rotation * relative
            };
        } else if data.model.is_cross() {
            turn = cross_rate(g, state, joint);
        } else {
            turn[2] = state.v[linkage.moved_link(joint, 0).first_speed];
            if wears {
                offset[2] = state.q[linkage.moved_link(joint, 0).first_coordinate];
            }
        }
    } else {
        let motion = state.relative_motion(joint);
        let journal = data.model.is_hinge();
        for j in 0..3 {
            let axis = motion.parent_axis(j);
            if journal && j == 2 {
                turn[2] = axis.dot(motion.omega);
                if wears {
                    offset[2] = state.coordinates(g, joint).position[0];
                }
                continue;
            }
            offset[j] = axis.dot(motion.distance);
            rate[j] = axis.dot(motion.slide);
            if !journal {
                turn[j] = axis.dot(motion.omega);
            }
        }
    }
    // What a wear coefficient reads besides: a journal leaves these places empty.
    let factor = data.clearance.as_ref().and_then(|clearance| clearance.factor.as_ref());
    let live = factor.map_or(&[][..], |factor| &factor.live[..]);
    for (place, id) in live.iter().enumerate() {
        let value = state.geometry.inputs.parameters[id.index()];
        match place {
            0 => rate[2] = value,
            place => turn[place - 1] = value,
        }
    }
    let clearance = match &data.clearance {
        Some(clearance) => state.lower(g, &clearance.radial),
        None => g.zero(),
    };
    offset.into_iter().chain(rate).chain(turn).chain([clearance]).collect()
}

/// Both axes of a universal joint in the tree, in the frame of its parent in which its offset is: the second is turned about the
/// first.
fn cross_axes<'g>(g: &'g Scope, state: &JointStates<'g>, joint: JointId) -> [Vec3<'g>; 2] {
    let linkage = state.geometry.linkage;
    let model = &state.geometry.mechanism.joint(joint).model;
    let reversed = linkage.reversed[joint.index()];
    let frame = linkage.moved_link(joint, model.offsets().start).frame;
    let of = |axis: &Axis| g.vector(frame.local(if reversed { axis.child } else { axis.parent }));
    let [first, second] = [of(&model.axes[0]), of(&model.axes[1])];
    let angle = state.q[linkage.moved_link(joint, 0).first_coordinate];
    let (sine, cosine) = (angle.sin(), angle.cos());
    let along = first.dot(second) * first;
    [first, along + cosine * (second - along) + sine * first.cross(second)]
}

/// Angular velocity of the child of a universal joint in the tree, relative to the parent.
fn cross_rate<'g>(g: &'g Scope, state: &JointStates<'g>, joint: JointId) -> Vec3<'g> {
    let [first, second] = cross_axes(g, state, joint);
    let rate = |coordinate| state.v[state.geometry.linkage.moved_link(joint, coordinate).first_speed];
    rate(0) * first + rate(1) * second
}

/// Adds what a contact wrench does.
pub fn contact_forces<'g>(
    g: &'g Scope,
    loads: &mut Loads<'g>,
    state: &JointStates<'g>,
    contact: &ContactWrench<'g>,
) {
    let linkage = state.geometry.linkage;
    let joint = contact.joint;
    if state.geometry.mechanism.joint(joint).model.is_loose_guide() {
        return GuidePlace::new(g, state, contact).push(loads, contact.force, contact.moment);
    }
    let model = &state.geometry.mechanism.joint(joint).model;
    if linkage.link_of_joint[joint.index()].is_none() {
        let motion = state.relative_motion(joint);
        let journal = model.is_hinge();
        let (mut moment, mut force) = (g.zero_vector(), g.zero_vector());
        for j in 0..3 {
            let axis = motion.parent_axis(j);
            if !journal || j < 2 {
                force += contact.force[j] * axis;
            }
            if !journal || j == 2 {
                moment += contact.moment[j] * axis;
            }
        }
        return loads.pair(joint, &motion, moment, force);
    }
    for (axis, coordinate) in model.offsets().enumerate() {
        loads.push_along(linkage.moved_link(joint, coordinate).first_speed, contact.force[axis]);
    }
    if model.is_cross() {
        for (coordinate, axis) in cross_axes(g, state, joint).into_iter().enumerate() {
            let speed = linkage.moved_link(joint, coordinate).first_speed;
            loads.push_along(speed, axis.dot(contact.moment));
        }
        return;
    }
    let Some(ball) = linkage.ball_of(joint) else {
        loads.push_along(linkage.moved_link(joint, 0).first_speed, contact.moment[2]);
        return;
    };
    let rotation = state.motion.poses.relative[ball].rotation;
    let (moment, reaction) = if linkage.reversed[joint.index()] {
        // The outboard body is the socket, which feels the opposite in its own frame.
        (-contact.moment, rotation * contact.moment)
    } else {
        (rotation.transpose() * contact.moment, -contact.moment)
    };
    loads.turn(linkage, ball, moment);
    loads.react(g, linkage, ball, reaction);
}
