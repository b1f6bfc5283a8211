//! Units as powers of base units. In: a unit as columns have it. Out: its powers. Never knows other units than SI's.

use linkwear_codegen::spec::Dimension;

/// Names of the base units of FMI.
pub const BASE: [&str; 4] = ["kg", "m", "s", "rad"];

/// Powers of [`BASE`]; none if a part is unknown.
pub fn powers(unit: &str) -> Option<[i32; 4]> {
    let mut powers = [0; 4];
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    for (text, sign) in [(above, 1), (below, -1)] {
        for factor in text.trim_matches(['(', ')']).split_whitespace() {
            let (symbol, power) = factor.split_once('^').unwrap_or((factor, "1"));
            let power: i32 = power.parse().ok()?;
            for (total, own) in powers.iter_mut().zip(of_symbol(symbol)?) {
                *total += sign * power * own;
            }
        }
    }
    Some(powers)
}

/// The unit of the rate in time of what has this unit; none if a part is unknown.
pub fn rate(unit: &str) -> Option<String> {
    let [mass, length, time, angle] = powers(unit)?;
    let time = time - 1;
    if angle == 0 {
        let exponent = |power: i32| i8::try_from(power).ok();
        return Some(Dimension::of(exponent(length)?, exponent(mass)?, exponent(time)?).si_unit());
    }
    let part = |sign: i32| {
        let factors = BASE.into_iter().zip([mass, length, time, angle]);
        let factors = factors.filter(|(_, power)| power.signum() == sign);
        let factor = |(base, power): (&str, i32)| match power.abs() {
            1 => base.to_owned(),
            power => format!("{base}^{power}"),
        };
        factors.map(factor).collect::<Vec<_>>()
    };
    let (above, below) = (part(1), part(-1));
    let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
    Some(match below.len() {
        0 => above,
        1 => format!("{above}/{}", below[0]),
        _ => format!("{above}/({})", below.join(" ")),
    })
}

fn of_symbol(symbol: &str) -> Option<[i32; 4]> {
    Some(match symbol {
        "1" => [0, 0, 0, 0],
        "kg" => [1, 0, 0, 0],
        "m" => [0, 1, 0, 0],
        "s" => [0, 0, 1, 0],
        "rad" => [0, 0, 0, 1],
        "Hz" => [0, 0, -1, 0],
        "N" => [1, 1, -2, 0],
        "J" => [1, 2, -2, 0],
        "W" => [1, 2, -3, 0],
        "Pa" => [1, -1, -2, 0],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_columns_are_powers_of_base_units() {
        assert_eq!(powers("N m"), Some([1, 2, -2, 0]));
        assert_eq!(powers("rad/s^2"), Some([0, 0, -2, 1]));
        assert_eq!(powers("1/(m s^2)"), Some([0, -1, -2, 0]));
        assert_eq!(powers("N s/m"), Some([1, 0, -1, 0]));
        assert_eq!(powers("1"), Some([0; 4]));
        assert_eq!(powers("furlong"), None);
    }

    #[test]
    fn the_unit_of_a_rate_is_that_of_its_quantity_over_seconds() {
        for (unit, of_rate) in [
            ("1", "1/s"),
            ("rad", "rad/s"),
            ("rad/s", "rad/s^2"),
            ("m/s", "m/s^2"),
            ("1/(m s)", "1/(m s^2)"),
            ("kg/s", "N/m"),
            ("s^2", "s"),
            ("N s", "N"),
            ("1/s^2", "1/s^3"),
            ("s/m", "1/m"),
            ("N m", "W"),
        ] {
            assert_eq!(rate(unit).as_deref(), Some(of_rate), "{unit}");
            let [over_seconds, of_unit] = [of_rate, unit].map(|unit| powers(unit).expect("known"));
            assert_eq!(over_seconds[2], of_unit[2] - 1, "{unit}");
        }
        assert_eq!(rate("furlong"), None);
    }
}
