//! What bounds of wear, and the way units came into the sample, add to a log-likelihood. In: increments of a unit, parameters. Out: a
//! value. Never knows how it is maximised.
//!
//! A bound adds the probability that wear keeps it. A unit that is in the sample because its wear at t0 was below D divides by the
//! probability of that: the law of what was seen is the one given that. Where units differ both are taken over the law of the unit's
//! own parameter: of a unit that is followed from its entry on only, readings tell of that parameter, and it was selected by it.

use super::model::{Model, Seen, units};
use crate::data::{Increment, Known};
use crate::process::RandomEffect;
use crate::quadrature::Hump;

/// How far from the middle of its law a unit's own parameter is looked for, in standard deviations.
const FARTHEST: f64 = 60.0;
/// First steps there.
const STEP: f64 = 0.5;

/// What all units add.
pub fn of_bounds(model: &Model, phi: &[f64], increments: &[Increment]) -> f64 {
    let bounded = units(increments).filter(|unit| !unit.iter().all(Increment::is_plain));
    bounded.map(|unit| of_unit(model, phi, unit)).sum()
}

fn of_unit(model: &Model, phi: &[f64], unit: &[Increment]) -> f64 {
    let bridges: f64 = unit.iter().map(|one| bridge(model, phi, one)).sum();
    match model.process.random_effect().filter(|_| model.units_differ) {
        Some(effect) => bridges + of_differing(model, effect, phi, unit),
        None => bridges + unit.iter().map(|one| plain(model, phi, one)).sum::<f64>(),
    }
}

/// Of an increment on whose way wear was bounded.
fn bridge(model: &Model, phi: &[f64], one: &Increment) -> f64 {
    let Known::Through { at, below } = one.known else { return 0.0 };
    let exposure = |from: f64, to: f64| model.lambda(phi, &Increment { from, to, ..one.clone() });
    let logs = model.sized(phi, model.ln_size(phi, one));
    let exposures = [exposure(one.from, at), exposure(at, one.to)];
    model.process.ln_bridge(logs, exposures, one.wear, below).unwrap_or(f64::NAN)
}

/// Of a bound or an entry where units are alike.
fn plain(model: &Model, phi: &[f64], one: &Increment) -> f64 {
    let logs = model.logs(phi, one);
    match one.known {
        Known::AtLeast => libm::log(model.process.failure(logs, 1.0, one.wear)),
        Known::Below => libm::log(model.process.cumulative(logs, 1.0, one.wear)),
        Known::Entered { from_new: true } => -libm::log(model.process.cumulative(logs, 1.0, one.wear)),
        _ => 0.0,
    }
}

/// Of all bounds and the entry of a unit with a parameter of its own.
fn of_differing(model: &Model, effect: &dyn RandomEffect, phi: &[f64], unit: &[Increment]) -> f64 {
    let seen = model.seen(phi, unit);
    let (new, cv) = (model.sized(phi, seen.ln_size), libm::exp(phi[phi.len() - 1]));
    let exposure = |one: &Increment| model.lambda(phi, one);
    let wear = |one: &Increment| seen.wear_of(one.wear, model.ln_size(phi, one));
    let is_entry = |one: &&Increment| !one.is_growth();
    let entry = |one: &Increment| libm::log(effect.tails(new, cv, exposure(one), wear(one)).0);
    let entries: f64 = unit.iter().filter(is_entry).map(entry).sum();
    // Those that its exact readings leave open.
    let open: Vec<&Increment> = unit
        .iter()
        .filter(|one| matches!(one.known, Known::AtLeast | Known::Below | Known::Entered { from_new: false }))
        .collect();
    let Some((logs, cv)) = after(effect, (new, cv), &seen) else { return f64::NAN };
    let together = match open[..] {
        [] => 0.0,
        [one] => {
            let (lambda, wear) = (exposure(one), wear(one));
            libm::log(match one.known {
                Known::AtLeast => effect.survival(logs, cv, lambda, wear).1,
                _ => effect.tails(logs, cv, lambda, wear).0,
            })
        }
        _ => {
            let kept = |own: [f64; 2]| -> f64 {
                let one = |one: &&Increment| {
                    let (lambda, wear) = (exposure(one), wear(one));
                    libm::log(match one.known {
                        Known::AtLeast => model.process.failure(own, lambda, wear),
                        _ => model.process.cumulative(own, lambda, wear),
                    })
                };
                open.iter().map(one).sum()
            };
            over_units(effect, (logs, cv), &kept)
        }
    };
    together - entries
}

/// The law of a unit's own parameter after what is known exactly of it.
fn after(effect: &dyn RandomEffect, law: ([f64; 2], f64), seen: &Seen) -> Option<([f64; 2], f64)> {
    match seen.exposure > 0.0 {
        true => effect.after(law.0, law.1, seen.exposure, seen.wear),
        false => Some(law),
    }
}

/// ln of the mean, over the law of a unit's own parameter, of a chance that is known by its logarithm.
fn over_units(
    effect: &dyn RandomEffect,
    (logs, cv): ([f64; 2], f64),
    ln_chance: &dyn Fn([f64; 2]) -> f64,
) -> f64 {
    let density = |place: f64| {
        let (own, ln) = effect.place(logs, cv, place)?;
        Some(if ln > f64::NEG_INFINITY { ln + ln_chance(own) } else { ln })
    };
    let value = |place: f64| density(place).unwrap_or(f64::NAN);
    let Some(hump) = Hump::find(&value, 0.0, STEP, FARTHEST) else { return f64::NAN };
    let terms = hump.points(&value).into_iter().map(|(place, weight)| value(place) + weight - hump.top);
    hump.top + libm::log(terms.map(libm::exp).sum::<f64>())
}
