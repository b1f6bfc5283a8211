//! Lives along tables, and how they vary with parameters. In: the mean paths of a mechanism and of those beside it, draws. Out: when
//! lives end, and their derivatives. Never knows equations.
//!
//! A random life varies with its increments, and an increment with its shape by the derivative of the Gamma quantile: what the draw
//! would have been, had the same random number been drawn by the law beside it, dx/da = -(dP/da) / p.

use linkwear_gamma::monte_carlo::GammaDraw;
use linkwear_runtime::life::{LifeSettings, WearFlow};

/// Part of the wear that doubles the clearance, over which the slope of a gain is taken.
const STEP: f64 = 1e-5;

/// Lives of one mechanism, or of one beside it.
pub(super) struct Along {
    pub flow: WearFlow,
    pub settings: LifeSettings,
    /// Cycles of the mean path over those by physics, beta over alpha, of every joint.
    pub slower: Vec<f64>,
    /// ln alpha and ln beta of every joint; nothing without random lives.
    pub processes: Vec<[f64; 2]>,
}

/// The same of the mechanism, and on both sides of every parameter.
pub(super) struct Paths {
    pub base: Along,
    /// Sides of a parameter, and its step to each.
    pub beside: Vec<([Along; 2], f64)>,
}

/// A life and its derivatives by all parameters.
#[derive(Clone, Debug)]
pub(super) struct Life {
    /// The joint that fails.
    pub joint: usize,
    /// Cycles.
    pub cycles: f64,
    pub slopes: Vec<f64>,
}

impl Along {
    /// When the first joint fails on the mean path, and which.
    pub(super) fn end(&self) -> (usize, f64) {
        let times = (0..self.flow.joints()).map(|joint| (joint, self.life(joint)));
        times.fold((0, f64::INFINITY), |first, one| if one.1 < first.1 { one } else { first })
    }

    /// When a joint fails on the mean path.
    fn life(&self, joint: usize) -> f64 {
        self.slower[joint] * self.flow.time(joint, 0.0, self.settings.joints[joint].threshold)
    }

    /// Wear of a joint [m] after so many cycles of the mean path.
    pub(super) fn worn_after(&self, joint: usize, cycles: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.settings.joints[joint].threshold);
        // Halved to the last place: time grows with wear.
        while high - low > 1e-12 * high {
            let middle = 0.5 * (low + high);
            if self.slower[joint] * self.flow.time(joint, 0.0, middle) < cycles {
                low = middle
            } else {
                high = middle
            }
        }
        0.5 * (low + high)
    }
}

impl Paths {
    /// The mean path.
    pub(super) fn mean(&self) -> Life {
        let (joint, cycles) = self.base.end();
        let slopes = self
            .beside
            .iter()
            .map(|(sides, step)| (sides[1].life(joint) - sides[0].life(joint)) / (2.0 * step));
        Life { joint, cycles, slopes: slopes.collect() }
    }

    /// A random life; nothing if it does not end in as many cycles as the settings allow.
    pub(super) fn drawn(&self, draw: &GammaDraw, life: u64) -> Option<Life> {
        let (joints, parameters) = (self.base.flow.joints(), self.beside.len());
        let mut wear = vec![0.0; joints];
        let mut slopes = vec![vec![0.0; parameters]; joints];
        for cycle in 0..self.base.settings.most_cycles {
            let mut first: Option<Life> = None;
            for joint in 0..joints {
                let (from, gain) = (wear[joint], self.base.flow.gain(joint, wear[joint]));
                let by_wear = self.gain_slope(joint, from);
                let (drawn, by_mean) = draw.draw_with_slope(joint, life, cycle, gain);
                let gains: Vec<f64> = (0..parameters)
                    .map(|at| {
                        let gain = self.across(at, |side| side.flow.gain(joint, from));
                        gain + by_wear * slopes[joint][at]
                    })
                    .collect();
                // The shape goes with alpha as it goes with the mean, the whole with one over beta.
                let own = |at: usize| {
                    let [alpha, beta] =
                        [0, 1].map(|which| self.across(at, |side| side.processes[joint][which]));
                    by_mean * (gains[at] + gain * alpha) - drawn * beta
                };
                let changes: Vec<f64> = (0..parameters).map(own).collect();
                let threshold = self.base.settings.joints[joint].threshold;
                if from + drawn >= threshold {
                    let part = (threshold - from) / drawn;
                    let to = from + part * gain;
                    let time = self.base.flow.time(joint, from, to);
                    // The rates of the mean path at both ends of the time.
                    let [at_from, at_to] = [from, to].map(|wear| self.pace(joint, wear));
                    let by_parameter = |at: usize| {
                        let limit = self.across(at, |side| side.settings.joints[joint].threshold);
                        let part_slope = (limit - slopes[joint][at] - part * changes[at]) / drawn;
                        let end = slopes[joint][at] + part_slope * gain + part * gains[at];
                        let own = self.across(at, |side| side.flow.time(joint, from, to));
                        own + end * at_to - slopes[joint][at] * at_from
                    };
                    let cycles = cycle as f64 + time.clamp(0.0, 1.0);
                    if first.as_ref().is_none_or(|first| cycles < first.cycles) {
                        let slopes = (0..parameters).map(by_parameter).collect();
                        first = Some(Life { joint, cycles, slopes });
                    }
                }
                wear[joint] = from + drawn;
                slopes[joint].iter_mut().zip(&changes).for_each(|(slope, change)| *slope += change);
            }
            if first.is_some() {
                return first;
            }
        }
        None
    }

    /// Derivative by a parameter of what is known on its sides.
    fn across(&self, at: usize, of: impl Fn(&Along) -> f64) -> f64 {
        let (sides, step) = &self.beside[at];
        (of(&sides[1]) - of(&sides[0])) / (2.0 * step)
    }

    /// How the gain of a cycle grows with the wear at its begin.
    fn gain_slope(&self, joint: usize, wear: f64) -> f64 {
        let (low, high) = self.around(joint, wear);
        let gain = |wear| self.base.flow.gain(joint, wear);
        (gain(high) - gain(low)) / (high - low)
    }

    /// Cycles per wear on the mean path [1/m].
    fn pace(&self, joint: usize, wear: f64) -> f64 {
        let (low, high) = self.around(joint, wear);
        self.base.flow.time(joint, low, high) / (high - low)
    }

    fn around(&self, joint: usize, wear: f64) -> (f64, f64) {
        let step = STEP * self.base.settings.joints[joint].threshold;
        ((wear - step).max(0.0), wear + step)
    }
}
