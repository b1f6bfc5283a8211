//! Fig. 6 and Table 2: remaining useful life by three models that learn from the same histories of wear. In: tables of
//! what a revolution wears. Out: [`Lives`]. Never knows how it is drawn.
//!
//! The truth is the finest own model: its wear increments are drawn cycle by cycle, each from the clearance that the
//! wear before has opened. Every model fits the Gamma process to the same histories with its own dLambda, then draws
//! lives from its own fit. One calibration of the cycle, on the truth, serves all models.

use std::ops::ControlFlow;

use linkwear_gamma::monte_carlo::MICRO;
use linkwear_runtime::life::WearOf;
use serde::Serialize;

use super::error::StudyError;
use super::learn::{Bearing, Learnt, PROTOCOLS, Protocol, Purpose};
use super::model::JOINT;
use super::options::{Effort, Options};
use super::rate::Curve;
use super::statistics::{Density, LifeNumbers, mean_and_scatter};
use super::tables::{DEEPEST, Tables};
use super::workers::Workers;

/// Names of the models, in the order of all results.
pub const MODELS: [&str; 3] = ["proposed", "baseline 1 (rigid)", "baseline 2 (no feedback)"];
/// The densities of Fig. 6 are those of this protocol: a prediction made while the joint still lives.
pub const SHOWN: Protocol = Protocol::First20;

/// A model under one protocol.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// Which of [`MODELS`].
    pub model: &'static str,
    /// Fitted shape per wear [1/µm], mean over the data sets.
    pub alpha: f64,
    /// Fitted rate [1/µm], mean over the data sets.
    pub beta: f64,
    /// Predicted lives, means over the data sets.
    pub lives: LifeNumbers,
    /// Predicted mean life over that of the truth, less one: mean of the data sets.
    pub error: f64,
    /// The same: standard deviation over data sets.
    pub error_scatter: f64,
    /// Coefficient of variation of predicted lives: standard deviation over data sets.
    pub cov_scatter: f64,
    /// Part of the data sets whose mean life is predicted too long.
    pub over_predicts: f64,
}

/// How often the orderings of the paper are found, as parts of the data sets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Orderings {
    /// The proposed model has the smallest error of the mean.
    pub proposed_is_nearest: f64,
    /// The proposed model has the smallest coefficient of variation.
    pub proposed_is_narrowest: f64,
    /// Both baselines predict longer lives than the truth has.
    pub baselines_over_predict: f64,
    /// Baseline 1 predicts a longer life than the other models.
    pub rigid_is_longest: f64,
    /// All of them at once.
    pub all: f64,
}

/// All models under one protocol.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnderProtocol {
    /// Which.
    pub protocol: Protocol,
    /// In the order of [`MODELS`].
    pub predictions: [Prediction; 3],
    /// Over the data sets.
    pub orderings: Orderings,
}

/// One definition of wear, with its calibration.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lives {
    /// What W is: "depth" by the Hertz area, or "largest depth" around the bearing.
    pub wear: &'static str,
    /// Growth of the clearance per W.
    pub gamma: f64,
    /// Revolutions per cycle with which the deterministic truth lives 25.1 cycles.
    pub revolutions_per_cycle: f64,
    /// Lives of the truth.
    pub truth: LifeNumbers,
    /// Deterministic lives with this cycle, without any fit [cycles], in the order of [`MODELS`].
    pub deterministic: [f64; 3],
    /// dLambda of each model over that of the truth, at the start and at the end of the life.
    pub ratio: [(f64, f64); 3],
    /// Exponent of the growth of the truth's dLambda with the clearance over the life.
    pub exponent: f64,
    /// Data sets.
    pub data_sets: usize,
    /// By protocol.
    pub protocols: [UnderProtocol; 4],
    /// Probability densities of life under [`SHOWN`], from the first data set: truth, then [`MODELS`].
    pub densities: Vec<Density>,
}

impl Lives {
    /// What the models predict under a protocol, in the order of [`MODELS`].
    pub fn under(&self, protocol: Protocol) -> &[Prediction; 3] {
        &self.protocols[protocol as usize].predictions
    }
}

/// The definitions of wear that are studied.
pub(super) const DEFINITIONS: [(&str, WearOf); 2] = [("depth", WearOf::Depth), ("largest depth", DEEPEST)];

/// Predicts lives under every protocol.
pub(super) fn lives(
    tables: &Tables<'_>,
    (wear, definition): (&'static str, WearOf),
    (options, effort): (Options, &Effort),
    workers: &Workers<'_>,
) -> Result<Lives, StudyError> {
    let no_rates = || StudyError::Missing { kind: "scatter of wear of joint", name: JOINT.into() };
    let rates = tables.rates().ok_or_else(no_rates)?;
    let revolutions_per_cycle = tables.revolutions_per_cycle(definition)?;
    let cycle = |measured, feedback| {
        Curve::of_revolution(measured, definition, feedback).of_cycle(revolutions_per_cycle)
    };
    let end = tables.finest.threshold();
    let bearing = Bearing {
        threshold: end,
        rates,
        truth: cycle(tables.finest, true),
        models: [cycle(tables.flexible, true), cycle(tables.rigid, true), cycle(tables.flexible, false)],
        seed: options.seed,
    };
    let lived = bearing.lives(&bearing.truth, rates, Purpose::Truth, 0..effort.trajectories);
    let truth = LifeNumbers::of(&lived);
    let sets: Vec<u64> = (0..effort.data_sets).collect();
    let learnt = workers.each(&sets, |set| {
        workers.piece(effort.work_of_data_set, |watch| match watch.report(0.0) {
            ControlFlow::Continue(()) => bearing.data_set(*set, effort.trajectories_per_set),
            ControlFlow::Break(()) => Err(StudyError::Interrupted),
        })
    })?;
    let mut densities = vec![Density::of(&lived)];
    for (model, first) in bearing.models.iter().zip(&learnt[0][SHOWN as usize]) {
        let lives = bearing.lives(model, first.rates, Purpose::Prediction, 0..effort.trajectories);
        densities.push(Density::of(&lives));
    }
    let growth = bearing.truth.at(end) / bearing.truth.at(0.0);
    let ratio = |model: &Curve, wear: f64| model.at(wear) / bearing.truth.at(wear);
    Ok(Lives {
        wear,
        gamma: tables.gamma(),
        revolutions_per_cycle,
        truth,
        deterministic: bearing.models.each_ref().map(|model| bearing.mean_life(model)),
        ratio: bearing.models.each_ref().map(|model| (ratio(model, 0.0), ratio(model, end))),
        exponent: libm::log(growth) / libm::log(tables.finest.opening()),
        data_sets: learnt.len(),
        protocols: PROTOCOLS.map(|protocol| under(protocol, &learnt, &truth)),
        densities,
    })
}

/// `learnt`: by data set, by protocol, by model.
fn under(protocol: Protocol, learnt: &[Vec<Vec<Learnt>>], truth: &LifeNumbers) -> UnderProtocol {
    let sets: Vec<&[Learnt]> = learnt.iter().map(|set| set[protocol as usize].as_slice()).collect();
    let predictions = [0, 1, 2].map(|model| prediction(model, &sets, truth));
    UnderProtocol { protocol, predictions, orderings: orderings(&sets, truth) }
}

fn prediction(model: usize, sets: &[&[Learnt]], truth: &LifeNumbers) -> Prediction {
    let of = |number: fn(&Learnt) -> f64| mean_and_scatter(sets.iter().map(|set| number(&set[model])));
    let errors = || sets.iter().map(|set| error(&set[model].lives, truth));
    let (mean_error, error_scatter) = mean_and_scatter(errors());
    let (cov, cov_scatter) = of(|learnt| learnt.lives.cov);
    Prediction {
        model: MODELS[model],
        alpha: MICRO * of(|learnt| learnt.rates.alpha).0,
        beta: MICRO * of(|learnt| learnt.rates.beta).0,
        lives: LifeNumbers {
            mean: of(|learnt| learnt.lives.mean).0,
            std: of(|learnt| learnt.lives.std).0,
            cov,
            mean_whole: of(|learnt| learnt.lives.mean_whole).0,
            cov_whole: of(|learnt| learnt.lives.cov_whole).0,
        },
        error: mean_error,
        error_scatter,
        cov_scatter,
        over_predicts: errors().filter(|error| *error > 0.0).count() as f64 / sets.len() as f64,
    }
}

fn error(life: &LifeNumbers, truth: &LifeNumbers) -> f64 {
    life.mean / truth.mean - 1.0
}

fn orderings(sets: &[&[Learnt]], truth: &LifeNumbers) -> Orderings {
    let error = |learnt: &Learnt| error(&learnt.lives, truth);
    let part = |holds: &dyn Fn(&&[Learnt]) -> bool| {
        sets.iter().filter(|set| holds(set)).count() as f64 / sets.len() as f64
    };
    let nearest = |set: &&[Learnt]| set[1..].iter().all(|other| error(&set[0]).abs() < error(other).abs());
    let narrowest = |set: &&[Learnt]| set[1..].iter().all(|other| set[0].lives.cov < other.lives.cov);
    let longer = |set: &&[Learnt]| set[1..].iter().all(|other| error(other) > 0.0);
    let longest = |set: &&[Learnt]| set[1].lives.mean > set[0].lives.mean.max(set[2].lives.mean);
    Orderings {
        proposed_is_nearest: part(&nearest),
        proposed_is_narrowest: part(&narrowest),
        baselines_over_predict: part(&longer),
        rigid_is_longest: part(&longest),
        all: part(&|set| nearest(set) && narrowest(set) && longer(set) && longest(set)),
    }
}
