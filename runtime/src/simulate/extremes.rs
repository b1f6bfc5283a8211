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

/// Collects extremes along a run.
pub(super) struct Collector {
    start: f64,
    span: f64,
    last: Option<(f64, Vec<f64>)>,
    low: Vec<At>,
    high: Vec<At>,
    /// Of every piece, the smallest and the largest values of all columns.
    pieces: Vec<[Vec<f64>; 2]>,
    peaks: Vec<(Peak, [Option<[usize; 3]>; 2])>,
}

impl Collector {
    /// For these columns, between `start` and `end` [s].
    pub(super) fn new(channels: &[Channel], (start, end): (f64, f64)) -> Self {
        let place = |name: String| channels.iter().position(|channel| channel.name == name);
        let vector = |stem: &str| {
            let [x, y, z] = ["x", "y", "z"].map(|axis| place(format!("{stem}{axis}")));
            Some([x?, y?, z?])
        };
        let joints = channels.iter().filter_map(|channel| channel.name.strip_suffix(".Fx"));
        let peak = |joint: &str| {
            let places = ["F", "M"].map(|load| vector(&format!("{joint}.{load}")));
            (Peak { joint: joint.to_owned(), force: At::default(), moment: At::default() }, places)
        };
        let count = channels.len();
        let none = |value: f64| vec![At { value, t: start }; count];
        let nothing = [f64::INFINITY, f64::NEG_INFINITY].map(|value| vec![value; count]);
        Self {
            start,
            span: end - start,
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
        for (low, value) in self.low.iter_mut().zip(values) {
            if *value < low.value {
                *low = At { value: *value, t };
            }
        }
        for (high, value) in self.high.iter_mut().zip(values) {
            if *value > high.value {
                *high = At { value: *value, t };
            }
        }
        for (peak, places) in &mut self.peaks {
            for (most, places) in [&mut peak.force, &mut peak.moment].into_iter().zip(places) {
                let Some(places) = places else { continue };
                let value = places.map(|place| values[place] * values[place]).iter().sum::<f64>().sqrt();
                if value > most.value {
                    *most = At { value, t };
                }
            }
        }
        self.note_envelopes(t, values);
        match &mut self.last {
            Some((time, last)) => {
                *time = t;
                last.copy_from_slice(values);
            }
            None => self.last = Some((t, values.to_vec())),
        }
    }

    /// Between two times curves are taken as straight lines.
    fn note_envelopes(&mut self, t: f64, values: &[f64]) {
        let place = |t: f64| (t - self.start) / self.span * ENVELOPE_PIECES as f64;
        let (to, now) = (place(t), self.piece(t));
        include(&mut self.pieces[now], values);
        let Some((before, last)) = &self.last else { return };
        let (from, first) = (place(*before), self.piece(*before));
        for border in first + 1..=now {
            let part = (border as f64 - from) / (to - from);
            let at_border: Vec<f64> =
                last.iter().zip(values).map(|(last, value)| last + part * (value - last)).collect();
            include(&mut self.pieces[border - 1], &at_border);
            include(&mut self.pieces[border], &at_border);
        }
    }

    fn piece(&self, t: f64) -> usize {
        let place = (t - self.start) / self.span * ENVELOPE_PIECES as f64;
        (place as usize).min(ENVELOPE_PIECES - 1)
    }

    /// What was collected, if the run got to its start.
    pub(super) fn finish(self) -> (Vec<Extremes>, Vec<Peak>) {
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

/// Takes the values of all columns into their ranges.
fn include([low, high]: &mut [Vec<f64>; 2], values: &[f64]) {
    for ((low, high), value) in low.iter_mut().zip(high).zip(values) {
        *low = if *value < *low { *value } else { *low };
        *high = if *value > *high { *value } else { *high };
    }
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
