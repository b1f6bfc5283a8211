//! Integrals over time of what begins and ends at zero as a power of time does, as pressures of contacts do where bodies touch and come
//! apart. In: values at equal times. Out: their integral, with the derivatives of the exact one. Never knows what is integrated.
//!
//! A rule for smooth values would miss by up to an interval where a derivative begins: it jumps there, or has no bound. Near a zero a
//! power of the values is taken as linear in time, and goes on beyond the last value to where it is zero; elsewhere Simpson's rule is
//! taken.

use super::tangents::Varied;

/// The least of three values over the largest, above which Simpson's rule holds them.
pub(super) const SMOOTH: f64 = 0.7;
/// Powers that are looked for: of a value that goes as its inverse power of time.
const POWERS: (f64, f64) = (0.5, 4.0);
/// Halvings of that range.
const HALVINGS: usize = 40;

/// Integral of values at times that are `apart`; of an even number of intervals.
pub(super) fn integral<const N: usize>(values: &[Varied<N>], apart: &Varied<N>) -> Varied<N> {
    let mut sum = Varied::ZERO;
    for first in (0..values.len().saturating_sub(2)).step_by(2) {
        let part = &values[first..first + 3];
        let (least, most) = part
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(least, most), one| (least.min(one.value), most.max(one.value)));
        if least > SMOOTH * most {
            for (one, weight) in part.iter().zip([1.0 / 3.0, 4.0 / 3.0, 1.0 / 3.0]) {
                sum = sum.plus(weight, one);
            }
        } else if most > 0.0 {
            for place in [first, first + 1] {
                sum = sum.plus(1.0, &interval(values, place));
            }
        }
    }
    sum.over(apart)
}

/// Integral from a value to the next, in units of the time between.
fn interval<const N: usize>(values: &[Varied<N>], at: usize) -> Varied<N> {
    // Values from a place on, away from the zero that is near.
    let (upwards, downwards) = (
        |from: usize| [0, 1, 2].map(|more| values.get(from + more)),
        |from: usize| [0, 1, 2].map(|more| from.checked_sub(more).and_then(|place| values.get(place))),
    );
    let [from, to] = [values[at].value, values[at + 1].value];
    match (from > 0.0, to > 0.0) {
        (false, false) => Varied::ZERO,
        (false, true) => beyond(upwards(at + 1)),
        (true, false) => beyond(downwards(at)),
        (true, true) if from <= to => between(upwards(at)),
        (true, true) => between(downwards(at + 1)),
    }
}

/// The power m by which three rising values are linear in time; one, if there is none.
fn power<const N: usize>([x, y, z]: [Option<&Varied<N>>; 3]) -> f64 {
    let (Some(x), Some(y), Some(z)) = (x, y, z) else { return 1.0 };
    let [x, y, z] = [x, y, z].map(|one| one.value / z.value);
    if !(0.0 < x && x < y && y < z) {
        return 1.0;
    }
    let bends = |m: f64| z.powf(m) - 2.0 * y.powf(m) + x.powf(m);
    let (mut low, mut high) = POWERS;
    if bends(low) > 0.0 || bends(high) < 0.0 {
        return 1.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if bends(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// m/(m+1) (b^(m+1) - a^(m+1)) / (b^m - a^m): from the first to the second of rising values.
fn between<const N: usize>(rising: [Option<&Varied<N>>; 3]) -> Varied<N> {
    let (m, [Some(first), Some(second), _]) = (power(rising), rising) else { return Varied::ZERO };
    let (a, b) = (first.value, second.value);
    let fall = b.powf(m) - a.powf(m);
    // What hardly differs has no power.
    if fall <= 1e-6 * b.powf(m) {
        return first.plus(1.0, second).times(0.5);
    }
    let (part, over) = (m / (m + 1.0), b.powf(m + 1.0) - a.powf(m + 1.0));
    let slope = |x: f64| ((m + 1.0) * x.powf(m) * fall - over * m * x.powf(m - 1.0)) / (fall * fall);
    let (by_a, by_b) = (-part * slope(a), part * slope(b));
    let tangents = std::array::from_fn(|lane| by_a * first.tangents[lane] + by_b * second.tangents[lane]);
    Varied { value: part * over / fall, tangents }
}

/// m/(m+1) b^(m+1) / (c^m - b^m): from the zero before it to the first of rising values.
fn beyond<const N: usize>(rising: [Option<&Varied<N>>; 3]) -> Varied<N> {
    let (m, [Some(first), second, _]) = (power(rising), rising) else { return Varied::ZERO };
    let b = first.value;
    let rise = second.map_or(0.0, |second| second.value.powf(m) - b.powf(m));
    // At most an interval before it, or there would be another value above zero.
    let Some(second) = second.filter(|_| rise >= b.powf(m)) else { return first.times(m / (m + 1.0)) };
    let (part, c) = (m / (m + 1.0), second.value);
    let by_b = part * ((m + 1.0) * b.powf(m) * rise + m * b.powf(2.0 * m)) / (rise * rise);
    let by_c = -part * m * b.powf(m + 1.0) * c.powf(m - 1.0) / (rise * rise);
    let tangents = std::array::from_fn(|lane| by_b * first.tangents[lane] + by_c * second.tangents[lane]);
    Varied { value: part * b.powf(m + 1.0) / rise, tangents }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of (k (t - t0))^q at equal times up to 1, with tangents by t0: zero before t0.
    fn values(q: f64, t0: f64, intervals: usize) -> Vec<Varied<1>> {
        let at = |place: usize| {
            let t = place as f64 / intervals as f64 - t0;
            let value = if t > 0.0 { t.powf(q) } else { 0.0 };
            Varied { value, tangents: [if t > 0.0 { -q * t.powf(q - 1.0) } else { 0.0 }] }
        };
        (0..=intervals).map(at).collect()
    }

    /// The integral is (1 - t0)^(q+1) / (q+1), its derivative by t0 -(1 - t0)^q: wherever the zero is between two times.
    #[test]
    fn powers_of_time_and_their_derivatives_are_exact_near_their_zero() {
        for q in [0.5, 0.75, 1.0, 1.5] {
            for part in [0.01, 0.3, 0.5, 0.77, 0.99] {
                let intervals = 400;
                let t0 = (101.0 + part) / intervals as f64;
                let apart = Varied { value: 1.0 / intervals as f64, tangents: [0.0] };
                let found = integral(&values(q, t0, intervals), &apart);
                let expected = (1.0 - t0).powf(q + 1.0) / (q + 1.0);
                // What Simpson's rule leaves from the third value on: a few 1e-3 of an interval's part of the derivative.
                assert!(
                    (found.value / expected - 1.0).abs() < 1e-6,
                    "{q} {part}: {}",
                    found.value / expected
                );
                let slope = -(1.0 - t0).powf(q);
                assert!(
                    (found.tangents[0] / slope - 1.0).abs() < 2e-4,
                    "{q} {part}: {}",
                    found.tangents[0] / slope
                );
            }
        }
    }

    #[test]
    fn smooth_values_are_integrated_as_ever() {
        let apart = Varied { value: 0.01, tangents: [0.5] };
        let at = |place: usize| {
            let t = 0.01 * place as f64;
            Varied { value: 2.0 + t.sin(), tangents: [t.cos()] }
        };
        let values: Vec<Varied<1>> = (0..=100).map(at).collect();
        let found = integral(&values, &apart);
        let exact = 3.0 - 1.0_f64.cos();
        // Simpson's rule: 1e-8 / 180 of the fourth derivative.
        assert!((found.value - exact).abs() < 1e-9);
        assert!((found.tangents[0] - (1.0_f64.sin() + 0.5 * exact / 0.01)).abs() < 1e-7);
    }
}
