//! The rate of wear as a function of wear, through two or three measurements, and where it leads.
//! In: wear and rates. Out: wear later on. Never knows where measurements come from.

/// Parts in which the way along a curve is followed: with a fifth of the clearance worn in a step, the fourth order leaves 1e-9.
const PIECES: u32 = 4;

/// Wear and rate of a joint at a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Measured {
    /// Wear W [m].
    pub wear: f64,
    /// What a cycle adds to it [m].
    pub rate: f64,
}

/// A polynomial in Newton's form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    begin: Measured,
    later: f64,
    slope: f64,
    bend: f64,
}

impl Curve {
    /// The straight line through two measurements; level where both have the same wear.
    pub(super) fn line(begin: Measured, later: Measured) -> Self {
        Self { begin, later: later.wear, slope: slope(begin, later), bend: 0.0 }
    }

    /// Bent so that it goes through a third one.
    pub(super) fn through(self, third: Measured) -> Self {
        let onward = slope(self.begin, third);
        let distance = third.wear - self.later;
        Self { bend: if distance == 0.0 { 0.0 } else { (onward - self.slope) / distance }, ..self }
    }

    /// Rate at a wear.
    pub(super) fn rate(&self, wear: f64) -> f64 {
        self.begin.rate + (wear - self.begin.wear) * (self.slope + (wear - self.later) * self.bend)
    }

    /// Wear after so many cycles from its begin.
    pub(super) fn after(&self, cycles: f64) -> f64 {
        let step = cycles / f64::from(PIECES);
        (0..PIECES).fold(self.begin.wear, |wear, _| {
            let a = self.rate(wear);
            let b = self.rate(wear + 0.5 * step * a);
            let c = self.rate(wear + 0.5 * step * b);
            let d = self.rate(wear + step * c);
            wear + step / 6.0 * (a + 2.0 * (b + c) + d)
        })
    }
}

fn slope(from: Measured, to: Measured) -> f64 {
    let distance = to.wear - from.wear;
    if distance == 0.0 { 0.0 } else { (to.rate - from.rate) / distance }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_that_go_with_the_root_of_the_clearance_are_followed() {
        // c' = 1.6 sqrt(c / 10), so c = (sqrt(c0) + 0.8 t / sqrt(10))².
        let at = |clearance: f64| Measured { wear: clearance - 10.0, rate: 1.6 * (clearance / 10.0).sqrt() };
        let exact = (20.0_f64.sqrt() + 0.8 / 10.0_f64.sqrt()).powi(2) - 20.0;
        let begin = at(20.0);
        let line = Curve::line(begin, at(20.0 + 0.75 * begin.rate));
        let [line, curve] = [line, line.through(at(18.0))].map(|curve| curve.after(1.0) - begin.wear);
        // The line leaves (k/c)²/192 of a step, by its second derivative; the curve what is left of the third.
        assert!((line / exact - 1.0).abs() < 1e-4 && (line / exact - 1.0).abs() > 2e-5, "{line} {exact}");
        assert!((curve / exact - 1.0).abs() < 5e-6, "{curve} {exact}");
    }

    #[test]
    fn what_does_not_wear_stays() {
        let still = Measured { wear: 3.0, rate: 0.0 };
        assert_eq!(Curve::line(still, still).through(still).after(5.0), 3.0);
    }
}
