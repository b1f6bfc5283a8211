//! Motion of a body in absolute coordinates, and of points and axes it carries.
//! In: a body's state. Out: positions, velocities, velocity-product accelerations. Never knows joints.

use nalgebra::{Matrix3, Vector3};

/// State of one body: displacement from its OWN reference pose, and absolute twist. All in W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Rotation from the reference pose, about W axes.
    pub rotation: Matrix3<f64>,
    /// Position of the mass centre [m].
    pub centre: Vector3<f64>,
    /// Angular velocity [rad/s].
    pub omega: Vector3<f64>,
    /// Velocity of the mass centre [m/s].
    pub velocity: Vector3<f64>,
}

/// Force [N] and torque about the mass centre [N m] on a body, W axes. Also the coefficients of a
/// constraint row: the row's rate is `force . velocity + torque . omega`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Force.
    pub force: Vector3<f64>,
    /// Torque about the mass centre.
    pub torque: Vector3<f64>,
}

impl Load {
    /// A force that acts `arm` away from the centre.
    pub(crate) fn at(arm: &Vector3<f64>, force: &Vector3<f64>) -> Self {
        Self { force: *force, torque: arm.cross(force) }
    }

    /// Adds `scale` times `other`.
    pub(crate) fn add(&mut self, scale: f64, other: &Self) {
        self.force += scale * other.force;
        self.torque += scale * other.torque;
    }
}

/// A body, or the ground, in motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub state: BodyState,
    /// Mass centre at the reference pose.
    pub reference: Vector3<f64>,
}

/// A material point in motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingPoint {
    /// From the mass centre to the point.
    pub arm: Vector3<f64>,
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    /// The part of the acceleration that does not come from accelerations of the body.
    pub bias: Vector3<f64>,
}

impl Frame {
    pub fn ground() -> Self {
        let zero = Vector3::zeros();
        let state = BodyState { rotation: Matrix3::identity(), centre: zero, omega: zero, velocity: zero };
        Self { state, reference: zero }
    }

    /// The material point that is at `reference` in the reference pose.
    pub fn point(&self, reference: &Vector3<f64>) -> MovingPoint {
        let BodyState { rotation, centre, omega, velocity } = &self.state;
        let arm = rotation * (reference - self.reference);
        let spin = omega.cross(&arm);
        MovingPoint { arm, position: centre + arm, velocity: velocity + spin, bias: omega.cross(&spin) }
    }

    /// The direction that is `reference` in the reference pose, its rate, and the part of its second
    /// derivative without angular acceleration.
    pub fn direction(&self, reference: &Vector3<f64>) -> [Vector3<f64>; 3] {
        let a = self.state.rotation * reference;
        let rate = self.state.omega.cross(&a);
        [a, rate, self.state.omega.cross(&rate)]
    }

    /// Velocity of the material point that is now at `place`.
    pub fn velocity_at(&self, place: &Vector3<f64>) -> Vector3<f64> {
        self.state.velocity + self.state.omega.cross(&(place - self.state.centre))
    }
}

/// Rotation by `angle` about the unit vector `axis` (Rodrigues).
pub(crate) fn rotation_about(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let k = axis.cross_matrix();
    Matrix3::identity() + angle.sin() * k + (1.0 - angle.cos()) * k * k
}

/// Rotation by the rotation vector `w` [rad].
pub(crate) fn rotation_by(w: &Vector3<f64>) -> Matrix3<f64> {
    let angle = w.norm();
    if angle == 0.0 { Matrix3::identity() } else { rotation_about(&(w / angle), angle) }
}

/// Angle in (-pi, pi] about the unit vector `axis` that turns `from` into `to`, both projected.
pub(crate) fn angle_about(axis: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let across = from - axis * axis.dot(from);
    axis.dot(&across.cross(to)).atan2(across.dot(to))
}

/// Two unit vectors that make a right-handed triad with the unit vector `axis`, in the order (1, 2, axis).
pub(crate) fn across(axis: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let mut least = Vector3::zeros();
    least[axis.iamin()] = 1.0;
    let first = least.cross(axis).normalize();
    [first, axis.cross(&first)]
}
