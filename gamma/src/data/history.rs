//! Readings of a unit in the order of exposure, cut where the part was replaced or worked on. In: readings. Out: increments of
//! each part, and what it wears now. Never knows whether increments are possible.

use std::collections::HashMap;

use super::error::DataError;
use super::increment::{Gauge, Increment, Known, Observations};
use super::reading::{Reading, Reset, Seen};

/// Increments of all units, and what each wears now.
pub fn histories(
    readings: &[Reading],
    from_zero: bool,
    gauge: Gauge,
) -> Result<(Observations, Vec<f64>), DataError> {
    // Each unit's place among them, in order of first appearance.
    let mut known: HashMap<&str, usize> = HashMap::new();
    let mut of_units: Vec<Vec<&Reading>> = Vec::new();
    for reading in readings {
        let at = *known.entry(&reading.unit).or_insert(of_units.len());
        if at == of_units.len() {
            of_units.push(Vec::new());
        }
        of_units[at].push(reading);
    }
    let (mut units, mut increments, mut wear) = (Vec::new(), Vec::new(), Vec::new());
    for own in &of_units {
        let name = &own[0].unit;
        let mut walk = Walk::new(own, from_zero, gauge)?;
        walk.enter(own)?;
        for reading in own {
            walk.read(reading)?;
        }
        walk.end();
        if !walk.parts.iter().any(Part::grows) {
            return Err(DataError::OneReading { unit: name.clone(), row: own[0].row });
        }
        for (at, part) in walk.parts.into_iter().enumerate().filter(|(_, part)| part.grows()) {
            let name = if at == 0 { name.clone() } else { format!("{name}#{}", at + 1) };
            if at > 0 && known.contains_key(name.as_str()) {
                return Err(DataError::PartName { name, row: own[0].row });
            }
            let unit = units.len();
            increments.extend(part.increments.into_iter().map(|one| Increment { unit, ..one }));
            wear.push(part.wear);
            units.push(name);
        }
    }
    Ok((Observations { units, increments }, wear))
}

/// One part.
#[derive(Default)]
struct Part {
    increments: Vec<Increment>,
    wear: f64,
}

impl Part {
    fn grows(&self) -> bool {
        self.increments.iter().any(Increment::is_growth)
    }
}

/// Known wear of the part at hand.
#[derive(Clone, Copy)]
struct Level {
    /// Age of the part.
    age: f64,
    wear: f64,
    /// What an increment from here on is, if its wear is read.
    next: Known,
}

/// Along the readings of one unit.
struct Walk<'a> {
    gauge: Gauge,
    parts: Vec<Part>,
    /// Exposure at which the part at hand was new.
    origin: f64,
    level: Option<Level>,
    /// The reading before.
    last: Option<&'a Reading>,
    /// The last reading since `level` that was below the gauge's range.
    below: Option<&'a Reading>,
    /// Whether the part has gone beyond the gauge's range.
    is_beyond: bool,
    from_zero: bool,
}

impl<'a> Walk<'a> {
    fn new(own: &[&'a Reading], from_zero: bool, gauge: Gauge) -> Result<Self, DataError> {
        let zero = Level { age: 0.0, wear: 0.0, next: Known::Exact };
        let from_zero = from_zero && own[0].exposure > 0.0;
        if let Some(other) = own.iter().find(|one| one.entered_below != own[0].entered_below) {
            let why = "another limit of entry than in the first row of its unit";
            return Err(DataError::Contradiction { unit: other.unit.clone(), row: other.row, why });
        }
        Ok(Self {
            gauge,
            parts: vec![Part::default()],
            origin: 0.0,
            level: from_zero.then_some(zero),
            last: None,
            below: None,
            is_beyond: false,
            from_zero,
        })
    }

    /// How the unit came among the data. One that was new at its first reading was below any limit for certain.
    fn enter(&mut self, own: &[&Reading]) -> Result<(), DataError> {
        let first = own[0];
        let Some(limit) = first.entered_below.filter(|_| first.exposure > 0.0) else { return Ok(()) };
        self.refuse_with_gauge(first, "a limit of entry")?;
        let is_below = match first.seen {
            Seen::Exact => first.wear < limit,
            Seen::Below => true,
            Seen::AtLeast => false,
        };
        if !is_below {
            let why = "wear at its first reading is not below the limit of entry";
            return Err(DataError::Contradiction { unit: first.unit.clone(), row: first.row, why });
        }
        let known = Known::Entered { from_new: self.from_zero };
        let to = first.exposure;
        self.part().increments.push(Increment { wear: limit, known, ..increment(0.0, to, first) });
        Ok(())
    }

    fn part(&mut self) -> &mut Part {
        if self.parts.is_empty() {
            self.parts.push(Part::default());
        }
        let last = self.parts.len() - 1;
        &mut self.parts[last]
    }

    fn read(&mut self, reading: &'a Reading) -> Result<(), DataError> {
        self.check_order(reading)?;
        let age = reading.exposure - self.origin;
        match (reading.seen, self.level) {
            _ if self.is_beyond && reading.seen == Seen::AtLeast => {}
            _ if self.is_beyond => {
                return contradiction(reading, "a reading after wear had passed the gauge's range");
            }
            (Seen::Exact, None) => {}
            (Seen::Exact, Some(level)) => self.grow(reading, level, age)?,
            (_, None) => {
                return contradiction(reading, "a bound, and wear before it is not known");
            }
            (Seen::AtLeast, Some(level)) => {
                self.refuse_with_gauge(reading, "a bound")?;
                if self.below.is_some() {
                    return contradiction(
                        reading,
                        "a lower bound right after an upper one, and no reading between them",
                    );
                }
                if reading.wear <= level.wear {
                    return contradiction(reading, "a lower bound that wear had passed before");
                }
                let wear = reading.wear - level.wear;
                let one = Increment { wear, known: Known::AtLeast, ..increment(level.age, age, reading) };
                self.part().increments.push(one);
            }
            (Seen::Below, Some(level)) => {
                self.refuse_with_gauge(reading, "a bound")?;
                if self.gauge == Gauge::Exact && reading.wear <= level.wear {
                    return contradiction(reading, "an upper bound that wear had passed before");
                }
                if self.below.is_some() && self.gauge == Gauge::Noisy {
                    return contradiction(
                        reading,
                        "a second bound in a row, of wear that may fall between them",
                    );
                }
                self.below = Some(reading);
            }
        }
        let is_read = reading.seen == Seen::Exact;
        self.is_beyond |= reading.seen == Seen::AtLeast;
        self.part().wear = if is_read { reading.wear } else { f64::NAN };
        if is_read {
            let is_anew = self.last.is_some_and(|last| last.exposure == reading.exposure);
            let next = if is_anew { Known::Anew } else { Known::Exact };
            self.level = Some(Level { age, wear: reading.wear, next });
        }
        self.last = Some(reading);
        if let Some(reset) = reading.reset {
            self.reset(reading, reset);
        }
        Ok(())
    }

    /// Exposure rises, but for a reading right after the part was set to an unknown level.
    fn check_order(&self, reading: &Reading) -> Result<(), DataError> {
        let Some(last) =
            self.last.map(|last| (last.exposure, last.row)).or(self.from_zero.then_some((0.0, 0)))
        else {
            return Ok(());
        };
        let (before, first) = last;
        let (unit, row, exposure) = (reading.unit.clone(), reading.row, reading.exposure);
        if exposure < before {
            return Err(DataError::Unsorted { unit, row, before, after: exposure });
        }
        if exposure == before && !(self.last.is_some_and(|last| last.reset.is_some()) && self.level.is_none())
        {
            return Err(DataError::Duplicate { unit, first, row, exposure });
        }
        Ok(())
    }

    /// From a known level to a reading.
    fn grow(&mut self, reading: &Reading, level: Level, age: f64) -> Result<(), DataError> {
        let known = match self.below.take() {
            Some(below) if below.covariates != reading.covariates => {
                return contradiction(reading, "other covariates than at the bound before it");
            }
            Some(below) if self.gauge == Gauge::Exact && reading.wear <= level.wear => {
                return contradiction(below, "a bound between readings that do not grow");
            }
            Some(below) => {
                Known::Through { at: below.exposure - self.origin, below: below.wear - level.wear }
            }
            None => level.next,
        };
        let wear = reading.wear - level.wear;
        self.part().increments.push(Increment { wear, known, ..increment(level.age, age, reading) });
        Ok(())
    }

    fn reset(&mut self, reading: &Reading, reset: Reset) {
        self.end();
        let age = match reset {
            Reset::Replaced(_) => {
                // It was taken out: nothing that it wears goes on.
                self.part().wear = f64::NAN;
                self.origin = reading.exposure;
                self.parts.push(Part::default());
                0.0
            }
            Reset::Reground(_) => reading.exposure - self.origin,
        };
        let (Reset::Replaced(level) | Reset::Reground(level)) = reset;
        self.level = level.map(|wear| Level { age, wear, next: Known::FromLevel });
        self.is_beyond = false;
        self.part().wear = level.unwrap_or(f64::NAN);
    }

    /// The last bound stands, if no reading follows it.
    fn end(&mut self) {
        let (Some(below), Some(level)) = (self.below.take(), self.level) else { return };
        let (wear, to) = (below.wear - level.wear, below.exposure - self.origin);
        let one = Increment { wear, known: Known::Below, ..increment(level.age, to, below) };
        self.part().increments.push(one);
    }

    fn refuse_with_gauge(&self, reading: &Reading, what: &'static str) -> Result<(), DataError> {
        match self.gauge {
            Gauge::Resolution(_) => Err(DataError::WithResolution { what, row: reading.row }),
            _ => Ok(()),
        }
    }
}

fn contradiction(reading: &Reading, why: &'static str) -> Result<(), DataError> {
    Err(DataError::Contradiction { unit: reading.unit.clone(), row: reading.row, why })
}

fn increment(from: f64, to: f64, reading: &Reading) -> Increment {
    let ln_covariates = reading.covariates.iter().map(|value| libm::log(*value)).collect();
    Increment { from, to, ln_covariates, row: reading.row, ..Increment::default() }
}
