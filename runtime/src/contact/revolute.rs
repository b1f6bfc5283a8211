//! A journal in its bearing, [CS (9)-(13), (16), (17)]: gap, penetration, sliding, forces on the journal.
//! In: motion of the journal's centre in the bearing's frame, relative speed of the joint, penetration with its gradient.
//! Out: one [`RevoluteContact`], from it one [`ContactForce`]. Never knows generalised coordinates.

use super::laws::{ContactForce, Laws};
use super::memory::ImpactMemory;
use crate::scalar::{Scalar, dot};

/// Squared distances [m²] below this count as zero: there the direction is taken as the first axis.
const CENTRED: f64 = 1e-60;

/// Motion of a journal as its bearing sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevoluteMotion<T> {
    /// Journal centre minus bearing centre, in the bearing's frame [m].
    pub offset: [T; 2],
    /// Its rate in that frame [m/s].
    pub offset_rate: [T; 2],
    /// Speed of the journal relative to the bearing about the third axis [rad/s].
    pub joint_speed: T,
}

/// A gradient shorter than this leads nowhere, and its force is none.
const NOWHERE: f64 = 1e-20;

/// Squared sliding speeds [m²/s²] below this count as this where sliding has several components: the root has no derivative at zero.
pub(super) const AT_REST: f64 = 1e-40;

/// How a bearing meets the centre of its journal: the penetration as a function of the offset.
///
/// The gradient of a round bearing is the unit vector from its centre to that of the journal. A worn bearing has its
/// own normals, and in a corner the journal leans on two places at once: their mean is shorter than one. Forces
/// follow the gradient, so that a worn contact stores and returns energy like a round one. What presses, rubs and wears is their
/// resultant: how many bins share it is a matter of how finely the bearing is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<T> {
    /// Penetration, negative while the bodies are apart [m].
    pub penetration: T,
    /// Its gradient by the offset [1].
    pub gradient: [T; 2],
    /// Length of the gradient; nothing if it is one, as in a round bearing.
    pub length: Option<T>,
    /// Its derivative by the angle of a journal that is not round [m/rad]; nothing of a round one.
    pub turning: Option<T>,
}

impl<T: Scalar> Support<T> {
    /// That of a round bearing with a radial clearance [m], [CS (11)-(13)].
    #[inline]
    pub fn round(offset: [T; 2], clearance: T) -> Self {
        let (distance, normal) = direction(offset);
        Self { penetration: distance - clearance, gradient: normal, length: None, turning: None }
    }

    /// A quarter turn ahead of the gradient, of length one.
    #[inline]
    pub(super) fn tangent(&self) -> [T; 2] {
        let [x, y] = self.gradient;
        let one = |component: T| {
            self.length.map_or(component, |length| component / length.max(T::constant(NOWHERE)))
        };
        [one(-y), one(x)]
    }
}

/// Geometry and sliding of a contact at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevoluteContact<T> {
    /// Penetration, negative while the bodies are apart [m].
    pub penetration: T,
    /// Rate of the penetration [m/s].
    pub penetration_rate: T,
    /// Gradient of the penetration: from the bearing's centre to the contact, of length one in a round bearing.
    pub normal: [T; 2],
    /// A quarter turn ahead of the normal, of length one.
    pub tangent: [T; 2],
    /// Speed of the journal's surface over the bearing's along the tangent [m/s].
    pub sliding_speed: T,
    journal_radius: T,
    /// Length of the normal, if it is not one.
    length: Option<T>,
    /// Derivative of the penetration by the journal's angle [m/rad].
    turning: Option<T>,
}

/// Contact angle atan2(y, x) [rad] of a journal centre at `offset` [m] in the bearing's frame, in
/// (-pi, pi]; zero for a centred journal. Where a profile is to be read.
#[inline]
pub fn bearing_angle<T: Scalar>(offset: [T; 2]) -> T {
    let (_, normal) = direction(offset);
    normal[1].atan2(normal[0])
}

/// Distance and unit vector of an offset; finite, with finite derivatives, also at zero.
#[inline]
pub(super) fn direction<T: Scalar, const N: usize>(offset: [T; N]) -> (T, [T; N]) {
    let c = T::constant;
    let square = dot(offset, offset);
    let centred = square.lt(c(CENTRED));
    let distance = T::select(centred, c(1.0), square).sqrt();
    let instead = |axis: usize| c(if axis == 0 { 1.0 } else { 0.0 });
    let normal = core::array::from_fn(|axis| T::select(centred, instead(axis), offset[axis] / distance));
    (T::select(centred, c(0.0), distance), normal)
}

impl<T: Scalar> RevoluteContact<T> {
    /// Gap and sliding of a journal of radius `journal_radius` [m], [CS (11)-(13), (17)].
    ///
    /// The sliding speed is that of the surfaces: t . offset_rate + r_j joint_speed. [CS (17)] has it
    /// the other way round, bearing minus journal, which is right only for forces on the bearing.
    #[inline]
    pub fn new(motion: &RevoluteMotion<T>, journal_radius: T, support: &Support<T>) -> Self {
        let Support { penetration, gradient: normal, length, turning } = *support;
        let tangent = support.tangent();
        let by_offset = dot(normal, motion.offset_rate);
        Self {
            penetration,
            penetration_rate: turning.map_or(by_offset, |slope| by_offset + slope * motion.joint_speed),
            normal,
            tangent,
            sliding_speed: dot(tangent, motion.offset_rate) + journal_radius * motion.joint_speed,
            journal_radius,
            length,
            turning,
        }
    }

    /// Forces on the journal, [CS (16)] in the direction that takes energy away:
    /// F = -F_n n - mu F_n sign(v_t) t, torque -r_j mu F_n sign(v_t).
    #[inline]
    pub fn force(&self, laws: &Laws, stiffness: T, memory: &ImpactMemory<T>) -> ContactForce<T> {
        let impact_speed = memory.impact_speed(&laws.normal, self.penetration_rate);
        let normal = laws.normal.evaluate(stiffness, self.penetration, self.penetration_rate, impact_speed);
        let pressing = normal.across(self.length);
        let friction_force = laws.friction.signed(self.sliding_speed) * pressing.force;
        let force = |i: usize| -(normal.force * self.normal[i] + friction_force * self.tangent[i]);
        let zero = T::constant(0.0);
        let by_friction = -(self.journal_radius * friction_force);
        // What lifts a journal that is not round out of its contact turns it back.
        let moment = self.turning.map_or(by_friction, |slope| by_friction - normal.force * slope);
        ContactForce {
            normal: pressing,
            force: [force(0), force(1), zero],
            moment: [zero, zero, moment],
            friction_loss: friction_force * self.sliding_speed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Friction, Normal, Onset, Restitution, Strength};
    use crate::dual::Dual;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    fn laws() -> Laws {
        let strength = Strength::Coulomb { coefficient: 0.05 };
        Laws {
            normal: Normal::new(Restitution::LankaraniNikravesh, 0.9, 1.5, 1e-3).unwrap(),
            friction: Friction::new(strength, Onset::Smoothed { speed: 1e-3 }, 0.0).unwrap(),
        }
    }

    const K: f64 = 4.85e11;

    #[test]
    fn a_row_of_the_independent_solution_is_met() {
        // RSSR with 10 µm clearance at R1, Exudyn 1.13.6, row t = 0 of one settled turn: x, y, xdot, ydot,
        // then alpha, p, pdot, F_n; E* = 115 GPa, r_j 10 mm, e 0.9, impact speed at the floor. The speed of
        // the crank is 4 pi rad/s.
        let motion = RevoluteMotion {
            offset: [8.903_622_561e-6, 4.653_009_373e-6],
            offset_rate: [-0.001_318_628_486, 0.002_387_400_265],
            joint_speed: 4.0 * PI,
        };
        let stiffness = crate::contact::Stiffness::Hertz { modulus: 115e9 }.value(0.01, 1e-5);
        let contact = RevoluteContact::new(&motion, 0.01, &Support::round(motion.offset, 1e-5));
        let force = contact.force(&laws(), stiffness, &ImpactMemory::in_contact(0.0));
        // Ten printed digits; p loses two of them against the clearance, F_n has 1.5 times its error.
        assert!((bearing_angle(motion.offset) - 0.481_561_615_3).abs() < 1e-9);
        assert!((contact.penetration / 4.614_308_708e-8 - 1.0).abs() < 1e-7, "{}", contact.penetration);
        // The rate is a difference of numbers of 2e-3 m/s with ten digits.
        assert!((contact.penetration_rate + 6.290_717_92e-5).abs() < 1e-11, "{}", contact.penetration_rate);
        assert!((contact.sliding_speed - 0.128_390_334_8).abs() < 1e-9, "{}", contact.sliding_speed);
        assert!((force.normal.force / 4.765_438_801 - 1.0).abs() < 2e-7, "{}", force.normal.force);
    }

    #[test]
    fn a_centred_journal_gives_numbers() {
        let d = |value, derivative| Dual::new(value, derivative);
        let motion = RevoluteMotion {
            offset: [d(0.0, 1.0), d(0.0, 0.5)],
            offset_rate: [d(0.1, 0.0), d(0.2, 0.0)],
            joint_speed: d(12.0, 0.0),
        };
        let support = Support::round(motion.offset, d(1e-5, 0.0));
        let contact = RevoluteContact::new(&motion, d(0.01, 0.0), &support);
        let force = contact.force(&laws(), d(K, 0.0), &ImpactMemory::apart());
        let angle = bearing_angle(motion.offset);
        assert_eq!((angle.value, contact.penetration.value), (0.0, -1e-5));
        assert_eq!((force.force[0].value, force.force[1].value, force.moment[2].value), (0.0, 0.0, 0.0));
        for x in [angle, contact.penetration_rate, contact.sliding_speed] {
            assert!(x.value.is_finite() && x.derivative.is_finite());
        }
        for x in [force.force[0], force.force[1], force.moment[2], force.friction_loss] {
            assert!(x.value.is_finite() && x.derivative.is_finite());
        }
    }

    #[test]
    fn angles_are_those_of_the_bearing_frame() {
        assert_eq!(bearing_angle([0.0, 2e-5]), PI / 2.0);
        assert_eq!(bearing_angle([-2e-5, 0.0]), PI);
        assert_eq!(bearing_angle([0.0, 0.0]), 0.0);
    }

    #[test]
    fn a_journal_turning_forwards_is_held_back_at_the_contact() {
        let motion = RevoluteMotion { offset: [1.1e-5, 0.0], offset_rate: [0.0, 0.0], joint_speed: 12.0 };
        let contact = RevoluteContact::new(&motion, 0.01, &Support::round(motion.offset, 1e-5));
        let out = contact.force(&laws(), K, &ImpactMemory::in_contact(0.0));
        assert!(out.normal.force > 0.0 && out.moment[2] < 0.0);
        assert_eq!(out.force[0], -out.normal.force);
        // mu F_n against the surface's motion, which at this contact is along +y.
        assert!((out.force[1] / (-0.05 * out.normal.force) - 1.0).abs() < 1e-15);
        assert!((out.moment[2] / (0.01 * out.force[1]) - 1.0).abs() < 1e-15);
    }

    /// A wall: the penetration goes with a constant gradient.
    fn wall<T: Scalar>(x: &[T; 9]) -> Support<T> {
        let gradient = [x[6], x[7]];
        let length = Some(dot(gradient, gradient).sqrt());
        Support { penetration: dot([x[0], x[1]], gradient) - x[5], gradient, length, turning: None }
    }

    /// Inputs as one list: offset, its rate, joint speed, clearance, gradient, impact speed.
    fn evaluate<T: Scalar>(x: [T; 9]) -> ([T; 3], ContactForce<T>) {
        let motion = RevoluteMotion { offset: [x[0], x[1]], offset_rate: [x[2], x[3]], joint_speed: x[4] };
        let contact = RevoluteContact::new(&motion, T::constant(0.01), &wall(&x));
        let out = contact.force(&laws(), T::constant(K), &ImpactMemory::in_contact(x[8]));
        ([out.force[0], out.force[1], out.moment[2]], out)
    }

    fn inputs() -> impl Strategy<Value = [f64; 9]> {
        let round = (0.0..2.0 * PI, -5e-7..5e-7_f64, -0.01..0.01_f64, -0.01..0.01_f64, -20.0..20.0_f64);
        (round, 5e-6..5e-5_f64, 0.5..1.0_f64, -0.5..0.5_f64, 0.0..0.02_f64).prop_map(
            |((angle, p, vx, vy, omega), c, length, lean, impact)| {
                // The journal points a little beside the normal of the wall.
                let (gx, gy) = (length * angle.cos(), length * angle.sin());
                let r = (c + p) / (length * lean.cos());
                [r * (angle + lean).cos(), r * (angle + lean).sin(), vx, vy, omega, c, gx, gy, impact]
            },
        )
    }

    proptest! {
        #[test]
        fn power_of_the_forces_is_stored_or_lost(x in inputs()) {
            let ([fx, fy, torque], out) = evaluate(x);
            let power = fx * x[2] + fy * x[3] + torque * x[4];
            let expected = -(out.normal.elastic_power + out.normal.damping_loss + out.friction_loss);
            // Where damping nearly takes the force away, what is stored and what is lost are larger than the power of the force.
            let terms = out.normal.elastic_power.abs() + out.normal.damping_loss;
            let scale = out.normal.force * (x[2].abs() + x[3].abs() + 0.01 * x[4].abs()) + terms;
            // Some twenty roundings of terms below the scale, which is below three times the largest.
            prop_assert!((power - expected).abs() <= 1e-14 * scale, "{} {}", power, expected);
            prop_assert!(out.friction_loss >= 0.0 && out.normal.damping_loss >= 0.0);
        }

        #[test]
        fn elastic_energy_changes_by_the_elastic_power(x in inputs()) {
            // Along the motion: the offset moves with its rate.
            let mut dual = x.map(Dual::<f64>::constant);
            (dual[0], dual[1]) = (Dual::new(x[0], x[2]), Dual::new(x[1], x[3]));
            let (_, out) = evaluate(dual);
            let scale = out.normal.elastic_power.value.abs() + out.normal.force.value * 0.01;
            // As above.
            prop_assert!((out.normal.elastic_energy.derivative - out.normal.elastic_power.value).abs() <= 1e-14 * scale);
        }

        #[test]
        fn derivatives_of_the_forces_agree_with_central_differences(x in inputs(), index in 0..9_usize) {
            // Kinks (onset of contact, clamp, smoothing, floor) within the step are left out.
            let step = [1e-10, 1e-10, 1e-6, 1e-6, 1e-3, 1e-10, 1e-6, 1e-6, 1e-6][index];
            let shifted = |by: f64| { let mut y = x; y[index] += by; y };
            let motion = |y: [f64; 9]| RevoluteMotion { offset: [y[0], y[1]], offset_rate: [y[2], y[3]], joint_speed: y[4] };
            let sides = [shifted(-step), shifted(step)].map(|y| {
                let contact = RevoluteContact::new(&motion(y), 0.01, &wall(&y));
                let damped = 1.0 + laws().normal.damping_factor() * contact.penetration_rate / y[8].max(1e-3);
                (contact.penetration > 0.0, contact.sliding_speed.abs() < 1e-3, damped > 0.0, y[8] > 1e-3)
            });
            prop_assume!(sides[0] == sides[1]);
            prop_assume!(wall(&x).penetration.abs() > 2e-8);
            let mut dual = x.map(Dual::<f64>::constant);
            dual[index] = Dual::variable(x[index]);
            let (exact, out) = evaluate(dual);
            let (low, high) = (evaluate(shifted(-step)).0, evaluate(shifted(step)).0);
            for i in 0..3 {
                let difference = (high[i] - low[i]) / (2.0 * step);
                // Rounding of a force over the step, and (step/size)² of truncation: sizes are 2e-8 m for
                // the penetration (2e-4 of an offset of 1e-4 m for the gradient), 1e-3 m/s and 0.1 rad/s
                // (r_j omega = 1e-3 m/s) for the speeds.
                let scale = out.normal.force.value * [5e7, 5e7, 1e3, 1e3, 10.0, 5e7, 5e3, 5e3, 1e3][index];
                prop_assert!(
                    (exact[i].derivative - difference).abs() <= 1e-3 * exact[i].derivative.abs() + 2e-4 * scale,
                    "{} {} {}", i, exact[i].derivative, difference
                );
            }
        }
    }
}
