//! The law of one life with all that the data leave open of its parameters, and the interval that holds it. In: an estimate, a
//! state. Out: a [`Lifetime`]. Never knows what else is told of a life.

use super::Prediction;
use super::questions::open;
use crate::error::LifeError;
use crate::inspection::{Mixture, Posterior, Prior};
use crate::life::{Estimate, LifeMixture, Lifetime, OperatingState, PossibleLives, Sample};

/// Increments up to which the predictive interval integrates over the parameters; of more the normal law of their logarithms
/// is as good, and quicker.
const INTEGRATED: usize = 400;
/// Increments below which that law is too narrow to go without a warning.
const FEW: usize = 40;
/// Parameter sets drawn from that law: the ends of the interval are good to some percent of its width beyond the plug-in one.
const NORMAL_SETS: usize = 2000;

/// What an interval for one life takes into account of the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum IntervalKind {
    /// All that the data leave open.
    Predictive,
    /// What the covariance leaves open, the logarithms of the parameters being normal.
    Normal,
    /// Nothing: they are taken as known.
    PlugIn,
}

impl IntervalKind {
    /// In JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Predictive => "predictive",
            Self::Normal => "normal",
            Self::PlugIn => "plug-in",
        }
    }

    /// For people, after the ends of the interval.
    pub fn words(self) -> &'static str {
        match self {
            Self::Predictive => "what the data leave open of the parameters is counted in",
            Self::Normal => "what the covariance leaves open of the parameters is counted in",
            Self::PlugIn => "as if the parameters were known",
        }
    }
}

/// A law of life with what it takes into account of the parameters.
type Law = (Box<dyn Mixture>, IntervalKind);

impl Prediction {
    /// The interval that holds the life of a joint of the fit's population with probability [`Self::LEVEL`], over all samples
    /// that the fit might have been made from: from the posterior of the parameters after the fit's increments under a
    /// flat prior (that of [`Prior::Matching`]), whose tails match those of repeated sampling; the bench
    /// `gamma/tests/coverage.rs` shows how well. After covariates or rounded readings from the sets of parameters of
    /// [`crate::FitFile::informed`]; after many increments from the normal law of the logarithms; without increments from the
    /// estimate alone.
    ///
    /// # Errors
    /// [`LifeError`], if a parameter leaves the range of numbers.
    pub fn predictive_interval(
        estimate: &Estimate,
        state: &OperatingState,
    ) -> Result<((f64, f64), IntervalKind), LifeError> {
        let (law, kind) = predictive_law(estimate, state)?;
        Ok((ends(&*law)?, kind))
    }

    /// `count` laws of life as the data leave them possible, equally probable: those that [`Self::predictive_interval`] mixes, in the
    /// order of their typical lives one from each part of even probability. None where the parameters are taken as known.
    ///
    /// # Errors
    /// As [`Self::predictive_interval`].
    pub fn possible_lives(
        estimate: &Estimate,
        state: &OperatingState,
        count: usize,
    ) -> Result<PossibleLives, LifeError> {
        let (law, kind) = predictive_law(estimate, state)?;
        if kind == IntervalKind::PlugIn {
            return Ok(PossibleLives::default());
        }
        let mut parts = law.parts();
        parts.sort_by(|(_, a), (_, b)| a.typical().total_cmp(&b.typical()));
        let total: f64 = parts.iter().map(|(weight, _)| weight).sum();
        let mut ahead = parts.into_iter();
        let (mut reached, mut life) = (0.0, None);
        let mut lives = Vec::with_capacity(count);
        for at in 0..count {
            let middle = total * (at as f64 + 0.5) / count as f64;
            while reached < middle {
                let Some((weight, next)) = ahead.next() else { break };
                reached += weight;
                life = Some(next);
            }
            lives.extend(life.cloned());
        }
        Ok(PossibleLives { lives })
    }
}

/// Ends of the interval that holds a life with probability [`Prediction::LEVEL`]; infinite where so many never fail.
pub(super) fn ends(life: &dyn Lifetime) -> Result<(f64, f64), LifeError> {
    let tail = 0.5 - 0.5 * Prediction::LEVEL;
    Ok((open(life.quantile(tail))?, open(life.quantile(1.0 - tail))?))
}

/// The law that [`Prediction::predictive_interval`] is of.
pub(super) fn predictive_law(estimate: &Estimate, state: &OperatingState) -> Result<Law, LifeError> {
    let process = estimate.process();
    match estimate.sample() {
        Sample::Increments(increments) if increments.len() <= INTEGRATED => {
            let prior = Prior::Matching { process, power_law: estimate.exponent().is_some() };
            if let Ok(posterior) = Posterior::of_increments(increments, &prior, state) {
                return Ok((Box::new(posterior), IntervalKind::Predictive));
            }
        }
        Sample::Sets(sets) => {
            let mixture = LifeMixture::of_sets(estimate, state, sets)?;
            return Ok((Box::new(mixture), IntervalKind::Predictive));
        }
        Sample::Unknown => return plug_in(estimate, state),
        _ => {}
    }
    if !estimate.is_uncertain() {
        return plug_in(estimate, state);
    }
    Ok((Box::new(LifeMixture::normal(estimate, state, NORMAL_SETS)?), IntervalKind::Normal))
}

fn plug_in(estimate: &Estimate, state: &OperatingState) -> Result<Law, LifeError> {
    Ok((Box::new(state.life(estimate)?), IntervalKind::PlugIn))
}

/// What is doubtful about an interval of this kind.
pub(super) fn interval_warning(estimate: &Estimate, kind: IntervalKind) -> Option<String> {
    if kind == IntervalKind::PlugIn && estimate.is_uncertain() {
        return Some("the interval of lives takes the parameters as known, because the fit does not hold its increments: after few of them it is too short; fit again with this version".to_owned());
    }
    match (kind, estimate.sample()) {
        (IntervalKind::Normal, Sample::Indirect { increments }) if *increments < FEW => Some(format!(
            "the interval of lives goes by the covariance alone, which says too little after {increments} increments: with a covariate 86 % of lives end within after 8 of them and 92 % after 16, not 95 %; if an older version wrote the fit, fit again"
        )),
        _ => None,
    }
}
