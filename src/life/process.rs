//! The Gamma processes of the wearing joints. In: alpha and beta of the mechanism's file, fits that take their place, a
//! shared factor. Out: draws, mean increments, how uncertain a mean life is by the fits. Never knows how lives are lived.

use linkwear_gamma::life::{Estimate, LifeError as LawError};
use linkwear_gamma::monte_carlo::{GammaDraw, GammaMean, PER_METRE};
use linkwear_gamma::series::SharedFactor;
use linkwear_runtime::life::CycleRecord;
use linkwear_runtime::{Description, GammaRates};
use serde::{Deserialize, Serialize};

use super::error::Cause;
use super::fit::JointFit;
use super::study::{LifeStudy, Trajectories};

/// Step in ln alpha and ln beta for the derivatives of a mean life: curvature leaves an error of 1e-4 of them.
const STEP: f64 = 0.02;

/// alpha and beta of a joint, and where they are from.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct JointProcess {
    /// The joint.
    pub joint: String,
    /// Its parameters [1/m].
    pub rates: GammaRates,
    /// The `from` of [`JointFit::new`]; none: the mechanism's file.
    pub from: Option<String>,
    /// Coefficient of variation of what the first cycle wears, if the mechanism's file gives it in place of alpha and beta.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycle_variation: Option<f64>,
}

impl JointProcess {
    /// alpha and beta [1/µm].
    pub fn per_micrometre(&self) -> [f64; 2] {
        [self.rates.alpha / PER_METRE, self.rates.beta / PER_METRE]
    }
}

/// Parameters of all wearing joints.
pub(super) struct Process {
    pub joints: Vec<JointProcess>,
    /// Fits from different places, which err independently.
    fits: Vec<JointFit>,
    shared: Option<SharedFactor>,
    seed: u64,
}

impl Process {
    /// Of the wearing joints; None where a joint has no parameters and nobody asks for random lives.
    pub fn new(study: &LifeStudy<'_>, description: &Description) -> Result<Option<Self>, Cause> {
        let contacts = || description.contacts.iter().filter(|contact| contact.wear.is_some());
        let known: Vec<String> = contacts().map(|contact| contact.joint.to_string()).collect();
        if let Some(fit) = study.fits.iter().find(|fit| !known.contains(&fit.joint)) {
            return Err(Cause::UnknownJoint { joint: fit.joint.clone(), known });
        }
        let twice =
            |(at, fit): &(usize, &JointFit)| study.fits[..*at].iter().any(|one| one.joint == fit.joint);
        if let Some((_, fit)) = study.fits.iter().enumerate().find(twice) {
            return Err(Cause::TwoFits { joint: fit.joint.clone() });
        }
        let shared = study.shared_factor.map(shared).transpose()?;
        let is_counted = matches!(study.trajectories, Trajectories::Count(_));
        let is_asked = is_counted || !study.fits.is_empty() || shared.is_some();
        let mut joints = Vec::new();
        for (contact, joint) in contacts().zip(known) {
            let fit = study.fits.iter().find(|fit| fit.joint == joint);
            let variation = contact.wear.and_then(|wear| wear.cycle_variation).filter(|_| fit.is_none());
            // Until the mean path, which needs no more than their quotient, has told them.
            let of_variation = variation.map(|_| GammaRates { alpha: PER_METRE, beta: PER_METRE });
            let of_file = contact.wear.and_then(|wear| wear.scatter).or(of_variation);
            let Some(rates) = fit.map(|fit| rates(&fit.estimate)).or(of_file) else {
                return if is_asked { Err(Cause::NoProcess { joint }) } else { Ok(None) };
            };
            let from = fit.map(|fit| fit.from.clone());
            joints.push(JointProcess { joint, rates, from, cycle_variation: variation });
        }
        let mut fits: Vec<JointFit> = Vec::new();
        for fit in &study.fits {
            if !fits.iter().any(|known| known.from == fit.from) {
                fits.push(fit.clone());
            }
        }
        Ok(Some(Self { joints, fits, shared, seed: study.seed }))
    }

    /// Takes alpha and beta from the coefficient of variation of the first cycle, where the file gives that: an increment of mean m has
    /// the shape alpha m and so the coefficient of variation 1 / sqrt(alpha m).
    pub fn know(&mut self, cycles: &[CycleRecord]) {
        let Some(first) = cycles.first() else { return };
        for (joint, worn) in self.joints.iter_mut().zip(&first.joints) {
            if let Some(variation) = joint.cycle_variation {
                let alpha = 1.0 / (variation * variation * worn.mean_increment);
                joint.rates = GammaRates { alpha, beta: alpha };
            }
        }
    }

    /// Random increments.
    pub fn draw(&self) -> GammaDraw {
        self.draw_of(&self.rates())
    }

    /// The mean increments, alpha dLambda / beta.
    pub fn mean(&self) -> GammaMean {
        GammaMean::new(&self.rates())
    }

    fn rates(&self) -> Vec<GammaRates> {
        self.joints.iter().map(|joint| joint.rates).collect()
    }

    fn draw_of(&self, rates: &[GammaRates]) -> GammaDraw {
        let draw =
            GammaDraw::new(self.seed, rates).differing(self.joints.iter().map(|one| self.cv(one)).collect());
        match self.shared {
            #[expect(clippy::expect_used, reason = "`shared` has checked its coefficient of variation")]
            Some(factor) => draw.sharing(factor).expect("checked at the beginning"),
            None => draw,
        }
    }

    /// Coefficient of variation of a joint's rate over lives, by its fit; 0 where units do not differ.
    fn cv(&self, joint: &JointProcess) -> f64 {
        let fit = self.fits.iter().find(|fit| joint.from.as_ref() == Some(&fit.from));
        fit.and_then(|fit| fit.estimate.cv()).unwrap_or(0.0)
    }

    /// Standard error that the fits' covariances leave to a mean life, to first order in the logarithms of alpha and
    /// beta; None without a covariance. `mean_life` lives by a draw, always with the same random numbers, so that
    /// what they do cancels in the differences. Different fits err independently.
    pub fn uncertainty<E>(
        &self,
        mean_life: &mut dyn FnMut(&GammaDraw) -> Result<f64, E>,
    ) -> Result<Option<f64>, E> {
        let mut variance = None;
        for fit in self.fits.iter().filter(|fit| fit.estimate.is_uncertain()) {
            let mut gradient = [0.0; 2];
            for (which, slope) in gradient.iter_mut().enumerate() {
                let [up, down] = [STEP, -STEP].map(|step| mean_life(&self.shifted(fit, which, step)));
                *slope = (up? - down?) / (2.0 * STEP);
            }
            *variance.get_or_insert(0.0) += fit.estimate.variance(&gradient);
        }
        Ok(variance.map(f64::sqrt))
    }

    /// The same of the mean path that ends when this joint fails: wear per cycle is alpha / beta times what the worn
    /// joint wears by physics, so the path's life goes as beta / alpha. What other joints' fits do to it is left out.
    pub fn uncertainty_of_mean_path(&self, joint: usize, cycles: f64) -> Option<f64> {
        let from = self.joints[joint].from.as_ref()?;
        let estimate = &self.fits.iter().find(|fit| fit.from == *from)?.estimate;
        estimate.is_uncertain().then(|| cycles * estimate.variance(&[-1.0, 1.0]).sqrt())
    }

    /// Draws with ln alpha (0) or ln beta (1) of one fit moved by a step.
    fn shifted(&self, fit: &JointFit, which: usize, step: f64) -> GammaDraw {
        let mut rates = self.rates();
        let is_its = |joint: &JointProcess| joint.from.as_ref() == Some(&fit.from);
        for (rates, _) in rates.iter_mut().zip(&self.joints).filter(|(_, joint)| is_its(joint)) {
            let value = if which == 0 { &mut rates.alpha } else { &mut rates.beta };
            *value *= step.exp();
        }
        self.draw_of(&rates)
    }
}

fn rates(estimate: &Estimate) -> GammaRates {
    let [alpha, beta] = estimate.parameters();
    GammaRates { alpha: PER_METRE * alpha, beta: PER_METRE * beta }
}

/// A factor of mean 1 with a coefficient of variation.
fn shared(cov: f64) -> Result<SharedFactor, Cause> {
    // Life goes nearly as one over the factor, whose square has a mean below this only.
    let below = 0.5_f64.sqrt();
    if cov > 0.0 && cov < below {
        Ok(SharedFactor::Gamma { cov })
    } else {
        Err(Cause::SharedFactor(LawError::HeavyFactor { cov, below }))
    }
}
