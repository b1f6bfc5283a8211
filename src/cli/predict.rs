//! `predict`: remaining life from a fit, and from inspections of the one joint.

use linkwear_gamma::inspection::{Effort, History, InspectionError, Mixture, Particles, Posterior, Prior};
use linkwear_gamma::life::{
    Band, Bands, Contribution, ErrorBudget, Estimate, FirstPassage, LifeError, Lifetime, Method, Moments,
    OperatingState, WithError,
};

use super::arguments::{Format, PredictArguments};
use super::failure::Failure;
use super::file::print;
use super::{fit_file, prediction, readings};

/// Probability of every interval.
pub const LEVEL: f64 = 0.95;
/// Times at which reliability is told, from now until all but `TAIL` have failed.
const TIMES: usize = 41;
const TAIL: f64 = 1e-3;

/// Answers `predict`.
pub fn run(arguments: &PredictArguments, format: Format) -> Result<(), Failure> {
    let fit = fit_file::read(&arguments.fit)?;
    let estimate = fit.estimate(&arguments.covariate)?;
    let situation = situation(arguments, &estimate)?;
    let knowledge = Knowledge::gather(arguments, estimate, situation)?;
    let mut answer = knowledge.answer().map_err(|error| asked(arguments, &error))?;
    for (at, (name, value)) in arguments.covariate.iter().enumerate() {
        let join = if at == 0 { " at" } else { "," };
        answer.from.push_str(&format!("{join} {name} = {value}"));
    }
    answer.warnings.splice(0..0, fit.warnings);
    match format {
        Format::Json => print(&prediction::machine(&answer)),
        Format::Text => print(&prediction::human(&answer)),
    }
}

/// Everything that is told about the remaining life.
pub struct Answer {
    /// What it rests on: `fit`, `fit and inspections`, ..
    pub from: String,
    pub current: f64,
    pub threshold: f64,
    /// None where mean and deviation are not finite; a warning says so.
    pub moments: Option<(Moments, Band)>,
    pub whole: Option<Moments>,
    /// 10 %, 50 %, 90 % of the life, with what the parameters leave open.
    pub quantiles: [Band; 3],
    /// Ends of the interval that holds the life with probability [`LEVEL`].
    pub interval: (f64, f64),
    /// Time, reliability with its band, hazard.
    pub course: Vec<(f64, Band, f64)>,
    /// Of the mean.
    pub budget: Option<ErrorBudget>,
    pub warnings: Vec<String>,
}

/// What the law of life is made from.
enum Knowledge {
    Fit { estimate: Estimate, situation: OperatingState, method: Method },
    Exact { posterior: Posterior, situation: OperatingState, from: String },
    Noisy { particles: Particles, situation: OperatingState },
}

fn situation(arguments: &PredictArguments, estimate: &Estimate) -> Result<OperatingState, Failure> {
    let wrong = |error: LifeError| asked(arguments, &error);
    let mut situation = OperatingState::new(arguments.threshold).map_err(wrong)?;
    if let Some(rate) = arguments.rate {
        situation = situation.at_rate(rate).map_err(wrong)?;
    }
    let current = arguments.current.unwrap_or(0.0);
    if current > 0.0 && arguments.at.is_none() && estimate.exponent().is_some() {
        return Err(asked(arguments, &LifeError::ExposureMissing));
    }
    situation.worn(current, arguments.at.unwrap_or(0.0)).map_err(wrong)
}

impl Knowledge {
    fn gather(
        arguments: &PredictArguments,
        estimate: Estimate,
        situation: OperatingState,
    ) -> Result<Self, Failure> {
        let Some(file) = &arguments.inspections else {
            let draws = |count| Method::Draws { count, seed: arguments.seed };
            let method = arguments.draws.map_or(Method::Delta, draws);
            return Ok(Self::Fit { estimate, situation, method });
        };
        // clap asks for both with --inspections.
        let (time, wear) = (arguments.time.as_deref(), arguments.wear.as_deref());
        let found = readings::read(file, time.unwrap_or_default(), wear.unwrap_or_default())?;
        let refused = |error: InspectionError| Failure::Data {
            file: file.clone(),
            line: error.row().and_then(|row| found.lines.get(row - 1)).copied(),
            message: error.to_string(),
            help: String::new(),
        };
        if let Some(gauge) = arguments.gauge {
            let history = History::noisy(found.readings.clone()).map_err(refused)?;
            let effort = Effort { count: arguments.particles as usize, seed: arguments.seed };
            let particles =
                Particles::follow(&history, &estimate, &situation, gauge, effort).map_err(refused)?;
            return Ok(Self::Noisy { particles, situation });
        }
        let history = History::exact(found.readings.clone()).map_err(refused)?;
        let (prior, from) = if arguments.flat_prior {
            (Prior::Flat { power_law: estimate.exponent().is_some() }, "inspections alone")
        } else {
            (Prior::Fit(estimate), "fit and inspections")
        };
        let posterior = Posterior::update(&history, &prior, &situation).map_err(refused)?;
        let last = history.last();
        let exposure = situation.rate() * last.time;
        let situation = situation.worn(last.wear, exposure).map_err(|error| asked(arguments, &error))?;
        Ok(Self::Exact { posterior, situation, from: from.to_owned() })
    }

    fn answer(&self) -> Result<Answer, LifeError> {
        match self {
            Self::Fit { estimate, situation, method } => {
                let life = situation.life(estimate)?;
                let bands = Bands::new(estimate, situation, LEVEL, *method)?;
                let mut answer = common(&life, &mut |ask| match ask {
                    Ask::Mean(_) => bands.mean(),
                    Ask::Quantile(p, _) => bands.quantile(p),
                    Ask::Reliability(t, _) => bands.reliability(t),
                })?;
                (answer.from, answer.current) = ("fit".to_owned(), situation.current());
                answer.threshold = situation.threshold();
                let known = Contribution::None("the fit gives no covariance");
                answer
                    .complete(Contribution::None("closed form"), (!estimate.is_uncertain()).then_some(known));
                Ok(answer)
            }
            Self::Exact { posterior, situation, from } => {
                let mut answer = common(posterior, &mut |ask| ask.of(posterior))?;
                (answer.from, answer.current) = (from.clone(), situation.current());
                answer.threshold = situation.threshold();
                answer.complete(Contribution::None("closed forms, quadrature over parameters"), Some(WITHIN));
                Ok(answer)
            }
            Self::Noisy { particles, situation } => {
                let mut answer = common(particles, &mut |ask| ask.of(particles))?;
                answer.from = "fit and inspections with gauge error".to_owned();
                answer.current = particles.wear().0;
                answer.threshold = situation.threshold();
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
        }
    }
}

/// Uncertainty of the parameters is part of the law itself.
const WITHIN: Contribution = Contribution::None("parameters are integrated over; the law contains them");

/// What is asked of the possible laws, with the answer of the whole.
enum Ask {
    Mean(f64),
    Quantile(f64, f64),
    Reliability(f64, f64),
}

impl Ask {
    fn of(&self, mixture: &dyn Mixture) -> Result<Band, LifeError> {
        match *self {
            // For a steady load the typical time is the mean; for a curved one it is near, at no cost of an integral.
            Self::Mean(value) => mixture.credible(value, LEVEL, &|life: &FirstPassage| Ok(life.typical())),
            Self::Quantile(p, value) => mixture.credible(value, LEVEL, &|life| life.quantile(p)),
            Self::Reliability(t, value) => mixture.credible(value, LEVEL, &|life| Ok(life.reliability(t))),
        }
    }
}

fn common(
    life: &dyn Lifetime,
    band: &mut dyn FnMut(Ask) -> Result<Band, LifeError>,
) -> Result<Answer, LifeError> {
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
    let interval = (life.quantile(0.5 - 0.5 * LEVEL)?, life.quantile(0.5 + 0.5 * LEVEL)?);
    let end = life.quantile(1.0 - TAIL)?;
    let mut course = Vec::with_capacity(TIMES);
    for k in 0..TIMES {
        let t = end * k as f64 / (TIMES - 1) as f64;
        course.push((t, band(Ask::Reliability(t, life.reliability(t)))?, life.hazard(t)));
    }
    let (from, current, threshold) = (String::new(), 0.0, 0.0);
    Ok(Answer {
        from,
        current,
        threshold,
        moments,
        whole,
        quantiles,
        interval,
        course,
        budget: None,
        warnings,
    })
}

impl Answer {
    /// Adds the budget of the mean. `parameters`: None takes the band of the mean.
    fn complete(&mut self, monte_carlo: Contribution, parameters: Option<Contribution>) {
        self.budget = self.moments.map(|(_, band)| ErrorBudget {
            monte_carlo,
            table: Contribution::None("exposure is a formula"),
            parameters: parameters.unwrap_or_else(|| ErrorBudget::parameters(band)),
        });
    }
}

/// A question that has no answer: the numbers on the command line are to blame.
fn asked(arguments: &PredictArguments, error: &LifeError) -> Failure {
    Failure::Data {
        file: arguments.fit.clone(),
        line: None,
        message: error.to_string(),
        help: "see `linkwear predict --help` for what the options mean".to_owned(),
    }
}
