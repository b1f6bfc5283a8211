//! Posteriors against closed forms, brute force and repeated experiments.

use rand::RngExt;
use rand::distr::Open01;

use super::*;
use crate::life::{Clock, Estimate, FirstPassage, Law, LifeError, Lifetime, OperatingState};
use crate::process::{Gamma, PROCESSES, Wiener};
use crate::quadrature::integrate;
use crate::random::{LnGamma, Stream};
use crate::special::ln_gamma;

const READINGS: [(f64, f64); 6] = [(0.0, 0.0), (1.0, 0.7), (2.0, 1.9), (3.5, 2.8), (4.0, 3.6), (5.0, 4.3)];

fn history(rows: &[(f64, f64)]) -> History {
    let readings = rows.iter().map(|(time, wear)| Reading { time: *time, wear: *wear });
    History::exact(&Gamma, readings.collect()).expect("rising")
}

fn situation() -> OperatingState {
    OperatingState::new(10.0).expect("valid")
}

fn fit() -> Estimate {
    let estimate = Estimate::new(&Gamma, [5.0, 6.0], None).expect("valid");
    estimate.with_log_covariance(&[vec![0.09, 0.08], vec![0.08, 0.10]]).expect("positive")
}

/// I_x(a, b), the regularised incomplete beta function, by its integral over v = ln(s / (1 - s)).
fn beta_reg(a: f64, b: f64, x: f64) -> f64 {
    let ln_density = |v: f64| a * v - (a + b) * v.exp().ln_1p();
    let mode = (a / b).ln();
    let scaled = |v: f64| [(ln_density(v) - ln_density(mode)).exp()];
    let width = (1.0 / a + 1.0 / b).sqrt();
    let (low, end, high) =
        (mode - 40.0 / a - 9.0 * width, (x / (1.0 - x)).ln(), mode + 40.0 / b + 9.0 * width);
    let area = |from: f64, to: f64| {
        let mut limits: Vec<f64> = [-3.0, -1.0, 0.0, 1.0, 3.0].map(|k| mode + k * width).to_vec();
        limits.retain(|v| from < *v && *v < to);
        limits.extend([from, to]);
        limits.sort_by(f64::total_cmp);
        integrate(&scaled, &limits, [1e-10]).0[0]
    };
    let (below, above) = (area(low.min(end), end), area(end, high.max(end)));
    below / (below + above)
}

/// ln of the marginal likelihood of alpha under a flat prior: beta integrated out, but for constants.
fn ln_marginal(rows: &[(f64, f64)], alpha: f64) -> f64 {
    let (mut ln, mut total, mut wear) = (0.0, 0.0, 0.0);
    for pair in rows.windows(2) {
        let (shape, step) = (alpha * (pair[1].0 - pair[0].0), pair[1].1 - pair[0].1);
        ln += shape * step.ln() - ln_gamma(shape);
        total += shape;
        wear += step;
    }
    ln + ln_gamma(total) - total * wear.ln()
}

#[test]
fn a_flat_prior_agrees_with_the_beta_integral() {
    // beta given alpha is Gamma(alpha Lambda, W), so P(T > t | alpha) = I_rho(alpha t, alpha Lambda), rho = r / (r + W),
    // r the wear that is left: one integral over ln alpha is left, here a fine trapezoid sum.
    let posterior = Posterior::update(
        &history(&READINGS),
        &Prior::Flat { process: &Gamma, power_law: false },
        &situation(),
    )
    .expect("proper");
    let (exposure, wear) = READINGS[5];
    let rho = (10.0 - wear) / 10.0;
    for t in [2.0, 5.0, 6.5, 9.0, 15.0] {
        let (mut sum, mut total) = (0.0, 0.0);
        for k in -1200..1200 {
            let alpha = (0.01 * f64::from(k)).exp();
            let weight = ln_marginal(&READINGS, alpha).exp();
            if weight > 0.0 {
                sum += weight * beta_reg(alpha * t, alpha * exposure, rho);
                total += weight;
            }
        }
        let (expected, found) = (sum / total, posterior.reliability(t));
        // The step of the nested rule: 1e-6.
        assert!((expected - found).abs() < 1e-6, "{t}: {expected} {found}");
        assert!((posterior.failed(t) + found - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_fit_as_prior_agrees_with_brute_force() {
    let posterior = Posterior::update(&history(&READINGS), &Prior::Fit(fit()), &situation()).expect("proper");
    // Plain midpoint sum over +-6 standard deviations of the prior, 200 x 200; precision of [[.09, .08], [.08, .10]].
    let determinant = 0.09 * 0.10 - 0.08 * 0.08;
    let (mut alive, mut mean, mut total) = ([0.0; 3], 0.0, 0.0);
    let times = [4.0, 6.0, 9.0];
    for i in 0..200 {
        let a = 12.0 * 0.3 * ((f64::from(i) + 0.5) / 200.0 - 0.5);
        for j in 0..200 {
            let b = 12.0 * 0.10_f64.sqrt() * ((f64::from(j) + 0.5) / 200.0 - 0.5);
            let square = (0.10 * a * a - 2.0 * 0.08 * a * b + 0.09 * b * b) / determinant;
            let (alpha, beta) = (5.0 * a.exp(), 6.0 * b.exp());
            let mut ln = -0.5 * square;
            for pair in READINGS.windows(2) {
                let (shape, step) = (alpha * (pair[1].0 - pair[0].0), pair[1].1 - pair[0].1);
                ln += shape * beta.ln() - ln_gamma(shape) + (shape - 1.0) * step.ln() - beta * step;
            }
            let weight = ln.exp();
            if square > 60.0 {
                continue;
            }
            let law = Law::new(&Gamma, [alpha, beta]).expect("valid");
            let life = FirstPassage::new(law, Clock::linear(1.0).expect("valid"), 10.0 - 4.3).expect("valid");
            for (sum, t) in alive.iter_mut().zip(times) {
                *sum += weight * life.reliability(t);
            }
            mean += weight * (beta * 5.7 + 0.5) / alpha;
            total += weight;
        }
    }
    for (sum, t) in alive.iter().zip(times) {
        let (expected, found) = (sum / total, posterior.reliability(t));
        // The sum leaves out e^-30 of the prior; its cells are a tenth of the posterior's width.
        assert!((expected - found).abs() < 1e-6, "{t}: {expected} {found}");
    }
    // The mean of a passage is (beta r + 1/2) / alpha but for e^-(beta r); the nested rule is good to 1e-6.
    let found = posterior.moments().expect("finite").mean;
    assert!((found * total / mean - 1.0).abs() < 1e-5, "{found} {}", mean / total);
}

#[test]
fn many_readings_outweigh_the_prior_and_none_leave_it() {
    let prior = fit();
    let nearly = prior.clone().with_log_covariance(&[vec![1e-10, 0.0], vec![0.0, 1e-10]]).expect("positive");
    let sharp = Posterior::update(&history(&READINGS), &Prior::Fit(nearly), &situation()).expect("proper");
    let known = Estimate::new(&Gamma, [5.0, 6.0], None).expect("valid");
    let point = Posterior::update(&history(&READINGS), &Prior::Fit(known), &situation()).expect("proper");
    assert_eq!(point.nodes(), 1);
    // Parameters known to 1e-5.
    assert!((sharp.quantile(0.3).expect("p") / point.quantile(0.3).expect("p") - 1.0).abs() < 1e-4);
    let posterior = Posterior::update(&history(&READINGS), &Prior::Fit(prior), &situation()).expect("proper");
    // Readings narrow what the prior left open.
    assert!(posterior.parameters()[0].std < 0.3);
}

#[test]
fn an_exponent_is_learned_too() {
    // Wear as the cube root of exposure, a little scatter.
    let rows: Vec<(f64, f64)> = [1.0f64, 4.0, 10.0, 30.0, 60.0, 100.0]
        .iter()
        .zip([0.02, -0.02, 0.03, -0.03, 0.01, 0.0])
        .map(|(t, off)| (*t, t.cbrt() + off))
        .collect();
    let mut rows = rows;
    rows.insert(0, (0.0, 0.0));
    let flat = Prior::Flat { process: &Gamma, power_law: true };
    let posterior =
        Posterior::update(&history(&rows), &flat, &OperatingState::new(6.0).expect("valid")).expect("proper");
    let exponent = posterior.parameters()[2];
    // Within two posterior standard deviations.
    assert!((exponent.mean - (1.0_f64 / 3.0).ln()).abs() < 2.0 * exponent.std, "{exponent:?}");
    // Wear 6 is reached at 216 in the mean: 116 from now.
    let median = posterior.quantile(0.5).expect("p");
    assert!((80.0..170.0).contains(&median), "{median}");
    assert_eq!(posterior.moments(), Err(LifeError::HeavyExponent));
}

/// A unit drawn from the prior: its readings at 0, 1, .. 6 until the threshold, and its true remaining life.
fn unit(draws: &mut Stream, prior: &Estimate) -> Option<(Vec<(f64, f64)>, f64)> {
    let logs = prior.drawn_logs(draws);
    let (alpha, beta) = (logs[0].exp(), logs[1].exp());
    let mut rows = vec![(0.0, 0.0)];
    let mut wear = 0.0;
    for n in 1..=4 {
        wear += draws.sample(LnGamma(alpha)).exp() / beta;
        rows.push((f64::from(n), wear));
    }
    if wear >= 10.0 {
        return None;
    }
    // Its life given what is left, by the law of passage of its own parameters.
    let law = Law::new(&Gamma, [alpha, beta]).ok()?;
    let life = FirstPassage::new(law, Clock::linear(1.0).ok()?, 10.0 - wear).ok()?;
    Some((rows, life.quantile(draws.sample(Open01)).ok()?))
}

#[test]
fn intervals_hold_the_life_of_500_units_as_often_as_they_say() {
    let (prior, mut unit_at) = (fit(), 0);
    let (mut held, mut held_half, mut count) = (0, 0, 0);
    while count < 500 {
        unit_at += 1;
        let Some((rows, truth)) = unit(&mut Stream::new(2024, unit_at, 0), &prior) else { continue };
        let posterior =
            Posterior::update(&history(&rows), &Prior::Fit(prior.clone()), &situation()).expect("proper");
        // Between the quantiles p and 1 - p exactly if the distribution at the truth is.
        let place = posterior.failed(truth);
        held += usize::from((0.05..=0.95).contains(&place));
        held_half += usize::from((0.25..=0.75).contains(&place));
        count += 1;
    }
    let (part, half) = (held as f64 / count as f64, held_half as f64 / count as f64);
    // Binomial standard errors 0.0134 and 0.0224; three of each.
    assert!((part - 0.9).abs() < 0.040, "{part}");
    assert!((half - 0.5).abs() < 0.067, "{half}");
    println!("coverage of 90 % and 50 % intervals over 500 units: {part} {half}");
}

#[test]
fn little_gauge_error_gives_what_exact_readings_give() {
    let readings: Vec<Reading> =
        READINGS[1..4].iter().map(|(time, wear)| Reading { time: *time, wear: *wear }).collect();
    let noisy = History::noisy(readings).expect("numbers");
    let effort = Effort { count: 20_000, seed: 4 };
    let particles = Particles::follow(&noisy, &fit(), &situation(), 0.05, effort).expect("explained");
    let exact =
        Posterior::update(&history(&READINGS[..4]), &Prior::Fit(fit()), &situation()).expect("proper");
    for t in [4.0, 7.0, 10.0] {
        // Some 1,000 different particles: standard error 0.016; and the gauge's 0.05 of wear. Three of it.
        let (a, b) = (particles.reliability(t), exact.reliability(t));
        assert!((a - b).abs() < 0.05, "{t}: {a} {b} ({} particles)", particles.distinct());
    }
    let (wear, spread) = particles.wear();
    assert!((wear - 2.8).abs() < 0.05 && spread < 0.06, "{wear} {spread}");
    let again = Particles::follow(&noisy, &fit(), &situation(), 0.05, effort).expect("explained");
    assert_eq!(again.reliability(7.0), particles.reliability(7.0));
}

#[test]
fn a_gauge_without_error_says_what_exact_readings_say_of_the_beginning() {
    // From the new joint on, and from wear that is read at time 0; a tenth of a gauge's error there is none.
    let cases: [(&[(f64, f64)], f64); 3] = [
        (&[(2.0, 1.5), (4.0, 3.2)], 0.0),
        (&[(0.0, 2.0), (3.0, 4.6)], 2.0),
        (&[(0.0, 0.005), (3.0, 2.6)], 0.0),
    ];
    for (rows, begins) in cases {
        let readings: Vec<Reading> =
            rows.iter().map(|(time, wear)| Reading { time: *time, wear: *wear }).collect();
        let noisy = History::noisy(readings.clone()).expect("numbers");
        let effort = Effort { count: 40_000, seed: 4 };
        let particles = Particles::follow(&noisy, &fit(), &situation(), 0.05, effort).expect("explained");
        let begun = [&[(0.0, begins)], &rows[usize::from(rows[0].0 == 0.0)..]].concat();
        let plain = Posterior::update(&history(&begun), &Prior::Fit(fit()), &situation()).expect("proper");
        let exact = History::exact(&Gamma, readings).expect("rising");
        let exact = Posterior::update(&exact, &Prior::Fit(fit()), &situation()).expect("proper");
        for p in [0.1, 0.5] {
            let told = |life: &dyn Lifetime| life.quantile(p).expect("a law");
            // Wear of 0.005 at the beginning is a thousandth of what is left.
            assert!((told(&exact) / told(&plain) - 1.0).abs() < 2e-3, "{rows:?} {p}");
            // Some 1,000 different particles, and the gauge's 0.05 of wear.
            assert!((told(&particles) / told(&plain) - 1.0).abs() < 0.04, "{rows:?} {p}");
        }
    }
}

#[test]
fn a_flat_prior_of_few_readings_and_an_exponent_comes_to_an_end() {
    let rows = [(0.0, 0.0), (1.0, 2.0), (2.0, 4.5), (3.5, 6.0), (5.0, 7.1), (6.0, 7.9), (8.0, 9.0)];
    for count in [4, 5, 7] {
        let flat = Prior::Flat { process: &Gamma, power_law: true };
        let state = OperatingState::new(30.0).expect("valid");
        let posterior = Posterior::update(&history(&rows[..count]), &flat, &state).expect("proper");
        let quantiles = [0.1, 0.5, 0.9, 0.999].map(|p| posterior.quantile(p).expect("a number"));
        assert!(quantiles.is_sorted(), "{quantiles:?}");
        // Exponents near zero put the rarest lives beyond all numbers.
        let rarest = posterior.quantile(1.0 - 1e-9);
        assert_eq!(rarest.is_err(), count < 7, "{rarest:?}");
        // Every node has its answer, if only that there is none.
        let at = |life: &FirstPassage| Ok((life.quantile(0.5).unwrap_or(f64::INFINITY), 1.0));
        let band = posterior.credible(quantiles[1], 0.5, &at).expect("a level");
        assert!(band.lower < quantiles[1] && quantiles[1] < band.upper, "{band:?} {quantiles:?}");
    }
}

#[test]
fn a_coarse_gauge_bears_readings_that_fall() {
    let rows = [(1.0, 0.9), (2.0, 0.8), (3.0, 2.6)];
    let readings = rows.iter().map(|(time, wear)| Reading { time: *time, wear: *wear }).collect();
    let noisy = History::noisy(readings).expect("numbers");
    let effort = Effort { count: 5000, seed: 1 };
    let particles = Particles::follow(&noisy, &fit(), &situation(), 0.5, effort).expect("explained");
    assert!(particles.quantile(0.5).expect("p") > 0.0);
    assert_eq!(particles.failed_already(), 0.0);
    // Wear far above what the fit can give: the row is named.
    let far = History::noisy(vec![Reading { time: 1.0, wear: 9.9 }]).expect("numbers");
    let error = Particles::follow(&far, &fit(), &situation(), 0.01, effort).expect_err("contradiction");
    assert!(matches!(error, InspectionError::Degenerate { row: 1, .. }), "{error}");
    let error = Particles::follow(&far, &fit(), &situation(), 0.0, effort).expect_err("no error");
    assert_eq!(error, InspectionError::Gauge { value: 0.0 });
}

#[test]
fn what_cannot_be_learned_from_is_refused() {
    let flat = Prior::Flat { process: &Gamma, power_law: false };
    let two = history(&READINGS[..2]);
    assert!(matches!(
        Posterior::update(&two, &flat, &situation()),
        Err(InspectionError::TooFew { readings: 2, needed: 3, .. })
    ));
    let line = history(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
    assert!(matches!(
        Posterior::update(&line, &flat, &situation()),
        Err(InspectionError::Proportional { readings: 4 })
    ));
    let over = history(&[(0.0, 0.0), (1.0, 10.5)]);
    assert!(matches!(
        Posterior::update(&over, &Prior::Fit(fit()), &situation()),
        Err(InspectionError::Life(LifeError::Failed { .. }))
    ));
    let few = Posterior::update(&history(&READINGS[..4]), &flat, &situation()).expect("proper");
    assert!(matches!(few.moments(), Err(LifeError::HeavyTail { increments: 3, needed: 4 })));
    assert!(few.quantile(0.5).is_ok());
}

#[test]
fn a_catalogue_counts_as_much_as_it_is_sure_of() {
    let rows: Vec<Reading> = READINGS.map(|(time, wear)| Reading { time, wear }).to_vec();
    for process in PROCESSES {
        let history = History::exact(process, rows.clone()).expect("rising");
        let ln_mean = |prior: &Prior| {
            let posterior = Posterior::update(&history, prior, &situation()).expect("proper");
            let [first, second] = [0, 1].map(|at| posterior.parameters()[at].mean);
            (process.ln_mean([first, second]), posterior.quantile(0.5).expect("a law"))
        };
        let catalogue = |range| ln_mean(&Prior::catalogue(process, range).expect("a range"));
        // Twice as fast as it wears, sure to a thousandth: no reading changes that.
        let (mean, sure) = catalogue([1.719, 1.721]);
        assert!((mean - 1.72_f64.ln()).abs() < 1e-3, "{process:?} {mean}");
        let (mean, unsure) = catalogue([0.5, 6.0]);
        let seen = (4.3_f64 / 5.0).ln();
        assert!(mean > seen && mean < 1.72_f64.ln(), "{process:?} {mean}");
        // The rest of the wear at that rate, nearly: readings so far off it say that wear scatters, so lives are skew.
        assert!(sure < unsure && (sure / (5.7 / 1.72) - 1.0).abs() < 0.15, "{process:?} {sure} {unsure}");
        // So wide that it says nothing: a flat prior, whose powers of the drift the catalogue's law does not have.
        let flat = ln_mean(&Prior::Flat { process, power_law: false }).1;
        let nothing = catalogue([1e-9, 1e9]).1;
        if process.flat_prior_power() == 0.0 {
            // The curvature of so wide a law: ln mean is known to 0.1 of its 10.6.
            assert!((nothing / flat - 1.0).abs() < 1e-3, "{process:?} {nothing} {flat}");
        }
    }
    for range in [[0.0, 1.0], [2.0, 1.0], [1.0, 1.0], [f64::NAN, 1.0], [1.0, f64::INFINITY]] {
        let error = Prior::catalogue(&Gamma, range).expect_err("no range");
        assert!(matches!(error, LifeError::CatalogueRange { .. }));
    }
    let wiener = Prior::catalogue(&Wiener, [0.5, 2.0]).expect("a range");
    let rows = READINGS.map(|(time, wear)| Reading { time, wear }).to_vec();
    let history = History::exact(&Wiener, rows).expect("numbers");
    let posterior = Posterior::update(&history, &wiener, &situation()).expect("proper");
    assert!(posterior.moments().is_ok(), "drifts near 0 are out of the question");
}
