//! Tables of numbers in CSV files. In: a path. Out: cells by named columns, with their lines; or what is wrong, where, and
//! what to do. Never knows what the columns mean.

mod error;
mod number;
pub(crate) mod rows;

use std::path::Path;

use linkwear_codegen::diagnostic::{cut, nearest};
use linkwear_codegen::input::read_text;
use linkwear_codegen::limits;

pub use self::error::CsvError;
use self::error::{fault, gather};
use self::rows::{BrokenRow, Row, Rows};
use crate::checksum::sha256_of;

/// What parts columns, for a table that has them parted otherwise.
const BY_COMMAS: &str = "columns are parted by commas: write the file with commas, and decimal points";

/// Letters of a cell or of a list of names that are shown.
const SHOWN: [usize; 2] = [40, 300];

/// A CSV file in memory.
pub struct CsvTable<'a> {
    file: &'a Path,
    /// Line of the header.
    head: usize,
    header: Vec<String>,
    rows: Vec<Row>,
    /// How many comments after the header look like rows.
    like_rows: usize,
    sha256: String,
}

impl<'a> CsvTable<'a> {
    /// Reads the file; its first line that is neither empty nor a comment (#) is the header.
    ///
    /// # Errors
    /// [`CsvError`].
    pub fn read(file: &'a Path) -> Result<Self, CsvError> {
        let text = read_text(file, limits::DATA_BYTES);
        Self::parse(file, &text.map_err(|error| CsvError::Read { file: file.to_path_buf(), error })?)
    }

    /// The same of its text.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn parse(file: &'a Path, text: &str) -> Result<Self, CsvError> {
        // A byte order mark would hide in the first name.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut rows = Rows::new(text, true);
        let Some(header) = rows.next() else {
            let help = "write a line of column names, then one reading a line";
            return Err(fault(file, None, "the file is empty".to_owned(), help));
        };
        let (head, header) = header.map_err(|row| broken(file, &[], row))?;
        let header: Vec<String> = header.iter().map(str::to_owned).collect();
        let before = rows.comments().len();
        let read = gather(rows.by_ref().map(|row| row.map_err(|row| broken(file, &header, row))))?;
        let comments = &rows.comments()[before..];
        let like_rows = comments.iter().filter(|comment| is_like_a_row(comment, header.len())).count();
        Ok(Self { file, head, header, rows: read, like_rows, sha256: sha256_of(text.as_bytes()) })
    }

    /// SHA-256 of the text.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// How many comments after the header look like rows: they have as many cells, two of them numbers at least.
    pub fn comments_like_rows(&self) -> usize {
        self.like_rows
    }

    /// The line of each row.
    pub fn lines(&self) -> impl Iterator<Item = usize> {
        self.rows.iter().map(|(line, _)| *line)
    }

    /// Names of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// A fault of the line of column names.
    pub fn fault_in_header(&self, message: String, help: &str) -> CsvError {
        self.fault_at(Some(self.head), message, help)
    }

    /// A fault at a line, if it has a place.
    pub fn fault_at(&self, line: Option<usize>, message: String, help: &str) -> CsvError {
        fault(self.file, line, message, help)
    }

    /// Whether there is a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.header.iter().any(|column| column == name)
    }

    fn place(&self, name: &str) -> Result<usize, CsvError> {
        let wrong = |message: String, help: &str| Err(self.fault_in_header(message, help));
        let mut found = self.header.iter().enumerate().filter(|(_, column)| *column == name);
        match (found.next(), found.next()) {
            (Some((at, _)), None) => Ok(at),
            (Some(_), Some(_)) => wrong(format!("column `{name}` is there twice"), "rename one of them"),
            _ => {
                let help = match nearest(name, self.header.iter().map(String::as_str)) {
                    Some(column) => format!("did you mean `{column}`?"),
                    None if is_parted_otherwise(&self.header) => BY_COMMAS.to_owned(),
                    None => format!("the columns are: {}", cut(&self.header.join(", "), SHOWN[1])),
                };
                wrong(format!("there is no column `{name}`"), &help)
            }
        }
    }

    /// The finite numbers of a column, by row.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, CsvError> {
        self.numbers_at(self.place(name)?)
    }

    /// The same by the column's place, from 0.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn numbers_at(&self, column: usize) -> Result<Vec<f64>, CsvError> {
        let number = |(line, record): &Row| {
            let cell = record.get(column).unwrap_or_default();
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| self.no_number(*line, column, cell))
        };
        gather(self.rows.iter().map(number))
    }

    /// The same where a number may stand after one of some marks: which, and the number.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn numbers_after(&self, name: &str, marks: &[&str]) -> Result<Vec<(Option<usize>, f64)>, CsvError> {
        let column = self.place(name)?;
        let read = |(line, record): &Row| {
            let cell = record.get(column).unwrap_or_default();
            let mark = marks.iter().position(|mark| cell.starts_with(mark));
            let rest = mark.map_or(cell, |at| cell[marks[at].len()..].trim_start());
            let value = rest.parse::<f64>().ok().filter(|value| value.is_finite());
            value.map(|value| (mark, value)).ok_or_else(|| self.no_number(*line, column, cell))
        };
        gather(self.rows.iter().map(read))
    }

    /// The same where cells may be empty.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn numbers_or_none(&self, name: &str) -> Result<Vec<Option<f64>>, CsvError> {
        let column = self.place(name)?;
        let read = |(line, record): &Row| match record.get(column).unwrap_or_default() {
            "" => Ok(None),
            cell => match cell.parse::<f64>().ok().filter(|value| value.is_finite()) {
                Some(value) => Ok(Some(value)),
                None => Err(self.no_number(*line, column, cell)),
            },
        };
        gather(self.rows.iter().map(read))
    }

    fn no_number(&self, line: usize, column: usize, cell: &str) -> CsvError {
        let name = self.header.get(column).map_or("", String::as_str);
        let (name, cell) = (cut(name, SHOWN[0]), &*cut(cell, SHOWN[0]));
        let (cause, help) = number::why(&name, cell);
        fault(self.file, Some(line), format!("line {line}: `{name}` {cause}"), &help)
    }

    /// The cells of a column that names things: none is empty, none has letters that cannot be seen.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn names(&self, column: &str) -> Result<Vec<String>, CsvError> {
        let names = self.texts(column)?;
        let named = names.into_iter().zip(self.lines()).map(|(name, line)| {
            let wrong = |cause: &str, help: &str| {
                let message = format!("line {line}: `{}` {cause}", cut(column, SHOWN[0]));
                Err(fault(self.file, Some(line), message, help))
            };
            if name.is_empty() {
                return wrong("is empty", "write a name, or delete the line");
            }
            if let Some(letter) = name.chars().find(|letter| letter.is_control()) {
                let shown = cut(&name.escape_debug().to_string(), SHOWN[0]);
                let letter = format!("U+{:04X}", u32::from(letter));
                let cause = format!("is `{shown}`, with a control character ({letter})");
                return wrong(&cause, "delete the character; write the file as plain text, UTF-8");
            }
            Ok(name)
        });
        gather(named)
    }

    /// The cells of a column.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn texts(&self, name: &str) -> Result<Vec<String>, CsvError> {
        let column = self.place(name)?;
        Ok(self.rows.iter().map(|(_, record)| record[column].to_owned()).collect())
    }
}

fn broken(file: &Path, header: &[String], BrokenRow { line, cells, why }: BrokenRow) -> CsvError {
    let is_wider = cells.is_some_and(|[found, expected]| found > expected);
    if is_wider && is_parted_otherwise(header) {
        let message = "columns are not parted by commas, but numbers seem to have decimal commas".to_owned();
        return fault(file, Some(line), format!("line {line}: {message}"), BY_COMMAS);
    }
    let help = "each line needs as many cells as the header, and each quote its end";
    fault(file, Some(line), format!("line {line}: this is no CSV table: {why}"), help)
}

/// Whether a header looks as if columns were parted by semicolons or tabs.
fn is_parted_otherwise(header: &[String]) -> bool {
    header.iter().any(|name| name.contains([';', '\t']))
}

/// Whether a comment has as many cells as a header, two of them numbers at least.
fn is_like_a_row(comment: &[u8], cells: usize) -> bool {
    let found: Vec<&[u8]> = comment.split(|byte| *byte == b',').collect();
    let is_number =
        |cell: &&&[u8]| std::str::from_utf8(cell).is_ok_and(|cell| cell.trim().parse::<f64>().is_ok());
    found.len() == cells && found.iter().filter(is_number).count() >= 2
}
