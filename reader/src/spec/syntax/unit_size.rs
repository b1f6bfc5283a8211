//! A unit alone, as a heading or an option has it. In: the unit as it was read. Out: numbers of it in SI and in other units, as near as
//! doubles are to them. Never knows texts.

use super::super::dimension::Dimension;
use super::super::turning::Turning;
use super::super::unit::Unit;

/// What a unit is. It is the whole numerator and denominator of its size: a number times a size such as 0.001 would be rounded twice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitSize {
    unit: Unit,
    /// Its dimension.
    pub dimension: Dimension,
    /// Turns and angles in it: Hz and rad/s have one dimension, and differ by 2 pi.
    pub turning: Turning,
}

impl UnitSize {
    /// No unit.
    pub const ONE: Self = Self::of(Unit::ONE);

    pub(super) const fn of(unit: Unit) -> Self {
        Self { unit, dimension: unit.dimension, turning: unit.turning }
    }

    /// How much it is in SI.
    pub fn size(self) -> f64 {
        self.to_si(1.0)
    }

    /// `number` of this unit in SI: "120 mm" and "0.12 m" are one double.
    pub fn to_si(self, number: f64) -> f64 {
        self.unit.to_si(number)
    }

    /// `number` of this unit, counted in another of the same dimension.
    pub fn to_unit(self, number: f64, other: Self) -> f64 {
        let (own, other) = (self.unit, other.unit);
        let (factor, divisor) = (own.factor * other.divisor, own.divisor * other.factor);
        // The ratio of two powers of ten is whole, one way or the other.
        if factor >= divisor { number * (factor / divisor) } else { number / (divisor / factor) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::unit_size;

    #[test]
    fn numbers_of_a_unit_are_those_that_are_written_in_another() {
        for (unit, other, power) in [("um", "m", -6), ("um", "mm", -3), ("mm", "m", -3), ("m", "um", 6)] {
            let (unit, other) = (unit_size(unit).unwrap(), unit_size(other).unwrap());
            for number in 1..=2000 {
                // Products with 1e-3 miss one number of three by a bit.
                let written: f64 = format!("{number}e{power}").parse().unwrap();
                assert_eq!(unit.to_unit(f64::from(number), other), written, "{number}");
                let in_si: f64 = format!("{number}e-6").parse().unwrap();
                assert_eq!(unit_size("um").unwrap().to_si(f64::from(number)), in_si, "{number}");
            }
        }
        let [hertz, rpm] = ["Hz", "rpm"].map(|unit| unit_size(unit).unwrap());
        assert_eq!((rpm.to_unit(120.0, hertz), hertz.to_unit(2.0, rpm)), (2.0, 120.0));
    }

    #[test]
    fn a_unit_alone_is_a_unit_and_nothing_else() {
        for (unit, size) in
            [("1", 1.0), ("", 1.0), ("mm", 1e-3), ("1/s", 1.0), ("N m s/rad", 1.0), ("%", 0.01)]
        {
            assert_eq!(unit_size(unit).map(|unit| unit.size()), Some(size), "{unit}");
        }
        for none in ["furlong", "2", "2 mm", "mm + mm", "m/s s", "-", "HRC", "pi", "mm,"] {
            assert_eq!(unit_size(none), None, "{none}");
        }
    }
}
