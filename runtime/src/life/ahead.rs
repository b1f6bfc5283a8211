//! The mean path of one joint whose wear is a number, by measurements that do not wait for each other. In: what a revolution wears
//! now. Out: the path to the threshold. Never knows draws, or how measurements are made.
//!
//! What a revolution wears goes with W alone there, so that the life is the integral of dW over the rate of wear. Measurements are
//! made in rounds, which the fine scale may run side by side: at even places up to the threshold, then where the curve through its
//! neighbours is least sure.

use super::curve::{Curve, Measured, apart};
use super::path::{Increments, Path, Segment, Walker, rates};
use super::settings::{LifeSettings, WearStep};
use super::source::WearSource;
use crate::watch::Watch;
use crate::wear::ContactMeasure;

/// Measurements of a round: as many as the widest registers have lanes.
const ROUND: usize = 8;
/// A path may err by this part of what a step may: measurements in rounds cost little.
const PART: f64 = 0.25;
/// A curve through four errs by no more than this part of its largest difference from those through three of them: by a fourth to a
/// half at kinks, by less where it is smooth.
const OF_DIFFERENCE: f64 = 0.5;
/// What is left of the error of a way when it is halved: by a fourth at kinks, by a sixteenth where it is smooth.
const LEFT: f64 = 0.125;
/// Where twice as many measurements leave more than this part of the error, it is scatter of the fine scale: ...
const SCATTERS: f64 = 0.75;
/// ... more of them average it out, as long as there are not too many.
const MOST: usize = 128;
/// Points of a curve.
const POINTS: usize = 4;
/// The same of the curve by which a path goes on beyond the last measurement, where measurements scatter: a line there errs by twice
/// their scatter, a cubic by thirty times as much.
const SCATTERED_POINTS: usize = 2;
/// Those of it are no nearer to each other than this part of what a cycle wears: neighbours tell more of the scatter of the fine scale
/// than of the way on.
const APART: f64 = 0.5;

/// A measurement.
struct Station<S> {
    /// Depth worn since the begin [m].
    worn: f64,
    /// What a cycle adds to it [m].
    rate: f64,
    measured: Vec<ContactMeasure>,
    /// Of the fine scale.
    state: S,
}

/// The way between two measurements.
#[derive(Clone, Copy)]
struct Piece {
    cycles: f64,
    /// Estimated [cycles].
    error: f64,
}

impl<F: WearSource> Walker<'_, F> {
    /// The path over so many cycles, or to the threshold, from a measurement at its begin.
    ///
    /// Nothing where what a revolution wears does not go with one number, or cannot be measured all the way: a path that goes step by
    /// step then says where it ends, and why.
    ///
    /// The watch hears how sure it is already; who wants it stopped is heard by the measurements.
    pub(super) fn ahead(&mut self, start: &[ContactMeasure], most: u64, watch: Watch<'_>) -> Option<Path> {
        let WearStep::Adaptive { tolerance, .. } = self.settings.step else { return None };
        let ([joint], [base], true) =
            (&self.settings.joints[..], self.base, self.settings.is_measured_ahead())
        else {
            return None;
        };
        let whole = joint.threshold - base.wear;
        let mut stations = vec![Station::new(self.settings, 0.0, start.to_vec(), self.state.clone())?];
        let even: Vec<f64> = (1..=ROUND).map(|at| whole * at as f64 / ROUND as f64).collect();
        self.add(&mut stations, &even)?;
        let mut before: Vec<(usize, f64)> = Vec::new();
        loop {
            let pieces = pieces(&stations)?;
            let cycles: f64 = pieces.iter().map(|piece| piece.cycles).sum();
            let error: f64 = pieces.iter().map(|piece| piece.error).sum();
            let allowed = PART * tolerance * cycles;
            if error <= allowed {
                return self.path(stations, &pieces, (error, most), POINTS);
            }
            if pieces.len() >= MOST {
                // What is not smooth by so many scatters.
                return self.path(stations, &pieces, (error, most), SCATTERED_POINTS);
            }
            let half = before.iter().rev().find(|(count, _)| 2 * count <= pieces.len() + 1);
            if half.is_some_and(|(_, half)| error > SCATTERS * half) {
                let squares: f64 = pieces.iter().map(|piece| piece.error * piece.error).sum();
                if squares <= (tolerance * cycles) * (tolerance * cycles) {
                    return self.path(stations, &pieces, (squares.sqrt(), most), SCATTERED_POINTS);
                }
            }
            // The error falls with a power of the number of measurements.
            let _ = watch.report((allowed / error).sqrt());
            before.push((pieces.len(), error));
            let places = next(&stations, &pieces, allowed);
            self.add(&mut stations, &places)?;
        }
    }

    /// Measures at these places, each from the state of the nearest measurement.
    fn add(&mut self, stations: &mut Vec<Station<F::State>>, places: &[f64]) -> Option<()> {
        let nearest = |place: &f64| {
            let far = |station: &&Station<F::State>| (station.worn - place).abs();
            stations.iter().min_by(|a, b| far(a).total_cmp(&far(b))).map(|station| station.state.clone())
        };
        let mut states: Vec<F::State> = places.iter().map(nearest).collect::<Option<_>>()?;
        let increments: Vec<Increments> = places.iter().map(|place| vec![*place]).collect();
        let each = self.measure_each(&increments, &mut states).ok()?;
        for ((place, measured), state) in places.iter().zip(each).zip(states) {
            stations.push(Station::new(self.settings, *place, measured, state)?);
        }
        stations.sort_by(|a, b| a.worn.total_cmp(&b.worn));
        Some(())
    }

    /// The path through these; it goes on for a cycle along a curve through so many of the last ones, because cycles are whole.
    fn path(
        &mut self,
        stations: Vec<Station<F::State>>,
        pieces: &[Piece],
        (error, most): (f64, u64),
        points: usize,
    ) -> Option<Path> {
        let mut segments = Vec::with_capacity(stations.len());
        let mut starts = vec![0.0];
        for (pair, piece) in stations.windows(2).zip(pieces) {
            let start = starts[starts.len() - 1];
            let (from, to) = ((pair[0].worn, pair[0].rate), (pair[1].worn, pair[1].rate));
            segments.push(segment((start, piece.cycles), from, to));
            starts.push(start + piece.cycles);
        }
        let (last, end) = (stations.last()?, *starts.last()?);
        let known = known(&stations);
        let (own, earlier) = known.split_last()?;
        let others = apart(&[*own], earlier, APART * own.rate).take(points - 1);
        let curve = others.fold(Curve::level(*own), Curve::through);
        let beyond = curve.after(last.worn, 1.0);
        segments.push(segment((end, 1.0), (last.worn, last.rate), (beyond, curve.rate(beyond))));
        let span = (end.floor() as u64 + 1).min(most.max(1));
        let reached = starts.partition_point(|start| *start <= span as f64).max(1) - 1;
        // Of a path that is not followed to its end, as much of the error as of the cycles.
        let error = error * (span as f64 / end).min(1.0);
        let state = stations[reached].state.clone();
        let seen =
            starts.into_iter().zip(stations).map(|(start, station)| (start, station.measured)).collect();
        let path = Path { segments, span, end: None, error: vec![error], seen };
        path.is_finite().then(|| {
            self.state = state;
            path
        })
    }
}

impl<S> Station<S> {
    /// Nothing where it does not wear.
    fn new(settings: &LifeSettings, worn: f64, measured: Vec<ContactMeasure>, state: S) -> Option<Self> {
        let rate = rates(settings, &measured).first().copied().filter(|rate| *rate > 0.0)?;
        Some(Self { worn, rate, measured, state })
    }
}

/// Where to measure next: in the middle of the ways that are least sure, as many as it takes.
fn next<S>(stations: &[Station<S>], pieces: &[Piece], allowed: f64) -> Vec<f64> {
    let mut worst: Vec<usize> = (0..pieces.len()).collect();
    worst.sort_by(|a, b| pieces[*b].error.total_cmp(&pieces[*a].error));
    let mut left: f64 = pieces.iter().map(|piece| piece.error).sum();
    let is_needed = |at: &usize| {
        let is_needed = left > allowed;
        left -= (1.0 - LEFT) * pieces[*at].error;
        is_needed
    };
    let chosen = worst.into_iter().take(ROUND).take_while(is_needed);
    chosen.map(|at| 0.5 * (stations[at].worn + stations[at + 1].worn)).collect()
}

/// The ways between measurements, which are sorted; nothing where a curve does not wear all the way.
fn pieces<S>(stations: &[Station<S>]) -> Option<Vec<Piece>> {
    let known = known(stations);
    (0..known.len() - 1).map(|at| piece(&known, at)).collect()
}

fn known<S>(stations: &[Station<S>]) -> Vec<Measured> {
    stations.iter().map(|station| Measured { wear: station.worn, rate: station.rate }).collect()
}

fn through(points: &[Measured]) -> Option<Curve> {
    let (first, others) = points.split_first()?;
    Some(others.iter().fold(Curve::level(*first), |curve, next| curve.through(*next)))
}

/// The way that begins at one of them, by the curve through the four that are nearest.
fn piece(known: &[Measured], at: usize) -> Option<Piece> {
    let (from, to) = (known[at].wear, known[at + 1].wear);
    let first = at.saturating_sub(1).min(known.len().saturating_sub(POINTS));
    let near = &known[first..(first + POINTS).min(known.len())];
    let cycles = |points: &[Measured]| through(points)?.cycles(from, to);
    let all = cycles(near)?;
    // Those through three that have both ends of the way.
    let [before, after] = [&near[..near.len() - 1], &near[1..]];
    let fewer = [(before, at + 2 < first + near.len()), (after, at > first)];
    let error = fewer
        .iter()
        .filter(|(_, holds)| *holds)
        .map(|(points, _)| cycles(points).map_or(f64::INFINITY, |fewer| (fewer - all).abs()))
        .fold(0.0, f64::max);
    Some(Piece { cycles: all, error: OF_DIFFERENCE * error })
}

fn segment((start, length): (f64, f64), from: (f64, f64), to: (f64, f64)) -> Segment {
    let [(from, from_rate), (to, to_rate)] = [from, to].map(|(worn, rate)| (vec![worn], vec![rate]));
    Segment { start, length, from, to, from_rate, to_rate }
}
