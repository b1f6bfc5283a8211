//! Wear of an ideal joint from its reaction: no clearance, no contact, for design studies. In: sampled rows of a
//! [`Run`]. Out: the numbers of a measured turn. Never knows contacts.
//!
//! F_n is the reaction across the axis (of a ball the whole), v_t the journal radius times the joint's speed (of a
//! ball the part across the force). The quadrature over evenly spaced samples is the trapezoidal rule with Gregory's
//! end corrections: order 4 where both are smooth, order 2 where the sliding turns round.

use super::run::Run;
use crate::clearance_joint::Clearance;
use crate::error::SetupError;
use crate::scalar::{cross, dot};
use crate::wear::{ContactMeasure, Load};

/// Where the motion of an ideal joint is found.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion {
    /// Channel of the joint's speed, unit vector along its axis in W.
    Revolute { speed: usize, axis: [f64; 3] },
    /// First channels of the absolute angular velocities of child and parent; no parent: the ground.
    Ball { child: usize, parent: Option<usize> },
}

/// A joint without clearance whose wear is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealJoint {
    /// First of the three force channels, parent on child in W.
    force: usize,
    motion: Motion,
    radius: f64,
}

impl IdealJoint {
    /// A revolute joint with its axis [any length, in W] and journal radius [m]. The axis has to keep its direction: a
    /// joint on the ground, or of a planar mechanism.
    ///
    /// # Errors
    /// If the run has no columns of such a joint, or axis or radius make no sense.
    pub fn revolute(run: &Run, joint: &str, axis: [f64; 3], journal_radius: f64) -> Result<Self, SetupError> {
        let length = length(axis);
        positive("length of the axis", length)?;
        positive("journal radius", journal_radius)?;
        let speed = find(run, joint, "v")?;
        let motion = Motion::Revolute { speed, axis: axis.map(|x| x / length) };
        Ok(Self { force: find(run, joint, "Fx")?, motion, radius: journal_radius })
    }

    /// A spherical joint between two bodies (no parent: the ground) with the radius of its ball [m].
    ///
    /// # Errors
    /// If the run has no columns of such a joint or bodies, or the radius makes no sense.
    pub fn ball(
        run: &Run,
        joint: &str,
        (parent, child): (Option<&str>, &str),
        radius: f64,
    ) -> Result<Self, SetupError> {
        positive("radius of the ball", radius)?;
        let parent = parent.map(|body| find(run, body, "wx")).transpose()?;
        let motion = Motion::Ball { child: find(run, child, "wx")?, parent };
        Ok(Self { force: find(run, joint, "Fx")?, motion, radius })
    }

    /// Normal force [N] and sliding speed [m/s] of one sampled row.
    pub fn normal_force_and_speed(&self, row: &[f64]) -> (f64, f64) {
        let three = |at: usize| [row[at], row[at + 1], row[at + 2]];
        let force = three(self.force);
        match self.motion {
            Motion::Revolute { speed, axis } => (length(cross(axis, force)), self.radius * row[speed]),
            Motion::Ball { child, parent } => {
                let (child, parent) = (three(child), parent.map_or([0.0; 3], three));
                let turning = [child[0] - parent[0], child[1] - parent[1], child[2] - parent[2]];
                let size = length(force);
                let across = if size > 0.0 { length(cross(turning, force)) / size } else { length(turning) };
                (size, self.radius * across)
            }
        }
    }

    /// What the joint did over the samples of a run. `wear`: laws of a joint and the clearance [m] whose contact area
    /// counts, the contact taken as resting at every instant.
    pub fn measure(&self, run: &Run, wear: Option<(&Clearance, f64)>) -> ContactMeasure {
        let count = run.times.len();
        let mut measure = ContactMeasure::default();
        let [first, .., last] = run.times[..] else { return measure };
        let spacing = (last - first) / (count - 1) as f64;
        for (index, row) in run.rows.iter().enumerate() {
            let weight = spacing * gregory(index, count);
            let (normal_force, sliding_speed) = self.normal_force_and_speed(row);
            measure.wear_integral += weight * normal_force * sliding_speed.abs();
            measure.mean_force += weight * normal_force / (last - first);
            measure.peak_force = measure.peak_force.max(normal_force);
            if let Some((joint, clearance)) = wear
                && let Some((archard, _)) = joint.wear()
            {
                let penetration = joint.resting_penetration(clearance, normal_force);
                let load = Load { normal_force, penetration, sliding_speed };
                measure.depth += weight * archard.rates(&load, &joint.pair(clearance)).depth;
            }
        }
        measure
    }
}

/// Weight of sample `index` among `count` evenly spaced ones, in spacings: order 4 from six samples on, below
/// the trapezoidal rule.
fn gregory(index: usize, count: usize) -> f64 {
    const ENDS: [f64; 3] = [3.0 / 8.0, 7.0 / 6.0, 23.0 / 24.0];
    let from_end = index.min(count - 1 - index);
    if count < 6 { if from_end == 0 { 0.5 } else { 1.0 } } else { ENDS.get(from_end).copied().unwrap_or(1.0) }
}

fn find(run: &Run, element: &str, quantity: &str) -> Result<usize, SetupError> {
    Ok(run.index(&format!("{element}.{quantity}"))?)
}

fn positive(name: &'static str, value: f64) -> Result<(), SetupError> {
    let fits = value > 0.0 && value.is_finite();
    if fits { Ok(()) } else { Err(SetupError::Setting { name, value, need: "finite and above 0" }) }
}

fn length(vector: [f64; 3]) -> f64 {
    dot(vector, vector).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_integrate_cubics_exactly_and_periods_closely() {
        for count in [6, 7, 20, 101] {
            let h = 1.0 / (count - 1) as f64;
            let sum = |f: &dyn Fn(f64) -> f64| -> f64 {
                (0..count).map(|i| h * gregory(i, count) * f(i as f64 * h)).sum()
            };
            // A quadratic is exact from the weights on; rounding of up to a hundred terms.
            assert!((sum(&|x| x * x) - 1.0 / 3.0).abs() < 1e-14, "{count}");
        }
        let wave = |x: f64| 1.0 / (2.0 + (2.0 * std::f64::consts::PI * x).cos());
        let sum: f64 = (0..=60).map(|i| gregory(i, 61) / 60.0 * wave(i as f64 / 60.0)).sum();
        // 1/sqrt(3); the trapezoidal rule is off by 1e-34, the end corrections by about h⁵ times a fourth
        // derivative of (2 pi)⁴: 1e-6.
        assert!((sum - 1.0 / f64::sqrt(3.0)).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn a_revolute_joint_slides_by_its_speed_and_a_ball_across_its_force() {
        let row = [3.0, 4.0, 7.0, 2.0, 1.0, 0.0, 0.0];
        let joint = IdealJoint {
            force: 0,
            motion: Motion::Revolute { speed: 3, axis: [0.0, 0.0, 1.0] },
            radius: 0.01,
        };
        assert_eq!(joint.normal_force_and_speed(&row), (5.0, 0.02));
        let row = [0.0, 0.0, 5.0, 3.0, 4.0, 9.0, 0.0, 4.0, 0.0];
        let ball = IdealJoint { force: 0, motion: Motion::Ball { child: 3, parent: Some(6) }, radius: 0.1 };
        let (force, speed) = ball.normal_force_and_speed(&row);
        // Turning across the force: 3 rad/s; one product and one root.
        assert!((force - 5.0).abs() < 1e-15 && (speed - 0.3).abs() < 1e-16);
    }
}
