//! Tables of numbers in CSV files. In: a path. Out: cells by named columns, with their lines; or what is wrong, where, and
//! what to do. Never knows what the columns mean.

use std::io;
use std::path::{Path, PathBuf};

use csv::{ReaderBuilder, StringRecord, Trim};
use linkwear_codegen::diagnostic::{cut, nearest};
use linkwear_codegen::input::read_text;
use linkwear_codegen::limits;
use thiserror::Error;

use crate::checksum::sha256_of;

/// Letters of a cell or of a list of names that are shown.
const SHOWN: [usize; 2] = [40, 300];

/// A file that is no table of what is asked for.
#[derive(Debug, Error)]
pub enum CsvError {
    /// It cannot be read.
    #[error("cannot read `{}`: {error}", .file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Something is wrong in it.
    #[error("{message}")]
    Data {
        /// The file.
        file: PathBuf,
        /// Line, from 1, if the fault has one.
        line: Option<usize>,
        /// The cause.
        message: String,
        /// What to do.
        help: String,
    },
}

/// A CSV file in memory.
pub struct CsvTable<'a> {
    file: &'a Path,
    /// Line of the header.
    head: usize,
    header: Vec<String>,
    /// Line and cells.
    rows: Vec<(usize, StringRecord)>,
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
        let mut reader =
            ReaderBuilder::new().comment(Some(b'#')).trim(Trim::All).from_reader(text.as_bytes());
        let broken = |error: csv::Error| {
            let line = error.position().and_then(|position| usize::try_from(position.line()).ok());
            let help = "each line needs as many cells as the header, and each quote its end";
            fault(file, line, format!("this is no CSV table: {error}"), help)
        };
        let header: Vec<String> = reader.headers().map_err(broken)?.iter().map(str::to_owned).collect();
        if header.is_empty() {
            let help = "write a line of column names, then one reading a line";
            return Err(fault(file, None, "the file is empty".to_owned(), help));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(broken)?;
            let line = record.position().map_or(0, |position| usize::try_from(position.line()).unwrap_or(0));
            rows.push((line, record));
        }
        let first = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
        let head = text.lines().position(first).map_or(1, |at| at + 1);
        Ok(Self { file, head, header, rows, sha256: sha256_of(text.as_bytes()) })
    }

    /// SHA-256 of the text.
    pub fn sha256(&self) -> &str {
        &self.sha256
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
                let separator = |name: &&str| name.contains([';', '\t']);
                let joined = self.header.iter().map(String::as_str).find(separator);
                let help = match nearest(name, self.header.iter().map(String::as_str)) {
                    Some(column) => format!("did you mean `{column}`?"),
                    None if joined.is_some() => {
                        "columns are parted by commas: write the file with commas, and decimal points"
                            .to_owned()
                    }
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
        let number = |(line, record): &(usize, StringRecord)| {
            let cell = record.get(column).unwrap_or_default();
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| self.no_number(*line, column, cell))
        };
        self.rows.iter().map(number).collect()
    }

    /// The same where a number may stand after one of some marks: which, and the number.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn numbers_after(&self, name: &str, marks: &[&str]) -> Result<Vec<(Option<usize>, f64)>, CsvError> {
        let column = self.place(name)?;
        let read = |(line, record): &(usize, StringRecord)| {
            let cell = record.get(column).unwrap_or_default();
            let mark = marks.iter().position(|mark| cell.starts_with(mark));
            let rest = mark.map_or(cell, |at| cell[marks[at].len()..].trim_start());
            let value = rest.parse::<f64>().ok().filter(|value| value.is_finite());
            value.map(|value| (mark, value)).ok_or_else(|| self.no_number(*line, column, cell))
        };
        self.rows.iter().map(read).collect()
    }

    /// The same where cells may be empty.
    ///
    /// # Errors
    /// [`CsvError::Data`].
    pub fn numbers_or_none(&self, name: &str) -> Result<Vec<Option<f64>>, CsvError> {
        let column = self.place(name)?;
        let read = |(line, record): &(usize, StringRecord)| match record.get(column).unwrap_or_default() {
            "" => Ok(None),
            cell => match cell.parse::<f64>().ok().filter(|value| value.is_finite()) {
                Some(value) => Ok(Some(value)),
                None => Err(self.no_number(*line, column, cell)),
            },
        };
        self.rows.iter().map(read).collect()
    }

    fn no_number(&self, line: usize, column: usize, cell: &str) -> CsvError {
        let name = self.header.get(column).map_or("", String::as_str);
        let (name, cell) = (cut(name, SHOWN[0]), &*cut(cell, SHOWN[0]));
        let pointed = cell.replacen(',', ".", 1);
        if pointed != cell && pointed.parse::<f64>().is_ok() {
            let message = format!("line {line}: `{name}` is `{cell}`, a number with a decimal comma");
            let help = format!("write a decimal point in all numbers: `{pointed}`");
            return fault(self.file, Some(line), message, &help);
        }
        let unit = cell.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE ".contains(c));
        if !unit.is_empty() && unit.len() < cell.len() {
            let message = format!("line {line}: `{name}` is `{cell}`, a number with a unit");
            let help =
                format!("one unit per column: convert all rows, and put it into the header, `{name}_{unit}`");
            return fault(self.file, Some(line), message, &help);
        }
        let message = match cell {
            "" => format!("line {line}: `{name}` is empty"),
            _ => format!("line {line}: `{name}` is `{cell}`, not a finite number"),
        };
        fault(self.file, Some(line), message, "write a number, or delete the line")
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

fn fault(file: &Path, line: Option<usize>, message: String, help: &str) -> CsvError {
    CsvError::Data { file: file.to_path_buf(), line, message, help: help.to_owned() }
}
