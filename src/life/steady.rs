//! What turns that had not settled, or that differ from each other, do to a life. In: measurements along a life, each with how
//! steady its turns were. Out: relative errors of the life. Never knows how turns are run.
//!
//! A life is the sum of dW over the wear per revolution, so that an error of a measurement counts by the part of the life that is
//! spent near it: half the way to the measurements on either side.

use linkwear_runtime::Steadiness;
use serde::{Deserialize, Serialize};

/// One measurement of a joint.
pub(super) struct Steady {
    /// W [m] it was made at.
    pub worn: f64,
    pub turns: Steadiness,
}

/// Relative errors of a life; nothing where no two turns could be compared.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct TurnErrors {
    /// What one more turn to settle would change, all measurements together: those that drift alike add.
    pub settling: Option<f64>,
    /// Standard error by the scatter of the turns, measurements being independent.
    pub averaging: Option<f64>,
}

impl TurnErrors {
    pub(super) fn of(mut measurements: Vec<Steady>) -> Self {
        measurements.sort_by(|a, b| a.worn.total_cmp(&b.worn));
        let last = measurements.len().saturating_sub(1);
        let time = |at: usize| {
            let (before, after) = (&measurements[at.saturating_sub(1)], &measurements[(at + 1).min(last)]);
            let wear = measurements[at].turns.wear;
            if wear > 0.0 { (after.worn - before.worn) / wear } else { 0.0 }
        };
        let mut times: Vec<f64> = (0..measurements.len()).map(time).collect();
        let mut all: f64 = times.iter().sum();
        if all == 0.0 {
            // All at one place, as without feedback.
            times.fill(1.0);
            all = times.len() as f64;
        }
        let parts = || measurements.iter().zip(&times).map(|(one, time)| (one.turns, time / all));
        let settling = parts().map(|(turns, part)| Some(part * turns.drift?)).sum::<Option<f64>>();
        let square = |(turns, part): (Steadiness, f64)| turns.scatter.map(|scatter| (part * scatter).powi(2));
        let averaging = parts().map(square).sum::<Option<f64>>();
        Self { settling: settling.map(f64::abs), averaging: averaging.map(f64::sqrt) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(worn: f64, wear: f64, drift: f64, scatter: f64) -> Steady {
        Steady { worn, turns: Steadiness { wear, drift: Some(drift), scatter: Some(scatter) } }
    }

    #[test]
    fn a_measurement_counts_by_the_time_that_is_spent_near_it() {
        // Twice as fast in the second half: a third of the life; ends count half.
        let errors =
            TurnErrors::of(vec![at(0.0, 1.0, 0.01, 0.0), at(2.0, 2.0, 0.0, 0.0), at(1.0, 1.0, 0.0, 0.03)]);
        // Times 1, 2, 1/2 of 3.5.
        assert!((errors.settling.expect("a drift") - 0.01 / 3.5).abs() < 1e-15, "{errors:?}");
        assert!((errors.averaging.expect("a scatter") - 0.03 * 2.0 / 3.5).abs() < 1e-15, "{errors:?}");
    }

    #[test]
    fn drifts_of_one_sign_add_and_scatter_cancels() {
        let many = || (0..100).map(|k| at(f64::from(k), 1.0, 0.01, 0.01)).collect();
        let errors = TurnErrors::of(many());
        assert!((errors.settling.expect("a drift") - 0.01).abs() < 1e-12);
        assert!((errors.averaging.expect("a scatter") - 0.001).abs() < 1e-5);
        let alone = Steadiness { wear: 1.0, drift: None, scatter: None };
        let unknown = TurnErrors::of(vec![Steady { worn: 0.0, turns: alone }]);
        assert_eq!(unknown, TurnErrors { settling: None, averaging: None });
    }
}
