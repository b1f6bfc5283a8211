//! Two results side by side. In: their columns. Out: what differs, the largest first. Never knows files.

use std::collections::{HashMap, VecDeque};

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
    let keys = |of: &Known| -> Vec<String> { of.columns.iter().map(|column| column.key.clone()).collect() };
    let [keys_of_a, keys_of_b] = [keys(a), keys(b)];
    let together = side_by_side(&keys_of_a, &keys_of_b);
    let rows =
        |of: &Known| if of.is_table { of.columns.first().map_or(0, |first| first.cells.len()) } else { 0 };
    let clock = a.columns.first().filter(|_| a.is_table);
    let pairs: Vec<(&Column, &Column)> = together
        .iter()
        .filter_map(|(one, other)| Some((a.columns.get((*one)?)?, b.columns.get((*other)?)?)))
        .collect();
    let only = |keys: &[String], alone: &dyn Fn(&Pair) -> Option<usize>| -> Vec<String> {
        together.iter().filter_map(|pair| Some(keys.get(alone(pair)?)?.clone())).collect()
    };
    let only = [
        only(&keys_of_a, &|(one, other)| one.filter(|_| other.is_none())),
        only(&keys_of_b, &|(one, other)| other.filter(|_| one.is_none())),
    ];
    let mut differences: Vec<Difference> =
        pairs.iter().filter_map(|(one, other)| difference(one, other, clock)).collect();
    // Words first: they have no size.
    let size = |found: &Difference| found.relative.unwrap_or(f64::INFINITY);
    differences.sort_by(|one, other| size(other).total_cmp(&size(one)));
    Compared { made: made(a, b), differences, only, keys: pairs.len(), rows: [rows(a), rows(b)] }
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

/// Where two lists have the same: a place in the one and in the other.
type Pair = (Option<usize>, Option<usize>);

/// Names of one list beside those of the other, the first of a name beside the first; what only the other has comes last.
fn side_by_side(a: &[String], b: &[String]) -> Vec<Pair> {
    let mut of_b: HashMap<&str, VecDeque<usize>> = HashMap::new();
    for (at, name) in b.iter().enumerate() {
        of_b.entry(name).or_default().push_back(at);
    }
    let mut pairs: Vec<Pair> = Vec::new();
    for (at, name) in a.iter().enumerate() {
        pairs.push((Some(at), of_b.get_mut(name.as_str()).and_then(VecDeque::pop_front)));
    }
    let mut left: Vec<usize> = of_b.into_values().flatten().collect();
    left.sort_unstable();
    pairs.extend(left.into_iter().map(|at| (None, Some(at))));
    pairs
}

/// Cells of two columns that belong together: rows of a table as far as both go, values of lists by their places, since
/// optional keys leave some of them out.
fn cells(a: &Column, b: &Column, is_table: bool) -> Vec<Pair> {
    if !a.places.is_empty() {
        return side_by_side(&a.places, &b.places);
    }
    let [one, other] = [a.cells.len(), b.cells.len()];
    let end = if is_table { one.min(other) } else { one.max(other) };
    (0..end).map(|at| (Some(at).filter(|at| *at < one), Some(at).filter(|at| *at < other))).collect()
}

/// How far apart two cells are; infinite where one of them is no number, or there is none.
fn gap(cells: (Option<&Cell>, Option<&Cell>)) -> f64 {
    let gap = match cells {
        (Some(a), Some(b)) if a == b => 0.0,
        // NaN stands for the same nothing in both.
        (Some(Cell::Number(a)), Some(Cell::Number(b))) if a.is_nan() && b.is_nan() => 0.0,
        (Some(Cell::Number(a)), Some(Cell::Number(b))) => (a - b).abs(),
        (Some(Cell::Quantity(a, of_a)), Some(Cell::Quantity(b, of_b))) if of_a == of_b => (a - b).abs(),
        _ => f64::INFINITY,
    };
    // What is no number is larger than any.
    if gap.is_nan() { f64::INFINITY } else { gap }
}

/// The largest difference of a column, if there is one; the clock tells where in a table.
fn difference(a: &Column, b: &Column, clock: Option<&Column>) -> Option<Difference> {
    let (mut largest, mut at) = (0.0, None);
    for (one, other) in cells(a, b, clock.is_some()) {
        let gap = gap((one.and_then(|at| a.cells.get(at)), other.and_then(|at| b.cells.get(at))));
        if gap > largest {
            (largest, at) = (gap, Some((one, other)));
        }
    }
    let (one, other) = at?;
    let range = range(a).max(range(b));
    let range = if range > 0.0 { range } else { size(a).max(size(b)) };
    let finite = Some(largest).filter(|largest| largest.is_finite());
    let place = match clock {
        Some(clock) => {
            let row = one.or(other)?;
            let value = clock.cells.get(row).map_or_else(String::new, Cell::shown);
            Some((format!("row {}", row + 1), Some((clock.key.clone(), value))))
        }
        None => {
            let place = |of: &Column, at: Option<usize>| at.and_then(|at| of.places.get(at).cloned());
            place(a, one)
                .or_else(|| place(b, other))
                .filter(|place| *place != a.key)
                .map(|place| (place, None))
        }
    };
    let value = |column: &Column, at: Option<usize>| {
        at.and_then(|at| column.cells.get(at)).map_or_else(|| "nothing".to_owned(), Cell::shown)
    };
    Some(Difference {
        key: a.key.clone(),
        largest: finite,
        relative: finite.map(|largest| largest / range),
        values: [value(a, one), value(b, other)],
        place,
    })
}

fn numbers(column: &Column) -> impl Iterator<Item = f64> {
    column.cells.iter().filter_map(|cell| match cell {
        Cell::Number(value) | Cell::Quantity(value, _) if value.is_finite() => Some(*value),
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

    #[test]
    fn values_of_lists_are_side_by_side_by_their_places_and_columns_of_one_name_by_their_order() {
        let speeds = |place: &str| Column { places: vec![place.into()], ..column(&[5.0]) };
        let found = difference(&speeds("s[0].x"), &speeds("s[1].x"), None).expect("another place");
        assert_eq!(found.values, ["5".to_owned(), "nothing".to_owned()]);
        assert_eq!((found.largest, found.place), (None, Some(("s[0].x".into(), None))));
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let found = side_by_side(&names(&["a", "b", "b"]), &names(&["b", "a", "c", "b", "b"]));
        let expected =
            [(Some(0), Some(1)), (Some(1), Some(0)), (Some(2), Some(3)), (None, Some(2)), (None, Some(4))];
        assert_eq!(found, expected);
    }
}
