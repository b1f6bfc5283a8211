//! Places where a rod touches its bush, along which it may slide and in which it may tilt: docs/wear-in-more-places.md.
//! In: coordinates of a joint in the tree. Out: motion of the rod's centre there; generalised forces. Never knows laws of contact.
//!
//! In the frame of the bush the rod's centre line goes through the centre of tilting O and has the direction a: first turned about
//! e_x, then about b. What a place of it does follows from the coordinates of the joint alone, so that offsets of micrometres
//! keep their digits. Forces follow from the same velocities by virtual work: the power of a wrench is that of its generalised
//! forces, to the last digit.

use crate::expr::{Expr, Scope, Vec3};
use crate::model::Ends;

use super::contact_wrench::ContactWrench;
use super::joint_state::JointStates;
use super::loads::Loads;

/// A coordinate of the joint: its rate, and the place of its speed among all.
#[derive(Clone, Copy)]
struct Moved<'g> {
    rate: Expr<'g>,
    speed: usize,
}

/// A place where a rod touches its bush; vectors are in the frame of the bush.
pub struct GuidePlace<'g> {
    across: [Moved<'g>; 2],
    /// About e_x and about [`Self::second`].
    tilts: Option<[Moved<'g>; 2]>,
    /// About the rod's centre line.
    turn: Option<Moved<'g>>,
    /// Along [`Self::sliding`].
    slide: Option<Moved<'g>>,
    sliding: Vec3<'g>,
    /// Direction of the rod's centre line, a.
    axis: Vec3<'g>,
    /// Second axis of tilting, b.
    second: Vec3<'g>,
    /// From the centre of tilting to the rod's centre at this place.
    arm: Vec3<'g>,
    /// Rod's centre minus bush's at this place; across the axis.
    offset: [Expr<'g>; 2],
    /// Of a place that is fixed in the bush, how far the centre line leaves the axis per length along it.
    slope: Option<[Expr<'g>; 2]>,
}

impl<'g> GuidePlace<'g> {
    /// Of a joint in the tree.
    pub fn new(g: &'g Scope, state: &JointStates<'g>, contact: &ContactWrench<'g>) -> Self {
        let model = &state.geometry.mechanism.joint(contact.joint).model;
        let link = |number: usize| state.geometry.linkage.moved_link(contact.joint, number);
        let place = |number: usize| state.q[link(number).first_coordinate];
        let moved = |number: usize| {
            let speed = link(number).first_speed;
            Moved { rate: state.v[speed], speed }
        };
        let across = [0, 1].map(|axis| model.offsets().start + axis);
        let tilts = model.tilt.map(|_| [0, 1].map(|tilt| model.tilts().start + tilt));
        let [mut axis, mut second] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]].map(|unit| g.vector(unit));
        let sliding = axis;
        if let Some([first, then]) = tilts.map(|tilts| tilts.map(place)) {
            let ([s1, c1], [s2, c2]) = ([first.sin(), first.cos()], [then.sin(), then.cos()]);
            axis = Vec3([s2, -(s1 * c2), c1 * c2]);
            second = Vec3([g.zero(), c1, s1]);
        }
        // A place of the rod stays one; to a place of the bush the rod brings others as it slides.
        let in_bush = model.tilt == Some(Ends::Bearing);
        let along = g.number(contact.along);
        let arm = if in_bush { along / axis[2] } else { along } * axis;
        Self {
            across: across.map(moved),
            tilts: tilts.map(|tilts| tilts.map(moved)),
            turn: model.turn_about_axis().map(moved),
            slide: model.slide_along_axis().map(moved),
            sliding: if in_bush { axis } else { sliding },
            axis,
            second,
            arm,
            offset: [0, 1].map(|i| place(across[i]) + arm[i]),
            slope: in_bush.then(|| [0, 1].map(|i| axis[i] / axis[2])),
        }
    }

    /// Offset of the rod's centre across the axis, its velocity, angular velocity of the rod relative to the bush.
    pub fn motion(&self, g: &'g Scope) -> [Vec3<'g>; 3] {
        let rate = |moved: Option<Moved<'g>>| moved.map_or(g.zero(), |moved| moved.rate);
        let tilting = match self.tilts {
            Some([first, then]) => then.rate * self.second + Vec3([first.rate, g.zero(), g.zero()]),
            None => g.zero_vector(),
        };
        let [x, y] = self.across.map(|moved| moved.rate);
        let slid = rate(self.slide) * self.sliding;
        let mut velocity = Vec3([x, y, g.zero()]) + slid + tilting.cross(self.arm);
        for (i, slope) in self.slope.into_iter().flatten().enumerate() {
            // Across the axis, of the place where the rod goes through the plane of the bush's end.
            let carried = slope * velocity[2];
            velocity[i] -= carried;
        }
        let [x, y] = self.offset;
        [Vec3([x, y, g.zero()]), velocity, tilting + rate(self.turn) * self.axis]
    }

    /// Adds what a wrench on the rod at this place does: what the velocities of [`Self::motion`] make of its power.
    pub fn push(&self, loads: &mut Loads<'g>, mut force: Vec3<'g>, moment: Vec3<'g>) {
        for (i, slope) in self.slope.into_iter().flatten().enumerate() {
            let carried = slope * force[i];
            force[2] -= carried;
        }
        let mut add = |moved: Option<Moved<'g>>, by: Expr<'g>| {
            if let Some(Moved { speed, .. }) = moved {
                loads.push_along(speed, by);
            }
        };
        let about = moment + self.arm.cross(force);
        let [first, then] = self.tilts.map_or([None; 2], |tilts| tilts.map(Some));
        add(Some(self.across[0]), force[0]);
        add(Some(self.across[1]), force[1]);
        add(first, about[0]);
        add(then, self.second.dot(about));
        add(self.turn, self.axis.dot(moment));
        add(self.slide, self.sliding.dot(force));
    }
}
