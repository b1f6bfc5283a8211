//! Where every group of coordinates lives in the flat slices, and how coordinates move with speeds.
//! In: the motions of a [`crate::Description`]. Out: index maps and updates on the manifold.
//! Never knows equations.

use crate::manifold::groups;
pub use crate::manifold::{Group, turn};
use crate::scalar::Scalar;
use crate::tables::Motion;

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

impl Layout {
    /// Places the motions one behind the other.
    pub fn new(motions: &[Motion]) -> Self {
        let mut layout = Self { groups: groups(motions).collect(), ..Self::default() };
        for motion in motions {
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
        self.groups.iter().filter(|group| group.is_free())
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
        self.free().for_each(|group| group.advance(q, delta));
    }

    /// Scales the quaternions in `q` to unit length.
    pub fn normalize<T: Scalar>(&self, q: &mut [T]) {
        self.free().for_each(|group| group.normalize(q));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::rotate;

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
