//! How a model learns from histories of wear and predicts lives from what it learnt. In: mean increments of a cycle
//! by the wear before it, one curve for the truth and one per model. Out: [`Learnt`] per data set. Never knows what
//! wear is or how often this is done.

use linkwear_gamma::data::{Increment, Observations};
use linkwear_gamma::fit::{Model as GammaModel, estimate};
use linkwear_gamma::monte_carlo::{GammaDraw, MICRO};
use linkwear_runtime::GammaRates;
use linkwear_runtime::life::IncrementModel;
use serde::Serialize;

use super::error::StudyError;
use super::rate::Cycle;
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

/// One wearing joint as the Gamma layer sees it.
pub(super) struct Bearing {
    /// Wear at failure [m].
    pub threshold: f64,
    /// The true parameters.
    pub rates: GammaRates,
    pub truth: Cycle,
    /// In the order of [`super::MODELS`].
    pub models: [Cycle; 3],
    pub seed: u64,
}

/// A history: W before each cycle and the increment in it [m].
type History = Vec<(f64, f64)>;

impl Bearing {
    /// Draws the histories of a data set, fits every model under every protocol, predicts so many lives with each:
    /// by protocol, then by model.
    pub fn data_set(&self, set: u64, trajectories: u64) -> Result<Vec<Vec<Learnt>>, StudyError> {
        let unit =
            |unit| history(&self.truth, self.threshold, &self.draw(self.rates), set * HISTORIES + unit);
        let histories: Vec<History> = (0..HISTORIES).map(unit).collect();
        let learn = |protocol: &Protocol, cycle: &Cycle| -> Result<Learnt, StudyError> {
            let rates = match protocol.cycles() {
                Some(cycles) => fit(cycle, &histories, cycles)?,
                None => self.rates,
            };
            let first = set * trajectories;
            let lives = self.lives(cycle, rates, Purpose::Prediction, first..first + trajectories);
            Ok(Learnt { rates, lives: LifeNumbers::of(&lives) })
        };
        let under = |protocol: &Protocol| self.models.iter().map(|cycle| learn(protocol, cycle)).collect();
        PROTOCOLS.iter().map(under).collect()
    }

    /// Random lives.
    pub fn lives(
        &self,
        cycle: &Cycle,
        rates: GammaRates,
        purpose: Purpose,
        trajectories: std::ops::Range<u64>,
    ) -> Vec<Lived> {
        let draw = self.draw(rates);
        trajectories.map(|trajectory| life(cycle, self.threshold, &draw, (purpose, trajectory))).collect()
    }

    fn draw(&self, rates: GammaRates) -> GammaDraw {
        // One stream per purpose, where a life has one per joint.
        GammaDraw::new(self.seed, &[rates; 3])
    }
}

/// One random life, recorded.
fn history(cycle: &Cycle, threshold: f64, draw: &GammaDraw, trajectory: u64) -> History {
    let (mut wear, mut steps) = (0.0, Vec::new());
    while wear < threshold {
        let mean = cycle.mean_increment(wear);
        let increment = draw.draw(Purpose::Histories as usize, trajectory, steps.len() as u64, mean);
        steps.push((wear, increment));
        wear += increment;
    }
    steps
}

fn life(cycle: &Cycle, threshold: f64, draw: &GammaDraw, (purpose, trajectory): (Purpose, u64)) -> Lived {
    let (mut wear, mut cycles) = (0.0, 0);
    loop {
        let increment = draw.draw(purpose as usize, trajectory, cycles, cycle.mean_increment(wear));
        if wear + increment >= threshold {
            let before = cycles as f64;
            return Lived { cycles: before + (threshold - wear) / increment, whole: before + 1.0 };
        }
        wear += increment;
        cycles += 1;
    }
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
    let parameters = found.parameters();
    Ok(GammaRates { alpha: parameters[0] / MICRO, beta: parameters[1] / MICRO })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wear increments of 3.2 µm a cycle, whatever the wear, times a factor.
    fn steady(factor: f64) -> Cycle {
        Cycle::constant(factor * 3.2e-6, 80e-6)
    }

    #[test]
    fn a_constant_factor_between_model_and_truth_cancels_in_the_fit() {
        let rates = GammaRates { alpha: 13.65e6, beta: 13.65e6 };
        let models = [steady(1.0), steady(2.0), steady(0.3)];
        let bearing = Bearing { threshold: 80e-6, rates, truth: steady(1.0), models, seed: 3 };
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
