//! Profile-likelihood intervals. In: an fit. Out: the values of a parameter that the data do not reject. Never
//! knows other kinds of intervals.

use super::error::FitError;
use super::estimate::Fit;
use super::maximise::{LARGEST_CV, maximise};
use crate::data::Observations;
use crate::special::normal_quantile;

/// Standard errors from the estimate up to which the end of an interval is looked for: a likelihood that has not fallen enough by
/// then is flat.
const FARTHEST: f64 = 30.0;
/// Relative accuracy of the end of an interval that is bracketed: no digit that is printed depends on more.
pub(super) const ACCURACY: f64 = 1e-9;

/// An interval for a parameter; an end is infinite, or 0 for a parameter that is positive, where the data set none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether it holds a value.
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }
}

/// The values of parameter `index` of [`Fit::parameters`] that a likelihood-ratio test at 1 - `level` does not
/// reject, the others re-estimated at each. Where the likelihood stays too flat toward a side up to 30 standard errors away, that
/// side is open.
///
/// # Errors
/// [`FitError::NotConverged`] when the others cannot be re-estimated on the way.
pub fn profile_interval(
    fit: &Fit,
    observations: &Observations,
    index: usize,
    level: f64,
) -> Result<Interval, FitError> {
    profile_within(fit, observations, index, normal_quantile(0.5 + 0.5 * level))
}

/// [`profile_interval`] up to where the signed root of the likelihood ratio is `reach`.
pub(super) fn profile_within(
    fit: &Fit,
    observations: &Observations,
    index: usize,
    reach: f64,
) -> Result<Interval, FitError> {
    let ends = [end(fit, observations, index, -reach)?, end(fit, observations, index, reach)?];
    let [low, high] = ends.map(|end| fit.model.natural(index, end));
    Ok(Interval { low, high })
}

/// The value where the signed root of the likelihood ratio reaches `target`: a secant on a function that is nearly
/// linear, because phi is in logarithms. Infinite where it stays below.
fn end(fit: &Fit, observations: &Observations, index: usize, target: f64) -> Result<f64, FitError> {
    let top = fit.phi[index];
    let deviation = fit.covariance[index][index].sqrt();
    let mut path = Path::new(fit, index);
    let mut root = |value: f64| -> Result<f64, FitError> {
        let (phi, point) = maximise(&fit.model, &observations.increments, &path.start(value), Some(index))?;
        path.add(phi);
        Ok((2.0 * (fit.log_likelihood - point.value)).max(0.0).sqrt() * target.signum())
    };
    // The exponent stays positive: towards 0 by halves.
    let positive = fit.model.power_law && index == 2;
    let guard = |old: f64, new: f64| if positive && new <= 0.0 { 0.5 * old } else { new };
    let (mut x0, mut r0) = (top, 0.0);
    let mut x1 = guard(top, top + target * deviation);
    for _ in 0..60 {
        let r1 = root(x1)?;
        // 1e-9 of a standard deviation.
        if (r1 - target).abs() < 1e-9 {
            return Ok(x1);
        }
        let away = (x1 - top).abs();
        let too_flat = r1.abs() < target.abs();
        if too_flat && (away > FARTHEST * deviation || r1 == r0) {
            return Ok(target.signum() * f64::INFINITY);
        }
        if r1 == r0 {
            break;
        }
        // Where it falls again on the way out, the secant would turn back.
        let longest = (3.0 * deviation).max(0.5 * away);
        let slope = (r1 - r0) / (x1 - x0);
        let step = match slope > 0.0 {
            true => ((target - r1) / slope).clamp(-longest, longest),
            false => target.signum() * longest,
        };
        (x0, r0, x1) = (x1, r1, guard(x1, x1 + step));
    }
    Err(FitError::NotConverged)
}

/// The other parameters' best as one is moved: where to look for the next of them.
struct Path<'a> {
    fit: &'a Fit,
    index: usize,
    /// Where the last best was.
    last: Vec<f64>,
    /// How all change with the one.
    slope: Vec<f64>,
}

impl<'a> Path<'a> {
    /// From the estimate, along the ridge of the likelihood.
    fn new(fit: &'a Fit, index: usize) -> Self {
        let slope = fit.covariance.iter().map(|row| row[index] / fit.covariance[index][index]);
        Self { fit, index, last: fit.phi.clone(), slope: slope.collect() }
    }

    fn start(&self, value: f64) -> Vec<f64> {
        let by = value - self.last[self.index];
        let mut start: Vec<f64> =
            self.last.iter().zip(&self.slope).map(|(last, slope)| last + by * slope).collect();
        // Where a straight line ends beyond what there is, it is not followed.
        let is_left = |at: &usize| {
            let is_exponent = self.fit.model.power_law && *at == 2;
            let is_cv = self.fit.model.units_differ && *at + 1 == self.last.len();
            (is_exponent && start[*at] <= 0.0) || (is_cv && start[*at] > libm::log(LARGEST_CV))
        };
        if (0..start.len()).any(|at| is_left(&at)) {
            start.clone_from(&self.last);
        }
        start[self.index] = value;
        start
    }

    fn add(&mut self, best: Vec<f64>) {
        let by = best[self.index] - self.last[self.index];
        if by != 0.0 {
            self.slope = best.iter().zip(&self.last).map(|(best, last)| (best - last) / by).collect();
        }
        self.last = best;
    }
}
