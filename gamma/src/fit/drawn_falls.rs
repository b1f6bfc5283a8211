//! By how much the likelihood falls from its top to the parameters that the data were drawn from. In: a model of rounded readings,
//! parameters, data alike. Out: falls in drawn data. Never knows which fall is critical.
//!
//! All data are judged on one lattice of parameters around those they were drawn from, so that laws are integrated once for all of
//! them: the process's two parameters by steps of the mean and of the scatter, what is between them by parabolas. Other parameters (an
//! exponent, powers of covariates) stay as they are.

use std::collections::HashMap;

use super::bootstrap::{draw, own_seed};
use super::estimate::Fit;
use super::model::Model;
use super::rounded::{Chain, Laws};
use crate::data::{Increment, Rounding};

/// From scatter to scatter, by the logarithm of alpha; from mean to mean, in standard errors of it without rounding.
const SCATTERS: f64 = 0.25;
const MEANS: f64 = 0.3;
/// Steps of a search along the lattice.
const MOST: usize = 400;
/// Places near no scatter, by the logarithm of the variance over the least that a gauge's readings tell from none, where the
/// likelihood is taken for what it tends to; they differ by less than 0.1, but where a line is the more likely the less it scatters.
pub const EDGE: [f64; 3] = [0.4, 1.2, 2.5];
/// Seed of drawn data, beside the data they are compared with.
const SEED: u64 = 12;

/// Which parameters vary beside those drawn from.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Along {
    /// The scatter, by steps, and the mean.
    Scatter(i64),
    /// The first parameter alone, by steps of the mean.
    First,
}

/// Data drawn from parameters, and their likelihood around these.
pub struct DrawnFalls<'a> {
    like: &'a [Increment],
    seed: u64,
    fit: Fit,
    rounding: Rounding,
    /// Of the mean, in its logarithm.
    spacing: f64,
    /// Steps of scatter near no scatter.
    edge: Vec<i64>,
    chains: HashMap<(Along, i64), Chain>,
    /// Likelihoods of the data at hand.
    known: HashMap<(Along, i64), f64>,
}

impl<'a> DrawnFalls<'a> {
    /// None for exact readings.
    pub fn new(model: &Model, phi: Vec<f64>, like: &'a [Increment]) -> Option<Self> {
        let rounding = model.resolution?;
        let growth = || like.iter().filter(|one| one.is_growth());
        let logs = |one: &Increment| model.logs(&phi, one);
        let mean: f64 = growth().map(|one| libm::exp(model.process.ln_mean(logs(one)))).sum();
        let variance: f64 = growth().map(|one| model.process.variance(logs(one))).sum();
        let scatter = model.ln_scatter(&phi, like);
        #[allow(clippy::cast_possible_truncation, reason = "saturates")]
        let edge = EDGE.iter().map(|near| libm::floor((scatter - near) / SCATTERS) as i64).collect();
        let spacing = MEANS * libm::sqrt(variance) / mean;
        let fit = Fit { model: *model, phi, covariance: vec![], log_likelihood: 0.0, increments: like.len() };
        let seed = own_seed(SEED, like);
        Some(Self { like, seed, fit, rounding, spacing, edge, chains: HashMap::new(), known: HashMap::new() })
    }

    /// Twice the fall in data of this number, one of the first two parameters held.
    pub fn drawn(&mut self, index: usize, number: u64) -> Option<f64> {
        let increments = draw(&self.fit, self.like, self.seed, number);
        self.fall(index, &increments)
    }

    /// Twice the fall in data.
    pub fn fall(&mut self, index: usize, data: &[Increment]) -> Option<f64> {
        self.known.clear();
        let start = self.mean_beside(data);
        let held = match index {
            0 => self.best_mean(Along::Scatter(0), start, data).1,
            // More of the first parameter is more of the mean.
            _ => self.best_mean(Along::First, start, data).1,
        };
        let top = self.top(start, data).max(held);
        Some(2.0 * (top - held)).filter(|fall| fall.is_finite())
    }

    /// The largest likelihood of all, at the edge, too.
    fn top(&mut self, start: i64, data: &[Increment]) -> f64 {
        let edge = self.edge.clone();
        let last = edge.iter().copied().max().unwrap_or(0);
        let mut mean = start;
        let mut at = |scatter: i64| {
            if scatter > last {
                return f64::NEG_INFINITY;
            }
            // From the mean of the data, and from that which was best last.
            let found = [start, mean].map(|mean| self.best_mean(Along::Scatter(scatter), mean, data));
            let best = if found[0].1 > found[1].1 { found[0] } else { found[1] };
            mean = best.0;
            best.1
        };
        let inside = climb(&mut at, 0).1;
        edge.into_iter().map(at).fold(inside, f64::max)
    }

    /// By how many steps the mean of data is beside that of the parameters.
    fn mean_beside(&self, data: &[Increment]) -> i64 {
        let growth = || data.iter().filter(|one| one.is_growth());
        let logs = |one: &Increment| self.fit.model.logs(&self.fit.phi, one);
        let mean: f64 = growth().map(|one| libm::exp(self.fit.model.process.ln_mean(logs(one)))).sum();
        let wear: f64 = growth().map(|one| one.wear).sum();
        #[allow(clippy::cast_possible_truncation, reason = "saturates")]
        let steps = libm::round(libm::log(wear.max(0.5 * self.rounding.step) / mean) / self.spacing) as i64;
        steps
    }

    fn best_mean(&mut self, along: Along, start: i64, data: &[Increment]) -> (i64, f64) {
        climb(&mut |mean| self.value(along, mean, data), start)
    }

    fn value(&mut self, along: Along, mean: i64, data: &[Increment]) -> f64 {
        let Self { fit, rounding, spacing, chains, known, .. } = self;
        if let Some(known) = known.get(&(along, mean)) {
            return *known;
        }
        let mut phi = fit.phi.clone();
        let more = mean as f64 * *spacing;
        match along {
            Along::Scatter(steps) => {
                phi[0] += steps as f64 * SCATTERS;
                phi[1] += steps as f64 * SCATTERS - more;
            }
            Along::First => phi[0] += more,
        }
        let logs = |one: &Increment| fit.model.logs(&phi, one);
        let chain = chains.entry((along, mean)).or_insert_with(|| Chain::of_many_laws(*rounding));
        let value = chain.ln_likelihood(Laws { process: fit.model.process, logs: &logs }, data);
        let value = if value.is_nan() { f64::NEG_INFINITY } else { value };
        known.insert((along, mean), value);
        value
    }
}

/// From a place of a lattice up to the next top: its place, and the top of the parabola there.
fn climb(at: &mut dyn FnMut(i64) -> f64, start: i64) -> (i64, f64) {
    let mut place = start;
    let (mut down, mut here, mut up) = (at(place - 1), at(place), at(place + 1));
    for _ in 0..MOST {
        if up > here && up >= down {
            place += 1;
            (down, here, up) = (here, up, at(place + 1));
        } else if down > here {
            place -= 1;
            (down, here, up) = (at(place - 1), down, here);
        } else {
            break;
        }
    }
    let bend = down + up - 2.0 * here;
    let gain = (up - down) * (up - down) / (-8.0 * bend);
    // Where a window ends the likelihood falls off at once, and no parabola tells more.
    (place, if bend < 0.0 && bend.is_finite() && gain < -0.5 * bend { here + gain } else { here })
}
