//! Numbers as messages and tables show them.

/// A number for people: four significant digits, exponents only where they save space.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{value:.3e}")
    } else {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 6")]
        let decimals = (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
        format!("{value:.decimals$}")
    }
}

/// A number with so many decimals, for columns; from 1e9 on with an exponent.
pub fn decimals(value: f64, digits: usize) -> String {
    if value.abs() < 1e9 { format!("{value:.digits$}") } else { format!("{value:.digits$e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_four_digits() {
        let shown: Vec<String> = [0.0, 52.908271, -0.0338, 1.2e-9, 1234567.0].map(number).into();
        assert_eq!(shown, ["0", "52.91", "-0.03380", "1.200e-9", "1.235e6"]);
    }

    #[test]
    fn decimals_of_huge_numbers_have_an_exponent() {
        let shown = [0.25, -999_999_999.0, 1e9, 1e300, f64::INFINITY].map(|value| decimals(value, 2));
        assert_eq!(shown, ["0.25", "-999999999.00", "1.00e9", "1.00e300", "inf"]);
    }
}
