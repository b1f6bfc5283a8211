//! Where every group of coordinates lives in the flat slices, and how coordinates move with speeds.
//! In: the motions of a [`crate::Description`]. Out: index maps and updates on the manifold.
//! Never knows equations.

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

/// The groups of a mechanism in tree order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// The groups.
    pub groups: Vec<Group>,
    /// Number of free coordinates.
    pub coordinates: usize,
    /// Number of free speeds.
    pub speeds: usize,
    /// Number of all coordinates.
    pub all_coordinates: usize,
    /// Number of all speeds.
    pub all_speeds: usize,
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

impl Layout {
    /// Places the motions one behind the other.
    pub fn new(motions: &[Motion]) -> Self {
        let mut layout = Self::default();
        for motion in motions {
            layout.groups.push(Group {
                motion: *motion,
                all_coordinate: layout.all_coordinates,
                all_speed: layout.all_speeds,
                coordinate: layout.coordinates,
                speed: layout.speeds,
            });
            let (coordinates, speeds) = motion.lengths();
            layout.all_coordinates += coordinates;
            layout.all_speeds += speeds;
            if motion.driver().is_none() {
                layout.coordinates += coordinates;
                layout.speeds += speeds;
            }
        }
        layout
    }

    /// The free groups.
    pub fn free(&self) -> impl Iterator<Item = &Group> {
        self.groups.iter().filter(|group| group.motion.driver().is_none())
    }

    /// Places among all speeds: of every free speed, and of every driver's speed.
    pub fn speed_places(&self, drivers: usize) -> (Vec<usize>, Vec<usize>) {
        let (mut free, mut driven) = (Vec::with_capacity(self.speeds), vec![0; drivers]);
        for group in &self.groups {
            match group.motion.driver() {
                Some(driver) => driven[driver] = group.all_speed,
                None => free.extend((0..group.motion.lengths().1).map(|i| group.all_speed + i)),
            }
        }
        (free, driven)
    }

    /// Moves the free coordinates `q` as the constant speeds `delta` would in unit time (exponential map;
    /// quaternions come out with unit length if they went in so).
    pub fn advance(&self, q: &mut [f64], delta: &[f64]) {
        for group in self.free() {
            let (q, delta) = (&mut q[group.coordinate..], &delta[group.speed..]);
            match group.motion {
                Motion::Scalar { .. } => q[0] += delta[0],
                Motion::Rotation => rotate(q, [delta[0], delta[1], delta[2]]),
                Motion::Pose => displace(q, [delta[0], delta[1], delta[2]], [delta[3], delta[4], delta[5]]),
            }
        }
    }

    /// Scales the quaternions in `q` to unit length.
    pub fn normalize<T: Scalar>(&self, q: &mut [T]) {
        for group in self.free() {
            if matches!(group.motion, Motion::Rotation | Motion::Pose) {
                let part = &mut q[group.coordinate..][..4];
                let length = length([part[0], part[1], part[2], part[3]]);
                part.iter_mut().for_each(|x| *x = *x / length);
            }
        }
    }

    /// Fills the slices of all coordinates and speeds from the free ones and the prescribed values
    /// (position, speed, acceleration of each driver).
    pub fn expand(&self, state: (&[f64], &[f64]), prescribed: &[f64], all: (&mut [f64], &mut [f64])) {
        let ((q, v), (all_q, all_v)) = (state, all);
        for group in &self.groups {
            if let Motion::Scalar { driver } = group.motion {
                let (position, speed) = match driver {
                    Some(driver) => (prescribed[3 * driver], prescribed[3 * driver + 1]),
                    None => (q[group.coordinate], v[group.speed]),
                };
                (all_q[group.all_coordinate], all_v[group.all_speed]) = (position, speed);
            } else {
                let (coordinates, speeds) = group.motion.lengths();
                all_q[group.all_coordinate..][..coordinates]
                    .copy_from_slice(&q[group.coordinate..][..coordinates]);
                all_v[group.all_speed..][..speeds].copy_from_slice(&v[group.speed..][..speeds]);
            }
        }
    }
}

/// Unit quaternion (scalar first) times the rotation by the vector `angle` [rad] in the body's own frame.
fn rotate(q: &mut [f64], angle: [f64; 3]) {
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

#[cfg(test)]
mod tests {
    use super::*;

    const MOTIONS: [Motion; 4] =
        [Motion::Scalar { driver: Some(0) }, Motion::Rotation, Motion::Scalar { driver: None }, Motion::Pose];

    #[test]
    fn driven_groups_take_no_free_place() {
        let layout = Layout::new(&MOTIONS);
        assert_eq!((layout.coordinates, layout.speeds), (12, 10));
        assert_eq!((layout.all_coordinates, layout.all_speeds), (13, 11));
        let q: Vec<f64> = (0..12).map(f64::from).collect();
        let v: Vec<f64> = (0..10).map(|i| 100.0 + f64::from(i)).collect();
        let (mut all_q, mut all_v) = (vec![0.0; 13], vec![0.0; 11]);
        layout.expand((&q, &v), &[-1.0, -2.0, -3.0], (&mut all_q, &mut all_v));
        assert_eq!((all_q[0], &all_q[1..]), (-1.0, &q[..]));
        assert_eq!((all_v[0], &all_v[1..]), (-2.0, &v[..]));
    }

    #[test]
    fn a_screw_motion_in_two_halves_equals_the_whole() {
        let layout = Layout::new(&[Motion::Pose]);
        let delta = [0.3, -0.4, 1.1, 0.2, 0.5, -0.7];
        for scale in [1.0, 1e-3] {
            let whole: Vec<f64> = delta.iter().map(|x| scale * x).collect();
            let half: Vec<f64> = whole.iter().map(|x| 0.5 * x).collect();
            let start = [0.5, 0.5, -0.5, 0.5, 1.0, 2.0, 3.0];
            let (mut once, mut twice) = (start, start);
            layout.advance(&mut once, &whole);
            layout.advance(&mut twice, &half);
            layout.advance(&mut twice, &half);
            for (a, b) in once.iter().zip(twice) {
                // A constant twist is a one-parameter group; a few roundings of numbers up to 3.
                assert!((a - b).abs() < 2e-15, "{a} {b}");
            }
        }
    }

    #[test]
    fn quarter_turn_about_z_carries_x_to_y() {
        let mut q = [1.0, 0.0, 0.0, 0.0];
        rotate(&mut q, [0.0, 0.0, core::f64::consts::FRAC_PI_2]);
        let [x, y, z] = turn(q, [1.0, 0.0, 0.0]);
        assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15 && z == 0.0);
    }
}
