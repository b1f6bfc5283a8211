//! Every way to stop early has its own message and keeps what was computed.

use std::fmt;

use linkwear_runtime::Watch;
use linkwear_runtime::life::{
    Feedback, IncrementModel, JointWear, LifeError, LifeOutcome, LifeSettings, LifeState, MeanIncrement,
    SettingsError, WearOf, WearSource, WearStep, run_life,
};
use linkwear_runtime::wear::{ContactMeasure, Measure, Observed, ScalarFeedback, Warning};

use crate::analytic::{C0, DEPTH, Powers, THRESHOLD, adaptive, arc, joint, live, revolution, settings};

/// A formula of the clearance [m] that may fail.
struct By<F>(F);

#[derive(Debug, PartialEq)]
struct Broken;

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the assembly is lost")
    }
}

impl<F: FnMut(f64) -> Result<ContactMeasure, Broken>> WearSource for By<F> {
    type State = ();
    type Error = Broken;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Broken> {
        joints.iter().map(|joint| (self.0)(joint.clearance)).collect()
    }
}

/// A life of 25 cycles whose fine scale changes its mind above a clearance.
fn life_until<E: Fn(ContactMeasure) -> Result<ContactMeasure, Broken>>(
    limit: f64,
    then: E,
) -> (LifeError<Broken>, LifeState<()>) {
    let settings = settings(0.5, 1.0, 25.1, WearStep::Cycle);
    let mut state = LifeState::new(&settings, 0).unwrap();
    let mut fine = By(|clearance: f64| {
        let sound = revolution(DEPTH * (clearance / C0).sqrt(), clearance);
        if clearance > limit { then(sound) } else { Ok(sound) }
    });
    (run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::NONE).unwrap_err(), state)
}

#[test]
fn a_fine_scale_that_fails_keeps_the_cycles_before() {
    let (stop, state) = life_until(4.0 * C0, |_| Err(Broken));
    let LifeError::Fine { cycle, error: Broken } = stop else { panic!("{stop}") };
    assert_eq!((state.cycle, state.cycles.len() as u64, state.failure), (cycle - 1, cycle - 1, None));
    assert!(state.joints[0].clearance > 4.0 * C0 && state.cycles[3].joints[0].wear > 0.0);
    assert_eq!(stop.to_string(), format!("cycle {cycle}: the assembly is lost"));
}

#[test]
fn a_failed_life_goes_on_where_it_was_once_the_cause_is_gone() {
    let settings = settings(0.5, 1.0, 25.1, adaptive(1e-5));
    let mut state = LifeState::new(&settings, 0).unwrap();
    let mut calls = 0;
    let mut failing = By(|clearance: f64| {
        calls += 1;
        if calls == 20 { Err(Broken) } else { Ok(revolution(DEPTH * (clearance / C0).sqrt(), clearance)) }
    });
    let stop = run_life(&settings, &mut failing, &MeanIncrement, &mut state, Watch::NONE).unwrap_err();
    assert!(matches!(stop, LifeError::Fine { .. }));
    run_life(&settings, &mut Powers::one(0.5), &MeanIncrement, &mut state, Watch::NONE).unwrap();
    let (_, whole) = live(&settings, &mut Powers::one(0.5)).unwrap();
    assert_eq!(state, whole);
}

#[test]
fn contact_lost_for_most_of_the_turn_stops_the_life() {
    let (stop, state) = life_until(4.0 * C0, |sound| Ok(ContactMeasure { touching: 0.4, ..sound }));
    assert!(matches!(stop, LifeError::ContactLost { touching: 0.4, .. }), "{stop}");
    assert!(stop.to_string().contains("`R1` is without contact for 60 %"), "{stop}");
    assert!(state.cycle > 3);
}

#[test]
fn numbers_that_mean_nothing_stop_the_life() {
    let (stop, _) = life_until(4.0 * C0, |sound| Ok(ContactMeasure { depth: f64::NAN, ..sound }));
    assert!(matches!(stop, LifeError::Measured { name: "depth", .. }), "{stop}");
    let (stop, _) = life_until(0.0, |sound| Ok(ContactMeasure { wear_integral: -1.0, ..sound }));
    assert!(matches!(stop, LifeError::Measured { name: "wear integral", cycle: 1, .. }), "{stop}");
}

#[test]
fn a_threshold_below_the_first_increment_is_told() {
    let settings = settings(0.5, 1.0, 0.3, adaptive(1e-4));
    let stop = live(&settings, &mut Powers::one(0.5)).unwrap_err();
    let LifeError::ThresholdBelowFirstIncrement { threshold, increment, .. } = stop else { panic!("{stop}") };
    assert!(threshold == THRESHOLD && increment > THRESHOLD);
}

#[test]
fn a_clearance_above_the_journal_is_told_at_once_and_on_the_way() {
    let mut at_once = settings(0.5, 1.0, 25.1, WearStep::FULL);
    at_once.joints[0].clearance = 0.02;
    let stop = live(&at_once, &mut Powers::one(0.5)).unwrap_err();
    assert!(matches!(stop, LifeError::ClearanceAboveJournal { cycle: 1, clearance: 0.02, .. }), "{stop}");

    let mut on_the_way = settings(0.0, 0.0, 25.1, WearStep::Cycle);
    on_the_way.joints[0].feedback = Feedback::Scalar(ScalarFeedback::new(500.0).unwrap());
    let mut state = LifeState::new(&on_the_way, 0).unwrap();
    let stop =
        run_life(&on_the_way, &mut Powers::one(0.0), &MeanIncrement, &mut state, Watch::NONE).unwrap_err();
    // (0.01 - 1e-5)/500 of 80e-6 is a quarter of 25.1 cycles.
    assert!(matches!(stop, LifeError::ClearanceAboveJournal { cycle: 8, .. }) && state.cycle == 7, "{stop}");
}

#[test]
fn a_worn_profile_counts_for_the_clearance() {
    let joint = crate::analytic::with_profile(
        joint("R1", 1e10, 0.0),
        WearOf::Profile(Measure::Mean),
        Feedback::Profile,
    );
    let mut settings = LifeSettings::new(vec![joint]);
    settings.joints[0].threshold = 1.0;
    let mut fine =
        By(|clearance| Ok(ContactMeasure { deposit: Some(arc(DEPTH)), ..revolution(DEPTH, clearance) }));
    let mut state = LifeState::new(&settings, 0).unwrap();
    let stop = run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::NONE).unwrap_err();
    assert!(matches!(stop, LifeError::ClearanceAboveJournal { .. }), "{stop}");
}

#[test]
fn a_joint_that_does_not_wear_has_no_end() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::FULL);
    let stop = live(&settings, &mut By(|clearance| Ok(revolution(0.0, clearance)))).unwrap_err();
    assert_eq!(stop, LifeError::NoWear { cycle: 1 });
}

#[test]
fn a_life_longer_than_asked_for_can_go_on() {
    let mut settings = settings(0.5, 1.0, 25.1, WearStep::Cycle);
    settings.most_cycles = 10;
    let mut state = LifeState::new(&settings, 0).unwrap();
    let mut fine = Powers::one(0.5);
    let outcome = run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::NONE).unwrap();
    assert_eq!((outcome, state.cycle), (LifeOutcome::CycleLimit, 10));
    settings.most_cycles = 100;
    let outcome = run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::NONE).unwrap();
    assert!(matches!(outcome, LifeOutcome::Failed(_)));
}

struct Negative;

impl IncrementModel for Negative {
    fn draw(&self, _: usize, _: u64, cycle: u64, mean: f64) -> f64 {
        if cycle == 4 { -mean } else { mean }
    }
}

#[test]
fn a_negative_draw_is_refused_with_its_cycle() {
    let settings = settings(0.5, 1.0, 25.1, WearStep::Cycle);
    let mut state = LifeState::new(&settings, 0).unwrap();
    let stop = run_life(&settings, &mut Powers::one(0.5), &Negative, &mut state, Watch::NONE).unwrap_err();
    assert!(matches!(stop, LifeError::Drawn { cycle: 5, .. }) && state.cycle == 4, "{stop}");
}

#[test]
fn warnings_come_once_per_kind_and_joint_with_their_cycle() {
    let joints = vec![joint("R1", 1e7, 1.0), joint("R2", 1e7, 1.0)];
    let settings = LifeSettings { step: WearStep::Cycle, ..LifeSettings::new(joints) };
    let mut fine = By(|clearance: f64| {
        let mut wear = revolution(DEPTH, clearance);
        // From 3 C0 on; every cycle wears 3.25 µm, so that is the eighth.
        let pressure = if clearance > 3.0 * C0 { 4e9 } else { 2e6 };
        wear.observed = wear.observed.map(|seen| Observed { pressure, ..seen });
        Ok(wear)
    });
    let (_, state) = live(&settings, &mut fine).unwrap();
    let seen: Vec<(usize, u64)> = state.warnings.iter().map(|seen| (seen.joint, seen.cycle)).collect();
    assert_eq!(seen, [(0, 8), (1, 8)]);
    assert!(matches!(state.warnings[0].warning, Warning::PressureAboveHardness { pressure: 4e9, .. }));

    let coarse = settings.with_longer_cycles(2.0);
    let (_, state) = live(&coarse, &mut fine).unwrap();
    let depth = state.warnings.iter().find(|seen| matches!(seen.warning, Warning::DepthPerCycleLarge { .. }));
    assert_eq!(depth.map(|seen| (seen.joint, seen.cycle)), Some((0, 1)));
}

#[test]
fn settings_and_states_that_make_no_sense_are_refused() {
    let sound = settings(0.5, 1.0, 25.1, WearStep::FULL);
    let refused = |change: &dyn Fn(&mut LifeSettings)| {
        let mut settings = sound.clone();
        change(&mut settings);
        LifeState::<()>::new(&settings, 0).unwrap_err()
    };
    assert_eq!(refused(&|s| s.joints.clear()), SettingsError::NoJoint);
    for (name, change) in [
        ("the wear threshold", (|s| s.joints[0].threshold = 0.0) as fn(&mut LifeSettings)),
        ("the clearance", |s| s.joints[0].clearance = f64::NAN),
        ("the journal radius", |s| s.joints[0].journal_radius = -1.0),
        ("revolutions_per_cycle", |s| s.joints[0].revolutions_per_cycle = f64::INFINITY),
        ("the number of bins", |s| s.joints[0].bins = Some(3)),
    ] {
        let error = refused(&change);
        assert!(error.to_string().starts_with(&format!("{name} of joint `R1` is ")), "{error}");
    }
    assert!(matches!(refused(&|s| s.least_touching = 1.0), SettingsError::Run(_)));
    assert!(matches!(refused(&|s| s.step = adaptive(0.0)), SettingsError::Run(_)));
    assert!(matches!(
        refused(&|s| s.joints[0].feedback = Feedback::Profile),
        SettingsError::NoProfile { .. }
    ));

    let mut state = LifeState::new(&sound, 0).unwrap();
    let other = LifeSettings::new(vec![joint("R1", 1.0, 1.0), joint("R2", 1.0, 1.0)]);
    let stop = run_life(&other, &mut Powers::one(0.5), &MeanIncrement, &mut state, Watch::NONE).unwrap_err();
    assert!(
        matches!(stop, LifeError::Settings(SettingsError::State { expected: 2, found: 1, .. })),
        "{stop}"
    );
    // A fine scale of another mechanism.
    let mut state = LifeState::new(&other, 0).unwrap();
    let stop = run_life(&other, &mut Powers::one(0.5), &MeanIncrement, &mut state, Watch::NONE).unwrap_err();
    assert!(matches!(stop, LifeError::Shape { what: "joints", expected: 2, found: 1 }), "{stop}");
}
