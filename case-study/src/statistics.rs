//! Numbers about samples of lives. In: lives. Out: means, scatter, densities. Never knows models or figures.

use serde::Serialize;

/// Points of a density.
const POINTS: usize = 121;
/// Half-width of the plotted range, in standard deviations.
const WIDTH: f64 = 4.0;

/// A random life [cycles].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lived {
    /// Threshold interpolated within the cycle.
    pub cycles: f64,
    /// Whole cycles, as an inspection after every cycle counts.
    pub whole: f64,
}

/// A sample of lives in numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LifeNumbers {
    /// Mean [cycles], threshold interpolated within the cycle.
    pub mean: f64,
    /// Standard deviation [cycles].
    pub std: f64,
    /// Standard deviation over mean.
    pub cov: f64,
    /// Mean of whole cycles, as an inspection after every cycle counts [cycles].
    pub mean_whole: f64,
    /// Standard deviation of whole cycles over their mean.
    pub cov_whole: f64,
}

impl LifeNumbers {
    pub(super) fn of(lives: &[Lived]) -> Self {
        let (mean, std) = mean_and_scatter(lives.iter().map(|life| life.cycles));
        let (mean_whole, std_whole) = mean_and_scatter(lives.iter().map(|life| life.whole));
        Self { mean, std, cov: std / mean, mean_whole, cov_whole: std_whole / mean_whole }
    }
}

/// Mean and standard deviation (over n - 1).
pub(super) fn mean_and_scatter(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
    (mean, if count > 1.0 { libm::sqrt(squares / (count - 1.0)) } else { 0.0 })
}

/// A probability density of life.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Density {
    /// Lives [cycles].
    pub lives: Vec<f64>,
    /// Density [1/cycle].
    pub values: Vec<f64>,
}

impl Density {
    /// Smoothed by normal kernels of Silverman's width.
    pub(super) fn of(lives: &[Lived]) -> Self {
        let (mean, std) = mean_and_scatter(lives.iter().map(|life| life.cycles));
        let width = 1.06 * std * libm::pow(lives.len() as f64, -0.2);
        let place = |index: usize| mean + std * WIDTH * (2.0 * index as f64 / (POINTS - 1) as f64 - 1.0);
        let kernel = |at: f64, life: &Lived| {
            let x = (at - life.cycles) / width;
            libm::exp(-0.5 * x * x)
        };
        let height = lives.len() as f64 * width * libm::sqrt(2.0 * std::f64::consts::PI);
        let value = |at: &f64| lives.iter().map(|life| kernel(*at, life)).sum::<f64>() / height;
        let places: Vec<f64> = (0..POINTS).map(place).collect();
        Self { values: places.iter().map(value).collect(), lives: places }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lives() -> Vec<Lived> {
        (0..400)
            .map(|i| f64::from(i) / 40.0)
            .map(|x| Lived { cycles: 20.0 + x, whole: (20.0 + x).ceil() })
            .collect()
    }

    #[test]
    fn numbers_of_an_even_sample_are_those_of_its_closed_form() {
        let numbers = LifeNumbers::of(&lives());
        // Steps of 1/40 from 20 to 29.975; variance of n even steps h: h^2 n (n + 1)/12 (over n - 1). A few roundings.
        assert!((numbers.mean - 24.9875).abs() < 1e-12);
        assert!((numbers.std - (400.0_f64 * 401.0 / 12.0).sqrt() / 40.0).abs() < 1e-12);
        assert!((numbers.mean_whole - 25.4875).abs() < 0.02, "{}", numbers.mean_whole);
    }

    #[test]
    fn a_density_has_an_area_of_one() {
        let density = Density::of(&lives());
        let spacing = density.lives[1] - density.lives[0];
        let area = spacing * density.values.iter().sum::<f64>();
        // Nothing lies beyond four deviations of an even sample; sums over a smooth curve that ends at zero are exact.
        assert!((area - 1.0).abs() < 1e-6, "{area}");
    }
}
