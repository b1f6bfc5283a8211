//! Coefficient of friction over sliding speed, the mu(|v_t|) of [CS (16)]. In: sliding speed. Out: the coefficient with its
//! direction, smooth where the law is. Never knows normal forces.
//!
//! mu(s) = max(strength(s) + slope s, 0) * onset(s) with s = |v_t|. The strength says how much, the onset how
//! the force turns round at zero speed:
//! - smoothed Coulomb: constant strength, smoothed onset;
//! - Stribeck: mu_k + (mu_s - mu_k) exp(-(s/v_S)^a), smoothed onset;
//! - Ambrosio: constant strength, dynamic correction between two speeds.

use super::range::{OutOfRange, checked, not_negative, positive};
use crate::scalar::Scalar;

/// Coefficient of friction of a body that slides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Strength {
    /// The same at every speed.
    Coulomb {
        /// Coefficient.
        coefficient: f64,
    },
    /// mu_k + (mu_s - mu_k) exp(-(s/v_S)^a): Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30
    /// (1994) 1083-1138.
    Stribeck {
        /// Coefficient mu_s at rest.
        static_coefficient: f64,
        /// Coefficient mu_k at high speed.
        kinetic_coefficient: f64,
        /// Stribeck speed v_S [m/s].
        stribeck_speed: f64,
        /// Exponent a: 2 is usual, 1 the older form.
        exponent: f64,
    },
}

impl Strength {
    /// By the coefficient at high speed and, where friction is stronger at rest, the coefficient there and the Stribeck
    /// speed [m/s].
    pub fn new(coefficient: f64, at_rest: Option<(f64, f64)>) -> Self {
        match at_rest {
            None => Self::Coulomb { coefficient },
            Some((static_coefficient, stribeck_speed)) => {
                let kinetic_coefficient = coefficient;
                Self::Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, exponent: 2.0 }
            }
        }
    }

    /// So many times as much at every speed.
    pub fn scaled(mut self, factor: f64) -> Self {
        match &mut self {
            Self::Coulomb { coefficient } => *coefficient *= factor,
            Self::Stribeck { static_coefficient, kinetic_coefficient, .. } => {
                *static_coefficient *= factor;
                *kinetic_coefficient *= factor;
            }
        }
        self
    }

    /// What [`Self::new`] makes it of.
    pub fn given(self) -> (f64, Option<(f64, f64)>) {
        match self {
            Self::Coulomb { coefficient } => (coefficient, None),
            Self::Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, .. } => {
                (kinetic_coefficient, Some((static_coefficient, stribeck_speed)))
            }
        }
    }
}

/// How friction grows from zero speed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Onset {
    /// x (3 - x²)/2 with x = s/v_s below v_s, one above: once continuously differentiable.
    Smoothed {
        /// v_s [m/s].
        speed: f64,
    },
    /// Zero below the lower speed, one above the upper, linear between: Ambrosio, in Virtual
    /// Nonlinear Multibody Systems, Kluwer 2003, 57-81.
    Ambrosio {
        /// v_0 [m/s].
        lower: f64,
        /// v_1 [m/s].
        upper: f64,
    },
}

impl Onset {
    /// By one speed [m/s] up to which friction is smoothed, or by the two between which it grows.
    pub fn new(speed: f64, upper: Option<f64>) -> Self {
        upper.map_or(Self::Smoothed { speed }, |upper| Self::Ambrosio { lower: speed, upper })
    }

    /// What [`Self::new`] makes it of.
    pub fn given(self) -> (f64, Option<f64>) {
        match self {
            Self::Smoothed { speed } => (speed, None),
            Self::Ambrosio { lower, upper } => (lower, Some(upper)),
        }
    }
}

/// A law of friction with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    strength: Strength,
    onset: Onset,
    slope: f64,
}

impl Friction {
    /// A law; `slope` [s/m] is added to the strength per unit of sliding speed.
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn new(strength: Strength, onset: Onset, slope: f64) -> Result<Self, OutOfRange> {
        match strength {
            Strength::Coulomb { coefficient } => {
                not_negative("coefficient of friction", coefficient)?;
            }
            Strength::Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, exponent } => {
                not_negative("static coefficient of friction", static_coefficient)?;
                not_negative("kinetic coefficient of friction", kinetic_coefficient)?;
                positive("Stribeck speed", stribeck_speed)?;
                positive("Stribeck exponent", exponent)?;
            }
        }
        match onset {
            Onset::Smoothed { speed } => {
                positive("smoothing speed of friction", speed)?;
            }
            Onset::Ambrosio { lower, upper } => {
                not_negative("lower speed of friction", lower)?;
                checked("upper speed of friction", upper, "finite and above the lower speed", |x| {
                    x > lower && x.is_finite()
                })?;
            }
        }
        checked("slope of friction", slope, "finite", f64::is_finite)?;
        Ok(Self { strength, onset, slope })
    }

    /// No friction at any speed.
    pub const fn none() -> Self {
        let strength = Strength::Coulomb { coefficient: 0.0 };
        Self { strength, onset: Onset::Smoothed { speed: 1.0 }, slope: 0.0 }
    }

    /// mu(s)/s [s/m] at a sliding speed s >= 0 [m/s]; finite at zero.
    ///
    /// Times a tangential velocity it is the coefficient with its direction, in any dimension, without a
    /// division by a speed that may vanish.
    #[inline(always)]
    pub fn over_speed<T: Scalar>(&self, speed: T) -> T {
        let strength = self.strength(speed) + T::constant(self.slope) * speed;
        strength.max(T::constant(0.0)) * self.onset_over_speed(speed)
    }

    /// Coefficient with the sign of the sliding speed [m/s]: mu(|v|) sign(v), zero at zero.
    #[inline]
    pub fn signed<T: Scalar>(&self, sliding_speed: T) -> T {
        self.over_speed(sliding_speed.abs()) * sliding_speed
    }

    #[inline(always)]
    fn strength<T: Scalar>(&self, speed: T) -> T {
        match self.strength {
            Strength::Coulomb { coefficient } => T::constant(coefficient),
            Strength::Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, exponent } => {
                let ratio = speed * T::constant(1.0 / stribeck_speed);
                let fall = (-power(ratio, exponent)).exp();
                T::constant(kinetic_coefficient)
                    + T::constant(static_coefficient - kinetic_coefficient) * fall
            }
        }
    }

    #[inline(always)]
    fn onset_over_speed<T: Scalar>(&self, speed: T) -> T {
        let c = T::constant;
        match self.onset {
            Onset::Smoothed { speed: limit } => {
                let slow = speed.lt(c(limit));
                let x = speed * c(1.0 / limit);
                // The side that is not chosen must not divide by zero.
                let fast = c(1.0) / T::select(slow, c(1.0), speed);
                T::select(slow, (c(3.0) - x * x) * c(0.5 / limit), fast)
            }
            Onset::Ambrosio { lower, upper } => {
                // A speed of exactly zero with a lower speed of zero has the limit 1/upper.
                let divisor = T::select(speed.lt(c(f64::MIN_POSITIVE)), c(1.0), speed);
                let rising = (c(1.0) - c(lower) / divisor) * c(1.0 / (upper - lower));
                let moving = T::select(speed.lt(c(upper)), rising, c(1.0) / divisor);
                T::select(speed.lt(c(lower)), c(0.0), moving)
            }
        }
    }
}

/// `base^exponent` for a base >= 0.
#[inline]
fn power<T: Scalar>(base: T, exponent: f64) -> T {
    if exponent == 1.0 {
        base
    } else if exponent == 2.0 {
        base * base
    } else {
        let zero = base.lt(T::constant(f64::MIN_POSITIVE));
        let safe = T::select(zero, T::constant(1.0), base);
        T::select(zero, T::constant(0.0), (safe.ln() * T::constant(exponent)).exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use proptest::prelude::*;

    const STRIBECK: Strength = Strength::Stribeck {
        static_coefficient: 0.12,
        kinetic_coefficient: 0.05,
        stribeck_speed: 0.01,
        exponent: 2.0,
    };
    const COULOMB: Strength = Strength::Coulomb { coefficient: 0.05 };
    const SMOOTHED: Onset = Onset::Smoothed { speed: 1e-3 };
    const AMBROSIO: Onset = Onset::Ambrosio { lower: 1e-4, upper: 1e-3 };

    fn laws() -> Vec<Friction> {
        let older = Strength::Stribeck {
            static_coefficient: 0.2,
            kinetic_coefficient: 0.1,
            stribeck_speed: 0.02,
            exponent: 0.7,
        };
        let mut laws = Vec::new();
        for strength in [COULOMB, STRIBECK, older] {
            for onset in [SMOOTHED, AMBROSIO, Onset::Ambrosio { lower: 0.0, upper: 1e-3 }] {
                for slope in [0.0, -0.01, 0.02] {
                    laws.push(Friction::new(strength, onset, slope).unwrap());
                }
            }
        }
        laws
    }

    #[test]
    fn sliding_coulomb_friction_has_its_full_coefficient() {
        for onset in [SMOOTHED, AMBROSIO] {
            let law = Friction::new(COULOMB, onset, 0.0).unwrap();
            for speed in [1e-3, 0.126, -2.0] {
                // One reciprocal and two products.
                assert!((law.signed(speed) - 0.05 * f64::signum(speed)).abs() < 2e-17);
            }
        }
        assert_eq!(Friction::none().signed(3.0), 0.0);
    }

    #[test]
    fn ambrosio_friction_is_absent_below_and_linear_between_its_speeds() {
        let law = Friction::new(COULOMB, AMBROSIO, 0.0).unwrap();
        assert_eq!(law.signed(0.99e-4), 0.0);
        // Halfway between: half; a few roundings.
        assert!((law.signed(5.5e-4) - 0.025).abs() < 1e-17);
        let from_zero = Friction::new(COULOMB, Onset::Ambrosio { lower: 0.0, upper: 1e-3 }, 0.0).unwrap();
        assert_eq!(from_zero.over_speed(0.0), 0.05 * (1.0 / 1e-3));
        assert!((from_zero.signed(-2.5e-4) + 0.0125).abs() < 1e-17);
    }

    #[test]
    fn stribeck_friction_falls_from_static_to_kinetic() {
        let law = Friction::new(STRIBECK, SMOOTHED, 0.0).unwrap();
        // At the Stribeck speed 1/e of the difference is left.
        let expected = 0.05 + 0.07 * f64::exp(-1.0);
        assert!((law.signed(0.01) - expected).abs() < 1e-16);
        assert!((law.signed(1.0) - 0.05).abs() < 1e-16);
        assert!((law.signed(1.000_1e-3) - 0.12).abs() < 1e-3, "1 % of the difference has gone");
    }

    #[test]
    fn slope_adds_to_the_coefficient_and_never_turns_the_force_round() {
        let rising = Friction::new(COULOMB, SMOOTHED, 0.02).unwrap();
        assert!((rising.signed(0.5) - 0.06).abs() < 1e-16);
        let falling = Friction::new(COULOMB, SMOOTHED, -0.02).unwrap();
        assert_eq!(falling.signed(100.0), 0.0);
    }

    #[test]
    fn constants_out_of_range_are_refused() {
        let name = |strength, onset, slope| Friction::new(strength, onset, slope).unwrap_err().name;
        let negative = Strength::Coulomb { coefficient: -0.1 };
        assert_eq!(name(negative, SMOOTHED, 0.0), "coefficient of friction");
        assert_eq!(name(COULOMB, Onset::Smoothed { speed: 0.0 }, 0.0), "smoothing speed of friction");
        assert_eq!(name(COULOMB, Onset::Ambrosio { lower: 1.0, upper: 1.0 }, 0.0), "upper speed of friction");
        assert_eq!(name(COULOMB, SMOOTHED, f64::NAN), "slope of friction");
        let (static_coefficient, kinetic_coefficient) = (0.2, 0.1);
        let strength = |stribeck_speed, exponent| Strength::Stribeck {
            static_coefficient,
            kinetic_coefficient,
            stribeck_speed,
            exponent,
        };
        assert_eq!(name(strength(0.0, 1.0), SMOOTHED, 0.0), "Stribeck speed");
        assert_eq!(name(strength(0.1, 0.0), SMOOTHED, 0.0), "Stribeck exponent");
    }

    #[test]
    fn at_zero_speed_value_and_slope_are_finite() {
        for law in laws() {
            let mu = law.signed(Dual::variable(0.0));
            assert_eq!(mu.value, 0.0);
            assert!(mu.derivative.is_finite(), "{law:?}");
        }
    }

    #[test]
    fn smoothed_onset_has_no_kink() {
        let law = Friction::new(COULOMB, SMOOTHED, 0.0).unwrap();
        let slope = |speed: f64| law.signed(Dual::variable(speed)).derivative;
        // Slope just inside: 3 mu/(2 v_s) (1 - x²) = 75 * 2e-9; just outside zero to rounding of mu/v_s.
        assert!(slope(1e-3 * (1.0 - 1e-9)).abs() < 2e-7);
        assert!(slope(1e-3 * (1.0 + 1e-9)).abs() < 1e-13);
    }

    proptest! {
        #[test]
        fn friction_is_odd_and_opposes(v in -0.1..0.1_f64) {
            for law in laws() {
                let mu = law.signed(v);
                prop_assert_eq!(law.signed(-v), -mu);
                prop_assert!(mu * v >= 0.0);
            }
        }

        #[test]
        fn derivative_agrees_with_central_differences(v in -0.05..0.05_f64) {
            // Kinks of the Ambrosio onset, where the difference straddles two slopes, are left out.
            let h = 1e-9;
            let s = v.abs();
            prop_assume!([0.0, 1e-4, 1e-3].iter().all(|kink: &f64| (s - kink).abs() > 1e-5));
            for law in laws() {
                let exact = law.signed(Dual::variable(v)).derivative;
                let difference = (law.signed(v + h) - law.signed(v - h)) / (2.0 * h);
                // Rounding 0.2 * 1e-16/1e-9, truncation h² mu'''/6 far below.
                prop_assert!((exact - difference).abs() < 1e-7 * (1.0 + exact.abs()), "{:?} {} {}", law, exact, difference);
            }
        }
    }
}
