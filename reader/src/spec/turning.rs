//! Turns and radians of a quantity: what its dimension cannot tell, because both are pure numbers.
//! A rate in Hz or rpm counts turns; only a factor such as `2*pi` or `360 deg` makes an angle of them.

/// How often turns and angles are factors of a quantity: 1 and 0 for Hz, 0 and 1 for rad/s, 0 and 0 for 1/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turning {
    /// Exponent of turns, as in Hz and rpm.
    pub turns: i8,
    /// Exponent of angles, as in rad, deg and pi.
    pub angles: i8,
}

impl Turning {
    /// Turns, as Hz and rpm count.
    pub const TURNS: Self = Self { turns: 1, angles: 0 };
    /// An angle.
    pub const ANGLE: Self = Self { turns: 0, angles: 1 };

    /// Of a product: an angle per turn makes angles of turns.
    pub fn times(self, other: Self) -> Self {
        let (turns, angles) =
            (self.turns.saturating_add(other.turns), self.angles.saturating_add(other.angles));
        if turns > 0 && angles > 0 { Self { turns: 0, angles } } else { Self { turns, angles } }
    }

    /// Of a power.
    pub fn to_power(self, exponent: i32) -> Self {
        let exponent = i8::try_from(exponent).unwrap_or(0);
        let raised = |own: i8| own.saturating_mul(exponent);
        Self { turns: raised(self.turns), angles: raised(self.angles) }
    }

    /// Whether it counts turns where `other` measures angles.
    pub fn is_turns_beside(self, other: Self) -> bool {
        self.turns > 0 && other.turns == 0 && other.angles > 0
    }

    /// Whether one counts turns and the other radians: such numbers cannot stand for each other.
    pub fn differs_from(self, other: Self) -> bool {
        self.is_turns_beside(other) || other.is_turns_beside(self)
    }

    /// Whether it is radians per turn or turns per radian: a ratio of rates that is off by 2 pi.
    pub fn is_mixed(self) -> bool {
        (self.turns > 0 && self.angles < 0) || (self.turns < 0 && self.angles > 0)
    }

    /// What it counts, where it differs from another.
    pub fn counted(self) -> &'static str {
        if self.turns > 0 { "turns" } else { "radians" }
    }

    /// What to say of `what`, which counts `given`, for the quantity of this name and unit that counts this; and the cure. Nothing where
    /// they agree.
    pub fn told_apart(self, given: Self, what: &str, (name, unit): (&str, &str)) -> Option<[String; 2]> {
        self.differs_from(given).then(|| {
            let (counts, own) = (given.counted(), self.counted());
            let message = format!("{what} counts {counts}, but `{name}` counts {own}");
            [message, format!("a turn is 2*pi rad; the file gives `{name}` in {unit}")]
        })
    }

    /// What one of it is in terms of `other`: 2 pi for turns where radians are counted.
    pub fn in_terms_of(self, other: Self) -> f64 {
        let power = if self.is_turns_beside(other) {
            self.turns
        } else if other.is_turns_beside(self) {
            -other.turns
        } else {
            0
        };
        (2.0 * std::f64::consts::PI).powi(power.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_per_turn_makes_an_angle_of_turns_in_any_order() {
        let product = |factors: [Turning; 3]| factors.into_iter().fold(Turning::default(), Turning::times);
        let none = Turning::default();
        assert_eq!(product([Turning::ANGLE, Turning::TURNS, none]), Turning::ANGLE);
        assert_eq!(product([Turning::TURNS, none, Turning::ANGLE]), Turning::ANGLE);
        assert_eq!(product([Turning::TURNS, none, none]), Turning::TURNS);
        // 2 pi t/T with T = 1/f.
        let period = Turning::TURNS.to_power(-1);
        assert_eq!(product([Turning::ANGLE, period.to_power(-1), none]), Turning::ANGLE);
    }

    #[test]
    fn a_turn_is_two_pi_radians_and_both_differ_from_each_other_alone() {
        let (turns, angle, none) = (Turning::TURNS, Turning::ANGLE, Turning::default());
        assert!(turns.differs_from(angle) && angle.differs_from(turns));
        assert!(!turns.differs_from(none) && !none.differs_from(angle) && !turns.differs_from(turns));
        assert_eq!(turns.in_terms_of(angle) * angle.in_terms_of(turns), 1.0);
        assert_eq!((turns.in_terms_of(angle), turns.in_terms_of(none)), (std::f64::consts::TAU, 1.0));
        assert!(angle.times(turns.to_power(-1)).is_mixed() && !angle.times(turns).is_mixed());
    }
}
