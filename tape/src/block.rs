//! Named parts of flat inputs and outputs. Out: [`Block`]. Never knows what computes them.

/// A named vector or matrix in a flat slice, row major.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct Block {
    /// Name, e.g. `phi_q`.
    pub name: String,
    /// What it is: shape, unit, frame.
    pub doc: String,
    /// Equation of the paper, e.g. "[CS (3)]", or empty.
    pub citation: String,
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub columns: usize,
}

impl Block {
    /// A column vector.
    pub fn vector(name: &str, rows: usize) -> Self {
        Self { name: name.to_owned(), rows, columns: 1, ..Self::default() }
    }

    /// With a sentence about what it is.
    pub fn doc(self, doc: &str) -> Self {
        Self { doc: doc.to_owned(), ..self }
    }

    /// Number of entries.
    pub const fn len(&self) -> usize {
        self.rows.saturating_mul(self.columns)
    }

    /// Whether there are no entries.
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `n` for a column vector, `m x n` for a matrix.
    pub fn shape(&self) -> String {
        if self.columns == 1 { self.rows.to_string() } else { format!("{} x {}", self.rows, self.columns) }
    }

    /// The citation after a space, or nothing.
    pub fn cited(&self) -> String {
        if self.citation.is_empty() { String::new() } else { format!(" {}", self.citation) }
    }
}
