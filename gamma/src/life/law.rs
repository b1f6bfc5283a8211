//! The law of wear: a process with its parameters, perhaps of a unit whose own parameter has a law. In and out: numbers. Never knows time.

use crate::error::{LifeError, positive};
use crate::process::{Process, RandomEffect};

/// A process with its two parameters, in the units of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    process: &'static dyn Process,
    logs: [f64; 2],
    /// Coefficient of variation of what differs between units; 0: the parameters are those of the unit.
    cv: f64,
}

/// Step of differences in the exposure, as a part of it: errors of 1e-10 by curvature and by rounding.
const STEP: f64 = 1e-5;
/// Survivors below which the hazard goes by their logarithm: numbers end at 1e-308, and lose digits on the way.
const FEWEST: f64 = 1e-290;
/// Exposure, in those that wear takes in the mean, after which a unit that has not failed never does.
const FOREVER: f64 = 1e12;
/// Places of a unit's parameter on either side at most; ten are usual.
const MOST_PLACES: i32 = 1000;

impl Law {
    /// The parameters in the order of [`Process::parameters`].
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn new(process: &'static dyn Process, parameters: [f64; 2]) -> Result<Self, LifeError> {
        let names = process.parameters();
        let logs = [0, 1].map(|at: usize| positive(names[at], parameters[at]).map(libm::log));
        let [first, second] = logs;
        Ok(Self { process, logs: [first?, second?], cv: 0.0 })
    }

    /// The same from the logarithms of the parameters.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`] for parameters out of the range of numbers.
    pub(crate) fn from_logs(process: &'static dyn Process, logs: [f64; 2]) -> Result<Self, LifeError> {
        for (name, log) in process.parameters().into_iter().zip(logs) {
            positive(name, libm::exp(log))?;
        }
        Ok(Self { process, logs, cv: 0.0 })
    }

    /// Of a unit whose parameter has the law of [`Process::random_effect`].
    ///
    /// # Errors
    /// [`LifeError::NotPositive`] for numbers out of their range.
    pub(crate) fn of_units(
        process: &'static dyn Process,
        logs: [f64; 2],
        cv: f64,
    ) -> Result<Self, LifeError> {
        let cv = positive("the coefficient of variation of units", cv)?;
        Ok(Self { cv, ..Self::from_logs(process, logs)? })
    }

    fn effect(&self) -> Option<&'static dyn RandomEffect> {
        self.process.random_effect().filter(|_| self.cv > 0.0)
    }

    /// Whether lives have a mean and a standard deviation.
    pub(crate) fn has_moments(&self) -> bool {
        self.effect().is_none_or(RandomEffect::has_moments)
    }

    /// Probability that wear ever reaches `left`.
    pub(crate) fn ever(&self, left: f64) -> f64 {
        if self.has_moments() {
            1.0
        } else {
            self.failure((FOREVER * self.mean_exposure(left)).min(f64::MAX), left)
        }
    }

    /// Probability that wear stays below `left` throughout an exposure.
    pub(crate) fn survival(&self, exposure: f64, left: f64) -> f64 {
        match self.effect() {
            _ if exposure <= 0.0 => 1.0,
            // Powers of long times are beyond all numbers.
            _ if exposure == f64::INFINITY => 1.0 - self.ever(left),
            Some(effect) => effect.survival(self.logs, self.cv, exposure, left).0,
            None => self.process.survival(self.logs, exposure, left),
        }
    }

    /// Probability that wear reaches `left` within an exposure.
    pub(crate) fn failure(&self, exposure: f64, left: f64) -> f64 {
        match self.effect() {
            _ if exposure <= 0.0 => 0.0,
            _ if exposure == f64::INFINITY => self.ever(left),
            Some(effect) => effect.survival(self.logs, self.cv, exposure, left).1,
            None => self.process.failure(self.logs, exposure, left),
        }
    }

    /// Whether wear never falls.
    pub(crate) fn is_increasing(&self) -> bool {
        self.process.is_increasing()
    }

    /// Whether a unit has a parameter of its own, of which wear tells.
    pub(crate) fn units_differ(&self) -> bool {
        self.cv > 0.0
    }

    /// Laws of single units with their probabilities, evenly apart over what differs between them: by `spacing`, in standard deviations
    /// and in the logarithm of a parameter, as far as ln of the density is within `depth` of the top. Itself where units are alike.
    pub(crate) fn units(&self, spacing: (f64, f64), depth: f64) -> Vec<(f64, Self)> {
        let Some(effect) = self.effect() else { return vec![(1.0, *self)] };
        let step = spacing.0.min(spacing.1 / self.cv);
        let place = |at: i32| effect.place(self.logs, self.cv, step * f64::from(at));
        let top = place(0).map_or(0.0, |(_, ln)| ln);
        let counts = |found: &([f64; 2], f64)| found.1 > top - depth;
        let side = |sign: i32| (1..MOST_PLACES).map_while(move |at| place(sign * at).filter(counts));
        let middle = place(0).into_iter();
        let mut units: Vec<(f64, Self)> = middle
            .chain(side(1))
            .chain(side(-1))
            .map(|(logs, ln)| (libm::exp(ln - top), Self { logs, cv: 0.0, ..*self }))
            .collect();
        let all: f64 = units.iter().map(|(part, _)| part).sum();
        units.iter_mut().for_each(|(part, _)| *part /= all);
        units
    }

    /// Wear of units that are alike after an exposure > 0, which is not exceeded with probability `p`.
    pub(crate) fn quantile(&self, exposure: f64, p: f64) -> f64 {
        self.process.quantile(self.logs, exposure, p)
    }

    /// Failures per unit of exposure among the survivors.
    pub(crate) fn hazard(&self, exposure: f64, left: f64) -> f64 {
        let Some(effect) = self.effect() else { return self.process.hazard(self.logs, exposure, left) };
        if exposure <= 0.0 {
            return 0.0;
        }
        let at = |exposure: f64| effect.survival(self.logs, self.cv, exposure, left);
        let step = STEP * exposure;
        let ((before, failed_before), (after, failed_after)) = (at(exposure - step), at(exposure + step));
        if after < FEWEST {
            let ln = |exposure: f64| effect.ln_survival(self.logs, self.cv, exposure, left);
            return (ln(exposure - step) - ln(exposure + step)) / (2.0 * step);
        }
        // Of both differences the one that keeps its digits.
        let change = if before < 0.5 { before - after } else { failed_after - failed_before };
        change / (step * (before + after))
    }

    /// Mean and variance of the exposure at which wear reaches `left`, where they have closed forms.
    pub(crate) fn passage_moments(&self, left: f64) -> Option<(f64, f64)> {
        self.process.passage_moments(self.logs, left).filter(|_| self.effect().is_none())
    }

    /// Mean exposure at which wear reaches `left`.
    pub(crate) fn mean_exposure(&self, left: f64) -> f64 {
        self.process.mean_exposure(self.logs, left)
    }
}
