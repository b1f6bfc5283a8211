//! Trajectories with their own fine scale: against exact lives, through a saved state, with draws.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::Mutex;

use linkwear_runtime::Watch;
use linkwear_runtime::life::{
    IncrementModel, JointWear, LifeError, LifeOutcome, LifeSettings, LifeState, MeanIncrement, WearSource,
    WearStep, run_life,
};
use linkwear_runtime::wear::ContactMeasure;

use crate::analytic::{
    C0, DEPTH, Powers, THRESHOLD, adaptive, exact_revolutions, joint, live, revolution, settings,
};

/// Exponents of the area models, and constant wear.
const EXPONENTS: [f64; 4] = [0.0, 0.005, 1.0 / 3.0, 0.5];

#[test]
fn lives_of_the_area_models_are_those_of_their_differential_equation() {
    for exponent in EXPONENTS {
        for gamma in [0.0, 0.1, 1.0] {
            for tolerance in [1e-3, 1e-5, 1e-7] {
                let settings = settings(exponent, gamma, 25.1, adaptive(tolerance));
                let (life, _) = live(&settings, &mut Powers::one(exponent)).unwrap();
                // The tolerance bounds the error of order 2 per step, kept is that of order 3; rounding 1e-13.
                assert!(
                    (life / 25.1 - 1.0).abs() < tolerance + 1e-13,
                    "{exponent} {gamma} {tolerance}: {life}"
                );
            }
        }
    }
}

#[test]
fn full_coupling_needs_few_measurements_and_none_far_beyond_failure() {
    let mut fine = Powers::one(0.5);
    let (life, state) = live(&settings(0.5, 1.0, 25.1, WearStep::FULL), &mut fine).unwrap();
    // 0.02 cycle of 25 is what table and full coupling may differ by; a tenth of that is left to the steps.
    assert!((life - 25.1).abs() < 2e-3, "{life}");
    // One step of three per cycle would be 79.
    assert!(fine.calls < 79, "{}", fine.calls);
    assert_eq!(state.measurements, fine.calls as u64);
    // The last step ends with the whole cycle in which the joint fails: a 25th, twice as fast at the end.
    assert!(fine.most_wear < 1.1 * THRESHOLD, "{}", fine.most_wear);
}

/// Wear by the root of the clearance that goes up by a part of itself at a clearance [m], and cannot be measured beyond another.
struct Kinked {
    kink: f64,
    end: f64,
    asked: Vec<Vec<f64>>,
}

impl WearSource for Kinked {
    type State = u64;
    type Error = &'static str;

    fn measure(
        &mut self,
        joints: &[JointWear],
        count: &mut u64,
    ) -> Result<Vec<ContactMeasure>, &'static str> {
        *count += 1;
        let clearance = joints[0].clearance;
        if clearance > self.end {
            return Err("does not run");
        }
        // A kink: the rate is steeper beyond it.
        let steeper = 1.0 + 0.2 * (clearance / self.kink - 1.0).max(0.0);
        Ok(vec![revolution(DEPTH * (clearance / C0).sqrt() * steeper, clearance)])
    }

    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [u64],
    ) -> Result<Vec<Vec<ContactMeasure>>, &'static str> {
        self.asked.push(joints.iter().map(|joints| joints[0].clearance).collect());
        joints.iter().zip(states).map(|(joints, state)| self.measure(joints, state)).collect()
    }
}

#[test]
fn measurements_of_the_mean_path_do_not_wait_for_each_other_and_gather_where_wear_is_least_known() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::FULL);
    let mut fine = Kinked { kink: 33.3e-6, end: 1.0, asked: Vec::new() };
    let mut state = LifeState::new(&settings, 0).unwrap();
    let heard = Mutex::new(Vec::new());
    let hear = |part: f64| {
        heard.lock().unwrap().push(part);
        ControlFlow::Continue(())
    };
    let outcome = run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::new(&hear)).unwrap();
    let LifeOutcome::Failed(failure) = outcome else { panic!("{outcome:?}") };
    let life = failure.cycles;
    // One report a round but the last, before those of the cycles.
    let heard = heard.into_inner().unwrap();
    let rounds = &heard[..fine.asked.len() - 1];
    assert!(rounds.is_sorted() && rounds.iter().all(|part| *part > 0.05 && *part < 1.0), "{rounds:?}");
    assert_eq!(heard.len(), rounds.len() + state.cycles.len());
    let exact = {
        // Simpson's rule over both sides of the kink.
        let rate = |clearance: f64| {
            let steeper = 1.0 + 0.2 * (clearance / fine.kink - 1.0).max(0.0);
            settings.joints[0].revolutions_per_cycle * DEPTH * (clearance / C0).sqrt() * steeper
        };
        let simpson = |from: f64, to: f64| {
            let width = (to - from) / 1000.0;
            let weight = |at: u32| if at == 0 || at == 1000 { 1.0 } else { f64::from(2 + 2 * (at % 2)) };
            (0..=1000).map(|at| weight(at) / rate(from + f64::from(at) * width)).sum::<f64>() * width / 3.0
        };
        simpson(C0, fine.kink) + simpson(fine.kink, C0 + THRESHOLD)
    };
    // A quarter of the tolerance of a step, and the estimate covers what it is off by.
    assert!((life / exact - 1.0).abs() < 0.25 * 1e-4, "{life} {exact}");
    assert!((life - exact).abs() < state.joints[0].error, "{life} {exact} {}", state.joints[0].error);
    // Eight at even places, then rounds of eight or less.
    assert!(fine.asked.iter().all(|round| round.len() <= 8), "{:?}", fine.asked);
    let last = fine.asked.last().expect("rounds");
    let near = last.iter().filter(|clearance| (**clearance - fine.kink).abs() < 10e-6).count();
    assert!(2 * near >= last.len(), "{last:?}");
    assert_eq!(state.measurements, 1 + fine.asked.iter().map(Vec::len).sum::<usize>() as u64);
    // What stands beside a cycle is a revolution as worn as the joint is at its begin.
    for record in &state.cycles {
        let joint = &record.joints[0];
        let steeper = 1.0 + 0.2 * (joint.clearance / fine.kink - 1.0).max(0.0);
        let expected = DEPTH * (joint.clearance / C0).sqrt() * steeper;
        assert!((joint.revolution.depth / expected - 1.0).abs() < 2e-3, "{}", record.cycle);
    }
}

#[test]
fn a_mean_path_that_cannot_be_measured_to_its_end_is_followed_as_far_as_it_can() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::FULL);
    let mut fine = Kinked { kink: 1.0, end: C0 + 0.5 * THRESHOLD, asked: Vec::new() };
    let mut state = LifeState::new(&settings, 0).unwrap();
    let error = run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::NONE).unwrap_err();
    let LifeError::Fine { cycle, error: "does not run" } = error else { panic!("{error:?}") };
    // sqrt(x) from 1 to 3 in 25.1 cycles; x is 5 where it stops to run.
    let stops = 25.1 * (5.0_f64.sqrt() - 1.0) / 2.0;
    assert!((f64::from(u32::try_from(cycle).unwrap()) - stops).abs() < 3.0, "{cycle} {stops}");
    assert_eq!(state.cycles.len() as u64, state.cycle);
    assert!(state.cycle + 1 >= cycle && state.cycle > 10, "{}", state.cycle);
}

#[test]
fn wear_that_scatters_is_averaged_and_not_measured_for_ever() {
    let mut fine = Noisy { calls: 0 };
    let (life, state) = live(&settings(0.0, 1.0, 25.1, WearStep::FULL), &mut fine).unwrap();
    assert!(fine.calls <= 129, "{}", fine.calls);
    // 0.6 % by a hundred measurements, each with its part of the way.
    assert!((life / 25.1 - 1.0).abs() < 2e-3, "{life}");
    assert!(state.joints[0].error / life < 2e-2, "{}", state.joints[0].error);
}

/// Wear that scatters by this part to either side, however near two states of wear are.
struct Scattered(f64);

impl WearSource for Scattered {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        let noise = (joints[0].clearance * 1e13).sin();
        Ok(vec![revolution(DEPTH * (1.0 + self.0 * noise), joints[0].clearance)])
    }
}

#[test]
fn the_last_cycle_wears_like_the_ones_before_though_neighbouring_measurements_scatter() {
    // It ends beyond the threshold, where nothing is measured: half a cycle of few, all of it of many.
    // Of scatter by 3 % all measurements that are allowed do not average enough.
    for scatter in [5e-3, 3e-2] {
        for cycles in [3.5, 11.1, 25.1, 240.9] {
            let scattered = &mut Scattered(scatter);
            let (_, state) = live(&settings(0.0, 1.0, cycles, WearStep::FULL), scattered).unwrap();
            for record in &state.cycles {
                let part = record.joints[0].mean_increment / (THRESHOLD / cycles);
                // A line through two errs by up to three times their scatter a cycle further on.
                assert!((part - 1.0).abs() < 3.0 * scatter, "{} of {cycles}: {part}", record.cycle);
            }
        }
    }
}

/// Draws that take turns about the mean: 60 and 140 % of it.
struct Alternating;

impl IncrementModel for Alternating {
    fn draw(&self, _: usize, _: u64, cycle: u64, mean: f64) -> f64 {
        mean * if cycle.is_multiple_of(2) { 0.6 } else { 1.4 }
    }
}

#[test]
fn drawn_lives_measure_once_a_cycle_in_its_middle() {
    let lived = |settings: &LifeSettings, fine: &mut Powers| {
        let mut state = LifeState::new(settings, 0).unwrap();
        let outcome = run_life(settings, fine, &Alternating, &mut state, Watch::NONE).unwrap();
        let LifeOutcome::Failed(failure) = outcome else { panic!("{outcome:?}") };
        (failure.cycles, state)
    };
    for joints in [vec![(DEPTH, 0.5, 0.0)], vec![(DEPTH, 0.5, 0.0), (0.5 * DEPTH, 1.0 / 3.0, 0.3)]] {
        let mut fine = Powers::new(joints.clone());
        let all =
            (0..joints.len()).map(|at| joint(&format!("R{at}"), exact_revolutions(0.5, 1.0) / 25.1, 1.0));
        let full = LifeSettings { step: WearStep::FULL, ..LifeSettings::new(all.collect()) };
        let (life, state) = lived(&full, &mut fine);
        let fine_steps = LifeSettings { step: adaptive(1e-7), ..full.clone() };
        let (expected, exact) = lived(&fine_steps, &mut Powers::new(joints.clone()));
        // Steps may err by four times their tolerance of 1e-4; they err by a tenth of that here.
        assert!((life / expected - 1.0).abs() < 4e-5, "{life} {expected}");
        // Two or three cycles that know too little, with up to four measurements each.
        let cycles = state.cycles.len();
        assert!(fine.calls < cycles + 10, "{} measurements of {cycles} cycles", fine.calls);
        for (found, expected) in state.cycles.iter().zip(&exact.cycles) {
            for (at, (found, expected)) in found.joints.iter().zip(&expected.joints).enumerate() {
                // What was measured is told as it is at the begin of its cycle.
                let rate = |one: &linkwear_runtime::life::CycleJoint| one.revolution.depth;
                assert!((rate(found) / rate(expected) - 1.0).abs() < 1e-4, "joint {at}");
                assert!((found.wear / expected.wear - 1.0).abs() < 1e-4, "joint {at}");
            }
        }
    }
}

#[test]
fn estimated_error_covers_the_true_one() {
    for exponent in [1.0 / 3.0, 0.5] {
        let settings = settings(exponent, 1.0, 25.1, adaptive(1e-3));
        let (life, state) = live(&settings, &mut Powers::one(exponent)).unwrap();
        let estimate = state.joints[0].error;
        // An estimate far above the tolerance, 0.025 cycle in all, would say nothing.
        assert!((life - 25.1).abs() < estimate && estimate < 0.026, "{life} {estimate}");
    }
}

#[test]
fn wear_steps_are_of_third_order() {
    // Steps of one cycle; the same life in 8, 16 and 32 cycles, wear after half of it.
    let wear = |cycles: u32| {
        let step = WearStep::Adaptive { tolerance: 0.9, shortest: 1.0, longest: 1, remembers: false };
        let settings = settings(0.5, 1.0, f64::from(cycles), step);
        let (_, state) = live(&settings, &mut Powers::one(0.5)).unwrap();
        state.cycles[cycles as usize / 2 - 1].joints[0].wear
    };
    // x = (1 + g n/2)^2 at half the life with sqrt(x) from 1 to 3: x = 4.
    let exact = 3.0 * C0;
    let errors = [8, 16, 32].map(|cycles| (wear(cycles) - exact).abs());
    for pair in errors.windows(2) {
        // Order 3 is a factor 8; terms of order 4 are still seen.
        assert!((6.5..9.5).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

#[test]
fn the_recursion_of_the_paper_is_taken_literally() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::Cycle);
    let (life, state) = live(&settings, &mut Powers::one(0.5)).unwrap();
    let (mut clearance, mut wear, mut cycle) = (C0, 0.0, 0.0);
    let last = loop {
        let increment = settings.joints[0].revolutions_per_cycle * DEPTH * (clearance / C0).powf(0.5);
        if wear + increment >= THRESHOLD {
            break cycle + (THRESHOLD - wear) / increment;
        }
        (clearance, wear, cycle) = (clearance + increment, wear + increment, cycle + 1.0);
        let record = &state.cycles[cycle as usize - 1];
        // Same operations in another order, 25 times.
        assert!((record.joints[0].wear / wear - 1.0).abs() < 1e-14);
        assert_eq!(record.joints[0].increment, record.joints[0].mean_increment);
    };
    assert!((life / last - 1.0).abs() < 1e-14, "{life} {last}");
    assert_eq!(state.failure.unwrap().whole_cycles, last.ceil() as u64);
    // Feedback once per cycle lags by half a cycle: the life is longer than 25.1 by less than one.
    assert!(life > 25.1 && life < 26.1);
}

#[test]
fn records_are_those_of_whole_cycles_whatever_the_steps() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::FULL);
    let (_, state) = live(&settings, &mut Powers::one(0.5)).unwrap();
    assert_eq!(state.cycles.len(), 26);
    for (index, record) in state.cycles.iter().enumerate() {
        let joint = &record.joints[0];
        assert_eq!(record.cycle, index as u64 + 1);
        // sqrt(x) grows evenly from 1 to 3 over 25.1 cycles; steps may err by their tolerance.
        let exact = C0 * ((1.0 + 2.0 * record.cycle as f64 / 25.1).powi(2) - 1.0);
        assert!((joint.wear / exact - 1.0).abs() < 1e-4, "{}: {} {exact}", record.cycle, joint.wear);
        assert_eq!(record.used, joint.wear / THRESHOLD);
        let before = if index == 0 { 0.0 } else { state.cycles[index - 1].joints[0].wear };
        assert_eq!(joint.increment, joint.wear - before);
        // c = c0 + gamma W: a few roundings of 1e-4 m.
        assert!((joint.clearance - C0 - before).abs() < 1e-19);
    }
    let joint = &state.joints[0];
    assert!((joint.exposure / joint.wear - 1.0).abs() < 1e-14, "the mean path adds up to the wear");
}

#[test]
fn without_feedback_wear_is_even_and_one_measurement_per_stage_is_enough() {
    let fed_back = settings(0.5, 0.1, 25.1, WearStep::FULL);
    let (short, _) = live(&fed_back, &mut Powers::one(0.5)).unwrap();
    let settings = fed_back.without_feedback();
    let (life, state) = live(&settings, &mut Powers::one(0.5)).unwrap();
    let exact = THRESHOLD / (settings.joints[0].revolutions_per_cycle * DEPTH);
    // The last billionth of a way counts as its end, and there are eight.
    assert!((life / exact - 1.0).abs() < 1e-9 / 8.0 + 1e-13 && life > short, "{life} {exact} {short}");
    assert!(state.joints[0].clearance == C0 && state.measurements < 40, "{}", state.measurements);
}

#[test]
fn the_first_of_several_joints_ends_the_life() {
    // Uncoupled joints of 30, 20 and 40 cycles.
    let lives = [30.0, 20.0, 40.0];
    let joints: Vec<_> =
        lives.iter().map(|life| joint("R", exact_revolutions(0.5, 1.0) / life, 1.0)).collect();
    let settings = LifeSettings { step: adaptive(1e-6), ..LifeSettings::new(joints) };
    let mut fine = Powers::new(vec![(DEPTH, 0.5, 0.0); 3]);
    let (life, state) = live(&settings, &mut fine).unwrap();
    assert!((life - 20.0).abs() < 20.0 * 1e-6, "{life}");
    assert_eq!(state.failure.unwrap().joint, 1);
    // At cycle n, sqrt(x) is 1 + 2 n/life for each.
    let end = &state.cycles[9];
    for (joint, life) in end.joints.iter().zip(lives) {
        let exact = C0 * ((1.0 + 20.0 / life).powi(2) - 1.0);
        // Steps are kept to 1e-6 of the fastest joint.
        assert!((joint.wear / exact - 1.0).abs() < 2e-6, "{} {exact}", joint.wear);
    }
}

#[test]
fn coupled_joints_follow_their_common_equation() {
    // Each wears with the other's clearance: dx/dn = g y, dy/dn = g x from (1, 1) is x = y = exp(g n).
    let revolutions = exact_revolutions(1.0, 1.0) / 25.1;
    let joints = vec![joint("R1", revolutions, 1.0), joint("R2", revolutions, 1.0)];
    let settings = LifeSettings { step: adaptive(1e-6), ..LifeSettings::new(joints) };
    let (life, state) = live(&settings, &mut Powers::new(vec![(DEPTH, 0.0, 1.0); 2])).unwrap();
    assert!((life / 25.1 - 1.0).abs() < 1e-6, "{life}");
    assert_eq!(state.failure.unwrap().joint, 0);
}

/// Depends on what it did before, as unsettled dynamics do.
#[derive(Default)]
struct Remembering;

impl WearSource for Remembering {
    type State = f64;
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], memory: &mut f64) -> Result<Vec<ContactMeasure>, Infallible> {
        *memory = 0.9 * *memory + 0.1 * (1e4 * joints[0].clearance).sin();
        let depth = DEPTH * (1.0 + 0.05 * *memory) * (joints[0].clearance / C0).sqrt();
        Ok(vec![revolution(depth, joints[0].clearance)])
    }
}

/// Something between 0.5 and 1.5 times the mean, by cycle and trajectory.
struct Scatter;

impl IncrementModel for Scatter {
    fn draw(&self, joint: usize, trajectory: u64, cycle: u64, mean: f64) -> f64 {
        mean * (0.5 + ((cycle * 7 + trajectory * 3 + joint as u64 * 5) % 11) as f64 / 10.0)
    }
}

#[test]
fn a_life_that_was_stopped_goes_on_with_the_same_bits() {
    for step in [WearStep::Cycle, WearStep::FULL, adaptive(1e-7)] {
        for draw in [&MeanIncrement as &dyn IncrementModel, &Scatter] {
            let settings = settings(0.5, 1.0, 25.1, step);
            let mut whole = LifeState::new(&settings, 3).unwrap();
            run_life(&settings, &mut Remembering, draw, &mut whole, Watch::NONE).unwrap();
            let mut pieces = LifeState::new(&settings, 3).unwrap();
            let mut stops = 0;
            while run_life(
                &settings,
                &mut Remembering,
                draw,
                &mut pieces,
                Watch::new(&|_| ControlFlow::Break(())),
            )
            .unwrap()
                == LifeOutcome::Cancelled
            {
                stops += 1;
            }
            // The mean path of one joint is one step.
            let is_one = draw.is_mean() && step == WearStep::FULL;
            assert!(if is_one { stops == 0 } else { stops >= 3 }, "{stops}");
            assert_eq!(pieces, whole);
        }
    }
}

#[test]
fn draws_feed_back_and_keep_the_mean_apart_from_the_wear() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::Cycle);
    let mut state = LifeState::new(&settings, 3).unwrap();
    run_life(&settings, &mut Powers::one(0.5), &Scatter, &mut state, Watch::NONE).unwrap();
    let mut clearance = C0;
    for (cycle, record) in state.cycles.iter().enumerate() {
        let joint = &record.joints[0];
        let mean = settings.joints[0].revolutions_per_cycle * DEPTH * (clearance / C0).sqrt();
        // Increments are differences of wears of 1e-4 m: roundings of 1e-20 m.
        assert!((joint.mean_increment - mean).abs() < 1e-18, "{cycle}");
        assert!((joint.increment - Scatter.draw(0, 3, cycle as u64, mean)).abs() < 1e-18, "{cycle}");
        clearance += joint.increment;
    }
    let failure = state.failure.unwrap();
    assert!(
        failure.cycles > (failure.whole_cycles - 1) as f64 && failure.cycles <= failure.whole_cycles as f64
    );
    assert!((state.joints[0].exposure / state.joints[0].wear - 1.0).abs() > 1e-3, "Lambda is not W");
}

/// A draw that is the mean, but does not say so: cycle by cycle.
struct Quiet;

impl IncrementModel for Quiet {
    fn draw(&self, _: usize, _: u64, _: u64, mean: f64) -> f64 {
        mean
    }
}

#[test]
fn a_draw_equal_to_the_mean_lives_as_long_as_the_mean_path() {
    let settings = settings(0.5, 1.0, 25.1, adaptive(1e-6));
    let mut state = LifeState::new(&settings, 0).unwrap();
    run_life(&settings, &mut Powers::one(0.5), &Quiet, &mut state, Watch::NONE).unwrap();
    let (life, _) = live(&settings, &mut Powers::one(0.5)).unwrap();
    // Both within their tolerance of 25.1.
    assert!((state.failure.unwrap().cycles - life).abs() < 2.0 * 25.1 * 1e-6);
}

/// Wear with noise of 1 %, as a chattering mechanism has it.
struct Noisy {
    calls: usize,
}

impl WearSource for Noisy {
    type State = u64;
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], count: &mut u64) -> Result<Vec<ContactMeasure>, Infallible> {
        self.calls += 1;
        *count += 1;
        let noise = (*count as f64 * 0.618_034).fract() - 0.5;
        Ok(vec![revolution(DEPTH * (1.0 + 0.02 * noise), joints[0].clearance)])
    }
}

#[test]
fn noise_does_not_drive_the_steps_to_nothing() {
    let settings = settings(0.0, 1.0, 25.1, adaptive(1e-6));
    let mut fine = Noisy { calls: 0 };
    let (life, _) = live(&settings, &mut fine).unwrap();
    // Noise of 1 % averages out over tens of measurements.
    assert!((life - 25.1).abs() < 0.05, "{life}");
    // The shortest step would be 1000 per cycle, 75,000 measurements.
    assert!(fine.calls < 400, "{}", fine.calls);
}
