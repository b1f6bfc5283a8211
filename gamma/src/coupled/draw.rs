//! Wear increments of the Gamma process, [CS (21)], for the coarse scale. In: rates per joint, a seed. Out: dW.
//! Never knows the state of a trajectory.

use linkwear_runtime::GammaRates;
use linkwear_runtime::life::IncrementDraw;

use crate::sample::ln_gamma_variate;
use crate::stream::Stream;

/// Wear in this layer is counted in micrometres.
const MICRO: f64 = 1e-6;

/// dW ~ Gamma(shape alpha dLambda, rate beta), joint by joint; one stream per (trajectory, joint).
#[derive(Clone, Debug)]
pub struct GammaDraw {
    seed: u64,
    /// alpha [1/µm] and ln beta, beta in 1/µm.
    joints: Vec<(f64, f64)>,
}

impl GammaDraw {
    /// For these joints, in the order of the wearing joints.
    #[must_use]
    pub fn new(seed: u64, joints: &[GammaRates]) -> Self {
        let joint = |rates: &GammaRates| (rates.alpha * MICRO, libm::log(rates.beta * MICRO));
        Self { seed, joints: joints.iter().map(joint).collect() }
    }
}

impl IncrementDraw for GammaDraw {
    fn draw(&self, joint: usize, trajectory: u64, cycle: u64, mean: f64) -> f64 {
        let Some((alpha, ln_beta)) = self.joints.get(joint) else { return mean };
        let shape = alpha * (mean / MICRO);
        if shape <= 0.0 {
            return 0.0;
        }
        let mut stream = Stream::new(self.seed, trajectory, joint as u64);
        stream.at(cycle);
        // Wear too small for a number is no wear: only here, where it is added to micrometres.
        libm::exp(ln_gamma_variate(shape, &mut stream) - ln_beta) * MICRO
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
    fn no_mean_wear_is_no_wear() {
        assert_eq!(GammaDraw::new(1, &[RATES]).draw(0, 0, 0, 0.0), 0.0);
    }
}
