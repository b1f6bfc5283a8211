//! How the penetration of a contact runs over a step: the cubic through values and rates at both ends. In: both ends. Out: where it
//! may get to the other side of zero between them. Never knows forces.

use crate::scalar::Scalar;

/// Penetration over a step; time in steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course<T> {
    /// At the begin and at the end [m].
    pub(crate) from: T,
    pub(crate) to: T,
    /// Rates there, per step [m].
    pub(crate) from_rate: T,
    pub(crate) to_rate: T,
}

impl<T: Scalar> Course<T> {
    /// By penetration [m] and its rate [m/s] at both ends of a step of this length [s].
    pub(crate) fn new(before: (T, T), after: (T, T), length: T) -> Self {
        Self { from: before.0, to: after.0, from_rate: before.1 * length, to_rate: after.1 * length }
    }

    /// Whether the curve cannot get to the other side of zero than its ends are on, which are on one side: their rates bend it by
    /// 4/27 of themselves at most.
    pub(crate) fn keeps_its_side(&self) -> T::Mask {
        let (from, to) = (self.from.abs(), self.to.abs());
        let least = T::select(from.lt(to), from, to);
        (T::constant(4.0 / 27.0) * (self.from_rate.abs() + self.to_rate.abs())).lt(least)
    }

    /// 1 where something may begin or end in the step, 0 where it certainly does not; `touching`: 1 if a contact runs at its begin.
    /// What it is, is for who looks at the step alone.
    pub(crate) fn may_change(&self, touching: T) -> T {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let touches = T::select(zero.lt(self.to), one, zero);
        let differs = (touches - T::select(T::constant(0.5).lt(touching), one, zero)).abs();
        // Towards the other side at the begin, back at the end.
        let away = touches + touches - one;
        let leaves = (away * self.from_rate).lt(zero);
        let returns = T::select((away * self.to_rate).lt(zero), zero, one);
        let may_cross = T::select(self.keeps_its_side(), zero, one);
        differs.max(T::select(leaves, returns * may_cross, zero))
    }
}

impl Course<f64> {
    /// The penetration at a part of the step [m].
    pub(crate) fn at(&self, part: f64) -> f64 {
        let rise = self.to - self.from;
        let a = self.from_rate + self.to_rate - 2.0 * rise;
        let b = 3.0 * rise - 2.0 * self.from_rate - self.to_rate;
        ((a * part + b) * part + self.from_rate) * part + self.from
    }

    /// Where the rate vanishes, if it has opposite signs at the ends.
    pub(crate) fn turning_point(&self) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        let rise = self.to - self.from;
        let a = self.from_rate + self.to_rate - 2.0 * rise;
        let b = 3.0 * rise - 2.0 * self.from_rate - self.to_rate;
        let rate = |part: f64| (3.0 * a * part + 2.0 * b) * part + self.from_rate;
        // Where it is exactly does not matter.
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if (rate(middle) > 0.0) == (self.from_rate > 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_turns_once_and_certainly_stays_on_its_side_does(
            from in -1.0..1.0_f64,
            to in -1.0..1.0_f64,
            rates in (-9.0..9.0_f64, 0.0..9.0_f64),
        ) {
            // Rates of one sign at both ends are those of a curve that goes on, or turns twice: a step is shorter than that.
            let course = Course { from, to, from_rate: rates.0, to_rate: -rates.1.copysign(rates.0) };
            let touching = f64::from(u8::from(from > 0.0));
            if course.may_change(touching) == 0.0 {
                for part in 0..=1000 {
                    let there = course.at(f64::from(part) / 1000.0);
                    // Rounding of a curve that just touches zero.
                    prop_assert!(there * from >= -1e-12, "{course:?} at {part}: {there}");
                }
            }
        }
    }
}
