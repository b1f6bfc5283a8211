//! What a process is. In: nothing but numbers. Never knows which processes there are.

use std::fmt::Debug;

use super::random_effect::RandomEffect;
use crate::random::Stream;

/// Wear that grows by independent increments with a law of two positive parameters.
///
/// `logs` are the logarithms of the two parameters. Exposure that counts f times multiplies the parameters by f to the
/// [`Process::exposure_powers`], so the law of an increment over an exposure is that over exposure 1 with other
/// parameters.
pub trait Process: Debug + Sync {
    /// Name in files and on the command line.
    fn name(&self) -> &'static str;

    /// Name for people.
    fn title(&self) -> &'static str;

    /// Names of the two parameters.
    fn parameters(&self) -> [&'static str; 2];

    /// Powers of the exposure that the two parameters of an increment are proportional to.
    fn exposure_powers(&self) -> [f64; 2];

    /// Powers of a factor on the size of increments that the two parameters are proportional to.
    fn size_powers(&self) -> [f64; 2] {
        [1.0, 0.0]
    }

    /// Whether wear never falls.
    fn is_increasing(&self) -> bool {
        true
    }

    /// Logarithms of the maximum-likelihood parameters of increments over exposures; None where there is no maximum.
    fn maximum(&self, exposures: &[f64], wears: &[f64]) -> Option<[f64; 2]>;

    /// ln density of an increment over exposure 1, with derivatives by `logs`.
    fn density(&self, logs: [f64; 2], wear: f64) -> Term;

    /// ln density of an increment over exposure 1 alone.
    fn ln_density(&self, logs: [f64; 2], wear: f64) -> f64 {
        self.density(logs, wear).value
    }

    /// ln of the mean wear over exposure 1.
    fn ln_mean(&self, logs: [f64; 2]) -> f64;

    /// Variance of an increment over exposure 1.
    fn variance(&self, logs: [f64; 2]) -> f64;

    /// The ln density of an increment over exposure 1 as c + p ln wear - r wear: c, p, r; None where it is none of that kind.
    fn density_terms(&self, _logs: [f64; 2]) -> Option<[f64; 3]> {
        None
    }

    /// Mean of what an increment over exposure 1 is below `wear`: the integral of its distribution function up to there; None
    /// where readings rounded to a gauge's step cannot be taken as such.
    fn mean_shortfall(&self, _logs: [f64; 2], _wear: f64) -> Option<f64> {
        None
    }

    /// Mean of what it is above `wear`: the integral of what its distribution function lacks to 1 from there on. Excess and
    /// shortfall differ by mean - wear.
    fn mean_excess(&self, _logs: [f64; 2], _wear: f64) -> Option<f64> {
        None
    }

    /// ln density of increments (exposure, wear) over the logarithm of the second parameter, the first held.
    fn slice(&self, first: f64, increments: &[(f64, f64)]) -> Slice;

    /// Bias of both maximum-likelihood parameters to first order in 1/n, where theory has it.
    fn first_order_bias(&self, _logs: [f64; 2], _exposures: &[f64]) -> Option<[f64; 2]> {
        None
    }

    /// Power of the first parameter that a prior without information is proportional to, in its logarithm and that of
    /// the second: the posterior of few readings is proper.
    fn flat_prior_power(&self) -> f64 {
        0.0
    }

    /// ln of what a flat prior is weighed by, at the logarithm of the first parameter, so that intervals predicted from
    /// increments (exposure, wear) match those of repeated sampling.
    fn ln_matching_weight(&self, _ln_first: f64, _increments: &[(f64, f64)]) -> f64 {
        0.0
    }

    /// Increments from which on a flat prior gives lives of finite variance; None if it never does.
    fn increments_for_variance(&self) -> Option<usize>;

    /// How its units may differ; None where no law of that is known.
    fn random_effect(&self) -> Option<&'static dyn RandomEffect> {
        None
    }

    /// Draws an increment over an exposure.
    fn draw(&self, logs: [f64; 2], exposure: f64, stream: &mut Stream) -> f64;

    /// Probability that an increment over an exposure is at most `wear`.
    fn cumulative(&self, logs: [f64; 2], exposure: f64, wear: f64) -> f64;

    /// Increment over an exposure that is not exceeded with probability `p`.
    fn quantile(&self, logs: [f64; 2], exposure: f64, p: f64) -> f64;

    /// ln of the probability that wear over the first of two exposures in a row was below `below`, given what it came to over both;
    /// None where there is no closed form of it.
    fn ln_bridge(&self, _logs: [f64; 2], _exposures: [f64; 2], _wear: f64, _below: f64) -> Option<f64> {
        None
    }

    /// Probability that wear stays below `left` > 0 throughout an exposure > 0. Wear that does not fall does so exactly if
    /// it is below in the end.
    fn survival(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        self.cumulative(logs, exposure, left)
    }

    /// Probability that wear reaches `left` > 0 within an exposure > 0, right to its last digits when small.
    fn failure(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64;

    /// Failures per unit of exposure among the survivors, -d ln survival / d exposure.
    fn hazard(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64;

    /// Mean and variance of the exposure at which wear reaches `left`, where they have closed forms.
    fn passage_moments(&self, _logs: [f64; 2], _left: f64) -> Option<(f64, f64)> {
        None
    }

    /// Mean exposure at which wear reaches `left`, perhaps but for terms that vanish exponentially with it: searches start from it.
    fn mean_exposure(&self, logs: [f64; 2], left: f64) -> f64;
}

impl PartialEq for dyn Process + '_ {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

/// A contribution to a log-likelihood with its derivatives by the logarithms of the two parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// The contribution.
    pub value: f64,
    /// First derivatives.
    pub gradient: [f64; 2],
    /// Second derivatives: by the first twice, mixed, by the second twice.
    pub hessian: [f64; 3],
}

/// A log-likelihood over the logarithm u of the second parameter: constant + slope u - scale exp(power u).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// What does not depend on u.
    pub constant: f64,
    /// Coefficient of u, of the sign of `power`.
    pub slope: f64,
    /// Coefficient of the exponential, positive.
    pub scale: f64,
    /// Power of the second parameter.
    pub power: f64,
}

impl Slice {
    /// The log-likelihood at u.
    pub fn at(&self, u: f64) -> f64 {
        self.constant + self.slope * u - self.scale * libm::exp(self.power * u)
    }

    /// u where it is largest.
    pub fn peak(&self) -> f64 {
        libm::log(self.slope / (self.scale * self.power)) / self.power
    }
}

/// Whether a sum of squares is more than rounding, beside what it is a part of.
pub(crate) fn scatters(squares: f64, scale: f64) -> bool {
    squares > 1e-24 * scale
}
