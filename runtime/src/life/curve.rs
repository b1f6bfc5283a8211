//! The rate of wear as a function of wear, through a few measurements, and where it leads.
//! In: wear and rates. Out: wear later on. Never knows where measurements come from.

/// Parts in which the way along a curve is followed: with a fifth of the clearance worn in a step, the fourth order leaves 1e-9.
const PIECES: u32 = 4;

/// The same for the time that a way takes: with as much worn as there was clearance, three places of Gauss in each leave 2e-8.
const PARTS: u32 = 4;
/// Places and weights of Gauss's rule of three, between -1 and 1.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Wear and rate of a joint at a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Measured {
    /// Wear W [m].
    pub wear: f64,
    /// What a cycle adds to it [m].
    pub rate: f64,
}

/// Measurements that a curve goes through, at most.
const MOST: usize = 4;

/// A polynomial in Newton's form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    /// Wear at the measurements, and divided differences of the rates.
    wear: [f64; MOST],
    differences: [f64; MOST],
    count: usize,
}

impl Curve {
    /// Level, at the rate of a measurement.
    pub(super) fn level(at: Measured) -> Self {
        let mut curve = Self { wear: [0.0; MOST], differences: [0.0; MOST], count: 1 };
        (curve.wear[0], curve.differences[0]) = (at.wear, at.rate);
        curve
    }

    /// Bent so that it goes through one more; as it was where it has one of the same wear, or as many as it may have.
    pub(super) fn through(mut self, next: Measured) -> Self {
        if self.count == MOST || self.wear[..self.count].contains(&next.wear) {
            return self;
        }
        let known = self.wear.iter().zip(&self.differences).take(self.count);
        let difference =
            known.fold(next.rate, |rate, (wear, difference)| (rate - difference) / (next.wear - wear));
        (self.wear[self.count], self.differences[self.count]) = (next.wear, difference);
        self.count += 1;
        self
    }

    /// Rate at a wear.
    pub(super) fn rate(&self, wear: f64) -> f64 {
        let known = self.wear.iter().zip(&self.differences).take(self.count).rev();
        known.fold(0.0, |rate, (at, difference)| difference + (wear - at) * rate)
    }

    /// Cycles from one wear to another; nothing where it does not wear all the way.
    pub(super) fn cycles(&self, from: f64, to: f64) -> Option<f64> {
        let half = 0.5 * (to - from) / f64::from(PARTS);
        let places = (0..PARTS).flat_map(|part| {
            let middle = from + (2.0 * f64::from(part) + 1.0) * half;
            GAUSS.map(|(place, weight)| (middle + place * half, weight * half))
        });
        places
            .map(|(wear, weight)| Some(self.rate(wear)).filter(|rate| *rate > 0.0).map(|rate| weight / rate))
            .sum()
    }

    /// Wear so many cycles after a wear.
    pub(super) fn after(&self, wear: f64, cycles: f64) -> f64 {
        let step = cycles / f64::from(PIECES);
        (0..PIECES).fold(wear, |wear, _| {
            let a = self.rate(wear);
            let b = self.rate(wear + 0.5 * step * a);
            let c = self.rate(wear + 0.5 * step * b);
            let d = self.rate(wear + step * c);
            wear + step / 6.0 * (a + 2.0 * (b + c) + d)
        })
    }
}

/// Earlier measurements that are no nearer than this [m] to own ones and to each other, those nearest to the first first.
pub(super) fn apart(
    own: &[Measured],
    earlier: &[Measured],
    least: f64,
) -> impl Iterator<Item = Measured> + use<> {
    let (first, mut taken) = (own[0].wear, own.to_vec());
    let mut sorted = earlier.to_vec();
    sorted.sort_by(|a, b| (a.wear - first).abs().total_cmp(&(b.wear - first).abs()));
    sorted.into_iter().filter(move |one| {
        let distances = taken.iter().map(|known| (one.wear - known.wear).abs());
        let is_apart = distances.fold(f64::INFINITY, f64::min) >= least.abs();
        if is_apart {
            taken.push(*one);
        }
        is_apart
    })
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
        let line = Curve::level(begin).through(at(20.0 + 0.75 * begin.rate));
        let [line, curve] =
            [line, line.through(at(18.0))].map(|curve| curve.after(begin.wear, 1.0) - begin.wear);
        // The line leaves (k/c)²/192 of a step, by its second derivative; the curve what is left of the third.
        assert!((line / exact - 1.0).abs() < 1e-4 && (line / exact - 1.0).abs() > 2e-5, "{line} {exact}");
        assert!((curve / exact - 1.0).abs() < 5e-6, "{curve} {exact}");
    }

    #[test]
    fn the_time_that_a_way_takes_is_the_integral_of_one_over_the_rate() {
        // c' = c, through four places: a cubic is off, a line is met. From 1 to 2 in ln 2.
        let line = Curve::level(Measured { wear: 1.0, rate: 1.0 }).through(Measured { wear: 2.0, rate: 2.0 });
        assert!((line.cycles(1.0, 2.0).expect("it wears") - std::f64::consts::LN_2).abs() < 3e-8);
        let ends =
            Curve::level(Measured { wear: 1.0, rate: 1.0 }).through(Measured { wear: 2.0, rate: -1.0 });
        assert_eq!(ends.cycles(1.0, 2.0), None);
    }

    #[test]
    fn a_curve_goes_through_all_that_it_was_told() {
        let law = |wear: f64| 2.0 + wear * (3.0 + wear * (0.5 - 0.25 * wear));
        let at = |wear: f64| Measured { wear, rate: law(wear) };
        let curve =
            [0.5, -1.0, 2.0].into_iter().fold(Curve::level(at(1.0)), |curve, wear| curve.through(at(wear)));
        for wear in [1.0, 0.5, -1.0, 2.0, 3.5] {
            // A few roundings.
            assert!((curve.rate(wear) - law(wear)).abs() < 1e-13, "{wear}");
        }
        assert_eq!(curve.through(at(9.0)).rate(4.0), curve.rate(4.0), "a cubic is all there is");
    }

    #[test]
    fn one_measurement_in_the_middle_tells_what_a_step_wears() {
        // c' = 1.6 sqrt(c / 10), in steps of one with earlier middles one and two steps before.
        let at = |clearance: f64| Measured { wear: clearance - 10.0, rate: 1.6 * (clearance / 10.0).sqrt() };
        let clearance = |time: f64| (20.0_f64.sqrt() + 0.8 * time / 10.0_f64.sqrt()).powi(2);
        let [own, others @ ..] = [0.5, -0.5, -1.5, -2.5].map(|time| at(clearance(time)));
        let three = Curve::level(own).through(others[0]).through(others[1]);
        let exact = clearance(1.0) - clearance(0.0);
        let off =
            [three, three.through(others[2])].map(|curve| (curve.after(10.0, 1.0) - 10.0) / exact - 1.0);
        // Of the third derivative a 24th is left, times the third power of a tenth of the clearance; of the fourth about as much.
        assert!(off[0].abs() < 3e-5 && off[1].abs() < 1e-5, "{off:?}");
    }

    #[test]
    fn what_does_not_wear_stays() {
        let still = Measured { wear: 3.0, rate: 0.0 };
        assert_eq!(Curve::level(still).through(still).after(3.0, 5.0), 3.0);
    }
}
