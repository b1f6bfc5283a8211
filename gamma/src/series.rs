//! Life of a system of wearing joints: it ends when the first of them fails.
//! In: first passages of the joints, perhaps a factor they share. Out: a [`Lifetime`], which joint ends it, draws of the
//! factor for lives that have no closed form.
//! Never knows mechanisms.
//!
//! Given the exposures the joints wear independently: the reliabilities multiply. A shared factor Z (load, dirt, the
//! quality of one batch) makes the exposure of all joints run Z times as fast; its mean is 1. Then
//!
//! ```text
//! S(t) = E_Z [ product over joints of P(T_j > t | exposure Z Lambda_j) ].
//! ```

use rand::RngExt;

use crate::error::{LifeError, positive};
use crate::life::{FirstPassage, Lifetime, Survived, mixed_hazard};
use crate::quadrature::integrate;
use crate::random::{LnGamma, StandardNormal, Stream};

/// Pieces, each twice as long as the one before, over which lives are followed of which part never end: to 1e12 typical ones.
const DOUBLINGS: i32 = 40;

/// Law of the factor all joints share; mean 1, coefficient of variation `cov` > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SharedFactor {
    /// Gamma law of shape and rate 1 / cov².
    Gamma {
        /// Coefficient of variation.
        cov: f64,
    },
    /// Lognormal law.
    Lognormal {
        /// Coefficient of variation.
        cov: f64,
    },
}

impl SharedFactor {
    /// ln of a draw.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`] for its coefficient of variation.
    pub fn ln_draw(self, stream: &mut Stream) -> Result<f64, LifeError> {
        Ok(match self.law()? {
            Law::Gamma { shape } => stream.sample(LnGamma(shape)) - libm::log(shape),
            Law::Lognormal { sigma } => sigma * (stream.sample(StandardNormal) - 0.5 * sigma),
        })
    }

    /// Parameters of the law with mean 1.
    fn law(self) -> Result<Law, LifeError> {
        let cov = match self {
            Self::Gamma { cov } | Self::Lognormal { cov } => cov,
        };
        let square = positive("the coefficient of variation of the shared factor", cov)? * cov;
        Ok(match self {
            Self::Gamma { .. } => Law::Gamma { shape: 1.0 / square },
            Self::Lognormal { .. } => Law::Lognormal { sigma: libm::sqrt(libm::log1p(square)) },
        })
    }

    /// Points and weights of a trapezoid rule in ln Z. The rule converges faster than any power of the step here; the
    /// law is cut where its density has fallen to e^-45. Weights are scaled to sum 1.
    fn nodes(self) -> Result<Vec<(f64, f64)>, LifeError> {
        /// ln of the density that is left out.
        const CUT: f64 = -45.0;
        /// Steps per standard deviation.
        const FINE: f64 = 5.0;
        let (ln_density, spread): (Box<dyn Fn(f64) -> f64>, f64) = match self.law()? {
            Law::Gamma { shape } => {
                // Density of u = ln Z, relative to u = 0.
                (Box::new(move |u: f64| shape * (u - libm::exp(u) + 1.0)), 1.0 / libm::sqrt(shape))
            }
            Law::Lognormal { sigma } => {
                let mean = -0.5 * sigma * sigma;
                (Box::new(move |u: f64| -0.5 * (u - mean) * (u - mean) / (sigma * sigma)), sigma)
            }
        };
        let step = spread.min(1.0) / FINE;
        let mut nodes = Vec::new();
        for direction in [-1.0, 1.0] {
            let mut k = if direction > 0.0 { 0.0 } else { 1.0 };
            loop {
                let u = direction * k * step;
                let density = ln_density(u);
                if density < CUT {
                    break;
                }
                nodes.push((libm::exp(u), libm::exp(density)));
                k += 1.0;
            }
        }
        let total: f64 = nodes.iter().map(|node| node.1).sum();
        nodes.iter_mut().for_each(|node| node.1 /= total);
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(nodes)
    }
}

/// A shared factor by its parameters.
#[derive(Clone, Copy)]
enum Law {
    /// Shape and rate are the same number.
    Gamma { shape: f64 },
    /// The mean of the logarithm is -sigma²/2.
    Lognormal { sigma: f64 },
}

/// Several wearing joints; time runs from the present, in the unit all their clocks have.
#[derive(Clone, Debug)]
pub struct SeriesSystem {
    members: Vec<FirstPassage>,
    /// Values of the shared factor with their weights; one value 1 without it.
    factors: Vec<(f64, f64)>,
    shared: Option<SharedFactor>,
}

impl SeriesSystem {
    /// Joints that wear independently.
    ///
    /// # Errors
    /// [`LifeError::NoMember`].
    pub fn independent(members: Vec<FirstPassage>) -> Result<Self, LifeError> {
        if members.is_empty() {
            return Err(LifeError::NoMember);
        }
        Ok(Self { members, factors: vec![(1.0, 1.0)], shared: None })
    }

    /// Joints whose exposure runs faster or slower by a factor they share.
    ///
    /// # Errors
    /// [`LifeError::NoMember`], [`LifeError::NotPositive`] for its coefficient of variation.
    pub fn sharing(members: Vec<FirstPassage>, factor: SharedFactor) -> Result<Self, LifeError> {
        Ok(Self { factors: factor.nodes()?, shared: Some(factor), ..Self::independent(members)? })
    }

    /// Probability of each joint to be the one that ends the life, in the order given; sums to 1 within 1e-8.
    ///
    /// # Errors
    /// Those of [`Lifetime::quantile`], by which the range of integration is found.
    pub fn first_to_fail(&self) -> Result<Vec<f64>, LifeError> {
        self.first_to_fail_after(0.0)
    }

    /// The same of a system that has gone on for a time `from` without a failure.
    ///
    /// # Errors
    /// Those of [`Survived::new`] and of [`Lifetime::quantile`].
    pub fn first_to_fail_after(&self, from: f64) -> Result<Vec<f64>, LifeError> {
        let rest = Survived::new(self, from)?;
        let mut limits = match rest.quantile(1.0 - 1e-12) {
            Err(LifeError::Never { .. } | LifeError::Endless { .. }) => {
                // Part of the lives do not end: ever longer pieces, until as few are left of those that do.
                let pieces: Vec<f64> =
                    (0..DOUBLINGS).map(|k| from + rest.typical() * libm::exp2(f64::from(k))).collect();
                self.limits(
                    from + rest.typical() * libm::exp2(f64::from(DOUBLINGS)),
                    &[&[from], &pieces[..]].concat(),
                )
            }
            end => self.limits(from + end?, &[from, from + rest.quantile(0.5)?]),
        };
        limits.retain(|limit| *limit >= from);
        let alive = self.reliability(from);
        let part = |j: usize| {
            let density = |t: f64| {
                let at =
                    |(z, weight): &(f64, f64)| weight * self.members[j].hazard_at(t, *z) * self.alive(t, *z);
                [self.factors.iter().map(at).sum::<f64>()]
            };
            integrate(&density, &limits, [1e-10 * alive]).0[0] / alive
        };
        Ok((0..self.members.len()).map(part).collect())
    }

    fn alive(&self, t: f64, factor: f64) -> f64 {
        self.members.iter().map(|member| member.reliability_at(t, factor)).product()
    }
}

impl Lifetime for SeriesSystem {
    fn reliability(&self, t: f64) -> f64 {
        self.factors.iter().map(|(z, weight)| weight * self.alive(t, *z)).sum()
    }

    fn typical(&self) -> f64 {
        self.members.iter().map(Lifetime::typical).fold(f64::INFINITY, f64::min)
    }

    fn failed(&self, t: f64) -> f64 {
        if let ([member], [_]) = (&self.members[..], &self.factors[..]) {
            return member.failed(t);
        }
        // 1 - product of (1 - F_j) with the digits of small F_j kept.
        let at = |(z, weight): &(f64, f64)| {
            let ln: f64 = self.members.iter().map(|member| libm::log1p(-member.failed_at(t, *z))).sum();
            weight * -libm::expm1(ln)
        };
        self.factors.iter().map(at).sum()
    }

    fn ever(&self) -> f64 {
        1.0 - self.members.iter().map(|member| 1.0 - member.ever()).product::<f64>()
    }

    fn breaks(&self) -> Vec<f64> {
        self.members.iter().flat_map(Lifetime::breaks).collect()
    }

    fn hazard(&self, t: f64) -> f64 {
        mixed_hazard(self.factors.iter().map(|(z, weight)| {
            let hazards = self.members.iter().map(|member| member.hazard_at(t, *z));
            (weight * self.alive(t, *z), hazards.sum())
        }))
    }

    /// A factor near 0 lets joints live long: T grows as Z^(-1/g) where exposure grows as t^g, and E Z^-k of a Gamma
    /// law is finite only if 1/cov² > k.
    fn finite_moments(&self) -> Result<(), LifeError> {
        // One joint that fails for certain is enough.
        let mut alone = self.members.iter().map(Lifetime::finite_moments);
        if let Some(error) = alone.next().filter(Result::is_err)
            && alone.all(|other| other.is_err())
        {
            return error;
        }
        let Some(SharedFactor::Gamma { cov }) = self.shared else { return Ok(()) };
        let growth = self.members.iter().map(|member| member.clock().growth()).fold(0.0, f64::max);
        let below = libm::sqrt(0.5 * growth);
        if cov < below { Ok(()) } else { Err(LifeError::HeavyFactor { cov, below }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::life::{Clock, Law, LifeStatistics};
    use crate::process::Gamma;

    fn member(alpha: f64, threshold: f64) -> FirstPassage {
        let law = Law::new(&Gamma, [alpha, 10.0]).expect("valid");
        FirstPassage::new(law, Clock::linear(1.0).expect("valid"), threshold).expect("valid")
    }

    #[test]
    fn a_system_of_one_is_its_joint() {
        let (one, joint) =
            (SeriesSystem::independent(vec![member(8.0, 4.0)]).expect("one"), member(8.0, 4.0));
        for t in [0.5, 4.0, 7.0] {
            assert_eq!(one.reliability(t), joint.reliability(t));
            // The hazard is divided by a probability and multiplied by it again.
            assert!((one.hazard(t) / joint.hazard(t) - 1.0).abs() < 1e-12);
        }
        // Accuracy of the integral.
        assert!((one.first_to_fail().expect("one")[0] - 1.0).abs() < 1e-8);
    }

    #[test]
    fn alike_joints_end_the_life_alike_and_sooner() {
        let system = SeriesSystem::independent(vec![member(8.0, 4.0); 3]).expect("three");
        let t = 4.5;
        assert!((system.reliability(t) - member(8.0, 4.0).reliability(t).powi(3)).abs() < 1e-15);
        for share in system.first_to_fail().expect("three") {
            assert!((share - 1.0 / 3.0).abs() < 1e-8);
        }
    }

    #[test]
    fn the_shared_factor_has_mean_one_and_the_spread_asked_for() {
        for cov in [0.05, 0.3, 0.9] {
            for factor in [SharedFactor::Gamma { cov }, SharedFactor::Lognormal { cov }] {
                let nodes = factor.nodes().expect("valid");
                let moment = |k: i32| nodes.iter().map(|(z, weight)| weight * z.powi(k)).sum::<f64>();
                // Trapezoid rule of analytic functions: exponential convergence.
                assert!((moment(1) - 1.0).abs() < 1e-9, "{factor:?} {}", moment(1));
                assert!((moment(2) - 1.0 - cov * cov).abs() < 1e-8, "{factor:?} {}", moment(2));
            }
        }
    }

    #[test]
    fn drawn_factors_have_mean_one_and_the_spread_asked_for() {
        let count = 20_000;
        for factor in [SharedFactor::Gamma { cov: 0.3 }, SharedFactor::Lognormal { cov: 0.3 }] {
            let draw = |at: u64| factor.ln_draw(&mut Stream::new(5, at, 0)).expect("valid").exp();
            let drawn: Vec<f64> = (0..count).map(draw).collect();
            let seen = LifeStatistics::of(&drawn).expect("positive");
            // Four standard errors of a fixed seed.
            assert!((seen.mean().value - 1.0).abs() < 4.0 * seen.mean().error, "{factor:?}");
            assert!((seen.std().value - 0.3).abs() < 4.0 * seen.std().error, "{factor:?}");
        }
        assert!(SharedFactor::Gamma { cov: 0.0 }.ln_draw(&mut Stream::new(5, 0, 0)).is_err());
    }

    #[test]
    fn a_shared_factor_agrees_with_drawing_it() {
        let members = vec![member(8.0, 4.0), member(5.0, 3.0)];
        let system =
            SeriesSystem::sharing(members.clone(), SharedFactor::Lognormal { cov: 0.4 }).expect("valid");
        let sigma = (0.16_f64).ln_1p().sqrt();
        let mut draws = Stream::new(11, 0, 0);
        let (mut sum, mut squares, t, count) = (0.0, 0.0, 4.5, 20_000);
        for _ in 0..count {
            let z = (sigma * draws.sample(StandardNormal) - 0.5 * sigma * sigma).exp();
            let alive: f64 = members.iter().map(|member| member.reliability_at(t, z)).product();
            sum += alive;
            squares += alive * alive;
        }
        let mean = sum / f64::from(count);
        let error = ((squares / f64::from(count) - mean * mean) / f64::from(count)).sqrt();
        // Four standard errors of a fixed seed.
        assert!((mean - system.reliability(t)).abs() < 4.0 * error, "{mean} {}", system.reliability(t));
        // What the joints share makes them fail together: more systems live to a late time than without it.
        let alone: f64 = members
            .iter()
            .map(|member| {
                let one = SeriesSystem::sharing(vec![member.clone()], SharedFactor::Lognormal { cov: 0.4 });
                one.expect("valid").reliability(t)
            })
            .product();
        assert!(system.reliability(t) > alone);
        let shares: f64 = system.first_to_fail().expect("two").iter().sum();
        assert!((shares - 1.0).abs() < 1e-8, "{shares}");
    }

    #[test]
    fn moments_that_are_not_finite_are_refused() {
        let wide =
            SeriesSystem::sharing(vec![member(8.0, 4.0)], SharedFactor::Gamma { cov: 0.8 }).expect("valid");
        assert!(matches!(wide.moments(), Err(LifeError::HeavyFactor { .. })));
        assert!(wide.quantile(0.5).is_ok());
        assert!(SeriesSystem::independent(Vec::new()).is_err());
        assert!(SeriesSystem::sharing(vec![member(8.0, 4.0)], SharedFactor::Gamma { cov: -0.1 }).is_err());
    }
}
