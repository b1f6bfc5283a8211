//! Closed forms against drawn paths.

use rand::RngExt;

use super::*;
use crate::process::Gamma;
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
