//! Unit symbols: their size in SI and their dimension.
//! In: a symbol such as `mm`. Out: factor and [`Dimension`]. Never knows formulas.

use std::f64::consts::PI;

use super::Dimension;
use super::turning::Turning;

/// A unit: how much of the SI unit it is, and its dimension.
///
/// The size is `factor / divisor`: powers of ten are kept whole, so that "120 mm" is the double nearest
/// to 0.12, as if it had been written "0.12 m".
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    /// Numerator of the size in SI.
    pub factor: f64,
    /// Denominator of the size in SI.
    pub divisor: f64,
    /// Dimension.
    pub dimension: Dimension,
    /// Turns and angles in it.
    pub turning: Turning,
    /// It counts hardness.
    pub hardness: bool,
}

/// Symbols that take the prefixes below.
const PREFIXED: &[(&str, f64, f64, Dimension)] = &[
    ("m", 1.0, 1.0, Dimension::LENGTH),
    ("g", 1.0, 1e3, Dimension::MASS),
    ("s", 1.0, 1.0, Dimension::TIME),
    ("rad", 1.0, 1.0, Dimension::NONE),
    ("Hz", 1.0, 1.0, Dimension::of(0, 0, -1)),
    ("N", 1.0, 1.0, Dimension::FORCE),
    ("J", 1.0, 1.0, Dimension::TORQUE),
    ("W", 1.0, 1.0, Dimension::of(2, 1, -3)),
    ("Pa", 1.0, 1.0, Dimension::of(-1, 1, -2)),
];

/// Symbols that take none. `rpm` is a frequency like `Hz`, turns per second without 2 pi.
const PLAIN: &[(&str, f64, f64, Dimension)] = &[
    ("t", 1e3, 1.0, Dimension::MASS),
    ("min", 60.0, 1.0, Dimension::TIME),
    ("h", 3600.0, 1.0, Dimension::TIME),
    ("deg", PI, 180.0, Dimension::NONE),
    ("rpm", 1.0, 60.0, Dimension::of(0, 0, -1)),
    ("%", 1.0, 100.0, Dimension::NONE),
    // Brinell and Vickers numbers are kgf/mm^2.
    ("HB", 9_806_650.0, 1.0, PRESSURE),
    ("HBW", 9_806_650.0, 1.0, PRESSURE),
    ("HV", 9_806_650.0, 1.0, PRESSURE),
];

const PRESSURE: Dimension = Dimension::of(-1, 1, -2);

/// Prefixes as powers of ten.
const PREFIXES: &[(&str, i32)] = &[
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("k", 3),
    ("M", 6),
    ("G", 9),
];

impl Unit {
    /// No unit.
    pub const ONE: Self = Self {
        factor: 1.0,
        divisor: 1.0,
        dimension: Dimension::NONE,
        turning: Turning { turns: 0, angles: 0 },
        hardness: false,
    };

    /// Product; `None` if an exponent overflows.
    pub fn times(self, other: Self) -> Option<Self> {
        Some(Self {
            factor: self.factor * other.factor,
            divisor: self.divisor * other.divisor,
            dimension: self.dimension.times(other.dimension)?,
            turning: self.turning.times(other.turning),
            hardness: self.hardness || other.hardness,
        })
    }

    /// Power; `None` if an exponent overflows.
    pub fn to_power(self, exponent: i32) -> Option<Self> {
        let (factor, divisor) =
            if exponent < 0 { (self.divisor, self.factor) } else { (self.factor, self.divisor) };
        let size = i32::try_from(exponent.unsigned_abs()).ok()?;
        let dimension = self.dimension.to_power(exponent)?;
        let turning = self.turning.to_power(exponent);
        let [factor, divisor] = [factor, divisor].map(|part| part.powi(size));
        Some(Self { factor, divisor, dimension, turning, hardness: self.hardness })
    }

    /// `number` of this unit in SI.
    pub fn to_si(self, number: f64) -> f64 {
        number * self.factor / self.divisor
    }
}

/// Whether the symbol is that of a hardness that is proportional to a pressure.
pub(super) fn is_hardness(symbol: &str) -> bool {
    matches!(symbol, "HB" | "HBW" | "HV")
}

/// The unit with this symbol.
pub(super) fn unit(symbol: &str) -> Option<Unit> {
    let find = |list: &[(&str, f64, f64, Dimension)], symbol: &str| {
        let (_, factor, divisor, dimension) = list.iter().find(|(known, ..)| *known == symbol)?;
        let turning = match symbol {
            "Hz" | "rpm" => Turning::TURNS,
            "rad" | "deg" => Turning::ANGLE,
            _ => Turning::default(),
        };
        let hardness = is_hardness(symbol);
        Some(Unit { factor: *factor, divisor: *divisor, dimension: *dimension, turning, hardness })
    };
    if symbol == "kg" {
        return Some(Unit { dimension: Dimension::MASS, ..Unit::ONE });
    }
    find(PLAIN, symbol).or_else(|| find(PREFIXED, symbol)).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, power)| {
            let unit = find(PREFIXED, symbol.strip_prefix(prefix)?)?;
            let size = 10f64.powi(power.abs());
            Some(if *power < 0 {
                Unit { divisor: unit.divisor * size, ..unit }
            } else {
                Unit { factor: unit.factor * size, ..unit }
            })
        })
    })
}

/// What a person may have meant by an unknown symbol: a near one, or two run together (`Nm`).
pub(super) fn suggestion(symbol: &str) -> Option<String> {
    for (split, _) in symbol.char_indices().skip(1) {
        let (first, second) = symbol.split_at(split);
        // `mmm` is a slip, not a product: no unit is written as a product of two lengths.
        if let (Some(a), Some(b)) = (unit(first), unit(second))
            && a.dimension != b.dimension
        {
            return Some(format!("{first} {second}"));
        }
    }
    const COMMON: &[&str] = &[
        "mm", "cm", "km", "um", "kg", "g", "ms", "min", "rad", "deg", "Hz", "kHz", "rpm", "N", "kN", "J",
        "W", "Pa", "kPa", "MPa", "GPa", "m", "s", "h", "HV",
    ];
    crate::diagnostic::nearest(symbol, COMMON.iter().copied()).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixed_quantities_are_the_nearest_double() {
        // Each pair is one quantity written twice; a product with 1e-3 would miss some by one bit.
        for thousandths in 1..=2000 {
            let number = f64::from(thousandths);
            let written: f64 = format!("{thousandths}e-3").parse().unwrap();
            assert_eq!(unit("mm").unwrap().to_si(number), written);
            assert_eq!(unit("g").unwrap().to_si(number), written);
        }
        assert_eq!(unit("GPa").unwrap().to_si(210.0), 210e9);
        assert_eq!(unit("µm").unwrap().to_si(10.0), 1e-5);
        assert_eq!(unit("kg").unwrap().to_si(1.0), 1.0);
        assert_eq!(unit("kt"), None);
    }

    #[test]
    fn minutes_and_tonnes_are_not_prefixes() {
        assert_eq!(unit("min").unwrap().to_si(1.0), 60.0);
        assert_eq!(unit("t").unwrap().dimension, Dimension::MASS);
    }

    #[test]
    fn brinell_and_vickers_numbers_are_kilogram_forces_per_square_millimetre() {
        for symbol in ["HB", "HBW", "HV"] {
            assert_eq!(unit(symbol).unwrap().to_si(120.0), 120.0 * 9.80665e6);
        }
    }

    #[test]
    fn run_together_units_are_taken_apart() {
        assert_eq!(suggestion("Nm").as_deref(), Some("N m"));
        assert_eq!(suggestion("mmm").as_deref(), Some("mm"));
        assert_eq!(suggestion("newton"), None);
        assert_eq!(suggestion("MPA").as_deref(), Some("MPa"));
    }
}
