use super::*;
use crate::data::{Gauge, Observations, Reading as Datum};
use crate::fit::{Model, estimate};
use crate::fit_file::FitFile;
use crate::inspection::Reading;
use crate::process::{Gamma, InverseGaussian, PROCESSES, Process, Wiener};
use crate::random::Stream;

/// GaAs lasers (Meeker & Escobar, 1998, table C.17), with a covariance of some percent.
fn lasers() -> Estimate {
    let estimate = Estimate::new(&Gamma, [28.753_506_06, 14.114_459_33], None).expect("valid");
    estimate.with_log_covariance(&[vec![7e-3, 6e-3], vec![6e-3, 7e-3]]).expect("positive definite")
}

fn state() -> OperatingState {
    OperatingState::new(10.0).expect("positive")
}

fn asked() -> Questions {
    Questions {
        survived: 0.0,
        quantiles: vec![0.01, 0.5],
        times: vec![0.0, 4.5],
        missions: vec![[0.0, 4.5], [4.5, 5.0]],
    }
}

#[test]
fn answers_are_those_of_the_law() {
    let (estimate, state) = (lasers(), state());
    let life = state.life(&estimate).expect("valid");
    let told = Prediction::by_fit(&estimate, &state, Method::Delta, &asked()).expect("valid");
    let [(p, b1), (_, median)] = told.answers.quantiles[..] else { panic!("two were asked") };
    assert_eq!((p, b1.value), (0.01, life.quantile(0.01).expect("valid")));
    assert_eq!(median, told.quantiles[1]);
    assert!(b1.lower < b1.value && b1.value < b1.upper);
    let [new, later] = &told.answers.times[..] else { panic!("two were asked") };
    let (moments, band) = told.moments.expect("finite");
    let rest = new.rest.expect("finite");
    // The same integral, and the same band.
    assert_eq!((rest.value, rest), (moments.mean, band));
    let alive = life.reliability(4.5);
    assert_eq!(later.reliability.value, alive);
    let [first, second] = told.answers.missions[..] else { panic!("two were asked") };
    assert_eq!(first.1, later.reliability);
    assert!((second.1.value - life.reliability(5.0) / alive).abs() < 1e-15);
    // Mean rest from the mean: E T = E min(T, t) + S(t) rest, the first term by Simpson's rule on a smooth function.
    let n = 2000;
    let step = 4.5 / f64::from(n);
    let simpson: f64 = (0..n)
        .map(|at| {
            let [a, b, c] = [0.0, 0.5, 1.0].map(|part| life.reliability((f64::from(at) + part) * step));
            step * (a + 4.0 * b + c) / 6.0
        })
        .sum();
    let expected = (moments.mean - simpson) / alive;
    assert!((later.rest.expect("finite").value / expected - 1.0).abs() < 1e-8);
}

#[test]
fn time_without_failure_counts_in_every_answer() {
    let (estimate, state) = (lasers(), state());
    let life = state.life(&estimate).expect("valid");
    let questions = Questions { survived: 4.5, missions: vec![[0.2, 0.5]], ..asked() };
    let told = Prediction::by_fit(&estimate, &state, Method::Delta, &questions).expect("valid");
    let rest = |t: f64| life.reliability(4.5 + t) / life.reliability(4.5);
    assert!((rest(told.quantiles[1].value) - 0.5).abs() < 1e-12);
    assert!((told.answers.missions[0].1.value - rest(0.5) / rest(0.2)).abs() < 1e-12);
    assert_eq!(told.course[0].1.value, 1.0);
    assert!(told.interval.0 < told.quantiles[1].value && told.quantiles[1].value < told.interval.1);
    let new = Prediction::by_fit(&estimate, &state, Method::Delta, &asked()).expect("valid");
    // Wear that is not seen: the rest is shorter than a new life, and longer than a new life less the time.
    let (here, whole) = (told.moments.expect("finite").0.mean, new.moments.expect("finite").0.mean);
    assert!(here < whole && here > whole - 4.5);
}

#[test]
fn a_reading_and_time_since_it_without_failure() {
    let reading = |time, wear| Reading { time, wear };
    let readings = vec![reading(0.0, 0.0), reading(1.0, 2.1), reading(2.0, 3.9), reading(3.0, 6.2)];
    let history = History::exact(&Gamma, readings).expect("rising");
    let flat = Prior::Flat { process: &Gamma, power_law: false };
    let now = state().worn(6.2, 3.0).expect("below");
    let posterior = Posterior::update(&history, &flat, &state()).expect("valid");
    let questions = Questions { survived: 2.4, times: vec![0.5], ..Questions::default() };
    let told = Prediction::after(&history, &flat, &now, &questions).expect("valid");
    let expected = posterior.reliability(2.9) / posterior.reliability(2.4);
    assert!((told.answers.times[0].reliability.value - expected).abs() < 1e-12);
    // The band is of parameters by which it got that far: it lies around the value.
    let Band { value, lower, upper } = told.answers.times[0].reliability;
    assert!(lower < value && value < upper);
    // Without weighing, parameters by which it should have failed would pull the band down.
    let unweighed = posterior
        .credible(value, Prediction::LEVEL, &|life| {
            Ok((Survived::new(life, 2.4).map_or(0.0, |rest| rest.reliability(0.5)), 1.0))
        })
        .expect("valid");
    assert!(unweighed.lower < lower, "{unweighed:?} {lower}");
}

#[test]
fn the_band_of_the_mean_after_readings_is_of_means_and_holds_it() {
    let log = [(1.0, 2.5), (2.5, 4.1), (4.0, 8.7)].map(|(time, wear)| Reading { time, wear }).to_vec();
    let near = |process: &'static dyn Process, parameters, exponent, left: f64| {
        let estimate = Estimate::new(process, parameters, exponent).expect("valid");
        let size = estimate.logs().len();
        let logs = (0..size).map(|i| (0..size).map(|j| if i == j { 0.01 } else { 0.0 }).collect());
        let prior = Prior::Fit(estimate.with_log_covariance(&logs.collect::<Vec<_>>()).expect("definite"));
        let history = History::exact(process, log.clone()).expect("rising");
        let state = OperatingState::new(8.7 + left).expect("positive");
        let told = |survived| {
            let questions = Questions { survived, ..Questions::default() };
            Prediction::after(&history, &prior, &state, &questions).expect("explained").moments
        };
        [0.0, 1e-9].map(|survived| told(survived).expect("finite").1)
    };
    let cases =
        [(&Gamma as &dyn Process, None, 0.01), (&InverseGaussian, None, 0.01), (&Gamma, Some(0.3), 10.0)];
    for (process, exponent, left) in cases {
        // A mean below its band, and with an exponent a band 6 % too low, were told: those of the exposure at failure.
        let [band, again] = near(process, [3.0, 1.4], exponent, left);
        assert!(band.lower < band.value && band.value < band.upper, "{process:?} {left}: {band:?}");
        // A moment without failure changes by that moment, or by the few that it ended.
        for (a, b) in [(band.lower, again.lower), (band.upper, again.upper)] {
            assert!((a / b - 1.0).abs() < 1e-4, "{process:?} {left}: {band:?} {again:?}");
        }
    }
}

#[test]
fn a_machine_of_one_joint_is_its_joint_and_of_two_sooner_at_its_end() {
    let member = Member { estimate: lasers(), state: state() };
    let questions = Questions { survived: 0.5, ..asked() };
    let one = Machine::new(std::slice::from_ref(&member), &questions).expect("valid");
    let joint =
        Prediction::by_fit(&member.estimate, &member.state, Method::Delta, &questions).expect("valid");
    // The same formulas but for products of one factor.
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    near(one.moments.expect("finite").0.mean, joint.moments.expect("finite").0.mean);
    for (a, b) in one.quantiles.iter().zip(&joint.quantiles) {
        near(a.value, b.value);
        near(a.lower, b.lower);
        near(a.upper, b.upper);
    }
    near(one.interval.0, joint.interval.0);
    // Accuracy of the integral.
    assert!((one.first[0] - 1.0).abs() < 1e-8);
    let worn = Member { state: state().worn(3.0, 1.0).expect("below"), ..member.clone() };
    let two = Machine::new(&[member, worn], &questions).expect("valid");
    let lives = [0.0, 3.0].map(|wear| {
        let state = state().worn(wear, wear / 3.0).expect("below");
        state.life(&lasers()).expect("valid")
    });
    let alive = |t: f64| lives.iter().map(|life| life.reliability(0.5 + t)).product::<f64>();
    near(two.answers.times[1].reliability.value, alive(4.5) / alive(0.0));
    near(1.0, two.first.iter().sum());
    assert!(two.first[1] > 0.9 && two.quantiles[1].value < one.quantiles[1].value);
    // Two fits leave open more than one of them.
    let width = |band: Band| (band.upper / band.lower).ln();
    assert!(width(two.quantiles[1]) > 0.5 * width(one.quantiles[1]));
    assert!(matches!(Machine::new(&[], &questions), Err(LifeError::NoMember)));
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let refused = |questions: Questions| {
        Prediction::by_fit(&lasers(), &state(), Method::Delta, &questions).expect_err("impossible")
    };
    let none = Questions::default;
    assert!(matches!(refused(Questions { quantiles: vec![1.0], ..none() }), LifeError::Probability { .. }));
    assert!(matches!(refused(Questions { times: vec![-1.0], ..none() }), LifeError::Negative { .. }));
    assert!(matches!(refused(Questions { survived: f64::NAN, ..none() }), LifeError::Negative { .. }));
    assert!(matches!(refused(Questions { survived: 50.0, ..none() }), LifeError::NoneSurvives { .. }));
    for mission in [[2.0, 1.0], [1.0, 1.0], [0.0, f64::NAN], [0.0, f64::INFINITY]] {
        let error = refused(Questions { missions: vec![mission], ..none() });
        assert!(matches!(error, LifeError::Span { .. }), "{mission:?} {error}");
    }
    // A mission that nobody is alive for.
    let error = refused(Questions { missions: vec![[50.0, 51.0]], ..none() });
    assert!(matches!(error, LifeError::NoneSurvives { .. }), "{error}");
    // No rest where there is none left, but the other answers.
    let late = Questions { times: vec![50.0], ..none() };
    let told = Prediction::by_fit(&lasers(), &state(), Method::Delta, &late).expect("an answer");
    assert_eq!(told.answers.times[0].rest, None);
    assert!(told.answers.times[0].reliability.value < 1e-12);
}

#[test]
fn a_drift_that_may_be_zero_has_no_mean_rest() {
    let reading = |time, wear| Reading { time, wear };
    let history =
        History::noisy(vec![reading(0.0, 0.0), reading(1.0, 1.1), reading(2.0, 1.9), reading(3.0, 3.2)]);
    let flat = Prior::Flat { process: &Wiener, power_law: false };
    let questions = Questions { times: vec![1.0], ..Questions::default() };
    let told = Prediction::after(&history.expect("valid"), &flat, &state(), &questions).expect("quantiles");
    assert!(told.moments.is_none() && told.answers.times[0].rest.is_none());
}

/// Wear over the power 0.7 of exposure, which is counted in units of 1 / `unit`, in two environments.
fn readings(process: &dyn Process, units: usize, unit: f64) -> Vec<Datum> {
    let mut readings = Vec::new();
    for part in 0..units {
        let (mut stream, mut wear) = (Stream::new(11, part as u64, 0), 0.0);
        for step in 0..7_u8 {
            let at = |step: u8| f64::from(step).powf(0.7);
            if step > 0 {
                wear += process.draw([0.9, 0.4], at(step) - at(step - 1), &mut stream);
            }
            readings.push(Datum {
                unit: part.to_string(),
                exposure: f64::from(step) * unit,
                wear,
                covariates: vec![[0.5, 2.0][part % 2]],
                row: readings.len() + 2,
                ..Datum::default()
            });
        }
    }
    readings
}

fn fitted(process: &'static dyn Process, (units, covariates): (usize, usize), unit: f64) -> FitFile {
    let gauge = if process.is_increasing() { Gauge::Exact } else { Gauge::Noisy };
    let mut readings = readings(process, units, unit);
    readings.iter_mut().for_each(|one| one.covariates.truncate(covariates));
    let data = Observations::new(&readings, false, gauge).expect("wear");
    let model = Model { process, power_law: true, covariates, ..Model::default() };
    let fit = estimate(&data, &model).expect("a maximum");
    let names = ["load".to_owned()];
    FitFile::new(&fit, &data, &names[..covariates], ("um", "h"), false)
}

/// Times that are told, in the first unit of exposure.
fn told(process: &'static dyn Process, (units, covariates): (usize, usize), unit: f64) -> Vec<f64> {
    let values = [("load".to_owned(), 2.0)];
    let file = fitted(process, (units, covariates), unit);
    let fit = file.informed(&values[..covariates]).expect("its data");
    let state = OperatingState::new(40.0).expect("positive");
    let questions = Questions::default();
    let mut times = Vec::new();
    let mut add = |told: Prediction| {
        for band in told.quantiles {
            times.extend([band.lower, band.value, band.upper]);
        }
        times.extend([told.interval.0, told.interval.1]);
    };
    for method in [Method::Delta, Method::Draws { count: 100, seed: 3 }] {
        add(Prediction::by_fit(&fit, &state, method, &questions).expect("a law"));
    }
    let log = [(0.0, 0.0), (1.0, 2.0), (2.0, 4.5), (3.5, 6.0), (4.0, 6.5), (6.0, 8.1)];
    let log = log.map(|(time, wear)| Reading { time: time * unit, wear }).to_vec();
    let exact = History::exact(process, log.clone()).expect("rising");
    for prior in [Prior::Fit(fit.clone()), Prior::Flat { process, power_law: true }] {
        // Of few readings and an exponent that may be near zero the later lives have no number, in any unit: they are infinite.
        add(Prediction::after(&exact, &prior, &state, &questions).expect("explained"));
    }
    // Particles take seconds: of one process.
    if process.name() == Gamma.name() {
        let effort = Effort { count: 4000, seed: 1 };
        let noisy = History::noisy(log).expect("numbers");
        add(Prediction::after_gauge(&noisy, &fit, &state, 0.5, effort, &questions).expect("explained"));
    }
    let lives = Prediction::possible_lives(&fit, &state, 40).expect("laws");
    times.extend(lives.as_slice().iter().map(Lifetime::typical));
    // With one answer left out, in one unit alone, there would be fewer.
    times.iter().map(|time| time / unit).collect()
}

#[test]
fn predictions_by_a_power_law_are_the_same_in_every_unit_of_exposure() {
    // Integrated over the parameters, by sets of them, by the normal law of their logarithms.
    let mut cases: Vec<_> = PROCESSES.into_iter().map(|process| (process, (10, 0))).collect();
    cases.extend([(&Wiener as &dyn Process, (10, 1)), (&Wiener, (70, 0))]);
    for (process, data) in cases {
        let plain = told(process, data, 1.0);
        for unit in [1e-6, 1e9] {
            let other = told(process, data, unit);
            assert_eq!(plain.len(), other.len());
            for (at, (a, b)) in plain.iter().zip(other).enumerate() {
                // The maximum is found to 1e-10, and what is drawn around it goes with it.
                assert!(*a == b || (b / a - 1.0).abs() < 1e-6, "{process:?} {data:?} {unit} {at}: {a} {b}");
            }
        }
    }
}

/// Wiener processes whose drifts differ by a third: some 0.1 % of the units never fail.
fn drifting(cv: f64) -> Estimate {
    let logs = [vec![1e-2, 0.0, 0.0], vec![0.0, 1e-3, 0.0], vec![0.0, 0.0, 1e-2]];
    let estimate = Estimate::new(&Wiener, [1.0, 0.3], None).expect("valid").differing(cv).expect("positive");
    estimate.with_log_covariance(&logs).expect("positive definite")
}

#[test]
fn what_never_happens_refuses_no_more_than_what_is_asked_of_it() {
    let told = |cv: f64, p: f64| {
        let asked = Questions { quantiles: vec![p], ..Questions::default() };
        Prediction::by_fit(&drifting(cv), &state(), Method::Delta, &asked)
    };
    // 0.4 % never fail: the course of 99.9 % had no end, and nothing was told.
    let few = told(0.4, 0.01).expect("B1 exists");
    assert_eq!(few.answers.quantiles[0].0, 0.01);
    assert!(
        few.course.iter().all(|(t, band, _)| t.is_finite() && band.value >= 0.09),
        "{:?}",
        few.course.last()
    );
    assert_eq!(few.course.last().map(|last| last.0), Some(few.quantiles[2].value));
    assert!(few.interval.0.is_finite() && few.warnings.iter().any(|text| text.contains("ever fails")));
    // 12 %: neither B90 nor an upper end.
    let many = told(0.85, 0.5).expect("B50 exists");
    assert!(many.quantiles[1].value.is_finite() && many.quantiles[2].value == f64::INFINITY);
    assert!(many.interval.0.is_finite() && many.interval.1 == f64::INFINITY);
    assert_eq!(many.course.last().map(|last| last.0), Some(many.quantiles[1].value));
    // What is asked for and does not exist is refused.
    assert!(matches!(told(0.85, 0.9), Err(LifeError::Never { .. })));
}

#[test]
fn a_quantile_near_the_part_that_ever_fails_has_an_open_band() {
    let estimate = drifting(0.6);
    let ever = state().life(&estimate).expect("valid").ever();
    // So near that a step of the differences leaves no such time.
    let asked = Questions { quantiles: vec![ever - 1e-9], ..Questions::default() };
    let told = Prediction::by_fit(&estimate, &state(), Method::Delta, &asked).expect("exists");
    let band = told.answers.quantiles[0].1;
    assert!(band.value.is_finite() && band.lower == 0.0 && band.upper == f64::INFINITY, "{band:?}");
}

#[test]
fn a_machine_lasts_for_ever_only_if_all_its_joints_do() {
    let member = |estimate| Member { estimate, state: state() };
    let told = Machine::new(&[member(drifting(0.85)), member(drifting(0.85))], &Questions::default());
    let told = told.expect("quantiles exist");
    assert!(told.moments.is_none() && told.quantiles[2].value.is_finite());
    let ever = 1.0 - (1.0 - state().life(&drifting(0.85)).expect("valid").ever()).powi(2);
    // The accuracy of the integrals, and those that fail after 1e12 lives.
    assert!(told.first.iter().all(|first| (first - 0.5 * ever).abs() < 1e-8), "{:?} {ever}", told.first);
    let told =
        Machine::new(&[member(drifting(0.85)), member(lasers())], &Questions::default()).expect("valid");
    assert!(told.moments.is_some() && told.interval.1.is_finite());
}
