//! Sampled rows as CSV. In: a [`Run`]. Out: text in any writer.
//! Numbers are the shortest that read back to the same bits.

use std::io::{self, Write};

use crate::simulate::Run;

/// Writes the header `t [s],name [unit],...` and one line per sample.
///
/// # Errors
/// What the writer reports.
pub fn write_csv(writer: &mut dyn Write, run: &Run) -> io::Result<()> {
    write!(writer, "t [s]")?;
    for channel in &run.channels {
        write!(writer, ",{} [{}]", channel.name, channel.unit)?;
    }
    writeln!(writer)?;
    for (t, row) in run.times.iter().zip(&run.rows) {
        write_number(writer, *t)?;
        for value in row {
            writer.write_all(b",")?;
            write_number(writer, *value)?;
        }
        writeln!(writer)?;
    }
    Ok(())
}

/// Shortest round-trip decimal; exponents where plain digits would be long.
fn write_number(writer: &mut dyn Write, value: f64) -> io::Result<()> {
    let size = value.abs();
    // `+ 0.0` turns a negative zero into zero.
    if value == 0.0 || (1e-5..1e16).contains(&size) {
        write!(writer, "{}", value + 0.0)
    } else {
        write!(writer, "{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Channel;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let values = vec![0.1, -0.0, 1.0 / 3.0, 5e-324, -1.797_693_134_862_315_7e308, 1e-5, 123_456_789.25];
        let run = Run { times: vec![0.5], rows: vec![values.clone()], ..Run::default() };
        let mut text = Vec::new();
        write_csv(&mut text, &run).expect("a vector takes every byte");
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
        write_csv(&mut text, &Run { channels, ..Run::default() }).expect("a vector takes every byte");
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
        let error = write_csv(&mut Full, &Run::default()).expect_err("nothing fits");
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
