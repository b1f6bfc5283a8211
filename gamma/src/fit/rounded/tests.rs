//! Likelihoods of rounded readings against sums over fine grids.

use rustc_hash::FxHashMap;

use super::kernel::{By, Kernel, Known};
use super::window::{Place, Window};
use super::*;
use crate::process::{Gamma, Process};
use crate::special::normal_cdf;

fn laws(logs: &dyn Fn(&Increment) -> [f64; 2]) -> Laws<'_> {
    Laws { process: &Gamma, logs }
}

fn chain(wears: &[f64], from: f64) -> Vec<Increment> {
    let one = |(at, wear): (usize, &f64)| Increment {
        unit: 0,
        from: from + at as f64,
        to: from + at as f64 + 1.0,
        wear: *wear,
        ln_covariates: vec![],
        row: 0,
        ..Increment::default()
    };
    wears.iter().enumerate().map(one).collect()
}

/// Probability of two readings by sums over a fine grid of true wear, from distribution functions alone.
fn by_grid(logs: [f64; 2], wears: [f64; 2], step: f64, is_exact: bool) -> f64 {
    let parts = 400;
    let part = step / f64::from(parts);
    let below = |wear: f64| if wear > 0.0 { Gamma.cumulative(logs, 1.0, wear) } else { 0.0 };
    let place = |k: i32| (f64::from(k) + 0.5) * part - 0.5 * step;
    let starts: Vec<f64> = if is_exact { vec![0.0] } else { (0..parts).map(place).collect() };
    let mut sum = 0.0;
    for j in 0..parts {
        let middle = wears[0] + place(j);
        let into: f64 = starts
            .iter()
            .map(|start| below(middle + 0.5 * part - start) - below(middle - 0.5 * part - start))
            .sum();
        let last = wears[0] + wears[1];
        let out = below(last + 0.5 * step - middle) - below(last - 0.5 * step - middle);
        sum += into / starts.len() as f64 * out;
    }
    sum
}

#[test]
fn two_readings_that_share_a_rounding_have_the_probability_of_a_fine_grid() {
    for (alpha, beta) in [(2.0_f64, 1.5_f64), (0.3_f64, 0.4_f64), (20.0, 9.0)] {
        let logs = [alpha.ln(), beta.ln()];
        for wears in [[1.0, 2.0], [0.0, 1.0], [3.0, 0.0], [2.0, 3.0]] {
            for from in [0.0, 1.0] {
                let found = ln_likelihood(laws(&|_| logs), &chain(&wears, from), Rounding::to(1.0)).exp();
                let expected = by_grid(logs, wears, 1.0, from == 0.0);
                if expected < 1e-4 {
                    // Far tails: what spreading adds to a variance counts there, and no reading is there.
                    continue;
                }
                // Parts of a sixteenth: largest where the density is singular.
                assert!(
                    (found / expected - 1.0).abs() < 0.02,
                    "{alpha} {wears:?} {from}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn a_fine_gauge_gives_the_likelihood_of_exact_readings() {
    let data = chain(&[1.25, 0.5, 2.0, 0.75], 0.0);
    let logs = [0.4, 0.2];
    let exact: f64 = data.iter().map(|one| Gamma.density(logs, one.wear).value).sum();
    for step in [1e-2, 1e-4, 1e-6] {
        let rounded = ln_likelihood(laws(&|_| logs), &data, Rounding::to(step));
        // Second order in the step; differences of probabilities of 1e-7 at the finest, for the exact start.
        assert!((rounded - exact).abs() < 2.0 * step * step + 1e-8, "{step}: {rounded} {exact}");
    }
}

/// Chances of two readings after a place, by tilts or by parts.
fn two_chances(place: &Place, kernels: [&Kernel<'_>; 2], window: &Window, by_tilts: [bool; 2]) -> f64 {
    let masses = |place: &Place| match place {
        Place::Exact => None,
        Place::Tilted(tilt) => Some(window.tilted(*tilt)),
        Place::Parts(masses) => Some(masses.clone()),
    };
    let mut product = 1.0;
    let mut at = masses(place).map_or(Place::Exact, Place::Parts);
    if by_tilts[0] {
        at = match place {
            Place::Tilted(tilt) => Place::Tilted(*tilt),
            _ => at,
        };
    }
    for (kernel, by_tilts) in kernels.into_iter().zip(by_tilts) {
        let (chance, next) = if by_tilts {
            let (chance, next) = kernel.even_within(0.1).expect("an even density").follow(&at, window);
            (chance * window.chances.iter().map(|[here, _]| here).sum::<f64>() * kernel.part, next)
        } else {
            let parts = kernel.parts;
            let next = match masses(&at) {
                None => kernel.after_exact(&mut Known::default(), By::Integrals),
                Some(masses) => {
                    let chances = kernel.chances(&mut Known::default(), By::Integrals);
                    let into =
                        |j: usize| (0..parts).map(|i| masses[i] * chances[parts - 1 + j - i]).sum::<f64>();
                    (0..parts).map(into).collect()
                }
            };
            let weighed: Vec<f64> =
                next.iter().zip(&window.chances).map(|(mass, [here, _])| mass * here).collect();
            let chance: f64 = weighed.iter().sum();
            (chance, Place::Parts(weighed.into_iter().map(|mass| mass / chance).collect()))
        };
        product *= chance;
        at = next;
    }
    product
}

#[test]
fn chances_by_densities_are_those_by_integrals() {
    for rounding in [Rounding::to(1.0), Rounding { step: 1.0, error: 0.4 }] {
        let window = Window::new(rounding);
        for (alpha, beta) in [(0.3_f64, 0.5_f64), (2.0, 1.5), (8.0, 3.0), (20.0, 20.0)] {
            for steps in [0.0, 1.0, 2.0, 5.0] {
                let kernel = Kernel::of(&Gamma, [alpha.ln(), beta.ln()], (steps, rounding), &window);
                let mut logarithms = FxHashMap::default();
                let mut both = |of: &mut dyn FnMut(By<'_>) -> Vec<f64>| {
                    [of(By::Integrals), of(By::Densities(&mut logarithms))]
                };
                let chances = both(&mut |by| kernel.chances(&mut Known::default(), by));
                let masses = both(&mut |by| kernel.after_exact(&mut Known::default(), by));
                for [integrals, densities] in [chances, masses] {
                    assert_eq!(integrals.len(), densities.len());
                    let most = integrals.iter().copied().fold(0.0, f64::max);
                    for (a, b) in integrals.iter().zip(densities) {
                        // What five nodes leave, and second differences of integrals that are some ten thousand parts' chances.
                        assert!(
                            (a - b).abs() < 2e-9 * a + 1e-11 * most,
                            "{alpha} {steps} {rounding:?}: {a} {b}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn tilted_windows_give_the_chances_of_their_parts() {
    for error in [0.0, 5e-3] {
        let rounding = Rounding { step: 2e-2, error };
        let window = Window::new(rounding);
        // Steep and bent, and falling: nearly as much as counts as even.
        let kernel =
            |alpha: f64, steps: f64| Kernel::of(&Gamma, [alpha.ln(), 0.3], (steps, rounding), &window);
        let kernels = [kernel(1.5, 80.0), kernel(1.2, 45.0)];
        let [first, second] = kernels.each_ref();
        for place in [Place::Exact, Place::Tilted(-0.9), Place::Parts(window.tilted(0.4))] {
            let exact = two_chances(&place, [first, second], &window, [false; 2]);
            for by_tilts in [[true, true], [true, false], [false, true]] {
                let found = two_chances(&place, [first, second], &window, by_tilts);
                // The density changes thirty times as much as where windows count as even, so a squared change is 1e-3:
                // fourth powers are left out.
                let off = (found / exact - 1.0).abs();
                assert!(off < 2e-6, "{error} {by_tilts:?}: {found} {exact}");
                // Without tilts and bends it would be this.
                let flat = (kernels[0].ln_density(0) + kernels[1].ln_density(0)).exp();
                let width = window.part * window.chances.iter().map(|[here, _]| here).sum::<f64>();
                assert!((flat * width * width / exact - 1.0).abs() > 10.0 * off, "{error} {by_tilts:?}");
            }
        }
    }
}

#[test]
fn a_few_equal_readings_are_followed_however_many_and_different_ones_are_limited() {
    let logs = |one: &Increment| [(2.0 * (one.to - one.from)).ln(), 0.7];
    let many = |spans: usize| -> Vec<Increment> {
        let one = |at: usize| Increment {
            unit: 0,
            from: 10.0 * at as f64,
            to: 10.0 * at as f64 + 1.0 + (at % spans) as f64 * 1e-6,
            wear: 0.5 * (at % 9) as f64,
            ln_covariates: vec![],
            row: 0,
            ..Increment::default()
        };
        (0..60_000).map(one).collect()
    };
    for (spans, error, is_followed) in [(7, 0.0, true), (60_000, 0.0, false), (7, 0.4, false)] {
        let found = windows(laws(&logs), &many(spans), Rounding { step: 0.5, error }, 1);
        assert_eq!(found.count, 60_000);
        assert_eq!(found.count <= found.most, is_followed, "{spans} {error}: {}", found.most);
    }
    // Even over the windows of a fine gauge: as many as there are.
    assert_eq!(windows(laws(&logs), &many(60_000)[1..9], Rounding::to(1e-6), 1).count, 0);
}

#[test]
fn transforms_of_rounded_readings_are_those_of_the_exact_ones_for_a_fine_gauge() {
    let data = chain(&[1.25, 0.5], 0.0);
    let found = transforms(laws(&|_| [0.4, 0.2]), &data, Rounding::to(1e-3), &mut Stream::new(1, 0, 0));
    for (u, one) in found.iter().zip(&data) {
        // The width of a step.
        assert!((u - Gamma.cumulative([0.4, 0.2], 1.0, one.wear)).abs() < 1e-3, "{u}");
    }
}

/// Probability of two readings with an error before rounding, after an exact start, by sums over a fine grid of true wear.
fn by_grid_with_error(logs: [f64; 2], wears: [f64; 2], Rounding { step, error }: Rounding) -> f64 {
    let part = 0.01;
    let below = |wear: f64| if wear > 0.0 { Gamma.cumulative(logs, 1.0, wear) } else { 0.0 };
    let law: Vec<f64> =
        (0..1500).map(|k| below(f64::from(k + 1) * part) - below(f64::from(k) * part)).collect();
    let read = |wear: f64, reading: f64| {
        let [low, high] = [-0.5, 0.5].map(|side| normal_cdf((reading + side * step - wear) / error));
        high - low
    };
    let mut sum = 0.0;
    for (i, first) in law.iter().enumerate() {
        let first = first * read((i as f64 + 0.5) * part, wears[0]);
        for (j, second) in law.iter().enumerate().take_while(|_| first > 1e-12) {
            sum += first * second * read((i + j + 1) as f64 * part, wears[0] + wears[1]);
        }
    }
    sum
}

#[test]
fn readings_with_an_error_before_rounding_have_the_probability_of_a_fine_grid() {
    let logs = [2.0_f64.ln(), 1.5_f64.ln()];
    for rounding in [Rounding { step: 0.5, error: 0.2 }, Rounding { step: 0.25, error: 0.5 }] {
        for wears in [[1.0, 2.0], [0.5, -0.5], [2.5, 0.0]] {
            let found = ln_likelihood(laws(&|_| logs), &chain(&wears, 0.0), rounding).exp();
            let expected = by_grid_with_error(logs, wears, rounding) / (rounding.step * rounding.step);
            // Parts of a sixteenth, and a reading far from any wear that there is.
            assert!((found / expected - 1.0).abs() < 0.01, "{rounding:?} {wears:?}: {found} {expected}");
        }
    }
}

#[test]
fn an_error_far_below_the_step_changes_nothing() {
    let data = chain(&[1.0, 0.0, 3.0], 0.0);
    let value = |error| ln_likelihood(laws(&|_| [0.4, 0.2]), &data, Rounding { step: 1.0, error });
    // Parts move with the window: a sixteenth of a step.
    assert!((value(1e-3) - value(0.0)).abs() < 5e-3, "{} {}", value(1e-3), value(0.0));
}
