//! Every process against its own definitions, against `rand_distr`, and against published formulas.

use rand::RngExt;

use super::*;
use crate::life::{Clock, FirstPassage, Law, LifeStatistics, Lifetime};
use crate::random::Stream;
use crate::special::normal_density;

/// ln 2 and ln 0.8: laws of moderate scatter for all processes.
const LOGS: [f64; 2] = [core::f64::consts::LN_2, -0.223_143_551_314_209_76];

fn life(process: &'static dyn Process, parameters: [f64; 2], threshold: f64) -> FirstPassage {
    let law = Law::new(process, parameters).expect("positive");
    FirstPassage::new(law, Clock::linear(1.0).expect("positive"), threshold).expect("wear is left")
}

#[test]
fn densities_sum_to_the_cumulative_law() {
    for process in PROCESSES {
        let powers = process.exposure_powers();
        let exposure: f64 = 1.7;
        let logs = [0, 1].map(|k: usize| LOGS[k] + powers[k] * exposure.ln());
        let (from, to, cells) = (1.0, 4.0, 3000);
        let width = (to - from) / f64::from(cells);
        let density = |k: i32| process.density(logs, from + width * (f64::from(k) + 0.5)).value.exp();
        let sum: f64 = (0..cells).map(|k| width * density(k)).sum();
        let cumulative = |wear: f64| process.cumulative(LOGS, exposure, wear);
        // Midpoint rule: width² / 24 of the change of the slope.
        assert!((sum - cumulative(to) + cumulative(from)).abs() < 1e-6, "{process:?}");
        for p in [1e-3, 0.3, 0.7, 0.999] {
            assert!((cumulative(process.quantile(LOGS, exposure, p)) - p).abs() < 1e-12, "{process:?} {p}");
        }
    }
}

#[test]
fn a_slice_is_the_sum_of_the_densities() {
    let increments = [(0.5, 0.7), (1.0, 2.5), (2.0, 3.1)];
    for process in PROCESSES {
        let powers = process.exposure_powers();
        let slice = process.slice(LOGS[0], &increments);
        let sum = |second: f64| -> f64 {
            let one = |(exposure, wear): &(f64, f64)| {
                let logs = [LOGS[0] + powers[0] * exposure.ln(), second + powers[1] * exposure.ln()];
                process.density(logs, *wear).value
            };
            increments.iter().map(one).sum()
        };
        for second in [-1.0, 0.0, slice.peak()] {
            assert!((slice.at(second) - sum(second)).abs() < 1e-12, "{process:?}");
        }
        assert!(slice.at(slice.peak()) > slice.at(slice.peak() + 0.01).max(slice.at(slice.peak() - 0.01)));
    }
}

#[test]
fn drawn_increments_follow_the_cumulative_law() {
    for process in PROCESSES {
        let mut stream = Stream::new(21, 0, 0);
        let n = 20_000;
        let law = |wear: f64| process.cumulative(LOGS, 0.4, wear);
        let mut places: Vec<f64> = (0..n).map(|_| law(process.draw(LOGS, 0.4, &mut stream))).collect();
        places.sort_by(f64::total_cmp);
        let off = |(at, p): (usize, &f64)| (p - (at as f64 + 0.5) / f64::from(n)).abs();
        let distance = places.iter().enumerate().map(off).fold(0.0, f64::max);
        // Kolmogorov's critical value at 0.1 %.
        assert!(distance < 1.95 / f64::from(n).sqrt(), "{process:?}: {distance}");
    }
}

#[test]
fn inverse_gaussian_draws_have_the_quantiles_of_rand_distr() {
    let n = 40_000;
    for (mean, shape) in [(1.0, 0.1), (2.0, 3.0), (1.0, 500.0)] {
        let (logs, mut stream) = ([mean, shape].map(f64::ln), Stream::new(22, 0, 0));
        let mut ours: Vec<f64> = (0..n).map(|_| InverseGaussian.draw(logs, 1.0, &mut stream)).collect();
        let oracle = rand_distr::InverseGaussian::new(mean, shape).expect("positive");
        let mut theirs: Vec<f64> = (0..n).map(|_| stream.sample(oracle)).collect();
        ours.sort_by(f64::total_cmp);
        theirs.sort_by(f64::total_cmp);
        let below = |x: &f64| theirs.partition_point(|y| y <= x);
        let distance = ours.iter().enumerate().map(|(at, x)| below(x).abs_diff(at)).max().unwrap_or(n);
        // Smirnov's two-sample distance, critical value at 0.1 %: 1.9495 sqrt(2 / n).
        assert!((distance as f64) < 1.9495 * (2.0 * n as f64).sqrt(), "{mean} {shape}: {distance} of {n}");
    }
}

#[test]
fn survival_failure_and_hazard_belong_together() {
    for process in PROCESSES {
        for (exposure, left) in [(0.5, 3.0), (2.0, 3.0), (9.0, 3.0), (40.0, 3.0)] {
            let alive = |exposure: f64| process.survival(LOGS, exposure, left);
            assert!((alive(exposure) + process.failure(LOGS, exposure, left) - 1.0).abs() < 1e-14);
            let step = 1e-5 * exposure;
            let slope = (alive(exposure - step).ln() - alive(exposure + step).ln()) / (2.0 * step);
            let hazard = process.hazard(LOGS, exposure, left);
            // Central difference: rounding of 1 - S, 1e-16 / step, and curvature.
            assert!(
                (slope - hazard).abs() < 1e-6 * hazard + 1e-10,
                "{process:?} {exposure}: {slope} {hazard}"
            );
        }
    }
}

#[test]
fn a_wiener_passage_has_the_moments_of_the_inverse_gaussian_law() {
    // Folks & Chhikara (1978): mean left / drift, variance left spread² / drift³.
    let (drift, spread, left) = (2.0, 0.8, 10.0);
    let moments = life(&Wiener, [drift, spread], left).moments().expect("finite");
    assert!((moments.mean - left / drift).abs() < 1e-9, "{moments:?}");
    assert!(
        (moments.std.powi(2) / (left * spread * spread / drift.powi(3)) - 1.0).abs() < 1e-8,
        "{moments:?}"
    );
    // The closed form is that of paths: small steps, and Gobet's and Asmussen's shift 0.5826 spread sqrt(step) for the
    // crossings between two of them.
    let step: f64 = 0.01;
    let seen: Vec<f64> = (0..2000)
        .map(|path| {
            let (mut stream, mut wear, mut steps) = (Stream::new(23, path, 0), 0.0, 0.0);
            while wear < left - 0.5826 * spread * step.sqrt() {
                wear += Wiener.draw([drift.ln(), spread.ln()], step, &mut stream);
                steps += 1.0;
            }
            steps * step
        })
        .collect();
    let seen = LifeStatistics::of(&seen).expect("lives");
    assert!((seen.mean().value - moments.mean).abs() < 3.0 * seen.mean().error, "{:?}", seen.mean());
    assert!((seen.std().value - moments.std).abs() < 3.0 * seen.std().error, "{:?}", seen.std());
}

#[test]
fn the_mean_exposure_is_the_mean_of_the_passage() {
    for (process, parameters) in
        [(&Gamma as &dyn Process, [3.0, 2.0]), (&Wiener, [2.0, 0.8]), (&InverseGaussian, [2.0, 100.0])]
    {
        let moments = life(process, parameters, 10.0).moments().expect("finite");
        // Exact but for e^-20 and Phi(-15); the accuracy of the integrals.
        let mean = process.mean_exposure(parameters.map(f64::ln), 10.0);
        assert!((moments.mean / mean - 1.0).abs() < 1e-8, "{process:?}: {} {mean}", moments.mean);
    }
}

#[test]
fn the_mean_exposure_of_an_inverse_gaussian_process_is_exact_however_little_wear_is_left() {
    // Below the last two left / drift + drift / (2 spread) is 60 and 5e8 times the mean.
    for (parameters, left) in [([2.0, 3.0], 2.0), ([2.0, 3.0], 1e-2), ([2.0, 3.0], 1e-4), ([1e9, 1.0], 1.0)] {
        let moments = life(&InverseGaussian, parameters, left).moments().expect("finite");
        let mean = InverseGaussian.mean_exposure(parameters.map(f64::ln), left);
        // The accuracy of the integrals.
        assert!((moments.mean / mean - 1.0).abs() < 1e-8, "{parameters:?} {left}: {} {mean}", moments.mean);
    }
    // Beyond all numbers but for its limit, 2 phi(0) / k.
    let mean = InverseGaussian.mean_exposure([690.0, -690.0], 1.0);
    assert!((mean / (2.0 * normal_density(0.0) * 345.0_f64.exp()) - 1.0).abs() < 1e-12, "{mean}");
}

/// Variations of what differs between units: far from 0, and so large that a normal law has to be cut off.
const CVS: [f64; 2] = [0.1, 0.4];

#[test]
fn mixed_densities_sum_to_the_mixed_law() {
    for process in PROCESSES {
        let (effect, powers) = (process.random_effect().expect("a law"), process.exposure_powers());
        for cv in CVS {
            let exposure: f64 = 1.7;
            let logs = [0, 1].map(|k: usize| LOGS[k] + powers[k] * exposure.ln());
            let (from, to, cells) = (1.0, 4.0, 3000);
            let width = (to - from) / f64::from(cells);
            let density = |k: i32| effect.ln_density(logs, cv, from + width * (f64::from(k) + 0.5)).exp();
            let sum: f64 = (0..cells).map(|k| width * density(k)).sum();
            let tails = |wear: f64| effect.tails(LOGS, cv, exposure, wear);
            // Midpoint rule: width² / 24 of the change of the slope.
            assert!((sum - tails(to).0 + tails(from).0).abs() < 1e-6, "{process:?} {cv}");
            assert!((tails(to).0 + tails(to).1 - 1.0).abs() < 1e-9, "{process:?} {cv}");
        }
    }
}

#[test]
fn units_drawn_wear_and_fail_by_the_mixed_law() {
    for process in PROCESSES {
        let effect = process.random_effect().expect("a law");
        for cv in CVS {
            let (exposure, left, n) = (1.7, 3.0, 20_000);
            let mut stream = Stream::new(27, 0, 0);
            let units: Vec<[f64; 2]> = (0..n).map(|_| effect.draw(LOGS, cv, &mut stream)).collect();
            let mut places: Vec<f64> = units
                .iter()
                .map(|logs| effect.tails(LOGS, cv, exposure, process.draw(*logs, exposure, &mut stream)).0)
                .collect();
            places.sort_by(f64::total_cmp);
            let off = |(at, p): (usize, &f64)| (p - (at as f64 + 0.5) / f64::from(n)).abs();
            let distance = places.iter().enumerate().map(off).fold(0.0, f64::max);
            // Kolmogorov's critical value at 0.1 %.
            assert!(distance < 1.95 / f64::from(n).sqrt(), "{process:?} {cv}: {distance}");
            let alive =
                units.iter().map(|logs| process.survival(*logs, exposure, left)).sum::<f64>() / f64::from(n);
            let (survives, fails) = effect.survival(LOGS, cv, exposure, left);
            // Four standard errors of a mean of values between 0 and 1.
            assert!(
                (alive - survives).abs() < 2.0 / f64::from(n).sqrt(),
                "{process:?} {cv}: {alive} {survives}"
            );
            assert!((survives + fails - 1.0).abs() < 1e-9, "{process:?} {cv}");
        }
    }
}

#[test]
fn what_a_unit_wore_and_what_comes_have_the_law_of_both_together() {
    // f(w1) f(w2 | w1) = f(w1 + w2) times the plain density of the parts given their sum: the chain that likelihoods go by.
    for process in PROCESSES {
        let (effect, powers) = (process.random_effect().expect("a law"), process.exposure_powers());
        let over = |logs: [f64; 2], exposure: f64| [0, 1].map(|k: usize| logs[k] + powers[k] * exposure.ln());
        for cv in CVS {
            let ((first, w1), (second, w2)) = ((0.8, 1.1), (1.9, 4.2));
            let (own, own_cv) = effect.after(LOGS, cv, first, w1).expect("a law of the same kind");
            let chain = effect.ln_density(over(LOGS, first), cv, w1)
                + effect.ln_density(over(own, second), own_cv, w2);
            let plain = |exposure: f64, wear: f64| process.ln_density(over(LOGS, exposure), wear);
            let both = effect.ln_density(over(LOGS, first + second), cv, w1 + w2)
                + plain(first, w1)
                + plain(second, w2)
                - plain(first + second, w1 + w2);
            assert!((chain - both).abs() < 1e-12, "{process:?} {cv}: {chain} {both}");
            // Two readings or one: the same law of the unit.
            let (twice, cv_twice) = effect.after(own, own_cv, second, w2).expect("a law");
            let (once, cv_once) = effect.after(LOGS, cv, first + second, w1 + w2).expect("a law");
            assert!(
                (twice[0] - once[0]).abs() + (twice[1] - once[1]).abs() + (cv_twice - cv_once).abs() < 1e-13
            );
        }
    }
}

#[test]
fn hardly_any_difference_is_none() {
    for process in PROCESSES {
        let effect = process.random_effect().expect("a law");
        // cv² of the difference: 1e-8 of moderate numbers.
        assert!(
            (effect.ln_density(LOGS, 1e-4, 1.5) - process.ln_density(LOGS, 1.5)).abs() < 1e-7,
            "{process:?}"
        );
        let (alive, failed) = effect.survival(LOGS, 1e-4, 1.7, 3.0);
        assert!((alive - process.survival(LOGS, 1.7, 3.0)).abs() < 1e-7, "{process:?}");
        assert!((failed - process.failure(LOGS, 1.7, 3.0)).abs() < 1e-7, "{process:?}");
    }
}

/// By mpmath, 50 digits: ln of the plain density and of those of units that differ by 0.2 and 2^-10, slopes.
#[test]
#[allow(clippy::excessive_precision, reason = "as computed")]
fn densities_of_large_shapes_keep_their_digits() {
    let effect = Gamma.random_effect().expect("a law");
    for (eta, wear, plain, mixed, slopes) in [
        (
            9.211340371976183,
            1.367398200185398,
            2.5360625924953067,
            [0.3709399685012386, 2.539301766454419],
            [129.72727365269462, -130.06501625270897],
        ),
        (
            18.420680743952367,
            1.350034289220989,
            7.146345072581763,
            [0.38703589582864608, 5.6984206076929888],
            [12999.655073223247, -12999.99999999622],
        ),
        (
            27.631021115928547,
            1.349860562392454,
            11.751571457008357,
            [0.38716492355991875, 5.712530482790785],
            [1299999.6550658268, -1300000.0000650946],
        ),
    ] {
        let logs = [eta, eta - 0.3];
        // Wear and ln beta are known to 1e-16 and 4e-15 of the mean, and the density falls by up to 1.3 sqrt(a) times that; as written
        // it was off by a times as much: 2e-7 and 2e-3.
        let tolerance = 1e-14 * libm::exp(0.5 * eta) + 1e-13;
        let term = Gamma.density(logs, wear);
        assert!((term.value - plain).abs() < tolerance, "{eta}: {}", term.value);
        for (cv, expected) in [0.2, 1.0 / 1024.0].into_iter().zip(mixed) {
            let found = effect.ln_density(logs, cv, wear);
            assert!((found - expected).abs() < tolerance, "{eta} {cv}: {found}");
        }
        for (found, expected) in term.gradient.into_iter().zip(slopes) {
            // Of ln beta's rounding; the curvature is a.
            assert!((found - expected).abs() < 1e-14 * libm::exp(eta) + 1e-11, "{eta}: {found} {expected}");
        }
    }
}
