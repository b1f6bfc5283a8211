//! Archard's law, [CS (18)-(20)], as terms of the right-hand side. In: load of a contact, material.
//! Out: rates of the wear integral and of the depth. Never knows who integrates them.

use super::area::{Area, Load, Pair};
use crate::contact::{OutOfRange, positive};
use crate::scalar::Scalar;

/// Archard's law of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Archard {
    /// k/H [1/Pa].
    rate: f64,
    area: Area,
}

/// Rates of the two quantities that a worn joint adds to the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearRates<T> {
    /// Of the wear integral S = ∫ F_n |v_t| dt: power [W].
    pub wear_integral: T,
    /// Of the depth h = ∫ k/(H A) F_n |v_t| dt: speed [m/s].
    pub depth: T,
}

impl Archard {
    /// The law by its wear coefficient k [1], the hardness H [Pa] of the softer body and its area.
    ///
    /// # Errors
    /// If a number is not above zero.
    pub fn new(wear_coefficient: f64, hardness: f64, area: Area) -> Result<Self, OutOfRange> {
        let coefficient = positive("wear coefficient", wear_coefficient)?;
        Ok(Self { rate: coefficient / positive("hardness", hardness)?, area })
    }

    /// The model of the contact area.
    pub fn area(&self) -> Area {
        self.area
    }

    /// Worn volume per unit of wear integral, k/H [m³/J].
    pub fn volume_rate(&self) -> f64 {
        self.rate
    }

    /// Rate of the integral of the depth over the bearing angle [m rad/s]: worn volume over radius and
    /// length of the bearing, the same for every area. What a circumferential profile takes in.
    #[inline]
    pub fn profile_rate<T: Scalar>(&self, load: &Load<T>, pair: &Pair<T>) -> T {
        let surface = (pair.journal_radius + pair.clearance) * pair.length;
        T::constant(self.rate) * load.normal_force * load.sliding_speed.abs() / surface
    }

    /// Rate of the depth [m/s] at a mean pressure [Pa] and a sliding speed [m/s], [CS (19)].
    #[inline]
    pub fn depth_rate<T: Scalar>(&self, pressure: T, sliding_speed: T) -> T {
        T::constant(self.rate) * pressure * sliding_speed.abs()
    }

    /// Rates at one instant, [CS (19)]; zero without contact, [CS (20)].
    #[inline]
    pub fn rates<T: Scalar>(&self, load: &Load<T>, pair: &Pair<T>) -> WearRates<T> {
        let speed = load.sliding_speed.abs();
        WearRates {
            wear_integral: load.normal_force * speed,
            depth: self.depth_rate(self.area.pressure(load, pair), load.sliding_speed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAIR: Pair<f64> = Pair { journal_radius: 0.01, length: 0.02, clearance: 1e-5, modulus: 115e9 };

    #[test]
    fn depth_rate_is_that_of_the_printed_law() {
        let law = Archard::new(1e-8, 3.5e9, Area::Projected).unwrap();
        let load = Load { normal_force: 31.9, penetration: 2e-7, sliding_speed: -0.126 };
        let rates = law.rates(&load, &PAIR);
        assert_eq!(rates.wear_integral, 31.9 * 0.126);
        // k/(H A) F_n |v_t| with A = 2 r L; a few roundings.
        let expected = 1e-8 / (3.5e9 * 4e-4) * 31.9 * 0.126;
        assert!((rates.depth / expected - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_turn_of_the_case_study_wears_by_the_known_projected_depth() {
        // S = 2.0053636 J per turn at 10 µm (independent solution) gives 1.43e-14 m: three digits.
        let law = Archard::new(1e-8, 3.5e9, Area::Projected).unwrap();
        let load = Load { normal_force: 2.005_363_6, penetration: 1e-9, sliding_speed: 1.0 };
        assert!((law.rates(&load, &PAIR).depth / 1.43e-14 - 1.0).abs() < 2e-3);
    }

    #[test]
    fn without_contact_nothing_wears() {
        for area in [Area::Projected, Area::Hertz, Area::Conformal] {
            let law = Archard::new(1e-8, 3.5e9, area).unwrap();
            let apart = Load { normal_force: 0.0, penetration: -1e-6, sliding_speed: 5.0 };
            assert_eq!(law.rates(&apart, &PAIR), WearRates { wear_integral: 0.0, depth: 0.0 });
        }
    }

    #[test]
    fn hertz_depth_over_its_arc_is_what_a_profile_takes_in() {
        let law = Archard::new(1e-8, 3.5e9, Area::Hertz).unwrap();
        let load = Load { normal_force: 31.9, penetration: 2e-7, sliding_speed: 0.126 };
        let over_arc = law.rates(&load, &PAIR).depth * 2.0 * Area::Hertz.half_angle(&load, &PAIR);
        // The same volume computed along two ways: a few roundings.
        assert!((law.profile_rate(&load, &PAIR) / over_arc - 1.0).abs() < 1e-14);
    }

    #[test]
    fn constants_out_of_range_are_refused() {
        assert_eq!(Archard::new(0.0, 1e9, Area::Hertz).unwrap_err().name, "wear coefficient");
        assert_eq!(Archard::new(1e-8, -1.0, Area::Hertz).unwrap_err().name, "hardness");
    }
}
