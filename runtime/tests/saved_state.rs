//! What belongs to the state of a trajectory can be saved and comes back bit for bit.

use linkwear_runtime::TurnState;
use linkwear_runtime::clearance::JointState;
use linkwear_runtime::contact::ImpactMemory;
use linkwear_runtime::wear::{Limits, Observed, Profile, Warning};

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
    let worn = JointState {
        memory: ImpactMemory::in_contact(1.0 / 3.0),
        worn: 0.1 + 0.2,
        profile: Some(Profile::unworn(8).unwrap()),
    };
    let state = TurnState {
        t: 1.0 / 7.0,
        q: vec![1e-300, -0.0],
        v: vec![0.1],
        joints: vec![worn, JointState::unworn()],
    };
    let text = serde_json::to_string(&state).unwrap();
    assert_eq!(serde_json::from_str::<TurnState>(&text).unwrap(), state);
}
