//! Measured series of missions: a CSV file with a column of time and columns of parameters or inputs, binned into segments with
//! their shares of the time. In: the file. Out: segments, and those in half as many bins.

use std::collections::BTreeMap;
use std::path::Path;

use super::resolver::Resolver;
use crate::diagnostic::{Code, brief};
use crate::id::ParameterId;
use crate::input::read_named;
use crate::limits;
use crate::model::Segment;
use crate::spec::{Dimension, Name, UnitSize, unit_size};

/// Segments that a series may come to: each has its own dynamics.
const MOST_SEGMENTS: usize = 64;

/// A series in SI.
struct Series {
    /// Time that each row stands for [s]: half the way to its neighbours.
    weights: Vec<f64>,
    columns: Vec<(ParameterId, Vec<f64>)>,
}

impl Resolver<'_> {
    /// Segments of a mission's series in so many bins a column, and in half as many.
    pub(super) fn series_segments(
        &mut self,
        mission: &Name,
        file: &Name,
        bins: usize,
    ) -> Option<(Vec<Segment>, Vec<Segment>)> {
        let found = read_named(Path::new(&self.source.name), &file.value, self.reach, limits::DATA_BYTES);
        let text = found.map_err(|error| error.to_string()).map(|(path, text)| {
            self.attached.push(path);
            text
        });
        let series = text.and_then(|text| self.series(&text));
        let series = series.and_then(|series| {
            let count = series.segments(bins).len();
            if count > MOST_SEGMENTS {
                return Err(format!(
                    "it comes to {count} segments, more than {MOST_SEGMENTS}: give fewer `bins`"
                ));
            }
            Ok(series)
        });
        match series {
            Ok(series) => {
                let coarser = if bins > 1 { series.segments(bins / 2) } else { Vec::new() };
                Some((series.segments(bins), coarser))
            }
            Err(reason) => {
                // The reason may quote the file, which need not be meant for who reads the message.
                let message = format!(
                    "the series `{}` of mission `{}` cannot be used: {}",
                    file.value,
                    mission.value,
                    brief(&reason)
                );
                self.refuse(Code::BadMission, file.span, message).help(
                    "a CSV file with the header `t [s], speed [Hz]`, a tunable parameter or an input in each further column; its \
                     path is relative to this file",
                );
                None
            }
        }
    }

    fn series(&self, text: &str) -> Result<Series, String> {
        let lines = text.lines().enumerate().map(|(at, line)| (at + 1, line.trim()));
        let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (_, header) = lines.next().ok_or("it is empty")?;
        let titles: Vec<&str> = cells(header).collect();
        let mut time = None;
        let mut places: Vec<(usize, usize, UnitSize)> = Vec::new();
        for (at, title) in titles.iter().enumerate() {
            let (name, unit) =
                title.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')).unwrap_or((title, "1"));
            let (name, unit) = (name.trim(), unit.trim());
            let size = unit_size(unit).ok_or_else(|| format!("`{unit}` of column `{title}` is no unit"))?;
            let UnitSize { dimension, turning, .. } = size;
            if matches!(name, "t" | "time") {
                if dimension != Dimension::TIME || time.replace((at, size)).is_some() {
                    return Err("one column gives the time, `t [s]`".to_owned());
                }
                continue;
            }
            let name = name.strip_suffix(".u").unwrap_or(name);
            let id = (0..self.parameters.len()).find(|id| self.parameters[*id].name == name);
            let id = id.ok_or_else(|| format!("there is no parameter or input `{name}`"))?;
            let parameter = &self.parameters[id];
            if !parameter.tunable && !parameter.input {
                return Err(format!("`{name}` is fixed at generation: give it `tunable = true`"));
            }
            if parameter.dimension != dimension {
                let needed = parameter.dimension.description();
                return Err(format!("column `{title}`: `{name}` is {needed}"));
            }
            if let Some([message, help]) = self.other_turning(id, turning, &format!("column `{title}`")) {
                return Err(format!("{message}: {help}"));
            }
            if places.iter().any(|(known, ..)| *known == id) {
                return Err(format!("two columns give `{name}`"));
            }
            places.push((id, at, size));
        }
        let (time_at, second) = time.ok_or("no column gives the time, `t [s]`")?;
        if places.is_empty() {
            return Err("no column gives a parameter or an input".to_owned());
        }
        let (mut times, mut columns) = (Vec::new(), vec![Vec::new(); places.len()]);
        for (line, row) in lines {
            let cells: Vec<&str> = cells(row).collect();
            let number = |at: usize, size: UnitSize| {
                let value = cells.get(at).and_then(|cell| cell.parse::<f64>().ok());
                let value = value.map(|value| size.to_si(value)).filter(|value| value.is_finite());
                value.ok_or_else(|| format!("line {line}: column `{}` has no number", titles[at]))
            };
            let now = number(time_at, second)?;
            if times.last().is_some_and(|before| *before >= now) {
                return Err(format!("line {line}: times do not rise"));
            }
            times.push(now);
            for (column, (_, at, size)) in columns.iter_mut().zip(&places) {
                column.push(number(*at, *size)?);
            }
        }
        if times.len() < 2 {
            return Err("it has fewer than two rows".to_owned());
        }
        let last = times.len() - 1;
        let weight = |at: usize| 0.5 * (times[(at + 1).min(last)] - times[at.saturating_sub(1)]);
        let ids = places.iter().map(|(id, ..)| ParameterId::new(*id));
        Ok(Series { weights: (0..times.len()).map(weight).collect(), columns: ids.zip(columns).collect() })
    }
}

impl Series {
    /// A segment for each cell of bins that has any time, with the means of its rows.
    fn segments(&self, bins: usize) -> Vec<Segment> {
        let ranges: Vec<(f64, f64)> = self.columns.iter().map(|(_, values)| range(values)).collect();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 up to the number of bins"
        )]
        let bin = |value: f64, (low, high): (f64, f64)| {
            let part = if high > low { (value - low) / (high - low) } else { 0.0 };
            ((part * bins as f64) as usize).min(bins - 1)
        };
        let mut found: BTreeMap<Vec<usize>, (f64, Vec<f64>)> = BTreeMap::new();
        for (row, weight) in self.weights.iter().enumerate() {
            let cell = self.columns.iter().zip(&ranges).map(|((_, values), range)| bin(values[row], *range));
            let (time, sums) = found.entry(cell.collect()).or_insert((0.0, vec![0.0; self.columns.len()]));
            *time += weight;
            for (sum, (_, values)) in sums.iter_mut().zip(&self.columns) {
                *sum += weight * values[row];
            }
        }
        let whole: f64 = found.values().map(|(time, _)| time).sum();
        let is_one = found.len() == 1;
        let segment = |(at, (time, sums)): (usize, (f64, Vec<f64>))| Segment {
            name: format!("bin{}", at + 1),
            amount: if is_one { 1.0 } else { time / whole },
            values: self.columns.iter().zip(sums).map(|((id, _), sum)| (*id, sum / time)).collect(),
            factors: (1.0, 1.0),
            of_joints: Vec::new(),
        };
        found.into_values().enumerate().map(segment).collect()
    }
}

/// Cells of a row, without quotes.
pub(super) fn cells(row: &str) -> impl Iterator<Item = &str> {
    row.split(',').map(|cell| cell.trim().trim_matches('"').trim())
}

fn range(values: &[f64]) -> (f64, f64) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    (low, values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(values: &[f64]) -> Series {
        Series { weights: vec![1.0; values.len()], columns: vec![(ParameterId::new(0), values.to_vec())] }
    }

    #[test]
    fn bins_have_their_shares_of_the_time_and_the_means_of_their_rows() {
        let segments = series(&[1.0, 1.5, 2.0, 2.0, 5.0]).segments(2);
        let told: Vec<(f64, f64)> =
            segments.iter().map(|segment| (segment.amount, segment.values[0].1)).collect();
        assert_eq!(told, [(0.8, 1.625), (0.2, 5.0)]);
    }

    #[test]
    fn what_does_not_vary_is_one_segment() {
        let segments = series(&[3.0; 4]).segments(8);
        assert_eq!((segments.len(), segments[0].amount, segments[0].values[0].1), (1, 1.0, 3.0));
    }
}
