//! Contact stiffness K of the sphere law, following the clearance. In: materials, journal radius,
//! clearance. Out: K [N/m^1.5]. Never knows how deep the contact is.

use super::range::{OutOfRange, checked, positive};
use crate::scalar::Scalar;

/// Equivalent modulus E* [Pa] of two materials, each (Young's modulus [Pa], Poisson's ratio):
/// 1/E* = (1 - nu_i²)/E_i + (1 - nu_j²)/E_j.
///
/// # Errors
/// If a modulus is not above zero or a ratio outside [-1, 0.5].
pub fn equivalent_modulus(bearing: (f64, f64), journal: (f64, f64)) -> Result<f64, OutOfRange> {
    let mut compliance = 0.0;
    for (modulus, ratio) in [bearing, journal] {
        let modulus = positive("Young's modulus", modulus)?;
        let ratio = checked("Poisson's ratio", ratio, "within [-1, 0.5]", |x| (-1.0..=0.5).contains(&x))?;
        compliance += (1.0 - ratio * ratio) / modulus;
    }
    positive("equivalent modulus", 1.0 / compliance)
}

/// R_b R_j / (R_b - R_j) [m] for a journal of radius R_j in a bearing of radius R_b = R_j + clearance.
///
/// Written with the clearance, because the difference of the radii would cancel.
#[inline]
pub fn effective_radius<T: Scalar>(journal_radius: T, clearance: T) -> T {
    (journal_radius + clearance) * journal_radius / clearance
}

/// How a contact gets its stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stiffness {
    /// K as given [N/m^n], whatever the clearance.
    Given(f64),
    /// K = 4/3 E* sqrt(R_eff) of two spheres, used for journals too, as the literature does: the K of
    /// [CS (14), (15)], 4/(3 pi (h_i + h_j)) sqrt(R_eff) with h = (1 - nu²)/(pi E). Follows the clearance.
    Hertz {
        /// Equivalent modulus E* [Pa], see [`equivalent_modulus`].
        modulus: f64,
    },
}

impl Stiffness {
    /// The one that is given, or that of two spheres of the pair's modulus E* [Pa].
    pub fn new(given: Option<f64>, modulus: f64) -> Self {
        given.map_or(Self::Hertz { modulus }, Self::Given)
    }

    /// Whether it is given, whatever the clearance.
    pub fn is_given(self) -> bool {
        matches!(self, Self::Given(_))
    }

    /// Itself, if its constant is in range.
    ///
    /// # Errors
    /// If it is not above zero and finite.
    pub fn checked(self) -> Result<Self, OutOfRange> {
        let (Self::Given(constant) | Self::Hertz { modulus: constant }) = self;
        positive("contact stiffness", constant).map(|_| self)
    }

    /// K [N/m^n] at a journal radius and a clearance [m].
    #[inline]
    pub fn value<T: Scalar>(&self, journal_radius: T, clearance: T) -> T {
        match *self {
            Self::Given(stiffness) => T::constant(stiffness),
            Self::Hertz { modulus } => {
                T::constant(4.0 / 3.0 * modulus) * effective_radius(journal_radius, clearance).sqrt()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;

    #[test]
    fn stiffness_of_a_10_mm_bearing_and_a_9_5_mm_journal_of_steel() {
        // 4/(3 pi (h_i + h_j)) sqrt(R_i R_j/(R_i - R_j)), h = (1 - nu²)/(pi E), with 207 GPa and 0.3.
        let modulus = equivalent_modulus((207e9, 0.3), (207e9, 0.3)).unwrap();
        let stiffness = Stiffness::Hertz { modulus }.value(9.5e-3, 0.5e-3);
        // Eight printed digits.
        assert!((stiffness / 6.610_198_4e10 - 1.0).abs() < 1e-8, "{stiffness}");
        let h = (1.0 - 0.09) / (core::f64::consts::PI * 207e9);
        let printed = 4.0 / (3.0 * core::f64::consts::PI * 2.0 * h) * f64::sqrt(10e-3 * 9.5e-3 / 0.5e-3);
        // A dozen roundings in two forms of the same number.
        assert!((stiffness / printed - 1.0).abs() < 4e-15);
    }

    #[test]
    fn stiffness_falls_with_the_square_root_of_a_small_clearance() {
        let clearance = Dual::variable(1e-6);
        let k = Stiffness::Hertz { modulus: 115e9 }.value(Dual::constant(0.01), clearance);
        let exponent = k.derivative * clearance.value / k.value;
        // Exactly -r_j / (2 (r_j + c)); rounding of a few operations.
        assert!((exponent + 0.01 / (2.0 * (0.01 + 1e-6))).abs() < 1e-14, "{exponent}");
        let given = Stiffness::Given(3e9).value(Dual::constant(0.01), clearance);
        assert_eq!((given.value, given.derivative), (3e9, 0.0));
    }

    #[test]
    fn materials_that_do_not_exist_are_refused() {
        assert_eq!(equivalent_modulus((0.0, 0.3), (2e11, 0.3)).unwrap_err().name, "Young's modulus");
        assert_eq!(equivalent_modulus((2e11, 0.3), (2e11, 0.7)).unwrap_err().name, "Poisson's ratio");
    }
}
