//! Looks that find failures, against published examples and closed forms.

use super::*;
use crate::life::{Lifetime, Weibull};

/// A normal law of lives.
struct Normal {
    mean: f64,
    std: f64,
}

impl Lifetime for Normal {
    fn reliability(&self, t: f64) -> f64 {
        0.5 * libm::erfc((t - self.mean) / (self.std * 2.0_f64.sqrt()))
    }
    fn typical(&self) -> f64 {
        self.mean
    }
}

/// Equipment for emergencies, whose inspection takes 0.25 month and makes it as new, and whose repair takes 0.5 month more, with normal
/// lives: the availability in closed form, by the integral of the normal law.
#[test]
fn the_availability_of_equipment_for_emergencies_is_that_of_the_closed_form() {
    let (mean, std) = (5.0, 1.0);
    let life = Normal { mean, std };
    // What costs is time: the rate of cost is the part of time that the equipment cannot be called on.
    let costs = Costs::new(0.25, 0.75).expect("valid").taking(0.25, 0.75).expect("valid");
    let looks = Looks::new(0.0, Some(1.0)).expect("valid");
    let availability =
        |interval: f64| 1.0 - hidden_cost(&life, &costs, &looks, interval, Some(1)).expect("valid").rate;
    // The antiderivative of the reliability: (t - m) S(t) - s phi((t - m) / s).
    let sum = |t: f64| {
        let off = (t - mean) / std;
        let density = (-0.5 * off * off).exp() / (2.0 * std::f64::consts::PI).sqrt();
        (t - mean) * life.reliability(t) - std * density
    };
    for interval in [0.5, 1.0, 3.0, 3.3, 5.0, 8.0] {
        let works = life.reliability(interval);
        let cycle = interval + 0.25 * works + 0.75 * (1.0 - works);
        let expected = (sum(interval) - sum(0.0)) / cycle;
        let found = availability(interval);
        // Quadrature of the reliability.
        assert!((found - expected).abs() < 1e-8, "{interval}: {found} {expected}");
    }
}

/// Intervals of failure finding as parts of the mean life, for an availability (J. Moubray, Reliability-centred Maintenance, 2nd ed.
/// 1997, compared with a reprint of the table): exponential lives, looks that take no time.
#[test]
fn availabilities_of_a_published_table_of_failure_finding() {
    let life = Weibull { scale: 1.0, shape: 1.0 };
    let costs = Costs::new(0.5, 1.0).expect("valid");
    let looks = Looks::new(0.0, Some(1.0)).expect("valid");
    for (interval, printed, digit) in
        [(0.002, 99.9, 0.1), (0.01, 99.5, 0.1), (0.02, 99.0, 1.0), (0.06, 97.0, 1.0), (0.1, 95.0, 1.0)]
    {
        let found = hidden_cost(&life, &costs, &looks, interval, None).expect("valid");
        let availability = 100.0 * (1.0 - found.unnoticed / found.cycle);
        assert!((availability - printed).abs() < 0.5 * digit, "{interval}: {availability}");
    }
}

/// Shocks of rate 1 whose exponential damages add up to more than 100 of their means.
struct Shocks;

impl Lifetime for Shocks {
    fn reliability(&self, t: f64) -> f64 {
        // By the number of shocks until then, and the number of damages that fit in: both are Poisson's.
        let (mut sum, mut shocks, mut fit) = (0.0, (-t).exp(), 1.0);
        let mut damages = (-100.0_f64).exp();
        for j in 0..400 {
            sum += shocks * fit;
            shocks *= t / f64::from(j + 1);
            fit -= damages;
            damages *= 100.0 / f64::from(j + 1);
        }
        sum
    }
    fn typical(&self) -> f64 {
        100.0
    }
}

/// Looks that find damage beyond a threshold (T. Nakagawa, Shock and Damage Models in Reliability Theory, Springer 2007, table 5.2,
/// without damage by inspection): a look every 5, which costs 1 as an undetected failure does by unit of time. With a replacement at
/// 1 it is printed to be best at the 15th look, and to cost 0.214. For replacements at 5 and 10 the book has 17, 19 and 0.264, 0.323;
/// its sums end too early there: with all terms it is 18, 20 and 0.262, 0.316 (by another program).
#[test]
fn the_look_at_which_parts_are_replaced_may_be_late() {
    for (replacement, last, rate, digits) in
        [(1.0, 15, 0.214, 5e-4), (5.0, 18, 0.262_025, 1e-6), (10.0, 20, 0.316_202, 1e-6)]
    {
        // A replacement costs the same for a failed part; costs must differ.
        let costs = Costs::new(replacement, replacement * (1.0 + 1e-9)).expect("valid");
        let looks = Looks::new(1.0, Some(1.0)).expect("valid");
        let plan = best_hidden(&Shocks, &costs, &looks, Some(5.0)).expect("a plan");
        assert_eq!(plan.last, Some(last), "{plan:?}");
        assert!((plan.cost.rate - rate).abs() < digits, "{plan:?}");
    }
}

/// Barlow and Proschan's model with lives that know no age: all sums are geometric.
#[test]
fn looks_at_exponential_lives_cost_what_the_closed_form_says() {
    let (mean, inspection, downtime, failure) = (500.0, 10.0, 1.0, 40.0);
    let life = Weibull { scale: mean, shape: 1.0 };
    let costs = Costs::new(20.0, failure).expect("valid");
    let looks = Looks::new(inspection, Some(downtime)).expect("valid");
    let rate = |tau: f64| {
        let looked = 1.0 / -(-tau / mean).exp_m1();
        (inspection * looked + downtime * (tau * looked - mean) + failure) / (tau * looked)
    };
    for tau in [20.0, 97.0, 400.0] {
        let found = hidden_cost(&life, &costs, &looks, tau, None).expect("valid");
        assert!((found.rate / rate(tau) - 1.0).abs() < 1e-7, "{tau}: {found:?} {}", rate(tau));
        assert!((found.looks * -(-tau / mean).exp_m1() - 1.0).abs() < 1e-7);
        // What works is as good as new: replacing it costs, and saves nothing.
        assert!(hidden_cost(&life, &costs, &looks, tau, Some(3)).expect("valid").rate > found.rate);
    }
    let plan = best_hidden(&life, &costs, &looks, None).expect("a plan");
    assert_eq!((plan.last, plan.at_an_end), (None, false));
    // d rate / d tau = 0: (c_d mean - c_f) (1 - (1 + x) exp(-x)) = c_i, x = tau / mean, by bisection.
    let slope = |x: f64| (downtime * mean - failure) * (1.0 - (1.0 + x) * (-x).exp()) - inspection;
    let (mut low, mut high) = (0.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if slope(middle) < 0.0 { low = middle } else { high = middle }
    }
    // The minimum is flat: values good to 1e-8 tell its place to some 1e-4.
    assert!((plan.interval / (low * mean) - 1.0).abs() < 1e-3, "{plan:?} {}", low * mean);
}

#[test]
fn parts_that_age_are_replaced_at_some_look() {
    let life = Weibull { scale: 100.0, shape: 4.0 };
    let costs = Costs::new(5.0, 100.0).expect("valid");
    let looks = Looks::new(0.5, Some(10.0)).expect("valid");
    let plan = best_hidden(&life, &costs, &looks, None).expect("a plan");
    let last = plan.last.expect("parts age");
    // Neighbours cost no less.
    for (factor, last) in [(0.9, Some(last)), (1.1, Some(last)), (1.0, Some(last + 1)), (1.0, None)] {
        let other = hidden_cost(&life, &costs, &looks, factor * plan.interval, last).expect("valid");
        assert!(other.rate >= plan.cost.rate * (1.0 - 1e-9), "{plan:?} {factor} {last:?} {other:?}");
    }
    // To look once, at the end, is to replace at an age; a failure costs more by its mean time unnoticed.
    let one = hidden_cost(&life, &costs, &looks, 60.0, Some(1)).expect("valid");
    let dearer = Costs::new(5.5, 100.5 + 10.0 * one.unnoticed / one.fail).expect("valid");
    let by_age = age_cost_rate(&life, &dearer, 60.0).expect("valid");
    // The cycle is as long as the interval, whether the part failed or not.
    let used = 60.0 - one.unnoticed;
    assert!((one.rate * 60.0 / (by_age * used) - 1.0).abs() < 1e-7, "{one:?} {by_age}");
    let at_once = Looks::new(0.5, None).expect("valid");
    assert_eq!(hidden_cost(&life, &costs, &at_once, 3.0, None), Err(PlanError::ShowsAtOnce));
    let often = hidden_cost(&life, &costs, &looks, 1e-3, None);
    assert!(matches!(often, Err(PlanError::TooOften { .. })), "{often:?}");
}
