//! What looks at one interval cost for many thresholds at once, fast. In: wear of a part, costs, interval. Out: costs by threshold, the
//! least of them. Never knows how intervals are chosen.
//!
//! Parts below one threshold at a look are those below the next lower one, and those between both. So one pass over the levels has the
//! failures for all of them, by the rule of trapezoids: good to some percent of the failures, which moves the cheapest threshold by less
//! than a level.

use super::condition::{Cycle, MOST, Monitored, SKIPPED};
use super::costs::{Costs, Looks};
use crate::life::{Clock, Law};

/// Parts that are still in use after so many looks no longer count.
const GONE: f64 = 1e-6;
/// Places between two looks at which failures are asked for.
const PLACES: usize = 4;

/// Costs by threshold, for ascending `levels`, as means over the part's units.
fn rates(part: &Monitored, asked: (&Costs, &Looks), interval: f64, levels: &[f64]) -> Vec<f64> {
    let (clock, units) = part.few();
    let mut means = vec![Cycle::default(); levels.len()];
    for (share, law) in units {
        let of_law = cycles((law, clock, part.failure()), asked.1, interval, levels);
        means.iter_mut().zip(of_law).for_each(|(mean, own)| mean.add(*share, own));
    }
    means.into_iter().map(|mean| mean.cost(asked).rate).collect()
}

/// Part of a cost that counts as none: plans are told to four digits.
pub(super) const SAME: f64 = 1e-4;

/// The least cost, its threshold among ascending levels or, but for the ends, between them. Where the lowest threshold costs the same,
/// hardly any part is below any of them: then the highest that does.
pub(super) fn least_rate(
    part: &Monitored,
    asked: (&Costs, &Looks),
    interval: f64,
    (levels, first): (&[f64], usize),
) -> (f64, f64) {
    let rates = rates(part, asked, interval, levels);
    let best = (first..levels.len()).min_by(|a, b| rates[*a].total_cmp(&rates[*b])).unwrap_or(first);
    let same = (1.0 + SAME) * rates[best];
    if rates[first] <= same && first + 1 < levels.len() {
        let last = (best..levels.len()).take_while(|at| rates[*at] <= same).last().unwrap_or(best);
        let Some(next) = rates.get(last + 1) else { return (rates[best], levels[last]) };
        let part = (same - rates[last]) / (next - rates[last]);
        return (rates[best], levels[last] + part * (levels[last + 1] - levels[last]));
    }
    if best == first || best + 1 == levels.len() {
        return (rates[best], levels[best]);
    }
    // The parabola through three levels.
    let [low, middle, high] = [best - 1, best, best + 1].map(|at| (levels[at], rates[at]));
    let slopes = [(low, middle), (middle, high)].map(|((x, f), (y, g))| (g - f) / (y - x));
    let bend = (slopes[1] - slopes[0]) / (high.0 - low.0);
    if bend <= 0.0 || !bend.is_finite() {
        return (middle.1, middle.0);
    }
    let at = 0.5 * (low.0 + middle.0) - 0.5 * slopes[0] / bend;
    (low.1 + slopes[0] * (at - low.0) + bend * (at - low.0) * (at - middle.0), at)
}

/// Of units of one law.
fn cycles(
    (law, clock, failure): (&Law, &Clock, f64),
    looks: &Looks,
    interval: f64,
    levels: &[f64],
) -> Vec<Cycle> {
    let mut sums = vec![Cycle::default(); levels.len()];
    let mut alive = vec![1.0; levels.len()];
    // By wear at the look, from none on: the probability to fail until the next, and the time after failure.
    let mut risks: Vec<(f64, f64)> = Vec::new();
    let mut known = [f64::NAN; 2];
    for k in 0..MOST {
        let start = interval * k as f64;
        let before = clock.exposure(start);
        let gained = |part: f64| clock.gained(start, part * interval).max(0.0);
        let whole = gained(1.0);
        let is_risky = law.failure(before + whole, failure) > SKIPPED;
        let own = [whole, gained(0.5)];
        // A steady clock has the same risks from look to look.
        let is_known = own.iter().zip(known).all(|(own, known)| (own - known).abs() <= 1e-9 * known);
        if is_risky && !is_known {
            let risk = |worn: f64| {
                let left = failure - worn;
                if left <= 0.0 {
                    return (1.0, interval);
                }
                let place = |at: usize| law.failure(gained((at as f64 + 0.5) / PLACES as f64), left);
                let late = (0..PLACES).map(place).sum::<f64>() / PLACES as f64;
                (law.failure(whole, left), interval * late)
            };
            risks = std::iter::once(0.0).chain(levels.iter().copied()).map(risk).collect();
            known = own;
        }
        let (mut failed, mut late, mut last) = (0.0, 0.0, 0.0);
        for (at, (sum, alive)) in sums.iter_mut().zip(&alive).enumerate() {
            if is_risky && k == 0 {
                (failed, late) = risks[0];
            } else if is_risky {
                let [low, high] = [risks[at], risks[at + 1]];
                failed += 0.5 * (alive - last) * (low.0 + high.0);
                late += 0.5 * (alive - last) * (low.1 + high.1);
                last = *alive;
            }
            sum.add_interval(looks, interval, *alive, (failed, late));
        }
        let reached = clock.exposure(start + interval);
        alive.iter_mut().zip(levels).for_each(|(alive, level)| *alive = law.survival(reached, *level));
        if alive.last().is_none_or(|alive| *alive < GONE) {
            break;
        }
    }
    sums
}
