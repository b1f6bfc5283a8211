//! Wear increments of the Gamma process, [CS (21)], for the coarse scale. In: rates per joint, a seed, perhaps a factor
//! all joints share. Out: dW, drawn or in the mean.
//! Never knows the state of a trajectory.

use rand::RngExt;

use linkwear_runtime::GammaRates;
use linkwear_runtime::life::{IncrementModel, LANES, Lanes};

use crate::error::LifeError;
use crate::process::{Gamma, Process};
use crate::random::{LnGamma, Stream, gamma_draws};
use crate::series::SharedFactor;
use crate::special::{ln_gamma, ln_gamma_p, ln_gamma_p_slope};

/// A micrometre in metres: wear of the processes is counted in it.
pub const MICRO: f64 = 1e-6;
/// Micrometres in a metre.
pub const PER_METRE: f64 = 1.0 / MICRO;
/// Number of the stream that a trajectory draws its shared factor from: no joint has it.
const TRAJECTORY: u64 = u64::MAX;

/// dW ~ Gamma(shape alpha dLambda, rate beta), joint by joint; one stream per (trajectory, joint).
#[derive(Clone, Debug)]
pub struct GammaDraw {
    seed: u64,
    /// alpha [1/µm] and ln beta, beta in 1/µm.
    joints: Vec<(f64, f64)>,
    /// Coefficient of variation of each joint's beta over lives; 0 or none: it is the same in all.
    cvs: Vec<f64>,
    shared: Option<SharedFactor>,
}

impl GammaDraw {
    /// For these joints, in the order of the wearing joints.
    pub fn new(seed: u64, joints: &[GammaRates]) -> Self {
        let joint = |rates: &GammaRates| (rates.alpha * MICRO, libm::log(rates.beta * MICRO));
        Self { seed, joints: joints.iter().map(joint).collect(), cvs: Vec::new(), shared: None }
    }

    /// With a factor of mean 1, one draw for each trajectory, that multiplies the exposure dLambda of all its joints and
    /// cycles, as [`crate::series::SeriesSystem::sharing`] has it. It changes the shapes of increments, not their rates.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`] for its coefficient of variation.
    pub fn sharing(self, factor: SharedFactor) -> Result<Self, LifeError> {
        // Errors come here, so that drawing has none.
        factor.ln_draw(&mut Stream::new(self.seed, 0, TRAJECTORY))?;
        Ok(Self { shared: Some(factor), ..self })
    }

    /// With rates beta that differ between units by a Gamma law of these coefficients of variation, joint by joint, 0 for none: a joint
    /// keeps its rate for all of a life. `joints` of [`Self::new`] are those of the mean rate.
    pub fn differing(self, cvs: Vec<f64>) -> Self {
        Self { cvs, ..self }
    }

    /// ln of a joint's rate over the mean one in a trajectory, if it differs.
    fn ln_rate(&self, joint: usize, trajectory: u64) -> Option<f64> {
        let cv = self.cvs.get(joint).filter(|cv| **cv > 0.0)?;
        // Streams from the last one down: no joint has them.
        let mut stream = Stream::new(self.seed, trajectory, TRAJECTORY - 1 - joint as u64);
        Gamma.random_effect().map(|effect| effect.draw([0.0; 2], *cv, &mut stream)[1])
    }

    /// An increment in a cycle of a trajectory whose factor is known.
    fn draw_with(&self, joint: usize, (trajectory, cycle): (u64, u64), mean: f64, factor: f64) -> f64 {
        let Some((alpha, ln_beta)) = self.joints.get(joint) else { return mean };
        let shape = alpha * (mean / MICRO) * factor;
        if shape <= 0.0 {
            return 0.0;
        }
        let mut stream = Stream::new(self.seed, trajectory, joint as u64);
        stream.at(cycle);
        let ln_beta = ln_beta + self.ln_rate(joint, trajectory).unwrap_or(0.0);
        // Wear too small for a number is no wear: only here, where it is added to micrometres.
        libm::exp(stream.sample(LnGamma(shape)) - ln_beta) * MICRO
    }

    /// The increment that [`IncrementModel::draw`] gives, and its derivative by `mean` at the same random number: by the quantile of
    /// the Gamma law, whose derivative by its shape a is dx/da = -(dP/da) / p. That by ln alpha is the same times `mean`, that by ln beta
    /// the negative of the increment.
    pub fn draw_with_slope(&self, joint: usize, trajectory: u64, cycle: u64, mean: f64) -> (f64, f64) {
        let Some((alpha, ln_beta)) = self.joints.get(joint) else { return (mean, 1.0) };
        let factor = self.of_trajectory(trajectory);
        let drawn = self.draw_with(joint, (trajectory, cycle), mean, factor);
        let shape = alpha * (mean / MICRO) * factor;
        if shape <= 0.0 || drawn <= 0.0 {
            return (drawn, 0.0);
        }
        let rate = libm::exp(ln_beta + self.ln_rate(joint, trajectory).unwrap_or(0.0));
        let x = drawn / MICRO * rate;
        let ln_density = (shape - 1.0) * libm::log(x) - x - ln_gamma(shape);
        let by_shape = ln_gamma_p_slope(shape, x) * libm::exp(ln_gamma_p(shape, x) - ln_density);
        (drawn, by_shape * alpha * factor / rate)
    }

    /// ln of the factor of a trajectory: 0 if joints share none.
    fn ln_factor(&self, trajectory: u64) -> f64 {
        let drawn =
            self.shared.map(|factor| factor.ln_draw(&mut Stream::new(self.seed, trajectory, TRAJECTORY)));
        drawn.and_then(Result::ok).unwrap_or(0.0)
    }
}

impl IncrementModel for GammaDraw {
    fn draw(&self, joint: usize, trajectory: u64, cycle: u64, mean: f64) -> f64 {
        self.draw_with(joint, (trajectory, cycle), mean, self.of_trajectory(trajectory))
    }

    fn of_trajectory(&self, trajectory: u64) -> f64 {
        if self.shared.is_some() { libm::exp(self.ln_factor(trajectory)) } else { 1.0 }
    }

    fn draw_lanes(&self, joint: usize, lanes: &Lanes, means: &[f64; LANES]) -> [f64; LANES] {
        let Some((alpha, ln_beta)) = self.joints.get(joint) else { return *means };
        let shapes = std::array::from_fn(|lane| alpha * (means[lane] / MICRO) * lanes.own[lane]);
        let streams = (self.seed, joint as u64);
        let differs = self.cvs.get(joint).is_some_and(|cv| *cv > 0.0);
        let (drawn, holds) = gamma_draws(streams, &lanes.trajectories, &lanes.cycles, &shapes, *ln_beta);
        let one = |lane: usize| {
            let place = (lanes.trajectories[lane], lanes.cycles[lane]);
            self.draw_with(joint, place, means[lane], lanes.own[lane])
        };
        std::array::from_fn(|lane| if holds[lane] && !differs { drawn[lane] * MICRO } else { one(lane) })
    }
}

/// The increments' means, alpha dLambda / beta: the mean path of processes whose alpha and beta differ.
#[derive(Clone, Debug)]
pub struct GammaMean {
    /// alpha / beta.
    joints: Vec<f64>,
}

impl GammaMean {
    /// For these joints, in the order of the wearing joints.
    pub fn new(joints: &[GammaRates]) -> Self {
        Self { joints: joints.iter().map(|rates| rates.alpha / rates.beta).collect() }
    }
}

impl IncrementModel for GammaMean {
    fn draw(&self, joint: usize, _trajectory: u64, _cycle: u64, mean: f64) -> f64 {
        self.joints.get(joint).copied().unwrap_or(1.0) * mean
    }

    /// Only where every joint wears as its physics says may cycles be jumped over.
    fn is_mean(&self) -> bool {
        self.joints.iter().all(|ratio| *ratio == 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATES: GammaRates = GammaRates { alpha: 13.65e6, beta: 13.65e6 };

    #[test]
    fn increments_have_the_mean_and_variance_of_the_process() {
        let draw = GammaDraw::new(1, &[RATES]);
        let (mean, count) = (3.2e-6, 50_000_u64);
        let drawn: Vec<f64> = (0..count).map(|cycle| draw.draw(0, 0, cycle, mean)).collect();
        let n = count as f64;
        let average = drawn.iter().sum::<f64>() / n;
        let variance = drawn.iter().map(|dw| (dw - average).powi(2)).sum::<f64>() / (n - 1.0);
        // Shape 43.68: variance mean / beta; four standard errors of either, kurtosis 3 + 6 / shape.
        let exact = mean / RATES.beta;
        assert!((average - mean).abs() < 4.0 * (exact / n).sqrt(), "{average}");
        assert!((variance / exact - 1.0).abs() < 4.0 * ((2.0 + 6.0 / 43.68) / n).sqrt(), "{variance}");
    }

    #[test]
    fn a_draw_knows_its_place_and_nothing_else() {
        let draw = GammaDraw::new(1, &[RATES; 2]);
        let first = draw.draw(0, 3, 5, 1e-6);
        draw.draw(1, 3, 5, 1e-6);
        assert_eq!(first.to_bits(), draw.draw(0, 3, 5, 1e-6).to_bits());
        for other in [draw.draw(1, 3, 5, 1e-6), draw.draw(0, 4, 5, 1e-6), draw.draw(0, 3, 6, 1e-6)] {
            assert_ne!(first.to_bits(), other.to_bits());
        }
        assert_ne!(first.to_bits(), GammaDraw::new(2, &[RATES]).draw(0, 3, 5, 1e-6).to_bits());
    }

    #[test]
    fn a_joint_keeps_its_rate_for_all_of_a_life() {
        let plain = GammaDraw::new(1, &[RATES; 2]);
        let own = plain.clone().differing(vec![0.3, 0.0]);
        // The same numbers but for the rate, which is the trajectory's: alone and in lanes.
        let ratio = |joint, trajectory, cycle| {
            own.draw(joint, trajectory, cycle, 1e-6) / plain.draw(joint, trajectory, cycle, 1e-6)
        };
        assert!((ratio(0, 3, 5) / ratio(0, 3, 9) - 1.0).abs() < 1e-14 && ratio(1, 3, 5) == 1.0);
        assert_ne!(ratio(0, 3, 5), ratio(0, 4, 5));
        let lanes = Lanes { trajectories: [3; LANES], cycles: [5; LANES], own: [1.0; LANES] };
        assert_eq!(own.draw_lanes(0, &lanes, &[1e-6; LANES])[0].to_bits(), own.draw(0, 3, 5, 1e-6).to_bits());
        // Mean 1 and coefficient of variation 0.3 of the rates; four standard errors of 20,000 (kurtosis 3 + 6 cv²).
        let count = 20_000_u32;
        let rates: Vec<f64> = (0..count).map(|t| own.ln_rate(0, t.into()).unwrap().exp()).collect();
        let mean = rates.iter().sum::<f64>() / f64::from(count);
        let variance = rates.iter().map(|rate| (rate - mean).powi(2)).sum::<f64>() / f64::from(count);
        assert!((mean - 1.0).abs() < 4.0 * 0.3 / f64::from(count).sqrt(), "{mean}");
        assert!((variance / 0.09 - 1.0).abs() < 4.0 * (2.54 / f64::from(count)).sqrt(), "{variance}");
    }

    #[test]
    fn a_shared_factor_belongs_to_the_trajectory() {
        let draw = GammaDraw::new(1, &[RATES; 2]);
        let own = draw.clone().sharing(SharedFactor::Gamma { cov: 0.3 }).expect("valid");
        assert_eq!(own.ln_factor(3), own.ln_factor(3));
        assert_ne!(own.ln_factor(3), own.ln_factor(4));
        // At a shape of 1e6 a draw is its mean but for a thousandth: both joints, all cycles, wear by the same factor.
        let mean = 1e6 / RATES.alpha;
        for (joint, cycle) in [(0, 0), (1, 0), (0, 7)] {
            let ratio = own.draw(joint, 3, cycle, mean) / draw.draw(joint, 3, cycle, mean);
            // Five standard deviations of a quotient of two such draws.
            assert!((ratio / own.ln_factor(3).exp() - 1.0).abs() < 5.0 * 1.5e-3, "{joint} {cycle}: {ratio}");
        }
        assert!(draw.sharing(SharedFactor::Gamma { cov: -1.0 }).is_err());
    }

    #[test]
    fn the_mean_increment_is_alpha_over_beta_of_the_exposure() {
        let mean = GammaMean::new(&[RATES, GammaRates { alpha: 3.0, beta: 2.0 }]);
        assert_eq!((mean.draw(0, 0, 0, 4e-6), mean.draw(1, 5, 5, 4e-6)), (4e-6, 6e-6));
        assert!(!mean.is_mean() && GammaMean::new(&[RATES]).is_mean());
    }

    #[test]
    fn a_drawn_increment_varies_as_its_quantile() {
        let draw = GammaDraw::new(1, &[RATES]);
        for (cycle, mean) in [(0, 3.2e-6), (1, 3.2e-6), (2, 1e-7), (3, 4e-5)] {
            let (drawn, slope) = draw.draw_with_slope(0, 5, cycle, mean);
            assert_eq!(drawn, draw.draw(0, 5, cycle, mean));
            // The same probability by the laws beside it.
            let (shape, x) = (RATES.alpha * mean, drawn * RATES.beta);
            let p = crate::special::gamma_p(shape, x);
            let step = 1e-4 * shape;
            let at = |shape: f64| crate::special::gamma_quantile(shape, p);
            let expected = (at(shape + step) - at(shape - step)) / (2.0 * step) * RATES.alpha / RATES.beta;
            // Central difference: 1e-8 by curvature; quantiles are known to 1e-12 of themselves, over a step of 1e-4.
            assert!((slope / expected - 1.0).abs() < 1e-6, "{cycle}: {slope} {expected}");
        }
    }

    #[test]
    fn no_mean_wear_is_no_wear() {
        assert_eq!(GammaDraw::new(1, &[RATES]).draw(0, 0, 0, 0.0), 0.0);
    }
}
