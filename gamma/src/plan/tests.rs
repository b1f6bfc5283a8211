//! Plans against published examples, closed forms and simulation.

use super::*;
use crate::life::{Clock, Law, Lifetime, Weibull};
use crate::process::{Gamma, InverseGaussian, Process, Wiener};
use crate::random::Stream;

/// Even between 0 and `end`.
struct Even {
    end: f64,
}

impl Lifetime for Even {
    fn reliability(&self, t: f64) -> f64 {
        (1.0 - t / self.end).clamp(0.0, 1.0)
    }
    fn typical(&self) -> f64 {
        0.5 * self.end
    }
    fn breaks(&self) -> Vec<f64> {
        vec![self.end]
    }
}

/// ReliaWiki, "Optimum Replacement Time Example" (System Analysis Reference): Weibull law of shape 2.5 and scale 1000 h,
/// replacement $1, failure $5. The Python package `reliability` prints for it 493.05 h (in its documentation up to version 0.5) and
/// $0.0035 an hour; later versions print 493.19 h, a minimum sought less closely.
#[test]
fn the_replacement_age_of_a_published_example() {
    let costs = Costs::new(1.0, 5.0).expect("valid");
    let life = Weibull { scale: 1000.0, shape: 2.5 };
    let plan = best_age(&life, &costs).expect("a plan");
    let age = plan.age.expect("pays");
    // Printed digits.
    assert!((age - 493.05).abs() < 0.005, "{plan:?}");
    assert!((plan.cost_rate - 0.0035).abs() < 5e-5);
    // The minimum is flat: 0.4 h beside it nothing shows in eight digits.
    for other in [0.7 * age, 1.3 * age] {
        assert!(age_cost_rate(&life, &costs, other).expect("valid") > plan.cost_rate);
    }
    assert!((plan.cost_rate - age_cost_rate(&life, &costs, age).expect("valid")).abs() < 1e-12);
}

/// Jardine and Tsang, Maintenance, Replacement and Reliability, chapter 2, problem 2: failures even between 0 and 40,000 km,
/// replacement 100, failure 200; the publisher's solutions print four rates per km, and 30,000 km as the best of these ages.
#[test]
fn cost_rates_of_a_published_exercise() {
    let costs = Costs::new(100.0, 200.0).expect("valid");
    let life = Even { end: 40_000.0 };
    for (age, printed) in [(10_000.0, 0.0143), (20_000.0, 0.0100), (30_000.0, 0.0093), (40_000.0, 0.0100)] {
        let rate = age_cost_rate(&life, &costs, age).expect("valid");
        assert!((rate - printed).abs() < 5e-5, "{age}: {rate}");
    }
    // By hand: C = 200 (80000 + 2 T) / (80000 T - T^2) is least where T^2 + 80000 T = 80000^2 / 2.
    let age = 40_000.0 * (3.0_f64.sqrt() - 1.0);
    let plan = best_age(&life, &costs).expect("a plan");
    assert!((plan.age.expect("pays") / age - 1.0).abs() < 1e-5, "{plan:?} {age}");
}

#[test]
fn where_failures_come_by_chance_waiting_is_best() {
    let costs = Costs::new(1.0, 100.0).expect("valid");
    for shape in [0.7, 1.0] {
        let plan = best_age(&Weibull { scale: 3.0, shape }, &costs).expect("a plan");
        assert_eq!(plan.age, None, "{shape}");
        assert!((plan.cost_rate - plan.failure_only).abs() < 1e-15);
    }
    let error = Costs::new(2.0, 1.0).expect_err("nothing to save");
    assert_eq!(error, PlanError::NothingToSave { preventive: 2.0, failure: 1.0 });
}

/// Standstill that is as long as it is dear changes the age; a failure that stands still for no time does not.
#[test]
fn times_of_replacement_count_as_time_of_the_cycle() {
    let life = Weibull { scale: 10.0, shape: 3.0 };
    let none = Costs::new(1.0, 4.0).expect("valid");
    let some = none.taking(0.5, 2.0).expect("valid");
    let at = |costs: &Costs| age_cost_rate(&life, costs, 6.0).expect("valid");
    let (alive, use_time) = (life.reliability(6.0), (1.0 * alive_cost(&life) + 0.0) / at(&none));
    let by_hand = alive_cost(&life) / (use_time + 0.5 * alive + 2.0 * (1.0 - alive));
    assert!((at(&some) - by_hand).abs() < 1e-12);
}

fn alive_cost(life: &dyn Lifetime) -> f64 {
    life.reliability(6.0) + 4.0 * life.failed(6.0)
}

fn differing(process: &'static dyn Process, parameters: [f64; 2], exponent: f64, cv: f64) -> Monitored {
    if cv == 0.0 {
        return part(process, parameters, exponent);
    }
    let law = Law::of_units(process, parameters.map(f64::ln), cv).expect("valid");
    Monitored::new(law, Clock::power(1.0, exponent).expect("valid"), 10.0).expect("valid")
}

fn part(process: &'static dyn Process, parameters: [f64; 2], exponent: f64) -> Monitored {
    let clock = Clock::power(1.0, exponent).expect("valid");
    Monitored::new(Law::new(process, parameters).expect("valid"), clock, 10.0).expect("valid")
}

/// Cost and length of cycles by drawing the wear at even small steps of the clock.
fn simulated(
    (process, parameters, exponent, cv): (&'static dyn Process, [f64; 2], f64, f64),
    (costs, looks): (&Costs, &Looks),
    (interval, threshold): (f64, f64),
    cycles: u32,
) -> (f64, f64) {
    const FINE: usize = 50;
    let logs = parameters.map(f64::ln);
    let mut stream = Stream::new(7, 0, 0);
    let (mut cost, mut length, mut squares) = (0.0, 0.0, 0.0);
    let mut all = Vec::new();
    for _ in 0..cycles {
        let (mut wear, mut k, mut spent) = (0.0, 0, 0.0);
        let mut failed_at = None;
        let effect = process.random_effect().filter(|_| cv > 0.0);
        let logs = effect.map_or(logs, |effect| effect.draw(logs, cv, &mut stream));
        let took = loop {
            for i in 0..FINE {
                let t = |i: usize| interval * (k as f64 + i as f64 / FINE as f64);
                let exposure = t(i + 1).powf(exponent) - t(i).powf(exponent);
                wear += process.draw(logs, exposure, &mut stream);
                if wear >= 10.0 && failed_at.is_none() {
                    // Somewhere within the fine step.
                    failed_at = Some(0.5 * (t(i) + t(i + 1)));
                }
            }
            k += 1;
            let now = interval * k as f64;
            match (failed_at, looks.downtime) {
                (Some(at), None) => {
                    spent += costs.failure;
                    break at + costs.failure_time;
                }
                (Some(at), Some(downtime)) => {
                    spent += looks.inspection + costs.failure + downtime * (now - at);
                    break now + costs.failure_time;
                }
                (None, _) => spent += looks.inspection,
            }
            if wear >= threshold {
                spent += costs.preventive;
                break now + costs.preventive_time;
            }
        };
        cost += spent;
        length += took;
        all.push((spent, took));
    }
    let rate = cost / length;
    for (spent, took) in all {
        squares += (spent - rate * took) * (spent - rate * took);
    }
    // Standard error of a ratio.
    (rate, squares.sqrt() / length)
}

#[test]
fn looking_at_even_intervals_costs_what_simulated_cycles_cost() {
    let costs = Costs::new(10.0, 50.0).expect("valid").taking(0.1, 0.4).expect("valid");
    let models: [(&'static dyn Process, [f64; 2], f64, f64); 5] = [
        (&Gamma, [2.0, 1.0], 1.0, 0.0),
        (&InverseGaussian, [1.5, 3.0], 1.0, 0.0),
        (&Gamma, [3.0, 2.0], 1.4, 0.0),
        // Units that differ.
        (&Gamma, [2.0, 1.0], 1.0, 0.4),
        (&InverseGaussian, [1.5, 3.0], 1.4, 0.2),
    ];
    for model in models {
        for downtime in [None, Some(20.0)] {
            let looks = Looks::new(1.0, downtime).expect("valid");
            for (interval, threshold) in [(1.0, 6.0), (2.5, 8.5)] {
                let found = differing(model.0, model.1, model.2, model.3)
                    .cost(&costs, &looks, interval, threshold)
                    .expect("valid");
                let (rate, error) = simulated(model, (&costs, &looks), (interval, threshold), 8000);
                // Four standard errors, 1 % of a fine step.
                assert!(
                    (found.rate - rate).abs() < 4.0 * error + 1e-3 * rate,
                    "{model:?} {downtime:?} {interval}: {found:?} {rate} +- {error}"
                );
            }
        }
    }
}

/// Replacing at the first look whatever it shows is replacing at an age.
#[test]
fn a_threshold_near_zero_is_an_age() {
    let part = part(&Gamma, [4.0, 2.0], 1.0);
    let costs = Costs::new(10.0, 60.0).expect("valid");
    let looks = Looks::new(2.0, None).expect("valid");
    let found = part.cost(&costs, &looks, 3.0, 1e-9).expect("valid");
    let dearer = Costs::new(12.0, 60.0).expect("valid");
    let life = part.life().expect("valid");
    let rate = age_cost_rate(&life, &dearer, 3.0).expect("valid");
    // Accuracy asked of the integrals, for the costs of failures.
    assert!((found.rate / rate - 1.0).abs() < 1e-6, "{found:?} {rate}");
}

#[test]
fn no_plan_nearby_is_cheaper() {
    let part = part(&Gamma, [2.0, 1.0], 1.0);
    let costs = Costs::new(10.0, 50.0).expect("valid");
    for downtime in [None, Some(30.0)] {
        let looks = Looks::new(1.0, downtime).expect("valid");
        let plan = best_inspection(&part, &costs, &looks, None, None).expect("a plan");
        assert!(!plan.at_an_end && plan.threshold < 10.0, "{plan:?}");
        for (a, b) in [(0.9, 1.0), (1.1, 1.0), (1.0, 0.93), (1.0, 1.07), (1.08, 1.05), (0.92, 0.95)] {
            let (interval, threshold) = (a * plan.interval, (b * plan.threshold).min(10.0));
            let other = part.cost(&costs, &looks, interval, threshold).expect("valid");
            assert!(other.rate >= plan.cost.rate * (1.0 - 1e-9), "{plan:?} {interval} {threshold} {other:?}");
        }
        // To look is a choice more: not dearer than an age at which a look is made as well.
        let age =
            best_age(&part.life().expect("valid"), &Costs::new(11.0, 50.0).expect("valid")).expect("a plan");
        if downtime.is_none() {
            assert!(plan.cost.rate <= age.cost_rate * (1.0 + 1e-9), "{plan:?} {age:?}");
        }
    }
}

#[test]
fn questions_without_an_answer_say_so() {
    let clock = || Clock::linear(1.0).expect("valid");
    let wiener = Law::new(&Wiener, [1.0, 1.0]).expect("valid");
    assert!(matches!(Monitored::new(wiener, clock(), 10.0), Err(PlanError::FallingWear)));
    let part = part(&Gamma, [2.0, 1.0], 1.0);
    let costs = Costs::new(10.0, 50.0).expect("valid");
    assert_eq!(Looks::new(1.0, Some(0.0)), Err(PlanError::FreeDowntime));
    let free = Looks::new(1.0, None).expect("valid");
    let above = part.cost(&costs, &free, 1.0, 11.0);
    assert!(matches!(above, Err(PlanError::ReplacedTooLate { .. })), "{above:?}");
    // After 20,000 looks all parts are still there: what is summed up by then is no cycle.
    let often = part.cost(&costs, &free, 1e-5, 5.0);
    assert!(matches!(often, Err(PlanError::TooOften { .. })), "{often:?}");
    let free = Looks::new(0.0, None).expect("valid");
    assert!(best_inspection(&part, &costs, &free, None, None).is_err());
}

/// The expectation over drawn wear, each followed by the cheapest age on a fine grid, all sums by hand.
#[test]
fn a_look_is_worth_what_it_saves_on_drawn_parts() {
    let law = Law::new(&Gamma, [1.0, 1.0]).expect("valid");
    let clock = Clock::linear(1.0).expect("valid");
    let part = InUse { law, clock: clock.clone(), failure: 10.0, current: 2.0, now: 3.0 };
    let costs = Costs::new(10.0, 80.0).expect("valid");
    let new = crate::life::FirstPassage::new(law, clock, 10.0).expect("valid");
    let rate = best_age(&new, &costs).expect("a plan").cost_rate;
    let at = 2.5;
    let worth = worth_of_a_look(&part, &costs, rate, at).expect("valid");
    let cheapest = |left: f64| {
        let (mut used, mut best) = (0.0, costs.preventive);
        let step = 0.02;
        for k in 1..2500 {
            let t = step * f64::from(k);
            let s = |t: f64| Gamma.survival([0.0, 0.0], t.max(1e-12), left);
            used += step * s(t - 0.5 * step);
            best = f64::min(best, costs.preventive * s(t) + costs.failure * (1.0 - s(t)) - rate * used);
        }
        best
    };
    assert!((worth.without - cheapest(8.0)).abs() < 1e-3 * costs.preventive, "{worth:?} {}", cheapest(8.0));
    let mut stream = Stream::new(3, 0, 0);
    let draws = 400;
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..draws {
        let (mut worn, mut lasted) = (0.0, at);
        for k in 0..50 {
            worn += Gamma.draw([0.0, 0.0], at / 50.0, &mut stream);
            if worn >= 8.0 {
                lasted = at * (f64::from(k) + 0.5) / 50.0;
                break;
            }
        }
        let cost = if worn >= 8.0 { costs.failure } else { cheapest(8.0 - worn) } - rate * lasted;
        sum += cost;
        squares += cost * cost;
    }
    let mean = sum / f64::from(draws);
    let error = ((squares / f64::from(draws) - mean * mean) / f64::from(draws)).sqrt();
    assert!((worth.with - mean).abs() < 4.0 * error, "{worth:?} {mean} +- {error}");
    assert!(worth.value() > 0.0, "{worth:?}");
    // A look when all is over tells nothing.
    let late = worth_of_a_look(&part, &costs, rate, 60.0).expect("valid");
    assert!(late.value().abs() < 1e-9, "{late:?}");
}
