//! Contact area A and mean pressure F_n/A of a journal in its bearing, the sigma_n of [CS (18)].
//! In: load, geometry, modulus. Out: pressure [Pa], half-width of the arc [rad]. Never knows wear.
//!
//! How A depends on force and clearance decides the strength of the feedback: at constant force the depth rate
//! goes with the clearance to the power 0 (`Projected`), 1/2 (`Hertz`), 1/3 (`Conformal`).

use crate::contact::effective_radius;
use crate::named::named;
use crate::scalar::Scalar;

named! {
    /// Model of the contact area.
    #[derive(Default)]
    pub enum Area {
        /// The journal seen from the side: A = 2 r L.
        Projected = "projected", "projected, 2 r L";
        /// Line contact: A = 2 b L, b = sqrt(4 F_n R_eff/(pi E* L)).
        #[default]
        Hertz = "hertz", "Hertz, 2 b L";
        /// Overlap of two circles: A = 2 r L eps, cos eps = c/(c + p).
        Conformal = "conformal", "conformal arc";
    }
}

/// Geometry and material of a journal in its bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<T> {
    /// Radius of the journal [m].
    pub journal_radius: T,
    /// Length of the bearing [m].
    pub length: T,
    /// Radial clearance [m].
    pub clearance: T,
    /// Equivalent modulus E* [Pa].
    pub modulus: T,
}

/// What acts on the contact at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load<T> {
    /// F_n [N]; for an ideal joint the radial reaction hypot(Fx, Fy).
    pub normal_force: T,
    /// Penetration [m]; for an ideal joint that of the resting contact.
    pub penetration: T,
    /// Sliding speed v_t [m/s]; for an ideal joint r_j times the joint's speed.
    pub sliding_speed: T,
}

impl Area {
    /// Whether it takes the bodies as half-spaces, which only narrow contacts are.
    pub fn is_half_space(self) -> bool {
        self == Self::Hertz
    }

    /// Mean pressure F_n/A [Pa]; zero where there is no force, with a finite derivative.
    #[inline]
    pub fn pressure<T: Scalar>(self, load: &Load<T>, pair: &Pair<T>) -> T {
        let (c, zero) = (T::constant, T::constant(0.0));
        let (loaded, touching) = (zero.lt(load.normal_force), zero.lt(load.penetration));
        match self {
            Self::Projected => {
                T::select(loaded, load.normal_force, zero) / (c(2.0) * pair.journal_radius * pair.length)
            }
            Self::Hertz => {
                let force = T::select(loaded, load.normal_force, c(1.0));
                let width = c(2.0) * hertz_half_width(force, pair);
                T::select(loaded, force / (width * pair.length), zero)
            }
            Self::Conformal => {
                let angle = conformal_half_angle(T::select(touching, load.penetration, c(1.0)), pair);
                let pressure = load.normal_force / (c(2.0) * pair.journal_radius * pair.length * angle);
                T::select(touching, T::select(loaded, pressure, zero), zero)
            }
        }
    }

    /// Half-width of the contact as an angle in the bearing [rad], over which wear is spread.
    ///
    /// `Projected` says nothing about the width of the arc; there it is that of `Hertz`.
    #[inline]
    pub fn half_angle<T: Scalar>(self, load: &Load<T>, pair: &Pair<T>) -> T {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let (value, has_arc) = match self {
            Self::Projected | Self::Hertz => {
                let loaded = zero.lt(load.normal_force);
                let half_width = hertz_half_width(T::select(loaded, load.normal_force, one), pair);
                (half_width / (pair.journal_radius + pair.clearance), loaded)
            }
            Self::Conformal => {
                let touching = zero.lt(load.penetration);
                (conformal_half_angle(T::select(touching, load.penetration, one), pair), touching)
            }
        };
        T::select(has_arc, value, zero)
    }
}

/// b = sqrt(4 F_n R_eff/(pi E* L)) [m] for a force above zero.
#[inline]
fn hertz_half_width<T: Scalar>(force: T, pair: &Pair<T>) -> T {
    let radius = effective_radius(pair.journal_radius, pair.clearance);
    (T::constant(4.0 / core::f64::consts::PI) * force * radius / (pair.modulus * pair.length)).sqrt()
}

/// eps with cos eps = c/(c + p) for p above zero: the arc tangent does not cancel for small p.
#[inline]
fn conformal_half_angle<T: Scalar>(penetration: T, pair: &Pair<T>) -> T {
    let chord = (penetration * (pair.clearance + pair.clearance + penetration)).sqrt();
    chord.atan2(pair.clearance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Normal, Stiffness};
    use crate::dual::Dual;
    use proptest::prelude::*;

    fn pair<T: Scalar>(clearance: T) -> Pair<T> {
        let c = T::constant;
        Pair { journal_radius: c(0.01), length: c(0.02), clearance, modulus: c(115e9) }
    }

    /// Pressure of a resting contact at a constant force [N].
    fn pressure<T: Scalar>(area: Area, force: f64, clearance: T) -> T {
        let pair = pair(clearance);
        let stiffness = Stiffness::Hertz { modulus: 115e9 }.value(pair.journal_radius, clearance);
        let law = Normal::with_damping_factor(0.0, 1.5, 1e-3).unwrap();
        let normal_force = T::constant(force);
        let penetration = law.resting_penetration(stiffness, normal_force);
        area.pressure(&Load { normal_force, penetration, sliding_speed: T::constant(0.126) }, &pair)
    }

    #[test]
    fn pressure_goes_with_the_clearance_to_the_power_of_the_model() {
        for (&area, exponent) in Area::ALL.iter().zip([0.0, 0.5, 1.0 / 3.0]) {
            for clearance in [10e-6, 30e-6, 90e-6] {
                let p = pressure(area, 32.0, Dual::variable(clearance));
                let found = p.derivative * clearance / p.value;
                // Exact powers hold for c << r_j and p << c: c/(2 r_j) is 0.0045, p/c at most 0.016.
                assert!((found - exponent).abs() < 0.01, "{area:?} {clearance}: {found}");
            }
        }
    }

    #[test]
    fn pressures_of_a_loaded_journal_have_the_size_of_the_areas() {
        // 2 r L = 4e-4 m²; b = sqrt(4 * 32 * 10.01/(pi * 115e9 * 0.02)); both by hand.
        assert!((pressure(Area::Projected, 32.0, 10e-6) / 8e4 - 1.0).abs() < 1e-15);
        let b = f64::sqrt(4.0 * 32.0 * 10.01 / (core::f64::consts::PI * 115e9 * 0.02));
        // 10.01 is R_eff to rounding.
        assert!((pressure(Area::Hertz, 32.0, 10e-6) / (32.0 / (2.0 * b * 0.02)) - 1.0).abs() < 1e-13);
        let p = f64::powf(32.0 / (4.0 / 3.0 * 115e9 * f64::sqrt(10.01)), 2.0 / 3.0);
        let angle = f64::acos(10e-6 / (10e-6 + p));
        // acos near one keeps 13 digits.
        let expected = 32.0 / (2.0 * 0.01 * 0.02 * angle);
        assert!((pressure(Area::Conformal, 32.0, 10e-6) / expected - 1.0).abs() < 1e-11);
    }

    #[test]
    fn without_a_load_there_is_no_pressure_and_no_arc() {
        for &area in Area::ALL {
            let load = Load {
                normal_force: Dual::variable(0.0),
                penetration: Dual::new(-1e-6, 1.0),
                sliding_speed: Dual::constant(0.1),
            };
            let pair = pair(Dual::constant(1e-5));
            for x in [area.pressure(&load, &pair), area.half_angle(&load, &pair)] {
                assert_eq!(x.value, 0.0);
                assert!(x.derivative.is_finite(), "{area:?}");
            }
        }
    }

    proptest! {
        #[test]
        fn half_angle_times_radius_is_half_the_width_of_the_area(force in 0.1..500.0_f64, c in 1e-6..2e-4_f64, p in 1e-9..1e-6_f64) {
            let pair = pair(c);
            let load = Load { normal_force: force, penetration: p, sliding_speed: 0.1 };
            let width = |area: Area| force / area.pressure(&load, &pair) / pair.length;
            // The Hertz width is a chord, the conformal one an arc of the journal; a few roundings.
            let hertz = Area::Hertz.half_angle(&load, &pair) * (0.01 + c) * 2.0;
            prop_assert!((hertz / width(Area::Hertz) - 1.0).abs() < 1e-14);
            let conformal = Area::Conformal.half_angle(&load, &pair) * 0.01 * 2.0;
            prop_assert!((conformal / width(Area::Conformal) - 1.0).abs() < 1e-14);
        }
    }
}
