//! Looks at units that differ, and what possible lives leave open of looks.

use super::*;
use crate::life::{Clock, Estimate, FirstPassage, Law, OperatingState};
use crate::process::{Gamma, InverseGaussian, Process};

fn part(law: Law) -> Monitored {
    Monitored::new(law, Clock::linear(1.0).expect("valid"), 10.0).expect("valid")
}

/// Wear that is looked at after every unit of time and grows by exponential amounts in between, which a Gamma process of shape 1
/// does; a part has failed if wear is beyond K at a look (T. Nakagawa, Shock and Damage Models in Reliability Theory, Springer 2007,
/// section 3.2 (3) and the end of example 3.1; tables 3.1 and 3.4). Printed: K, cost of a failure beside that of a replacement in
/// time, the wear from which to replace, and its cost, all in mean amounts and by looks.
#[test]
fn thresholds_of_replacement_of_a_published_example() {
    let table_3_4 = [
        (10.0, 2.0, 7.93, Some(0.126)),
        (10.0, 5.0, 6.71, Some(0.149)),
        (10.0, 10.0, 6.01, Some(0.166)),
        (10.0, 20.0, 5.37, Some(0.186)),
        (20.0, 2.0, 17.16, Some(0.058)),
        (20.0, 5.0, 15.85, Some(0.063)),
        (20.0, 10.0, 15.09, Some(0.066)),
        (20.0, 20.0, 14.39, Some(0.069)),
    ];
    // Tires that fail at 30,000 km, with a mean of 1000 km in a unit of time: printed in km.
    let table_3_1 = [(30.0, 2.0, 26.714, None), (30.0, 5.0, 25.379, None), (30.0, 10.0, 24.600, None)];
    let rows = table_3_4.into_iter().chain(table_3_1);
    // All of them take half a minute.
    let every = if std::env::var("ALL_ROWS").is_ok() { 1 } else { 5 };
    for (failure, ratio, threshold, rate) in rows.step_by(every) {
        let law = Law::from_logs(&Gamma, [0.0, 0.0]).expect("valid");
        let part = Monitored::new(law, Clock::linear(1.0).expect("valid"), failure).expect("valid");
        let costs = Costs::new(1.0, ratio).expect("valid");
        // The book has no cost of looks, nor of failures until they are seen: as good as none.
        let looks = Looks::new(1e-6, Some(1e-6)).expect("valid");
        let plan = best_inspection(&part, &costs, &looks, Some(1.0), None).expect("a plan");
        // Half of the last digit, and what a cost good to 1e-7 leaves of a flat minimum.
        assert!((plan.threshold - threshold).abs() < 5e-3 + 2e-3, "{failure} {ratio}: {plan:?}");
        if let Some(rate) = rate {
            assert!((plan.cost.rate - rate).abs() < 5e-4, "{failure} {ratio}: {plan:?}");
        }
    }
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
fn a_plan_of_few_looks_is_found_where_it_is_cheapest() {
    // Dear looks at parts that live much alike: one shortly before they fail, or two, each cheap within a few percent of its interval.
    let costs = Costs::new(100.0, 900.0).expect("valid");
    let looks = Looks::new(15.0, None).expect("valid");
    for shape in [3.0_f64, 5.0] {
        let part = Monitored::new(
            Law::new(&Gamma, [shape; 2]).expect("valid"),
            Clock::linear(1.0).expect("valid"),
            20.0,
        )
        .expect("valid");
        let plan = best_inspection(&part, &costs, &looks, None, None).expect("a plan");
        // No plan of a grid is cheaper, but for its digits.
        for at in 0..24 {
            let interval = 5.0 * 1.06_f64.powi(at);
            for threshold in [1.0, 3.0, 6.0, 9.0, 11.0, 13.0] {
                let other = part.cost(&costs, &looks, interval, threshold).expect("valid").rate;
                assert!(
                    plan.cost.rate < other * (1.0 + 1e-4),
                    "{shape}: {plan:?}, {interval} {threshold} {other}"
                );
            }
        }
        // The band of one possible life is its own plan, also beside a plan of two looks.
        let other = ConditionPlan { interval: 0.5 * plan.interval, threshold: 10.0, ..plan };
        let lives = [part.life().expect("valid")];
        let band = look_bands(&lives, 20.0, (&costs, &looks), (&other, [false; 2]), 0.95).expect("a life");
        assert!((band.interval.0 / plan.interval - 1.0).abs() < 0.02, "{plan:?} {band:?}");
        // Of thresholds that cost the same, since all parts are beyond them at the first look, the highest.
        assert!(plan.threshold > 4.0, "{plan:?}");
        let higher = part.cost(&costs, &looks, plan.interval, plan.threshold + 0.5).expect("valid").rate;
        assert!(higher > plan.cost.rate, "{plan:?} {higher}");
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
