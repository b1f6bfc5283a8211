//! NumPy's own format: an array with one named field per column, so that `numpy.load("rssr.npy")["R1.q [rad]"]` is a
//! column, bit for bit. After <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, version 3.0.

use std::io::{self, Write};

use linkwear_runtime::{Cells, Table, TableColumn};

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
