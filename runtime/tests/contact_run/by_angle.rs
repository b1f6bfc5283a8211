//! Wear by bearing angle of bush and journal.

use std::f64::consts::PI;

use linkwear_runtime::wear::{Area, Profile};
use linkwear_runtime::{ContactInfo, Settings, Simulation, Span, Watch};

use crate::common::journal::{Journal, coulomb, smooth, wear};
use crate::journals::{CLEARANCE, circling, dopri5, loaded, runner, steady, swelling};

#[test]
fn wear_by_angle_adds_up_and_goes_where_the_contact_is() {
    let system = loaded(ContactInfo { wear: wear(Area::Hertz, true), ..smooth() }, circling);
    let mut runner = runner(&system);
    runner.turns(2, Watch::NONE).expect("it turns");
    let turn = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    let deposit = turn.deposit.expect("it keeps a profile");
    let amount: f64 = deposit.depths().iter().sum::<f64>() * deposit.bin_angle();
    let expected = 1e-8 / 3.5e9 * turn.wear_integral / ((0.01 + CLEARANCE) * 0.02);
    // Shares of every step add up to it; a thousand steps round.
    assert!((amount - expected).abs() < 1e-12 * expected);
    for depth in deposit.depths() {
        // The same everywhere: one step, a 3600th of a turn, may fall to either side of a bin of a 72nd: 2 %;
        // in it the arc of contact, which is wider, evens out.
        assert!((depth / deposit.mean() - 1.0).abs() < 0.02, "{depth} {}", deposit.mean());
    }
    let system = loaded(ContactInfo { wear: wear(Area::Hertz, true), ..smooth() }, steady);
    let turn = self::runner(&system).measure(Watch::NONE).expect("it turns").joints.remove(0);
    let deposit = turn.deposit.expect("it keeps a profile");
    let angle = (40.0_f64 / 30.0).atan();
    for (bin, depth) in deposit.depths().iter().enumerate() {
        // Hertz arc of some 0.17 mm on 10 mm: less than a bin to either side.
        let near = (deposit.middle(bin) - angle).abs() < 1.5 * deposit.bin_angle();
        assert!((*depth > 0.0) <= near, "{bin} {depth}");
    }
}

#[test]
fn a_bush_wears_in_one_place_and_its_journal_evenly_round() {
    // Archard by hand: 50 N at a standing angle over a way of 2 pi r a turn; the journal is four times as hard.
    let (way, ratio) = (2.0 * PI * 0.01, 0.25);
    let volume = 1e-8 / 3.5e9 * 50.0 * way;
    let contact = || ContactInfo { wear: wear(Area::Hertz, true), ..smooth() };
    let integral = |depths: &Profile| depths.depths().iter().sum::<f64>() * depths.bin_angle();
    let system = loaded(contact(), steady).wearing(ratio);
    let turn = runner(&system).measure(Watch::NONE).expect("it turns").joints.remove(0);
    let (bush, journal) =
        (turn.deposit.as_ref().expect("a profile"), turn.journal.as_ref().expect("a profile"));
    // Volumes k F s/H of both, k/H of the journal a quarter; the load rings by 1e-8 of itself, as above.
    let (worn, of_journal) = (integral(bush) * (0.01 + CLEARANCE) * 0.02, integral(journal) * 0.01 * 0.02);
    assert!((worn / volume - 1.0).abs() < 1e-8, "{worn:e} {volume:e}");
    assert!((of_journal / (ratio * volume) - 1.0).abs() < 1e-8, "{of_journal:e}");
    // The bush in one place, less than a bin to either side (see below); the journal evenly: a step may fall to either side of
    // a bin of fifty steps.
    assert!(bush.depths().iter().filter(|depth| **depth > 0.0).count() <= 3);
    for depth in journal.depths() {
        assert!((depth / journal.mean() - 1.0).abs() < 0.02, "{depth:e} {:e}", journal.mean());
    }
    // A load that turns with the journal: the other way round.
    let system = loaded(contact(), circling).wearing(ratio);
    let mut runner = runner(&system);
    runner.turns(2, Watch::NONE).expect("it turns");
    let turn = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    let (bush, journal) = (turn.deposit.expect("a profile"), turn.journal.expect("a profile"));
    let expected = 1e-8 / 3.5e9 * turn.wear_integral;
    // A thousand steps round.
    assert!((integral(&journal) * 0.01 * 0.02 / (ratio * expected) - 1.0).abs() < 1e-12);
    assert!(journal.maximum() > 10.0 * journal.mean(), "{journal:?}");
    assert!(bush.maximum() < 1.02 * bush.mean(), "{bush:?}");
}

#[test]
fn a_journal_worn_by_angle_keeps_its_energy() {
    let contact = ContactInfo { wear: wear(Area::Hertz, true), ..smooth() };
    let mut system = Journal::new(contact).held([3e-6, -2e-6], [0.1, 0.07]).wearing(1.0);
    system.turning = 50.0;
    let settings = Settings::new(dopri5(1e-11), Span::Time(0.01), 2);
    let mut start =
        Simulation::start(&system, &system.description, &[9.81, CLEARANCE], &settings).expect("it starts");
    let waves = |high: f64, count: f64| {
        let depth = |bin: usize| high * (1.0 + (count * 2.0 * PI * (bin as f64 + 0.5) / 72.0).cos());
        Profile::try_from((0..72).map(depth).collect::<Vec<_>>()).expect("a profile")
    };
    start.set_worn_pair(0, 0.0, [Some(waves(1e-6, 3.0)), Some(waves(1e-6, 2.0))]).expect("it fits");
    let energy = |simulation: &mut Simulation<'_>| {
        let touch = simulation.contacts()[0];
        let (y, v) = (simulation.coordinates()[1], simulation.speeds());
        0.5 * (v[0] * v[0] + v[1] * v[1] + 1e-3 * v[2] * v[2]) + 9.81 * y + touch.elastic_energy
    };
    let before = energy(&mut start);
    let turning = start.speeds()[2];
    start.advance(0.01, Watch::NONE).expect("it runs");
    let after = energy(&mut start);
    // As in a round bearing: 1e-11 of a step, over some hundred bounces of it.
    assert!((after - before).abs() < 1e-8 * before, "{before:e} {after:e}");
    // The waves turn it: friction there is none.
    let turned = start.speeds()[2] - turning;
    assert!(turned.abs() > 1e-6, "{turned:e}");
}

#[test]
fn a_journal_in_a_place_that_fits_it_carries_its_load() {
    // A place as wide as a journal that has worn itself in by twice the clearance, cut into bins of five degrees: the journal lies on
    // several of them at once.
    let system = loaded(ContactInfo { wear: wear(Area::Hertz, true), ..smooth() }, steady);
    let angle = (40.0_f64 / 30.0).atan();
    let unworn = Profile::unworn(72).expect("bins");
    let depth = |bin: usize| (3.0 * CLEARANCE * (unworn.middle(bin) - angle).cos() - CLEARANCE).max(0.0);
    let worn = Profile::try_from((0..72).map(depth).collect::<Vec<_>>()).expect("a profile");
    let mut runner = runner(&system);
    runner.set_worn(0, 0.0, Some(worn)).expect("it fits");
    runner.turns(2, Watch::NONE).expect("it turns");
    let joint = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    // 50 N; the start still rings by a part of that.
    assert!((joint.mean_force / 50.0 - 1.0).abs() < 1e-6, "{}", joint.mean_force);
    // Way times force.
    assert!((joint.wear_integral / (50.0 * 2.0 * PI * 0.01) - 1.0).abs() < 1e-6, "{}", joint.wear_integral);
}

#[test]
fn an_uneven_profile_keeps_the_balance_of_energy() {
    let depths = (0..72).map(|i| 1e-6 * (1.0 + (f64::from(i) * PI / 18.0).sin())).collect::<Vec<_>>();
    let contact = ContactInfo { wear: wear(Area::Hertz, true), friction: coulomb(0.1), ..smooth() };
    let system = loaded(contact, swelling);
    let mut runner = runner(&system);
    runner.set_worn(0, 0.0, Some(Profile::try_from(depths).expect("a profile"))).expect("it fits");
    let statistics = runner.measure(Watch::NONE).expect("it turns").statistics;
    // The slope of the profile has kinks at the middles of bins: errors of order h³ there.
    assert!(statistics.energy_error_J < 1e-7 * statistics.energy_throughput_J, "{statistics:?}");
}
