//! Why a cell is no number, and what to write. In: a cell. Out: cause and cure. Never knows tables.

/// Cause, after the name and the text of the cell; and cure.
pub type Wrong = (String, String);

/// What is wrong with a cell in a column of a name that is no finite number.
pub fn why(name: &str, cell: &str) -> Wrong {
    if let Some(wrong) = with_commas(cell) {
        return wrong;
    }
    // Of infinite numbers and of no number, too, the letters are no unit.
    let is_number = cell.parse::<f64>().is_ok();
    let joined = cell.replace('_', "");
    if !is_number && joined.parse::<f64>().is_ok_and(f64::is_finite) {
        return (
            format!("is `{cell}`, a number with underscores"),
            format!("leave them out in all numbers: `{joined}`"),
        );
    }
    let unit = cell.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE ".contains(c));
    if !is_number && !unit.is_empty() && unit.len() < cell.len() {
        let help =
            format!("one unit per column: convert all rows, and put it into the header, `{name}_{unit}`");
        return (format!("is `{cell}`, a number with a unit"), help);
    }
    let cause =
        if cell.is_empty() { "is empty".to_owned() } else { format!("is `{cell}`, not a finite number") };
    (cause, "write a number, or delete the line".to_owned())
}

/// The same of digits with commas: between thousands, before decimals, or who knows.
fn with_commas(cell: &str) -> Option<Wrong> {
    let (joined, pointed) = (cell.replace(',', ""), cell.replacen(',', ".", 1));
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    let (commas, is_decimal) = (cell.matches(',').count(), is_number(&pointed));
    if commas == 0 || !is_number(&joined) {
        return None;
    }
    match (has_thousands(cell), is_decimal) {
        (true, true) => Some((
            format!(
                "is `{cell}`, a number with a comma, of which nobody knows whether it is a decimal comma"
            ),
            format!("write `{joined}` if it parts thousands, `{pointed}` if decimals, so in all numbers"),
        )),
        (true, false) => Some((
            format!("is `{cell}`, a number with commas between thousands"),
            format!("leave them out in all numbers: `{joined}`"),
        )),
        (false, true) => Some((
            format!("is `{cell}`, a number with a decimal comma"),
            format!("write a decimal point in all numbers: `{pointed}`"),
        )),
        (false, false) => None,
    }
}

/// Whether three digits stand after each comma, and one to three, no zero first, before the first one.
fn has_thousands(cell: &str) -> bool {
    let whole = cell.trim_start_matches(['+', '-']);
    let whole = whole.split_once('.').map_or(whole, |(whole, _)| whole);
    let mut groups = whole.split(',');
    let is_first = |group: &str| (1..=3).contains(&group.len()) && !group.starts_with('0');
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    groups.next().is_some_and(|group| is_first(group) && is_digits(group))
        && groups.all(|group| group.len() == 3 && is_digits(group))
}

#[cfg(test)]
mod tests {
    use super::why;

    #[test]
    fn commas_of_thousands_and_of_decimals_are_told_apart_where_they_can_be() {
        for (cell, cause, cure) in [
            ("1,000", "nobody knows", "`1000` if it parts thousands, `1.000` if decimals"),
            ("-12,500", "nobody knows", "`-12500`"),
            ("1,234,567", "between thousands", "`1234567`"),
            ("1,234.5", "between thousands", "`1234.5`"),
            ("0,125", "decimal comma", "`0.125`"),
            ("2,5", "decimal comma", "`2.5`"),
            ("1234,567", "decimal comma", "`1234.567`"),
            ("2 h", "with a unit", "`w_h`"),
            ("-inf", "not a finite number", "write a number"),
            ("+NaN", "not a finite number", "write a number"),
            ("1e999", "not a finite number", "write a number"),
            ("1_000", "with underscores", "`1000`"),
            ("x", "not a finite number", "write a number"),
            ("", "is empty", "write a number"),
        ] {
            let (found, help) = why("w", cell);
            assert!(found.contains(cause) && help.contains(cure), "{cell}: {found}; {help}");
        }
    }
}
