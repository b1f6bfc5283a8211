//! Lives by Monte Carlo: against the closed form where there is one, and the same bits for any number of threads.

#![allow(clippy::disallowed_methods)]

use std::convert::Infallible;
use std::num::NonZero;
use std::ops::ControlFlow;

use linkwear_gamma::life::{Clock, FirstPassage, Law, LifeStatistics, Lifetime};
use linkwear_gamma::monte_carlo::{Ended, GammaDraw, Lives, MonteCarlo};
use linkwear_gamma::process::Gamma;
use linkwear_gamma::series::{SeriesSystem, SharedFactor};
use linkwear_gamma::special::gamma_p;
use linkwear_runtime::GammaRates;
use linkwear_runtime::Watch;
use linkwear_runtime::life::{Feedback, JointLife, JointWear, LifeSettings, WearOf, WearSource, WearStep};
use linkwear_runtime::wear::{ContactMeasure, Limits, Observed, ScalarFeedback};

/// beta `W_crit` = 1092 and a mean life of about 25 cycles, as in the case study.
const RATES: GammaRates = GammaRates { alpha: 13.65e6, beta: 13.65e6 };
const THRESHOLD: f64 = 80e-6;
const C0: f64 = 10e-6;
const PER_CYCLE: f64 = 3.2e-6;

/// A revolution wears with a power of the clearance.
#[derive(Clone)]
struct Power(f64);

impl WearSource for Power {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        let wear = |joint: &JointWear| ContactMeasure {
            wear_integral: 2.0,
            depth: PER_CYCLE * (joint.clearance / C0).powf(self.0),
            mean_force: 30.0,
            peak_force: 50.0,
            losses: 0.0,
            touching: 1.0,
            loss: 0.0,
            deposit: None,
            journal: None,
            observed: Some(Observed::nothing(joint.clearance, 0.01)),
        };
        Ok(joints.iter().map(wear).collect())
    }
}

fn settings(gamma: f64, step: WearStep) -> LifeSettings {
    let joint = JointLife {
        joint: "R1".to_owned(),
        journal_radius: 0.01,
        clearance: C0,
        threshold: THRESHOLD,
        revolutions_per_cycle: 1.0,
        wear: WearOf::Depth,
        feedback: Feedback::Scalar(ScalarFeedback::new(gamma).expect("a factor")),
        bins: None,
        journal_bins: None,
        limits: Limits { hardness: 3.5e9, pressure_speed: None },
    };
    LifeSettings { step, keep_cycles: false, ..LifeSettings::new(vec![joint]) }
}

fn lives(settings: &LifeSettings, exponent: f64, seed: u64, count: u64, threads: usize) -> Lives<Infallible> {
    let draw = GammaDraw::new(seed, &[RATES]);
    let threads = NonZero::new(threads).expect("a thread");
    MonteCarlo { settings, draw: &draw, trajectories: 0..count, threads }.run(
        &|lend| {
            lend(&mut Power(exponent));
            Ok(())
        },
        Watch::NONE,
    )
}

/// Mean and standard deviation.
fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    (mean, (values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt())
}

#[test]
fn without_feedback_lives_follow_the_law_of_first_passage() {
    let count = 100_000;
    let run = lives(&settings(0.0, WearStep::Cycle), 0.5, 4, count, 2);
    assert_eq!(run.ended, Ended::Complete);
    let whole = run.failures.iter().map(|(_, failure)| failure.whole_cycles as f64);
    let (mean, std) = moments(whole);
    // P(N > n) = P(W_n < W_crit), summed: E N, and E N^2 with weights 2 n + 1.
    let survives = |n: u32| gamma_p(RATES.alpha * PER_CYCLE * f64::from(n), RATES.beta * THRESHOLD);
    let (mut first, mut second) = (1.0, 1.0);
    for n in 1..100 {
        first += survives(n);
        second += f64::from(2 * n + 1) * survives(n);
    }
    let exact_std = (second - first * first).sqrt();
    let n = count as f64;
    // Three standard errors; lives are nearly normal, so that of the standard deviation is std / sqrt(2 n).
    assert!((mean - first).abs() < 3.0 * exact_std / n.sqrt(), "{mean} {first}");
    let (cov, exact) = (std / mean, exact_std / first);
    assert!((cov - exact).abs() < 3.0 * exact / (2.0 * n).sqrt(), "{cov} {exact}");
    // Interpolated within the cycle, a life is half a cycle shorter; the excess of half a gamma step is left.
    let (continuous, _) = moments(run.failures.iter().map(|(_, failure)| failure.cycles));
    assert!((mean - continuous - 0.5).abs() < 0.02, "{mean} {continuous}");
}

/// Closed form of lives without feedback, in micrometres: [`PER_CYCLE`] is 3.2 of them.
fn member(threshold: f64) -> FirstPassage {
    let law = Law::new(&Gamma, [RATES.alpha * 1e-6, RATES.beta * 1e-6]).expect("positive");
    FirstPassage::new(law, Clock::linear(PER_CYCLE * 1e6).expect("positive"), threshold * 1e6)
        .expect("positive")
}

#[test]
fn lives_with_a_shared_factor_follow_the_closed_form() {
    let (count, factor) = (20_000, SharedFactor::Gamma { cov: 0.2 });
    for thresholds in [&[THRESHOLD][..], &[THRESHOLD, 1.02 * THRESHOLD]] {
        let mut settings = settings(0.0, WearStep::Cycle);
        let own = settings.joints[0].clone();
        settings.joints =
            thresholds.iter().map(|threshold| JointLife { threshold: *threshold, ..own.clone() }).collect();
        let draw = GammaDraw::new(6, &vec![RATES; thresholds.len()]).sharing(factor).expect("positive");
        let threads = NonZero::new(2).expect("threads");
        let run = MonteCarlo { settings: &settings, draw: &draw, trajectories: 0..count, threads }.run(
            &|lend| {
                lend(&mut Power(0.5));
                Ok(())
            },
            Watch::NONE,
        );
        assert_eq!(run.ended, Ended::Complete);
        let members = thresholds.iter().map(|threshold| member(*threshold)).collect();
        let system = SeriesSystem::sharing(members, factor).expect("members");
        let whole: Vec<f64> = run.failures.iter().map(|(_, failure)| failure.whole_cycles as f64).collect();
        let (seen, exact) =
            (LifeStatistics::of(&whole).expect("lives"), system.whole_cycles().expect("finite"));
        // Three standard errors throughout.
        let (mean, std) = (seen.mean(), seen.std());
        assert!((mean.value - exact.mean).abs() < 3.0 * mean.error, "{mean:?} {exact:?}");
        assert!((std.value - exact.std).abs() < 3.0 * std.error, "{std:?} {exact:?}");
        for cycles in [18.0, 22.0, 26.0, 34.0] {
            let (part, exact) = (seen.reliability(cycles), system.reliability(cycles));
            assert!((part.value - exact).abs() < 3.0 * part.error, "{cycles}: {part:?} {exact}");
        }
        // Without the factor lives scatter by 3 %: the factor is what is seen.
        assert!(exact.std > 0.15 * exact.mean);
    }
}

#[test]
fn threads_and_order_change_no_bit() {
    let settings = settings(1.0, WearStep::TABLE);
    let bits = |lives: Lives<Infallible>| -> Vec<(u64, u64)> {
        lives.failures.iter().map(|(trajectory, failure)| (*trajectory, failure.cycles.to_bits())).collect()
    };
    let one = bits(lives(&settings, 0.5, 9, 200, 1));
    assert_eq!(one, bits(lives(&settings, 0.5, 9, 200, 2)));
    assert_eq!(one, bits(lives(&settings, 0.5, 9, 200, 7)));
    assert_eq!(one[..50], bits(lives(&settings, 0.5, 9, 50, 2)));
    assert_ne!(one, bits(lives(&settings, 0.5, 10, 200, 2)));
    // Pinned: debug and release, now and later, give these bits.
    assert_eq!(one[0].1, 4_623_217_841_093_021_260, "first life");
}

#[test]
fn a_run_that_is_stopped_keeps_the_lives_it_had() {
    let settings = settings(1.0, WearStep::TABLE);
    let draw = GammaDraw::new(1, &[RATES]);
    let threads = NonZero::new(1).expect("a thread");
    let run = MonteCarlo { settings: &settings, draw: &draw, trajectories: 0..100, threads }.run(
        &|lend| {
            lend(&mut Power(0.5));
            Ok(())
        },
        Watch::new(&|part| if part < 0.045 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }),
    );
    assert_eq!((run.ended, run.failures.len()), (Ended::Cancelled, 5));
}

#[test]
fn a_thread_that_panics_ends_the_run_with_its_life_and_words() {
    let settings = settings(1.0, WearStep::TABLE);
    let draw = GammaDraw::new(1, &[RATES]);
    for threads in [1, 3] {
        let threads = NonZero::new(threads).expect("threads");
        let watch = |part: f64| if part < 0.045 { ControlFlow::Continue(()) } else { panic!("at {part}") };
        let run = MonteCarlo { settings: &settings, draw: &draw, trajectories: 0..100, threads }.run(
            &|lend| {
                lend(&mut Power(0.5));
                Ok(())
            },
            Watch::new(&watch),
        );
        let Ended::Panicked { trajectory, message } = run.ended else { panic!("{:?}", run.ended) };
        // Every thread may panic once, and which of them is told is chance: five lives are finished then, or one more each.
        let told =
            (5..5 + threads.get()).any(|finished| message == format!("at {}", finished as f64 / 100.0));
        assert!(told && (0..100).contains(&trajectory), "{trajectory} {message}");
        assert!(run.failures.len() >= 5, "{}", run.failures.len());
    }
}
