//! Tables of numbers, and CSV of them. In: columns, or a [`Run`]. Out: text in any writer. Never knows files.

use std::borrow::Cow;
use std::fmt::{self, Write as _};
use std::io::{self, Write};

use crate::error::is_long;
use crate::simulate::Run;

/// Columns of the same length.
pub struct Table<'a> {
    /// Number of rows.
    pub rows: usize,
    /// The columns, in order.
    pub columns: Vec<TableColumn<'a>>,
    /// Whether text has exponents where plain digits would be long.
    pub exponents: bool,
}

/// A column of a table.
pub struct TableColumn<'a> {
    /// Its name, `R1.q`.
    pub name: Cow<'a, str>,
    /// Its unit; empty if it needs none.
    pub unit: Cow<'a, str>,
    /// Its values.
    pub cells: Cells<'a>,
}

/// The values of a column, each by its row, counted from 0.
pub enum Cells<'a> {
    /// Numbers.
    Numbers(Box<dyn Fn(usize) -> f64 + 'a>),
    /// Whole numbers.
    Counts(Box<dyn Fn(usize) -> u64 + 'a>),
    /// Names.
    Names(Box<dyn Fn(usize) -> &'a str + 'a>),
}

impl<'a> Table<'a> {
    /// A table without columns yet, numbers with exponents.
    pub fn new(rows: usize) -> Self {
        Self { rows, columns: Vec::new(), exponents: true }
    }

    /// With a further column; an empty unit: it needs none.
    pub fn column(
        mut self,
        name: impl Into<Cow<'a, str>>,
        unit: impl Into<Cow<'a, str>>,
        cells: Cells<'a>,
    ) -> Self {
        self.columns.push(TableColumn { name: name.into(), unit: unit.into(), cells });
        self
    }
}

impl TableColumn<'_> {
    /// Name and unit: `R1.q [rad]`.
    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.name.to_string() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

impl<'a> Cells<'a> {
    /// Numbers by their row.
    pub fn numbers(value: impl Fn(usize) -> f64 + 'a) -> Self {
        Self::Numbers(Box::new(value))
    }

    /// Whole numbers by their row.
    pub fn counts(value: impl Fn(usize) -> u64 + 'a) -> Self {
        Self::Counts(Box::new(value))
    }

    /// Names by their row.
    pub fn names(value: impl Fn(usize) -> &'a str + 'a) -> Self {
        Self::Names(Box::new(value))
    }
}

impl Run {
    /// The samples: `t [s]`, then the channels.
    pub fn table(&self) -> Table<'_> {
        let time = Table::new(self.rows.len()).column("t", "s", Cells::numbers(|row| self.times[row]));
        self.channels.iter().enumerate().fold(time, |table, (at, channel)| {
            let cells = Cells::numbers(move |row| self.rows[row][at]);
            table.column(&*channel.name, &*channel.unit, cells)
        })
    }
}

/// Writes a line of titles and one line per row. Numbers are the shortest that read back to the same bits, but that zero
/// has no sign; what is not a number is an empty cell.
///
/// # Errors
/// What the writer reports.
pub fn write_csv(writer: &mut dyn Write, table: &Table<'_>) -> io::Result<()> {
    let titles: Vec<String> = table.columns.iter().map(TableColumn::title).collect();
    // A line is told at once: writers take longer to ask than numbers to write.
    let mut line = titles.join(",");
    line.push('\n');
    writer.write_all(line.as_bytes())?;
    for row in 0..table.rows {
        line.clear();
        for (at, column) in table.columns.iter().enumerate() {
            if at > 0 {
                line.push(',');
            }
            write_cell(&mut line, (&column.cells, row), table.exponents).map_err(io::Error::other)?;
        }
        line.push('\n');
        writer.write_all(line.as_bytes())?;
    }
    Ok(())
}

fn write_cell(line: &mut String, (cells, row): (&Cells<'_>, usize), exponents: bool) -> fmt::Result {
    match cells {
        Cells::Numbers(value) => {
            let value = value(row);
            match value {
                _ if value.is_nan() => Ok(()),
                _ if exponents => write_number(line, value),
                _ => write!(line, "{value}"),
            }
        }
        Cells::Counts(value) => write!(line, "{}", value(row)),
        Cells::Names(value) => line.write_str(value(row)),
    }
}

/// Shortest round-trip decimal; exponents where plain digits would be long.
fn write_number(line: &mut String, value: f64) -> fmt::Result {
    if is_long(value) {
        write!(line, "{value:e}")
    } else {
        // `+ 0.0` turns a negative zero into zero.
        write!(line, "{}", value + 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Channel;

    #[test]
    fn a_number_that_is_not_there_is_an_empty_cell() {
        let values = [1.5, f64::NAN];
        let table = Table::new(2).column("x", "m", Cells::numbers(|row| values[row])).column(
            "name",
            "",
            Cells::names(|row| ["a", "b"][row]),
        );
        let mut text = Vec::new();
        write_csv(&mut text, &table).expect("a vector takes every byte");
        assert_eq!(text, b"x [m],name\n1.5,a\n,b\n");
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let values = vec![0.1, -0.0, 1.0 / 3.0, 5e-324, -1.797_693_134_862_315_7e308, 1e-5, 123_456_789.25];
        let channel = |_: &f64| Channel { name: "x".into(), unit: "1".into(), wraps: false };
        let channels = values.iter().map(channel).collect();
        let run = Run { channels, times: vec![0.5], rows: vec![values.clone()], ..Run::default() };
        let mut text = Vec::new();
        write_csv(&mut text, &run.table()).expect("a vector takes every byte");
        let text = String::from_utf8(text).expect("numbers are ASCII");
        let line = text.lines().nth(1).expect("one row");
        assert_eq!(line, "0.5,0.1,0,0.3333333333333333,5e-324,-1.7976931348623157e308,0.00001,123456789.25");
        for (field, value) in line.split(',').skip(1).zip(values) {
            assert_eq!(field.parse::<f64>().expect("a number"), value);
        }
    }

    #[test]
    fn header_names_columns_with_units() {
        let mut text = Vec::new();
        let column = |(name, unit): (&'static str, &'static str)| Channel {
            name: name.into(),
            unit: unit.into(),
            wraps: false,
        };
        let channels = [("R1.q", "rad"), ("R1.drive", "N m")].map(column).to_vec();
        write_csv(&mut text, &Run { channels, ..Run::default() }.table()).expect("a vector takes every byte");
        assert_eq!(text, b"t [s],R1.q [rad],R1.drive [N m]\n");
    }

    struct Full;
    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_reported() {
        let error = write_csv(&mut Full, &Run::default().table()).expect_err("nothing fits");
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
