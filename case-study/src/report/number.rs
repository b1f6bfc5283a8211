//! Numbers as the report writes them.

/// Digits after the point.
pub fn fixed(value: f64, digits: usize) -> String {
    format!("{value:.digits$}")
}

/// A part of all, in whole per cents.
pub fn percent(part: f64) -> String {
    format!("{:.0} %", 100.0 * part)
}

/// With its sign.
pub fn signed(value: f64, digits: usize) -> String {
    // Adding zero turns -0 into 0.
    let rounded = (value * 10_f64.powi(digits as i32)).round() / 10_f64.powi(digits as i32) + 0.0;
    format!("{rounded:+.digits$}")
}

/// A part of all in per cents, with its sign.
pub fn signed_percent(part: f64, digits: usize) -> String {
    format!("{} %", signed(100.0 * part, digits))
}
