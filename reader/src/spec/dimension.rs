//! Physical dimensions as integer exponents, and how to say them.

use super::turning::Turning;

/// Exponents of length, mass, time. Angles carry none; `rad` and `deg` are units of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    /// Exponent of m.
    pub length: i8,
    /// Exponent of kg.
    pub mass: i8,
    /// Exponent of s.
    pub time: i8,
}

/// Dimension, SI unit, what a quantity of it is called, and a quantity as one would write it.
const KNOWN: &[(Dimension, &str, &str, &str)] = &[
    (Dimension::NONE, "1", "a pure number or an angle", "30 deg"),
    (Dimension::LENGTH, "m", "a length", "120 mm"),
    (Dimension::MASS, "kg", "a mass", "0.5 kg"),
    (Dimension::TIME, "s", "a time", "0.2 s"),
    (Dimension::of(-1, 0, 0), "1/m", "an inverse length", "13.65 1/um"),
    (Dimension::of(2, 0, 0), "m^2", "an area", "40 mm^2"),
    (Dimension::of(3, 0, 0), "m^3", "a volume", "500 mm^3"),
    (Dimension::of(0, 0, -1), "1/s", "a frequency or angular speed", "10 rad/s"),
    (Dimension::of(0, 0, -2), "1/s^2", "an angular acceleration", "5 rad/s^2"),
    (Dimension::of(1, 0, -1), "m/s", "a speed", "0.3 m/s"),
    (Dimension::of(1, 0, -2), "m/s^2", "an acceleration", "9.81 m/s^2"),
    (Dimension::FORCE, "N", "a force", "10 N"),
    (Dimension::TORQUE, "N m", "a torque or an energy", "2 N m"),
    (Dimension::of(2, 1, -3), "W", "a power", "50 W"),
    (Dimension::of(-1, 1, -2), "Pa", "a pressure", "210 GPa"),
    (Dimension::of(-3, 1, 0), "kg/m^3", "a density", "7850 kg/m^3"),
    (Dimension::of(2, 1, 0), "kg m^2", "a moment of inertia", "0.002 kg m^2"),
    (Dimension::of(0, 1, -2), "N/m", "a stiffness", "500 N/m"),
    (Dimension::of(0, 1, -1), "N s/m", "a damping", "20 N s/m"),
    (Dimension::of(2, 1, -1), "N m s", "a rotational damping", "0.1 N m s/rad"),
];

impl Dimension {
    /// A pure number or an angle.
    pub const NONE: Self = Self::of(0, 0, 0);
    /// A length.
    pub const LENGTH: Self = Self::of(1, 0, 0);
    /// A mass.
    pub const MASS: Self = Self::of(0, 1, 0);
    /// A time.
    pub const TIME: Self = Self::of(0, 0, 1);
    /// A force.
    pub const FORCE: Self = Self::of(1, 1, -2);
    /// A torque.
    pub const TORQUE: Self = Self::of(2, 1, -2);

    /// The dimension with these exponents of m, kg, s.
    pub const fn of(length: i8, mass: i8, time: i8) -> Self {
        Self { length, mass, time }
    }

    /// Dimension of a product; `None` beyond exponents that any quantity has.
    pub fn times(self, other: Self) -> Option<Self> {
        Some(Self {
            length: self.length.checked_add(other.length)?,
            mass: self.mass.checked_add(other.mass)?,
            time: self.time.checked_add(other.time)?,
        })
    }

    /// Dimension of a power; `None` beyond exponents that any quantity has.
    pub fn to_power(self, exponent: i32) -> Option<Self> {
        let exponent = i8::try_from(exponent).ok();
        let scale = |value: i8| if value == 0 { Some(0) } else { value.checked_mul(exponent?) };
        Some(Self { length: scale(self.length)?, mass: scale(self.mass)?, time: scale(self.time)? })
    }

    /// Dimension of a quotient; `None` beyond exponents that any quantity has.
    pub fn over(self, other: Self) -> Option<Self> {
        self.times(other.to_power(-1)?)
    }

    /// Dimension of a square root; `None` if it has none.
    pub fn root(self) -> Option<Self> {
        let even = [self.length, self.mass, self.time].iter().all(|exponent| exponent % 2 == 0);
        even.then_some(Self { length: self.length / 2, mass: self.mass / 2, time: self.time / 2 })
    }

    /// The SI unit as text, e.g. `N m`; `1` for pure numbers and angles.
    pub fn si_unit(self) -> String {
        if let Some((_, unit, _, _)) = self.known() {
            return (*unit).to_owned();
        }
        let parts = |sign: i8| {
            [("kg", self.mass), ("m", self.length), ("s", self.time)]
                .into_iter()
                .filter(|(_, exponent)| exponent.signum() == sign)
                .map(|(unit, exponent)| match exponent.unsigned_abs() {
                    1 => unit.to_owned(),
                    n => format!("{unit}^{n}"),
                })
                .collect::<Vec<_>>()
        };
        let (above, below) = (parts(1), parts(-1));
        let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
        match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join(" ")),
        }
    }

    /// The SI unit of a quantity that counts turns or radians: what is a pure number alike is none or rad, what is per second alike
    /// Hz or rad/s.
    pub fn unit_counting(self, turning: Turning) -> String {
        let over = match self {
            Self::NONE => ["1", "rad"],
            Self { length: 0, mass: 0, time: -1 } => ["Hz", "rad/s"],
            Self { length: 0, mass: 0, time: -2 } => ["Hz/s", "rad/s^2"],
            _ => return self.si_unit(),
        };
        match turning {
            Turning::TURNS => over[0].to_owned(),
            Turning::ANGLE => over[1].to_owned(),
            _ => self.si_unit(),
        }
    }

    /// What a quantity of this dimension is, with its unit: `a length [m]`.
    pub fn description(self) -> String {
        match self.known() {
            Some((Self::NONE, _, what, _)) => (*what).to_owned(),
            Some((_, unit, what, _)) => format!("{what} [{unit}]"),
            None => format!("a quantity in [{}]", self.si_unit()),
        }
    }

    /// A quantity of this dimension as one would write it, for advice.
    pub fn example(self) -> String {
        match self.known() {
            Some((_, _, _, example)) => (*example).to_owned(),
            None => format!("1 {}", self.si_unit()),
        }
    }

    fn known(self) -> Option<&'static (Self, &'static str, &'static str, &'static str)> {
        KNOWN.iter().find(|(dimension, ..)| *dimension == self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::parse_expression;

    #[test]
    fn si_units_read_as_people_write_them() {
        assert_eq!(Dimension::TORQUE.si_unit(), "N m");
        assert_eq!(Dimension::of(2, 1, -1).si_unit(), "N m s");
        assert_eq!(Dimension::NONE.si_unit(), "1");
        assert_eq!(Dimension::of(1, 1, -4).si_unit(), "kg m/s^4");
        assert_eq!(Dimension::of(-1, 0, -2).si_unit(), "1/(m s^2)");
    }

    #[test]
    fn every_unit_and_example_in_a_message_reads_back_to_its_dimension() {
        for (dimension, unit, _, example) in KNOWN.iter().skip(1) {
            for text in [format!("1 {unit}"), (*example).to_owned()] {
                let read = parse_expression(&text, &|_| false).unwrap();
                assert_eq!(read.quantity().map(|(_, dimension)| dimension), Some(*dimension), "{text}");
            }
        }
    }

    #[test]
    fn exponents_cannot_overflow() {
        assert_eq!(Dimension::LENGTH.to_power(1000), None);
        assert_eq!(Dimension::NONE.to_power(1000), Some(Dimension::NONE));
        assert_eq!(Dimension::of(100, 0, 0).times(Dimension::of(100, 0, 0)), None);
        assert_eq!(Dimension::of(2, 0, -2).root(), Some(Dimension::of(1, 0, -1)));
        assert_eq!(Dimension::LENGTH.root(), None);
    }
}
