//! What a process is fitted to: increments of wear, unit by unit, and how a gauge gives them. Never knows readings.

/// What is known of the wear of one unit between two exposures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Increment {
    /// Index of the unit in [`Observations::units`].
    pub unit: usize,
    /// Exposure at the earlier reading.
    pub from: f64,
    /// Exposure at the later reading, above `from`.
    pub to: f64,
    /// Wear between them, or a bound of it, as `known` has it.
    pub wear: f64,
    /// Logarithms of the covariates.
    pub ln_covariates: Vec<f64>,
    /// Row of the later reading; 0 for none.
    pub row: usize,
    /// How much is known of it.
    pub known: Known,
}

/// What is known of an increment of wear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Known {
    /// Wear grew by just so much from a reading to the next.
    #[default]
    Exact,
    /// It did so from a level that is no reading, as after regrinding: exact even where a gauge rounds.
    FromLevel,
    /// It did so from a reading of its own, taken at the exposure of the one before it, after the part was worked on.
    Anew,
    /// It did so, and at exposure `at` on the way it had grown by less than `below`: the gauge showed nothing yet.
    Through {
        /// Exposure on the way.
        at: f64,
        /// What it had grown by less than.
        below: f64,
    },
    /// It reached so much, by `to` at the latest.
    AtLeast,
    /// It was less at `to`.
    Below,
    /// No increment: the unit is among the data only because its wear at `to` was below `wear`, from a new unit at 0.
    Entered {
        /// Whether the unit's increments begin at the new unit, too; else at its entry.
        from_new: bool,
    },
}

impl Increment {
    /// Whether its wear is known, and not only bounded.
    pub fn is_exact(&self) -> bool {
        self.is_plain() || matches!(self.known, Known::Through { .. })
    }

    /// Whether all is known of it that a difference of two readings tells, and no more.
    pub fn is_plain(&self) -> bool {
        matches!(self.known, Known::Exact | Known::FromLevel | Known::Anew)
    }

    /// Whether it tells of wear, and not of how the unit came into the sample.
    pub fn is_growth(&self) -> bool {
        !matches!(self.known, Known::Entered { .. })
    }
}

/// What a process is fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct Observations {
    /// Names of the units, in the order in which they first appear. A part that takes the place of another is a unit of its own,
    /// named after the first: `a`, `a#2`, `a#3`.
    pub units: Vec<String>,
    /// Increments, unit by unit, in order of exposure.
    pub increments: Vec<Increment>,
}

/// How a gauge gives readings: true wear with a normal error, then rounded to the nearest multiple of a step, but for a shift that
/// all readings of a unit share. Readings at exposure 0 are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// The step, in the unit of wear.
    pub step: f64,
    /// Standard deviation of the error before rounding; 0 for none.
    pub error: f64,
}

impl Rounding {
    /// Without an error before.
    pub fn to(step: f64) -> Self {
        Self { step, error: 0.0 }
    }
}

/// How zero and negative increments are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gauge {
    /// Readings are exact: every increment must be positive.
    Exact,
    /// Readings are rounded.
    Resolution(Rounding),
    /// Readings carry random errors: any increment may be seen.
    Noisy,
}
