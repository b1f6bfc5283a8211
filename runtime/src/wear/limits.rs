//! Validity limits of the wear models. In: extremes of a run, limits of the material.
//! Out: warnings as data. Never stops anything.

use core::fmt;

use super::area::{Area, Load, Pair};
use crate::scalar::Scalar;

/// Limits of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// Hardness H of the softer body [Pa].
    pub hardness: f64,
    /// Largest pressure times sliding speed that the bearing stands [W/m²], if known.
    pub pressure_speed: Option<f64>,
}

/// Extremes of a joint over a measured stretch of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Observed {
    /// Largest mean contact pressure F_n/A [Pa].
    pub pressure: f64,
    /// Largest pressure times sliding speed [W/m²].
    pub pressure_speed: f64,
    /// Largest half-width b of the Hertz contact [m]; zero if another area is used.
    pub hertz_half_width: f64,
    /// Half-width of the widest contact as an angle in the bearing [rad], over which wear is spread; zero if nothing touched, or unknown
    /// (kept by an earlier version).
    #[cfg_attr(feature = "serde", serde(default))]
    pub half_angle: f64,
    /// Largest penetration [m].
    pub penetration: f64,
    /// Depth gained in one wear cycle [m].
    pub depth_per_cycle: f64,
    /// Clearance at its begin [m].
    pub clearance: f64,
    /// Radius of the journal [m].
    pub journal_radius: f64,
}

impl Observed {
    /// Nothing seen yet of a joint with a radial clearance and journal radius [m].
    pub fn nothing(clearance: f64, journal_radius: f64) -> Self {
        Self {
            pressure: 0.0,
            pressure_speed: 0.0,
            hertz_half_width: 0.0,
            half_angle: 0.0,
            penetration: 0.0,
            depth_per_cycle: 0.0,
            clearance,
            journal_radius,
        }
    }

    /// The larger of every extreme; clearance and radius stay.
    pub fn larger(self, other: Self) -> Self {
        Self {
            pressure: Scalar::max(self.pressure, other.pressure),
            pressure_speed: Scalar::max(self.pressure_speed, other.pressure_speed),
            hertz_half_width: Scalar::max(self.hertz_half_width, other.hertz_half_width),
            half_angle: Scalar::max(self.half_angle, other.half_angle),
            penetration: Scalar::max(self.penetration, other.penetration),
            ..self
        }
    }

    /// What these extremes mean for a joint of this contact area and size. The depth per cycle is for the caller to set.
    pub fn of(extremes: &Extremes<f64>, area: Area, pair: &Pair<f64>) -> Self {
        let Extremes { normal_force, pressure, pressure_speed, penetration } = *extremes;
        // Contacts are the wider the larger the force or the penetration.
        let load = Load { normal_force, penetration, sliding_speed: 0.0 };
        let radius = pair.journal_radius + pair.clearance;
        let half_angle = area.half_angle(&load, pair);
        let hertz_half_width = if area.is_half_space() { half_angle * radius } else { 0.0 };
        let seen = Self::nothing(pair.clearance, pair.journal_radius);
        Self { pressure, pressure_speed, hertz_half_width, half_angle, penetration, ..seen }
    }
}

/// Largest of what acted on a joint so far; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes<T> {
    /// Normal force.
    pub normal_force: T,
    /// Mean pressure.
    pub pressure: T,
    /// Pressure times sliding speed.
    pub pressure_speed: T,
    /// Penetration; zero if nothing touched.
    pub penetration: T,
}

impl<T: Scalar> Extremes<T> {
    /// Of nothing seen yet.
    pub fn nothing() -> Self {
        let zero = T::constant(0.0);
        Self { normal_force: zero, pressure: zero, pressure_speed: zero, penetration: zero }
    }

    /// Includes what acts at one instant, with the mean pressure there [Pa].
    #[inline]
    pub fn include(&mut self, pressure: T, load: &Load<T>) {
        self.normal_force = self.normal_force.max(load.normal_force);
        self.pressure = self.pressure.max(pressure);
        self.pressure_speed = self.pressure_speed.max(pressure * load.sliding_speed.abs());
        self.penetration = self.penetration.max(load.penetration);
    }
}

/// A model used outside its range. Numbers in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Warning {
    /// The mean pressure is above the hardness: the surface flows, Archard's law does not hold.
    PressureAboveHardness {
        /// Largest mean pressure [Pa].
        pressure: f64,
        /// Hardness [Pa].
        hardness: f64,
    },
    /// Pressure times speed is above what the bearing stands: it overheats.
    PressureSpeedAboveLimit {
        /// Largest product [W/m²].
        pressure_speed: f64,
        /// Its limit [W/m²].
        limit: f64,
    },
    /// One cycle wears so deep that the clearance is not constant within it.
    DepthPerCycleLarge {
        /// Depth per cycle [m].
        depth: f64,
        /// Clearance [m].
        clearance: f64,
    },
    /// The contact is so wide that the half-space of Hertz's theory no longer holds.
    HertzContactWide {
        /// Half-width [m].
        half_width: f64,
        /// Radius of the journal [m].
        journal_radius: f64,
    },
    /// The penetration is no longer small against the clearance: the bodies lie in each other's curve.
    PenetrationLarge {
        /// Penetration [m].
        penetration: f64,
        /// Clearance [m].
        clearance: f64,
    },
}

impl Limits {
    /// Depth per cycle, as a part of the clearance, up to which geometry counts as constant in a cycle.
    pub const DEPTH_PART: f64 = 0.5;
    /// Half-width, as a part of the journal radius, up to which Hertz's half-space is accepted.
    pub const WIDTH_PART: f64 = 0.1;
    /// Penetration, as a part of the clearance, up to which a contact counts as narrow.
    pub const PENETRATION_PART: f64 = 0.1;

    /// Everything that is outside its range, in a fixed order. A quantity that is not a number warns too.
    pub fn warnings(&self, seen: &Observed) -> impl Iterator<Item = Warning> + use<> {
        let above = |value: f64, limit: f64| value.is_nan() || value > limit;
        let pressure_speed_limit = self.pressure_speed.filter(|limit| above(seen.pressure_speed, *limit));
        let found = [
            above(seen.pressure, self.hardness).then_some(Warning::PressureAboveHardness {
                pressure: seen.pressure,
                hardness: self.hardness,
            }),
            pressure_speed_limit
                .map(|limit| Warning::PressureSpeedAboveLimit { pressure_speed: seen.pressure_speed, limit }),
            above(seen.depth_per_cycle, Self::DEPTH_PART * seen.clearance).then_some(
                Warning::DepthPerCycleLarge { depth: seen.depth_per_cycle, clearance: seen.clearance },
            ),
            above(seen.hertz_half_width, Self::WIDTH_PART * seen.journal_radius).then_some(
                Warning::HertzContactWide {
                    half_width: seen.hertz_half_width,
                    journal_radius: seen.journal_radius,
                },
            ),
            above(seen.penetration, Self::PENETRATION_PART * seen.clearance).then_some(
                Warning::PenetrationLarge { penetration: seen.penetration, clearance: seen.clearance },
            ),
        ];
        found.into_iter().flatten()
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PressureAboveHardness { pressure, hardness } => write!(
                f,
                "mean contact pressure {:.4} GPa is above the hardness {:.4} GPa; Archard's law does not hold, \
                 lower the load or enlarge the joint",
                pressure * 1e-9,
                hardness * 1e-9
            ),
            Self::PressureSpeedAboveLimit { pressure_speed, limit } => write!(
                f,
                "pressure times sliding speed {:.4} MW/m² is above the limit {:.4} MW/m²; the bearing overheats",
                pressure_speed * 1e-6,
                limit * 1e-6
            ),
            Self::DepthPerCycleLarge { depth, clearance } => write!(
                f,
                "one cycle wears {:.3} µm at a clearance of {:.3} µm; take fewer revolutions per cycle",
                depth * 1e6,
                clearance * 1e6
            ),
            Self::HertzContactWide { half_width, journal_radius } => write!(
                f,
                "Hertz contact is {:.3} mm to either side on a journal of radius {:.3} mm; its theory holds \
                 for narrow contacts, use the conformal area",
                half_width * 1e3,
                journal_radius * 1e3
            ),
            Self::PenetrationLarge { penetration, clearance } => write!(
                f,
                "penetration {:.3} µm is not small against the clearance {:.3} µm; stiffness and width of the \
                 contact are those of small penetrations",
                penetration * 1e6,
                clearance * 1e6
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { hardness: 3.5e9, pressure_speed: Some(2e6) };
    const SOUND: Observed = Observed {
        pressure: 2e6,
        pressure_speed: 2.5e5,
        hertz_half_width: 5e-4,
        half_angle: 0.05,
        penetration: 2e-7,
        depth_per_cycle: 3e-6,
        clearance: 1e-5,
        journal_radius: 0.01,
    };

    #[test]
    fn a_sound_joint_has_no_warning() {
        assert_eq!(LIMITS.warnings(&SOUND).count(), 0);
    }

    #[test]
    fn every_limit_has_its_warning() {
        let one = |seen: Observed| {
            let mut warnings = LIMITS.warnings(&seen);
            let first = warnings.next().expect("a warning");
            assert_eq!(warnings.next(), None);
            first
        };
        let warning = one(Observed { pressure: 4e9, ..SOUND });
        assert!(matches!(warning, Warning::PressureAboveHardness { pressure: 4e9, hardness: 3.5e9 }));
        let warning = one(Observed { pressure_speed: 3e6, ..SOUND });
        assert!(matches!(warning, Warning::PressureSpeedAboveLimit { limit: 2e6, .. }));
        let warning = one(Observed { depth_per_cycle: 6e-6, ..SOUND });
        assert!(matches!(warning, Warning::DepthPerCycleLarge { depth: 6e-6, .. }));
        let warning = one(Observed { hertz_half_width: 2e-3, ..SOUND });
        assert!(matches!(warning, Warning::HertzContactWide { half_width: 2e-3, .. }));
        let warning = one(Observed { penetration: 2e-6, ..SOUND });
        assert!(matches!(warning, Warning::PenetrationLarge { penetration: 2e-6, .. }));
        assert!(matches!(
            one(Observed { pressure: f64::NAN, ..SOUND }),
            Warning::PressureAboveHardness { .. }
        ));
    }

    #[test]
    fn extremes_are_the_largest_of_what_was_seen() {
        let pair = Pair { journal_radius: 0.01, length: 0.02, clearance: 1e-5, modulus: 115e9 };
        let load = |normal_force, sliding_speed| Load { normal_force, penetration: 2e-7, sliding_speed };
        let mut extremes = Extremes::nothing();
        for load in [load(10.0, -3.0), load(40.0, 0.1), load(0.0, 9.0)] {
            extremes.include(Area::Hertz.pressure(&load, &pair), &load);
        }
        let seen = Observed::of(&extremes, Area::Hertz, &pair);
        let pressure = |force: f64| Area::Hertz.pressure(&load(force, 0.0), &pair);
        assert_eq!(seen.pressure, pressure(40.0));
        assert_eq!(seen.pressure_speed, pressure(10.0) * 3.0);
        // F_n = p 2 b L; a few roundings.
        assert!((seen.hertz_half_width / (40.0 / (pressure(40.0) * 2.0 * 0.02)) - 1.0).abs() < 1e-14);
        assert_eq!((seen.penetration, seen.depth_per_cycle), (2e-7, 0.0));
    }

    #[test]
    fn an_unknown_limit_never_warns() {
        let limits = Limits { pressure_speed: None, ..LIMITS };
        assert_eq!(limits.warnings(&Observed { pressure_speed: 1e12, ..SOUND }).count(), 0);
    }
}
