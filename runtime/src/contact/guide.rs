//! A rod at one place of its bush along which it may slide: gap, penetration, sliding round and along, forces on the rod.
//! In: motion of the rod's centre at that place in the bush's frame, relative angular velocity, penetration with its gradient.
//! Out: one [`GuideContact`], from it one [`ContactForce`]. Never knows generalised coordinates.
//!
//! The laws of [`super::revolute`]; friction acts against the whole sliding velocity, its part along the axis included.

use super::laws::{ContactForce, Laws};
use super::memory::ImpactMemory;
use super::revolute::{AT_REST, Support};
use crate::scalar::{Scalar, dot};

/// Motion of a rod at one place of its bush, as the bush sees it; the third axis is that of the bush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideMotion<T> {
    /// Rod centre minus bush centre across the axis [m].
    pub offset: [T; 2],
    /// Its rate across the axis, and the speed of the rod along it [m/s].
    pub offset_rate: [T; 3],
    /// Angular velocity of the rod relative to the bush [rad/s].
    pub angular_velocity: [T; 3],
}

/// Geometry and sliding of a contact at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideContact<T> {
    /// Penetration, negative while the bodies are apart [m].
    pub penetration: T,
    /// Rate of the penetration [m/s].
    pub penetration_rate: T,
    /// Gradient of the penetration: from the bush's centre to the contact, of length one in a round bush.
    pub normal: [T; 2],
    /// A quarter turn ahead of the normal, of length one.
    pub tangent: [T; 2],
    /// Speed of the rod's surface over the bush's round the axis and along it [m/s].
    pub sliding_velocity: [T; 2],
    /// Its magnitude [m/s].
    pub sliding_speed: T,
    rod_radius: T,
    /// Length of the normal, if it is not one.
    length: Option<T>,
}

impl<T: Scalar> GuideContact<T> {
    /// Gap and sliding of a rod of radius `rod_radius` [m].
    ///
    /// The surface at the contact lies at r n from the rod's centre. It moves with offset_rate + omega x r n: round the axis
    /// by t . offset_rate + r omega_z, along it by offset_rate_z - r t . omega.
    #[inline]
    pub fn new(motion: &GuideMotion<T>, rod_radius: T, support: &Support<T>) -> Self {
        let Support { penetration, gradient: normal, length, .. } = *support;
        let tangent = support.tangent();
        let [vx, vy, vz] = motion.offset_rate;
        let [wx, wy, wz] = motion.angular_velocity;
        let sliding_velocity =
            [dot(tangent, [vx, vy]) + rod_radius * wz, vz - rod_radius * dot(tangent, [wx, wy])];
        Self {
            penetration,
            penetration_rate: dot(normal, [vx, vy]),
            normal,
            tangent,
            sliding_velocity,
            sliding_speed: dot(sliding_velocity, sliding_velocity).max(T::constant(AT_REST)).sqrt(),
            rod_radius,
            length,
        }
    }

    /// Force on the rod and moment about its centre at this place: -F_n n - mu F_n v_s/|v_s|, and r n x that of friction.
    #[inline]
    pub fn force(&self, laws: &Laws, stiffness: T, memory: &ImpactMemory<T>) -> ContactForce<T> {
        let impact_speed = memory.impact_speed(&laws.normal, self.penetration_rate);
        let normal = laws.normal.evaluate(stiffness, self.penetration, self.penetration_rate, impact_speed);
        let pressing = normal.across(self.length);
        let drag = laws.friction.over_speed(self.sliding_speed) * pressing.force;
        let [round, along] = self.sliding_velocity.map(|speed| -(drag * speed));
        let across = |i: usize| round * self.tangent[i] - normal.force * self.normal[i];
        let lever = -(self.rod_radius * along);
        ContactForce {
            normal: pressing,
            force: [across(0), across(1), along],
            moment: [lever * self.tangent[0], lever * self.tangent[1], self.rod_radius * round],
            friction_loss: drag * dot(self.sliding_velocity, self.sliding_velocity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{
        Friction, Normal, Onset, Restitution, RevoluteContact, RevoluteMotion, SphericalContact,
        SphericalMotion, Strength,
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

    fn both(motion: &GuideMotion<f64>) -> (GuideContact<f64>, ContactForce<f64>) {
        let contact = GuideContact::new(motion, 0.01, &Support::round(motion.offset, 1e-5));
        (contact, contact.force(&laws(), K, &ImpactMemory::in_contact(2e-3)))
    }

    #[test]
    fn a_rod_that_only_turns_is_a_journal() {
        let flat = RevoluteMotion { offset: [8e-6, 7e-6], offset_rate: [-1e-3, 2e-3], joint_speed: 11.0 };
        let journal = RevoluteContact::new(&flat, 0.01, &Support::round(flat.offset, 1e-5));
        let plane = journal.force(&laws(), K, &ImpactMemory::in_contact(2e-3));
        let (contact, rod) = both(&GuideMotion {
            offset: flat.offset,
            offset_rate: [-1e-3, 2e-3, 0.0],
            angular_velocity: [0.0, 0.0, 11.0],
        });
        // The same formulas in another order of operations.
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * plane.normal.force;
        assert!(plane.normal.force > 0.0 && same(contact.sliding_speed, journal.sliding_speed.abs()));
        assert!(same(rod.force[0], plane.force[0]) && same(rod.force[1], plane.force[1]));
        assert!(same(rod.moment[2], plane.moment[2]) && same(rod.friction_loss, plane.friction_loss));
    }

    #[test]
    fn a_rod_that_slides_along_its_bush_is_held_back_along_it() {
        let (contact, rod) = both(&GuideMotion {
            offset: [1.1e-5, 0.0],
            offset_rate: [0.0, 0.0, 0.3],
            angular_velocity: [0.0; 3],
        });
        assert_eq!(contact.sliding_velocity, [0.0, 0.3]);
        // mu with its slope, far above the speed of smoothing.
        let friction = (0.05 + 0.1 * 0.3) * rod.normal.force;
        assert!((rod.force[2] / -friction - 1.0).abs() < 1e-12, "{}", rod.force[2]);
        // It acts at the contact, r from the centre along x: r e_x x (-friction e_z) = r friction e_y.
        assert!((rod.moment[1] / (0.01 * friction) - 1.0).abs() < 1e-12, "{:?}", rod.moment);
        assert!(rod.force[1].abs() < 1e-12 * friction && rod.moment[2].abs() < 1e-12 * friction);
    }

    #[test]
    fn a_centred_rod_at_rest_gives_numbers() {
        let zero = [Dual::variable(0.0); 3];
        let motion = GuideMotion { offset: [zero[0], zero[1]], offset_rate: zero, angular_velocity: zero };
        for clearance in [1e-5, -1e-6] {
            let support = Support::round(motion.offset, Dual::constant(clearance));
            let contact = GuideContact::new(&motion, Dual::constant(0.01), &support);
            let out =
                contact.force(&laws(), Dual::constant(K), &ImpactMemory::in_contact(Dual::constant(0.0)));
            for x in [contact.sliding_speed, contact.penetration_rate, out.force[2], out.moment[1]] {
                assert!(x.value.is_finite() && x.derivative.is_finite());
            }
        }
    }

    proptest! {
        #[test]
        fn power_of_the_forces_is_stored_or_lost(
            angle in 0.0..6.3_f64, p in -5e-7..5e-7_f64, rate in prop::array::uniform3(-0.01..0.01_f64),
            omega in prop::array::uniform3(-5.0..5.0_f64), gradient in 0.5..1.0_f64, impact in 0.0..0.02_f64,
        ) {
            let (sine, cosine) = angle.sin_cos();
            let offset = [(1e-5 + p) * cosine, (1e-5 + p) * sine];
            let motion = GuideMotion { offset, offset_rate: rate, angular_velocity: omega };
            // In a corner of a worn bush the gradient is shorter than one.
            let support = Support {
                penetration: p, gradient: [gradient * cosine, gradient * sine], length: Some(gradient), turning: None,
            };
            let contact = GuideContact::new(&motion, 0.01, &support);
            let out = contact.force(&laws(), K, &ImpactMemory::in_contact(impact));
            let power = dot(out.force, rate) + dot(out.moment, omega);
            let expected = -(out.normal.elastic_power + out.normal.damping_loss + out.friction_loss);
            // Some thirty roundings of terms below F_n times the largest speed, 0.02 + 0.01 * 9 m/s, and of what is stored and lost, which
            // is larger where damping nearly takes the force away.
            let terms = out.normal.elastic_power.abs() + out.normal.damping_loss;
            prop_assert!((power - expected).abs() <= 1e-14 * (0.2 * out.normal.force + terms));
            prop_assert!(out.friction_loss >= 0.0);
        }

        #[test]
        fn a_ball_at_the_same_place_slides_alike(
            angle in 0.0..6.3_f64, rate in prop::array::uniform3(-0.01..0.01_f64),
            omega in prop::array::uniform3(-5.0..5.0_f64),
        ) {
            // A ball whose centre lies in the plane of this place touches where the rod does.
            let (sine, cosine) = angle.sin_cos();
            let offset = [1.05e-5 * cosine, 1.05e-5 * sine];
            let (contact, rod) = both(&GuideMotion { offset, offset_rate: rate, angular_velocity: omega });
            let motion = SphericalMotion {
                offset: [offset[0], offset[1], 0.0], offset_rate: rate, angular_velocity: omega,
            };
            let ball = SphericalContact::new(&motion, 0.01, 1e-5);
            let other = ball.force(&laws(), K, &ImpactMemory::in_contact(2e-3));
            // Rounding of a force of some newtons, magnified by the difference of offset and clearance.
            let bound = 1e-12 * other.normal.force.max(1.0);
            prop_assert!((contact.sliding_speed - ball.sliding_speed).abs() < 1e-15);
            for axis in 0..3 {
                prop_assert!((rod.force[axis] - other.force[axis]).abs() <= bound);
                prop_assert!((rod.moment[axis] - other.moment[axis]).abs() <= bound);
            }
        }
    }
}
