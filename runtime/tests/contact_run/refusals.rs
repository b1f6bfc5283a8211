//! What is warned of, doubtful or refused.

use std::f64::consts::PI;

use linkwear_runtime::contact::Stiffness;
use linkwear_runtime::{
    AssemblyError, ContactInfo, Integrator, Run, RunError, RunWarning, SINGULAR_PIVOT, Settings, SetupError,
    Span, TurnRunner, Watch, simulate,
};

use crate::common::journal::{Journal, smooth};
use crate::journals::{CLEARANCE, SPEED, TURN, dopri5, every_method, flyer, loaded, rk4, run, steady};

#[test]
fn long_steps_and_lost_contact_draw_warnings() {
    let system = loaded(smooth(), steady);
    let coarse = run(&system, 0.0, rk4(TURN / 300.0), Span::Turns(1.0), 0);
    let [RunWarning::StepTooCoarse { joint, step, frequency, accurate, stable }] = &coarse.warnings[..]
    else {
        panic!("{:?}", coarse.warnings)
    };
    // sqrt(3/2 F/(p m)): the journal alone moves.
    let stiffness = 4.0 / 3.0 * 115e9 * ((0.01 + CLEARANCE) * 0.01 / CLEARANCE).sqrt();
    let expected = (1.5 * 50.0 / (50.0 / stiffness).powf(2.0 / 3.0)).sqrt();
    assert!((frequency - expected).abs() < 1e-6 * expected, "{frequency} {expected}");
    assert_eq!(joint, "R");
    assert!(step * frequency > *accurate && step * frequency < *stable);
    assert!(coarse.warnings[0].to_string().contains("inaccurate"), "{}", coarse.warnings[0]);

    // Nothing presses: after a push the journal is mostly in flight.
    let mut system = Journal::new(smooth()).driven(SPEED).held([0.0, 0.0], [0.01, 0.0]);
    system.damping = 0.0;
    let lost = run(&system, 0.0, dopri5(1e-9), Span::Turns(1.0), 0);
    let [RunWarning::ContactLost { turn: 1, touching_part, .. }] = &lost.warnings[..] else {
        panic!("{:?}", lost.warnings)
    };
    assert!(*touching_part < 0.5);
}

#[test]
fn constants_and_clearances_out_of_range_are_told_apart() {
    let refused = |contact: ContactInfo, clearance: f64| {
        let system = Journal::new(contact);
        let settings = Settings::default();
        simulate(&system, &system.description, &[9.81, clearance], &settings, Watch::NONE)
            .expect_err("it cannot start")
    };
    let error = refused(ContactInfo { restitution: 1.2, ..smooth() }, CLEARANCE);
    assert!(matches!(&error, RunError::Setup(SetupError::Contact { joint, .. }) if joint == "R"), "{error}");
    assert_eq!(
        error.to_string(),
        "joint `R`: coefficient of restitution is 1.2; it must be above 0 and at most 1 in this law"
    );
    for clearance in [0.02, 0.0, -1e-6] {
        let error = refused(smooth(), clearance);
        let RunError::Assembly(AssemblyError::Setup(SetupError::Clearance { journal_radius, .. })) = &error
        else {
            panic!("{error}")
        };
        assert_eq!(*journal_radius, 0.01);
    }
}

#[test]
fn a_journal_that_is_demanded_outside_its_bearing_is_refused() {
    let start = |offset: f64| {
        let system = Journal::new(smooth()).held([offset, 0.0], [0.0, 0.0]);
        let settings = Settings { span: Span::Time(1e-5), ..Settings::default() };
        simulate(&system, &system.description, &[9.81, CLEARANCE], &settings, Watch::NONE)
    };
    // Pressed in by half a clearance is a start, by a hundred is none.
    assert!(start(1.5 * CLEARANCE).is_ok());
    let expected =
        AssemblyError::OutsideClearance { joint: "R".into(), distance: 1e-3, clearance: CLEARANCE };
    assert_eq!(start(1e-3), Err(RunError::Assembly(expected)));
}

/// A driven journal under 50 N, on a spring of contact of this stiffness [N/m^1.5].
fn on_a_spring(stiffness: f64) -> Journal {
    let mut system =
        Journal::new(ContactInfo { stiffness: Stiffness::Given(stiffness), ..smooth() }).driven(4.0 * PI);
    system.load = |_| [0.0, -50.0];
    system
}

fn unfinished(system: &Journal, integrator: Integrator, span: Span) -> Run {
    simulate(system, &system.description, &[0.0, CLEARANCE], &Settings::new(integrator, span, 2), Watch::NONE)
        .expect("it starts")
}

#[test]
fn a_contact_deeper_than_its_clearance_is_doubtful_and_one_near_its_radius_ends_the_run() {
    // K p^1.5 = 50 N: two clearances, and a fifth of the radius.
    for integrator in every_method(1e-5) {
        let run = unfinished(&on_a_spring(50.0 / 2e-5_f64.powf(1.5)), integrator, Span::Time(1e-3));
        assert_eq!(run.stopped, None);
        let [RunWarning::DeepContact { joint, penetration, clearance, .. }] = &run.warnings[..] else {
            panic!("{:?}", run.warnings)
        };
        // It rests there.
        assert!(joint == "R" && *clearance == CLEARANCE && (penetration / 2e-5 - 1.0).abs() < 1e-6);
        let run = unfinished(&on_a_spring(50.0 / 2e-3_f64.powf(1.5)), integrator, Span::Time(1e-3));
        let Some(RunError::Penetration { penetration, journal_radius, .. }) = run.stopped else {
            panic!("{:?}", run.stopped)
        };
        assert!(journal_radius == 0.01 && (penetration / 2e-3 - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_run_that_does_not_get_on_says_so_and_ends() {
    // Pressed in by half a clearance on a spring of 1e22: a thousand million oscillations a second.
    let mut system = on_a_spring(1e22).held([0.0, -1.5 * CLEARANCE], [0.0, 0.0]);
    for integrator in every_method(1e-16) {
        let run = unfinished(&system, integrator, Span::Turns(1.0));
        let Some(RunError::NoProgress { tried, gained, joint, .. }) = &run.stopped else {
            panic!("{integrator:?} {:?}", run.stopped)
        };
        assert!(*tried >= 20_000 && *gained < 1e-4 * 0.5 && joint.as_deref() == Some("R"));
    }
    // A turn of a life as well, and nothing that turns.
    let parameters = [0.0, CLEARANCE];
    let mut runner = TurnRunner::new(&system, &system.description, &parameters, dopri5(1e-9), SINGULAR_PIVOT)
        .expect("it starts");
    assert!(matches!(runner.measure(Watch::NONE), Err(RunError::NoProgress { .. })));
    system = Journal::new(ContactInfo { stiffness: Stiffness::Given(1e22), ..smooth() })
        .held([0.0, -1.5 * CLEARANCE], [0.0, 0.0]);
    let run = unfinished(&system, dopri5(1e-4), Span::Time(1e4));
    assert!(matches!(run.stopped, Some(RunError::NoProgress { .. })), "{:?}", run.stopped);
}

#[test]
fn an_energy_balance_that_is_off_is_doubtful_then_an_error() {
    let (mut good, mut doubtful, mut wrong) = (0, 0, 0);
    // An impact takes about 0.1 ms.
    for step in [1e-6, 3e-6, 1e-5, 1.5e-5, 2e-5, 2.5e-5, 3e-5, 3.5e-5, 4e-5, 5e-5, 6e-5] {
        let run = unfinished(&flyer(smooth()), rk4(step), Span::Time(0.02));
        let statistics = run.statistics;
        let off = statistics.energy_error_J / statistics.energy_throughput_J;
        let warned = run.warnings.iter().any(|warning| matches!(warning, RunWarning::EnergyOff { .. }));
        match &run.stopped {
            None => assert!(off <= 0.1 && warned == (off > 0.01), "{step} {off} {:?}", run.warnings),
            Some(RunError::EnergyLost { error, throughput, .. }) => assert!(*error > 0.1 * throughput),
            Some(other) => assert!(matches!(other, RunError::Penetration { .. }), "{step} {other}"),
        }
        let stopped = run.stopped.is_some();
        good += usize::from(!stopped && !warned);
        doubtful += usize::from(!stopped && warned);
        wrong += usize::from(stopped);
    }
    assert!(good > 0 && doubtful > 0 && wrong > 0, "{good} {doubtful} {wrong}");
}
