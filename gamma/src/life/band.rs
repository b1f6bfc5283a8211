//! Bands: what the uncertainty of estimated parameters leaves open about reliability, quantiles and means.
//! In: an estimate with its covariance, a state. Out: intervals. Never knows how the covariance was found.
//!
//! Delta method: a value is linear in the logarithms of the parameters on a scale on which it is unbounded, the logit for
//! probabilities, the logarithm for times; half-width z times its standard error there, carried back. Draws: parameters
//! from the normal law of their logarithms, quantiles of the values they give.

use super::estimate::Estimate;
use super::first_passage::FirstPassage;
use super::lifetime::Lifetime;
use super::state::OperatingState;
use crate::error::{LifeError, probability};
use crate::order::sorted_quantile;
use crate::random::Stream;
use crate::special::normal_quantile;

/// Step of the differences in the logarithms of the parameters: error 1e-8 by curvature, 1e-12 by rounding.
const STEP: f64 = 1e-4;

/// A value and the interval its parameters leave open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// At the estimated parameters.
    pub value: f64,
    /// Lower end.
    pub lower: f64,
    /// Upper end; infinite where it is open.
    pub upper: f64,
}

impl Band {
    /// A value with half of its interval's width on a scale. Of a probability no width where that is not finite; a time that parameters
    /// nearby do not have is open.
    pub(crate) fn around(value: f64, scale: Scale, half: f64) -> Self {
        let centre = scale.out(value);
        if scale == Scale::Log && centre.is_finite() && !half.is_finite() {
            return Self { value, lower: 0.0, upper: f64::INFINITY };
        }
        if !(centre.is_finite() && half.is_finite()) {
            return Self { value, lower: value, upper: value };
        }
        // There and back costs a digit: the value stays inside its band.
        let (lower, upper) = (scale.back(centre - half), scale.back(centre + half));
        Self { value, lower: lower.min(value), upper: upper.max(value) }
    }

    /// Half of the interval's width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.upper - self.lower)
    }
}

/// How bands are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Linear in the logarithms of the parameters: quick, symmetric on the scale of the value.
    Delta,
    /// Parametric draws: `count` of them, decided by `seed`.
    Draws {
        /// Number of draws.
        count: usize,
        /// Seed.
        seed: u64,
    },
}

/// Bands of one state.
#[derive(Debug)]
pub struct Bands<'a> {
    estimate: &'a Estimate,
    state: &'a OperatingState,
    life: FirstPassage,
    z: f64,
    level: f64,
    drawn: Vec<FirstPassage>,
}

/// Laws of life at drawn parameters.
fn drawn_lives(
    estimate: &Estimate,
    state: &OperatingState,
    count: usize,
    seed: u64,
) -> Result<Vec<FirstPassage>, LifeError> {
    // One stream for each draw, the joint 0: more draws leave the first ones as they are.
    let at = |at: usize| {
        let logs = estimate.drawn_logs(&mut Stream::new(seed, at as u64, 0));
        state.life_by(estimate, &logs)
    };
    (0..count).map(at).collect()
}

/// The scale on which a value is unbounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Of probabilities.
    Logit,
    /// Of times.
    Log,
}

impl Scale {
    fn out(self, value: f64) -> f64 {
        match self {
            Self::Logit => libm::log(value) - libm::log1p(-value),
            Self::Log => libm::log(value),
        }
    }

    fn back(self, value: f64) -> f64 {
        match self {
            Self::Logit => 1.0 / (1.0 + libm::exp(-value)),
            Self::Log => libm::exp(value),
        }
    }
}

impl<'a> Bands<'a> {
    /// Bands that hold the true value with probability `level`, as far as the normal law of the logarithms holds.
    ///
    /// # Errors
    /// [`LifeError::Probability`] for the level; [`LifeError`] if drawn parameters leave the range of numbers.
    pub fn new(
        estimate: &'a Estimate,
        state: &'a OperatingState,
        level: f64,
        method: Method,
    ) -> Result<Self, LifeError> {
        let z = normal_quantile(0.5 + 0.5 * probability(level)?);
        let life = state.life(estimate)?;
        let drawn = match method {
            Method::Delta => Vec::new(),
            Method::Draws { count, seed } => drawn_lives(estimate, state, count, seed)?,
        };
        Ok(Self { estimate, state, life, z, level, drawn })
    }

    /// Probability of no failure until `t` from now.
    ///
    /// # Errors
    /// [`LifeError`] if a parameter leaves the range of numbers.
    pub fn reliability(&self, t: f64) -> Result<Band, LifeError> {
        self.band(Scale::Logit, &|life| Ok(life.reliability(t)))
    }

    /// Time until which the part `p` has failed.
    ///
    /// # Errors
    /// [`LifeError::Probability`].
    pub fn quantile(&self, p: f64) -> Result<Band, LifeError> {
        self.band(Scale::Log, &|life| life.quantile(p))
    }

    /// Mean remaining life.
    ///
    /// # Errors
    /// [`LifeError`] if a parameter leaves the range of numbers.
    pub fn mean(&self) -> Result<Band, LifeError> {
        self.band(Scale::Log, &|life| Ok(life.moments()?.mean))
    }

    /// Whatever can be asked of a life.
    ///
    /// # Errors
    /// Those of the question.
    pub fn band(
        &self,
        scale: Scale,
        of: &dyn Fn(&FirstPassage) -> Result<f64, LifeError>,
    ) -> Result<Band, LifeError> {
        let value = of(&self.life)?;
        if !self.estimate.is_uncertain() {
            return Ok(Band { value, lower: value, upper: value });
        }
        if !self.drawn.is_empty() {
            let mut values = self.drawn.iter().map(of).collect::<Result<Vec<f64>, _>>()?;
            values.sort_by(f64::total_cmp);
            let at = |p: f64| sorted_quantile(&values, p);
            let tail = 0.5 - 0.5 * self.level;
            return Ok(Band { value, lower: at(tail), upper: at(1.0 - tail) });
        }
        if !scale.out(value).is_finite() {
            return self.at_an_edge(value, of);
        }
        Ok(Band::around(value, scale, self.z * variance(self.estimate, self.state, scale, of)?.sqrt()))
    }
}

impl Bands<'_> {
    /// Of a value that has no finite place on its scale, such as a probability of 0 or 1 in all digits: between the values at `z`
    /// standard errors along each axis of the covariance.
    fn at_an_edge(
        &self,
        value: f64,
        of: &dyn Fn(&FirstPassage) -> Result<f64, LifeError>,
    ) -> Result<Band, LifeError> {
        let mut band = Band { value, lower: value, upper: value };
        let size = self.estimate.logs().len();
        for (at, sign) in (0..size).flat_map(|at| [(at, -1.0), (at, 1.0)]) {
            let axis: Vec<f64> =
                (0..size).map(|other| if other == at { sign * self.z } else { 0.0 }).collect();
            let steps = self.estimate.factor().times(&axis);
            let logs = self.estimate.logs_off_by(steps.into_iter().chain(std::iter::repeat(0.0)));
            let there = of(&self.state.life_by(self.estimate, &logs)?)?;
            band = Band { lower: band.lower.min(there), upper: band.upper.max(there), ..band };
        }
        Ok(band)
    }
}

/// Variance that an estimate's covariance gives to what `of` tells of a life, on a scale.
pub(crate) fn variance(
    estimate: &Estimate,
    state: &OperatingState,
    scale: Scale,
    of: &dyn Fn(&FirstPassage) -> Result<f64, LifeError>,
) -> Result<f64, LifeError> {
    let mut gradient = Vec::new();
    for at in 0..estimate.logs().len() {
        let shifted = |step: f64| -> Result<f64, LifeError> {
            let steps = (0..estimate.logs().len()).map(|other| if other == at { step } else { 0.0 });
            let logs = estimate.logs_off_by(steps);
            Ok(scale.out(of(&state.life_by(estimate, &logs)?)?))
        };
        gradient.push((shifted(STEP)? - shifted(-STEP)?) / (2.0 * STEP));
    }
    Ok(estimate.factor().variance(&gradient))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::Gamma;
    use crate::special::trigamma;

    /// The published fit of the GaAs lasers with the inverse of its information. All 240 increments have the exposure
    /// 0.25, so the information needs only alpha and beta: I_aa = 240 * 0.25² psi'(0.25 alpha), I_ab = -60 / beta,
    /// I_bb = 60 alpha / beta².
    fn lasers() -> Estimate {
        let (alpha, beta) = (28.75350606, 14.11445933);
        let (aa, ab, bb) = (15.0 * trigamma(0.25 * alpha), -60.0 / beta, 60.0 * alpha / (beta * beta));
        let determinant = aa * bb - ab * ab;
        let covariance =
            [vec![bb / determinant, -ab / determinant], vec![-ab / determinant, aa / determinant]];
        Estimate::new(&Gamma, [alpha, beta], None)
            .expect("valid")
            .with_covariance(&covariance)
            .expect("positive")
    }

    #[test]
    fn the_published_band_of_the_lasers_is_the_delta_method_on_the_logit_scale() {
        let (estimate, state) = (lasers(), OperatingState::new(10.0).expect("valid"));
        let bands = Bands::new(&estimate, &state, 0.95, Method::Delta).expect("valid");
        let band = bands.reliability(5.0).expect("valid");
        // Five published decimals: S(5) = .42377, 95 % band .22976 to .64453 (SurPyval 0.25).
        assert!((band.value - 0.42377).abs() < 5e-6, "{band:?}");
        assert!((band.lower - 0.22976).abs() < 5e-6 && (band.upper - 0.64453).abs() < 5e-6, "{band:?}");
    }

    #[test]
    fn draws_agree_with_the_delta_method_where_uncertainty_is_small() {
        let (estimate, state) = (lasers(), OperatingState::new(10.0).expect("valid"));
        let delta = Bands::new(&estimate, &state, 0.9, Method::Delta).expect("valid");
        let draws =
            Bands::new(&estimate, &state, 0.9, Method::Draws { count: 2000, seed: 7 }).expect("valid");
        for p in [0.1, 0.5, 0.9] {
            let (a, b) = (delta.quantile(p).expect("valid"), draws.quantile(p).expect("valid"));
            // 2000 draws: an end has a standard error of 0.047 half-widths at 90 %; three of them, and curvature.
            assert!((a.lower - b.lower).abs() < 0.2 * a.half_width(), "{a:?} {b:?}");
            assert!((a.upper - b.upper).abs() < 0.2 * a.half_width(), "{a:?} {b:?}");
        }
        let again =
            Bands::new(&estimate, &state, 0.9, Method::Draws { count: 2000, seed: 7 }).expect("valid");
        assert_eq!(draws.quantile(0.1), again.quantile(0.1));
        let other =
            Bands::new(&estimate, &state, 0.9, Method::Draws { count: 2000, seed: 8 }).expect("valid");
        assert_ne!(draws.quantile(0.1), other.quantile(0.1));
    }

    #[test]
    fn a_reliability_too_small_for_numbers_has_a_band_all_the_same() {
        // Errors of half a logarithm.
        let estimate = Estimate::new(&Gamma, [28.0, 14.0], None).expect("valid");
        let estimate = estimate.with_log_covariance(&[vec![0.3, 0.0], vec![0.0, 0.3]]).expect("positive");
        let state = OperatingState::new(10.0).expect("valid");
        let bands = Bands::new(&estimate, &state, 0.95, Method::Delta).expect("valid");
        let band = bands.reliability(30.0).expect("valid");
        assert_eq!((band.value, band.lower), (0.0, 0.0));
        // It was (0, 0) where the value came out as 0: a life 1.96 * 0.55 of a logarithm longer is not.
        assert!(band.upper > 1e-50, "{band:?}");
    }

    #[test]
    fn known_parameters_leave_nothing_open() {
        let estimate = Estimate::new(&Gamma, [28.0, 14.0], None).expect("valid");
        let state = OperatingState::new(10.0).expect("valid");
        let bands = Bands::new(&estimate, &state, 0.95, Method::Delta).expect("valid");
        assert_eq!(bands.mean().expect("finite").half_width(), 0.0);
    }

    #[test]
    fn a_uniform_scale_of_time_moves_the_median_by_the_same_factor() {
        // Uncertain beta alone: the life is near beta W / alpha, so ln T moves by the step of ln beta, nearly.
        let estimate = Estimate::new(&Gamma, [1000.0, 1000.0], None).expect("valid");
        let estimate = estimate.with_log_covariance(&[vec![0.0, 0.0], vec![0.0, 1e-4]]).expect("valid");
        let state = OperatingState::new(1.0).expect("valid");
        let bands = Bands::new(&estimate, &state, 0.95, Method::Delta).expect("valid");
        let band = bands.quantile(0.5).expect("valid");
        // d ln T / d ln beta = 1 but for terms of order 1 / (beta W) = 1e-3.
        assert!(((band.upper / band.value).ln() / (1.96 * 0.01) - 1.0).abs() < 2e-3, "{band:?}");
    }
}
