//! The life of a machine of several wearing joints, each with a fit of its own: it ends when the first of them fails.
//! In: estimates and states. Out: numbers with their bands. Never knows files or terminals.

use super::interval::{IntervalKind, ends, predictive_law};
use super::questions::{Answers, Ask, Questions, never_warning, usual_quantile};
use super::{Prediction, TAIL};
use crate::error::LifeError;
use crate::inspection::Mixture;
use crate::life::{Band, Estimate, FirstPassage, Lifetime, Moments, OperatingState, Survived, variance};
use crate::series::SeriesSystem;
use crate::special::normal_quantile;

/// One of the joints.
#[derive(Clone, Debug)]
pub struct Member {
    /// The law of its wear.
    pub estimate: Estimate,
    /// How far it is worn.
    pub state: OperatingState,
}

/// The remaining life of a machine; times in the unit of the rates of exposure, from the present. Given their exposures joints
/// wear independently, and so are the errors of their fits.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Mean and standard deviation, the mean with its band; None where they are not finite, and a warning says so.
    pub moments: Option<(Moments, Band)>,
    /// 10 %, 50 %, 90 % of the life, with what the parameters leave open; infinite where so many never fail.
    pub quantiles: [Band; 3],
    /// Ends of the interval that holds the life with probability [`Prediction::LEVEL`].
    pub interval: (f64, f64),
    /// How it takes the parameters: as the joint does that takes the least into account.
    pub interval_kind: IntervalKind,
    /// Probability of each joint to be the one that ends the life, in the order given.
    pub first: Vec<f64>,
    /// To what else was asked.
    pub answers: Answers,
    /// What its reader has to know.
    pub warnings: Vec<String>,
}

impl Machine {
    /// Of its joints.
    ///
    /// # Errors
    /// [`LifeError`]; [`LifeError::NoMember`].
    pub fn new(members: &[Member], questions: &Questions) -> Result<Self, LifeError> {
        questions.check()?;
        let lives = members.iter().map(|one| one.state.life(&one.estimate)).collect::<Result<Vec<_>, _>>()?;
        let system = SeriesSystem::independent(lives.clone())?;
        let rest = Survived::new(&system, questions.survived)?;
        let band = |ask: Ask, value: f64| bands(members, &lives, questions.survived, ask, value);
        let quantile = |p: f64| usual_quantile(&rest, p, &band);
        let quantiles = [quantile(0.1)?, quantile(0.5)?, quantile(0.9)?];
        let (moments, mut warnings) = match rest.moments() {
            Ok(moments) => (Some((moments, band(Ask::Mean, moments.mean)?)), Vec::new()),
            Err(error) => (None, vec![error.to_string()]),
        };
        warnings.extend(never_warning(&rest, TAIL));
        let (laws, kinds): (Vec<_>, Vec<_>) = members
            .iter()
            .map(|one| predictive_law(&one.estimate, &one.state))
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .unzip();
        let predictive = AllOf { laws, typical: system.typical() };
        Ok(Self {
            moments,
            quantiles,
            interval: ends(&Survived::new(&predictive, questions.survived)?)?,
            interval_kind: kinds.into_iter().max().unwrap_or(IntervalKind::PlugIn),
            first: system.first_to_fail_after(questions.survived)?,
            answers: questions.answers(&rest, &band)?,
            warnings,
        })
    }
}

/// A value and what the parameters of all joints leave open of it: the delta method, errors of the fits being independent.
fn bands(
    members: &[Member],
    lives: &[FirstPassage],
    survived: f64,
    ask: Ask,
    value: f64,
) -> Result<Band, LifeError> {
    let mut sum = 0.0;
    for (at, Member { estimate, state }) in members.iter().enumerate() {
        let of = |life: &FirstPassage| {
            let mut lives = lives.to_vec();
            lives[at] = life.clone();
            ask.open(&Survived::new(&SeriesSystem::independent(lives)?, survived)?)
        };
        if estimate.is_uncertain() {
            sum += variance(estimate, state, ask.scale(), &of)?;
        }
    }
    Ok(Band::around(value, ask.scale(), normal_quantile(0.5 + 0.5 * Prediction::LEVEL) * sum.sqrt()))
}

/// A life that lasts as long as all of several do.
struct AllOf {
    laws: Vec<Box<dyn Mixture>>,
    typical: f64,
}

impl Lifetime for AllOf {
    fn reliability(&self, t: f64) -> f64 {
        self.laws.iter().map(|law| law.reliability(t)).product()
    }

    /// 1 - product of (1 - F) with the digits of small F kept.
    fn failed(&self, t: f64) -> f64 {
        let ln: f64 = self.laws.iter().map(|law| libm::log1p(-law.failed(t))).sum();
        -libm::expm1(ln)
    }

    fn typical(&self) -> f64 {
        self.typical
    }

    fn ever(&self) -> f64 {
        1.0 - self.laws.iter().map(|law| 1.0 - law.ever()).product::<f64>()
    }
}
