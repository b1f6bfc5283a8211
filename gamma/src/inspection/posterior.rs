//! Posterior of the parameters of one joint after exact readings, and what it predicts.
//! In: readings, prior, threshold. Out: weighted nodes over the parameters; a [`Lifetime`] mixed from their closed forms.
//! Never knows files.
//!
//! Nested quadrature: along the second parameter for each first, along the first for each exponent, along the exponent if it is a
//! parameter. Each line gets its own points where its hump is, so narrow, skewed and funnel-shaped posteriors cost the
//! same. Against a closed form the reliability is good to 1e-7 (test below).

use super::credible::Mixture;
use super::error::InspectionError;
use super::history::History;
use super::likelihood::Likelihood;
use super::prior::Prior;
use crate::error::LifeError;
use crate::life::{FirstPassage, Lifetime, OperatingState, mixed_hazard};
use crate::process::{Process, Slice};
use crate::quadrature::Hump;

/// Weight of all the lightest nodes together that are left out.
const NEGLIGIBLE: f64 = 1e-8;
/// How far from the start a hump is looked for, in logarithms.
const FARTHEST: f64 = 60.0;

/// Largest logarithm of a parameter, either way, that is computed with.
const LARGEST: f64 = 690.0;

/// Parameters of one joint as its readings leave them.
#[derive(Debug)]
pub struct Posterior {
    process: &'static dyn Process,
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
    /// After the readings of `history`; `state` gives threshold and exposure per unit of time, the last reading the
    /// present.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn update(history: &History, prior: &Prior, state: &OperatingState) -> Result<Self, InspectionError> {
        let last = history.last();
        let now = state.clone().worn(last.wear, state.rate() * last.time)?;
        let increments = history.increments(state.rate());
        Self::of_increments(&increments, prior, &now)
    }

    /// After increments of any joints of one population, each exposure before (without an exponent), exposure after, wear;
    /// about a joint of the same population that is in state `now`.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn of_increments(
        increments: &[[f64; 3]],
        prior: &Prior,
        now: &OperatingState,
    ) -> Result<Self, InspectionError> {
        let (count, process) = (increments.len(), prior.process());
        let reference = prior.reference(increments);
        let counted = |[from, to, wear]: &[f64; 3]| [reference.counted(*from), reference.counted(*to), *wear];
        let increments: Vec<[f64; 3]> = increments.iter().map(counted).collect();
        let (start, size, flat) = match prior {
            Prior::Fit(fit) if !fit.is_uncertain() => {
                let node = Node { logs: fit.logs().to_vec(), weight: 1.0, life: now.life(fit)? };
                return Ok(Self { process, nodes: vec![node], flat: None });
            }
            Prior::Fit(fit) => {
                let size = fit.logs().len();
                if fit.factor().distance(&vec![0.0; size]).is_none() {
                    return Err(LifeError::Covariance { reason: "singular", size }.into());
                }
                (fit.logs_at_reference(), size, None)
            }
            Prior::Flat { .. } | Prior::Matching { .. } | Prior::Catalogue { .. } => {
                let power_law = prior.has_power_law();
                let needed = if power_law { 4 } else { 3 };
                if count + 1 < needed {
                    let why = "with a flat prior, one more than parameters";
                    return Err(InspectionError::TooFew { readings: count + 1, needed, why });
                }
                let exposures: Vec<f64> = increments.iter().map(|[from, to, _]| to - from).collect();
                let wear: Vec<f64> = increments.iter().map(|[.., wear]| *wear).collect();
                let Some([first, second]) = process.maximum(&exposures, &wear) else {
                    return Err(InspectionError::Proportional { readings: count + 1 });
                };
                (vec![first, second, 0.0], if power_law { 3 } else { 2 }, Some(count))
            }
        };
        let lines = Lines { likelihood: Likelihood::new(&increments, prior), start };
        let Some(mut points) = lines.points(size) else {
            return Err(InspectionError::Proportional { readings: count + 1 });
        };
        for (logs, _) in &mut points {
            let exponent = logs.get(2).map(|ln| libm::exp(*ln));
            reference.back(logs, exponent.unwrap_or(0.0));
        }
        // A catalogue keeps drifts away from 0, which are all that a Wiener process has to fear.
        let flat = flat.filter(|_| !(prior.is_catalogue() && process.increments_for_variance().is_none()));
        Ok(Self { process, nodes: weighed(points, process, now)?, flat })
    }

    /// Nodes of the quadrature.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Logarithms of the process's parameters and perhaps of the exponent: mean and standard deviation.
    pub fn parameters(&self) -> Vec<LogParameter> {
        let one = |at: usize| {
            let mean: f64 = self.nodes.iter().map(|node| node.weight * node.logs[at]).sum();
            let square: f64 = self
                .nodes
                .iter()
                .map(|node| node.weight * (node.logs[at] - mean) * (node.logs[at] - mean))
                .sum();
            LogParameter { mean, std: libm::sqrt(square) }
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
        let part = |node: &Node| (node.weight * node.life.reliability(t), node.life.hazard(t));
        mixed_hazard(self.nodes.iter().map(part))
    }

    fn finite_moments(&self) -> Result<(), LifeError> {
        let Some(increments) = self.flat else { return Ok(()) };
        // T grows as e^(1/c) for small exponents c, whose probability falls only as a power.
        if self.nodes[0].logs.len() == 3 {
            return Err(LifeError::HeavyExponent);
        }
        match self.process.increments_for_variance() {
            None => Err(LifeError::HeavyDrift),
            Some(needed) if increments < needed => Err(LifeError::HeavyTail { increments, needed }),
            Some(_) => Ok(()),
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
            return self.over_first(0.0, &[]);
        }
        let area =
            |ln_exponent: f64| self.first_hump(ln_exponent).map_or(f64::NEG_INFINITY, |hump| hump.ln_area());
        let hump = Hump::find(&area, self.start[2], 0.3, FARTHEST)?;
        let mut points = Vec::new();
        for (ln_exponent, weight) in hump.points(&area) {
            let line = self.over_first(ln_exponent, &[ln_exponent])?;
            points.extend(line.into_iter().map(|(logs, ln)| (logs, ln + weight)));
        }
        Some(points)
    }

    fn first_hump(&self, ln_exponent: f64) -> Option<Hump> {
        let area = |ln_first: f64| self.second_hump(ln_first, ln_exponent).1.ln_area();
        Hump::find(&area, self.start[0], 0.5, FARTHEST)
    }

    fn over_first(&self, ln_exponent: f64, more: &[f64]) -> Option<Vec<Point>> {
        let area = |ln_first: f64| self.second_hump(ln_first, ln_exponent).1.ln_area();
        let hump = self.first_hump(ln_exponent)?;
        let mut points = Vec::new();
        for (ln_first, weight) in hump.points(&area) {
            let (slice, inner) = self.second_hump(ln_first, ln_exponent);
            let density = |ln_second: f64| self.likelihood.at(&slice, &[ln_first, ln_second, ln_exponent]);
            for (ln_second, inner_weight) in inner.points(&density) {
                let mut logs = vec![ln_first, ln_second];
                logs.extend(more);
                points.push((logs, density(ln_second) + inner_weight + weight));
            }
        }
        Some(points)
    }

    /// Concave along the second parameter: the hump is always found.
    fn second_hump(&self, ln_first: f64, ln_exponent: f64) -> (Slice, Hump) {
        let slice = self.likelihood.slice(ln_first, ln_exponent);
        let density = |ln_second: f64| self.likelihood.at(&slice, &[ln_first, ln_second, ln_exponent]);
        let empty = Hump { mode: slice.peak(), sigma: 1.0, top: f64::NEG_INFINITY };
        let hump = Hump::find(&density, slice.peak(), 0.1, 1e4).filter(|hump| hump.top.is_finite());
        (slice, hump.unwrap_or(empty))
    }
}

/// Weights that sum to 1, lives of the nodes that count.
fn weighed(
    points: Vec<Point>,
    process: &'static dyn Process,
    now: &OperatingState,
) -> Result<Vec<Node>, InspectionError> {
    let top = points.iter().map(|point| point.1).fold(f64::NEG_INFINITY, f64::max);
    let mut kept: Vec<Point> = points.into_iter().filter(|point| point.1 > f64::NEG_INFINITY).collect();
    // Heaviest first, until the rest does not count. The sort is stable: the same nodes in every run.
    kept.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all: f64 = kept.iter().map(|point| libm::exp(point.1 - top)).sum();
    let mut total = 0.0;
    let enough = kept.iter().position(|point| {
        total += libm::exp(point.1 - top);
        total > (1.0 - NEGLIGIBLE) * all
    });
    kept.truncate(enough.map_or(kept.len(), |last| last + 1));
    let node = |(logs, ln): Point| {
        // Under a flat prior a tail of weight 1e-8 reaches rates below the smallest number; there the first jump fails.
        let within: Vec<f64> = logs.iter().map(|log| log.clamp(-LARGEST, LARGEST)).collect();
        let life = now.life_at(process, &within)?;
        Ok(Node { logs, weight: libm::exp(ln - top) / total, life })
    };
    kept.into_iter().map(node).collect()
}
