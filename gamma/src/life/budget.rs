//! Error budget: how far a printed number may be off, and why. In: half-widths. Out: a table of them and their sum.
//! Never knows what the number is.

use std::fmt;

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
    /// Nothing tells how large it is. Says why.
    Unknown(&'static str),
}

impl Contribution {
    /// Half-width: 0 if the source does not arise, NaN if nothing tells.
    pub fn half_width(self) -> f64 {
        match self {
            Self::Random(half) | Self::Bound(half) => half,
            Self::None(_) => 0.0,
            Self::Unknown(_) => f64::NAN,
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
    /// From revolutions that had not settled when they were measured; nothing where none are measured.
    pub settling: Option<Contribution>,
    /// From the finite number of revolutions whose mean was taken; nothing where none are measured.
    pub averaging: Option<Contribution>,
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
    pub fn parts(&self) -> impl Iterator<Item = (&'static str, Contribution)> {
        let parts = [
            ("monte_carlo", Some(self.monte_carlo)),
            ("table", Some(self.table)),
            ("settling", self.settling),
            ("averaging", self.averaging),
            ("parameters", Some(self.parameters)),
        ];
        parts.into_iter().filter_map(|(name, part)| Some((name, part?)))
    }

    /// Half-width of all together, if all are known.
    pub fn known_total(&self) -> Option<f64> {
        let is_known = self.parts().all(|(_, part)| !matches!(part, Contribution::Unknown(_)));
        is_known.then(|| self.total())
    }

    /// Half-width of all together, but for what is unknown.
    pub fn total(&self) -> f64 {
        let (mut squares, mut bounds) = (0.0, 0.0);
        for (_, part) in self.parts() {
            match part {
                Contribution::Random(half) => squares += half * half,
                Contribution::Bound(half) => bounds += half,
                Contribution::None(_) | Contribution::Unknown(_) => {}
            }
        }
        libm::sqrt(squares) + bounds
    }
}

impl fmt::Display for ErrorBudget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rest = "";
        for (name, part) in self.parts() {
            let name = if name == "monte_carlo" { "Monte Carlo" } else { name };
            match part {
                Contribution::Random(half) => writeln!(f, "  {name:<12}+- {half:.3e}")?,
                Contribution::Bound(half) => writeln!(f, "  {name:<12}+- {half:.3e} (bound)")?,
                Contribution::None(reason) => writeln!(f, "  {name:<12}none: {reason}")?,
                Contribution::Unknown(reason) => {
                    rest = ", and what is unknown";
                    writeln!(f, "  {name:<12}unknown: {reason}")?;
                }
            }
        }
        write!(f, "  {:<12}+- {:.3e}{rest}", "total", self.total())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: Contribution = Contribution::None("closed form");
    const EXACT: ErrorBudget =
        ErrorBudget { monte_carlo: NONE, table: NONE, settling: None, averaging: None, parameters: NONE };

    #[test]
    fn random_parts_add_as_squares_and_bounds_as_they_are() {
        let budget = ErrorBudget {
            monte_carlo: Contribution::Random(2.0),
            table: Contribution::Bound(0.25),
            settling: Some(Contribution::Bound(0.25)),
            averaging: Some(Contribution::Random(5.0_f64.sqrt())),
            parameters: Contribution::Random(4.0),
        };
        assert!((budget.total() - 5.5).abs() < 1e-15);
        let text = budget.to_string();
        assert!(
            text.contains("table       +- 2.500e-1 (bound)") && text.contains("total       +- 5.500e0"),
            "{text}"
        );
    }

    #[test]
    fn a_source_that_does_not_arise_says_why() {
        let budget = ErrorBudget { parameters: Contribution::Random(1.0), ..EXACT };
        assert!(budget.to_string().contains("Monte Carlo none: closed form"), "{budget}");
        assert_eq!(budget.total(), 1.0);
    }

    #[test]
    fn what_nobody_knows_is_not_zero() {
        let budget = ErrorBudget { settling: Some(Contribution::Unknown("no turn before")), ..EXACT };
        let text = budget.to_string();
        assert!(text.contains("settling    unknown: no turn before"), "{text}");
        assert!(text.ends_with("total       +- 0.000e0, and what is unknown"), "{text}");
        assert_eq!((budget.known_total(), EXACT.known_total()), (None, Some(0.0)));
    }
}
