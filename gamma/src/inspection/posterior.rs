//! Posterior of the parameters of one joint after exact readings, and what it predicts.
//! In: readings, prior, threshold. Out: weighted nodes over the parameters; a [`Lifetime`] mixed from their closed forms.
//! Never knows files.
//!
//! Nested quadrature: along ln beta for each ln alpha, along ln alpha for each exponent, along the exponent if it is a
//! parameter. Each line gets its own points where its hump is, so narrow, skewed and funnel-shaped posteriors cost the
//! same. Against a closed form the reliability is good to 1e-7 (test below).

use super::credible::Mixture;
use super::error::InspectionError;
use super::history::History;
use super::likelihood::{Likelihood, Slice};
use crate::life::{Estimate, FirstPassage, LifeError, Lifetime, OperatingState};
use crate::quadrature::Hump;

/// Weight of all the lightest nodes together that are left out.
const NEGLIGIBLE: f64 = 1e-8;
/// A flat prior gives a finite variance from this many increments on: S(t) falls as t^-(increments - 1).
const FINITE_VARIANCE: usize = 4;
/// How far from the start a hump is looked for, in logarithms.
const FARTHEST: f64 = 60.0;

/// Largest logarithm of a parameter, either way, that is computed with.
const LARGEST: f64 = 690.0;

/// What was known before the readings.
#[derive(Clone, Debug, PartialEq)]
pub enum Prior {
    /// Nothing: flat in ln alpha and ln beta, and in ln exponent if that is a parameter.
    Flat {
        /// Whether exposure counts by an unknown power; else as it is.
        power_law: bool,
    },
    /// An estimate from other units of the same population: normal in the logarithms of its parameters. Without
    /// covariance the parameters are known, and readings say only where wear is.
    Fit(Estimate),
}

/// Parameters of one joint as its readings leave them.
#[derive(Debug)]
pub struct Posterior {
    nodes: Vec<Node>,
    /// Increments, if the prior was flat.
    flat: Option<usize>,
}

/// One point of the quadrature.
#[derive(Debug)]
struct Node {
    logs: Vec<f64>,
    weight: f64,
    life: FirstPassage,
}

/// Mean and standard deviation of one parameter's logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogParameter {
    /// Mean of the logarithm.
    pub mean: f64,
    /// Standard deviation of the logarithm.
    pub std: f64,
}

impl Posterior {
    /// After the readings of `history`; `situation` gives threshold and exposure per unit of time, the last reading the
    /// present.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn update(
        history: &History,
        prior: &Prior,
        situation: &OperatingState,
    ) -> Result<Self, InspectionError> {
        let last = history.last();
        let now = situation.clone().worn(last.wear, situation.rate() * last.time)?;
        let exposures: Vec<f64> =
            history.readings().iter().map(|reading| situation.rate() * reading.time).collect();
        let wear: Vec<f64> = history.readings().iter().map(|reading| reading.wear).collect();
        let increments = wear.len() - 1;
        let (start, size, flat) = match prior {
            Prior::Fit(fit) if !fit.is_uncertain() => {
                let node = Node { logs: fit.logs().to_vec(), weight: 1.0, life: now.life(fit)? };
                return Ok(Self { nodes: vec![node], flat: None });
            }
            Prior::Fit(fit) => {
                let size = fit.logs().len();
                if fit.factor().distance(&vec![0.0; size]).is_none() {
                    return Err(LifeError::Covariance { reason: "singular", size }.into());
                }
                (fit.logs().to_vec(), size, None)
            }
            Prior::Flat { power_law } => {
                let needed = if *power_law { 4 } else { 3 };
                if increments + 1 < needed {
                    let why = "with a flat prior, one more than parameters";
                    return Err(InspectionError::TooFew { readings: increments + 1, needed, why });
                }
                // The exponential law of as many increments: right order of magnitude.
                let total = exposures[increments] - exposures[0];
                let start = vec![(increments as f64 / total).ln(), 0.0, 0.0];
                (start, if *power_law { 3 } else { 2 }, Some(increments))
            }
        };
        let lines = Lines { likelihood: Likelihood::new(&exposures, &wear, prior), start };
        let Some(points) = lines.points(size) else {
            return Err(InspectionError::Proportional { readings: wear.len() });
        };
        Ok(Self { nodes: weighed(points, &now)?, flat })
    }

    /// Nodes of the quadrature.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// ln alpha, ln beta and perhaps ln exponent: mean and standard deviation.
    #[must_use]
    pub fn parameters(&self) -> Vec<LogParameter> {
        let one = |at: usize| {
            let mean: f64 = self.nodes.iter().map(|node| node.weight * node.logs[at]).sum();
            let square: f64 =
                self.nodes.iter().map(|node| node.weight * (node.logs[at] - mean).powi(2)).sum();
            LogParameter { mean, std: square.sqrt() }
        };
        (0..self.nodes[0].logs.len()).map(one).collect()
    }
}

impl Lifetime for Posterior {
    fn accuracy(&self) -> f64 {
        1e-7
    }

    fn reliability(&self, t: f64) -> f64 {
        self.nodes.iter().map(|node| node.weight * node.life.reliability(t)).sum()
    }

    fn typical(&self) -> f64 {
        // The heaviest node is in the middle.
        let heaviest = self.nodes.iter().max_by(|a, b| a.weight.total_cmp(&b.weight));
        heaviest.map_or(1.0, |node| node.life.typical())
    }

    fn failed(&self, t: f64) -> f64 {
        self.nodes.iter().map(|node| node.weight * node.life.failed(t)).sum()
    }

    fn hazard(&self, t: f64) -> f64 {
        let (mut density, mut alive) = (0.0, 0.0);
        for node in &self.nodes {
            let here = node.weight * node.life.reliability(t);
            density += here * node.life.hazard(t);
            alive += here;
        }
        density / alive
    }

    fn finite_moments(&self) -> Result<(), LifeError> {
        // T grows as e^(1/c) for small exponents c, whose probability falls only as a power.
        if self.flat.is_some() && self.nodes[0].logs.len() == 3 {
            return Err(LifeError::HeavyExponent);
        }
        match self.flat {
            Some(increments) if increments < FINITE_VARIANCE => {
                Err(LifeError::HeavyTail { increments, needed: FINITE_VARIANCE })
            }
            _ => Ok(()),
        }
    }
}

impl Mixture for Posterior {
    fn parts(&self) -> Vec<(f64, &FirstPassage)> {
        self.nodes.iter().map(|node| (node.weight, &node.life)).collect()
    }
}

/// The nested lines of the quadrature.
struct Lines<'a> {
    likelihood: Likelihood<'a>,
    start: Vec<f64>,
}

/// Logarithms of the parameters and ln of weight times density.
type Point = (Vec<f64>, f64);

impl Lines<'_> {
    fn points(&self, size: usize) -> Option<Vec<Point>> {
        if size == 2 {
            return self.over_alpha(0.0, &[]);
        }
        let area =
            |ln_exponent: f64| self.alpha_hump(ln_exponent).map_or(f64::NEG_INFINITY, |hump| hump.ln_area());
        let hump = Hump::find(&area, self.start[2], 0.3, FARTHEST)?;
        let mut points = Vec::new();
        for (ln_exponent, weight) in hump.points(&area) {
            let line = self.over_alpha(ln_exponent, &[ln_exponent])?;
            points.extend(line.into_iter().map(|(logs, ln)| (logs, ln + weight)));
        }
        Some(points)
    }

    fn alpha_hump(&self, ln_exponent: f64) -> Option<Hump> {
        let area = |ln_alpha: f64| self.beta_hump(ln_alpha, ln_exponent).1.ln_area();
        Hump::find(&area, self.start[0], 0.5, FARTHEST)
    }

    fn over_alpha(&self, ln_exponent: f64, more: &[f64]) -> Option<Vec<Point>> {
        let area = |ln_alpha: f64| self.beta_hump(ln_alpha, ln_exponent).1.ln_area();
        let hump = self.alpha_hump(ln_exponent)?;
        let mut points = Vec::new();
        for (ln_alpha, weight) in hump.points(&area) {
            let (slice, inner) = self.beta_hump(ln_alpha, ln_exponent);
            let density = |ln_beta: f64| self.likelihood.at(&slice, ln_alpha, ln_beta, ln_exponent);
            for (ln_beta, inner_weight) in inner.points(&density) {
                let mut logs = vec![ln_alpha, ln_beta];
                logs.extend(more);
                points.push((logs, density(ln_beta) + inner_weight + weight));
            }
        }
        Some(points)
    }

    /// Concave in ln beta: the hump is always found.
    fn beta_hump(&self, ln_alpha: f64, ln_exponent: f64) -> (Slice, Hump) {
        let slice = self.likelihood.slice(ln_alpha, ln_exponent);
        let density = |ln_beta: f64| self.likelihood.at(&slice, ln_alpha, ln_beta, ln_exponent);
        let empty = Hump { mode: slice.peak(), sigma: 1.0, top: f64::NEG_INFINITY };
        let hump = Hump::find(&density, slice.peak(), 0.1, 1e4).filter(|hump| hump.top.is_finite());
        (slice, hump.unwrap_or(empty))
    }
}

/// Weights that sum to 1, lives of the nodes that count.
fn weighed(points: Vec<Point>, now: &OperatingState) -> Result<Vec<Node>, InspectionError> {
    let top = points.iter().map(|point| point.1).fold(f64::NEG_INFINITY, f64::max);
    let mut kept: Vec<Point> = points.into_iter().filter(|point| point.1 > f64::NEG_INFINITY).collect();
    // Heaviest first, until the rest does not count. The sort is stable: the same nodes in every run.
    kept.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all: f64 = kept.iter().map(|point| (point.1 - top).exp()).sum();
    let mut total = 0.0;
    let enough = kept.iter().position(|point| {
        total += (point.1 - top).exp();
        total > (1.0 - NEGLIGIBLE) * all
    });
    kept.truncate(enough.map_or(kept.len(), |last| last + 1));
    let node = |(logs, ln): Point| {
        // Under a flat prior a tail of weight 1e-8 reaches rates below the smallest number; there the first jump fails.
        let within: Vec<f64> = logs.iter().map(|log| log.clamp(-LARGEST, LARGEST)).collect();
        let life = now.life_at(&within)?;
        Ok(Node { logs, weight: (ln - top).exp() / total, life })
    };
    kept.into_iter().map(node).collect()
}
