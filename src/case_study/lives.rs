//! Fig. 6 and Table 2: remaining useful life by three models that learn from the same histories of wear. In: tables of
//! what a revolution wears. Out: [`Lives`]. Never knows how it is drawn.
//!
//! The truth is the finest own model: its wear increments are drawn cycle by cycle, each from the clearance that the
//! wear before has opened. Every model fits the Gamma process to the same histories with its own dLambda, then draws
//! lives from its own fit. One calibration of the cycle, on the truth, serves all models.

use linkwear_gamma::coupled::GammaDraw;
use linkwear_gamma::data::{Increment, Observations};
use linkwear_gamma::fit::{Model as GammaModel, estimate};
use linkwear_runtime::GammaRates;
use linkwear_runtime::life::{IncrementDraw, WearOf, calibrate};
use linkwear_runtime::wear::Measure;
use serde::Serialize;

use super::around::{CALIBRATED, TRUE_LIFE};
use super::error::StudyError;
use super::options::Effort;
use super::rate::{Cycle, Rate};
use super::tables::{Definition, Tables};
use super::watch::{Job, Watch, run_all};

/// Histories in a data set, the paper's M (it gives no number).
pub const HISTORIES: u64 = 20;
/// Names of the models, in the order of all results.
pub const MODELS: [&str; 3] = ["proposed", "baseline 1 (rigid)", "baseline 2 (no feedback)"];
/// Wear in the Gamma layer is counted in micrometres.
const MICRO: f64 = 1e-6;
/// A table reaches this far, in thresholds: the last cycle of a life begins before.
const REACH: f64 = 1.0;

/// What random numbers are drawn for.
const FOR_HISTORIES: usize = 0;
const FOR_TRUTH: usize = 1;
const FOR_PREDICTION: usize = 2;

/// Which increments a model is fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Protocol {
    /// All until failure.
    All,
    /// The first ten cycles.
    First10,
    /// The first twenty cycles.
    First20,
    /// No fit: every model has the parameters of the truth.
    Shared,
}

/// All protocols, in the order of all results.
pub const PROTOCOLS: [Protocol; 4] = [Protocol::All, Protocol::First20, Protocol::First10, Protocol::Shared];

/// Lives drawn from one model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LifeNumbers {
    /// Mean [cycles], threshold interpolated within the cycle.
    pub mean: f64,
    /// Standard deviation [cycles].
    pub std: f64,
    /// Standard deviation over mean.
    pub cov: f64,
    /// Mean of whole cycles, as an inspection after every cycle counts [cycles].
    pub mean_whole: f64,
}

/// A model under one protocol.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// Which of [`MODELS`].
    pub model: &'static str,
    /// Fitted shape per wear [1/µm], mean over the data sets.
    pub alpha: f64,
    /// Fitted rate [1/µm], mean over the data sets.
    pub beta: f64,
    /// Lives predicted from the first data set.
    pub first: LifeNumbers,
    /// Predicted mean life of every data set over that of the truth, less one: mean of the data sets.
    pub error: f64,
    /// The same: standard deviation over data sets; zero without a fit.
    pub error_scatter: f64,
    /// Coefficient of variation of predicted lives, mean over data sets.
    pub cov: f64,
    /// The same: standard deviation over data sets.
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
    /// Both baselines predict longer lives than the proposed model.
    pub baselines_are_longer: f64,
    /// Baseline 1 predicts the longest life.
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
    /// dLambda of each model over that of the truth, at the begin and at the end of the life.
    pub ratio: Vec<(f64, f64)>,
    /// Exponent of the growth of the truth's dLambda with the clearance over the life.
    pub exponent: f64,
    /// Data sets.
    pub data_sets: usize,
    /// By protocol.
    pub protocols: Vec<UnderProtocol>,
    /// Probability densities of life from the first data set fitted on its first 20 cycles: truth, then [`MODELS`].
    pub densities: Vec<Density>,
}

/// A probability density of life.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Density {
    /// Lives [cycles].
    pub lives: Vec<f64>,
    /// Density [1/cycle].
    pub values: Vec<f64>,
}

/// All definitions of wear that a pair of gammas gives.
pub(super) fn definitions(gamma: f64) -> [(&'static str, Definition); 2] {
    [
        ("depth", Definition { wear: WearOf::Depth, gamma }),
        ("largest depth", Definition { wear: WearOf::Profile(Measure::Maximum), gamma }),
    ]
}

/// One wearing joint as the Gamma layer sees it.
struct Bearing {
    threshold: f64,
    truth: Cycle,
    /// In the order of [`MODELS`].
    models: [Cycle; 3],
    revolutions_per_cycle: f64,
}

/// A history: W before each cycle and the increment in it [m].
type History = Vec<(f64, f64)>;

/// What one data set gives: per protocol, per model, the rates and lives.
type Fitted = Vec<Vec<(GammaRates, LifeNumbers)>>;

/// Predicts lives under every protocol.
pub(super) fn lives(
    tables: &Tables,
    (wear, definition): (&'static str, Definition),
    (threads, seed): (usize, u64),
    effort: &Effort,
    watch: &Watch<'_>,
) -> Result<Lives, StudyError> {
    let rates = tables.rates().ok_or(StudyError::Missing { kind: "scatter of wear of joint", name: super::model::JOINT.into() })?;
    let bearing = Bearing::new(tables, definition, effort)?;
    let true_lives = draw_lives(&bearing.truth, bearing.threshold, rates, (seed, FOR_TRUTH), effort.trajectories);
    let truth = numbers(&true_lives);
    let jobs = (0..effort.data_sets).map(|set| {
        let bearing = &bearing;
        let job = move || {
            let fitted = if watch.is_stopped() { Err(StudyError::Interrupted) } else { bearing.data_set(rates, (seed, set), effort) };
            watch.done(effort.work_of_data_set);
            fitted
        };
        Box::new(job) as Job<'_, Result<Fitted, StudyError>>
    });
    let fitted: Result<Vec<Fitted>, StudyError> = run_all(threads, jobs.collect()).into_iter().collect();
    let fitted = fitted?;
    let protocols = PROTOCOLS.iter().enumerate();
    let protocols = protocols.map(|(at, protocol)| under(*protocol, at, &fitted, &truth));
    let mut densities = vec![density(&true_lives)];
    let shown = PROTOCOLS.iter().position(|protocol| *protocol == Protocol::First20).unwrap_or(0);
    for (at, cycle) in bearing.models.iter().enumerate() {
        let (rates, _) = &fitted[0][shown][at];
        densities.push(density(&draw_lives(cycle, bearing.threshold, *rates, (seed, FOR_PREDICTION), effort.trajectories)));
    }
    let end = bearing.threshold;
    let opened = 1.0 + definition.gamma * end / tables.clearance();
    let growth = bearing.truth.mean_increment(end) / bearing.truth.mean_increment(0.0);
    let ratio = |cycle: &Cycle, wear: f64| cycle.mean_increment(wear) / bearing.truth.mean_increment(wear);
    Ok(Lives {
        wear,
        gamma: definition.gamma,
        revolutions_per_cycle: bearing.revolutions_per_cycle,
        deterministic: bearing.models.iter().map(|cycle| cycle.mean_life(end)).collect(),
        ratio: bearing.models.iter().map(|cycle| (ratio(cycle, 0.0), ratio(cycle, end))).collect(),
        exponent: libm::log(growth) / libm::log(opened),
        data_sets: effort.data_sets as usize,
        protocols: protocols.collect(),
        densities,
        truth,
    })
}

impl Bearing {
    fn new(tables: &Tables, definition: Definition, effort: &Effort) -> Result<Self, StudyError> {
        let life = tables.finest.life(definition, effort.finest_wear_step)?;
        let factor = calibrate(&life, &mut tables.finest.table.clone(), TRUE_LIFE, CALIBRATED)?.factor;
        let (threshold, own) = (life.joints[0].threshold, life.joints[0].revolutions_per_cycle);
        let revolutions_per_cycle = factor * own;
        let cycle = |measured, definition| {
            Rate::of(measured, definition, REACH * threshold).cycle(revolutions_per_cycle)
        };
        let constant = Definition { gamma: 0.0, ..definition };
        Ok(Self {
            threshold,
            truth: cycle(&tables.finest, definition),
            models: [
                cycle(&tables.flexible, definition),
                cycle(&tables.rigid, definition),
                cycle(&tables.flexible, constant),
            ],
            revolutions_per_cycle,
        })
    }

    /// Draws histories, fits every model under every protocol, predicts.
    fn data_set(&self, truth: GammaRates, (seed, set): (u64, u64), effort: &Effort) -> Result<Fitted, StudyError> {
        let draw = drawing(truth, seed);
        let histories: Vec<History> = (0..HISTORIES)
            .map(|unit| history(&self.truth, self.threshold, &draw, (FOR_HISTORIES, set * HISTORIES + unit)))
            .collect();
        let predicted = |cycle: &Cycle, rates| {
            let lives =
                draw_lives(cycle, self.threshold, rates, (seed, FOR_PREDICTION), effort.trajectories_per_set);
            (rates, numbers(&lives))
        };
        let under = |protocol: &Protocol| -> Result<Vec<(GammaRates, LifeNumbers)>, StudyError> {
            let of = |cycle: &Cycle| {
                let rates = match protocol.cycles() {
                    Some(cycles) => fit(cycle, &histories, cycles)?,
                    None => truth,
                };
                Ok(predicted(cycle, rates))
            };
            self.models.iter().map(of).collect()
        };
        PROTOCOLS.iter().map(under).collect()
    }
}

impl Protocol {
    /// Cycles of a history that are fitted; nothing without a fit.
    fn cycles(self) -> Option<usize> {
        match self {
            Self::All => Some(usize::MAX),
            Self::First20 => Some(20),
            Self::First10 => Some(10),
            Self::Shared => None,
        }
    }
}

fn drawing(rates: GammaRates, seed: u64) -> GammaDraw {
    GammaDraw::new(seed, &[rates; 3])
}

/// One random life, recorded.
fn history(cycle: &Cycle, threshold: f64, draw: &GammaDraw, (purpose, trajectory): (usize, u64)) -> History {
    let (mut wear, mut steps) = (0.0, Vec::new());
    while wear < threshold {
        let increment = draw.draw(purpose, trajectory, steps.len() as u64, cycle.mean_increment(wear));
        steps.push((wear, increment));
        wear += increment;
    }
    steps
}

/// Random lives [cycles]: threshold interpolated within the cycle, and whole cycles.
fn draw_lives(
    cycle: &Cycle,
    threshold: f64,
    rates: GammaRates,
    (seed, purpose): (u64, usize),
    count: u64,
) -> Vec<(f64, f64)> {
    let draw = drawing(rates, seed);
    let life = |trajectory| {
        let (mut wear, mut cycles) = (0.0, 0);
        loop {
            let increment = draw.draw(purpose, trajectory, cycles, cycle.mean_increment(wear));
            if wear + increment >= threshold {
                return (cycles as f64 + (threshold - wear) / increment, cycles as f64 + 1.0);
            }
            wear += increment;
            cycles += 1;
        }
    };
    (0..count).map(life).collect()
}

fn numbers(lives: &[(f64, f64)]) -> LifeNumbers {
    let (mean, std) = mean_and_scatter(lives.iter().map(|life| life.0));
    let (mean_whole, _) = mean_and_scatter(lives.iter().map(|life| life.1));
    LifeNumbers { mean, std, cov: std / mean, mean_whole }
}

/// Mean and standard deviation (over n - 1).
fn mean_and_scatter(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
    (mean, if count > 1.0 { libm::sqrt(squares / (count - 1.0)) } else { 0.0 })
}

/// Maximum likelihood with a model's own dLambda, in micrometres.
fn fit(cycle: &Cycle, histories: &[History], cycles: usize) -> Result<GammaRates, StudyError> {
    let mut increments = Vec::new();
    for (unit, history) in histories.iter().enumerate() {
        let mut from = 0.0;
        for (wear, increment) in history.iter().take(cycles) {
            let to = from + cycle.mean_increment(*wear) / MICRO;
            let wear = increment / MICRO;
            increments.push(Increment { unit, from, to, wear, ln_covariates: Vec::new(), row: 0 });
            from = to;
        }
    }
    let units = (0..histories.len()).map(|unit| unit.to_string()).collect();
    let found = estimate(&Observations { units, increments }, &GammaModel::default())?;
    Ok(GammaRates { alpha: found.alpha() / MICRO, beta: found.beta() / MICRO })
}

fn under(protocol: Protocol, at: usize, fitted: &[Fitted], truth: &LifeNumbers) -> UnderProtocol {
    let sets: Vec<&Vec<(GammaRates, LifeNumbers)>> = fitted.iter().map(|set| &set[at]).collect();
    let error = |life: &LifeNumbers| life.mean / truth.mean - 1.0;
    let prediction = |model: usize| {
        let all = || sets.iter().map(|set| &set[model]);
        let mean_of = |of: fn(&GammaRates) -> f64| mean_and_scatter(all().map(|(rates, _)| of(rates))).0;
        let (mean_error, error_scatter) = mean_and_scatter(all().map(|(_, life)| error(life)));
        let (cov, cov_scatter) = mean_and_scatter(all().map(|(_, life)| life.cov));
        let longer = all().filter(|(_, life)| error(life) > 0.0).count();
        Prediction {
            model: MODELS[model],
            alpha: MICRO * mean_of(|rates| rates.alpha),
            beta: MICRO * mean_of(|rates| rates.beta),
            first: sets[0][model].1.clone(),
            error: mean_error,
            error_scatter,
            cov,
            cov_scatter,
            over_predicts: longer as f64 / sets.len() as f64,
        }
    };
    let part = |holds: &dyn Fn(&[(GammaRates, LifeNumbers)]) -> bool| {
        sets.iter().filter(|set| holds(set)).count() as f64 / sets.len() as f64
    };
    let nearest = |set: &[(GammaRates, LifeNumbers)]| {
        (1..3).all(|model| error(&set[0].1).abs() < error(&set[model].1).abs())
    };
    let narrowest =
        |set: &[(GammaRates, LifeNumbers)]| (1..3).all(|model| set[0].1.cov < set[model].1.cov);
    let longer = |set: &[(GammaRates, LifeNumbers)]| (1..3).all(|model| set[model].1.mean > set[0].1.mean);
    let longest =
        |set: &[(GammaRates, LifeNumbers)]| set[1].1.mean > set[0].1.mean.max(set[2].1.mean);
    UnderProtocol {
        protocol,
        predictions: (0..3).map(prediction).collect(),
        orderings: Orderings {
            proposed_is_nearest: part(&nearest),
            proposed_is_narrowest: part(&narrowest),
            baselines_are_longer: part(&longer),
            rigid_is_longest: part(&longest),
            all: part(&|set| nearest(set) && narrowest(set) && longer(set) && longest(set)),
        },
    }
}

/// A smooth density of lives: normal kernels of Silverman's width.
fn density(lives: &[(f64, f64)]) -> Density {
    const POINTS: usize = 121;
    let (mean, std) = mean_and_scatter(lives.iter().map(|life| life.0));
    let width = 1.06 * std * libm::pow(lives.len() as f64, -0.2);
    let place = |index: usize| mean + std * (8.0 * index as f64 / (POINTS - 1) as f64 - 4.0);
    let value = |at: f64| {
        let kernel = |life: &(f64, f64)| libm::exp(-0.5 * ((at - life.0) / width) * ((at - life.0) / width));
        let sum: f64 = lives.iter().map(kernel).sum();
        sum / (lives.len() as f64 * width * libm::sqrt(2.0 * std::f64::consts::PI))
    };
    let places: Vec<f64> = (0..POINTS).map(place).collect();
    Density { values: places.iter().map(|at| value(*at)).collect(), lives: places }
}
