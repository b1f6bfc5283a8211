//! Columns of numbers: each quantity has its names and its unit once, for CSV, JSON and text alike.

/// The names of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct Column {
    /// In words, as text shows it: `mean force`.
    pub name: &'static str,
    /// Short, as CSV shows it: `Fn_mean`.
    pub symbol: &'static str,
    /// SI unit; `1` if it has none.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Shown in tables of turns and cycles too, where room is short.
    pub brief: bool,
}

/// A quantity of `T` with its number.
pub type Quantity<T> = (Column, fn(&T) -> f64);

impl Column {
    /// A quantity that is told in every table.
    pub const fn new(
        (name, symbol, unit): (&'static str, &'static str, &'static str),
        meaning: &'static str,
    ) -> Self {
        Self { name, symbol, unit, meaning, brief: true }
    }

    /// The same, left out where room is short.
    pub const fn detail(self) -> Self {
        Self { brief: false, ..self }
    }

    /// Key in JSON: name and unit, `mean_force_N`.
    pub fn key(&self) -> String {
        let name = self.name.replace(' ', "_");
        if self.unit == "1" { name } else { format!("{name}_{}", self.unit) }
    }

    /// Head of a CSV column: `Fn_mean [N]`.
    pub fn head(&self) -> String {
        format!("{} [{}]", self.symbol, self.unit)
    }

    /// Head of a column of text: `mean force [N]`.
    pub fn title(&self) -> String {
        if self.unit == "1" { self.name.to_owned() } else { format!("{} [{}]", self.name, self.unit) }
    }
}
