//! The unit of length in which assembly compares residuals with tolerances and lengths with angles: the mechanism's own longest
//! lever arm, so that a tolerance means the same share of every mechanism, and a drawing of another scale starts as this one.
//! In: a mechanism at its guess. Out: factors of rows and speeds. Never solves.

use crate::evaluate::Evaluator;

/// What rows and speeds are multiplied with.
pub(super) struct Units {
    /// The longest lever arm [m].
    pub arm: f64,
    /// Residual of every row, kept or dropped, times this: a pure number.
    pub rows: Vec<f64>,
    /// Pure number times this: a free speed, or its step.
    pub speeds: Vec<f64>,
}

impl Units {
    /// Measures the lever arms at a position.
    pub(super) fn new(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64], v: &[f64]) -> Self {
        let description = evaluator.description();
        let arm = evaluator.longest_arm(t, q, v);
        let speed = |unit: &str| if unit == "m/s" { arm } else { 1.0 };
        Self {
            arm,
            rows: description.rows.iter().map(|row| if row.angular { 1.0 } else { 1.0 / arm }).collect(),
            speeds: description.speeds.iter().map(|info| speed(&info.unit)).collect(),
        }
    }

    /// Brings a Jacobian of some rows by all speeds to pure numbers.
    pub(super) fn scale(&self, jacobian: &mut [f64], rows: impl IntoIterator<Item = usize>) {
        for (line, row) in jacobian.chunks_exact_mut(self.speeds.len().max(1)).zip(rows) {
            line.iter_mut().zip(&self.speeds).for_each(|(entry, unit)| *entry *= self.rows[row] * unit);
        }
    }

    /// Brings a step from pure numbers to SI.
    pub(super) fn restore(&self, step: &mut [f64]) {
        step.iter_mut().zip(&self.speeds).for_each(|(x, unit)| *x *= unit);
    }
}
