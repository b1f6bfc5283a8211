//! The distribution of lives in numbers. In: failures of trajectories. Out: [`Summary`], plain data to print.
//! Never knows how they came about.

use super::state::{CycleRecord, FailureEvent};

/// Lives of all trajectories, in cycles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Summary {
    /// Mean life, interpolated within the last cycle.
    pub mean: f64,
    /// Standard deviation (over n - 1); zero for one trajectory.
    pub std: f64,
    /// Standard deviation over mean.
    pub cov: f64,
    /// Quantiles, linear between ordered lives.
    pub quantiles: Quantiles,
    /// Mean life as inspections after whole cycles see it.
    pub mean_whole_cycles: f64,
    /// Number of trajectories.
    pub trajectories: u64,
    /// Seed of the draws.
    pub seed: u64,
    /// Cycles of the deterministic life, or of the first trajectory.
    pub cycles: Vec<CycleRecord>,
}

/// Lives that a part of the trajectories does not reach.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Quantiles {
    /// 10 % fail before.
    pub p10: f64,
    /// Half fail before.
    pub p50: f64,
    /// 90 % fail before.
    pub p90: f64,
}

impl Summary {
    /// Sums up lives, in the order of their trajectories; nothing if there are none.
    pub fn of(failures: &[FailureEvent], seed: u64, cycles: Vec<CycleRecord>) -> Option<Self> {
        if failures.is_empty() {
            return None;
        }
        let count = failures.len() as f64;
        let mean = failures.iter().map(|failure| failure.cycles).sum::<f64>() / count;
        let square = |failure: &FailureEvent| (failure.cycles - mean) * (failure.cycles - mean);
        let squares: f64 = failures.iter().map(square).sum();
        let std = if failures.len() > 1 { libm::sqrt(squares / (count - 1.0)) } else { 0.0 };
        let whole: f64 = failures.iter().map(|failure| failure.whole_cycles as f64).sum();
        let mut lives: Vec<f64> = failures.iter().map(|failure| failure.cycles).collect();
        lives.sort_by(f64::total_cmp);
        Some(Self {
            mean,
            std,
            cov: std / mean,
            quantiles: Quantiles {
                p10: quantile(&lives, 0.1),
                p50: quantile(&lives, 0.5),
                p90: quantile(&lives, 0.9),
            },
            mean_whole_cycles: whole / count,
            trajectories: failures.len() as u64,
            seed,
            cycles,
        })
    }
}

/// Of ordered values, at least one.
fn quantile(ordered: &[f64], part: f64) -> f64 {
    let place = part * (ordered.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(ordered.len() - 1);
    ordered[below] + (place - below as f64) * (ordered[above] - ordered[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lives(cycles: &[f64]) -> Vec<FailureEvent> {
        let failure =
            |cycles: &f64| FailureEvent { joint: 0, cycles: *cycles, whole_cycles: cycles.ceil() as u64 };
        cycles.iter().map(failure).collect()
    }

    #[test]
    fn numbers_of_five_lives_are_those_computed_by_hand() {
        let summary = Summary::of(&lives(&[12.5, 10.0, 11.5, 14.0, 12.0]), 7, Vec::new()).unwrap();
        // Whole cycles 13, 10, 12, 14, 12: 61.
        assert_eq!((summary.mean, summary.mean_whole_cycles), (12.0, 12.2));
        // Squares 0.25, 4, 0.25, 4, 0: 8.5 over 4.
        assert_eq!((summary.std, summary.cov), (2.125_f64.sqrt(), 2.125_f64.sqrt() / 12.0));
        // Places 0.4, 2, 3.6 in 10, 11.5, 12, 12.5, 14; one rounding.
        assert!((summary.quantiles.p10 - 10.6).abs() < 1e-14 && (summary.quantiles.p90 - 13.4).abs() < 1e-14);
        assert_eq!((summary.quantiles.p50, summary.trajectories, summary.seed), (12.0, 5, 7));
    }

    #[test]
    fn one_life_has_no_scatter_and_none_no_summary() {
        let summary = Summary::of(&lives(&[25.1]), 0, Vec::new()).unwrap();
        assert_eq!((summary.mean, summary.std, summary.mean_whole_cycles), (25.1, 0.0, 26.0));
        assert_eq!(summary.quantiles, Quantiles { p10: 25.1, p50: 25.1, p90: 25.1 });
        assert_eq!(Summary::of(&[], 0, Vec::new()), None);
    }
}
