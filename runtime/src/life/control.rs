//! How long a step along the mean path of wear may be. In: what the last steps erred. Out: whether a step is good enough, the next
//! one to try. Never knows what wears, nor how an error was found.
//!
//! Bodies that chatter make every measurement scatter, wear by angle most of all, where the worst bin is asked. An error that
//! scatters does not shrink with the step, so steps that go by it alone end as short as they may be: what longer steps do not
//! make larger is known here as noise, and steps go by a multiple of it.

/// The next step is at most so many times longer.
const LARGEST_GROWTH: f64 = 4.0;
/// And at least this part of the one refused.
const LARGEST_CUT: f64 = 0.2;
/// Part of the step that the error would just allow.
const SAFETY: f64 = 0.9;
/// Steps go by this multiple of an error that did not shrink with the step: noise, or a kink on the way.
const ABOVE_NOISE: f64 = 2.0;
/// What is left of the known noise after a step: a kink that was taken for noise is forgotten in some ten steps.
const NOISE_KEPT: f64 = 0.9;
/// Where errors scatter, those of equal steps lie within this factor of each other, mostly: the largest of dozens of bins.
const SPREAD: f64 = 3.0;
/// What is left of the noise there after a step that erred more than it: the step's own error shows.
const NOISE_DOUBTED: f64 = 0.5;
/// A step is longer than the one before if it is so many times as long: equal steps to an end differ by less.
const CLEARLY_LONGER: f64 = 1.1;

/// What the step control remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Control {
    /// Next step to try, in cycles.
    pub step: f64,
    /// Relative error that does not shrink with the step: noise of the fine scale.
    pub noise: f64,
    /// The last step that was accepted: its length in cycles, its relative error.
    #[cfg_attr(feature = "serde", serde(default))]
    pub last: (f64, f64),
    /// Whether errors are known to scatter: the shortest step is no better than longer ones.
    #[cfg_attr(feature = "serde", serde(default))]
    pub scatters: bool,
}

impl Control {
    /// Of a life that begins: with a step of one cycle.
    pub(super) const fn new() -> Self {
        Self { step: 1.0, noise: 0.0, last: (0.0, 0.0), scatters: false }
    }

    /// Whether a step of a length is good enough, by its error over its gain and that of a longer one that was refused
    /// before; sets the next step to try.
    pub(super) fn accepts(
        &mut self,
        ratio: f64,
        length: f64,
        refused: Option<(f64, f64)>,
        (tolerance, shortest): (f64, f64),
    ) -> bool {
        // Error over gain goes with the square of the step; what does not go even in proportion is noise.
        let in_vain = refused.filter(|(longer, erred)| ratio > erred * (length / longer));
        if let Some((_, erred)) = in_vain {
            let seen = if self.scatters { erred.max(ratio) } else { ratio };
            self.noise = self.noise.max(seen);
        }
        let allowed = tolerance.max(if self.scatters { SPREAD } else { ABOVE_NOISE } * self.noise);
        let factor = SAFETY * libm::sqrt(allowed / ratio.max(f64::MIN_POSITIVE));
        if ratio > allowed && length > shortest {
            self.step = (length * factor.max(LARGEST_CUT)).max(shortest);
            return false;
        }
        self.step = (length * factor.min(LARGEST_GROWTH)).max(shortest);
        if self.scatters {
            // What was refused for its noise need not be approached step by step.
            self.step = self.step.max(in_vain.map_or(0.0, |(longer, _)| longer));
            self.learn_scatter(ratio, length, tolerance);
        } else {
            self.noise *= NOISE_KEPT;
        }
        if ratio > tolerance && length <= shortest {
            self.noise = self.noise.max(ratio);
            self.scatters = true;
        }
        self.last = (length, ratio);
        true
    }

    /// What an accepted step tells of an error that scatters, until it is below the tolerance.
    fn learn_scatter(&mut self, ratio: f64, length: f64, tolerance: f64) {
        self.noise *= match ratio {
            more if more > self.noise => NOISE_DOUBTED,
            less if SPREAD * less < self.noise => NOISE_KEPT,
            _ => 1.0,
        };
        let (before, erred) = self.last;
        if length > CLEARLY_LONGER * before && ratio < erred * (length / before) && ratio > tolerance {
            self.noise = self.noise.max(ratio);
        }
        self.scatters = self.noise > tolerance;
    }
}

#[cfg(test)]
mod tests {
    use super::Control;

    const TOLERANCE: f64 = 1e-5;
    const SHORTEST: f64 = 0.25;

    /// Steps tried, the refused ones among them, until so many cycles are done; errors by the length and the number of the trial.
    fn trials(cycles: f64, error: impl Fn(f64, u64) -> f64) -> (u64, Control) {
        let (mut control, mut refused) = (Control::new(), None);
        let (mut done, mut tried) = (0.0, 0);
        while done < cycles {
            assert!(tried < 100_000, "{done} cycles: {control:?}");
            let length = control.step;
            let ratio = error(length, tried);
            tried += 1;
            if control.accepts(ratio, length, refused, (TOLERANCE, SHORTEST)) {
                (done, refused) = (done + length, None);
            } else {
                refused = Some((length, ratio));
            }
        }
        (tried, control)
    }

    /// Numbers between 0 and 1 without an order.
    fn scattered(number: u64) -> f64 {
        ((number as f64 + 1.0) * 0.618_033_988_749_895).fract()
    }

    #[test]
    fn noise_does_not_shorten_steps() {
        // From a tenth of the worst to the worst, evenly in their logarithms; no length makes it less.
        let (tried, _) = trials(3000.0, |_, number| 0.01 * libm::pow(10.0, -scattered(number)));
        // Steps grow by 1.5 at least where they are accepted, and one in some four is not: 3,000 cycles are 20 growths.
        assert!(tried < 60, "{tried}");
    }

    #[test]
    fn steps_beneath_noise_grow_until_their_own_error_shows() {
        let scatter = |number| 1e-3 * (0.3 + 0.7 * scattered(number));
        let (tried, control) = trials(30_000.0, |length, number| scatter(number) + 1e-8 * length * length);
        // Their own error is that of the noise at 316 cycles.
        assert!(control.last.0 > 100.0 && control.last.0 < 1000.0, "{control:?}");
        assert!(tried < 300, "{tried}");
    }

    #[test]
    fn an_error_that_goes_with_the_step_is_held_and_a_kink_forgotten() {
        let kink = |number| if (20..23).contains(&number) { 1e-2 } else { 0.0 };
        let (_, control) = trials(300.0, |length, number| 1e-5 * length * length + kink(number));
        // Tolerance at one cycle, and steps a hair below.
        assert!(control.last.1 <= TOLERANCE && control.noise < TOLERANCE, "{control:?}");
    }
}
