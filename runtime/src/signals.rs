//! Inputs of a mechanism over time. In: samples by name. Out: values at any time, with the rates that drives need.
//! Never knows where samples come from.

use crate::description::Description;
use crate::error::SetupError;
use crate::tables::InputRole;

/// Inputs over time, in the order of [`Description::inputs`].
pub trait Signals: Sync {
    /// Writes the value of every connected input at time `t` [s]; the others keep theirs, which they have among the parameters.
    fn write(&self, t: f64, values: &mut [f64]);

    /// The first time after `t` at which a signal has a kink: no step should leap over it.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// First and last time that is known [s].
    fn span(&self) -> (f64, f64);
}

/// Signals given at times. Between them an input is linear; one that a drive follows is a cubic spline, which has the
/// rates that drives need. Outside of them the nearest value holds.
#[derive(Clone, Debug)]
pub struct SampledSignals {
    times: Vec<f64>,
    courses: Vec<Course>,
}

/// One input over time.
#[derive(Clone, Debug)]
enum Course {
    /// Nothing is connected.
    Unconnected,
    Linear(Vec<f64>),
    /// Values, second derivatives.
    Spline(Vec<f64>, Vec<f64>),
    /// Written together with the input that it is the rate of.
    Rate,
}

impl SampledSignals {
    /// From times [s] and columns of values in SI by the name of their input; inputs without a column keep the values
    /// that they have among the parameters of a run.
    ///
    /// # Errors
    /// If there are no times, they do not rise, a number is not finite, a column has another length, or its input does not
    /// exist or is given twice.
    pub fn new(
        description: &Description,
        times: Vec<f64>,
        columns: &[(String, Vec<f64>)],
    ) -> Result<Self, SetupError> {
        let bad = |row: usize, reason: &'static str| SetupError::Signals { row: row + 1, reason };
        if times.is_empty() {
            return Err(bad(0, "there is none"));
        }
        if let Some(row) = times.iter().position(|t| !t.is_finite()) {
            return Err(bad(row, "its time is not a finite number"));
        }
        if let Some(row) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(bad(row + 1, "its time is not later than the one before"));
        }
        for (at, (name, values)) in columns.iter().enumerate() {
            let known =
                description.input_infos().any(|(info, role)| role == InputRole::Value && info.name == *name);
            if !known || columns[..at].iter().any(|(other, _)| other == name) {
                return Err(SetupError::Input {
                    name: name.clone(),
                    known: names(description),
                    twice: known,
                });
            }
            if values.len() != times.len() {
                let (expected, found) = (times.len(), values.len());
                return Err(SetupError::Length { what: "values of an input", expected, found });
            }
            if let Some(row) = values.iter().position(|value| !value.is_finite()) {
                return Err(bad(row, "a value is not a finite number"));
            }
        }
        let roles = &description.inputs;
        let course = |(at, (info, role)): (usize, (&crate::description::ParameterInfo, InputRole))| {
            let given = columns.iter().find(|(name, _)| info.name == *name).map(|(_, values)| values.clone());
            let has_rates = roles.get(at + 1) == Some(&InputRole::RateOfPrevious);
            match (role, given) {
                (InputRole::RateOfPrevious, _) => Course::Rate,
                (InputRole::Value, None) => Course::Unconnected,
                (InputRole::Value, Some(values)) if has_rates => {
                    let bends = spline(&times, &values);
                    Course::Spline(values, bends)
                }
                (InputRole::Value, Some(values)) => Course::Linear(values),
            }
        };
        let courses = description.input_infos().enumerate().map(course).collect();
        Ok(Self { times, courses })
    }

    /// Whether an input has samples, by its place in [`Description::inputs`].
    pub fn connects(&self, input: usize) -> bool {
        matches!(self.courses.get(input), Some(Course::Linear(_) | Course::Spline(..)))
    }

    /// The piece at `t` by its first sample, and the time within it [s], none outside of all.
    fn piece(&self, t: f64) -> (usize, Option<f64>) {
        let last = self.times.len() - 1;
        // The last instant belongs to the last piece.
        let after = if t == self.times[last] { last } else { self.times.partition_point(|time| *time <= t) };
        match after.checked_sub(1) {
            None => (0, None),
            Some(first) if after > last => (first, None),
            Some(first) => (first, Some(t - self.times[first])),
        }
    }
}

impl Signals for SampledSignals {
    fn write(&self, t: f64, values: &mut [f64]) {
        let (at, within) = self.piece(t);
        for (place, course) in self.courses.iter().enumerate() {
            match (course, within) {
                (Course::Unconnected | Course::Rate, _) => {}
                (Course::Linear(samples), None) => values[place] = samples[at],
                (Course::Linear(samples), Some(within)) => {
                    let slope = (samples[at + 1] - samples[at]) / (self.times[at + 1] - self.times[at]);
                    values[place] = samples[at] + within * slope;
                }
                (Course::Spline(samples, _), None) => {
                    values[place..place + 3].copy_from_slice(&[samples[at], 0.0, 0.0]);
                }
                (Course::Spline(samples, bends), Some(within)) => {
                    let h = self.times[at + 1] - self.times[at];
                    let (y, m) = ([samples[at], samples[at + 1]], [bends[at], bends[at + 1]]);
                    let slope = (y[1] - y[0]) / h - h * (2.0 * m[0] + m[1]) / 6.0;
                    let growth = (m[1] - m[0]) / h;
                    let value = y[0] + within * (slope + within * (0.5 * m[0] + within * growth / 6.0));
                    let rate = slope + within * (m[0] + 0.5 * within * growth);
                    values[place..place + 3].copy_from_slice(&[value, rate, m[0] + within * growth]);
                }
            }
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.times.get(self.times.partition_point(|time| *time <= t)).copied()
    }

    fn span(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }
}

/// Names of the inputs, for a message.
fn names(description: &Description) -> String {
    let values = description.input_infos().filter(|(_, role)| *role == InputRole::Value);
    values.map(|(info, _)| info.name.to_string()).collect::<Vec<_>>().join(", ")
}

/// Second derivatives at the samples of the cubic spline whose first two and last two pieces are one cubic each: the
/// tridiagonal system of the inner samples by elimination. Two samples make a line, three a parabola.
fn spline(times: &[f64], values: &[f64]) -> Vec<f64> {
    let count = times.len();
    let mut bends = vec![0.0; count];
    if count < 3 {
        return bends;
    }
    let length = |i: usize| times[i + 1] - times[i];
    let slope = |i: usize| (values[i + 1] - values[i]) / length(i);
    if count == 3 {
        return vec![2.0 * (slope(1) - slope(0)) / (length(0) + length(1)); 3];
    }
    // What is left of the row above: its entry right of the diagonal and its right side.
    let (mut above, last) = (vec![(0.0, 0.0); count], count - 2);
    for i in 1..=last {
        let (before, after) = (length(i - 1), length(i));
        let (mut left, mut diagonal, mut right) = (before, 2.0 * (before + after), after);
        if i == 1 {
            (diagonal, right) =
                (diagonal + before + before * before / after, right - before * before / after);
        }
        if i == last {
            (diagonal, left) = (diagonal + after + after * after / before, left - after * after / before);
        }
        let pivot = diagonal - left * above[i - 1].0;
        let side = 6.0 * (slope(i) - slope(i - 1));
        above[i] = (right / pivot, (side - left * above[i - 1].1) / pivot);
    }
    bends[last] = above[last].1;
    for i in (1..last).rev() {
        bends[i] = above[i].1 - above[i].0 * bends[i + 1];
    }
    bends[0] = bends[1] - length(0) / length(1) * (bends[2] - bends[1]);
    bends[last + 1] = bends[last] + length(last) / length(last - 1) * (bends[last] - bends[last - 1]);
    bends
}

#[cfg(test)]
mod tests {
    use super::*;

    fn driven(times: Vec<f64>, values: Vec<f64>) -> SampledSignals {
        let bends = spline(&times, &values);
        SampledSignals { times, courses: vec![Course::Spline(values, bends), Course::Rate, Course::Rate] }
    }

    #[test]
    fn a_spline_meets_its_samples_and_has_the_rates_of_its_value() {
        let times: Vec<f64> = (0..9).map(|k| 0.1 * f64::from(k * k)).collect();
        let values: Vec<f64> = times.iter().map(|t| (1.3 * t).sin()).collect();
        let signals = driven(times.clone(), values.clone());
        let at = |t: f64| {
            let mut found = [0.0; 3];
            signals.write(t, &mut found);
            found
        };
        for (t, value) in times.iter().zip(&values) {
            // One rounding of numbers of about one.
            assert!((at(*t)[0] - value).abs() < 4e-16);
        }
        for t in [0.05, 0.3, 1.0, 2.9, 6.0] {
            let h = 1e-4;
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            // A cubic: the error of the difference is that of its third derivative, below one, times h^2/6, and rounding/h.
            assert!(((after[0] - before[0]) / (2.0 * h) - now[1]).abs() < 1e-8);
            assert!(((after[1] - before[1]) / (2.0 * h) - now[2]).abs() < 1e-8);
        }
    }

    #[test]
    fn a_cubic_is_met_with_its_rates_from_end_to_end() {
        let cubic = |t: f64| [t * (2.0 - t * (1.0 - 0.5 * t)), 2.0 - t * (2.0 - 1.5 * t), -2.0 + 3.0 * t];
        for count in 4..9 {
            let times: Vec<f64> = (0..count).map(|k| 0.3 * f64::from(k) + 0.02 * f64::from(k * k)).collect();
            let values = times.iter().map(|t| cubic(*t)[0]).collect();
            let signals = driven(times.clone(), values);
            for t in [0.0, 0.1, 0.5, times[times.len() - 1]] {
                let mut found = [0.0; 3];
                signals.write(t, &mut found);
                // Rounding of differences of numbers up to ten, over the square of a piece.
                found.iter().zip(cubic(t)).for_each(|(found, exact)| assert!((found - exact).abs() < 1e-11));
            }
        }
    }

    #[test]
    fn a_straight_line_is_a_straight_line() {
        let signals = driven(vec![0.0, 1.0, 3.0, 3.5], vec![1.0, 3.0, 7.0, 8.0]);
        let mut found = [0.0; 3];
        signals.write(2.25, &mut found);
        assert_eq!(found, [5.5, 2.0, 0.0]);
        signals.write(9.0, &mut found);
        assert_eq!(found, [8.0, 0.0, 0.0]);
        assert_eq!((signals.next_kink(1.0), signals.next_kink(3.5)), (Some(3.0), None));
    }
}
