//! `table` against `full` coupling, and the calibration of a cycle.

use std::ops::ControlFlow;
use std::sync::Mutex;

use linkwear_runtime::Watch;
use linkwear_runtime::life::{
    CalibrationError, DEFAULT_POINTS, Feedback, JointWear, LifeError, LifeOutcome, LifeSettings, LifeState,
    MeanIncrement, SettingsError, WearOf, WearSource, WearStep, WearTable, calibrate, run_life,
};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::wear::Measure;

use crate::analytic::{
    C0, DEPTH, Powers, THRESHOLD, adaptive, arc, exact_revolutions, joint, live, revolution, settings,
    with_profile,
};

fn table<F: WearSource>(settings: &LifeSettings, fine: &mut F) -> WearTable
where
    F::Error: std::fmt::Debug,
{
    WearTable::measure(settings, fine, DEFAULT_POINTS, Watch::NONE).unwrap()
}

#[test]
fn a_power_law_is_tabulated_exactly_and_lives_as_in_full_coupling() {
    for exponent in [0.0, 0.005, 1.0 / 3.0, 0.5] {
        for gamma in [0.1, 1.0] {
            let settings = settings(exponent, gamma, 25.1, WearStep::TABLE);
            let mut fine = Powers::one(exponent);
            let mut table = table(&settings, &mut fine);
            assert_eq!((fine.calls, table.report().points, table.report().measurements), (17, 17, 17));
            // Nothing is measured beyond the threshold; exp and ln round.
            assert!(fine.most_wear <= THRESHOLD * (1.0 + 1e-15));
            // ln of 1e-13 is 30: its rounding.
            assert!(table.report().left_out[0] < 1e-13 && table.report().others.is_none());
            let (by_table, state) = live(&settings, &mut table).unwrap();
            let (full, _) = live(&settings, &mut Powers::one(exponent)).unwrap();
            // The same steps with values that differ by 1e-14.
            assert!((by_table - full).abs() < 1e-11, "{by_table} {full}");
            assert!((state.cycles[3].joints[0].revolution.wear_integral / 2.0053636 - 1.0).abs() < 1e-3);
        }
    }
}

/// The clearance's power with a resonance of 0.2 % crossed on the way, as real mechanisms have them.
struct Resonance;

impl WearSource for Resonance {
    type State = ();
    type Error = std::convert::Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Self::Error> {
        let clearance = joints[0].clearance;
        let tuned = 1.0 + 0.002 * (-((clearance / C0 - 4.0) / 0.5).powi(2)).exp();
        Ok(vec![revolution(DEPTH * tuned * (clearance / C0).sqrt(), clearance)])
    }
}

#[test]
fn a_resonance_is_found_by_the_error_estimate_and_hardly_moves_the_life() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::TABLE);
    let mut table = table(&settings, &mut Resonance);
    let estimate = table.report().left_out[0];
    // Points lie ln(9)/16 apart, 0.55 C0 at 4 C0: half of them miss much of a peak of 0.2 %, all see it.
    assert!((1e-4..2e-3).contains(&estimate), "{estimate}");
    let truth = |wear: f64| {
        let joints = [JointWear { clearance: C0 + wear, wear, profile: None, journal: None }];
        Resonance.measure(&joints, &mut ()).unwrap()[0].depth
    };
    for i in 0..1000 {
        let wear = THRESHOLD * f64::from(i) / 1000.0;
        assert!((table.at(0, wear).depth / truth(wear) - 1.0).abs() < estimate, "{wear}");
    }
    let (by_table, _) = live(&settings, &mut table).unwrap();
    let (full, _) = live(&settings, &mut Resonance).unwrap();
    // 0.02 cycle is asked for; the peak is 0.2 % over a tenth of the life, 0.005 cycle, and mostly tabulated.
    assert!((by_table - full).abs() < 1e-3, "{by_table} {full}");
}

#[test]
fn without_feedback_a_table_is_one_measurement() {
    let settings = settings(0.5, 0.0, 25.1, WearStep::TABLE);
    let mut fine = Powers::one(0.5);
    let mut table = table(&settings, &mut fine);
    assert_eq!((fine.calls, table.report().left_out[0]), (1, 0.0));
    let (life, _) = live(&settings, &mut table).unwrap();
    // Additions of equal increments; exp(ln) of the depth.
    assert!((life / 25.1 - 1.0).abs() < 1e-13);
}

#[test]
fn joints_that_wear_apart_have_exact_tables() {
    let revolutions = exact_revolutions(0.5, 1.0) / 25.1;
    let joints =
        vec![joint("R1", 0.6 * revolutions, 1.0), joint("R2", revolutions, 1.0), joint("R3", 1.0, 0.0)];
    let settings = LifeSettings { step: WearStep::TABLE, ..LifeSettings::new(joints) };
    let mut fine = Powers::new(vec![(DEPTH, 0.5, 0.0), (DEPTH, 0.5, 0.0), (0.0, 0.5, 0.0)]);
    let mut table = table(&settings, &mut fine);
    // 17 points, 16 of them predicted first, and three checks.
    assert_eq!((fine.calls, table.report().measurements, table.report().points), (36, 36, 17));
    let errors = [&table.report().left_out[..], &table.report().others.clone().unwrap()].concat();
    // Roundings of ln.
    assert!(errors.iter().all(|error| *error < 1e-13), "{errors:?}");
    let (life, state) = live(&settings, &mut table).unwrap();
    // Tolerance 1e-6 of the wear step.
    assert!((life - 25.1).abs() < 25.1e-6 && state.failure.unwrap().joint == 1, "{life}");
}

#[test]
fn coupled_joints_live_by_the_table_as_in_full_coupling_and_the_coupling_is_reported() {
    let revolutions = exact_revolutions(0.5, 1.0) / 25.1;
    let joints = vec![joint("R1", revolutions, 1.0), joint("R2", 0.5 * revolutions, 0.5)];
    let settings = LifeSettings { step: WearStep::TABLE, ..LifeSettings::new(joints) };
    let powers = || Powers::new(vec![(DEPTH, 0.5, 0.1), (DEPTH, 0.3, 0.2)]);
    let mut table = table(&settings, &mut powers());
    let (by_table, _) = live(&settings, &mut table).unwrap();
    let (full, state) = live(&settings, &mut powers()).unwrap();
    // Both take the path of the table, up to Heun's error in 16 steps of 14 % (about (0.14)^2/12 of small exponents).
    assert!((by_table - full).abs() < 2e-3, "{by_table} {full}");
    // Unworn beside others that are worn out: (c/C0)^exponent of the other joint.
    let end = &state.joints;
    let factor = |joint: usize, exponent: f64| (end[joint].clearance / C0).powf(exponent);
    let expected = [1.0 - 1.0 / factor(1, 0.1), 1.0 - 1.0 / factor(0, 0.2)];
    for (found, expected) in table.report().others.clone().unwrap().into_iter().zip(expected) {
        // Clearances at the end of the table and at the end of the life differ by a cycle.
        assert!((found - expected).abs() < 0.02, "{found} {expected}");
    }
}

/// Depth by angle that goes with the clearance.
struct Arcs;

impl WearSource for Arcs {
    type State = ();
    type Error = std::convert::Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Self::Error> {
        let clearance = joints[0].clearance;
        let profile = arc(10.0 * DEPTH * (clearance / C0).sqrt());
        Ok(vec![ContactMeasure { deposit: Some(profile), ..revolution(DEPTH, clearance) }])
    }
}

#[test]
fn wear_by_profile_is_tabulated_if_it_feeds_back_as_one_number() {
    let scalar = joint("R1", 1e7, 1.0).feedback;
    for measure in [Measure::Mean, Measure::Maximum] {
        let joint = with_profile(joint("R1", 1e7, 1.0), WearOf::Profile(measure), scalar);
        let settings = LifeSettings { step: WearStep::TABLE, ..LifeSettings::new(vec![joint]) };
        let mut table = table(&settings, &mut Arcs);
        let (by_table, _) = live(&settings, &mut table).unwrap();
        let (full, _) = live(&settings, &mut Arcs).unwrap();
        // Bins are cubics over ln c in cells of 0.14: third order of sqrt(c), 0.14^3/100.
        assert!((by_table / full - 1.0).abs() < 3e-5, "{by_table} {full}");
    }
    let fed_back = with_profile(joint("R1", 1e7, 1.0), WearOf::Profile(Measure::Mean), Feedback::Profile);
    let settings = LifeSettings::new(vec![fed_back]);
    let stop = WearTable::measure(&settings, &mut Arcs, DEFAULT_POINTS, Watch::NONE).unwrap_err();
    assert!(matches!(stop, LifeError::Settings(SettingsError::TableOfProfile { .. })), "{stop}");
}

#[test]
fn progress_of_a_table_ends_at_one() {
    let seen = Mutex::new(Vec::new());
    let hear = |part| {
        seen.lock().unwrap().push(part);
        ControlFlow::Continue(())
    };
    let settings = settings(0.5, 1.0, 25.1, WearStep::TABLE);
    WearTable::measure(&settings, &mut Powers::one(0.5), 5, Watch::new(&hear)).unwrap();
    assert_eq!(*seen.lock().unwrap(), [0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn cycles_are_calibrated_to_the_life_wanted() {
    for exponent in [0.005, 1.0 / 3.0, 0.5] {
        for gamma in [0.0, 0.1, 1.0] {
            // Begins far off: one revolution per cycle.
            let settings =
                LifeSettings { step: WearStep::TABLE, ..LifeSettings::new(vec![joint("R1", 1.0, gamma)]) };
            let mut table = table(&settings, &mut Powers::one(exponent));
            let found = calibrate(&settings, &mut table, 25.1, 1e-6).unwrap();
            let exact = exact_revolutions(exponent, gamma) / 25.1;
            // 1e-6 of 25.1 cycles is asked for.
            assert!((found.revolutions_per_cycle[0] / exact - 1.0).abs() < 1e-6 / 25.1 * 1.1, "{found:?}");
            assert_eq!(found.factor, found.revolutions_per_cycle[0]);
        }
    }
}

#[test]
fn feedback_once_per_cycle_is_calibrated_as_it_is() {
    for cycles in [25.1, 25.0, 7.3] {
        let settings =
            LifeSettings { step: WearStep::Cycle, ..LifeSettings::new(vec![joint("R1", 1e6, 1.0)]) };
        let mut table = table(&settings, &mut Powers::one(0.5));
        let found = calibrate(&settings, &mut table, cycles, 1e-6).unwrap();
        let (life, _) = live(&settings.with_longer_cycles(found.factor), &mut Powers::one(0.5)).unwrap();
        // What was asked for, and the rounding of the table.
        assert!((life - cycles).abs() < 1.1e-6, "{life}");
        // The recursion lags behind continuous feedback: its cycles are longer.
        assert!(found.revolutions_per_cycle[0] > exact_revolutions(0.5, 1.0) / cycles);
    }
}

#[test]
fn calibration_keeps_the_ratio_of_joints() {
    let settings = LifeSettings::new(vec![joint("R1", 1e6, 1.0), joint("R2", 3e6, 0.5)]);
    let mut fine = Powers::new(vec![(DEPTH, 0.5, 0.1), (DEPTH, 0.3, 0.2)]);
    let found = calibrate(&settings, &mut fine, 25.1, 1e-6).unwrap();
    // One rounding each.
    assert!((found.revolutions_per_cycle[1] / found.revolutions_per_cycle[0] / 3.0 - 1.0).abs() < 1e-15);
    let settings = LifeSettings { step: adaptive(1e-8), ..settings.with_longer_cycles(found.factor) };
    let (life, _) = live(&settings, &mut fine).unwrap();
    assert!((life - 25.1).abs() < 1.1e-6, "{life}");
}

#[test]
fn lives_that_cannot_be_calibrated_are_refused() {
    let settings = LifeSettings::new(vec![joint("R1", 1e6, 1.0)]);
    for cycles in [1.0, f64::NAN, f64::INFINITY] {
        let error = calibrate(&settings, &mut Powers::one(0.5), cycles, 1e-6).unwrap_err();
        assert!(matches!(error, CalibrationError::Cycles { .. }), "{error}");
    }
    let mut still = Powers::new(vec![(0.0, 0.0, 0.0)]);
    let error = calibrate(&settings, &mut still, 25.1, 1e-6).unwrap_err();
    assert_eq!(error, CalibrationError::Life(LifeError::NoWear { cycle: 1 }));
}

#[test]
fn a_table_gives_the_same_bits_to_every_trajectory() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::TABLE);
    let table = table(&settings, &mut Powers::one(0.5));
    let end = |mut table: WearTable| {
        let mut state = LifeState::new(&settings, 0).unwrap();
        match run_life(&settings, &mut table, &MeanIncrement, &mut state, Watch::NONE).unwrap() {
            LifeOutcome::Failed(failure) => failure.cycles.to_bits(),
            outcome => panic!("{outcome:?}"),
        }
    };
    assert_eq!(end(table.clone()), end(table));
}
