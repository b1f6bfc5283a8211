//! Units as powers of base units. In: a unit as columns have it. Out: its powers. Never knows other units than SI's.

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
}
