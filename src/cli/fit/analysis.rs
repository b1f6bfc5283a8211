//! A fit and what is known about it. In: observations. Out: estimates, intervals, goodness of fit, other processes. Never
//! knows how it is printed.

use linkwear_gamma::FitFile;
use linkwear_gamma::data::{Observations, Rounding};
use linkwear_gamma::fit::{
    Bootstrap, Fit, FitError, Goodness, Interval, Model, estimate, goodness, profile_interval,
};
use linkwear_gamma::process::{PROCESSES, Process};

use super::super::arguments::FitArguments;

/// Level of the intervals printed.
pub const LEVEL: f64 = 0.95;

/// One fit and what is known about it.
pub struct Analysis {
    pub name: String,
    pub fit: Fit,
    pub file: FitFile,
    /// None where the likelihood does not fall far enough.
    pub intervals: Vec<Option<Interval>>,
    pub goodness: Goodness,
    pub bootstrap: Option<Bootstrap>,
    /// The other processes, if they are asked for.
    pub alternatives: Vec<(&'static dyn Process, Result<Fit, FitError>)>,
    /// Bias of the process's parameters to first order in 1/n, where theory has it.
    pub bias: Option<[f64; 2]>,
}

/// How the gauge rounds, if it does.
pub fn rounding(arguments: &FitArguments) -> Option<Rounding> {
    let error = arguments.gauge.unwrap_or(0.0);
    arguments.resolution.map(|step| Rounding { step, error })
}

/// What is estimated.
pub fn model(arguments: &FitArguments) -> Model {
    Model {
        process: arguments.process,
        power_law: arguments.power_law,
        covariates: arguments.covariate.len(),
        resolution: rounding(arguments),
    }
}

impl Analysis {
    /// Of a group of readings, or of all; `drawn` gives the replicates of its fit, if there are any.
    pub fn new(
        arguments: &FitArguments,
        name: &str,
        data: &Observations,
        drawn: impl FnOnce(&Fit) -> Option<Bootstrap>,
    ) -> Result<Self, FitError> {
        let fit = estimate(data, &model(arguments))?;
        let clock = match (&arguments.lambda, &arguments.exposure) {
            (Some(lambda), Some(_)) => format!("Lambda of {lambda}"),
            (Some(clock), None) | (None, Some(clock)) => clock.clone(),
            (None, None) => String::new(),
        };
        let over_lambda = arguments.lambda.is_some();
        let file = FitFile::new(&fit, data, &arguments.covariate, (&arguments.wear, &clock), over_lambda);
        let others = PROCESSES.into_iter().filter(|process| *process != fit.model.process);
        let alternative =
            |process| (process, estimate(data, &Model { process, resolution: None, ..fit.model }));
        let alternatives = if arguments.compare { others.map(alternative).collect() } else { Vec::new() };
        let interval = |at| profile_interval(&fit, data, at, LEVEL).ok();
        Ok(Self {
            name: name.to_owned(),
            intervals: (0..fit.parameters().len()).map(interval).collect(),
            goodness: goodness(&fit, &data.increments, arguments.seed),
            bootstrap: drawn(&fit),
            alternatives,
            bias: fit.first_order_bias(data),
            file,
            fit,
        })
    }
}
