//! Closed forms against drawn paths.

use rand::RngExt;

use super::*;
use crate::process::{Gamma, InverseGaussian, Wiener};
use crate::random::{LnGamma, Stream};

/// Wear on a bearing like that of the case study: threshold 80 um, some 3.2 um of mean wear a cycle, alpha = beta, and
/// beta W = 1092, to which the scatter of the paper's lives leads back.
const RATE: f64 = 13.65;
const THRESHOLD: f64 = 80.0;

/// Exposure of running-in: the increments of 60 cycles fall from 4 um to 3 um.
fn rows() -> Vec<(f64, f64)> {
    let mut exposure = 0.0;
    let mut rows = vec![(0.0, 0.0)];
    for n in 1..=60 {
        exposure += 3.0 + (-f64::from(n) / 5.0).exp();
        rows.push((f64::from(n), exposure));
    }
    rows
}

/// One path: the cycle that passes the threshold, and the time within it. Within the cycle exposure runs evenly, and a
/// half of a Gamma increment is its whole times a symmetric beta variate: halving finds the passage to 2^-12 cycle.
fn path(rows: &[(f64, f64)], draws: &mut Stream) -> (f64, f64) {
    let mut wear = 0.0;
    for (n, pair) in rows.windows(2).enumerate() {
        let mut shape = RATE * (pair[1].1 - pair[0].1);
        let mut increment = draws.at(n as u64).sample(LnGamma(shape)).exp() / RATE;
        if wear + increment >= THRESHOLD {
            let (mut t, mut length) = (pair[0].0, 1.0);
            for _ in 0..12 {
                shape *= 0.5;
                length *= 0.5;
                let (a, b) = (draws.sample(LnGamma(shape)), draws.sample(LnGamma(shape)));
                let first = increment / (1.0 + (b - a).exp());
                if wear + first >= THRESHOLD {
                    increment = first;
                } else {
                    wear += first;
                    increment -= first;
                    t += length;
                }
            }
            return (pair[1].0, t + 0.5 * length);
        }
        wear += increment;
    }
    panic!("sixty cycles wear {wear}");
}

#[test]
fn hundred_thousand_paths_agree_with_the_closed_form() {
    let rows = rows();
    let law = Law::new(&Gamma, [RATE, RATE]).expect("valid");
    let life = FirstPassage::new(law, Clock::table(rows.clone()).expect("rising"), THRESHOLD).expect("valid");
    let (whole, running): (Vec<f64>, Vec<f64>) =
        (0..100_000).map(|trajectory| path(&rows, &mut Stream::new(1, trajectory, 0))).unzip();
    for (lives, exact) in [(whole, life.whole_cycles()), (running, life.moments())] {
        let (lives, exact) = (LifeStatistics::of(&lives).expect("lives"), exact.expect("finite"));
        // Three standard errors of a fixed seed; seeds 0 to 11 lie between -1.5 and 2.3 of them in the mean.
        let (mean, cov) = (lives.mean(), lives.cov());
        assert!((mean.value - exact.mean).abs() < 3.0 * mean.error, "{mean:?} {exact:?}");
        assert!((cov.value - exact.cov()).abs() < 3.0 * cov.error, "{cov:?} {}", exact.cov());
        println!("mean {:.5} +- {:.5} exact {:.5}, ", mean.value, mean.error, exact.mean);
        println!("cov  {:.6} +- {:.6} exact {:.6}", cov.value, cov.error, exact.cov());
    }
}

#[test]
fn whole_cycles_add_half_a_cycle() {
    let law = Law::new(&Gamma, [RATE, RATE]).expect("valid");
    let life = FirstPassage::new(law, Clock::table(rows()).expect("rising"), THRESHOLD).expect("valid");
    let (running, whole) = (life.moments().expect("finite"), life.whole_cycles().expect("finite"));
    // Lives spread over about one cycle: the sum over cycles is the integral and a half but for 2 exp(-2 pi² s²) cycle.
    assert!((whole.mean - running.mean - 0.5).abs() < 1e-3, "{whole:?} {running:?}");
    // A number of cycles has the spread of the time and that of rounding up, 1/12.
    assert!((whole.std.powi(2) - running.std.powi(2) - 1.0 / 12.0).abs() < 1e-2);
}

/// Mean and standard deviation of (rate A)^(1/exponent) by its density, h = -dS/dt = hazard S, over ln t: another function
/// and another rule (equal steps) than those of the moments.
fn by_density(life: &FirstPassage) -> (f64, f64) {
    let (low, high) = (life.quantile(1e-9).expect("valid"), life.quantile(1.0 - 1e-12).expect("valid"));
    let steps = 4000;
    let step = (high / low).ln() / f64::from(steps);
    let centre = life.quantile(0.5).expect("valid");
    let mut sums = [0.0; 3];
    for k in 0..=steps {
        let t = low * (step * f64::from(k)).exp();
        let weight = step * t * life.density(t);
        for (sum, power) in sums.iter_mut().zip(0..) {
            *sum += weight * (t - centre).powi(power);
        }
    }
    let mean = sums[1] / sums[0];
    (centre + mean, (sums[2] / sums[0] - mean * mean).sqrt())
}

#[test]
fn moments_are_right_from_the_most_scattered_to_the_most_certain_life() {
    for alpha in [1e-3, 1.0, 3e4] {
        for k in -3..=12 {
            // beta W = 10^k, and a threshold of 3 of which 1 is worn.
            let scaled = 10.0_f64.powi(k);
            let law = Law::new(&Gamma, [alpha, 0.5 * scaled]).expect("valid");
            for exponent in [1.0, 0.2, 1.7] {
                let clock = Clock::power(2.0, exponent).expect("valid");
                let life = FirstPassage::from(law, clock, 3.0, 1.0, 0.0).expect("valid");
                let Moments { mean, std, .. } = life.moments().expect("finite");
                let case = format!("alpha {alpha} beta W 1e{k} exponent {exponent}: {mean} {std}");
                if scaled >= 1e3 {
                    // A of mean x + 1/2, variance x - 1/12 in units of 1/alpha (Euler and Maclaurin on the sums over
                    // whole shapes, Poisson's), and its power to second order.
                    let (x, g) = (scaled, 1.0 / exponent);
                    let (m, v) = (x + 0.5, x - 1.0 / 12.0);
                    let at_mean = (m / alpha).powf(g) / 2.0;
                    let expected = at_mean * (1.0 + 0.5 * g * (g - 1.0) * v / (m * m));
                    let spread = at_mean * g * v.sqrt() / m;
                    // What is left out is of order 1/x² and 1/x, with powers of 1/exponent = 5; for exponent 1 nothing.
                    let (of_mean, of_std) = if exponent == 1.0 {
                        (1e-9, 1e-6)
                    } else {
                        (1e-11 + 100.0 / (x * x), 1e-6 + 40.0 / x)
                    };
                    assert!((mean / expected - 1.0).abs() < of_mean, "{case}, {expected}");
                    assert!((std / spread - 1.0).abs() < of_std, "{case}, {spread}");
                }
                // The density is good to 1e-8; its left end and, for the widest laws, the step count.
                let (of_density, deviation) = by_density(&life);
                let share = mean / std;
                assert!(
                    (mean - of_density).abs() < 1e-5 * std * (1.0 + 1e-10 * share),
                    "{case}, {of_density}"
                );
                assert!((std / deviation - 1.0).abs() < 1e-4, "{case}, {deviation}");
            }
        }
    }
}

#[test]
fn moments_of_the_other_processes_are_the_closed_forms_however_certain() {
    for k in [-1, 0, 2, 4, 6, 8, 10, 12] {
        let certainty = 10.0_f64.powi(k);
        // Wiener: mean a / drift, variance a spread² / drift³.
        let law = Law::new(&Wiener, [2.0, (1.0 / certainty).sqrt()]).expect("valid");
        let life = FirstPassage::new(law, Clock::linear(1.0).expect("valid"), 3.0).expect("valid");
        let found = life.moments().expect("finite");
        let std = (3.0 / certainty / 8.0).sqrt();
        assert!((found.mean / 1.5 - 1.0).abs() < 1e-9, "{k}: {found:?}");
        assert!((found.std / std - 1.0).abs() < 1e-6, "{k}: {found:?} {std}");
        // Inverse Gaussian increments: the mean exposure of the process, exact but for what vanishes.
        if k >= 2 {
            let law = Law::new(&InverseGaussian, [2.0, certainty]).expect("valid");
            let life = FirstPassage::new(law, Clock::linear(1.0).expect("valid"), 3.0).expect("valid");
            let found = life.moments().expect("finite");
            let mean = life.typical();
            assert!((found.mean / mean - 1.0).abs() < 1e-9, "{k}: {found:?} {mean}");
        }
    }
}
