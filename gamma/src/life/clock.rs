//! How exposure Lambda runs with time, [CS (22)]. In: a time. Out: Lambda and its rate. Never knows wear.

use crate::error::{LifeError, positive};

/// Logarithm of a quotient of two exposures beyond which the smaller one does not count.
const FAR: f64 = 700.0;

/// Exposure as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub enum Clock {
    /// Lambda = (rate t)^exponent; exponent 1 is a steady load.
    Power {
        /// Exposure per unit of time.
        rate: f64,
        /// Exponent.
        exponent: f64,
    },
    /// Straight lines between rows of (time, Lambda); the first and last line go on beyond the table.
    Table(Vec<(f64, f64)>),
}

impl Clock {
    /// Lambda = rate t.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn linear(rate: f64) -> Result<Self, LifeError> {
        Self::power(rate, 1.0)
    }

    /// Lambda = (rate t)^exponent.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn power(rate: f64, exponent: f64) -> Result<Self, LifeError> {
        Ok(Self::Power { rate: positive("rate", rate)?, exponent: positive("exponent", exponent)? })
    }

    /// Rows of (time, Lambda), both strictly rising, as the cycles of a computed life.
    ///
    /// # Errors
    /// [`LifeError::ShortTable`], [`LifeError::TableOrder`].
    pub fn table(rows: Vec<(f64, f64)>) -> Result<Self, LifeError> {
        if rows.len() < 2 {
            return Err(LifeError::ShortTable { rows: rows.len() });
        }
        for (at, pair) in rows.windows(2).enumerate() {
            for (what, before, value) in [("time", pair[0].0, pair[1].0), ("exposure", pair[0].1, pair[1].1)]
            {
                // Written so that NaN is refused too.
                let rises = value > before && value.is_finite() && before.is_finite();
                if !rises {
                    return Err(LifeError::TableOrder { row: at + 2, what, value, before });
                }
            }
        }
        Ok(Self::Table(rows))
    }

    /// Lambda at time `t`.
    pub fn exposure(&self, t: f64) -> f64 {
        match self {
            Self::Power { rate, .. } => self.power_of(rate * t),
            Self::Table(rows) => {
                let (a, b) = interval(rows, t);
                a.1 + (b.1 - a.1) * ((t - a.0) / (b.0 - a.0))
            }
        }
    }

    /// Lambda gained from time `now` until `t` later: no small difference, however late it is.
    pub fn gained(&self, now: f64, t: f64) -> f64 {
        match self {
            Self::Power { rate, exponent } if *exponent == 1.0 || now <= 0.0 => self.power_of(rate * t),
            Self::Power { exponent, .. } if exponent * libm::log1p(t / now) < FAR => {
                self.exposure(now) * libm::expm1(exponent * libm::log1p(t / now))
            }
            _ => self.exposure(now + t) - self.exposure(now),
        }
    }

    /// How long after time `now` so much Lambda is gained.
    pub fn until(&self, now: f64, gained: f64) -> f64 {
        let before = self.exposure(now);
        match self {
            Self::Power { exponent, .. } if *exponent == 1.0 || now <= 0.0 => self.time(gained),
            Self::Power { exponent, .. } if libm::log1p(gained / before) / exponent < FAR => {
                now * libm::expm1(libm::log1p(gained / before) / exponent)
            }
            _ => self.time(before + gained) - now,
        }
    }

    /// The rate of a steady load; none of another.
    pub(crate) fn steady(&self) -> Option<f64> {
        match self {
            Self::Power { rate, exponent } if *exponent == 1.0 => Some(*rate),
            _ => None,
        }
    }

    /// dLambda/dt at time `t`; of a table, the slope on the right of `t`.
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Self::Power { rate, exponent } => rate * exponent * libm::pow(rate * t, exponent - 1.0),
            Self::Table(rows) => {
                let (a, b) = interval(rows, t);
                (b.1 - a.1) / (b.0 - a.0)
            }
        }
    }

    /// Time at which Lambda is `exposure`.
    pub fn time(&self, exposure: f64) -> f64 {
        match self {
            Self::Power { rate, exponent } => libm::pow(exposure, 1.0 / exponent) / rate,
            Self::Table(rows) => {
                let at = rows.partition_point(|row| row.1 <= exposure).clamp(1, rows.len() - 1);
                let (a, b) = (rows[at - 1], rows[at]);
                a.0 + (b.0 - a.0) * ((exposure - a.1) / (b.1 - a.1))
            }
        }
    }

    /// A load run through, by the exponent; a table has none.
    fn power_of(&self, load: f64) -> f64 {
        match self {
            Self::Power { exponent, .. } if *exponent != 1.0 => libm::pow(load, *exponent),
            _ => load,
        }
    }

    /// Power of time that Lambda grows with in the long run.
    pub fn growth(&self) -> f64 {
        match self {
            Self::Power { exponent, .. } => *exponent,
            Self::Table(_) => 1.0,
        }
    }

    /// Times where the rate jumps, between which Lambda is smooth.
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Power { .. } => Vec::new(),
            Self::Table(rows) => rows.iter().map(|row| row.0).collect(),
        }
    }

    /// Last time of a table: beyond it Lambda is extrapolated.
    pub fn end(&self) -> Option<f64> {
        match self {
            Self::Power { .. } => None,
            Self::Table(rows) => rows.last().map(|row| row.0),
        }
    }
}

/// The two rows whose line holds at `t`.
fn interval(rows: &[(f64, f64)], t: f64) -> ((f64, f64), (f64, f64)) {
    let at = rows.partition_point(|row| row.0 <= t).clamp(1, rows.len() - 1);
    (rows[at - 1], rows[at])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_and_exposure_are_inverse() {
        let table = Clock::table(vec![(0.0, 0.0), (1.0, 2.0), (4.0, 3.0)]).expect("rising");
        for clock in [Clock::linear(0.3).expect("valid"), Clock::power(2.0, 0.2).expect("valid"), table] {
            for t in [0.1, 0.9, 1.0, 3.7, 9.0] {
                // Powers by 1/0.2 lose a digit or two.
                assert!((clock.time(clock.exposure(t)) - t).abs() < 1e-13 * (1.0 + t), "{clock:?} {t}");
            }
        }
    }

    #[test]
    fn what_is_gained_late_keeps_its_digits() {
        let table = Clock::table(vec![(0.0, 0.0), (1.0, 2.0), (4.0, 3.0)]).expect("rising");
        for clock in [Clock::linear(0.3).expect("valid"), Clock::power(2.0, 0.2).expect("valid"), table] {
            for (now, t) in [(0.0, 2.0), (0.7, 1e-3), (3.0, 2.0), (1e-3, 50.0)] {
                let plain = clock.exposure(now + t) - clock.exposure(now);
                // The plain difference loses up to four digits.
                assert!((clock.gained(now, t) / plain - 1.0).abs() < 1e-11, "{clock:?} {now} {t}");
                assert!(
                    (clock.until(now, clock.gained(now, t)) / t - 1.0).abs() < 1e-10,
                    "{clock:?} {now} {t}"
                );
            }
        }
        for exponent in [0.4, 1.0, 2.5] {
            let clock = Clock::power(0.5, exponent).expect("valid");
            for now in [1e9, 1e17, 1e40] {
                // So late Lambda is a straight line: the next term is t / now.
                let slope = clock.rate(now) * 3.0;
                assert!((clock.gained(now, 3.0) / slope - 1.0).abs() < 1e-8, "{exponent} {now}");
                assert!((clock.until(now, slope) / 3.0 - 1.0).abs() < 1e-8, "{exponent} {now}");
            }
        }
    }

    #[test]
    fn rate_is_the_derivative() {
        let clock = Clock::power(2.0, 0.6).expect("valid");
        let slope = (clock.exposure(1.5 + 1e-6) - clock.exposure(1.5 - 1e-6)) / 2e-6;
        // Central difference: rounding 1e-16 / 1e-6.
        assert!((slope - clock.rate(1.5)).abs() < 1e-9);
    }

    #[test]
    fn a_table_that_falls_names_its_row() {
        let error = Clock::table(vec![(0.0, 0.0), (1.0, 2.0), (2.0, 1.5)]).expect_err("falls");
        assert_eq!(error, LifeError::TableOrder { row: 3, what: "exposure", value: 1.5, before: 2.0 });
        let error = Clock::table(vec![(0.0, 0.0), (f64::NAN, 2.0)]).expect_err("no number");
        assert!(error.to_string().contains("row 2"), "{error}");
        assert_eq!(Clock::table(vec![(0.0, 0.0)]), Err(LifeError::ShortTable { rows: 1 }));
    }
}
