//! Extremes of a run from the integrator's own steps: smallest and largest value of every column, the envelope of every
//! curve, the peak loads of every joint. In: columns at steps, and within long ones. Out: [`Extremes`], [`Peak`]s.
//! Rows have no part in it: the same run asked for two rows or for twenty thousand has the same extremes.

use crate::description::Channel;
use crate::system::STATES;

/// Pieces of equal length that the envelope of a curve has.
pub const ENVELOPE_PIECES: usize = 48;

/// A value and when it was met.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct At {
    /// Value in its unit.
    pub value: f64,
    /// Time [s].
    pub t: f64,
}

/// What a column went through.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// Its smallest value.
    pub low: At,
    /// Its largest value.
    pub high: At,
    /// Smallest and largest value in [`ENVELOPE_PIECES`] equal pieces of the time recorded.
    pub envelope: Vec<(f64, f64)>,
}

/// Peak loads of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Peak {
    /// The joint.
    pub joint: String,
    /// Largest magnitude of the force [N].
    pub force: At,
    /// Largest magnitude of the moment [N m]; zero if it transmits none.
    pub moment: At,
}

/// Groups of looks that are collected before they are judged: column by column then, many of one column in a row.
const GROUPS: usize = 4;

/// Collects extremes along a run.
pub(super) struct Collector {
    start: f64,
    span: f64,
    columns: usize,
    /// Times of the looks that are not judged yet, and their columns, group by group.
    times: Vec<f64>,
    looks: Vec<[f64; STATES]>,
    /// The piece of the looks that are not judged yet.
    piece: usize,
    /// Time of the look judged last. Its columns stay in the last place of all groups.
    last: Option<f64>,
    low: Vec<At>,
    high: Vec<At>,
    /// Of every piece, the smallest and the largest values of all columns.
    pieces: Vec<[Vec<f64>; 2]>,
    peaks: Vec<(Peak, [Option<Load>; 2])>,
}

/// A vector of which the largest magnitude is sought.
struct Load {
    places: [usize; 3],
    /// Square of the largest magnitude.
    square: f64,
}

impl Collector {
    /// For these columns, between `start` and `end` [s].
    pub(super) fn new(channels: &[Channel], (start, end): (f64, f64)) -> Self {
        let place = |name: String| channels.iter().position(|channel| channel.name == name);
        let vector = |stem: &str| {
            let [x, y, z] = ["x", "y", "z"].map(|axis| place(format!("{stem}{axis}")));
            Some(Load { places: [x?, y?, z?], square: 0.0 })
        };
        let joints = channels.iter().filter_map(|channel| channel.name.strip_suffix(".Fx"));
        let peak = |joint: &str| {
            let loads = ["F", "M"].map(|load| vector(&format!("{joint}.{load}")));
            (Peak { joint: joint.to_owned(), force: At::default(), moment: At::default() }, loads)
        };
        let columns = channels.len();
        let none = |value: f64| vec![At { value, t: start }; columns];
        let nothing = [f64::INFINITY, f64::NEG_INFINITY].map(|value| vec![value; columns]);
        Self {
            start,
            span: end - start,
            columns,
            times: Vec::with_capacity(GROUPS * STATES),
            looks: vec![[0.0; STATES]; GROUPS * columns],
            piece: 0,
            last: None,
            low: none(f64::INFINITY),
            high: none(f64::NEG_INFINITY),
            pieces: vec![nothing; ENVELOPE_PIECES],
            peaks: joints.map(peak).collect(),
        }
    }

    /// Notes all columns at a time; what was before the start is not recorded.
    pub(super) fn note(&mut self, t: f64, values: &[f64]) {
        if t < self.start {
            return;
        }
        self.make_room(t, |column| values[column]);
        let (looks, state) = self.next_look();
        looks.iter_mut().zip(values).for_each(|(look, value)| look[state] = *value);
        self.times.push(t);
    }

    /// Notes all columns at several times.
    pub(super) fn note_several(&mut self, times: &[f64], looks: &[[f64; STATES]]) {
        for (state, t) in times.iter().enumerate() {
            if *t < self.start {
                continue;
            }
            self.make_room(*t, |column| looks[column][state]);
            let (places, place) = self.next_look();
            places.iter_mut().zip(looks).for_each(|(look, known)| look[place] = known[state]);
            self.times.push(*t);
        }
    }

    /// Notes all columns at these times, which are to be written where this says; nowhere if these times are not all of the
    /// piece of the look before.
    pub(super) fn room(&mut self, times: &[f64; STATES]) -> Option<&mut [[f64; STATES]]> {
        let [first, .., last] = times;
        if *first < self.start || [first, last].iter().any(|t| self.piece(**t) != self.piece) {
            return None;
        }
        if !self.times.len().is_multiple_of(STATES) || self.times.len() == GROUPS * STATES {
            self.judge();
        }
        let group = self.times.len() / STATES;
        self.times.extend_from_slice(times);
        Some(&mut self.looks[group * self.columns..][..self.columns])
    }

    /// The group with the next look, and its place there.
    fn next_look(&mut self) -> (&mut [[f64; STATES]], usize) {
        let (group, state) = (self.times.len() / STATES, self.times.len() % STATES);
        (&mut self.looks[group * self.columns..][..self.columns], state)
    }

    /// Before a look at a time: what was noted is of the same piece, and there is room behind it.
    fn make_room(&mut self, t: f64, value: impl Fn(usize) -> f64) {
        let piece = self.piece(t);
        if self.times.len() == GROUPS * STATES || piece != self.piece {
            self.judge();
        }
        if piece != self.piece {
            self.cross_borders(t, value, piece);
            self.piece = piece;
        }
    }

    /// Takes the looks that were not judged yet into everything.
    fn judge(&mut self) {
        let Some(last) = self.times.last() else { return };
        self.last = Some(*last);
        self.repeat_last();
        let Self { columns, times, looks, low, high, pieces, peaks, .. } = self;
        let groups: [&[[f64; STATES]]; GROUPS] =
            std::array::from_fn(|group| &looks[group * *columns..][..*columns]);
        for (peak, loads) in peaks {
            for (most, load) in [&mut peak.force, &mut peak.moment].into_iter().zip(loads) {
                let Some(load) = load else { continue };
                groups.iter().zip(times.chunks(STATES)).for_each(|(group, t)| load.judge(most, t, group));
            }
        }
        let [lowest, highest] = &mut pieces[self.piece];
        let pieces = lowest.iter_mut().zip(highest);
        let all = low.iter_mut().zip(high).zip(pieces);
        let [first, second, third, fourth] = groups;
        let looks = first.iter().zip(second).zip(third.iter().zip(fourth));
        let all = all.zip(looks).enumerate();
        for (column, (((low, high), (lowest, highest)), ((first, second), (third, fourth)))) in all {
            (*lowest, *highest) = ends([first, second, third, fourth], (*lowest, *highest));
            if *lowest < low.value {
                take_first(low, (&groups, column), times, |look, low| look < low);
            }
            if *highest > high.value {
                take_first(high, (&groups, column), times, |look, high| look > high);
            }
        }
        self.times.clear();
    }

    /// Fills the groups up: the last look once more changes nothing.
    fn repeat_last(&mut self) {
        let (columns, count) = (self.columns, self.times.len());
        for place in count..GROUPS * STATES {
            let (group, state) = (place / STATES, place % STATES);
            let (before, looks) = self.looks.split_at_mut(group * columns);
            let known = (count - 1) / STATES * columns;
            for (column, look) in looks[..columns].iter_mut().enumerate() {
                let last = before.get(known + column).unwrap_or(look);
                look[state] = last[(count - 1) % STATES];
            }
        }
    }

    /// Between two times curves are taken as straight lines: what they are at the borders of pieces belongs to both.
    fn cross_borders(&mut self, t: f64, value: impl Fn(usize) -> f64, now: usize) {
        let Some(before) = self.last else { return };
        let place = |t: f64| (t - self.start) / self.span * ENVELOPE_PIECES as f64;
        let (from, to) = (place(before), place(t));
        for border in self.piece + 1..=now {
            let part = (border as f64 - from) / (to - from);
            let last_columns = &self.looks[(GROUPS - 1) * self.columns..];
            for (column, [.., last]) in last_columns.iter().enumerate() {
                let value = last + part * (value(column) - last);
                for [low, high] in &mut self.pieces[border - 1..=border] {
                    low[column] = smaller(value, low[column]);
                    high[column] = larger(value, high[column]);
                }
            }
        }
    }

    fn piece(&self, t: f64) -> usize {
        let place = (t - self.start) / self.span * ENVELOPE_PIECES as f64;
        (place as usize).min(ENVELOPE_PIECES - 1)
    }

    /// What was collected, if the run got to its start.
    pub(super) fn finish(mut self) -> (Vec<Extremes>, Vec<Peak>) {
        self.judge();
        if self.last.is_none() {
            return Default::default();
        }
        let envelope = |column: usize| {
            self.pieces.iter().map(|[low, high]| (low[column], high[column])).collect::<Vec<_>>()
        };
        let ends = self.low.iter().zip(&self.high).enumerate();
        let columns =
            ends.map(|(column, (low, high))| Extremes { low: *low, high: *high, envelope: envelope(column) });
        (columns.collect(), self.peaks.into_iter().map(|(peak, _)| peak).collect())
    }
}

impl Load {
    /// Takes a group of looks in; roots are taken of new maxima only.
    fn judge(&mut self, most: &mut At, times: &[f64], looks: &[[f64; STATES]]) {
        let [x, y, z] = self.places.map(|place| looks[place]);
        let squares: [f64; STATES] =
            std::array::from_fn(|state| x[state] * x[state] + y[state] * y[state] + z[state] * z[state]);
        if !squares.iter().fold(false, |any, square| any | (*square > self.square)) {
            return;
        }
        for (square, t) in squares.into_iter().zip(times) {
            if square > self.square {
                self.square = square;
                let value = square.sqrt();
                if value > most.value {
                    *most = At { value, t: *t };
                }
            }
        }
    }
}

/// Goes on to the first of the looks that are furthest beyond `most`, if there are any.
#[cold]
fn take_first(
    most: &mut At,
    (groups, column): (&[&[[f64; STATES]]; GROUPS], usize),
    times: &[f64],
    is_beyond: impl Fn(f64, f64) -> bool,
) {
    for (look, t) in groups.iter().flat_map(|group| &group[column]).zip(times) {
        if is_beyond(*look, most.value) {
            *most = At { value: *look, t: *t };
        }
    }
}

/// Smallest and largest value of groups of looks at a column, and of those before.
#[inline]
fn ends(groups: [&[f64; STATES]; GROUPS], (low, high): (f64, f64)) -> (f64, f64) {
    let (mut low, mut high) = ([low; STATES], [high; STATES]);
    for group in groups {
        for state in 0..STATES {
            low[state] = smaller(group[state], low[state]);
        }
        for state in 0..STATES {
            high[state] = larger(group[state], high[state]);
        }
    }
    // Halves first: two numbers then stay side by side to the end.
    let [a, b, c, d] = low;
    let least = smaller(smaller(a, c), smaller(b, d));
    let [a, b, c, d] = high;
    (least, larger(larger(a, c), larger(b, d)))
}

/// The smaller of both; `b` where `a` is not a number.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of both; `b` where `a` is not a number.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_have_their_times_and_envelopes_what_lies_between() {
        let channel = |name: &'static str| Channel { name: name.into(), unit: "N".into(), wraps: false };
        let channels = ["R.Fx", "R.Fy", "R.Fz"].map(channel);
        let mut collector = Collector::new(&channels, (1.0, 2.0));
        for (t, x) in [(0.5, 9.0), (1.0, 0.0), (1.25, -4.0), (2.0, 2.0)] {
            collector.note(t, &[x, 3.0, 0.0]);
        }
        let (columns, peaks) = collector.finish();
        assert_eq!(
            (columns[0].low, columns[0].high),
            (At { value: -4.0, t: 1.25 }, At { value: 2.0, t: 2.0 })
        );
        assert_eq!((peaks[0].joint.as_str(), peaks[0].force), ("R", At { value: 5.0, t: 1.25 }));
        assert_eq!(peaks[0].moment, At::default());
        // Down by 4 in a quarter of the time, 12 pieces; then up by 6 in 36.
        let near = |(low, high): (f64, f64), (a, b): (f64, f64)| (low - a).abs() + (high - b).abs() < 1e-12;
        assert!(near(columns[0].envelope[0], (-1.0 / 3.0, 0.0)), "{:?}", columns[0].envelope[0]);
        assert!(near(columns[0].envelope[12], (-4.0, -4.0 + 1.0 / 6.0)));
        assert!(near(columns[0].envelope[47], (2.0 - 1.0 / 6.0, 2.0)));
        assert!(columns[1].envelope.iter().all(|piece| *piece == (3.0, 3.0)));
    }
}
