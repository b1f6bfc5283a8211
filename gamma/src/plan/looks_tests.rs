//! Looks at units that differ, and what possible lives leave open of looks.

use super::*;
use crate::life::{Clock, Estimate, FirstPassage, Law, OperatingState};
use crate::process::{Gamma, InverseGaussian, Process};

fn part(law: Law) -> Monitored {
    Monitored::new(law, Clock::linear(1.0).expect("valid"), 10.0).expect("valid")
}

#[test]
fn units_that_hardly_differ_cost_what_units_alike_do() {
    let costs = Costs::new(10.0, 50.0).expect("valid");
    let looks = Looks::new(1.0, Some(20.0)).expect("valid");
    for process in [&Gamma as &'static dyn Process, &InverseGaussian] {
        let logs = [0.7, 0.2];
        let cost = |law: Law| part(law).cost(&costs, &looks, 1.5, 7.0).expect("valid");
        let alike = cost(Law::from_logs(process, logs).expect("valid"));
        let differ = |cv: f64| cost(Law::of_units(process, logs, cv).expect("valid")).rate;
        // Second order in the variation.
        assert!((differ(1e-3) / alike.rate - 1.0).abs() < 1e-4, "{process:?}");
        assert!((differ(0.5) / alike.rate - 1.0).abs() > 1e-2, "{process:?}");
    }
}

#[test]
fn a_plan_for_units_that_differ_is_cheaper_than_the_one_for_units_alike() {
    let costs = Costs::new(10.0, 60.0).expect("valid");
    let looks = Looks::new(0.5, None).expect("valid");
    let logs = [4.0_f64.ln(), 2.0_f64.ln()];
    let differ = part(Law::of_units(&Gamma, logs, 0.5).expect("valid"));
    // A threshold of one's own: the search along both takes half a minute.
    let threshold = Some(7.5);
    let plan = best_inspection(&differ, &costs, &looks, None, threshold).expect("a plan");
    let alike = part(Law::from_logs(&Gamma, logs).expect("valid"));
    let other = best_inspection(&alike, &costs, &looks, None, threshold).expect("a plan");
    let told = differ.cost(&costs, &looks, other.interval, other.threshold).expect("valid");
    assert!(plan.cost.rate < told.rate * (1.0 - 1e-3), "{plan:?} {other:?} {told:?}");
    // Fast units need more looks.
    assert!(plan.interval < other.interval, "{plan:?} {other:?}");
    for a in [0.85, 1.15] {
        let near = differ.cost(&costs, &looks, a * plan.interval, plan.threshold).expect("valid");
        // The search goes by fewer units than the cost that is told.
        assert!(near.rate > plan.cost.rate * (1.0 - 1e-3), "{plan:?} {a} {near:?}");
    }
}

#[test]
fn the_best_looks_of_the_fastest_and_the_slowest_lives_are_the_ends() {
    let state = OperatingState::new(10.0).expect("valid");
    let lives: Vec<FirstPassage> = [0.5, 1.0, 2.0]
        .iter()
        .map(|pace| {
            state.life(&Estimate::new(&Gamma, [2.0 * pace, 2.0], None).expect("valid")).expect("valid")
        })
        .collect();
    let costs = Costs::new(10.0, 60.0).expect("valid");
    let looks = Looks::new(0.5, None).expect("valid");
    let of = |life: &FirstPassage| {
        let part = Monitored::new(*life.law(), life.clock().clone(), 10.0).expect("valid");
        (best_inspection(&part, &costs, &looks, None, None).expect("a plan"), part)
    };
    let found: Vec<_> = lives.iter().map(of).collect();
    let plan = found[1].0;
    let asked = (&costs, &looks);
    let bands = look_bands(&lives, 10.0, asked, (&plan, [false; 2]), 1.0).expect("lives");
    // The search nearby ends with steps of 2 %.
    let (slow, fast) = (&found[0], &found[2]);
    assert!((bands.interval.0 / fast.0.interval - 1.0).abs() < 0.03, "{bands:?} {:?}", fast.0);
    assert!((bands.interval.1 / slow.0.interval - 1.0).abs() < 0.03, "{bands:?} {:?}", slow.0);
    let thresholds: Vec<f64> = found.iter().map(|(plan, _)| plan.threshold).collect();
    let ends = [bands.threshold.0, bands.threshold.1];
    let expected = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|pick| thresholds.iter().copied().reduce(pick).expect("three"));
    assert!(ends.iter().zip(expected).all(|(end, own)| (end - own).abs() < 0.3), "{ends:?} {thresholds:?}");
    let cost =
        |part: &Monitored| part.cost(&costs, &looks, plan.interval, plan.threshold).expect("valid").rate;
    assert_eq!(bands.cost_rate, (cost(&slow.1), cost(&fast.1)));
    // What is given is kept.
    let kept = look_bands(&lives, 10.0, asked, (&plan, [true, false]), 1.0).expect("lives");
    assert!((kept.interval.0 / plan.interval - 1.0).abs() < 1e-12, "{kept:?}");
    assert_eq!(kept.interval.0, kept.interval.1);
    assert!(look_bands(&[], 10.0, asked, (&plan, [false; 2]), 0.95).is_none());
}
