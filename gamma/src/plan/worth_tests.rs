//! What a look is worth where replacements take time.

use super::*;
use crate::life::{Clock, FirstPassage, Law};
use crate::process::Gamma;

const FAILURE: f64 = 10.0;

fn new_part(law: Law) -> InUse {
    InUse { law, clock: Clock::linear(1.0).expect("valid"), failure: FAILURE, current: 0.0, now: 0.0 }
}

fn life(part: &InUse) -> FirstPassage {
    FirstPassage::from(part.law, part.clock.clone(), part.failure, part.current, part.now).expect("valid")
}

fn costs((preventive, failure): (f64, f64), (preventive_time, failure_time): (f64, f64)) -> Costs {
    Costs::new(preventive, failure).expect("valid").taking(preventive_time, failure_time).expect("valid")
}

/// Standstills of every kind: none, after failures, at both ends, and so long that a failure is better than a replacement.
const STANDSTILLS: [(f64, f64); 4] = [(0.0, 0.0), (0.0, 3.0), (1.0, 20.0), (0.5, 400.0)];

#[test]
fn without_a_look_a_new_part_is_replaced_at_the_best_age_and_costs_what_time_does() {
    let law = Law::from_logs(&Gamma, [0.9, 0.9]).expect("valid");
    for times in STANDSTILLS {
        let (part, costs) = (new_part(law), costs((1.0, 5.0), times));
        let best = best_age(&life(&part), &costs).expect("a plan");
        let worth = worth_of_a_look(&part, &costs, best.cost_rate, 4.0).expect("valid");
        assert_eq!(worth.replace_after.is_some(), best.age.is_some(), "{times:?}: {worth:?} {best:?}");
        if let (Some(after), Some(age)) = (worth.replace_after, best.age) {
            assert!((after / age - 1.0).abs() < 1e-3, "{times:?}: {worth:?} {best:?}");
        }
        assert!(worth.without.abs() < 1e-5, "{times:?}: {worth:?} {best:?}");
        assert!(worth.value() >= 0.0, "{times:?}: {worth:?}");
    }
}

#[test]
fn standstill_is_worth_the_time_that_it_takes() {
    let law = Law::from_logs(&Gamma, [0.9, 0.9]).expect("valid");
    for (times, current) in [((1.0, 20.0), 0.0), ((1.0, 20.0), 6.0), ((3.0, 4.0), 8.0)] {
        let part = InUse { current, now: current, ..new_part(law) };
        let taking = costs((1.0, 5.0), times);
        let rate = best_age(&life(&new_part(law)), &taking).expect("a plan").cost_rate;
        let paid = (1.0 - rate * times.0, 5.0 - rate * times.1);
        let found = worth_of_a_look(&part, &taking, rate, 2.0).expect("valid");
        let same = worth_of_a_look(&part, &costs(paid, (0.0, 0.0)), rate, 2.0).expect("valid");
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(found.without, same.without) && close(found.with, same.with), "{found:?} {same:?}");
        assert_eq!(found.replace_after, same.replace_after);
        assert_eq!(found.replaced_at_once, same.replaced_at_once);
    }
}

#[test]
fn a_part_whose_failure_costs_less_than_its_replacement_is_left_to_fail() {
    let law = Law::from_logs(&Gamma, [0.9, 0.9]).expect("valid");
    let costs = costs((1.0, 5.0), STANDSTILLS[3]);
    let worn = InUse { current: 9.5, now: 9.5, ..new_part(law) };
    let rate = best_age(&life(&new_part(law)), &costs).expect("a plan").cost_rate;
    let worth = worth_of_a_look(&worn, &costs, rate, 0.2).expect("valid");
    assert_eq!((worth.replace_after, worth.replaced_at_once), (None, 0.0), "{worth:?}");
    assert!(worth.value() < 1e-4, "a look changes nothing: {worth:?}");
}

#[test]
fn a_look_is_worth_what_quadrature_says_however_little_that_is() {
    let law = Law::from_logs(&Gamma, [3.0_f64.ln(), 1.4_f64.ln()]).expect("valid");
    let part = InUse { failure: 20.0, ..new_part(law) };
    let costs = costs((200.0, 1500.0), STANDSTILLS[0]);
    // scipy 1.17.1: costs after the look by 80 points of Gauss and the best age, over 1201 even steps of a normal number of the same
    // probability as the wear. Middles of 64 even parts of the probability came to 0.430, 1.601, 8.055 and 36.724, none at once.
    for (at, value, at_once) in
        [(0.05, 0.385_850, 0.0), (0.2, 1.551_838, 0.0), (1.0, 7.999_190, 0.0), (4.0, 36.730_342, 0.001_383)]
    {
        let found = worth_of_a_look(&part, &costs, 38.0, at).expect("valid");
        // A part in 1e4, and of those replaced at once half a step of the 1201.
        assert!((found.value() / value - 1.0).abs() < 1e-4, "{at}: {} {value}", found.value());
        assert!((found.replaced_at_once - at_once).abs() < 2e-5, "{at}: {found:?}");
    }
}
