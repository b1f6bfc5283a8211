//! Shared by the tests of the case study's bearing R1.
#![allow(dead_code, reason = "every test file uses its own part")]

use crate::support::Recorded;

/// Compares with a number from elsewhere.
pub fn assert_near(value: f64, expected: f64, relative: f64, what: &str) {
    let error = (value / expected - 1.0).abs();
    assert!(error < relative, "{what}: {value} instead of {expected}, off by {error:e}");
}

/// Wear integral by bearing angle from evenly spaced samples: bin i covers [i, i + 1) of a turn's 72nd parts.
pub fn wear_by_angle(run: &Recorded) -> Vec<f64> {
    let (force, speed) = (run.column("R1.Fn"), run.column("R1.vt"));
    let angle = run.column("R1.contact_angle");
    let times = &run.run.times;
    let spacing = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let mut bins = vec![0.0; 72];
    // A whole turn that repeats itself: every sample but the last weighs the same.
    for index in 0..times.len() - 1 {
        let place = angle[index].rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU * 72.0;
        bins[place as usize % 72] += spacing * force[index] * speed[index].abs();
    }
    bins
}
