//! First passage of a process in closed form, where exposure is a known function of time.
//! In: law, clock, present time, wear that is left. Out: a [`Lifetime`]. Never knows uncertainty of parameters.
//!
//! For a process that does not fall, such as the Gamma process [CS (21)], T <= t means W(t) >= threshold:
//!
//! ```text
//! P(T <= t) = Q(alpha [Lambda(now + t) - Lambda(now)], beta [threshold - current])
//! ```

use super::clock::Clock;
use super::law::Law;
use super::lifetime::{Lifetime, Moments, integrated_moments};
use crate::error::{LifeError, non_negative, positive};

/// Remaining life of one joint; time runs from the present, in the clock's unit.
#[derive(Clone, Debug)]
pub struct FirstPassage {
    law: Law,
    clock: Clock,
    now: f64,
    left: f64,
}

impl FirstPassage {
    /// A new joint: clock at 0, no wear.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`] for the threshold.
    pub fn new(law: Law, clock: Clock, threshold: f64) -> Result<Self, LifeError> {
        Self::from(law, clock, threshold, 0.0, 0.0)
    }

    /// A joint that has worn to `current` at time `now` of its clock.
    ///
    /// # Errors
    /// [`LifeError::Failed`] if nothing is left to wear, [`LifeError::Negative`], [`LifeError::NotPositive`].
    pub fn from(law: Law, clock: Clock, threshold: f64, current: f64, now: f64) -> Result<Self, LifeError> {
        positive("the threshold", threshold)?;
        non_negative("the present wear", current)?;
        non_negative("the present time", now)?;
        if current >= threshold {
            return Err(LifeError::Failed { threshold, current });
        }
        Ok(Self::with_left(law, clock, threshold - current, now))
    }

    /// A joint with `left` > 0 to wear at time `now` of its clock.
    pub(crate) fn with_left(law: Law, clock: Clock, left: f64, now: f64) -> Self {
        Self { law, clock, now, left }
    }

    /// Exposure gained until `t` from now; none before.
    pub fn exposure(&self, t: f64) -> f64 {
        self.clock.gained(self.now, t.max(0.0)).max(0.0)
    }

    /// Reliability if exposure runs `factor` times as fast.
    pub fn reliability_at(&self, t: f64, factor: f64) -> f64 {
        self.law.survival(factor * self.exposure(t), self.left)
    }

    /// Probability of failure until `t` if exposure runs `factor` times as fast.
    pub fn failed_at(&self, t: f64, factor: f64) -> f64 {
        self.law.failure(factor * self.exposure(t), self.left)
    }

    /// Hazard if exposure runs `factor` times as fast.
    pub fn hazard_at(&self, t: f64, factor: f64) -> f64 {
        let rate = factor * self.clock.rate(self.now + t.max(0.0));
        rate * self.law.hazard(factor * self.exposure(t), self.left)
    }

    /// The law of its wear.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// The clock it wears by.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Probability of outliving the clock's table, beyond which exposure is extrapolated; 0 without a table.
    pub fn beyond_table(&self) -> f64 {
        self.clock.end().map_or(0.0, |end| self.reliability((end - self.now).max(0.0)))
    }
}

impl Lifetime for FirstPassage {
    fn reliability(&self, t: f64) -> f64 {
        self.reliability_at(t, 1.0)
    }

    fn failed(&self, t: f64) -> f64 {
        self.failed_at(t, 1.0)
    }

    /// When exposure reaches its mean at the passage.
    fn typical(&self) -> f64 {
        self.clock.until(self.now, self.law.mean_exposure(self.left))
    }

    fn ever(&self) -> f64 {
        self.law.ever(self.left)
    }

    fn finite_moments(&self) -> Result<(), LifeError> {
        if self.law.has_moments() { Ok(()) } else { Err(LifeError::DriftOfUnits) }
    }

    /// In closed form under a steady load, where there is one: near the threshold lives of a Wiener process are so uneven that
    /// integrals miss them.
    fn moments(&self) -> Result<Moments, LifeError> {
        let closed = self.clock.steady().zip(self.law.passage_moments(self.left));
        let Some((rate, (mean, variance))) = closed else { return integrated_moments(self) };
        Ok(Moments { mean: mean / rate, std: libm::sqrt(variance) / rate, error: 0.0 })
    }

    fn breaks(&self) -> Vec<f64> {
        self.clock.breaks().into_iter().map(|t| t - self.now).collect()
    }

    fn hazard(&self, t: f64) -> f64 {
        self.hazard_at(t, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::survived::Survived;
    use super::*;
    use crate::process::{Gamma, InverseGaussian, Process, Wiener};

    /// GaAs lasers (Meeker & Escobar, 1998, table C.17), fit of the R package `gammaprocesses`; exposure = hours/1000.
    fn lasers() -> Law {
        Law::new(&Gamma, [28.75350606, 14.11445933]).expect("valid")
    }

    fn clock() -> Clock {
        Clock::linear(1.0).expect("valid")
    }

    #[test]
    fn lasers_fail_when_published() {
        let life = FirstPassage::new(lasers(), clock(), 10.0).expect("valid");
        for (p, expected) in [(0.1, 4.40056787), (0.5, 4.92036645), (0.9, 5.45921661)] {
            let quantile = life.quantile(p).expect("valid");
            // Eight published decimals.
            assert!((quantile - expected).abs() < 1e-8, "{p}: {quantile}");
        }
        // Five published decimals.
        assert!((life.reliability(5.0) - 0.42377).abs() < 5e-6);
    }

    #[test]
    fn a_half_worn_laser_has_the_published_rest() {
        let life = FirstPassage::from(lasers(), clock(), 10.0, 5.0, 2.5).expect("valid");
        for (p, expected) in [(0.025, 1.91631198), (0.5, 2.46597232), (0.975, 3.06025256)] {
            let quantile = life.quantile(p).expect("valid");
            assert!((quantile - expected).abs() < 1e-8, "{p}: {quantile}");
        }
    }

    #[test]
    fn a_steady_load_leaves_the_same_life_however_late() {
        let at = |now: f64| FirstPassage::from(lasers(), Clock::linear(0.3).expect("valid"), 10.0, 5.0, now);
        let early = at(0.0).expect("valid");
        for now in [1e-3, 1e14, 1e18, 1e300] {
            let late = at(now).expect("valid");
            for p in [0.1, 0.5, 0.9] {
                assert_eq!(late.quantile(p), early.quantile(p), "{now} {p}");
            }
            assert_eq!(late.moments(), early.moments(), "{now}");
        }
    }

    #[test]
    fn a_life_beyond_all_numbers_is_refused() {
        let clock = Clock::power(1.0, 1e-3).expect("valid");
        let error = FirstPassage::new(lasers(), clock, 1e9).expect("valid").quantile(0.5).expect_err("none");
        assert_eq!(error, LifeError::Endless { p: 0.5 });
    }

    #[test]
    fn density_integrates_to_the_failed_part() {
        let life = FirstPassage::from(lasers(), Clock::power(1.3, 0.7).expect("valid"), 10.0, 4.0, 1.0)
            .expect("valid");
        let end = life.quantile(0.8).expect("valid");
        let (sum, _) = crate::quadrature::integrate(&|t| [life.density(t)], &[0.0, end], [1e-12]);
        // Cancellation in the hazard where everything is alive: 1e-13.
        assert!((sum[0] - 0.8).abs() < 1e-10, "{}", sum[0]);
    }

    #[test]
    fn a_table_of_a_straight_line_is_a_straight_line() {
        let rows = (0..40).map(|n| (f64::from(n), 0.5 * f64::from(n))).collect();
        let table = FirstPassage::new(lasers(), Clock::table(rows).expect("rising"), 10.0).expect("valid");
        let line = FirstPassage::new(lasers(), Clock::linear(0.5).expect("valid"), 10.0).expect("valid");
        let (a, b) = (table.moments().expect("finite"), line.moments().expect("finite"));
        // The accuracy of the integrals.
        assert!((a.mean - b.mean).abs() < 1e-9 && (a.std - b.std).abs() < 1e-8, "{a:?} {b:?}");
        let whole = line.whole_cycles().expect("finite");
        // Lives of about 10 cycles, spread over more than one: half a cycle more.
        assert!((whole.mean - b.mean - 0.5).abs() < 0.01, "{} {}", whole.mean, b.mean);
        assert!(table.beyond_table() < 1e-12);
    }

    #[test]
    fn mean_exposure_at_passage_is_half_a_unit_of_shape_beyond_the_threshold() {
        // The integral of P(a, x) over a is x + 1/2 but for e^-x terms: its derivative in x is Ramanujan's integral of
        // x^(a-1) / Gamma(a), times e^-x; the constant follows from sum over n >= 1 of P(n, x) = x.
        let life = FirstPassage::new(lasers(), clock(), 10.0).expect("valid");
        let expected = (14.11445933 * 10.0 + 0.5) / 28.75350606;
        // The accuracy asked of the integral.
        assert!((life.moments().expect("finite").mean - expected).abs() < 1e-9);
    }

    #[test]
    fn near_the_threshold_lives_of_a_wiener_process_have_their_closed_moments() {
        let law = Law::new(&Wiener, [0.8, 0.3]).expect("valid");
        let at = |left: f64| FirstPassage::new(law, Clock::linear(2.0).expect("valid"), left).expect("valid");
        // J. L. Folks, R. S. Chhikara (1978): mean a / drift, variance a spread² / drift³; by the rate of the clock.
        for left in [1e-12, 1e-6, 1.0, 50.0] {
            let moments = at(left).moments().expect("finite");
            let (mean, std) = (left / 1.6, (left * 0.09 / 0.512_f64).sqrt() / 2.0);
            // Rounding.
            assert!((moments.mean / mean - 1.0).abs() < 1e-14 && (moments.std / std - 1.0).abs() < 1e-14);
            let outlived = Survived::new(&at(left), 0.0).expect("all").moments();
            assert_eq!(outlived, Ok(moments));
        }
        let integrated = integrated_moments(&at(1.0)).expect("finite");
        let closed = at(1.0).moments().expect("finite");
        // The accuracy of the integrals.
        assert!((integrated.mean - closed.mean).abs() < 1e-9 && (integrated.std - closed.std).abs() < 1e-8);
    }

    #[test]
    fn hazards_go_on_where_survivors_are_too_few_for_numbers() {
        let processes: [(&'static dyn Process, f64); 5] = [
            (&Gamma, 0.1),
            (&Gamma, 0.5),
            (&Wiener, 0.02),
            (&InverseGaussian, 0.05),
            (&InverseGaussian, 0.3),
        ];
        for (process, cv) in processes {
            let law = Law::of_units(process, [0.0, 2.0], cv).expect("valid");
            let life = FirstPassage::new(law, clock(), 3.0).expect("valid");
            let (mut few, mut none) = (3.0, 3.0);
            while life.reliability(few) > 1e-270 && few < 1e6 {
                few *= 1.02;
            }
            while life.reliability(none) > 0.0 && none < 1e6 {
                none *= 1.02;
            }
            let [before, beyond, after] = [0.97 * few, none, 1.1 * none].map(|t| life.hazard(t));
            assert!(
                before > 0.0 && beyond.is_finite() && after.is_finite(),
                "{process:?} {before} {beyond} {after}"
            );
            // Hazards go on without a jump: in a few tenths of the exposure they change by less than half.
            assert!(
                (beyond / before - 1.0).abs() < 0.5 && (after / beyond - 1.0).abs() < 0.5,
                "{process:?} {before} {beyond} {after}"
            );
        }
    }

    #[test]
    fn no_wear_left_is_refused_with_both_numbers() {
        let error = FirstPassage::from(lasers(), clock(), 5.0, 5.5, 0.0).expect_err("failed already");
        assert!(error.to_string().contains("5.5") && error.to_string().contains("threshold 5"), "{error}");
        for current in [f64::NAN, -1.0] {
            assert!(matches!(
                FirstPassage::from(lasers(), clock(), 5.0, current, 0.0),
                Err(LifeError::Negative { .. })
            ));
        }
        assert!(matches!(
            FirstPassage::from(lasers(), clock(), 5.0, 1.0, -2.0),
            Err(LifeError::Negative { .. })
        ));
        assert!(matches!(FirstPassage::new(lasers(), clock(), f64::NAN), Err(LifeError::NotPositive { .. })));
    }
}
