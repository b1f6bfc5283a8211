//! What every law of life can tell from its reliability function: quantiles, moments, whole cycles, hazard.
//! In: reliability over time from the present. Out: numbers in the unit of that time. Never knows wear.

use crate::error::{LifeError, probability};
use crate::quadrature::integrate;
use crate::special::rising_root;

/// Survivors that are no longer counted, as a part of the accuracy asked for.
const GONE: f64 = 1e-5;
/// Width of the flank of a reliability, as a part of the median, below which it gets pieces of its own: a wider one is
/// seen by the 15 points of the first rule, a narrower one may fall between them.
const NARROW: f64 = 0.01;
/// Where the pieces of a narrow flank end: probabilities of failure below the median, of survival above it.
const FLANK: [f64; 4] = [0.1, 1e-3, 1e-7, 1e-12];
/// Steps on either side of the median by which moments are enclosed: to some 5 % of the standard deviation.
const ENCLOSING: u32 = 24;
/// Tail whose quantile decides how long these steps are.
const ENCLOSED_TAIL: f64 = 1e-3;
/// Whole cycles that are summed one by one; longer lives take the sum as an integral.
const SUMMED: f64 = 2000.0;

/// Mean and standard deviation of a life.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Mean [unit of time].
    pub mean: f64,
    /// Standard deviation [unit of time].
    pub std: f64,
    /// Estimate of the quadrature error of the mean [unit of time].
    pub error: f64,
}

impl Moments {
    /// Coefficient of variation std / mean.
    pub fn cov(&self) -> f64 {
        self.std / self.mean
    }
}

/// A distribution of the time that is left.
pub trait Lifetime {
    /// Probability of no failure until `t` from now; 1 for `t` <= 0, not rising, to 0 for long times.
    fn reliability(&self, t: f64) -> f64;

    /// A positive time of the order of the life, from which searches start.
    fn typical(&self) -> f64;

    /// Probability of failure until `t`. Overridden where it can be had without the loss of digits in 1 - S.
    fn failed(&self, t: f64) -> f64 {
        1.0 - self.reliability(t)
    }

    /// Probability of ever failing.
    fn ever(&self) -> f64 {
        1.0
    }

    /// Relative accuracy asked of integrals. Mixtures of many laws ask for less: each value costs them more, and they are
    /// no more accurate themselves.
    fn accuracy(&self) -> f64 {
        1e-11
    }

    /// Times where the reliability has kinks.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Limits of integrals from the present to `end`, which end a piece where the reliability has kinks and at the times
    /// `more`.
    fn limits(&self, end: f64, more: &[f64]) -> Vec<f64> {
        let mut limits = vec![0.0, end];
        limits.extend(self.breaks().into_iter().filter(|t| *t > 0.0 && *t < end));
        limits.extend(more);
        limits.sort_by(f64::total_cmp);
        limits.dedup();
        limits
    }

    /// Whether mean and standard deviation are finite.
    ///
    /// # Errors
    /// [`LifeError::HeavyTail`].
    fn finite_moments(&self) -> Result<(), LifeError> {
        Ok(())
    }

    /// Failures per unit of time among the survivors at `t`: -d ln S/dt, by central difference unless overridden.
    fn hazard(&self, t: f64) -> f64 {
        let step = 1e-5 * self.typical();
        let (before, after) = ((t - step).max(0.0), t + step);
        libm::log(self.reliability(before) / self.reliability(after)) / (after - before)
    }

    /// Probability density of the life at `t` [1/unit of time].
    fn density(&self, t: f64) -> f64 {
        self.hazard(t) * self.reliability(t)
    }

    /// Time until which the part `p` has failed: B10 is `quantile(0.1)`. Relative accuracy 1e-12.
    ///
    /// # Errors
    /// [`LifeError::Probability`]; [`LifeError::Never`] where fewer ever fail; [`LifeError::Endless`].
    fn quantile(&self, p: f64) -> Result<f64, LifeError> {
        probability(p)?;
        let ever = self.ever();
        if p >= ever {
            return Err(LifeError::Never { p, ever });
        }
        // The smaller of the two tails keeps its digits.
        let miss = |t: f64| if p <= 0.5 { self.failed(t) - p } else { (1.0 - p) - self.reliability(t) };
        let root = rising_root(&miss, self.typical());
        if root.is_finite() { Ok(root) } else { Err(LifeError::Endless { p }) }
    }

    /// Mean and standard deviation, time as it runs, by integrals of failed part and survivors; relative accuracy ten times
    /// [`Self::accuracy`]. They are held against what the reliability, because it only falls, leaves possible.
    ///
    /// # Errors
    /// [`LifeError::HeavyTail`]; [`LifeError::Moments`] for an integral outside of what is possible.
    fn moments(&self) -> Result<Moments, LifeError> {
        integrated_moments(self)
    }

    /// Mean and standard deviation of the number of whole cycles, a cycle being one unit of time: the cycle in which
    /// the threshold is passed counts in full, so the mean is about half a cycle above that of [`Self::moments`].
    /// E N = sum of S(n), n >= 0; above 2000 cycles E N = E T + 1/2 and var N = var T + 1/12, good to 1e-3 cycle.
    ///
    /// # Errors
    /// [`LifeError::HeavyTail`].
    fn whole_cycles(&self) -> Result<Moments, LifeError> {
        self.finite_moments()?;
        let gone = GONE * self.accuracy();
        if end(&|t| self.reliability(t), self.typical(), gone) > SUMMED {
            let moments = self.moments()?;
            let std = (moments.std * moments.std + 1.0 / 12.0).sqrt();
            return Ok(Moments { mean: moments.mean + 0.5, std, error: moments.error + 1e-3 });
        }
        let (mut mean, mut square, mut n) = (0.0, 0.0, 0.0);
        loop {
            let alive = self.reliability(n);
            mean += alive;
            square += (2.0 * n + 1.0) * alive;
            n += 1.0;
            if alive * n < gone {
                break;
            }
        }
        Ok(Moments { mean, std: (square - mean * mean).max(0.0).sqrt(), error: gone })
    }
}

/// [`Lifetime::moments`] of any law, by integrals.
pub(super) fn integrated_moments<L: Lifetime + ?Sized>(life: &L) -> Result<Moments, LifeError> {
    life.finite_moments()?;
    let scale = life.typical();
    let end = end(&|t| life.reliability(t), scale, GONE * life.accuracy());
    // From the median both ways, the failed part below it and the survivors above: nothing is a small difference.
    let centre = life.quantile(0.5)?;
    let mut marks = vec![scale, centre];
    let narrow = life.failed((1.0 - 0.5 * NARROW) * centre) < 0.1
        && life.reliability((1.0 + 0.5 * NARROW) * centre) < 0.1;
    let mut unit = centre;
    if narrow {
        for tail in FLANK {
            marks.extend([life.quantile(tail)?, life.quantile(1.0 - tail)?]);
        }
        unit = life.quantile(1.0 - FLANK[0])? - life.quantile(FLANK[0])?;
    }
    let integrand = |t: f64| {
        let part = if t < centre { -life.failed(t) } else { life.reliability(t) };
        [part, 2.0 * (t - centre) * part]
    };
    let tolerance = [life.accuracy() * unit, life.accuracy() * unit * unit];
    let (sums, errors) = integrate(&integrand, &life.limits(end, &marks), tolerance);
    for ((what, [low, high]), (sum, slack)) in ["mean", "variance"]
        .into_iter()
        .zip(enclosure(life, centre, end)?)
        .zip(sums.into_iter().zip(tolerance))
    {
        // Rounding of the sums, some hundred terms.
        let slack = 10.0 * slack + 1e-13 * (high - low).abs();
        let within = sum >= low - slack && sum <= high + slack;
        if !within {
            return Err(LifeError::Moments { what });
        }
    }
    let variance = (sums[1] - sums[0] * sums[0]).max(0.0);
    Ok(Moments { mean: centre + sums[0], std: variance.sqrt(), error: errors[0] })
}

/// Hazard of a mixture, from the part of each law that is alive and its hazard.
pub(crate) fn mixed_hazard(laws: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut density, mut alive, mut slowest) = (0.0, 0.0, f64::INFINITY);
    for (here, hazard) in laws {
        density += here * hazard;
        alive += here;
        slowest = hazard.min(slowest);
    }
    // Where none is alive by numbers, the last to die are of the law that fails most slowly.
    if alive > 0.0 { density / alive } else { slowest }
}

/// Bounds of the integrals of the parts, by steps: of S above the median and -F below it, and of the same times twice the
/// distance from the median. S falls and F rises, so in every step each lies between its values at both ends, whatever
/// it does between.
fn enclosure<L: Lifetime + ?Sized>(life: &L, centre: f64, end: f64) -> Result<[[f64; 2]; 2], LifeError> {
    let mut bounds = [[0.0; 2]; 2];
    for upper in [false, true] {
        let quantile = life.quantile(if upper { 1.0 - ENCLOSED_TAIL } else { ENCLOSED_TAIL })?;
        let reach = (quantile - centre).abs();
        let last = if upper { (end - centre).max(reach) } else { centre };
        let part = |distance: f64| {
            if upper { life.reliability(centre + distance) } else { life.failed(centre - distance) }
        };
        let (mut near, mut above, mut k) = (0.0, part(0.0), 0);
        while near < last {
            k += 1;
            // Even steps to the quantile, then growing ones.
            let even = reach * f64::from(k) / f64::from(ENCLOSING);
            let far = if k <= ENCLOSING && even > near { even } else { 1.25 * near }.min(last);
            let below = part(far);
            let (width, square) = (far - near, far * far - near * near);
            let (first, second) = ([below * width, above * width], [below * square, above * square]);
            let first = if upper { first } else { [-first[1], -first[0]] };
            for side in 0..2 {
                bounds[0][side] += first[side];
                bounds[1][side] += second[side];
            }
            if far <= near {
                break;
            }
            (near, above) = (far, below);
        }
    }
    Ok(bounds)
}

/// A time after which nothing counts, neither for the mean nor for the variance.
fn end(reliability: &dyn Fn(f64) -> f64, scale: f64, gone: f64) -> f64 {
    let mut end = scale;
    while reliability(end) * (end / scale) * (end / scale) > gone && end < 1e12 * scale {
        end *= 1.5;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::super::Weibull;
    use super::*;

    #[test]
    fn moments_and_quantiles_of_a_known_law() {
        for (scale, shape) in [(3.0, 1.0), (0.01, 2.5), (20.0, 20.0)] {
            let law = Weibull { scale, shape };
            let gamma = |x: f64| crate::special::ln_gamma(x).exp();
            let mean = scale * gamma(1.0 + 1.0 / shape);
            let std = (scale * scale * gamma(1.0 + 2.0 / shape) - mean * mean).sqrt();
            let moments = law.moments().expect("finite");
            // The accuracy asked of the integrals, times ten for the differences in the variance.
            assert!((moments.mean / mean - 1.0).abs() < 1e-10, "{shape} {} {mean}", moments.mean);
            assert!((moments.std / std - 1.0).abs() < 1e-8, "{shape} {} {std}", moments.std);
            for p in [1e-6, 0.1, 0.5, 0.9, 1.0 - 1e-9] {
                let expected = scale * (-f64::ln_1p(-p)).powf(1.0 / shape);
                // 1 - S of this test law loses digits at p = 1e-6.
                assert!((law.quantile(p).expect("valid") / expected - 1.0).abs() < 1e-9, "{shape} {p}");
            }
            // Central difference with a step of 1e-5.
            let hazard = shape / scale;
            assert!((law.hazard(scale) / hazard - 1.0).abs() < 1e-7);
        }
    }

    #[test]
    fn whole_cycles_of_an_exponential_law_are_geometric() {
        let law = Weibull { scale: 4.0, shape: 1.0 };
        let q = 1.0 - (-0.25_f64).exp();
        let whole = law.whole_cycles().expect("finite");
        assert!((whole.mean - 1.0 / q).abs() < 1e-12);
        assert!((whole.std - (1.0 - q).sqrt() / q).abs() < 1e-10);
        // Long lives: half a cycle more; S'(0)/12 = 1e-5 is left out.
        let law = Weibull { scale: 8000.0, shape: 1.0 };
        let q = -(-1.0 / 8000.0_f64).exp_m1();
        assert!((law.whole_cycles().expect("finite").mean - 1.0 / q).abs() < 1e-3);
    }

    #[test]
    fn a_flank_is_found_however_narrow_and_missing_it_is_out_of_bounds() {
        let narrow = Weibull { scale: 5.0, shape: 1e7 };
        let moments = narrow.moments().expect("finite");
        // Gumbel's law: mean -gamma, standard deviation pi / sqrt 6, over the shape.
        assert!((moments.mean / (5.0 * (1.0 - 0.577_215_664_9e-7)) - 1.0).abs() < 1e-13, "{moments:?}");
        let std = 5.0e-7 * std::f64::consts::PI / 6.0_f64.sqrt();
        assert!((moments.std / std - 1.0).abs() < 1e-6, "{moments:?} {std}");
        let median = narrow.quantile(0.5).expect("valid");
        let [first, second] = enclosure(&narrow, median, 6.0).expect("valid");
        let width = |bounds: [f64; 2]| bounds[1] - bounds[0];
        assert!(width(first) < 0.2 * std && width(second) < 0.3 * std * std, "{first:?} {second:?} {std}");
        // Both integrals came out as 0 where no point of the rule saw the flank.
        assert!(second[0] > 0.8 * std * std, "{second:?}");
    }

    #[test]
    fn no_probability_is_refused() {
        let law = Weibull { scale: 1.0, shape: 1.0 };
        for p in [0.0, 1.0, -0.1, f64::NAN] {
            assert!(matches!(law.quantile(p), Err(LifeError::Probability { .. })));
        }
    }
}
