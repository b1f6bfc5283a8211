//! Fig. 6 and Table 2: remaining useful life by three models that learn from the same histories of wear. In: tables of
//! what a revolution wears. Out: [`Lives`]. Never knows how it is drawn.
//!
//! The truth is the finest own model: its wear increments are drawn cycle by cycle, each from the clearance that the
//! wear before has opened. Every model fits the Gamma process to the same histories with its own dLambda, then draws
//! lives from its own fit. One calibration of the cycle, on the truth, serves all models.

use linkwear_gamma::monte_carlo::MICRO;
use linkwear_runtime::life::WearOf;
use linkwear_runtime::wear::Measure;
use serde::Serialize;

use super::error::StudyError;
use super::job_pool::{Job, run_all};
use super::learn::{Bearing, Learnt, PROTOCOLS, Protocol, Purpose};
use super::options::Effort;
use super::progress::Progress;
use super::rate::{Cycle, Rate};
use super::statistics::{Density, LifeNumbers, mean_and_scatter};
use super::tables::{Definition, Tables};

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
    pub predictions: Vec<Prediction>,
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
    pub deterministic: Vec<f64>,
    /// dLambda of each model over that of the truth, at the start and at the end of the life.
    pub ratio: Vec<(f64, f64)>,
    /// Exponent of the growth of the truth's dLambda with the clearance over the life.
    pub exponent: f64,
    /// Data sets.
    pub data_sets: usize,
    /// By protocol.
    pub protocols: Vec<UnderProtocol>,
    /// Probability densities of life under [`SHOWN`], from the first data set: truth, then [`MODELS`].
    pub densities: Vec<Density>,
}

impl Lives {
    /// What came out under a protocol.
    pub fn under(&self, protocol: Protocol) -> Option<&UnderProtocol> {
        self.protocols.iter().find(|under| under.protocol == protocol)
    }
}

/// The definitions of wear that are studied.
pub(super) fn definitions(gamma: f64) -> [(&'static str, Definition); 2] {
    [
        ("depth", Definition { wear: WearOf::Depth, gamma }),
        ("largest depth", Definition { wear: WearOf::Profile(Measure::Maximum), gamma }),
    ]
}

/// By data set, by protocol, by model.
type AllLearnt = Vec<Vec<Vec<Learnt>>>;

/// Predicts lives under every protocol.
pub(super) fn lives(
    tables: &Tables,
    (wear, definition): (&'static str, Definition),
    (threads, seed): (usize, u64),
    effort: &Effort,
    progress: &Progress<'_>,
) -> Result<Lives, StudyError> {
    let (bearing, revolutions_per_cycle) = bearing(tables, definition, seed, effort)?;
    let lived = bearing.lives(&bearing.truth, bearing.rates, Purpose::Truth, 0..effort.trajectories);
    let truth = LifeNumbers::of(&lived);
    let learnt = learn(&bearing, threads, effort, progress)?;
    let protocols = PROTOCOLS.iter().enumerate();
    let protocols = protocols.map(|(at, protocol)| under(*protocol, at, &learnt, &truth)).collect();
    let mut densities = vec![Density::of(&lived)];
    let shown = PROTOCOLS.iter().position(|protocol| *protocol == SHOWN).unwrap_or(0);
    for (cycle, first) in bearing.models.iter().zip(&learnt[0][shown]) {
        let lives = bearing.lives(cycle, first.rates, Purpose::Prediction, 0..effort.trajectories);
        densities.push(Density::of(&lives));
    }
    let end = bearing.threshold;
    let opened = 1.0 + definition.gamma * end / tables.clearance();
    let growth = bearing.truth.mean_increment(end) / bearing.truth.mean_increment(0.0);
    let ratio = |cycle: &Cycle, wear: f64| cycle.mean_increment(wear) / bearing.truth.mean_increment(wear);
    Ok(Lives {
        wear,
        gamma: definition.gamma,
        revolutions_per_cycle,
        truth,
        deterministic: bearing.models.iter().map(|cycle| cycle.mean_life(end)).collect(),
        ratio: bearing.models.iter().map(|cycle| (ratio(cycle, 0.0), ratio(cycle, end))).collect(),
        exponent: libm::log(growth) / libm::log(opened),
        data_sets: learnt.len(),
        protocols,
        densities,
    })
}

/// The joint with this definition of wear, and the revolutions that a cycle stands for.
fn bearing(
    tables: &Tables,
    definition: Definition,
    seed: u64,
    effort: &Effort,
) -> Result<(Bearing, f64), StudyError> {
    let no_rates =
        || StudyError::Missing { kind: "scatter of wear of joint", name: super::model::JOINT.into() };
    let rates = tables.rates().ok_or_else(no_rates)?;
    let revolutions = tables.revolutions_per_cycle(definition, effort)?;
    let threshold = tables.threshold();
    let cycle = |measured, definition| Rate::of(measured, definition, threshold).cycle(revolutions);
    let constant = Definition { gamma: 0.0, ..definition };
    let models = [
        cycle(&tables.flexible, definition),
        cycle(&tables.rigid, definition),
        cycle(&tables.flexible, constant),
    ];
    let truth = cycle(&tables.finest, definition);
    Ok((Bearing { threshold, rates, truth, models, seed }, revolutions))
}

fn learn(
    bearing: &Bearing,
    threads: usize,
    effort: &Effort,
    progress: &Progress<'_>,
) -> Result<AllLearnt, StudyError> {
    let jobs = (0..effort.data_sets).map(|set| {
        let job = move || {
            if progress.go_on().is_break() {
                return Err(StudyError::Interrupted);
            }
            let learnt = bearing.data_set(set, effort.trajectories_per_set);
            progress.done(effort.work_of_data_set);
            learnt
        };
        Box::new(job) as Job<'_, Result<Vec<Vec<Learnt>>, StudyError>>
    });
    run_all(threads, jobs.collect()).into_iter().collect()
}

fn under(protocol: Protocol, at: usize, learnt: &AllLearnt, truth: &LifeNumbers) -> UnderProtocol {
    let sets: Vec<&[Learnt]> = learnt.iter().map(|set| set[at].as_slice()).collect();
    let predictions = (0..MODELS.len()).map(|model| prediction(model, &sets, truth)).collect();
    UnderProtocol { protocol, predictions, orderings: orderings(&sets, truth) }
}

fn prediction(model: usize, sets: &[&[Learnt]], truth: &LifeNumbers) -> Prediction {
    let all: Vec<Learnt> = sets.iter().map(|set| set[model]).collect();
    let lives: Vec<LifeNumbers> = all.iter().map(|learnt| learnt.lives).collect();
    let mean_of = |of: fn(&Learnt) -> f64| mean_and_scatter(all.iter().map(of)).0;
    let errors = || lives.iter().map(|life| error(life, truth));
    let (mean_error, error_scatter) = mean_and_scatter(errors());
    Prediction {
        model: MODELS[model],
        alpha: MICRO * mean_of(|learnt| learnt.rates.alpha),
        beta: MICRO * mean_of(|learnt| learnt.rates.beta),
        lives: LifeNumbers::typical(&lives),
        error: mean_error,
        error_scatter,
        cov_scatter: mean_and_scatter(lives.iter().map(|life| life.cov)).1,
        over_predicts: errors().filter(|error| *error > 0.0).count() as f64 / all.len() as f64,
    }
}

fn error(life: &LifeNumbers, truth: &LifeNumbers) -> f64 {
    life.mean / truth.mean - 1.0
}

fn orderings(sets: &[&[Learnt]], truth: &LifeNumbers) -> Orderings {
    let part = |holds: &dyn Fn(&[LifeNumbers; 3]) -> bool| {
        let lives = sets.iter().map(|set| [set[0].lives, set[1].lives, set[2].lives]);
        lives.filter(holds).count() as f64 / sets.len() as f64
    };
    let error = |life: &LifeNumbers| error(life, truth);
    let nearest =
        |lives: &[LifeNumbers; 3]| lives[1..].iter().all(|life| error(&lives[0]).abs() < error(life).abs());
    let narrowest = |lives: &[LifeNumbers; 3]| lives[1..].iter().all(|life| lives[0].cov < life.cov);
    let longer = |lives: &[LifeNumbers; 3]| lives[1..].iter().all(|life| error(life) > 0.0);
    let longest = |lives: &[LifeNumbers; 3]| lives[1].mean > lives[0].mean.max(lives[2].mean);
    Orderings {
        proposed_is_nearest: part(&nearest),
        proposed_is_narrowest: part(&narrowest),
        baselines_over_predict: part(&longer),
        rigid_is_longest: part(&longest),
        all: part(&|lives| nearest(lives) && narrowest(lives) && longer(lives) && longest(lives)),
    }
}
