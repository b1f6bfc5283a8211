//! Damping factor chi of the normal force from the coefficient of restitution e, [CS (15)] and its relatives.
//! In: e. Out: chi. Never knows forces.
//!
//! All laws are F = K p^n (1 + chi p_dot / v0). Then p_dot as a function of p scales with K, the mass and v0, and the
//! restitution that comes out depends on chi alone: G(1) = G(-e) with G(u) = u/chi - ln(1 + chi u)/chi².

use super::range::{OutOfRange, checked};
use crate::named::named;

named! {
    /// Law of restitution: how the damping factor chi follows from the coefficient of restitution e.
    #[derive(Default)]
    pub enum Restitution {
        /// chi = 3/4 (1 - e²): Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369-376. What it returns is
        /// above e: 0.7252 for 0.5, 0.9132 for 0.9.
        #[default]
        LankaraniNikravesh = "lankarani_nikravesh", "Lankarani-Nikravesh";
        /// The chi that returns e exactly.
        Exact = "exact", "exact restitution";
        /// chi = 3/2 (1 - e): Hunt & Crossley, J. Appl. Mech. 42 (1975) 440-445.
        HuntCrossley = "hunt_crossley", "Hunt-Crossley";
        /// chi = 8 (1 - e) / (5 e): Flores, Machado, Silva & Martins, Multibody Syst. Dyn. 25 (2011) 357-375.
        Flores = "flores", "Flores";
        /// chi = 3/4 (1 - e): Lee & Wang, J. Mech. Transm. Autom. Des. 105 (1983) 534-540.
        LeeWang = "lee_wang", "Lee-Wang";
    }
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

#[cfg(test)]
mod tests {
    use super::*;
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
        use Restitution::{Exact, Flores};
        for law in Restitution::ALL {
            for e in [-0.1, 1.1, f64::NAN] {
                assert!(law.damping_factor(e).is_err());
            }
            assert_eq!(law.damping_factor(1.0), Ok(0.0));
            assert_eq!(law.damping_factor(0.0).is_err(), matches!(law, Exact | Flores));
        }
        assert!(Flores.damping_factor(1e-320).is_err());
    }

    proptest! {
        #[test]
        fn exact_damping_factor_solves_its_equation(e in 0.05..0.9_f64) {
            let chi = Restitution::Exact.damping_factor(e).unwrap();
            // G cancels like chi: 1e-16/0.16, and near 1/e its slope is large in chi but not in the residual.
            prop_assert!(residual_of_g(chi, e).abs() < 2e-13 * (1.0 + 1.0 / (1.0 - chi * e)));
        }
    }
}
