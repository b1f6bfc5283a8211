//! Two results side by side. In: their columns. Out: what differs, the largest first. Never knows files.

use super::read::{Cell, Column, Known};

/// A column that differs.
#[derive(Debug)]
pub struct Difference {
    pub key: String,
    /// Largest absolute difference; none between words.
    pub largest: Option<f64>,
    /// The same over the range of the column in both, or where it is constant its size; none between words.
    pub relative: Option<f64>,
    /// The two values there.
    pub values: [String; 2],
    /// Where: the key with its indices, or the row from 1; of a table with the first column's title and value there.
    pub place: Option<(String, Option<(String, String)>)>,
}

/// All that is different.
#[derive(Debug)]
pub struct Compared {
    /// What they are of, where it differs.
    pub made: Vec<(String, [String; 2])>,
    pub differences: Vec<Difference>,
    /// Columns that only the one or only the other has.
    pub only: [Vec<String>; 2],
    /// Columns that were compared.
    pub keys: usize,
    /// Rows of tables.
    pub rows: [usize; 2],
}

impl Compared {
    /// Whether all numbers agree within a part of their ranges, and all else is the same.
    pub fn agree(&self, most: f64) -> bool {
        let within = |found: &Difference| found.relative.is_some_and(|relative| relative <= most);
        self.only.iter().all(Vec::is_empty)
            && self.rows[0] == self.rows[1]
            && self.differences.iter().all(within)
    }
}

/// Compares results of one kind.
pub fn compare(a: &Known, b: &Known) -> Compared {
    let only = |own: &Known, other: &Known| -> Vec<String> {
        let is_alone = |column: &&Column| !other.columns.iter().any(|one| one.key == column.key);
        own.columns.iter().filter(is_alone).map(|column| column.key.clone()).collect()
    };
    let rows =
        |of: &Known| if of.is_table { of.columns.first().map_or(0, |first| first.cells.len()) } else { 0 };
    let clock = a.columns.first().filter(|_| a.is_table);
    let pairs: Vec<(&Column, &Column)> = a
        .columns
        .iter()
        .filter_map(|one| Some((one, b.columns.iter().find(|other| other.key == one.key)?)))
        .collect();
    let mut differences: Vec<Difference> =
        pairs.iter().filter_map(|(one, other)| difference(one, other, clock)).collect();
    // Words first: they have no size.
    let size = |found: &Difference| found.relative.unwrap_or(f64::INFINITY);
    differences.sort_by(|one, other| size(other).total_cmp(&size(one)));
    Compared {
        made: made(a, b),
        differences,
        only: [only(a, b), only(b, a)],
        keys: pairs.len(),
        rows: [rows(a), rows(b)],
    }
}

fn made(a: &Known, b: &Known) -> Vec<(String, [String; 2])> {
    let of = |result: &Known, key: &str| {
        result
            .made
            .iter()
            .find(|(known, _)| known == key)
            .map_or_else(String::new, |(_, value)| value.clone())
    };
    let mut keys: Vec<&str> = a.made.iter().map(|(key, _)| key.as_str()).collect();
    let more = b
        .made
        .iter()
        .map(|(key, _)| key.as_str())
        .filter(|key| !a.made.iter().any(|(known, _)| known == key));
    keys.extend(more);
    let pairs = keys.into_iter().map(|key| (key.to_owned(), [of(a, key), of(b, key)]));
    pairs.filter(|(_, [a, b])| a != b).collect()
}

/// The largest difference of a column, if there is one; the clock tells where in a table.
fn difference(a: &Column, b: &Column, clock: Option<&Column>) -> Option<Difference> {
    let (mut largest, mut at) = (-1.0, None);
    for (row, cells) in a.cells.iter().zip(&b.cells).enumerate() {
        let gap = match cells {
            // NaN stands for the same nothing in both.
            (Cell::Number(a), Cell::Number(b)) if a == b || a.is_nan() && b.is_nan() => 0.0,
            (Cell::Number(a), Cell::Number(b)) => (a - b).abs(),
            (a, b) => {
                if a == b {
                    0.0
                } else {
                    f64::NAN
                }
            }
        };
        // What is no number is larger than any.
        let gap = if gap.is_nan() { f64::INFINITY } else { gap };
        if gap > 0.0 && gap > largest {
            (largest, at) = (gap, Some(row));
        }
    }
    // Lists of different lengths differ where the shorter one ends.
    let ends = (clock.is_none() && a.cells.len() != b.cells.len()).then(|| a.cells.len().min(b.cells.len()));
    if let Some(end) = ends {
        (largest, at) = (f64::INFINITY, Some(end));
    }
    let at = at?;
    let range = range(a).max(range(b));
    let range = if range > 0.0 { range } else { size(a).max(size(b)) };
    let finite = Some(largest).filter(|largest| largest.is_finite());
    let place = match clock {
        Some(clock) => {
            let value = clock.cells.get(at).map_or_else(String::new, Cell::shown);
            Some((format!("row {}", at + 1), Some((clock.key.clone(), value))))
        }
        None => {
            let place = a.places.get(at).or_else(|| b.places.get(at));
            place.filter(|place| **place != a.key).map(|place| (place.clone(), None))
        }
    };
    let value = |column: &Column| column.cells.get(at).map_or_else(|| "nothing".to_owned(), Cell::shown);
    Some(Difference {
        key: a.key.clone(),
        largest: finite,
        relative: finite.map(|largest| largest / range),
        values: [value(a), value(b)],
        place,
    })
}

fn numbers(column: &Column) -> impl Iterator<Item = f64> {
    column.cells.iter().filter_map(|cell| match cell {
        Cell::Number(value) if value.is_finite() => Some(*value),
        _ => None,
    })
}

/// From the least to the largest number of a column.
fn range(column: &Column) -> f64 {
    let ends = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
    let (low, high) = numbers(column).fold((f64::INFINITY, f64::NEG_INFINITY), ends);
    if high > low { high - low } else { 0.0 }
}

/// The largest number of a column by its size.
fn size(column: &Column) -> f64 {
    numbers(column).fold(0.0, |most, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(numbers: &[f64]) -> Column {
        Column {
            key: "x".into(),
            places: Vec::new(),
            cells: numbers.iter().copied().map(Cell::Number).collect(),
        }
    }

    #[test]
    fn the_largest_difference_is_found_with_its_place_and_its_part_of_the_range() {
        let (a, b) = (column(&[0.0, 1.0, 4.0]), column(&[0.0, 1.5, 4.1]));
        let found = difference(&a, &b, Some(&column(&[0.0, 0.1, 0.2]))).expect("a difference");
        assert_eq!((found.largest, found.relative), (Some(0.5), Some(0.5 / 4.1)), "the longer range");
        assert_eq!(found.place, Some(("row 2".into(), Some(("x".into(), "0.1".into())))));
        assert!(difference(&a, &a, None).is_none());
    }

    #[test]
    fn a_constant_is_measured_by_its_size_and_what_is_no_number_by_nothing() {
        let found = difference(&column(&[2.0]), &column(&[2.5]), None).expect("a difference");
        assert_eq!((found.largest, found.relative, found.place), (Some(0.5), Some(0.5 / 2.5), None));
        let found = difference(&column(&[f64::NAN, 1.0]), &column(&[f64::NAN, f64::NAN]), None).expect("one");
        assert_eq!((found.largest, found.relative), (None, None));
        let shorter = difference(&column(&[1.0]), &column(&[1.0, 2.0]), None).expect("another length");
        assert_eq!(shorter.values, ["nothing".to_owned(), "2".to_owned()]);
    }
}
