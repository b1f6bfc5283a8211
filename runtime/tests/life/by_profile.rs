//! Lives that feed a worn profile back.

use std::convert::Infallible;

use linkwear_runtime::life::{Feedback, JointLife, JointWear, LifeSettings, WearOf, WearSource, WearStep};
use linkwear_runtime::wear::{ContactMeasure, Measure, Profile};

use crate::analytic::{C0, DEPTH, THRESHOLD, adaptive, arc, joint, live, revolution, with_profile};

/// Wear by angle: even wear of an arc; depth of the area's model twice the profile's mean.
struct Arc {
    /// Profiles that were handed in.
    seen: Vec<Option<Profile>>,
}

impl WearSource for Arc {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        self.seen.push(joints[0].profile.clone());
        // The more the profile is worn, the less it wears: conformity.
        let worn = joints[0].profile.as_ref().map_or(0.0, |profile| profile.mean());
        let profile = arc(DEPTH / (1.0 + worn / THRESHOLD));
        let depth = 2.0 * profile.mean();
        Ok(vec![ContactMeasure { deposit: Some(profile), ..revolution(depth, joints[0].clearance) }])
    }
}

#[test]
fn a_profile_fed_back_gains_what_the_revolutions_deposit() {
    for measure in [Measure::Mean, Measure::Maximum] {
        let joint = with_profile(joint("R1", 2e7, 0.0), WearOf::Profile(measure), Feedback::Profile);
        let settings = LifeSettings { step: adaptive(1e-6), ..LifeSettings::new(vec![joint]) };
        let mut fine = Arc { seen: Vec::new() };
        let (_, state) = live(&settings, &mut fine).unwrap();
        let end = &state.joints[0];
        let worn = end.profile.as_ref().unwrap();
        // W is read off the profile; the clearance of the unworn joint stays.
        assert_eq!((end.wear, end.clearance), (measure.of(worn.depths()), C0));
        assert!(fine.seen.iter().all(Option::is_some) && end.wear >= THRESHOLD);
        // Volume is conserved; the edges of the arc wear too, so that the journal fits.
        let unit = arc(1.0);
        let scale = worn.mean() / unit.mean();
        assert!(worn.maximum() < 0.99 * scale * unit.maximum());
        let edges =
            worn.depths().iter().zip(unit.depths()).filter(|(depth, share)| **share == 0.0 && **depth > 0.0);
        assert!(edges.count() > 0);
        // y' = N d m/(1 + y/W_crit) for the mean y: y + y^2/(2 W_crit) = N d m n, at every whole cycle.
        let per_cycle = 2e7 * DEPTH * unit.mean();
        let (mean, cycle) = (worn.mean(), state.cycle as f64);
        let exact = mean + mean * mean / (2.0 * THRESHOLD);
        assert!((exact / (per_cycle * cycle) - 1.0).abs() < 2e-6, "{measure:?}");
    }
}

#[test]
fn cycles_of_a_jump_wear_by_angle_as_those_that_are_stepped_one_by_one() {
    let joint = |revolutions| {
        with_profile(joint("R1", revolutions, 0.0), WearOf::Profile(Measure::Maximum), Feedback::Profile)
    };
    let lived = |longest| {
        let step = WearStep::Adaptive { tolerance: 1e-4, shortest: 0.25, longest, remembers: false };
        let settings = LifeSettings { step, ..LifeSettings::new(vec![joint(2e6)]) };
        let mut fine = Arc { seen: Vec::new() };
        let (life, state) = live(&settings, &mut fine).unwrap();
        (life, state, fine.seen.len())
    };
    let ((one_by_one, stepped, measured), (life, jumped, fewer)) = (lived(1), lived(64));
    assert!(stepped.cycle > 100 && 3 * fewer < measured, "{} {fewer} {measured}", stepped.cycle);
    // Steps err by their tolerance; pieces are cut at other places, each 1e-8 m of the threshold of 4e-5 m.
    assert!((life / one_by_one - 1.0).abs() < 3e-4, "{life} {one_by_one}");
    for (one, other) in stepped.cycles.iter().zip(&jumped.cycles) {
        let (one, other) = (&one.joints[0], &other.joints[0]);
        assert!((one.wear - other.wear).abs() < 2e-8, "{one:?} {other:?}");
        assert!(other.increment > 0.0);
    }
}

/// A bush whose load stands and a pin that turns under it, each losing as much; the less, the deeper the bush is.
struct Both;

impl WearSource for Both {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        let deepest = joints[0].profile.as_ref().map_or(0.0, Profile::maximum);
        let volume = DEPTH / (1.0 + 3.0 * deepest / THRESHOLD);
        let (mut bush, mut pin) = (Profile::unworn(36).unwrap(), Profile::unworn(36).unwrap());
        bush.deposit(0.0, 0.0, volume);
        pin.add_depths(&[bush.mean(); 36], 1.0);
        let wear = revolution(DEPTH, joints[0].clearance);
        Ok(vec![ContactMeasure { deposit: Some(bush), journal: Some(pin), ..wear }])
    }
}

#[test]
fn bush_and_pin_make_room_for_each_other_however_far_a_step_jumps() {
    let joint = with_profile(joint("R1", 1e7, 0.0), WearOf::Profile(Measure::Mean), Feedback::Profile);
    let joint = JointLife { journal_bins: Some(36), ..joint };
    let lived = |longest| {
        let step = WearStep::Adaptive { tolerance: 1e-4, shortest: 0.25, longest, remembers: false };
        let settings = LifeSettings { step, ..LifeSettings::new(vec![joint.clone()]) };
        let (life, _) = live(&settings, &mut Both).unwrap();
        life
    };
    let (one_by_one, life) = (lived(1), lived(64));
    // The gap half opens again: a pin, and a bush, that wore in the gap of the jump's begin would make 2e-4 of difference. Parts
    // of the clearance leave 2e-5.
    assert!((life / one_by_one - 1.0).abs() < 5e-5, "{life} {one_by_one}");
}

#[test]
fn wear_by_profile_can_feed_back_as_one_number() {
    let scalar = joint("R1", 2e7, 0.5).feedback;
    let joint = with_profile(joint("R1", 2e7, 0.5), WearOf::Profile(Measure::Mean), scalar);
    let settings = LifeSettings { step: adaptive(1e-6), ..LifeSettings::new(vec![joint]) };
    let mut fine = Arc { seen: Vec::new() };
    let (_, state) = live(&settings, &mut fine).unwrap();
    let end = &state.joints[0];
    // The fine scale sees the clearance alone; c0 + gamma W up to roundings of 1e-4 m.
    assert!(fine.seen.iter().all(Option::is_none));
    assert!((end.clearance - C0 - 0.5 * end.wear).abs() < 1e-18);
    assert_eq!(end.wear, end.profile.as_ref().unwrap().mean());
}
