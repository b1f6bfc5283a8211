//! A prediction: everything that is told about the remaining life of one joint. In: an estimate, the joint's state, perhaps
//! readings. Out: numbers with their bands and error budget. Never knows files or terminals.

use crate::error::LifeError;
use crate::inspection::{
    Effort, History, InspectionError, Mixture, Particles, Posterior, Prior, UnitPosterior,
};
use crate::life::{
    Band, Bands, Contribution, ErrorBudget, Estimate, FirstPassage, LifeMixture, Lifetime, Method, Moments,
    OperatingState, Sample, WithError,
};

/// Times at which reliability is given, from now until all but [`TAIL`] have failed.
const TIMES: usize = 41;
const TAIL: f64 = 1e-3;

/// Uncertainty of the parameters is part of the law itself.
const WITHIN: Contribution = Contribution::None("parameters are integrated over; the law contains them");

/// Increments up to which the predictive interval integrates over the parameters; of more the normal law of their logarithms
/// is as good, and quicker.
const INTEGRATED: usize = 400;
/// Increments below which that law is too narrow to go without a warning.
const FEW: usize = 40;
/// Parameter sets drawn from that law: the ends of the interval are good to some percent of its width beyond the plug-in one.
const NORMAL_SETS: usize = 2000;

/// What an interval for one life takes into account of the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// The remaining life of one joint; times in the unit of the exposure's rate, from the present.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// What it rests on: `fit`, `fit and inspections`, ..
    pub from: String,
    /// Wear now.
    pub current: f64,
    /// Wear at failure.
    pub threshold: f64,
    /// Mean and standard deviation, the mean with its band; None where they are not finite, and a warning says so.
    pub moments: Option<(Moments, Band)>,
    /// The same of the time rounded up to whole units.
    pub whole: Option<Moments>,
    /// 10 %, 50 %, 90 % of the life, with what the parameters leave open.
    pub quantiles: [Band; 3],
    /// Ends of the interval that holds the life with probability [`Prediction::LEVEL`].
    pub interval: (f64, f64),
    /// How it takes the parameters.
    pub interval_kind: IntervalKind,
    /// Time, reliability with its band, hazard.
    pub course: Vec<(f64, Band, f64)>,
    /// Of the mean.
    pub budget: Option<ErrorBudget>,
    /// What its reader has to know.
    pub warnings: Vec<String>,
}

impl Prediction {
    /// Probability of every interval and band.
    pub const LEVEL: f64 = 0.95;

    /// From a fit alone; `method` makes the bands.
    ///
    /// # Errors
    /// [`LifeError`].
    pub fn by_fit(estimate: &Estimate, state: &OperatingState, method: Method) -> Result<Self, LifeError> {
        let life = state.life(estimate)?;
        let bands = Bands::new(estimate, state, Self::LEVEL, method)?;
        let mut answer = Self::ask(&life, state, "fit", &mut |ask| match ask {
            Ask::Mean(_) => bands.mean(),
            Ask::Quantile(p, _) => bands.quantile(p),
            Ask::Reliability(t, _) => bands.reliability(t),
        })?;
        (answer.interval, answer.interval_kind) = Self::predictive_interval(estimate, state)?;
        if answer.interval_kind == IntervalKind::PlugIn && estimate.is_uncertain() {
            answer.warnings.push(
                "the interval of lives takes the parameters as known, because the fit does not hold its increments: after few of them it is too short; fit again with this version"
                    .to_owned(),
            );
        }
        if let (IntervalKind::Normal, Sample::Indirect { increments }) =
            (answer.interval_kind, estimate.sample())
            && *increments < FEW
        {
            answer.warnings.push(format!(
                "the interval of lives goes by the covariance alone, which says too little after {increments} increments: with a covariate 86 % of lives end within after 8 of them and 92 % after 16, not 95 %; if an older version wrote the fit, fit again"
            ));
        }
        let known = Contribution::None("the fit gives no covariance");
        answer.complete(Contribution::None("closed form"), (!estimate.is_uncertain()).then_some(known));
        Ok(answer)
    }

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
        let ends = |life: &dyn Lifetime| -> Result<(f64, f64), LifeError> {
            Ok((life.quantile(0.5 - 0.5 * Self::LEVEL)?, life.quantile(0.5 + 0.5 * Self::LEVEL)?))
        };
        let process = estimate.process();
        match estimate.sample() {
            Sample::Increments(increments) if increments.len() <= INTEGRATED => {
                let prior = Prior::Matching { process, power_law: estimate.exponent().is_some() };
                if let Ok(posterior) = Posterior::of_increments(increments, &prior, state) {
                    return Ok((ends(&posterior)?, IntervalKind::Predictive));
                }
            }
            Sample::Sets(sets) => {
                let mixture = LifeMixture::of_sets(estimate, state, sets)?;
                return Ok((ends(&mixture)?, IntervalKind::Predictive));
            }
            Sample::Unknown => return Ok((ends(&state.life(estimate)?)?, IntervalKind::PlugIn)),
            _ => {}
        }
        if !estimate.is_uncertain() {
            return Ok((ends(&state.life(estimate)?)?, IntervalKind::PlugIn));
        }
        let mixture = LifeMixture::normal(estimate, state, NORMAL_SETS)?;
        Ok((ends(&mixture)?, IntervalKind::Normal))
    }

    /// After exact readings; the last one is the present, `state` gives threshold and rate.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn after(history: &History, prior: &Prior, state: &OperatingState) -> Result<Self, InspectionError> {
        let last = history.last();
        let now = state.clone().worn(last.wear, state.rate() * last.time)?;
        let from = match prior {
            Prior::Flat { .. } | Prior::Matching { .. } => "inspections alone",
            Prior::Fit(_) => "fit and inspections",
        };
        let posterior: Box<dyn Mixture> = match prior {
            Prior::Fit(fit) if fit.units_differ() => Box::new(UnitPosterior::update(history, fit, state)?),
            _ => Box::new(Posterior::update(history, prior, state)?),
        };
        let mut answer = Self::ask(&*posterior, &now, from, &mut |ask| ask.of(&*posterior))?;
        answer.complete(Contribution::None("closed forms, quadrature over parameters"), Some(WITHIN));
        Ok(answer)
    }

    /// After readings with a normal error of standard deviation `gauge` \[unit of wear\]; the last one is the present, `state`
    /// gives threshold and rate.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn after_gauge(
        history: &History,
        prior: &Estimate,
        state: &OperatingState,
        gauge: f64,
        effort: Effort,
    ) -> Result<Self, InspectionError> {
        let particles = Particles::follow(history, prior, state, gauge, effort)?;
        let from = "fit and inspections with gauge error";
        let mut answer = Self::ask(&particles, state, from, &mut |ask| ask.of(&particles))?;
        answer.current = particles.wear().0;
        let mean = answer.moments.map_or(f64::NAN, |(moments, _)| moments.mean);
        let error = WithError { value: mean, error: particles.mean_error() };
        answer.complete(ErrorBudget::monte_carlo(error), Some(WITHIN));
        if particles.failed_already() > 0.0 {
            answer.warnings.push(format!(
                "with probability {:.2} the joint had failed at the last reading: the answer is for one that had not",
                particles.failed_already()
            ));
        }
        Ok(answer)
    }

    fn ask(
        life: &dyn Lifetime,
        state: &OperatingState,
        from: &str,
        band: &mut dyn FnMut(Ask) -> Result<Band, LifeError>,
    ) -> Result<Self, LifeError> {
        let mut warnings = Vec::new();
        let (moments, whole) = match (life.moments(), life.whole_cycles()) {
            (Ok(moments), Ok(whole)) => (Some((moments, band(Ask::Mean(moments.mean))?)), Some(whole)),
            (Err(error), _) | (_, Err(error)) => {
                warnings.push(error.to_string());
                (None, None)
            }
        };
        let mut quantile = |p: f64| band(Ask::Quantile(p, life.quantile(p)?));
        let quantiles = [quantile(0.1)?, quantile(0.5)?, quantile(0.9)?];
        let interval = (life.quantile(0.5 - 0.5 * Self::LEVEL)?, life.quantile(0.5 + 0.5 * Self::LEVEL)?);
        let end = life.quantile(1.0 - TAIL)?;
        let mut course = Vec::with_capacity(TIMES);
        for k in 0..TIMES {
            let t = end * k as f64 / (TIMES - 1) as f64;
            course.push((t, band(Ask::Reliability(t, life.reliability(t)))?, life.hazard(t)));
        }
        Ok(Self {
            from: from.to_owned(),
            current: state.current(),
            threshold: state.threshold(),
            moments,
            whole,
            quantiles,
            interval,
            // The law of a posterior contains the parameters; of a fit it is set by its caller.
            interval_kind: IntervalKind::Predictive,
            course,
            budget: None,
            warnings,
        })
    }

    /// Adds the budget of the mean. `parameters`: None takes the band of the mean.
    fn complete(&mut self, monte_carlo: Contribution, parameters: Option<Contribution>) {
        self.budget = self.moments.map(|(_, band)| ErrorBudget {
            monte_carlo,
            table: Contribution::None("exposure is a formula"),
            settling: None,
            averaging: None,
            parameters: parameters.unwrap_or_else(|| ErrorBudget::parameters(band)),
        });
    }
}

/// What is asked of the possible laws, with the answer of the whole.
enum Ask {
    Mean(f64),
    Quantile(f64, f64),
    Reliability(f64, f64),
}

impl Ask {
    fn of(&self, mixture: &dyn Mixture) -> Result<Band, LifeError> {
        let level = Prediction::LEVEL;
        match *self {
            // For a steady load the typical time is the mean; for a curved one it is near, at no cost of an integral.
            Self::Mean(value) => mixture.credible(value, level, &|life: &FirstPassage| Ok(life.typical())),
            Self::Quantile(p, value) => mixture.credible(value, level, &|life| life.quantile(p)),
            Self::Reliability(t, value) => mixture.credible(value, level, &|life| Ok(life.reliability(t))),
        }
    }
}
