//! Normal force of a contact, [CS (14), (15)] and its relatives. In: penetration and its rate, stiffness,
//! impact speed. Out: force, elastic energy and the power lost. Never knows the geometry.
//!
//! All laws are F = K p^n (1 + chi p_dot / v0), clamped at zero; they differ in chi(e) only. Then p_dot as a
//! function of p scales with K, the mass and v0, and the restitution that comes out depends on chi alone:
//! G(1) = G(-e) with G(u) = u/chi - ln(1 + chi u)/chi².

use super::OutOfRange;
use super::range::{checked, positive};
use crate::Scalar;

/// Impact speed [m/s] below which a contact counts as resting, unless told otherwise.
pub const IMPACT_SPEED_FLOOR: f64 = 1e-3;

/// How the damping factor chi follows from the coefficient of restitution e.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Restitution {
    /// chi = 3/4 (1 - e²): Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369-376. What it returns is
    /// above e: 0.7252 for 0.5, 0.9132 for 0.9.
    LankaraniNikravesh,
    /// The chi that returns e exactly.
    Exact,
    /// chi = 3/2 (1 - e): Hunt & Crossley, J. Appl. Mech. 42 (1975) 440-445.
    HuntCrossley,
    /// chi = 8 (1 - e) / (5 e): Flores, Machado, Silva & Martins, Multibody Syst. Dyn. 25 (2011) 357-375.
    Flores,
    /// chi = 3/4 (1 - e): Lee & Wang, J. Mech. Des. 105 (1983) 188-193.
    LeeWang,
}

impl Restitution {
    /// The damping factor chi [1] for a coefficient of restitution e.
    ///
    /// # Errors
    /// If e is outside [0, 1], or zero where the law divides by it (`Exact`, `Flores`).
    pub fn damping_factor(self, e: f64) -> Result<f64, OutOfRange> {
        let name = "coefficient of restitution";
        let e = match self {
            Self::Exact | Self::Flores => {
                checked(name, e, "above 0 and at most 1 in this law", |e| e > 0.0 && e <= 1.0)?
            }
            _ => checked(name, e, "within [0, 1]", |e| (0.0..=1.0).contains(&e))?,
        };
        let chi = match self {
            Self::LankaraniNikravesh => 0.75 * (1.0 - e * e),
            Self::Exact => exact_damping_factor(e),
            Self::HuntCrossley => 1.5 * (1.0 - e),
            Self::Flores => 8.0 * (1.0 - e) / (5.0 * e),
            Self::LeeWang => 0.75 * (1.0 - e),
        };
        checked(name, e, "larger: its damping factor overflows", |_| chi.is_finite()).map(|_| chi)
    }
}

/// chi with G(1) = G(-e): Newton on g, kept within a shrinking bracket; e in (0, 1].
fn exact_damping_factor(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    // There 1 - chi e = (1 + chi) exp(-chi (1 + e)), 4e-21 at most: the root is 1/e to the last bit.
    if e < 0.02 {
        return 1.0 / e;
    }
    // g(0) = (1 - e²)/2 > 0, g -> -inf at 1/e, one change of sign between them.
    let (mut low, mut high) = (0.0, 1.0 / e);
    let mut chi = (1.5 * (1.0 - e * e) / (1.0 + e * e * e)).min(0.5 * (low + high));
    // Bisection alone halves the bracket of at most 50 down to the last bit of a root above 1e-16.
    for _ in 0..120 {
        let (g, slope) = restitution_residual(chi, e);
        if g > 0.0 {
            low = chi;
        } else {
            high = chi;
        }
        let newton = chi - g / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - chi).abs() <= f64::EPSILON * chi || next <= low || next >= high {
            return next;
        }
        chi = next;
    }
    chi
}

/// g = (G(1) - G(-e)) and its slope by chi; g = (chi (1 + e) - ln(1 + chi) + ln(1 - chi e)) / chi².
fn restitution_residual(chi: f64, e: f64) -> (f64, f64) {
    // Below: sum over k >= 2 of chi^(k-2) ((-1)^k - e^k)/k, because the closed form cancels.
    const SMALL: f64 = 0.25;
    if chi < SMALL {
        let (mut g, mut slope) = (0.0, 0.0);
        // 0.25^30 is below 1e-18.
        for k in (2..=32_i32).rev() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            slope = slope * chi + g;
            g = g * chi + (sign - libm::pow(e, f64::from(k))) / f64::from(k);
        }
        return (g, slope);
    }
    let rest = 1.0 - chi * e;
    let f = chi * (1.0 + e) - libm::log1p(chi) + libm::log1p(-(chi * e));
    let f_slope = (1.0 + e) - 1.0 / (1.0 + chi) - e / rest;
    let g = f / (chi * chi);
    (g, (f_slope - 2.0 * f / chi) / (chi * chi))
}

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
            damping_factor: super::range::not_negative("damping factor", chi)?,
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
    use crate::Dual;
    use proptest::prelude::*;

    fn residual_of_g(chi: f64, e: f64) -> f64 {
        let g = |u: f64| u / chi - f64::ln_1p(chi * u) / (chi * chi);
        (g(1.0) - g(-e)) / g(1.0)
    }

    #[test]
    fn exact_damping_factor_agrees_with_the_table() {
        // e, chi: solutions of G(1) = G(-e), eight digits; confirmed by direct integration elsewhere.
        let table = [
            (0.1, 9.998_159_4),
            (0.3, 3.087_082_0),
            (0.5, 1.432_750_5),
            (0.7, 0.634_828_28),
            (0.9, 0.166_481_95),
            (0.95, 0.078_926_61),
        ];
        for (e, chi) in table {
            let found = Restitution::Exact.damping_factor(e).unwrap();
            // Seven decimals in the table where chi is above 1, eight below.
            assert!((found - chi).abs() < 6e-8, "{e}: {found} {chi}");
        }
    }

    #[test]
    fn exact_damping_factor_exists_from_the_smallest_to_the_largest_restitution() {
        assert_eq!(Restitution::Exact.damping_factor(1.0), Ok(0.0));
        let nearly = 1.0 - 1e-12;
        let chi = Restitution::Exact.damping_factor(nearly).unwrap();
        // chi -> 3/4 (1 - e²) for e -> 1; the difference 1 - e has four digits left here.
        assert!((chi / (0.75 * (1.0 - nearly * nearly)) - 1.0).abs() < 1e-11, "{chi}");
        for e in [1e-300, 1e-9, 1e-3, 0.019, 0.021] {
            // 1 - chi e is about exp(-1/e), below rounding: an ulp or two.
            let chi = Restitution::Exact.damping_factor(e).unwrap();
            assert!((chi * e - 1.0).abs() < 1e-15, "{e}: {chi}");
        }
    }

    #[test]
    fn restitutions_outside_the_range_of_a_law_are_refused() {
        use Restitution::{Exact, Flores, HuntCrossley, LankaraniNikravesh, LeeWang};
        for law in [LankaraniNikravesh, Exact, HuntCrossley, Flores, LeeWang] {
            for e in [-0.1, 1.1, f64::NAN] {
                assert!(law.damping_factor(e).is_err());
            }
            assert_eq!(law.damping_factor(1.0), Ok(0.0));
            assert_eq!(law.damping_factor(0.0).is_err(), matches!(law, Exact | Flores));
        }
        assert!(Flores.damping_factor(1e-320).is_err());
    }

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
        fn exact_damping_factor_solves_its_equation(e in 0.05..0.9_f64) {
            let chi = Restitution::Exact.damping_factor(e).unwrap();
            // G cancels like chi: 1e-16/0.16, and near 1/e its slope is large in chi but not in the residual.
            prop_assert!(residual_of_g(chi, e).abs() < 2e-13 * (1.0 + 1.0 / (1.0 - chi * e)));
        }

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
