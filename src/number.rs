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

/// A number with so many decimals; what rounds to 0 has no sign, as 0 has none.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|digit| matches!(digit, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// A number with so many decimals, for columns; with an exponent from 1e9 on, and where decimals would leave it less than
/// two significant digits.
pub fn decimals(value: f64, digits: usize) -> String {
    let (size, least) = (value.abs(), 10_f64.powi(1 - i32::try_from(digits).unwrap_or(0)));
    let is_plain = value == 0.0 || (least.min(1.0)..1e9).contains(&size);
    if is_plain { fixed(value, digits) } else { format!("{value:.digits$e}") }
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
    fn what_rounds_to_zero_has_no_sign() {
        let shown = [-1e-9, -0.0, -0.004, -0.006, 0.0, -10.0].map(|value| fixed(value, 2));
        assert_eq!(shown, ["0.00", "0.00", "0.00", "-0.01", "0.00", "-10.00"]);
        assert_eq!([fixed(-0.4, 0), decimals(-0.0, 6), number(-0.0)], ["0", "0.000000", "0"]);
        assert_eq!([f64::NEG_INFINITY, f64::NAN].map(|value| fixed(value, 2)), ["-inf", "NaN"]);
    }

    #[test]
    fn decimals_of_tiny_numbers_have_an_exponent() {
        let shown = [0.0, 1.766e-8, -9.9e-6, 1e-5, 0.25, f64::NAN].map(|value| decimals(value, 6));
        assert_eq!(shown, ["0.000000", "1.766000e-8", "-9.900000e-6", "0.000010", "0.250000", "NaN"]);
        assert_eq!([0.0099, 0.01].map(|value| decimals(value, 3)), ["9.900e-3", "0.010"]);
    }

    #[test]
    fn decimals_of_huge_numbers_have_an_exponent() {
        let shown = [1.25, -999_999_999.0, 1e9, 1e300, f64::INFINITY].map(|value| decimals(value, 2));
        assert_eq!(shown, ["1.25", "-999999999.00", "1.00e9", "1.00e300", "inf"]);
    }
}
