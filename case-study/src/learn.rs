//! How a model learns from histories of wear and predicts lives from what it learnt. In: mean increments of a cycle
//! by the wear before it, one curve for the truth and one per model. Out: [`Learnt`] per data set. Never knows what
//! wear is or how often this is done.

use std::ops::Range;

use linkwear_gamma::data::{Increment, Observations};
use linkwear_gamma::fit::{Model as GammaModel, estimate};
use linkwear_gamma::monte_carlo::{GammaDraw, MICRO};
use linkwear_runtime::GammaRates;
use linkwear_runtime::life::{IncrementModel, MeanIncrement};
use serde::Serialize;

use super::error::StudyError;
use super::rate::Curve;
use super::statistics::{LifeNumbers, Lived};

/// Histories in a data set: the paper's M, which it gives no number.
pub const HISTORIES: u64 = 20;

/// What random numbers are drawn for: every purpose has its own streams.
#[derive(Clone, Copy)]
pub(super) enum Purpose {
    Histories,
    Truth,
    Prediction,
}

/// Which increments a model is fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Protocol {
    /// All until failure.
    All,
    /// The first twenty cycles.
    First20,
    /// The first ten cycles.
    First10,
    /// No fit: every model has the parameters of the truth.
    Shared,
}

/// All protocols, in the order of all results.
pub const PROTOCOLS: [Protocol; 4] = [Protocol::All, Protocol::First20, Protocol::First10, Protocol::Shared];

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

    /// How it reads.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all cycles",
            Self::First20 => "first 20 cycles",
            Self::First10 => "first 10 cycles",
            Self::Shared => "shared parameters",
        }
    }
}

/// What a model has learnt from a data set, and what it predicts from that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Learnt {
    pub rates: GammaRates,
    pub lives: LifeNumbers,
}

/// One wearing joint as the Gamma layer sees it: models are mean increments of a cycle by the wear before it [m].
pub(super) struct Bearing {
    /// Wear at failure [m].
    pub threshold: f64,
    /// The true parameters.
    pub rates: GammaRates,
    pub truth: Curve,
    /// In the order of [`super::MODELS`].
    pub models: [Curve; 3],
    pub seed: u64,
}

/// A life until failure: W before each cycle and the increment in it [m].
type History = Vec<(f64, f64)>;

impl Bearing {
    /// Draws the histories of a data set, fits every model under every protocol, predicts so many lives with each:
    /// by protocol, then by model.
    pub fn data_set(&self, set: u64, trajectories: u64) -> Result<Vec<Vec<Learnt>>, StudyError> {
        let draw = self.draw(self.rates);
        let numbers = set * HISTORIES..(set + 1) * HISTORIES;
        let histories: Vec<History> =
            numbers.map(|number| self.history(&self.truth, &draw, Purpose::Histories, number)).collect();
        let learn = |protocol: &Protocol, model: &Curve| -> Result<Learnt, StudyError> {
            let rates = match protocol.cycles() {
                Some(cycles) => fit(model, &histories, cycles)?,
                None => self.rates,
            };
            let numbers = set * trajectories..(set + 1) * trajectories;
            let lives = self.lives(model, rates, Purpose::Prediction, numbers);
            Ok(Learnt { rates, lives: LifeNumbers::of(&lives) })
        };
        let under = |protocol: &Protocol| self.models.iter().map(|model| learn(protocol, model)).collect();
        PROTOCOLS.iter().map(under).collect()
    }

    /// Random lives.
    pub fn lives(
        &self,
        model: &Curve,
        rates: GammaRates,
        purpose: Purpose,
        numbers: Range<u64>,
    ) -> Vec<Lived> {
        let draw = self.draw(rates);
        numbers.map(|number| self.lived(&self.history(model, &draw, purpose, number))).collect()
    }

    /// Cycles of the life in which every increment is its mean.
    pub fn mean_life(&self, model: &Curve) -> f64 {
        self.lived(&self.history(model, &MeanIncrement, Purpose::Truth, 0)).cycles
    }

    fn draw(&self, rates: GammaRates) -> GammaDraw {
        // One stream per purpose, where a life has one per joint.
        GammaDraw::new(self.seed, &[rates; 3])
    }

    fn history(&self, model: &Curve, draw: &impl IncrementModel, purpose: Purpose, number: u64) -> History {
        let (mut wear, mut steps) = (0.0, Vec::new());
        while wear < self.threshold {
            let increment = draw.draw(purpose as usize, number, steps.len() as u64, model.at(wear));
            steps.push((wear, increment));
            wear += increment;
        }
        steps
    }

    fn lived(&self, history: &[(f64, f64)]) -> Lived {
        let (wear, increment) = history[history.len() - 1];
        let whole = history.len() as f64;
        Lived { cycles: whole - 1.0 + (self.threshold - wear) / increment, whole }
    }
}

/// Maximum likelihood with a model's own dLambda, in micrometres.
fn fit(model: &Curve, histories: &[History], cycles: usize) -> Result<GammaRates, StudyError> {
    let mut increments = Vec::new();
    for (unit, history) in histories.iter().enumerate() {
        let mut from = 0.0;
        for (wear, increment) in history.iter().take(cycles) {
            let to = from + model.at(*wear) / MICRO;
            let wear = increment / MICRO;
            increments.push(Increment {
                unit,
                from,
                to,
                wear,
                ln_covariates: Vec::new(),
                row: 0,
                ..Increment::default()
            });
            from = to;
        }
    }
    let units = (0..histories.len()).map(|unit| unit.to_string()).collect();
    let found = estimate(&Observations { units, increments }, &GammaModel::default())?;
    let parameters = found.parameters();
    Ok(GammaRates { alpha: parameters[0] / MICRO, beta: parameters[1] / MICRO })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wear increments of 3.2 µm a cycle, whatever the wear, times a factor.
    fn steady(factor: f64) -> Curve {
        Curve::constant(factor * 3.2e-6, 80e-6)
    }

    #[test]
    fn a_constant_factor_between_model_and_truth_cancels_in_the_fit() {
        let rates = GammaRates { alpha: 13.65e6, beta: 13.65e6 };
        let models = [steady(1.0), steady(2.0), steady(0.3)];
        let bearing = Bearing { threshold: 80e-6, rates, truth: steady(1.0), models, seed: 3 };
        assert!((bearing.mean_life(&bearing.models[1]) - 12.5).abs() < 1e-12);
        let learnt = bearing.data_set(0, 500).expect("a fit");
        for (protocol, models) in PROTOCOLS.iter().zip(&learnt) {
            let lives: Vec<f64> = models.iter().map(|model| model.lives.mean).collect();
            if *protocol == Protocol::Shared {
                assert!((lives[1] - 0.5 * lives[0]).abs() < 0.5, "{lives:?}");
            } else {
                // alpha takes the factor, to the tolerance of the fit; draws are the same.
                assert!((lives[1] / lives[0] - 1.0).abs() < 1e-6, "{lives:?}");
                assert!((lives[2] / lives[0] - 1.0).abs() < 1e-6, "{lives:?}");
            }
        }
        // 20 histories of 25 cycles know the mean to sqrt(1/(500 x 43.7)) = 0.7 %; three times that.
        assert!((learnt[0][0].lives.mean / 25.01 - 1.0).abs() < 0.021, "{:?}", learnt[0][0]);
    }
}
