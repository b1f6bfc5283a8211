//! What belongs to the state of a trajectory can be saved and comes back bit for bit.

use std::convert::Infallible;
use std::ops::ControlFlow;

use linkwear_runtime::clearance_joint::ClearanceState;
use linkwear_runtime::contact::ImpactMemory;
use linkwear_runtime::life::{
    Feedback, JointLife, JointWear, LifeOutcome, LifeSettings, LifeState, MeanIncrement, WearOf, WearSource,
    run_life,
};
use linkwear_runtime::wear::{ContactMeasure, Limits, Measure, Observed, Profile, Warning};
use linkwear_runtime::{TurnState, Watch};

#[test]
fn memory_of_a_contact_comes_back() {
    let memory = ImpactMemory::in_contact(0.1_f64 + 0.2);
    let text = serde_json::to_string(&memory).unwrap();
    assert_eq!(serde_json::from_str::<ImpactMemory<f64>>(&text).unwrap(), memory);
}

#[test]
fn a_profile_comes_back_and_a_broken_one_is_refused() {
    let mut profile = Profile::unworn(72).unwrap();
    profile.deposit(0.3, 0.1, 1e-6 / 3.0);
    let text = serde_json::to_string(&profile).unwrap();
    assert_eq!(serde_json::from_str::<Profile>(&text).unwrap(), profile);
    let error = serde_json::from_str::<Profile>("[0.0, 0.0]").unwrap_err();
    assert!(error.to_string().contains("2 bins"), "{error}");
}

#[test]
fn warnings_come_back() {
    let limits = Limits { hardness: 1e9, pressure_speed: None };
    let seen = Observed {
        pressure: 2e9,
        pressure_speed: 0.0,
        hertz_half_width: 0.0,
        half_angle: 0.0,
        penetration: 0.0,
        depth_per_cycle: 0.0,
        clearance: 1e-5,
        journal_radius: 0.01,
    };
    let warnings: Vec<Warning> = limits.warnings(&seen).collect();
    assert_eq!(warnings.len(), 1);
    let text = serde_json::to_string(&warnings).unwrap();
    assert_eq!(serde_json::from_str::<Vec<Warning>>(&text).unwrap(), warnings);
}

#[test]
fn a_trajectory_between_two_turns_comes_back() {
    let worn = ClearanceState {
        memory: ImpactMemory::in_contact(1.0 / 3.0),
        worn: 0.1 + 0.2,
        profile: Some(Profile::unworn(8).unwrap()),
        journal: Profile::try_from(vec![1e-7 / 3.0; 8]).ok(),
    };
    let state = TurnState {
        t: 1.0 / 7.0,
        q: vec![1e-300, -0.0],
        v: vec![0.1],
        joints: vec![worn, ClearanceState::unworn()],
        memory: vec![1.0 / 3.0, 0.0],
    };
    let text = serde_json::to_string(&state).unwrap();
    assert_eq!(serde_json::from_str::<TurnState>(&text).unwrap(), state);
}

/// Wear by angle that depends on what ran before.
struct Unsettled;

impl WearSource for Unsettled {
    type State = Option<Vec<f64>>;
    type Error = Infallible;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, Infallible> {
        let worn = joints[0].profile.as_ref().expect("the profile is fed back").maximum();
        let memory = state.get_or_insert_with(|| vec![0.1, 0.7]);
        memory[0] = (3.7 * memory[0] + memory[1] + worn).sin();
        let mut profile = Profile::unworn(12).expect("12 bins are enough");
        profile.deposit(memory[0], 0.8, 1e-13 * (1.0 + 1e4 * worn));
        Ok(vec![ContactMeasure {
            wear_integral: 2.0 + 0.1 * memory[0],
            depth: 3.25e-13,
            deposit: Some(profile),
            journal: None,
            mean_force: 32.0 / 3.0,
            peak_force: 55.1,
            losses: 0.0,
            touching: 1.0,
            loss: 0.0,
            observed: Some(Observed { pressure: 4e9, ..Observed::nothing(1e-5, 0.01) }),
        }])
    }
}

#[test]
fn a_trajectory_written_after_every_step_ends_with_the_same_bits() {
    let joint = JointLife {
        joint: "R1".to_owned(),
        journal_radius: 0.01,
        clearance: 1e-5,
        threshold: 8e-6,
        revolutions_per_cycle: 2e7 / 3.0,
        wear: WearOf::Profile(Measure::Mean),
        feedback: Feedback::Profile,
        bins: Some(12),
        journal_bins: None,
        limits: Limits { hardness: 3.5e9, pressure_speed: None },
    };
    let settings = LifeSettings::new(vec![joint]);
    let mut whole = LifeState::new(&settings, 5).unwrap();
    run_life(&settings, &mut Unsettled, &MeanIncrement, &mut whole, Watch::NONE).unwrap();
    let mut saved = LifeState::new(&settings, 5).unwrap();
    let mut stops = 0;
    loop {
        let stop = Watch::new(&|_| ControlFlow::Break(()));
        let outcome = run_life(&settings, &mut Unsettled, &MeanIncrement, &mut saved, stop).unwrap();
        let text = serde_json::to_string(&saved).unwrap();
        let read: LifeState<Option<Vec<f64>>> = serde_json::from_str(&text).unwrap();
        assert_eq!(read, saved);
        saved = read;
        if outcome != LifeOutcome::Cancelled {
            break;
        }
        stops += 1;
    }
    assert!(stops > 3 && whole.warnings.len() == 1 && whole.failure.is_some());
    assert_eq!(saved, whole);
}
