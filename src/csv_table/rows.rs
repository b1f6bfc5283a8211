//! Rows of a CSV text, each with the line in which it begins. In: text. Out: cells; or the line of a row that is none. Never knows
//! what the cells mean.
//!
//! The reader of CSV tells where it stood before it passed over comments and empty lines, so lines are counted here.

use csv::{ErrorKind, ReaderBuilder, StringRecord};

/// Cells of one row, and its line, from 1.
pub type Row = (usize, StringRecord);

/// A row that is none.
pub struct BrokenRow {
    /// The line in which it begins.
    pub line: usize,
    /// How many cells it has and how many the header has, if these differ.
    pub cells: Option<[u64; 2]>,
    /// The cause.
    pub why: String,
}

/// Rows from the header on.
pub struct Rows<'t> {
    reader: csv::Reader<&'t [u8]>,
    begins: Begins<'t>,
    is_trimmed: bool,
}

impl<'t> Rows<'t> {
    /// Of a text; spaces around cells belong to them, or are cut off.
    pub fn new(text: &'t str, is_trimmed: bool) -> Self {
        let reader = ReaderBuilder::new().comment(Some(b'#')).has_headers(false).from_reader(text.as_bytes());
        Self {
            reader,
            begins: Begins { text: text.as_bytes(), at: 0, line: 1, comments: Vec::new() },
            is_trimmed,
        }
    }

    /// Comments that were passed over so far.
    pub fn comments(&self) -> &[&'t [u8]] {
        &self.begins.comments
    }
}

impl Iterator for Rows<'_> {
    type Item = Result<Row, BrokenRow>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let row = self.read();
            // Where spaces around cells say nothing, a line of them is an empty one.
            let is_blank = |broken: &BrokenRow| broken.cells.is_some_and(|[found, _]| found == 1);
            match row {
                Some(Err(broken)) if self.is_trimmed && is_blank(&broken) && self.begins.is_blank() => {}
                row => return row,
            }
        }
    }
}

impl Rows<'_> {
    fn read(&mut self) -> Option<Result<Row, BrokenRow>> {
        // A text has less bytes than memory.
        self.begins.count_to(self.reader.position().byte() as usize);
        let mut record = StringRecord::new();
        let found = self.reader.read_record(&mut record);
        self.begins.pass_over();
        let line = self.begins.line;
        match found {
            Ok(false) => None,
            Ok(true) => {
                if self.is_trimmed {
                    record.trim();
                }
                Some(Ok((line, record)))
            }
            Err(error) => {
                let (cells, why) = match error.kind() {
                    ErrorKind::UnequalLengths { expected_len, len, .. } => (
                        Some([*len, *expected_len]),
                        format!("{len} cells, and the header has {expected_len}"),
                    ),
                    _ => (None, error.to_string()),
                };
                Some(Err(BrokenRow { line, cells, why }))
            }
        }
    }
}

/// Where rows begin.
struct Begins<'t> {
    text: &'t [u8],
    at: usize,
    /// The line of `at`.
    line: usize,
    comments: Vec<&'t [u8]>,
}

impl Begins<'_> {
    /// Whether the line at hand has nothing but blanks.
    fn is_blank(&self) -> bool {
        let line = self.text[self.at..].iter().take_while(|byte| !matches!(byte, b'\n' | b'\r'));
        line.into_iter().all(u8::is_ascii_whitespace)
    }

    /// Goes on to a place, and counts the ends of lines before it: \n, \r\n, or \r alone.
    fn count_to(&mut self, place: usize) {
        let to = place.clamp(self.at, self.text.len());
        let is_end = |at: &usize| match self.text[*at] {
            b'\n' => true,
            b'\r' => self.text.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        self.line += (self.at..to).filter(is_end).count();
        self.at = to;
    }

    /// Goes on to where the next row begins: behind empty lines and comments.
    fn pass_over(&mut self) {
        while let Some(byte) = self.text.get(self.at) {
            let rest = &self.text[self.at..];
            let length = match byte {
                b'\n' | b'\r' => 1,
                b'#' => rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len()),
                _ => return,
            };
            if *byte == b'#' {
                self.comments.push(&rest[..length]);
            }
            self.count_to(self.at + length);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_blanks_are_empty_where_spaces_say_nothing() {
        let text = "a,b\n1,2\n  \n3,4\n \t ";
        let lines = |is_trimmed| -> Vec<Result<usize, usize>> {
            let rows = Rows::new(text, is_trimmed);
            rows.map(|row| row.map(|(line, _)| line).map_err(|broken| broken.line)).collect()
        };
        assert_eq!(lines(true), [Ok(1), Ok(2), Ok(4)]);
        assert_eq!(lines(false)[2], Err(3));
    }
}
