//! How coordinates move with speeds, group by group. In: motions, coordinates, speeds. Out: places in flat slices, coordinates on
//! the manifold. Never knows equations.

use crate::scalar::{Scalar, cross, dot};
use crate::tables::Motion;

/// One group of coordinates and speeds, with its places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// How the coordinates move.
    pub motion: Motion,
    /// First place among all coordinates.
    pub all_coordinate: usize,
    /// First place among all speeds.
    pub all_speed: usize,
    /// First place among the free coordinates (of the next free group, if this one is driven).
    pub coordinate: usize,
    /// First place among the free speeds (of the next free group, if this one is driven).
    pub speed: usize,
}

impl Motion {
    /// Number of coordinates and speeds.
    pub const fn lengths(self) -> (usize, usize) {
        match self {
            Self::Scalar { .. } => (1, 1),
            Self::Rotation => (4, 3),
            Self::Pose => (7, 6),
        }
    }

    /// Index of the driver that prescribes it.
    pub const fn driver(self) -> Option<usize> {
        match self {
            Self::Scalar { driver } => driver,
            _ => None,
        }
    }
}

/// The groups in tree order, one behind the other.
pub(crate) fn groups(motions: &[Motion]) -> impl Iterator<Item = Group> + '_ {
    let mut next = [0; 4];
    motions.iter().map(move |motion| {
        let [all_coordinate, all_speed, coordinate, speed] = next;
        let (coordinates, speeds) = motion.lengths();
        next[0] += coordinates;
        next[1] += speeds;
        if motion.driver().is_none() {
            next[2] += coordinates;
            next[3] += speeds;
        }
        Group { motion: *motion, all_coordinate, all_speed, coordinate, speed }
    })
}

impl Group {
    /// Whether no driver prescribes it.
    pub fn is_free(&self) -> bool {
        self.motion.driver().is_none()
    }

    /// Moves its part of the free coordinates `q` as the constant free speeds `delta` would in unit time (exponential map; a
    /// quaternion comes out with unit length if it went in so).
    pub(crate) fn advance(&self, q: &mut [f64], delta: &[f64]) {
        let (q, delta) = (&mut q[self.coordinate..], &delta[self.speed..]);
        match self.motion {
            Motion::Scalar { .. } => q[0] += delta[0],
            Motion::Rotation => rotate(q, [delta[0], delta[1], delta[2]]),
            Motion::Pose => displace(q, [delta[0], delta[1], delta[2]], [delta[3], delta[4], delta[5]]),
        }
    }

    /// Scales its quaternion among the free coordinates to unit length, if it has one.
    pub(crate) fn normalize<T: Scalar>(&self, q: &mut [T]) {
        if matches!(self.motion, Motion::Rotation | Motion::Pose) {
            let part = &mut q[self.coordinate..][..4];
            let length = length([part[0], part[1], part[2], part[3]]);
            part.iter_mut().for_each(|x| *x = *x / length);
        }
    }
}

/// Unit quaternion (scalar first) times the rotation by the vector `angle` [rad] in the body's own frame.
pub(crate) fn rotate(q: &mut [f64], angle: [f64; 3]) {
    let [x, y, z] = angle;
    let half = 0.5 * (x * x + y * y + z * z).sqrt();
    let (sine, cosine) = Scalar::sin_cos(half);
    // sin(half) / (2 half); below 1e-4 the next term of the series is 1e-18.
    let factor = if half < 1e-4 { 0.5 - half * half / 12.0 } else { 0.5 * sine / half };
    let [b0, b1, b2, b3] = [cosine, factor * x, factor * y, factor * z];
    let [a0, a1, a2, a3] = [q[0], q[1], q[2], q[3]];
    q[0] = a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3;
    q[1] = a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2;
    q[2] = a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1;
    q[3] = a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0;
}

/// Pose times the exponential of a twist in the body's own frame.
fn displace(q: &mut [f64], angle: [f64; 3], shift: [f64; 3]) {
    let square = dot(angle, angle);
    let size = square.sqrt();
    let (sine, cosine) = Scalar::sin_cos(size);
    // (1 - cos)/x² and (x - sin)/x³; the series' next terms are 1e-13 of x⁴ below 1e-2.
    let (a, b) = if size < 1e-2 {
        (
            0.5 - square / 24.0 + square * square / 720.0,
            1.0 / 6.0 - square / 120.0 + square * square / 5_040.0,
        )
    } else {
        ((1.0 - cosine) / square, (size - sine) / (square * size))
    };
    let once = cross(angle, shift);
    let twice = cross(angle, once);
    let moved: [f64; 3] = core::array::from_fn(|i| shift[i] + a * once[i] + b * twice[i]);
    let global = turn([q[0], q[1], q[2], q[3]], moved);
    for (position, step) in q[4..7].iter_mut().zip(global) {
        *position += step;
    }
    rotate(q, angle);
}

/// Rotates a vector from the body's frame to W by a unit quaternion.
pub fn turn(q: [f64; 4], x: [f64; 3]) -> [f64; 3] {
    let axis = [q[1], q[2], q[3]];
    let once = cross(axis, x);
    let twice = cross(axis, once);
    core::array::from_fn(|i| x[i] + 2.0 * (q[0] * once[i] + twice[i]))
}

/// Length of a quaternion.
#[inline(always)]
fn length<T: Scalar>(quaternion: [T; 4]) -> T {
    dot(quaternion, quaternion).sqrt()
}
