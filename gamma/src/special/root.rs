//! The root of a rising function. In and out: numbers. Never knows the function.

/// A step of Newton's method within a bracket that may still be open: where it leaves the bracket, its middle, or one unit
/// from `x` towards the open end.
pub(crate) fn guarded(next: f64, x: f64, (low, high): (f64, f64)) -> f64 {
    if next > low && next < high {
        return next;
    }
    match (low.is_finite(), high.is_finite()) {
        (true, true) => 0.5 * (low + high),
        (true, false) => x + 1.0,
        _ => x - 1.0,
    }
}

/// Roots are looked for between these.
const NEAREST: f64 = 1e-300;
const FARTHEST: f64 = f64::MAX / 4.0;
/// Doublings or halvings, some nine digits, after which each step is the square of the one before: ten more reach the largest number.
const DOUBLED: u32 = 30;

/// Positive root of a rising function, looked for from `start` on by doubling and halving, then by [`bracketed`]; infinite where it
/// is below zero up to the largest numbers. Relative accuracy 1e-13.
pub(crate) fn rising_root(f: &dyn Fn(f64) -> f64, start: f64) -> f64 {
    rising_root_within(f, start, 1e-13)
}

/// The same to another relative accuracy.
pub(crate) fn rising_root_within(f: &dyn Fn(f64) -> f64, start: f64, accuracy: f64) -> f64 {
    let start = start.clamp(NEAREST, FARTHEST);
    let (mut low, mut high) = ((0.5 * start, None), (start, f(start)));
    let (mut factor, mut doubled) = (2.0, 0);
    while high.1 < 0.0 {
        if high.0 >= FARTHEST {
            return f64::INFINITY;
        }
        let next = (factor * high.0).min(FARTHEST);
        (low, high) = ((high.0, Some(high.1)), (next, f(next)));
        doubled += 1;
        if doubled >= DOUBLED {
            factor *= factor;
        }
    }
    let mut known = (low.0, low.1.unwrap_or_else(|| f(low.0)));
    let (mut factor, mut halved) = (0.5, 0);
    while known.1 > 0.0 && known.0 > NEAREST {
        let next = (factor * known.0).max(NEAREST);
        (high, known) = (known, (next, f(next)));
        halved += 1;
        if halved >= DOUBLED {
            factor *= factor;
        }
    }
    while high.0 > 2.0 * known.0 && known.1 <= 0.0 {
        let middle = libm::sqrt(known.0) * libm::sqrt(high.0);
        let middle = (middle, f(middle));
        if middle.1 < 0.0 { known = middle } else { high = middle }
    }
    bracketed(f, known, high, accuracy)
}

/// Root between two places with values of different signs, by the method of T. R. Chandrupatla (1997): inverse quadratic
/// interpolation where it is trusted, else halving.
fn bracketed(f: &dyn Fn(f64) -> f64, low: (f64, f64), high: (f64, f64), accuracy: f64) -> f64 {
    // The newest place, the one on the other side of the root, and the one before.
    let (mut a, mut b, mut c);
    (a, b) = (high, low);
    let mut part = 0.5;
    for _ in 0..200 {
        let nearest = if a.1.abs() < b.1.abs() { a } else { b };
        let least = 0.5 * accuracy * nearest.0 / (b.0 - a.0).abs();
        if nearest.1 == 0.0 || least.is_nan() || least > 0.5 {
            return nearest.0;
        }
        let at = a.0 + f64::clamp(part, least, 1.0 - least) * (b.0 - a.0);
        let new = (at, f(at));
        if (new.1 > 0.0) == (a.1 > 0.0) {
            c = a;
        } else {
            (c, b) = (b, a);
        }
        a = new;
        let (xi, phi) = ((a.0 - b.0) / (c.0 - b.0), (a.1 - b.1) / (c.1 - b.1));
        part = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            a.1 / (b.1 - a.1) * c.1 / (b.1 - c.1)
                + (c.0 - a.0) / (b.0 - a.0) * a.1 / (c.1 - a.1) * b.1 / (c.1 - b.1)
        } else {
            0.5
        };
    }
    if a.1.abs() < b.1.abs() { a.0 } else { b.0 }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn roots_are_found_wherever_the_search_begins_in_few_values() {
        let functions: [(&dyn Fn(f64) -> f64, f64); 4] = [
            (&|x| x * x * x - 8.0, 2.0),
            (&|x| libm::log(x) - 1.0, std::f64::consts::E),
            // Flat on both sides, and without an end on one.
            (&|x| libm::erf(50.0 * (x - 0.3)), 0.3),
            (&|x| if x > 7.0 { f64::INFINITY } else { x - 5.0 }, 5.0),
        ];
        for (function, root) in functions {
            for start in [1e-3, 0.2, 1.0, 3.0, 4e4] {
                let values = Cell::new(0);
                let counted = |x: f64| {
                    values.set(values.get() + 1);
                    function(x)
                };
                let found = rising_root(&counted, start);
                assert!((found / root - 1.0).abs() < 2e-13, "{found} {root} from {start}");
                let search = libm::log2(start / root).abs() as u32 + 2;
                assert!(values.get() <= search + 15, "{} values for {root} from {start}", values.get());
            }
        }
        assert_eq!(rising_root(&|x| x - 4.0, 4.0), 4.0);
        // From anywhere, to anywhere, or nowhere.
        for start in [0.0, 1.0, f64::INFINITY] {
            for root in [1e-200, 1.0, 1e250] {
                let found = rising_root(&|x| libm::log(x / root), start);
                assert!((found / root - 1.0).abs() < 1e-12, "{found} {root} from {start}");
            }
            let values = Cell::new(0);
            let counted = |_: f64| {
                values.set(values.get() + 1);
                -0.1
            };
            assert_eq!(rising_root(&counted, start), f64::INFINITY);
            assert!(values.get() < 100, "{} values", values.get());
        }
        let near = rising_root_within(&|x| x * x - 2.0, 1.0, 1e-3);
        assert!((near - std::f64::consts::SQRT_2).abs() < 1e-3 * near, "{near}");
    }
}
