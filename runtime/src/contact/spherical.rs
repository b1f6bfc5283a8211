//! A ball in its socket: gap, penetration, sliding, force and moment on the ball.
//! In: motion of the ball's centre in the socket's frame, relative angular velocity, clearance.
//! Out: one [`SphericalContact`], from it one [`ContactForce`]. Never knows generalised coordinates.
//!
//! The same laws as in [`super::revolute`], with vectors for the tangential parts.

use super::laws::{ContactForce, Laws};
use super::memory::ImpactMemory;
use super::revolute::{AT_REST, direction};
use crate::scalar::{Scalar, cross, dot};

/// Motion of a ball as its socket sees it; components in the socket's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalMotion<T> {
    /// Ball centre minus socket centre [m].
    pub offset: [T; 3],
    /// Its rate in that frame [m/s].
    pub offset_rate: [T; 3],
    /// Angular velocity of the ball relative to the socket [rad/s].
    pub angular_velocity: [T; 3],
}

/// Geometry and sliding of a contact at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalContact<T> {
    /// Penetration, negative while the bodies are apart [m].
    pub penetration: T,
    /// Rate of the penetration [m/s].
    pub penetration_rate: T,
    /// Unit vector from the socket's centre to the contact.
    pub normal: [T; 3],
    /// Velocity of the ball's surface over the socket's, at a right angle to the normal [m/s].
    pub sliding_velocity: [T; 3],
    /// Its magnitude [m/s].
    pub sliding_speed: T,
    ball_radius: T,
}

#[inline(always)]
fn scaled<T: Scalar>(a: [T; 3], factor: T) -> [T; 3] {
    a.map(|component| component * factor)
}

impl<T: Scalar> SphericalContact<T> {
    /// Gap and sliding of a ball of radius `ball_radius` [m] with a radial clearance [m].
    #[inline]
    pub fn new(motion: &SphericalMotion<T>, ball_radius: T, clearance: T) -> Self {
        let (distance, normal) = direction(motion.offset);
        let penetration_rate = dot(normal, motion.offset_rate);
        let turning = cross(motion.angular_velocity, scaled(normal, ball_radius));
        let sliding = |i: usize| (motion.offset_rate[i] - penetration_rate * normal[i]) + turning[i];
        let sliding_velocity = [sliding(0), sliding(1), sliding(2)];
        Self {
            penetration: distance - clearance,
            penetration_rate,
            normal,
            sliding_velocity,
            sliding_speed: dot(sliding_velocity, sliding_velocity).max(T::constant(AT_REST)).sqrt(),
            ball_radius,
        }
    }

    /// Force and moment on the ball: -F_n n - mu F_n v_t/|v_t|, moment r n x (friction force).
    #[inline]
    pub fn force(&self, laws: &Laws, stiffness: T, memory: &ImpactMemory<T>) -> ContactForce<T> {
        let impact_speed = memory.impact_speed(&laws.normal, self.penetration_rate);
        let normal = laws.normal.evaluate(stiffness, self.penetration, self.penetration_rate, impact_speed);
        let drag = laws.friction.over_speed(self.sliding_speed) * normal.force;
        let friction_force = scaled(self.sliding_velocity, -drag);
        let total = |i: usize| friction_force[i] - normal.force * self.normal[i];
        ContactForce {
            normal,
            force: [total(0), total(1), total(2)],
            moment: cross(scaled(self.normal, self.ball_radius), friction_force),
            friction_loss: drag * dot(self.sliding_velocity, self.sliding_velocity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{
        Friction, Normal, Onset, Restitution, RevoluteContact, RevoluteMotion, Strength, Support,
    };
    use crate::dual::Dual;
    use proptest::prelude::*;

    const K: f64 = 4.85e11;

    fn laws() -> Laws {
        let strength = Strength::Coulomb { coefficient: 0.05 };
        Laws {
            normal: Normal::new(Restitution::HuntCrossley, 0.8, 1.5, 1e-3).unwrap(),
            friction: Friction::new(strength, Onset::Smoothed { speed: 1e-3 }, 0.1).unwrap(),
        }
    }

    #[test]
    fn a_ball_turning_about_the_axis_is_a_journal() {
        let flat = RevoluteMotion { offset: [8e-6, 7e-6], offset_rate: [-1e-3, 2e-3], joint_speed: 11.0 };
        let journal = RevoluteContact::new(&flat, 0.01, &Support::round(flat.offset, 1e-5));
        let plane = journal.force(&laws(), K, &ImpactMemory::in_contact(2e-3));
        let motion = SphericalMotion {
            offset: [8e-6, 7e-6, 0.0],
            offset_rate: [-1e-3, 2e-3, 0.0],
            angular_velocity: [0.0, 0.0, 11.0],
        };
        let ball = SphericalContact::new(&motion, 0.01, 1e-5);
        let space = ball.force(&laws(), K, &ImpactMemory::in_contact(2e-3));
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * plane.normal.force;
        assert!(plane.normal.force > 0.0);
        // The same formulas in another order of operations.
        assert!(same(space.force[0], plane.force[0]) && same(space.force[1], plane.force[1]));
        assert!(same(space.moment[2], plane.moment[2]) && same(space.force[2], 0.0));
        assert!(same(space.friction_loss, plane.friction_loss));
    }

    #[test]
    fn a_centred_ball_at_rest_gives_numbers() {
        let zero = [Dual::variable(0.0); 3];
        let motion = SphericalMotion { offset: zero, offset_rate: zero, angular_velocity: zero };
        for clearance in [1e-5, -1e-6] {
            let contact = SphericalContact::new(&motion, Dual::constant(0.01), Dual::constant(clearance));
            let out =
                contact.force(&laws(), Dual::constant(K), &ImpactMemory::in_contact(Dual::constant(0.0)));
            for x in [
                contact.sliding_speed,
                contact.penetration_rate,
                out.friction_loss,
                out.force[0],
                out.moment[1],
            ] {
                assert!(x.value.is_finite() && x.derivative.is_finite());
            }
        }
    }

    proptest! {
        #[test]
        fn power_of_the_forces_is_stored_or_lost(
            direction in prop::array::uniform3(-1.0..1.0_f64), p in -5e-7..5e-7_f64,
            rate in prop::array::uniform3(-0.01..0.01_f64), omega in prop::array::uniform3(-5.0..5.0_f64),
            impact in 0.0..0.02_f64,
        ) {
            let length = dot(direction, direction).sqrt();
            prop_assume!(length > 0.1);
            let offset = direction.map(|d| d * (1e-5 + p) / length);
            let motion = SphericalMotion { offset, offset_rate: rate, angular_velocity: omega };
            let contact = SphericalContact::new(&motion, 0.01, 1e-5);
            let out = contact.force(&laws(), K, &ImpactMemory::in_contact(impact));
            let power = dot(out.force, rate) + dot(out.moment, omega);
            let expected = -(out.normal.elastic_power + out.normal.damping_loss + out.friction_loss);
            // Some thirty roundings of terms below F_n times the largest speed, 0.02 + 0.01 * 9 m/s, and of what is stored and lost, which
            // is larger where damping nearly takes the force away.
            let terms = out.normal.elastic_power.abs() + out.normal.damping_loss;
            prop_assert!((power - expected).abs() <= 1e-14 * (0.2 * out.normal.force + terms));
            prop_assert!(dot(contact.sliding_velocity, contact.normal).abs() < 1e-16);
            prop_assert!(out.friction_loss >= 0.0);
        }
    }
}
