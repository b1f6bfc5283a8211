//! Increments as the file has them, column by column. In: increments, or columns. Out: the other; or what is wrong with the columns. Never
//! knows where they stand in the file.

use serde::{Deserialize, Serialize};

use crate::data::{Increment, Known};

/// Increments as the file has them.
#[derive(Serialize, Deserialize)]
pub(super) struct Columns {
    from: Vec<f64>,
    to: Vec<f64>,
    wear: Vec<f64>,
    /// Which unit each is of; files of older programs do not have it.
    #[serde(default)]
    unit: Vec<usize>,
    /// Of each covariate its values; files of older programs do not have them.
    #[serde(default)]
    covariates: Vec<Vec<f64>>,
    /// How much is known of each, by its word; left out where all are differences of readings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    known: Vec<Word>,
    /// Exposure on the way at which wear was bounded; null elsewhere; left out where there is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    at: Vec<Option<f64>>,
    /// That bound.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    below: Vec<Option<f64>>,
}

#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Word {
    Exact,
    FromLevel,
    Anew,
    Through,
    AtLeast,
    Below,
    Entered,
    EnteredFromNew,
}

impl Columns {
    /// Of increments with so many covariates each, whose values are written if they are known.
    pub(super) fn new(increments: &[Increment], covariates: usize, has_values: bool) -> Self {
        let column = |of: &dyn Fn(&Increment) -> f64| increments.iter().map(of).collect::<Vec<_>>();
        let covariate = |at: usize| column(&|one| libm::exp(one.ln_covariates[at]));
        let is_exact = increments.iter().all(|one| one.known == Known::Exact);
        let known: Vec<Word> = increments.iter().map(|one| word(one.known)).collect();
        let way = |of: fn(f64, f64) -> f64| -> Vec<Option<f64>> {
            let one = |one: &Increment| match one.known {
                Known::Through { at, below } => Some(of(at, below)),
                _ => None,
            };
            if known.contains(&Word::Through) { increments.iter().map(one).collect() } else { Vec::new() }
        };
        Self {
            from: column(&|one| one.from),
            to: column(&|one| one.to),
            wear: column(&|one| one.wear),
            unit: increments.iter().map(|one| one.unit).collect(),
            covariates: (0..covariates).filter(|_| has_values).map(covariate).collect(),
            at: way(|at, _| at),
            below: way(|_, below| below),
            known: if is_exact { Vec::new() } else { known },
        }
    }

    /// The increments.
    pub(super) fn increments(&self) -> Result<Vec<Increment>, String> {
        let wrong = |what: &str| Err(what.to_owned());
        let given = [self.unit.len(), self.known.len(), self.at.len(), self.below.len()];
        let given = given.into_iter().filter(|length| *length > 0);
        let lengths =
            [self.to.len(), self.wear.len()].into_iter().chain(self.covariates.iter().map(Vec::len));
        if !lengths.chain(given).all(|length| length == self.from.len()) {
            return wrong("have columns of different lengths");
        }
        if self.covariates.iter().flatten().any(|value| !(value.is_finite() && *value > 0.0)) {
            return wrong("have a covariate that is no positive, finite number");
        }
        let rows: Vec<Increment> = (0..self.from.len()).map(|at| self.row(at)).collect();
        let rises = |one: &Increment| {
            one.from >= 0.0 && one.from < one.to && one.to.is_finite() && one.wear.is_finite()
        };
        if let Some(at) = rows.iter().position(|row| !rises(row)) {
            return Err(format!("have no rising, finite exposure or no finite wear in row {}", at + 1));
        }
        let passes = |one: &Increment| match one.known {
            Known::Through { at, below } => one.from < at && at < one.to && below.is_finite(),
            _ => true,
        };
        match rows.iter().position(|row| !passes(row)) {
            Some(at) => Err(format!("have no exposure with a bound on the way in row {}", at + 1)),
            None => Ok(rows),
        }
    }

    fn row(&self, at: usize) -> Increment {
        let on_way = |column: &[Option<f64>]| column.get(at).copied().flatten().unwrap_or(f64::NAN);
        let known = match self.known.get(at).copied().unwrap_or(Word::Exact) {
            Word::Exact => Known::Exact,
            Word::FromLevel => Known::FromLevel,
            Word::Anew => Known::Anew,
            Word::Through => Known::Through { at: on_way(&self.at), below: on_way(&self.below) },
            Word::AtLeast => Known::AtLeast,
            Word::Below => Known::Below,
            Word::Entered => Known::Entered { from_new: false },
            Word::EnteredFromNew => Known::Entered { from_new: true },
        };
        Increment {
            unit: self.unit.get(at).copied().unwrap_or(0),
            from: self.from[at],
            to: self.to[at],
            wear: self.wear[at],
            ln_covariates: self.covariates.iter().map(|column| libm::log(column[at])).collect(),
            row: 0,
            known,
        }
    }
}

fn word(known: Known) -> Word {
    match known {
        Known::Exact => Word::Exact,
        Known::FromLevel => Word::FromLevel,
        Known::Anew => Word::Anew,
        Known::Through { .. } => Word::Through,
        Known::AtLeast => Word::AtLeast,
        Known::Below => Word::Below,
        Known::Entered { from_new: false } => Word::Entered,
        Known::Entered { from_new: true } => Word::EnteredFromNew,
    }
}
