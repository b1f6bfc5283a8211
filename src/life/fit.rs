//! A fit to measured wear that a joint wears by. In: the fit's file. Out: [`JointFit`], or why no life can be drawn from it.

use linkwear_gamma::life::Estimate;
use linkwear_gamma::process::{Gamma, Process};
use linkwear_gamma::{FitFile, FitFileError};
use thiserror::Error;

use crate::number::number;

/// Beyond this a fit's wear is not that of the mechanism, but in other units.
const CREDIBLE: f64 = 100.0;

/// alpha and beta of a joint by a fit to measured wear: a plain Gamma process, wear and Lambda in micrometres.
#[derive(Clone, Debug, PartialEq)]
pub struct JointFit {
    /// The joint.
    pub(super) joint: String,
    /// Where the fit is from, to report.
    pub(super) from: String,
    /// alpha and beta [1/µm].
    pub(super) estimate: Estimate,
}

/// Why no life can be drawn from a fit.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum UnfitForLife {
    /// It is of another process.
    #[error("the fit is of the {} process: `life` draws Gamma increments", .0.title())]
    Process(&'static dyn Process),
    /// It has an exponent.
    #[error("the fit has an exponent of exposure: in `life` physics says how wear goes on")]
    Exponent,
    /// It has covariates.
    #[error("the fit has covariates: in `life` physics says what load does")]
    Covariates,
    /// It is not over Lambda.
    #[error("the fit is over an exposure as it is, so its alpha is not one per um of Lambda")]
    Exposure,
    /// Its wear and Lambda are not both in micrometres; has alpha / beta.
    #[error("by this fit wear grows {} times as fast as Lambda", number(*.0))]
    Units(f64),
    /// Its numbers are no Gamma process.
    #[error(transparent)]
    File(#[from] FitFileError),
}

impl JointFit {
    /// For a joint. `from` tells where the fit is from; joints whose fits are from the same place err together.
    ///
    /// # Errors
    /// [`UnfitForLife`].
    pub fn new(
        joint: impl Into<String>,
        from: impl Into<String>,
        fit: &FitFile,
    ) -> Result<Self, UnfitForLife> {
        if fit.process.name() != Gamma.name() {
            return Err(UnfitForLife::Process(fit.process));
        }
        if fit.exponent.is_some() {
            return Err(UnfitForLife::Exponent);
        }
        if !fit.covariates.is_empty() {
            return Err(UnfitForLife::Covariates);
        }
        if fit.over_lambda == Some(false) {
            return Err(UnfitForLife::Exposure);
        }
        let estimate = fit.estimate(&[])?;
        let [alpha, beta] = estimate.parameters();
        if !(1.0 / CREDIBLE..=CREDIBLE).contains(&(alpha / beta)) {
            return Err(UnfitForLife::Units(alpha / beta));
        }
        Ok(Self { joint: joint.into(), from: from.into(), estimate })
    }
}

impl UnfitForLife {
    /// With the line of the fit's file that is to blame, and what to do.
    pub fn located(self, fit: &FitFile) -> FitFileError {
        let again = "fit wear in um over Lambda: `linkwear life FILE --mean --format json > life.json`, then `linkwear \
                     fit .. --exposure CYCLES --lambda life.json`";
        let (key, cure) = match &self {
            Self::Process(_) => ("process", "fit it without --process"),
            Self::Exponent => ("exponent", again),
            Self::Covariates => ("covariates", again),
            Self::Exposure => ("over_lambda", again),
            Self::Units(_) => (
                "alpha",
                "count both wear and Lambda in um; if they are, correct the wear coefficient of the mechanism's file \
                 and fit again",
            ),
            Self::File(error) => return error.clone(),
        };
        fit.fault(key, &self.to_string(), cure)
    }
}
