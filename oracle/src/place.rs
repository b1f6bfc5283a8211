//! Placing a body so that a joint has given coordinates and speeds.
//! In: a [`JointMotion`] and the other body's motion. Out: the body's state. Never knows trees.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::frame::{BodyState, Frame, rotation_about};
use crate::joint::{JointGeometry, JointMotion};
use crate::kind::Kind;

impl JointGeometry {
    /// State of the child (`outward`), or of the parent, that gives the joint this motion when the other
    /// body moves like `known`. `reference` is the sought body's mass centre at its reference pose.
    pub fn place(
        &self,
        known: &Frame,
        outward: bool,
        reference: &Vector3<f64>,
        motion: &JointMotion,
    ) -> BodyState {
        let (turn, shift) = self.displacement(&motion.position);
        let k = &known.state;
        let near = usize::from(!outward);
        let rotation = k.rotation * if outward { turn } else { turn.transpose() };
        let parent_rotation = if outward { k.rotation } else { rotation };
        // A free joint's displacement is in W already.
        let d = if self.kind == Kind::Free { shift } else { parent_rotation * shift };
        let point = known.point(&self.points[near]).position + if outward { d } else { -d };
        let centre = point - rotation * (self.points[1 - near] - reference);
        // Joint's relative twist at the child's point, in W.
        let (spin, slip) = self.relative_twist(&parent_rotation, motion);
        let child_point = if outward { point } else { known.point(&self.points[1]).position };
        let sign = if outward { 1.0 } else { -1.0 };
        let omega = k.omega + sign * spin;
        let meeting = known.velocity_at(&child_point) + sign * slip;
        let velocity = meeting + omega.cross(&(centre - child_point));
        BodyState { rotation, centre, omega, velocity }
    }

    /// Rotation of the child relative to the parent, and the child's point relative to the parent's in
    /// parent axes (for a free joint in W).
    fn displacement(&self, q: &[f64]) -> (Matrix3<f64>, Vector3<f64>) {
        let axis = self.parent_axis(2);
        let align = self.triads[0] * self.triads[1].transpose();
        let none = Vector3::zeros();
        match self.kind {
            Kind::Revolute => (rotation_about(&axis, q[0]) * align, none),
            Kind::Prismatic => (align, q[0] * axis),
            Kind::Cylindrical => (rotation_about(&axis, q[0]) * align, q[1] * axis),
            Kind::Screw => (rotation_about(&axis, q[0]) * align, self.lead / TAU * q[0] * axis),
            Kind::Universal => {
                let [a, b] = self.two_axes().map(|axis| Vector3::from(axis.parent));
                (rotation_about(&a, q[0]) * rotation_about(&b, q[1]) * align, none)
            }
            Kind::Planar => {
                let shift = q[0] * self.parent_axis(0) + q[1] * self.parent_axis(1);
                (rotation_about(&axis, q[2]) * align, shift)
            }
            Kind::Slot => (rotation_about(&axis, q[1]) * align, q[0] * self.parent_axis(0)),
            Kind::Inplane => {
                (rotation_by_quaternion(&q[2..6]), q[0] * self.parent_axis(0) + q[1] * self.parent_axis(1))
            }
            Kind::Fixed => (align, none),
            Kind::Distance | Kind::OnSurface => unreachable!("what holds a place places no body"),
            Kind::Inline => (rotation_by_quaternion(&q[1..5]), q[0] * axis),
            Kind::Spherical | Kind::Free => {
                let shift = q.get(4..7).map_or(none, Vector3::from_column_slice);
                (rotation_by_quaternion(&q[..4]), shift)
            }
        }
    }

    fn relative_twist(&self, parent: &Matrix3<f64>, motion: &JointMotion) -> (Vector3<f64>, Vector3<f64>) {
        let v = &motion.speed;
        let axis = parent * self.parent_axis(2);
        let none = Vector3::zeros();
        match self.kind {
            Kind::Revolute => (v[0] * axis, none),
            Kind::Prismatic => (none, v[0] * axis),
            Kind::Cylindrical => (v[0] * axis, v[1] * axis),
            Kind::Screw => (v[0] * axis, self.lead / TAU * v[0] * axis),
            Kind::Universal => {
                let [a, b] = self.two_axes().map(|axis| Vector3::from(axis.parent));
                let b_now = parent * rotation_about(&a, motion.position[0]) * b;
                (v[0] * axis + v[1] * b_now, none)
            }
            Kind::Planar => {
                let slip = parent * (v[0] * self.parent_axis(0) + v[1] * self.parent_axis(1));
                (v[2] * axis, slip)
            }
            Kind::Slot => (v[1] * axis, parent * (v[0] * self.parent_axis(0))),
            Kind::Inplane => {
                let slip = parent * (v[0] * self.parent_axis(0) + v[1] * self.parent_axis(1));
                (Vector3::from_column_slice(&v[2..5]), slip)
            }
            Kind::Fixed => (none, none),
            Kind::Distance | Kind::OnSurface => unreachable!("what holds a place places no body"),
            Kind::Inline => (Vector3::from_column_slice(&v[1..4]), v[0] * axis),
            Kind::Spherical | Kind::Free => {
                let slip = v.get(3..6).map_or(none, Vector3::from_column_slice);
                (Vector3::from_column_slice(&v[..3]), slip)
            }
        }
    }
}

/// Rotation matrix of a quaternion, scalar first.
fn rotation_by_quaternion(q: &[f64]) -> Matrix3<f64> {
    let q = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
    q.to_rotation_matrix().into_inner()
}
