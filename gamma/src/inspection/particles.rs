//! Readings with a known gauge error: a bootstrap particle filter over parameters and wear.
//! In: readings, an estimate as prior, the gauge's standard error. Out: a [`Lifetime`] mixed over particles. Never knows
//! files.
//!
//! Each particle carries parameters drawn from the estimate and a wear path drawn with them from the new joint (time 0, no
//! wear), or from a reading at time 0 that is beyond the gauge's error from no wear; a later reading weighs it by the normal density of its error (Gordon, Salmond & Smith 1993), systematic resampling
//! follows when weights are uneven. Parameters do not move afterwards, so a reading the prior hardly explains leaves few
//! different particles: that is refused, not smoothed over.

use rand::RngExt;
use rand::distr::Open01;

use super::credible::Mixture;
use super::error::InspectionError;
use super::history::History;
use crate::error::LifeError;
use crate::life::{Estimate, FirstPassage, Lifetime, OperatingState, mixed_hazard};
use crate::process::Process;
use crate::random::{StandardNormal, Stream};

/// Different particles below which an answer is refused: three-digit probabilities need that many.
const FEWEST: usize = 200;

/// Gauge errors within which a reading at time 0 is one of no wear.
const UNWORN: f64 = 5.0;

/// Particles after the last reading, all of the same weight, none of them failed.
#[derive(Debug)]
pub struct Particles {
    lives: Vec<FirstPassage>,
    wear: Vec<f64>,
    failed_already: f64,
    distinct: usize,
}

/// How many particles, and what decides them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Particles.
    pub count: usize,
    /// Seed.
    pub seed: u64,
}

struct Particle {
    /// Which draw of the prior it descends from.
    origin: usize,
    logs: Vec<f64>,
    wear: f64,
}

impl Particles {
    /// After the readings of `history`, each off by a normal error of standard deviation `gauge` \[unit of wear\].
    ///
    /// # Errors
    /// [`InspectionError::Gauge`], [`InspectionError::Degenerate`], those of [`OperatingState`].
    pub fn follow(
        history: &History,
        prior: &Estimate,
        state: &OperatingState,
        gauge: f64,
        effort: Effort,
    ) -> Result<Self, InspectionError> {
        if !(gauge.is_finite() && gauge > 0.0) {
            return Err(InspectionError::Gauge { value: gauge });
        }
        let stream = |particle: usize| Stream::new(effort.seed, particle as u64, 0);
        // Beyond the particles: what resampling needs.
        let mut common = stream(effort.count);
        let mut particles: Vec<Particle> =
            (0..effort.count).map(|origin| Particle::new(origin, prior, &mut stream(origin))).collect();
        let process = prior.process();
        let mut ln_weights = vec![0.0; particles.len()];
        let mut fewest = (usize::MAX, 1);
        let mut before = 0.0;
        let begins_worn = history.readings()[0].time == 0.0 && history.readings()[0].wear > UNWORN * gauge;
        for (at, reading) in history.readings().iter().enumerate() {
            let now = state.rate() * reading.time;
            for (k, (particle, ln)) in particles.iter_mut().zip(&mut ln_weights).enumerate() {
                // Cycle 0 of a stream drew the parameters; reading n draws from cycle n.
                let mut own = stream(k);
                let draws = own.at(at as u64 + 1);
                if begins_worn && at == 0 {
                    let error: f64 = draws.sample(StandardNormal);
                    particle.wear = reading.wear + gauge * error;
                    continue;
                }
                particle.wear_on(process, before, now, draws);
                let off = (reading.wear - particle.wear) / gauge;
                *ln -= 0.5 * off * off;
            }
            before = now;
            let last = at + 1 == history.readings().len();
            if last || effective(&ln_weights) < 0.5 * particles.len() as f64 {
                particles = resampled(&particles, &ln_weights, common.sample(Open01));
                ln_weights.fill(0.0);
                let distinct = distinct(&particles);
                if distinct < fewest.0 {
                    fewest = (distinct, at + 1);
                }
            }
        }
        let (distinct, row) = fewest;
        if distinct < FEWEST {
            return Err(InspectionError::Degenerate { distinct, particles: effort.count, row });
        }
        Self::alive(process, particles, state, before, distinct)
    }

    fn alive(
        process: &'static dyn Process,
        particles: Vec<Particle>,
        state: &OperatingState,
        exposure: f64,
        distinct: usize,
    ) -> Result<Self, InspectionError> {
        let all = particles.len() as f64;
        let (mut lives, mut wear) = (Vec::new(), Vec::new());
        for particle in particles.iter().filter(|particle| particle.wear < state.threshold()) {
            lives.push(state.at_wear(particle.wear, exposure).life_at(process, &particle.logs)?);
            wear.push(particle.wear);
        }
        if lives.is_empty() {
            let (threshold, current) = (state.threshold(), particles[0].wear);
            return Err(LifeError::Failed { threshold, current }.into());
        }
        let failed_already = 1.0 - lives.len() as f64 / all;
        Ok(Self { lives, wear, failed_already, distinct })
    }

    /// Mean and standard deviation of the wear at the last reading, given that the joint has not failed.
    pub fn wear(&self) -> (f64, f64) {
        let count = self.wear.len() as f64;
        let mean = self.wear.iter().sum::<f64>() / count;
        let square = |wear: &f64| (wear - mean) * (wear - mean);
        (mean, libm::sqrt(self.wear.iter().map(square).sum::<f64>() / count))
    }

    /// Probability that wear had passed the threshold at the last reading already. The law of life is that of joints
    /// that had not.
    pub fn failed_already(&self) -> f64 {
        self.failed_already
    }

    /// Standard error of the mean life from the finite number of particles: the scatter of their mean wear paths over
    /// the different draws that are left.
    pub fn mean_error(&self) -> f64 {
        let typical: Vec<f64> = self.lives.iter().map(Lifetime::typical).collect();
        let count = typical.len() as f64;
        let mean = typical.iter().sum::<f64>() / count;
        let square = typical.iter().map(|t| (t - mean) * (t - mean)).sum::<f64>() / count;
        libm::sqrt(square / self.distinct as f64)
    }

    /// Different draws of the prior that are left.
    pub fn distinct(&self) -> usize {
        self.distinct
    }
}

impl Particle {
    fn new(origin: usize, prior: &Estimate, draws: &mut Stream) -> Self {
        Self { origin, logs: prior.drawn_unit(draws), wear: 0.0 }
    }

    /// Draws the wear between two exposures.
    fn wear_on(&mut self, process: &dyn Process, before: f64, now: f64, draws: &mut Stream) {
        let exponent = self.logs.get(2).map_or(1.0, |log| libm::exp(*log));
        let exposure = libm::pow(now, exponent) - libm::pow(before, exponent);
        if exposure > 0.0 {
            self.wear += process.draw([self.logs[0], self.logs[1]], exposure, draws);
        }
    }
}

/// Kish's effective number: (sum w)² / sum w².
fn effective(ln_weights: &[f64]) -> f64 {
    let top = ln_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (mut sum, mut squares) = (0.0, 0.0);
    for ln in ln_weights {
        let weight = libm::exp(ln - top);
        sum += weight;
        squares += weight * weight;
    }
    sum * sum / squares
}

/// Systematic resampling: one uniform number places a comb over the cumulated weights.
fn resampled(particles: &[Particle], ln_weights: &[f64], uniform: f64) -> Vec<Particle> {
    let top = ln_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = ln_weights.iter().map(|ln| libm::exp(ln - top)).collect();
    let step = weights.iter().sum::<f64>() / particles.len() as f64;
    let (mut at, mut reached) = (0, weights[0]);
    let mut next = Vec::with_capacity(particles.len());
    for k in 0..particles.len() {
        let tooth = (k as f64 + uniform) * step;
        while reached < tooth && at + 1 < particles.len() {
            at += 1;
            reached += weights[at];
        }
        let Particle { origin, logs, wear } = &particles[at];
        next.push(Particle { origin: *origin, logs: logs.clone(), wear: *wear });
    }
    next
}

/// Different origins; resampling keeps them in order.
fn distinct(particles: &[Particle]) -> usize {
    1 + particles.windows(2).filter(|pair| pair[0].origin != pair[1].origin).count()
}

impl Lifetime for Particles {
    fn accuracy(&self) -> f64 {
        1e-7
    }

    fn reliability(&self, t: f64) -> f64 {
        self.lives.iter().map(|life| life.reliability(t)).sum::<f64>() / self.lives.len() as f64
    }

    fn failed(&self, t: f64) -> f64 {
        self.lives.iter().map(|life| life.failed(t)).sum::<f64>() / self.lives.len() as f64
    }

    fn typical(&self) -> f64 {
        self.lives.iter().map(Lifetime::typical).sum::<f64>() / self.lives.len() as f64
    }

    fn hazard(&self, t: f64) -> f64 {
        mixed_hazard(self.lives.iter().map(|life| (life.reliability(t), life.hazard(t))))
    }
}

impl Mixture for Particles {
    fn parts(&self) -> Vec<(f64, &FirstPassage)> {
        let weight = 1.0 / self.lives.len() as f64;
        self.lives.iter().map(|life| (weight, life)).collect()
    }
}
