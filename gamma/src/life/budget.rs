//! Error budget: how far a printed number may be off, and why. In: half-widths. Out: a table of them and their sum.
//! Never knows what the number is.

use std::fmt;

use serde_json::{Map, Value, json};

use super::band::Band;
use super::statistics::WithError;

/// Half-widths that a 95 % interval of a normal law has, in standard errors.
const Z95: f64 = 1.959_963_984_540_054;

/// One source of error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contribution {
    /// Random: the half-width of its 95 % interval.
    Random(f64),
    /// A bound of unknown sign.
    Bound(f64),
    /// Does not arise: exact formula, no table, known parameters. Says which.
    None(&'static str),
}

impl Contribution {
    /// Half-width, 0 if the source does not arise.
    pub fn half_width(self) -> f64 {
        match self {
            Self::Random(half) | Self::Bound(half) => half,
            Self::None(_) => 0.0,
        }
    }
}

/// Half-widths at 95 % of one number, in its own unit.
///
/// Independent random parts add as squares, bounds add as they are: total = sqrt(sum of random²) + sum of bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBudget {
    /// From the finite number of trajectories.
    pub monte_carlo: Contribution,
    /// From the table of wear per revolution, or of a quadrature.
    pub table: Contribution,
    /// From the uncertainty of estimated parameters.
    pub parameters: Contribution,
}

impl ErrorBudget {
    /// Monte-Carlo part of a statistic of lives.
    pub fn monte_carlo(statistic: WithError) -> Contribution {
        Self::random(statistic.error)
    }

    /// Random part from a standard error.
    pub fn random(standard_error: f64) -> Contribution {
        Contribution::Random(Z95 * standard_error)
    }

    /// Parameter part from a 95 % band.
    pub fn parameters(band: Band) -> Contribution {
        Contribution::Random(band.half_width())
    }

    /// The parts with their names.
    pub fn parts(&self) -> [(&'static str, Contribution); 3] {
        [("monte_carlo", self.monte_carlo), ("table", self.table), ("parameters", self.parameters)]
    }

    /// The contributions with their kinds and reasons, and the total.
    pub fn to_json(&self) -> Value {
        let entry = |part: Contribution| match part {
            Contribution::Random(half) => json!({ "half_width": half, "kind": "random" }),
            Contribution::Bound(half) => json!({ "half_width": half, "kind": "bound" }),
            Contribution::None(reason) => json!({ "half_width": 0.0, "kind": "none", "reason": reason }),
        };
        let parts = self.parts().into_iter().map(|(name, part)| (name.to_owned(), entry(part)));
        parts.chain([("total".to_owned(), json!(self.total()))]).collect()
    }

    /// The half-widths alone, as `life` has them, and the total.
    pub fn half_widths_json(&self) -> Value {
        let parts = self.parts().into_iter().map(|(name, part)| (name.to_owned(), json!(part.half_width())));
        json!({ "half_widths_95": parts.collect::<Map<_, _>>(), "total": self.total() })
    }

    /// Half-width of all together.
    pub fn total(&self) -> f64 {
        let (mut squares, mut bounds) = (0.0, 0.0);
        for (_, part) in self.parts() {
            match part {
                Contribution::Random(half) => squares += half * half,
                Contribution::Bound(half) => bounds += half,
                Contribution::None(_) => {}
            }
        }
        libm::sqrt(squares) + bounds
    }
}

impl fmt::Display for ErrorBudget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = ["Monte Carlo", "table", "parameters"];
        for (name, (_, part)) in names.iter().zip(self.parts()) {
            match part {
                Contribution::Random(half) => writeln!(f, "  {name:<12}+- {half:.3e}")?,
                Contribution::Bound(half) => writeln!(f, "  {name:<12}+- {half:.3e} (bound)")?,
                Contribution::None(reason) => writeln!(f, "  {name:<12}none: {reason}")?,
            }
        }
        write!(f, "  {:<12}+- {:.3e}", "total", self.total())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_parts_add_as_squares_and_bounds_as_they_are() {
        let budget = ErrorBudget {
            monte_carlo: Contribution::Random(3.0),
            table: Contribution::Bound(0.5),
            parameters: Contribution::Random(4.0),
        };
        assert_eq!(budget.total(), 5.5);
        let text = budget.to_string();
        assert!(
            text.contains("table       +- 5.000e-1 (bound)") && text.contains("total       +- 5.500e0"),
            "{text}"
        );
    }

    #[test]
    fn a_source_that_does_not_arise_says_why() {
        let none = Contribution::None("closed form");
        let budget = ErrorBudget { monte_carlo: none, table: none, parameters: Contribution::Random(1.0) };
        assert!(budget.to_string().contains("Monte Carlo none: closed form"), "{budget}");
        assert_eq!(budget.total(), 1.0);
    }
}
