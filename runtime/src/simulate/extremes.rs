//! Extremes of a run from the integrator's own steps: smallest and largest value of every column, the envelope of every
//! curve, the peak loads of every joint. In: columns at steps, and within long ones. Out: [`Extremes`], [`Peak`]s.
//! Rows have no part in it: the same run asked for two rows or for twenty thousand has the same extremes.

use crate::description::Channel;

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

/// Looks that are collected before they are judged: column by column then, many of one column in a row.
const LOOKS: usize = 16;
/// Columns that are judged side by side, as many as registers hold.
const SIDE_BY_SIDE: usize = 8;

/// Collects extremes along a run.
pub(super) struct Collector {
    start: f64,
    span: f64,
    columns: usize,
    /// Times and columns of looks that are not judged yet, all in one piece; rows of whole groups of [`SIDE_BY_SIDE`].
    times: Vec<f64>,
    looks: Vec<f64>,
    /// The piece of the looks that are not judged yet.
    piece: usize,
    /// Time and columns of the look judged last.
    last: Option<f64>,
    last_columns: Vec<f64>,
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
            times: Vec::with_capacity(LOOKS),
            looks: vec![0.0; LOOKS * columns.next_multiple_of(SIDE_BY_SIDE)],
            piece: 0,
            last: None,
            last_columns: vec![0.0; columns],
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
        let piece = self.piece(t);
        if self.times.len() == LOOKS || piece != self.piece {
            self.judge();
        }
        if piece != self.piece {
            self.cross_borders(t, values, piece);
            self.piece = piece;
        }
        let row = self.times.len() * self.width();
        self.looks[row..row + self.columns].copy_from_slice(values);
        self.times.push(t);
    }

    /// Length of a row of looks.
    fn width(&self) -> usize {
        self.columns.next_multiple_of(SIDE_BY_SIDE)
    }

    /// Takes the looks of one piece that were not judged yet into everything.
    fn judge(&mut self) {
        let Some(last) = self.times.last() else { return };
        self.last = Some(*last);
        let (width, count) = (self.width(), self.times.len());
        let looks = &self.looks[..count * width];
        for (peak, loads) in &mut self.peaks {
            for (most, load) in [&mut peak.force, &mut peak.moment].into_iter().zip(loads) {
                let Some(load) = load else { continue };
                load.judge(most, &self.times, looks.chunks_exact(width));
            }
        }
        let [lowest, highest] = &mut self.pieces[self.piece];
        for first in (0..self.columns).step_by(SIDE_BY_SIDE) {
            let (low, high) = ends(looks, width, first);
            let at = |column: usize, value: f64| {
                let met = looks[column..].iter().step_by(width).position(|look| *look == value);
                At { value, t: self.times[met.unwrap_or(0)] }
            };
            let columns = first..(first + SIDE_BY_SIDE).min(self.columns);
            take_in(&mut lowest[columns.clone()], &low, |value, least| value < least);
            take_in(&mut highest[columns.clone()], &high, |value, most| value > most);
            for (at_column, (least, most)) in
                self.low[columns.clone()].iter_mut().zip(&mut self.high[columns]).enumerate()
            {
                if low[at_column] < least.value {
                    *least = at(first + at_column, low[at_column]);
                }
                if high[at_column] > most.value {
                    *most = at(first + at_column, high[at_column]);
                }
            }
        }
        self.last_columns.copy_from_slice(&looks[(count - 1) * width..][..self.columns]);
        self.times.clear();
    }

    /// Between two times curves are taken as straight lines: what they are at the borders of pieces belongs to both.
    fn cross_borders(&mut self, t: f64, values: &[f64], now: usize) {
        let Some(before) = self.last else { return };
        let place = |t: f64| (t - self.start) / self.span * ENVELOPE_PIECES as f64;
        let (from, to) = (place(before), place(t));
        for border in self.piece + 1..=now {
            let part = (border as f64 - from) / (to - from);
            for (column, (last, value)) in self.last_columns.iter().zip(values).enumerate() {
                let value = last + part * (value - last);
                for [low, high] in &mut self.pieces[border - 1..=border] {
                    low[column] = if value < low[column] { value } else { low[column] };
                    high[column] = if value > high[column] { value } else { high[column] };
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
    /// Takes looks in; roots are taken of new maxima only.
    fn judge<'l>(&mut self, most: &mut At, times: &[f64], looks: impl Iterator<Item = &'l [f64]>) {
        for (t, values) in times.iter().zip(looks) {
            let square = self.places.map(|place| values[place] * values[place]).iter().sum::<f64>();
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

fn take_in(ends: &mut [f64], values: &[f64; SIDE_BY_SIDE], beyond: impl Fn(f64, f64) -> bool) {
    for (end, value) in ends.iter_mut().zip(values) {
        *end = if beyond(*value, *end) { *value } else { *end };
    }
}

/// Smallest and largest values of columns side by side, from the column `first` on.
#[inline]
fn ends(looks: &[f64], width: usize, first: usize) -> ([f64; SIDE_BY_SIDE], [f64; SIDE_BY_SIDE]) {
    let (mut low, mut high) = ([f64::INFINITY; SIDE_BY_SIDE], [f64::NEG_INFINITY; SIDE_BY_SIDE]);
    for row in looks.chunks_exact(width) {
        let Some(values) = row[first..].first_chunk::<SIDE_BY_SIDE>() else { continue };
        for at in 0..SIDE_BY_SIDE {
            low[at] = if values[at] < low[at] { values[at] } else { low[at] };
        }
        for at in 0..SIDE_BY_SIDE {
            high[at] = if values[at] > high[at] { values[at] } else { high[at] };
        }
    }
    (low, high)
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
