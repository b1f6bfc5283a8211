//! The paper's Table 2 beside ours under one protocol, and that protocol, for scripts. In: [`Lives`] of every
//! definition of wear. Out: [`Table2`], [`ShownProtocol`]. Never computes lives.

use serde::Serialize;

use super::learn::{HISTORIES, Protocol};
use super::lives::{Lives, Prediction, SHOWN};
use super::options::Options;
use super::paper::{Printed, TABLE_2};
use super::statistics::LifeNumbers;

/// Table 2: ours under [`ShownProtocol`], and the paper's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table2 {
    /// The finest own model.
    pub truth: LifeNumbers,
    /// Flexible coupler, feedback.
    pub proposed: Row,
    /// Rigid coupler.
    pub baseline_1: Row,
    /// No feedback.
    pub baseline_2: Row,
    /// What the paper prints, in the order of [`super::MODELS`].
    pub paper: [Printed; 3],
}

/// A column of Table 2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Mean life [cycles], mean over the data sets.
    pub mean: f64,
    /// Standard deviation [cycles], mean over the data sets.
    pub std: f64,
    /// Standard deviation over mean, mean over the data sets.
    pub cov: f64,
    /// Mean life over that of the truth, less one, mean over the data sets.
    pub error: f64,
    /// Its standard deviation over the data sets.
    pub error_scatter: f64,
    /// Mean of whole cycles [cycles].
    pub mean_whole: f64,
}

/// How the numbers of [`Table2`] come about; all other protocols are in `lives`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShownProtocol {
    /// What W is.
    pub wear: &'static str,
    /// Model of the contact area.
    pub area: &'static str,
    /// Growth of the clearance per W.
    pub gamma: f64,
    /// Cycles that models are fitted to.
    pub fitted_on: Protocol,
    /// Histories in a data set.
    pub histories: u64,
    /// Data sets.
    pub data_sets: usize,
    /// Revolutions that a cycle stands for.
    pub revolutions_per_cycle: f64,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl From<&Prediction> for Row {
    fn from(found: &Prediction) -> Self {
        let LifeNumbers { mean, std, cov, mean_whole, .. } = found.lives;
        Self { mean, std, cov, error: found.error, error_scatter: found.error_scatter, mean_whole }
    }
}

/// The table and its protocol: the first definition of wear, fitted on what Fig. 6 shows.
pub(super) fn table2(shown: &Lives, options: Options) -> (Table2, ShownProtocol) {
    let [proposed, baseline_1, baseline_2] = shown.under(SHOWN).each_ref().map(Row::from);
    let protocol = ShownProtocol {
        wear: shown.wear,
        area: "hertz",
        gamma: shown.gamma,
        fitted_on: SHOWN,
        histories: HISTORIES,
        data_sets: shown.data_sets,
        revolutions_per_cycle: shown.revolutions_per_cycle,
        seed: options.seed,
    };
    (Table2 { truth: shown.truth, proposed, baseline_1, baseline_2, paper: TABLE_2 }, protocol)
}
