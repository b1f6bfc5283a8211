//! NumPy's own format: an array with one named field per column, so that `numpy.load("rssr.npy")["R1.q [rad]"]` is a
//! column, bit for bit. After <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, version 3.0.

#[cfg(feature = "cli")]
use std::fs;
use std::io::{self, Write};
#[cfg(feature = "cli")]
use std::path::Path;

use linkwear_runtime::{Cells, Table, TableColumn};

#[cfg(feature = "cli")]
use super::read::{CellsRead, Read, broken};

/// Magic bytes, version, length of the header.
const BEFORE_HEADER: usize = 6 + 2 + 4;
/// The values begin at a multiple of this.
const ALIGNMENT: usize = 64;

/// Writes a file: the header, then the rows.
pub fn write(out: &mut dyn Write, table: &Table<'_>) -> io::Result<()> {
    let width = |column: &TableColumn<'_>| match &column.cells {
        Cells::Names(name) => (0..table.rows).map(|row| name(row).chars().count()).max().unwrap_or(0).max(1),
        Cells::Numbers(_) | Cells::Counts(_) => 1,
    };
    let widths: Vec<usize> = table.columns.iter().map(width).collect();
    let fields = table.columns.iter().zip(&widths).map(|(column, width)| match &column.cells {
        Cells::Numbers(_) => format!("('{}', '<f8')", column.title()),
        Cells::Counts(_) => format!("('{}', '<u8')", column.title()),
        Cells::Names(_) => format!("('{}', '<U{width}')", column.title()),
    });
    let fields: Vec<String> = fields.collect();
    let mut header =
        format!("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", fields.join(", "), table.rows);
    let end = (BEFORE_HEADER + header.len() + 1).next_multiple_of(ALIGNMENT);
    header.push_str(&" ".repeat(end - 1 - BEFORE_HEADER - header.len()));
    header.push('\n');
    let length = u32::try_from(header.len()).map_err(io::Error::other)?;
    out.write_all(b"\x93NUMPY\x03\x00")?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for row in 0..table.rows {
        for (column, width) in table.columns.iter().zip(&widths) {
            match &column.cells {
                Cells::Numbers(value) => out.write_all(&value(row).to_le_bytes())?,
                Cells::Counts(value) => out.write_all(&value(row).to_le_bytes())?,
                Cells::Names(name) => {
                    let letters = name(row).chars().map(u32::from).chain(std::iter::repeat(0));
                    for letter in letters.take(*width) {
                        out.write_all(&letter.to_le_bytes())?;
                    }
                }
            }
        }
    }
    Ok(())
}

/// A type of a field: what it is of, bytes.
#[cfg(feature = "cli")]
#[derive(Clone, Copy)]
enum Field {
    Number,
    Unsigned,
    Signed,
    Letters(usize),
}

#[cfg(feature = "cli")]
impl Field {
    fn of(code: &str) -> Option<Self> {
        match code {
            "<f8" => Some(Self::Number),
            "<u8" => Some(Self::Unsigned),
            "<i8" => Some(Self::Signed),
            _ => code.strip_prefix("<U")?.parse().ok().map(Self::Letters),
        }
    }

    fn bytes(self) -> usize {
        if let Self::Letters(count) = self { 4 * count } else { 8 }
    }

    fn number(self, bytes: &[u8]) -> Option<f64> {
        let bytes = bytes.try_into().ok()?;
        match self {
            Self::Number => Some(f64::from_le_bytes(bytes)),
            Self::Unsigned => Some(u64::from_le_bytes(bytes) as f64),
            Self::Signed => Some(i64::from_le_bytes(bytes) as f64),
            Self::Letters(_) => None,
        }
    }
}

/// Reads a structured array, as [`write`] and `numpy.save` write it.
#[cfg(feature = "cli")]
pub fn read(file: &Path) -> io::Result<Read> {
    let bytes = fs::read(file)?;
    let none = || broken("it is no structured array of NumPy");
    let version = bytes.get(6).filter(|_| bytes.starts_with(b"\x93NUMPY")).ok_or_else(none)?;
    let (length, begin) = match version {
        1 => (bytes.get(8..10).map(|two| u32::from(two[0]) | u32::from(two[1]) << 8), 10),
        _ => (bytes.get(8..12).and_then(|four| Some(u32::from_le_bytes(four.try_into().ok()?))), 12),
    };
    let end = begin + length.and_then(|length| usize::try_from(length).ok()).ok_or_else(none)?;
    let header = bytes.get(begin..end).and_then(|header| str::from_utf8(header).ok()).ok_or_else(none)?;
    let fields = fields(header).filter(|fields| !fields.is_empty()).ok_or_else(none)?;
    let width: usize = fields.iter().map(|(_, field)| field.bytes()).sum();
    if width == 0 || (bytes.len() - end) % width != 0 {
        return Err(broken("its rows do not end where the file does"));
    }
    let rows: Vec<&[u8]> = bytes[end..].chunks(width).collect();
    let mut first = 0;
    let columns = fields.into_iter().map(|(title, field)| {
        let place = first..first + field.bytes();
        first = place.end;
        let own = || rows.iter().map(|row| &row[place.clone()]);
        let cells = if let Field::Letters(_) = field {
            let letter = |four: &[u8]| char::from_u32(u32::from_le_bytes(four.try_into().ok()?));
            let text =
                |cell: &[u8]| cell.chunks(4).filter_map(letter).filter(|letter| *letter != '\0').collect();
            CellsRead::Texts(own().map(text).collect())
        } else {
            CellsRead::Numbers(own().map(|cell| field.number(cell).unwrap_or(f64::NAN)).collect())
        };
        (title, cells)
    });
    Ok((columns.collect(), None))
}

/// Titles and types of `[('t [s]', '<f8'), ..]`.
#[cfg(feature = "cli")]
fn fields(header: &str) -> Option<Vec<(String, Field)>> {
    let list = header.split_once("[(")?.1.split_once(")]")?.0;
    let pairs = list.split("), (").map(|pair| {
        let (title, code) = pair.rsplit_once(", ")?;
        let bare = |text: &str| text.trim().trim_matches(['\'', '"']).to_owned();
        Some((bare(title), Field::of(&bare(code))?))
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_names_the_fields_and_rows_follow_it_without_gaps() {
        let names = ["R1", "S23"];
        let table = Table::new(2)
            .column("cycle", "", Cells::counts(|row| row as u64 + 1))
            .column("wear", "m", Cells::numbers(|row| 0.1 * row as f64))
            .column("joint", "", Cells::names(|row| names[row]));
        let mut file = Vec::new();
        write(&mut file, &table).expect("a vector takes every byte");
        assert_eq!(&file[..8], b"\x93NUMPY\x03\x00");
        let length = u32::from_le_bytes(file[8..12].try_into().expect("four bytes")) as usize;
        let (header, rows) = file[12..].split_at(length);
        assert_eq!((12 + length) % 64, 0);
        assert_eq!(
            std::str::from_utf8(header).expect("UTF-8").trim_end(),
            "{'descr': [('cycle', '<u8'), ('wear [m]', '<f8'), ('joint', '<U3')], 'fortran_order': False, \
             'shape': (2,), }"
        );
        let text = |letters: [u32; 3]| letters.map(u32::to_le_bytes).concat();
        let first = [&1_u64.to_le_bytes()[..], &0.0_f64.to_le_bytes(), &text([82, 49, 0])].concat();
        let second = [&2_u64.to_le_bytes()[..], &0.1_f64.to_le_bytes(), &text([83, 50, 51])].concat();
        assert_eq!(rows, [first, second].concat());
    }
}
