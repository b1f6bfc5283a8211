//! Apache Parquet: columns of doubles, of whole numbers and of names, no value missing, so that any program that reads tables has them
//! bit for bit with their types. What is known about the table is in the file's metadata under `linkwear`. Nothing is compressed, and
//! nothing depends on when and where it was written.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use linkwear_runtime::{Cells, Table, TableColumn};
use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesBuilder};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::types::{ColumnPath, Type, TypePtr};
use serde_json::Value;

use super::read::{CellsRead, Read};

/// Rows that are held in memory column by column, and that readers may share out among threads.
const GROUP: usize = 1 << 17;
/// Key of what is known about the table.
const KEY: &str = "linkwear";

/// Writes a file: groups of rows, then the names of the columns and what is known about them.
pub fn write(out: &mut (dyn Write + Send), table: &Table<'_>, about: &Value) -> io::Result<()> {
    in_groups(out, table, about, GROUP).map_err(|error| match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(error) => io::Error::other(error),
        },
        error => io::Error::other(error),
    })
}

fn in_groups(
    out: &mut (dyn Write + Send),
    table: &Table<'_>,
    about: &Value,
    group: usize,
) -> Result<(), ParquetError> {
    let fields = table.columns.iter().map(|column| field(column.title(), &column.cells));
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Arc::new(Type::group_type_builder("rows").with_fields(fields).build()?);
    let mut file = SerializedFileWriter::new(out, schema, Arc::new(properties(table, about)))?;
    let mut first = 0;
    while first < table.rows {
        let rows = first..table.rows.min(first + group);
        let mut group = file.next_row_group()?;
        for column in &table.columns {
            let Some(mut chunk) = group.next_column()? else { break };
            match (chunk.untyped(), &column.cells) {
                (ColumnWriter::DoubleColumnWriter(chunk), Cells::Numbers(value)) => {
                    chunk.write_batch(&rows.clone().map(value).collect::<Vec<_>>(), None, None)?;
                }
                (ColumnWriter::Int64ColumnWriter(chunk), Cells::Counts(value)) => {
                    let counts: Vec<i64> = rows.clone().map(|row| value(row).cast_signed()).collect();
                    chunk.write_batch(&counts, None, None)?;
                }
                (ColumnWriter::ByteArrayColumnWriter(chunk), Cells::Names(value)) => {
                    let names: Vec<ByteArray> = rows.clone().map(|row| value(row).into()).collect();
                    chunk.write_batch(&names, None, None)?;
                }
                _ => {
                    return Err(ParquetError::General("a column has another type than its field".to_owned()));
                }
            }
            chunk.close()?;
        }
        group.close()?;
        first = rows.end;
    }
    file.close().map(drop)
}

fn field(title: String, cells: &Cells<'_>) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match cells {
        Cells::Numbers(_) => (Physical::DOUBLE, None),
        Cells::Counts(_) => (Physical::INT64, Some(LogicalType::integer(64, false))),
        Cells::Names(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&title, physical).with_repetition(Repetition::REQUIRED);
    field.with_logical_type(logical).build().map(Arc::new)
}

/// Values as they are, names once each; least and largest values of a group, by which readers pass over it.
fn properties(table: &Table<'_>, about: &Value) -> WriterProperties {
    let properties = WriterProperties::builder()
        .set_created_by(concat!("linkwear version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(vec![KeyValue::new(KEY.to_owned(), about.to_string())]))
        .set_compression(Compression::UNCOMPRESSED)
        .set_encoding(Encoding::PLAIN)
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_offset_index_disabled(true);
    let names = table.columns.iter().filter(|column| matches!(column.cells, Cells::Names(_)));
    let enabled = |properties: WriterPropertiesBuilder, title: String| {
        properties.set_column_dictionary_enabled(ColumnPath::from(vec![title]), true)
    };
    names.map(TableColumn::title).fold(properties, enabled).build()
}

/// Reads a file of plain columns, as [`write`] writes it.
#[cfg(feature = "cli")]
pub fn read(file: &Path) -> io::Result<Read> {
    let reader = SerializedFileReader::new(File::open(file)?).map_err(io::Error::other)?;
    let about = reader.metadata().file_metadata().key_value_metadata();
    let about = about.and_then(|pairs| pairs.iter().find(|pair| pair.key == KEY)?.value.as_ref());
    let about = about.and_then(|text| serde_json::from_str(text).ok());
    let mut columns: Vec<(String, CellsRead)> = Vec::new();
    for row in reader.get_row_iter(None).map_err(io::Error::other)? {
        for (at, (title, cell)) in row.map_err(io::Error::other)?.get_column_iter().enumerate() {
            let number = match cell {
                Field::Double(number) => Some(*number),
                Field::ULong(number) => Some(*number as f64),
                Field::Long(number) => Some(*number as f64),
                _ => None,
            };
            if columns.len() == at {
                let empty = match number {
                    Some(_) => CellsRead::Numbers(Vec::new()),
                    None => CellsRead::Texts(Vec::new()),
                };
                columns.push((title.clone(), empty));
            }
            match &mut columns[at].1 {
                CellsRead::Numbers(cells) => cells.push(number.unwrap_or(f64::NAN)),
                CellsRead::Texts(cells) => cells.push(match cell {
                    Field::Str(text) => text.clone(),
                    other => other.to_string(),
                }),
            }
        }
    }
    Ok((columns, about))
}

#[cfg(test)]
mod tests {

    use super::*;
    use parquet::record::RowAccessor as _;
    use serde_json::json;

    fn written(table: &Table<'_>, group: usize) -> Vec<u8> {
        let mut file = Vec::new();
        in_groups(&mut file, table, &json!({ "format": 1 }), group).expect("a vector takes every byte");
        file
    }

    fn reader(bytes: &[u8]) -> SerializedFileReader<File> {
        let mut file = tempfile::tempfile().expect("a temporary file");
        file.write_all(bytes).expect("room");
        SerializedFileReader::new(file).expect("Parquet")
    }

    #[test]
    fn what_is_written_reads_back_to_the_bit_group_by_group_and_is_the_same_again() {
        let numbers = [0.1, -0.0, 5e-324, f64::NEG_INFINITY, 1.0 / 3.0];
        let names = ["R1", "S2", "R1", "Grübler", ""];
        let table = Table::new(5)
            .column("R1.q", "rad", Cells::numbers(|row| numbers[row]))
            .column("cycle", "", Cells::counts(|row| u64::MAX - row as u64))
            .column("failed joint", "", Cells::names(|row| names[row]));
        let file = written(&table, 2);
        assert_eq!(file, written(&table, 2));
        let reader = reader(&file);
        let about = reader.metadata().file_metadata();
        let fields = about.schema_descr().columns().iter().map(|column| column.name());
        assert_eq!(fields.collect::<Vec<_>>(), ["R1.q [rad]", "cycle", "failed joint"]);
        let known = about.key_value_metadata().expect("metadata");
        assert_eq!((&*known[0].key, known[0].value.as_deref()), ("linkwear", Some(r#"{"format":1}"#)));
        assert_eq!(about.created_by(), Some(concat!("linkwear version ", env!("CARGO_PKG_VERSION"))));
        assert_eq!(reader.num_row_groups(), 3);
        for (at, row) in reader.get_row_iter(None).expect("rows").enumerate() {
            let row = row.expect("a row");
            assert_eq!(row.get_double(0).expect("a number").to_bits(), numbers[at].to_bits());
            assert_eq!(row.get_ulong(1).expect("a count"), u64::MAX - at as u64);
            assert_eq!(row.get_string(2).expect("a name"), names[at]);
        }
    }

    #[test]
    fn a_table_without_rows_has_its_columns() {
        let table = Table::new(0).column("t", "s", Cells::numbers(|_| 0.0));
        let reader = reader(&written(&table, GROUP));
        assert_eq!((reader.num_row_groups(), reader.metadata().file_metadata().num_rows()), (0, 0));
        assert_eq!(reader.metadata().file_metadata().schema_descr().column(0).name(), "t [s]");
    }

    #[test]
    fn a_full_disk_is_reported_as_one() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let error = write(&mut Full, &Table::new(0), &Value::Null).expect_err("nothing fits");
        assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{error}");
    }
}
