//! The law of the likelihood ratio for differences between units, of few units. In: how many there are, how far their means are
//! apart. Out: probabilities and critical values. Never knows data.
//!
//! Exact for a Wiener process whose units have equal exposures: there the ratio goes by F, that of the variances between and within
//! units over its expectation. With x = F (k - 1) / k, k units, d degrees of freedom within them, n = k + d, and 1 + r the expected
//! ratio at the differences that are tested, twice the log-likelihood falls from its maximum by
//!
//! ```text
//! n ln([k x + d] / n) - k ln x                              for x > 1 / (1 + r), else no difference fits best:
//! n ln([k x + d] / [k x (1 + r) + d]) + k ln(1 + r)
//! ```
//!
//! For many units and readings it goes over into chi-square, and where none is tested into half of it; that is too narrow for intervals
//! from a few and too wide for the test (C. M. Crainiceanu, D. Ruppert, J. R. Stat. Soc. B 66 (2004) 165). How well the law does
//! for other processes is shown by the benches of docs/units-that-differ.md.

use crate::special::{f_above, rising_root};

/// So many units of equal exposures, and degrees of freedom within them.
#[derive(Clone, Copy, Debug)]
pub struct FewUnits {
    pub units: f64,
    pub degrees: f64,
}

impl FewUnits {
    fn fall(&self, x: f64, apart: f64) -> f64 {
        let Self { units: k, degrees: d } = self;
        if x * (1.0 + apart) > 1.0 {
            return (k + d) * libm::log1p(k * (x - 1.0) / (k + d)) - k * libm::log(x);
        }
        k * libm::log1p(apart) - (k + d) * libm::log1p(k * x * apart / (k * x + d))
    }

    /// Probability that x is above a number, and below it.
    fn tails(&self, x: f64) -> [f64; 2] {
        let above = f_above(self.units - 1.0, self.degrees, x * self.units / (self.units - 1.0));
        [above, 1.0 - above]
    }

    /// Probability of a fall of at least `least` > 0, where the variance that differences add to a unit's total is `apart` times that
    /// within it.
    pub fn probability(&self, least: f64, apart: f64) -> f64 {
        let start = libm::sqrt(2.0 * least / self.units);
        let high = 1.0 + rising_root(&|more| self.fall(1.0 + more, apart) - least, start);
        let from_above = self.tails(high)[0];
        if self.units * libm::log1p(apart) <= least {
            return from_above;
        }
        let low = 1.0 / (1.0 + rising_root(&|more| self.fall(1.0 / (1.0 + more), apart) - least, start));
        from_above + self.tails(low)[1]
    }

    /// The fall that is exceeded with probability 1 - `level`.
    pub fn critical(&self, apart: f64, level: f64) -> f64 {
        // Chi-square at 95 %.
        rising_root(&|least| 1.0 - level - self.probability(least, apart), 3.84)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::gamma_q;

    #[test]
    fn many_units_have_the_chi_square_law() {
        let law = FewUnits { units: 1e5, degrees: 1e6 };
        for least in [0.5, 3.84, 6.63] {
            let chi_square = gamma_q(0.5, 0.5 * least);
            // Second order in 1 / units, and rounding of ten digits of a million.
            assert!((law.probability(least, 2.0) / chi_square - 1.0).abs() < 1e-4, "{least}");
            // Without differences, half of it: x is below 1 in a little more than half of all cases.
            assert!((2.0 * law.probability(least, 0.0) / chi_square - 1.0).abs() < 0.02, "{least}");
        }
    }

    #[test]
    fn critical_values_are_those_of_drawn_ratios() {
        // Quantiles at 95 % of 400,000 falls drawn by an independent program (numpy 2), +- 0.02.
        for (units, degrees, apart, expected) in [
            (20.0, 100.0, 3.0, 4.151),
            (20.0, 100.0, 1.0, 4.112),
            (20.0, 100.0, 0.3, 2.638),
            (20.0, 100.0, 0.01, 2.069),
            (10.0, 80.0, 3.0, 4.569),
            (5.0, 45.0, 3.0, 4.808),
            (50.0, 450.0, 3.0, 3.976),
        ] {
            let found = FewUnits { units, degrees }.critical(apart, 0.95);
            assert!((found - expected).abs() < 0.03, "{units} {degrees} {apart}: {found} {expected}");
        }
    }
}
