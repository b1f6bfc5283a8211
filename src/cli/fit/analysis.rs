//! A fit and what is known about it. In: observations. Out: estimates, intervals, goodness of fit, other processes. Never
//! knows how it is printed.

use linkwear_gamma::FitFile;
use linkwear_gamma::data::{Known, Observations, Rounding};
use linkwear_gamma::fit::{
    Bootstrap, Fit, FitError, Goodness, Heterogeneity, Interval, Model, estimate, estimate_units, goodness,
    interval as interval_of,
};
use linkwear_gamma::process::{PROCESSES, Process};

use super::super::arguments::FitArguments;

/// Level of the intervals printed.
pub const LEVEL: f64 = 0.95;

/// One fit and what is known about it.
pub struct Analysis {
    pub name: String,
    pub fit: Fit,
    /// How many increments are bounds of wear.
    pub bounds: usize,
    /// Whether units entered below a limit and are followed from their entry on only.
    pub enter_unseen: bool,
    pub file: FitFile,
    /// None where one could not be found.
    pub intervals: Vec<Option<Interval>>,
    pub goodness: Goodness,
    pub bootstrap: Option<Bootstrap>,
    /// Whether units differ, if that is asked for.
    pub units: Option<Heterogeneity>,
    /// The other processes, if they are asked for.
    pub alternatives: Vec<(&'static dyn Process, Result<Fit, FitError>)>,
    /// Every process with units alike and with units that differ, if they are asked for.
    pub compared: Vec<Compared>,
    /// Comments of the file that look like rows, where all readings are fitted.
    pub comments_like_rows: usize,
    /// Names of units in several groups, where all readings are fitted.
    pub shared: Vec<String>,
    /// Bias of the process's parameters to first order in 1/n, where theory has it.
    pub bias: Option<[f64; 2]>,
}

/// Whether a process takes readings as exact although their gauge rounds them: its likelihood is of other data than that of the
/// process at hand, which takes them as rounded.
pub fn takes_as_exact(process: &dyn Process, fit: &Fit) -> bool {
    fit.model.resolution.is_some() && process != fit.model.process
}

/// A process, with units that differ or without, beside others.
pub struct Compared {
    pub process: &'static dyn Process,
    pub random: bool,
    pub found: Result<Criteria, FitError>,
}

/// How well it describes the data, and at what price.
pub struct Criteria {
    pub log_likelihood: f64,
    pub aic: f64,
    pub bic: f64,
    /// Whether no difference between units was found.
    pub boundary: bool,
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
        sizes: arguments.covariate_of_size.len(),
        resolution: rounding(arguments),
        units_differ: arguments.random_effects,
    }
}

impl Analysis {
    /// Of a group of readings, or of all; `drawn` gives the replicates of its fit, if there are any.
    pub fn new(
        arguments: &FitArguments,
        name: &str,
        (data, last): (&Observations, &[f64]),
        drawn: impl FnOnce(&Fit) -> Option<Bootstrap>,
    ) -> Result<Self, FitError> {
        let model = model(arguments);
        let units = arguments.random_effects.then(|| estimate_units(data, &model)).transpose()?;
        let fit = match &units {
            Some(found) => found.fit.clone(),
            None => estimate(data, &model)?,
        };
        let clock = match (&arguments.lambda, &arguments.exposure) {
            (Some(lambda), Some(_)) => format!("Lambda of {lambda}"),
            (Some(clock), None) | (None, Some(clock)) => clock.clone(),
            (None, None) => String::new(),
        };
        let over_lambda = arguments.lambda.is_some();
        let covariates: Vec<String> = arguments.covariates().cloned().collect();
        let file = FitFile::new(&fit, data, &covariates, (&arguments.wear, &clock), over_lambda);
        let file = match &units {
            Some(found) => file.with_units(found, last, data),
            None => file,
        };
        let others = PROCESSES.into_iter().filter(|process| *process != fit.model.process);
        let alternative = |process| {
            (process, estimate(data, &Model { process, resolution: None, units_differ: false, ..model }))
        };
        let alternatives = if arguments.compare { others.map(alternative).collect() } else { Vec::new() };
        let compared = if arguments.compare { compared(data, &fit, units.as_ref()) } else { Vec::new() };
        let of_units = fit.cv().map(|_| fit.parameters().len() - 1);
        let interval = |at| match &units {
            Some(found) if Some(at) == of_units => found.cv_interval(data, LEVEL).ok(),
            _ => interval_of(&fit, data, at, LEVEL).ok(),
        };
        Ok(Self {
            name: name.to_owned(),
            bounds: data.increments.iter().filter(|one| one.is_growth() && !one.is_plain()).count(),
            enter_unseen: data.increments.iter().any(|one| one.known == Known::Entered { from_new: false }),
            intervals: (0..fit.parameters().len()).map(interval).collect(),
            goodness: goodness(&fit, &data.increments, arguments.seed),
            bootstrap: drawn(&fit),
            alternatives,
            compared,
            comments_like_rows: 0,
            shared: Vec::new(),
            bias: fit.first_order_bias(data),
            file,
            fit,
            units,
        })
    }

    /// Akaike's criterion of the model asked for.
    pub fn aic(&self) -> f64 {
        self.units.as_ref().map_or_else(|| self.fit.aic(), Heterogeneity::aic)
    }

    /// Schwarz's criterion of the model asked for.
    pub fn bic(&self) -> f64 {
        self.units.as_ref().map_or_else(|| self.fit.bic(), Heterogeneity::bic)
    }
}

impl Criteria {
    fn of(fit: &Fit) -> Self {
        Self { log_likelihood: fit.log_likelihood, aic: fit.aic(), bic: fit.bic(), boundary: false }
    }

    fn of_units(found: &Heterogeneity) -> Self {
        let log_likelihood = found.fit.log_likelihood;
        Self { log_likelihood, aic: found.aic(), bic: found.bic(), boundary: found.boundary }
    }
}

/// Every process with units alike, and, of several units, with units that differ; readings with a gauge's step by the process at hand,
/// whose fits are known.
fn compared(data: &Observations, fit: &Fit, units: Option<&Heterogeneity>) -> Vec<Compared> {
    let own = fit.model;
    let rows = PROCESSES.into_iter().flat_map(|process| [(process, false), (process, true)]);
    let takes = |process| own.resolution.is_none() || process == own.process;
    let rows = rows.filter(|(process, random)| !random || (data.units.len() > 1 && takes(*process)));
    let row = |(process, random): (&'static dyn Process, bool)| {
        // The process at hand alone takes readings as rounded.
        let is_own = process == own.process;
        let resolution = own.resolution.filter(|_| is_own);
        let model = Model { process, resolution, units_differ: false, ..own };
        let found = match (random, units) {
            (true, Some(found)) if is_own => Ok(Criteria::of_units(found)),
            (true, _) => estimate_units(data, &model).map(|found| Criteria::of_units(&found)),
            (false, Some(found)) if is_own => Ok(Criteria::of(&found.plain)),
            (false, None) if is_own => Ok(Criteria::of(fit)),
            (false, _) => estimate(data, &model).map(|fit| Criteria::of(&fit)),
        };
        Compared { process, random, found }
    };
    rows.map(row).collect()
}
