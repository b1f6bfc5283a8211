//! From inspections to a plan. In: readings one after the other. Out: remaining life with its spread, and what to do.

use std::error::Error;
use std::fmt;

use linkwear_gamma::inspection::{History, Posterior, Prior, Reading};
use linkwear_gamma::life::{Estimate, Lifetime, OperatingState};
use linkwear_gamma::process::Gamma;

use crate::exposure::Exposure;

/// What is known of the scatter and of the rate before any reading: standard deviations of their logarithms. The rate of
/// wear of a bearing is rarely known better than to some twenty percent, its scatter hardly at all.
const SCATTER_OPEN: f64 = 0.7;
const RATE_OPEN: f64 = 0.2;

/// A reading.
#[derive(Clone, Copy)]
pub struct Inspection {
    /// Cycles since the joint was new.
    pub cycle: f64,
    /// Wear [m].
    pub wear: f64,
}

/// The joint as it is known by now.
pub struct Twin {
    pub exposure: Exposure,
    pub inspections: Vec<Inspection>,
    prior: Prior,
    /// The same with the model's exposure since the joint was new in place of cycles.
    readings: Vec<Reading>,
}

/// What follows from the last reading.
pub struct Plan {
    pub now: Inspection,
    /// Rate of wear beside the model's.
    pub rate: f64,
    /// Cycles left: 10 %, 50 %, 90 % of such joints have failed then.
    pub left: [f64; 3],
}

impl Twin {
    pub fn new(exposure: Exposure) -> Result<Self, Box<dyn Error>> {
        let rates = [exposure.scatter.alpha, exposure.scatter.beta];
        // The rate is alpha/beta: what both have in common is the scatter, what they have apart the rate.
        let (common, apart) = (SCATTER_OPEN * SCATTER_OPEN, 0.5 * RATE_OPEN * RATE_OPEN);
        let open = [vec![common + apart, common], vec![common, common + apart]];
        let estimate = Estimate::new(&Gamma, rates, None)?.with_log_covariance(&open)?;
        let new = Inspection { cycle: 0.0, wear: 0.0 };
        let readings = vec![Reading { time: 0.0, wear: 0.0 }];
        Ok(Self { exposure, inspections: vec![new], prior: Prior::Fit(estimate), readings })
    }

    /// Takes in a reading.
    pub fn inspected(&mut self, now: Inspection) -> Result<Plan, Box<dyn Error>> {
        let (before, last) =
            (self.inspections[self.inspections.len() - 1], self.readings[self.readings.len() - 1]);
        if now.cycle <= before.cycle {
            return Err(format!("cycle {} is not later than cycle {}", now.cycle, before.cycle).into());
        }
        if now.wear >= self.exposure.threshold {
            return Err(format!("worn by {:.1} um: the joint has failed", 1e6 * now.wear).into());
        }
        let gone = self.exposure.of(before.wear, now.cycle - before.cycle);
        let readings: Vec<Reading> = self
            .readings
            .iter()
            .copied()
            .chain([Reading { time: last.time + gone, wear: now.wear }])
            .collect();
        let history = History::exact(&Gamma, readings.clone())?;
        let state = OperatingState::new(self.exposure.threshold)?;
        let posterior = Posterior::update(&history, &self.prior, &state)?;
        // A life in exposure ends at the threshold. The model's own path from here to there says how many cycles that is.
        let to_go = self.exposure.threshold - now.wear;
        let per_exposure = self.exposure.cycles(now.wear, self.exposure.threshold) / to_go;
        let left = |p: f64| posterior.quantile(p).map(|exposure| exposure * per_exposure);
        let parameters = posterior.parameters();
        let rate = (parameters[0].mean - parameters[1].mean).exp();
        let plan = Plan { now, rate, left: [left(0.1)?, left(0.5)?, left(0.9)?] };
        self.inspections.push(now);
        self.readings = readings;
        Ok(plan)
    }
}

impl Plan {
    /// Cycle at which one in ten such joints has failed: replaced until then.
    pub fn replace_by(&self) -> f64 {
        self.now.cycle + self.left[0]
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [early, median, late] = self.left;
        write!(out, "{:5}  {:9.2}  {:12.3}  ", self.now.cycle, 1e6 * self.now.wear, self.rate)?;
        write!(out, "{early:8.2}  {median:11.2}  {late:8.2}  ")?;
        // Half of the safe time is left for what the next reading may show.
        match 0.5 * early {
            wait if wait >= 1.0 => {
                let inspect = self.now.cycle + wait.floor();
                write!(out, "inspect at {inspect}, replace by {:.1}", self.replace_by())
            }
            _ => write!(out, "replace by {:.1}: no further inspection pays", self.replace_by()),
        }
    }
}
