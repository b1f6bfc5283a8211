//! Text tables: left-aligned words, columns as wide as they need.

/// Rows of a table for people: more would push the summary off the screen.
const ROWS: usize = 24;

/// A table that ends after a screenful and says how much it leaves out; machines get all rows.
pub fn short_table(header: &[&str], mut rows: Vec<Vec<String>>) -> String {
    let more = rows.len().saturating_sub(ROWS);
    rows.truncate(ROWS);
    let mut text = table(header, &rows);
    if more > 0 {
        text.push_str(&format!("  .. and {more} more; --format json lists all\n"));
    }
    text
}

/// Lines of a table, indented by two, two spaces between columns, no trailing space.
/// Columns whose cells all read as numbers are aligned right.
pub fn table(header: &[impl AsRef<str>], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain(header.get(column).map(|title| title.as_ref().chars().count())).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let right: Vec<bool> = (0..header.len()).map(|column| is_numeric(rows, column)).collect();
    let line = |cells: Vec<&str>| {
        let mut text = String::from(" ");
        for ((cell, width), right) in cells.iter().zip(&widths).zip(&right) {
            let padding = " ".repeat(width - cell.chars().count());
            text.push(' ');
            text.push_str(&if *right { format!("{padding}{cell}") } else { format!("{cell}{padding}") });
            text.push(' ');
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
        text
    };
    let mut text = String::new();
    if header.iter().any(|title| !title.as_ref().is_empty()) {
        text.push_str(&line(header.iter().map(AsRef::as_ref).collect()));
    }
    for row in rows {
        text.push_str(&line(row.iter().map(String::as_str).collect()));
    }
    text
}

fn is_numeric(rows: &[Vec<String>], column: usize) -> bool {
    let mut cells = rows.iter().filter_map(|row| row.get(column)).filter(|cell| !cell.is_empty()).peekable();
    cells.peek().is_some() && cells.all(|cell| cell.replace(',', "").parse::<f64>().is_ok())
}

/// A time for people: `2.345 s`, `0.7 ms`.
pub fn duration(seconds: f64) -> String {
    if seconds < 0.1 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.3} s") }
}

/// A count with separators: 12,345.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `1 body`, `2 bodies`.
pub fn plural(value: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(value), if value == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_align_and_numbers_lean_right() {
        let rows = [vec!["R1".to_owned(), "1.5".to_owned()], vec!["S22".to_owned(), "12.25".to_owned()]];
        assert_eq!(table(&["joint", "N"], &rows), "  joint      N\n  R1       1.5\n  S22    12.25\n");
    }

    #[test]
    fn long_tables_say_what_they_leave_out() {
        let rows = vec![vec!["R".to_owned()]; ROWS + 3];
        let text = short_table(&[""], rows.clone());
        assert_eq!(text.lines().count(), ROWS + 1);
        assert!(text.ends_with(".. and 3 more; --format json lists all\n"), "{text}");
        assert_eq!(short_table(&[""], rows[3..].to_vec()), table(&[""], &rows[3..]));
    }

    #[test]
    fn short_times_are_milliseconds() {
        assert_eq!((duration(0.00071), duration(2.3456)), ("0.7 ms".into(), "2.346 s".into()));
    }

    #[test]
    fn counts_have_separators() {
        assert_eq!([7, 1234, 1_234_567].map(count), ["7", "1,234", "1,234,567"]);
    }
}
