//! Normal force of a contact, [CS (14)] and its relatives. In: penetration and its rate, stiffness,
//! impact speed. Out: force, elastic energy and the power lost. Never knows the geometry.
//!
//! All laws are F = K p^n (1 + chi p_dot / v0), clamped at zero; they differ in chi(e) only, see [`Restitution`].

use super::range::{OutOfRange, checked, not_negative, positive};
use super::restitution::Restitution;
use crate::scalar::Scalar;

/// Impact speed [m/s] below which a contact counts as resting, unless told otherwise.
pub const IMPACT_SPEED_FLOOR: f64 = 1e-3;

/// A normal law with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    damping_factor: f64,
    exponent: f64,
    impact_speed_floor: f64,
}

/// What a normal law gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForce<T> {
    /// F_n >= 0 [N].
    pub force: T,
    /// Energy K p^(n+1)/(n+1) stored in the contact [J].
    pub elastic_energy: T,
    /// Its rate K p^n p_dot at constant K [W].
    pub elastic_power: T,
    /// Power that the contact's damping takes away [W]: F_n p_dot less the elastic power, never below zero.
    pub damping_loss: T,
}

impl<T: Scalar> NormalForce<T> {
    /// The resultant of a force along normals whose mean has this length; the force itself where that is one.
    #[inline]
    pub(super) fn across(self, length: Option<T>) -> Self {
        Self { force: length.map_or(self.force, |length| self.force * length), ..self }
    }
}

impl Normal {
    /// A law by its coefficient of restitution, exponent n of the penetration (1.5 for the sphere law)
    /// and floor of the impact speed [m/s] ([`IMPACT_SPEED_FLOOR`]).
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn new(law: Restitution, restitution: f64, exponent: f64, floor: f64) -> Result<Self, OutOfRange> {
        Self::with_damping_factor(law.damping_factor(restitution)?, exponent, floor)
    }

    /// A law by its damping factor chi.
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn with_damping_factor(chi: f64, exponent: f64, floor: f64) -> Result<Self, OutOfRange> {
        Ok(Self {
            damping_factor: not_negative("damping factor", chi)?,
            exponent: checked("contact exponent", exponent, "at least 1 and finite", |n| {
                n >= 1.0 && n.is_finite()
            })?,
            impact_speed_floor: positive("floor of the impact speed", floor)?,
        })
    }

    /// chi [1].
    pub fn damping_factor(&self) -> f64 {
        self.damping_factor
    }

    /// Exponent n of the penetration.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// Floor of the impact speed [m/s].
    pub fn impact_speed_floor(&self) -> f64 {
        self.impact_speed_floor
    }

    /// The impact speed v0 to use [m/s]: the speed at which the gap closed, but not below the floor.
    #[inline]
    pub fn impact_speed<T: Scalar>(&self, closing_speed: T) -> T {
        closing_speed.max(T::constant(self.impact_speed_floor))
    }

    /// Force and energies at a penetration [m] (negative: apart), its rate [m/s], a stiffness [N/m^n] and
    /// an impact speed [m/s] as [`Self::impact_speed`] gives it.
    #[inline]
    pub fn evaluate<T: Scalar>(
        &self,
        stiffness: T,
        penetration: T,
        penetration_rate: T,
        impact_speed: T,
    ) -> NormalForce<T> {
        let zero = T::constant(0.0);
        let touching = zero.lt(penetration);
        // Apart, a depth of one keeps roots and logarithms and their derivatives finite.
        let depth = T::select(touching, penetration, T::constant(1.0));
        let elastic = T::select(touching, stiffness * self.power(depth), zero);
        let damped = T::constant(1.0) + T::constant(self.damping_factor) * penetration_rate / impact_speed;
        let force = elastic * damped.max(zero);
        NormalForce {
            force,
            elastic_energy: elastic * depth * T::constant(1.0 / (self.exponent + 1.0)),
            elastic_power: elastic * penetration_rate,
            damping_loss: (force - elastic) * penetration_rate,
        }
    }

    /// Penetration [m] at which a resting contact carries `force` [N]: (F/K)^(1/n), zero for no force.
    #[inline]
    pub fn resting_penetration<T: Scalar>(&self, stiffness: T, force: T) -> T {
        let loaded = T::constant(0.0).lt(force);
        let ratio = T::select(loaded, force, stiffness) / stiffness;
        T::select(loaded, (ratio.ln() * T::constant(1.0 / self.exponent)).exp(), T::constant(0.0))
    }

    /// `depth^n` for a depth above zero; exact roots for the usual exponents.
    #[inline]
    fn power<T: Scalar>(&self, depth: T) -> T {
        if self.exponent == 1.5 {
            depth * depth.sqrt()
        } else if self.exponent == 1.0 {
            depth
        } else {
            (depth.ln() * T::constant(self.exponent)).exp()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use proptest::prelude::*;

    #[test]
    fn constants_out_of_range_are_refused() {
        let law = |e, n, floor| Normal::new(Restitution::LankaraniNikravesh, e, n, floor);
        assert_eq!(law(0.9, 0.5, 1e-3).unwrap_err().name, "contact exponent");
        assert_eq!(law(0.9, 1.5, 0.0).unwrap_err().name, "floor of the impact speed");
        assert_eq!(Normal::with_damping_factor(-1.0, 1.5, 1e-3).unwrap_err().name, "damping factor");
    }

    #[test]
    fn printed_form_of_lankarani_and_nikravesh() {
        let law = Normal::new(Restitution::LankaraniNikravesh, 0.9, 1.5, 1e-3).unwrap();
        let (k, p, rate, v0) = (4.8e11, 2e-7, -3e-4, 5e-3);
        let n = law.evaluate(k, p, rate, v0);
        let spring = k * p.powf(1.5);
        let printed = spring + 3.0 * k * (1.0 - 0.81) * p.powf(1.5) / (4.0 * v0) * rate;
        // Two spellings of the same formula: some roundings.
        assert!((n.force / printed - 1.0).abs() < 1e-14);
    }

    #[test]
    fn general_exponent_meets_the_exact_roots() {
        let at = |exponent| {
            Normal::with_damping_factor(0.3, exponent, 1e-3).unwrap().evaluate(1e9, 3e-6, 0.01, 0.02)
        };
        for (exact, near) in [(1.5, 1.5 + 1e-13), (1.0, 1.0 + 1e-13)] {
            // p^1e-13 - 1 is 1.3e-12; exp and ln add a few ulp of ln p^n, 20.
            assert!((at(near).force / at(exact).force - 1.0).abs() < 2e-12);
        }
    }

    #[test]
    fn force_is_zero_apart_and_never_pulls() {
        let law = Normal::with_damping_factor(1.4, 1.5, 1e-3).unwrap();
        for p in [-1e-3, -1e-12, 0.0] {
            let c = Dual::constant;
            let n = law.evaluate(c(1e9), Dual::variable(p), c(-0.5), c(0.1));
            assert_eq!((n.force.value, n.force.derivative), (0.0, 0.0));
            assert_eq!((n.elastic_energy.value, n.damping_loss.value), (0.0, 0.0));
        }
        assert_eq!(law.evaluate(1e9, 1e-6, -5.0, 0.1).force, 0.0);
        assert_eq!(law.impact_speed(1e-4), 1e-3);
        assert_eq!(law.impact_speed(2e-3), 2e-3);
    }

    #[test]
    fn resting_penetration_carries_the_force() {
        for exponent in [1.0, 1.5, 2.2] {
            let law = Normal::with_damping_factor(0.2, exponent, 1e-3).unwrap();
            let p = law.resting_penetration(4.8e11, 32.0);
            // exp and ln: a few ulp of |ln p| = 24.
            assert!((law.evaluate(4.8e11, p, 0.0, 1e-3).force / 32.0 - 1.0).abs() < 2e-14);
            assert_eq!(law.resting_penetration(4.8e11, 0.0), 0.0);
        }
    }

    proptest! {
        #[test]
        fn force_times_rate_is_stored_or_lost(
            p in -1e-6..1e-5_f64, rate in -1.0..1.0_f64, chi in 0.0..5.0_f64, n in 1.0..2.5_f64, v0 in 1e-3..1.0_f64,
        ) {
            let law = Normal::with_damping_factor(chi, n, 1e-3).unwrap();
            let out = law.evaluate(1e10, p, rate, v0);
            prop_assert!(out.force >= 0.0 && out.damping_loss >= 0.0);
            let scale = out.force * rate.abs() + out.elastic_power.abs();
            // Four products and sums of numbers below the scale.
            prop_assert!((out.force * rate - out.elastic_power - out.damping_loss).abs() <= 1e-15 * scale);
            let moving = law.evaluate(
                Dual::constant(1e10), Dual::new(p, rate), Dual::constant(rate), Dual::constant(v0),
            );
            let stored = moving.elastic_energy.derivative;
            // exp and ln of the general exponent: a few ulp of n |ln p| = 70.
            prop_assert!((stored - out.elastic_power).abs() <= 1e-13 * out.elastic_power.abs());
        }
    }
}
