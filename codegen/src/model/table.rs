//! Tables of numbers as functions: which polynomial holds where, and its value over numbers or expressions.
//! In: rising arguments with their values. Out: [`DataTable`]. Never knows files.
//!
//! The piece is found by halving, each time by a choice between numbers: as many choices as rows, a few deep, and no memory that
//! back ends would have to share.

use super::piecewise::{SMOOTH, Value};
use crate::spec::{Interpolation, Outside};

/// A function given by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct DataTable {
    /// Name in the file.
    pub name: String,
    /// Arguments in SI, rising.
    pub knots: Vec<f64>,
    /// Cubic from each knot to the next, by powers of the way from it, lowest first.
    pub pieces: Vec<[f64; 4]>,
    /// Between rows.
    pub interpolation: Interpolation,
    /// Outside of them.
    pub outside: Outside,
}

impl DataTable {
    /// Of at least two rows, with rising arguments and finite numbers.
    pub fn new(
        name: &str,
        (knots, values): (Vec<f64>, &[f64]),
        interpolation: Interpolation,
        outside: Outside,
    ) -> Self {
        let lengths: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let chords: Vec<f64> =
            values.windows(2).zip(&lengths).map(|(pair, length)| (pair[1] - pair[0]) / length).collect();
        let periodic = outside == Outside::Periodic;
        let slopes = match interpolation {
            Interpolation::Linear => Vec::new(),
            Interpolation::Monotone => monotone(&lengths, &chords, periodic),
            Interpolation::Spline => spline(&lengths, &chords, periodic),
        };
        let piece = |(at, (length, chord)): (usize, (&f64, &f64))| {
            let Some([from, to]) = slopes.get(at).zip(slopes.get(at + 1)).map(|(a, b)| [*a, *b]) else {
                return [values[at], *chord, 0.0, 0.0];
            };
            // Hermite's cubic by values and slopes at both ends.
            let second = (3.0 * chord - 2.0 * from - to) / length;
            [values[at], from, second, (from + to - 2.0 * chord) / (length * length)]
        };
        let pieces = lengths.iter().zip(&chords).enumerate().map(piece).collect();
        Self { name: name.to_owned(), knots, pieces, interpolation, outside }
    }

    /// The last derivative that is continuous.
    pub fn continuity(&self) -> i32 {
        match (self.outside, self.interpolation) {
            // Constant outside: with a slope at the end it has a kink there.
            (Outside::Hold, _) | (_, Interpolation::Linear) => 0,
            (_, Interpolation::Monotone) => 1,
            (_, Interpolation::Spline) => {
                if self.pieces.len() > 1 {
                    2
                } else {
                    SMOOTH
                }
            }
        }
    }

    /// What kind of table it is, for messages.
    pub const fn kind(&self) -> &'static str {
        match (self.outside, self.interpolation) {
            (Outside::Hold, _) => "a table that is held outside",
            (_, Interpolation::Linear) => "a linear table",
            _ => "a table",
        }
    }

    /// First and last argument.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.pieces.len()]]
    }

    /// Its value.
    pub fn of<V: Value>(&self, x: V) -> V {
        let [first, last] = self.range().map(|end| x.number(end));
        match self.outside {
            Outside::Refuse => {
                let inside = (last - x).choose_quietly(last - x, x.number(1.0));
                // The root of a negative number, where there is nothing: it is no number, and so is what is made of it.
                self.within(x) * (x - first).choose_quietly(x - first, inside).root()
            }
            Outside::Hold => self.within(self.held(x)),
            Outside::Periodic => self.within(x - (last - first) * self.periods(x)),
        }
    }

    /// How many rows the argument has passed behind the first one, with the part of the way to the next; it goes on rising from
    /// period to period.
    pub fn row<V: Value>(&self, x: V) -> V {
        let [first, last] = self.range().map(|end| x.number(end));
        match self.outside {
            Outside::Refuse => self.row_within(x),
            Outside::Hold => self.row_within(self.held(x)),
            Outside::Periodic => {
                let periods = self.periods(x);
                let rows = x.number(self.pieces.len() as f64);
                self.row_within(x - (last - first) * periods) + rows * periods
            }
        }
    }

    /// The nearest argument inside.
    fn held<V: Value>(&self, x: V) -> V {
        let [first, last] = self.range().map(|end| x.number(end));
        let x = (x - first).choose(first, x);
        (last - x).choose(last, x)
    }

    /// Whole periods passed.
    fn periods<V: Value>(&self, x: V) -> V {
        let [first, last] = self.range().map(|end| x.number(end));
        ((x - first) / (last - first)).whole()
    }

    fn row_within<V: Value>(&self, x: V) -> V {
        let [row, knot, length] = self.chosen(x, (0, self.pieces.len()), &|at| {
            [at as f64, self.knots[at], self.knots[at + 1] - self.knots[at]]
        });
        row + (x - knot) / length
    }

    fn within<V: Value>(&self, x: V) -> V {
        let [knot, c0, c1, c2, c3] = self.chosen(x, (0, self.pieces.len()), &|at| {
            let [c0, c1, c2, c3] = self.pieces[at];
            [self.knots[at], c0, c1, c2, c3]
        });
        let u = x - knot;
        c0 + u * (c1 + u * (c2 + u * c3))
    }

    /// Numbers of the piece at `x`, by those of each piece, among pieces from `low` up to `high`.
    fn chosen<V: Value, const N: usize>(
        &self,
        x: V,
        (low, high): (usize, usize),
        of: &dyn Fn(usize) -> [f64; N],
    ) -> [V; N] {
        if high - low == 1 {
            return of(low).map(|number| x.number(number));
        }
        let middle = low.midpoint(high);
        let (left, right) = (self.chosen(x, (low, middle), of), self.chosen(x, (middle, high), of));
        let side = x - x.number(self.knots[middle]);
        std::array::from_fn(|at| side.choose_quietly(left[at], right[at]))
    }
}

/// Slopes at the knots by F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300: weighted harmonic means of the chords,
/// zero where these turn.
fn monotone(lengths: &[f64], chords: &[f64], periodic: bool) -> Vec<f64> {
    let count = chords.len();
    let mean = |before: usize, after: usize| {
        let (a, b) = (chords[before], chords[after]);
        if a * b <= 0.0 {
            return 0.0;
        }
        let (h, k) = (lengths[before], lengths[after]);
        let (v, w) = (2.0 * k + h, k + 2.0 * h);
        (v + w) / (v / a + w / b)
    };
    let end = |at: usize| if periodic { mean(count - 1, 0) } else { chords[at] };
    (0..=count)
        .map(|at| match at {
            0 => end(0),
            _ if at == count => end(count - 1),
            _ => mean(at - 1, at),
        })
        .collect()
}

/// Slopes at the knots of the cubic spline: continuous second derivatives at inner knots, and at the ends either one cubic over the
/// last two pieces or, of a period, the same as at an inner one.
fn spline(lengths: &[f64], chords: &[f64], periodic: bool) -> Vec<f64> {
    let count = chords.len();
    if count == 1 {
        return if periodic { vec![0.0; 2] } else { vec![chords[0]; 2] };
    }
    if count == 2 && !periodic {
        // One parabola.
        let bend = (chords[1] - chords[0]) / (lengths[0] + lengths[1]);
        let first = chords[0] - bend * lengths[0];
        let whole = lengths[0] + lengths[1];
        return vec![first, chords[0] + bend * lengths[0], first + 2.0 * bend * whole];
    }
    let unknowns = if periodic { count } else { count + 1 };
    let mut rows: Vec<Vec<f64>> = vec![vec![0.0; unknowns + 1]; unknowns];
    for (at, row) in rows.iter_mut().enumerate() {
        if !periodic && (at == 0 || at == count) {
            // The third derivative goes through the knot beside the end.
            let [a, b] = if at == 0 { [0, 1] } else { [count - 2, count - 1] };
            let (p, q) = (1.0 / (lengths[a] * lengths[a]), 1.0 / (lengths[b] * lengths[b]));
            row[a] += p;
            row[a + 1] += p - q;
            row[a + 2] -= q;
            row[unknowns] = 2.0 * (chords[a] * p - chords[b] * q);
            continue;
        }
        let before = (at + count - 1) % count;
        let (p, q) = (1.0 / lengths[before], 1.0 / lengths[at]);
        row[if periodic { before } else { at - 1 }] += p;
        row[at] += 2.0 * (p + q);
        row[(at + 1) % unknowns] += q;
        row[unknowns] = 3.0 * (chords[before] * p + chords[at] * q);
    }
    let mut slopes = solved(rows);
    if periodic {
        slopes.push(slopes[0]);
    }
    slopes
}

/// The solution of a small regular system, its right side in the last column, by elimination with pivots of columns.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let count = rows.len();
    for at in 0..count {
        let size = |row: &usize| rows[*row][at].abs();
        let pivot = (at..count).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(at);
        rows.swap(at, pivot);
        let own = rows[at].clone();
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = row[at] / own[at];
            if other != at && factor != 0.0 {
                row.iter_mut().zip(&own).skip(at).for_each(|(entry, pivot)| *entry -= factor * pivot);
            }
        }
    }
    rows.iter().enumerate().map(|(at, row)| row[count] / row[at]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(f: impl Fn(f64) -> f64, knots: &[f64], how: Interpolation, outside: Outside) -> DataTable {
        let values: Vec<f64> = knots.iter().map(|x| f(*x)).collect();
        DataTable::new("f", (knots.to_vec(), &values), how, outside)
    }

    const UNEVEN: [f64; 6] = [-1.0, -0.4, 0.1, 0.9, 1.3, 2.0];

    #[test]
    fn each_kind_meets_its_rows_and_what_it_must_reproduce() {
        let cubic = |x: f64| ((0.7 * x - 0.3) * x + 1.1) * x - 0.2;
        let line = |x: f64| 1.5 - 0.4 * x;
        for (how, f) in [
            (Interpolation::Linear, &line as &dyn Fn(f64) -> f64),
            (Interpolation::Monotone, &line),
            (Interpolation::Spline, &cubic),
        ] {
            let table = table(f, &UNEVEN, how, Outside::Refuse);
            for k in 0..=60 {
                let x = -1.0 + 0.05 * f64::from(k);
                // Roundings of a system of six unknowns about one.
                assert!((table.of(x.min(2.0)) - f(x.min(2.0))).abs() < 1e-14, "{how:?} at {x}");
            }
            assert!(table.of(-1.0001).is_nan() && table.of(2.0001).is_nan());
        }
        // Three rows are a parabola, two a line.
        for knots in [&UNEVEN[..3], &UNEVEN[..2]] {
            let f = |x: f64| if knots.len() == 3 { 2.0 * x * x - x } else { 3.0 * x };
            let table = table(f, knots, Interpolation::Spline, Outside::Refuse);
            assert!((table.of(-0.55) - f(-0.55)).abs() < 1e-15);
        }
    }

    #[test]
    fn a_spline_converges_with_the_fourth_power_of_its_step_and_a_period_goes_on_smoothly() {
        let error = |count: i32| {
            let knots: Vec<f64> =
                (0..=count).map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(count)).collect();
            let mut values: Vec<f64> = knots.iter().map(|x| x.sin()).collect();
            values[count as usize] = values[0];
            let table = DataTable::new("f", (knots, &values), Interpolation::Spline, Outside::Periodic);
            (0..1000)
                .map(|k| 0.05 * f64::from(k) - 20.0)
                .fold(0.0_f64, |worst, x| worst.max((table.of(x) - x.sin()).abs()))
        };
        let (coarse, fine) = (error(12), error(24));
        // 2^4 in the limit.
        assert!((14.0..18.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
        // 5/384 of the fourth power of the step.
        assert!(coarse < 5.0 / 384.0 * (std::f64::consts::TAU / 12.0).powi(4) * 1.2);
    }

    #[test]
    fn monotone_rows_make_a_monotone_table() {
        let values = [0.0, 0.0, 0.1, 3.0, 3.0, 9.0];
        let table = DataTable::new("f", (UNEVEN.to_vec(), &values), Interpolation::Monotone, Outside::Hold);
        let course: Vec<f64> = (0..=400).map(|k| table.of(-1.5 + 0.01 * f64::from(k))).collect();
        // Falls by roundings only.
        assert!(course.windows(2).all(|pair| pair[1] - pair[0] > -1e-15));
        // A few roundings of the cubic at its end.
        assert!(course[0] == 0.0 && (course[400] - 9.0).abs() < 1e-14);
    }
}
