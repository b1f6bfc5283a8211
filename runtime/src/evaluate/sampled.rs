//! Controllers that act at sampled times: when, which speeds they hold between their samples, and which columns say what they hold
//! next. In: a description, a system with values of its parameters. Out: [`Sampled`]. Never takes a step.

use crate::description::Description;
use crate::error::SetupError;
use crate::system::{Entry, System};

/// Times this close to one another, in parts of themselves, are the same time: rows and samples are multiples of different
/// numbers, each with a rounding of its own.
const SAME: f64 = 4.0 * f64::EPSILON;

/// One controller.
pub(super) struct Sampled {
    /// Time from sample to sample [s]: it acts at its multiples.
    period: f64,
    /// Column of what it holds next, and speed that holds it.
    pub(super) held: Vec<(usize, usize)>,
}

impl Sampled {
    /// Its first sample behind `t`, not at it.
    pub(super) fn after(&self, t: f64) -> f64 {
        let bound = t + same(t);
        let first = (bound / self.period).floor();
        // The quotient may be rounded to either side of a whole number.
        let found = (0..3).map(|more| (first + f64::from(more)) * self.period).find(|time| *time > bound);
        found.unwrap_or_else(|| bound.next_up())
    }

    /// Whether it acts at `t`, which a step from `from` ends at.
    pub(super) fn acts(&self, from: f64, t: f64) -> bool {
        self.after(from) <= t + same(t)
    }

    /// Whether a run that begins at `t` begins with a sample.
    pub(super) fn begins(&self, t: f64) -> bool {
        ((t / self.period).round() * self.period - t).abs() <= same(t)
    }
}

/// How far times may be apart that count as one [s].
pub(super) fn same(t: f64) -> f64 {
    SAME * t.abs()
}

/// The controllers of a mechanism.
pub(super) fn sampled(
    system: &dyn System<f64>,
    description: &Description,
    parameters: &[f64],
) -> Result<Vec<Sampled>, SetupError> {
    let columns = description.samplers();
    if columns.is_empty() {
        return Ok(Vec::new());
    }
    // Sample times are constants among the columns, whatever the state.
    let sizes = system.sizes();
    let mut input = vec![0.0; sizes.input(Entry::Observe)];
    input[..parameters.len()].copy_from_slice(parameters);
    let (mut output, mut workspace) = (vec![0.0; sizes.channels], vec![0.0; sizes.workspace]);
    system.evaluate(Entry::Observe, &input, &mut output, &mut workspace);
    let made = columns.into_iter().map(|(column, held)| {
        let period = output[column];
        if period.is_finite() && period > 0.0 {
            return Ok(Sampled { period, held });
        }
        Err(SetupError::Setting { name: "sample time", value: period, need: "above zero" })
    });
    made.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_is_met_once_however_steps_end() {
        for period in [0.1, 0.3, 1e-3, 1.0 / 3.0, 0.7e-4] {
            let own = Sampled { period, held: Vec::new() };
            // Steps that end at samples, a last place before or behind them, and in between.
            let ends = (1..2000).flat_map(|k| {
                let at = f64::from(k) * period;
                let beside = match k % 4 {
                    0 => at,
                    1 => at.next_down(),
                    2 => at.next_up(),
                    _ => at.next_down().next_down(),
                };
                [beside, beside.next_up(), at + 0.4 * period]
            });
            let (mut from, mut count) = (0.0, u64::from(own.begins(0.0)));
            for end in ends.filter(|end| *end > 0.0) {
                if end > from {
                    count += u64::from(own.acts(from, end));
                    from = end;
                }
            }
            assert_eq!(count, 2000, "{period}");
        }
    }

    #[test]
    fn the_next_sample_is_behind() {
        let own = Sampled { period: 0.1, held: Vec::new() };
        assert_eq!(own.after(0.0), 0.1);
        assert_eq!(own.after(-0.05), 0.0);
        assert_eq!(own.after(0.3), 4.0 * 0.1);
        assert_eq!(own.after(3.0 * 0.1), 4.0 * 0.1);
        assert!(own.begins(0.3) && own.begins(0.0) && !own.begins(0.05));
    }
}
