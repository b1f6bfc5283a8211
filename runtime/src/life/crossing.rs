//! Where a number that grows with time reaches zero. In: the number at any time between two. Out: the first time at which it is there,
//! to neighbouring numbers. Never knows wear.
//!
//! A chord tells nearly where: the way there errs with the square of the interval. So it is asked a little beyond, on the side of
//! the longer rest, and what is left is the short one; where that fails twice, the interval is halved.

/// How far beyond the chord is asked, as a part of the square of what is left over the whole.
const BEYOND: f64 = 0.05;

/// The first time after `early` and no later than `late` at which `excess` is not below zero, to neighbouring numbers. It is below zero at
/// `early`, not below zero at `late`, and grows between.
pub(super) fn first_reached(early: f64, late: f64, excess: impl Fn(f64) -> f64) -> f64 {
    let whole = late - early;
    let (mut early, mut late) = ((early, excess(early)), (late, excess(late)));
    let mut failed = 0;
    loop {
        let (width, middle) = (late.0 - early.0, 0.5 * (early.0 + late.0));
        if middle <= early.0 || middle >= late.0 {
            return late.0;
        }
        let chord = early.0 + width * (early.1 / (early.1 - late.1));
        let beyond = (BEYOND * width * (width / whole)).copysign(middle - chord);
        // Between neighbours there is nothing to ask.
        let at = (chord + beyond).clamp(early.0.next_up(), late.0.next_down());
        let at = if failed < 2 && at.is_finite() { at } else { middle };
        let found = excess(at);
        if found >= 0.0 {
            late = (at, found)
        } else {
            early = (at, found)
        }
        failed = if late.0 - early.0 <= 0.5 * width { 0 } else { failed + 1 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    fn asked(early: f64, late: f64, excess: impl Fn(f64) -> f64) -> (f64, u32) {
        let count = Cell::new(0);
        let found = first_reached(early, late, |time| {
            count.set(count.get() + 1);
            excess(time)
        });
        (found, count.get())
    }

    #[test]
    fn smooth_growth_is_met_between_neighbouring_numbers_by_few_questions() {
        for root in [1e-9, 0.1, 0.5, 0.77, 1.0 - 1e-9] {
            for bend in [0.0, 0.01, 0.5] {
                // Grows from below zero to above, by a straight line and a bend.
                let excess = |time: f64| {
                    let part = time - 24.0;
                    (part - root) * (1.0 + bend * part)
                };
                let (found, count) = asked(24.0, 25.0, excess);
                assert!(excess(found) >= 0.0 && excess(found.next_down()) < 0.0, "{root} {bend}: {found}");
                // Halving takes 50.
                assert!(count <= 14, "{root} {bend}: {count}");
            }
        }
    }

    #[test]
    fn jumps_and_numbers_that_are_none_end_too() {
        let (found, count) = asked(3.0, 4.0, |time| if time < 3.3 { -1e-300 } else { 1e300 });
        // Every third question halves what is left.
        assert!(found == 3.3 && count < 160, "{found} {count}");
        assert_eq!(asked(3.0, 4.0, |time| if time < 3.3 { -1.0 } else { f64::INFINITY }).0, 3.3);
        assert_eq!(asked(3.0, 4.0, |time| if time < 4.0 { -1.0 } else { 0.0 }).0, 4.0);
    }
}
