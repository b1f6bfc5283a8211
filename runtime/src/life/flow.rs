//! The mean path by a table, solved once for all lives: what a cycle adds to a joint's wear, and how long wear takes, as
//! flat tables of cubics. In: tables of the wear per revolution. Out: both from any wear on, in a few operations and
//! without allocation. Never knows draws.
//!
//! By a table a joint's wear depends on its own W alone, dW/dn = r(W) per cycle, so that time is the integral of dW/r and a
//! cycle's gain G solves "from W to W + G takes one cycle". Cells are equal parts of the octaves of u = 1 + W/scale, the
//! clearance in units of c0: exponent and leading bits of u are the number of its cell, no search and no logarithm.
//! Slopes at the nodes are exact (1/r, and r(W + G)/r(W) - 1), so errors go with the fourth power of the cell; cells are
//! made smaller until gain and time are met in between to [`ERROR`].

use super::interpolate::{at, cubic};
use super::joint::JointLife;

/// Largest error of a gain in between, as a part of it, and of a time over a cell, as a part of that.
pub const ERROR: f64 = 1e-9;
/// Cells of an octave, as powers of two: the first that is fine enough.
const RESOLUTIONS: [u32; 4] = [6, 8, 10, 12];
/// Cells of a table: 4 MB. More octaves than that are no bearing.
const MOST_CELLS: usize = 1 << 16;
/// Bits of a double after the point.
const FRACTION_BITS: u32 = 52;
/// Steps of Newton's method for a gain; four are usual.
const MOST_STEPS: usize = 50;

/// Abscissas and weights of Gauss and Legendre's rule of five points on [-1, 1].
#[expect(clippy::excessive_precision, reason = "digits as published")]
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_663_993, 0.236_926_885_056_189_088),
    (-0.538_469_310_105_683_091, 0.478_628_670_499_366_468),
    (0.0, 0.568_888_888_888_888_889),
    (0.538_469_310_105_683_091, 0.478_628_670_499_366_468),
    (0.906_179_845_938_663_993, 0.236_926_885_056_189_088),
];

/// The mean paths of all wearing joints, each by its own wear.
#[derive(Clone, Debug, PartialEq)]
pub struct WearFlow {
    joints: Vec<JointFlow>,
}

/// That of a joint. Nothing in it if the joint does not wear.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct JointFlow {
    /// One over the wear that doubles the clearance [1/m].
    per_scale: f64,
    resolution: u32,
    /// Cubics in the part of a cell: the gain of a cycle [m].
    gains: Vec<[f64; 4]>,
    /// Cubics in the part of a cell: time since the joint was unworn [cycles].
    times: Vec<[f64; 4]>,
}

impl WearFlow {
    /// Of joints that are each by themselves.
    pub(super) fn new(joints: Vec<JointFlow>) -> Option<Self> {
        // A mechanism that does not wear has no life; whoever lives it says so.
        joints.iter().any(|joint| !joint.gains.is_empty()).then_some(Self { joints })
    }

    /// Number of wearing joints.
    pub fn joints(&self) -> usize {
        self.joints.len()
    }

    /// Mean increment [m] of the cycle that begins at wear W [m]. Not a number beyond the threshold.
    #[inline]
    pub fn gain(&self, joint: usize, wear: f64) -> f64 {
        let flow = &self.joints[joint];
        if flow.gains.is_empty() { 0.0 } else { flow.at(&flow.gains, wear) }
    }

    /// How long [cycles] the mean path takes from one wear [m] to another. Not a number beyond a cycle after the threshold.
    pub fn time(&self, joint: usize, from: f64, to: f64) -> f64 {
        let flow = &self.joints[joint];
        flow.at(&flow.times, to) - flow.at(&flow.times, from)
    }
}

impl JointFlow {
    /// Gain of the first cycle [m].
    pub(super) fn first(&self) -> f64 {
        self.gains.first().map_or(0.0, |cubic| cubic[3])
    }

    #[inline]
    fn at(&self, cells: &[[f64; 4]], wear: f64) -> f64 {
        let (cell, part) = place(wear * self.per_scale, self.resolution);
        cells.get(cell).map_or(f64::NAN, |cubic| at(cubic, part))
    }

    /// Of a joint whose wear per cycle is `rate` of its wear, smooth but at `knots` (rising), with this scale. Nothing if that
    /// leads out of what holds for the joint, or cannot be met.
    pub(super) fn new(
        joint: &JointLife,
        scale: f64,
        knots: &[f64],
        rate: &dyn Fn(f64) -> f64,
    ) -> Option<Self> {
        if knots.iter().chain([&0.0]).all(|knot| rate(*knot) == 0.0) {
            return Some(Self::default());
        }
        RESOLUTIONS.into_iter().find_map(|resolution| {
            let path = Solved::new(joint, scale, resolution, knots, rate)?;
            path.cells()
        })
    }
}

/// The cell and the part of it of u = 1 + wear/scale.
#[inline]
fn place(worn: f64, resolution: u32) -> (usize, f64) {
    let shift = FRACTION_BITS - resolution;
    let bits = (1.0 + worn).to_bits();
    let cell = (bits >> shift).wrapping_sub(1.0_f64.to_bits() >> shift);
    // The bits after those of the cell, moved up: a number from 1 to below 2.
    let rest = (bits << resolution) & ((1 << FRACTION_BITS) - 1);
    (usize::try_from(cell).unwrap_or(usize::MAX), f64::from_bits(rest | 1.0_f64.to_bits()) - 1.0)
}

/// Where a cell begins: wear over scale.
fn node(cell: usize, resolution: u32) -> f64 {
    let shift = FRACTION_BITS - resolution;
    f64::from_bits(((1.0_f64.to_bits() >> shift) + cell as u64) << shift) - 1.0
}

/// The mean path of a joint at the nodes.
struct Solved<'a> {
    rate: &'a dyn Fn(f64) -> f64,
    knots: &'a [f64],
    scale: f64,
    resolution: u32,
    /// Wear [m] and time since the joint was unworn [cycles], to a cycle after the threshold.
    nodes: Vec<(f64, f64)>,
    /// Nodes that the threshold is between.
    reach: usize,
}

impl<'a> Solved<'a> {
    fn new(
        joint: &JointLife,
        scale: f64,
        resolution: u32,
        knots: &'a [f64],
        rate: &'a dyn Fn(f64) -> f64,
    ) -> Option<Self> {
        let mut path = Self { rate, knots, scale, resolution, nodes: vec![(0.0, 0.0)], reach: 0 };
        let mut time = 0.0;
        loop {
            let cell = path.nodes.len();
            let (from, to) = (path.nodes[cell - 1].0, scale * node(cell, resolution));
            time += path.quadrature(from, to);
            let is_allowed = joint.clearance + joint.gamma() * to < joint.journal_radius;
            if !(is_allowed && time.is_finite() && cell <= MOST_CELLS) {
                return None;
            }
            path.nodes.push((to, time));
            if path.reach == 0 && to >= joint.threshold {
                path.reach = cell;
            }
            if path.reach > 0 && time > path.nodes[path.reach].1 + 1.0 {
                return Some(path);
            }
        }
    }

    /// Cycles from one wear to another nearby; knots of the rate are between panels.
    fn quadrature(&self, from: f64, to: f64) -> f64 {
        let first = self.knots.partition_point(|knot| *knot <= from);
        let inside = self.knots[first..].iter().copied().take_while(|knot| *knot < to);
        let (mut sum, mut start) = (0.0, from);
        for end in inside.chain([to]) {
            let (half, middle) = (0.5 * (end - start), 0.5 * (end + start));
            sum += half * GAUSS.iter().map(|(x, w)| w / (self.rate)(middle + half * x)).sum::<f64>();
            start = end;
        }
        sum
    }

    /// Time [cycles] since the joint was unworn.
    fn time(&self, wear: f64) -> f64 {
        let (cell, _) = place(wear / self.scale, self.resolution);
        let (start, time) = self.nodes[cell.min(self.nodes.len() - 1)];
        time + self.quadrature(start, wear)
    }

    /// The gain of a cycle from a wear on, at a time, by Newton's method from a guess.
    fn gain(&self, (wear, time): (f64, f64), guess: f64) -> Option<f64> {
        let mut gain = guess;
        for _ in 0..MOST_STEPS {
            let to = (wear + gain).min(self.nodes[self.nodes.len() - 1].0);
            let step = (self.time(to) - time - 1.0) * (self.rate)(to);
            // Never back beyond the begin.
            let next = (to - wear - step).max(0.1 * gain);
            // Time is rounded at its own size.
            if (next - gain).abs() <= 1e-14 * gain * time.max(1.0) {
                return Some(next);
            }
            gain = next;
        }
        None
    }

    /// The cubics, if they are good in the middle of every cell, where their errors are largest.
    fn cells(&self) -> Option<JointFlow> {
        let mut flow = JointFlow {
            per_scale: 1.0 / self.scale,
            resolution: self.resolution,
            gains: Vec::with_capacity(self.reach),
            times: Vec::with_capacity(self.nodes.len()),
        };
        let mut guess = (self.rate)(0.0);
        let mut gains = Vec::with_capacity(self.reach + 1);
        for node in &self.nodes[..=self.reach] {
            guess = self.gain(*node, guess)?;
            gains.push((guess, (self.rate)(node.0 + guess) / (self.rate)(node.0) - 1.0));
        }
        for (cell, pair) in self.nodes.windows(2).enumerate() {
            let [(from, start), (to, end)] = [pair[0], pair[1]];
            let width = to - from;
            let slopes = [from, to].map(|wear| width / (self.rate)(wear));
            flow.times.push(cubic((start, slopes[0]), (end, slopes[1])));
            let middle = from + 0.5 * width;
            let time = start + self.quadrature(from, middle);
            // What is no number is not met either.
            let is_met = |error: f64| error.abs() <= ERROR;
            if !is_met((flow.at(&flow.times, middle) - time) / (end - start)) {
                return None;
            }
            if let Some([(g0, m0), (g1, m1)]) = gains.get(cell..cell + 2) {
                flow.gains.push(cubic((*g0, width * m0), (*g1, width * m1)));
                let truth = self.gain((middle, time), *g0)?;
                if !is_met(flow.at(&flow.gains, middle) / truth - 1.0) {
                    return None;
                }
            }
        }
        Some(flow)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::life::{Feedback, WearOf};
    use crate::wear::{Limits, ScalarFeedback};

    const C0: f64 = 1e-5;

    fn joint(threshold: f64) -> JointLife {
        JointLife {
            joint: "R1".to_owned(),
            journal_radius: 0.01,
            clearance: C0,
            threshold,
            revolutions_per_cycle: 1.0,
            wear: WearOf::Depth,
            feedback: Feedback::Scalar(ScalarFeedback::new(1.0).unwrap()),
            bins: None,
            journal_bins: None,
            limits: Limits { hardness: 3.5e9, pressure_speed: None },
        }
    }

    /// A rate of a power of the clearance: (1 - p) u^p du/dt has u^(1-p) grow evenly.
    fn power(exponent: f64, first: f64) -> impl Fn(f64) -> f64 {
        move |wear| first * libm::pow(1.0 + wear / C0, exponent)
    }

    fn flow(threshold: f64, knots: &[f64], rate: &dyn Fn(f64) -> f64) -> Option<WearFlow> {
        WearFlow::new(vec![JointFlow::new(&joint(threshold), C0, knots, rate)?])
    }

    #[test]
    fn a_power_of_the_clearance_is_met_everywhere() {
        // From a life of 3 cycles to one of 30,000.
        for first in [2e-5, 3e-6, 3e-9] {
            for exponent in [-0.5, 0.0, 1.0 / 3.0, 0.5, 0.9] {
                let flow = flow(8e-5, &[], &power(exponent, first)).expect("a smooth rate");
                let rest = 1.0 - exponent;
                let after = |wear: f64, cycles: f64| {
                    let worn = libm::pow(1.0 + wear / C0, rest) + cycles * rest * first / C0;
                    C0 * (libm::pow(worn, 1.0 / rest) - 1.0)
                };
                for i in 0..1000 {
                    let wear = 8e-5 * f64::from(i) / 1000.0;
                    let gain = after(wear, 1.0) - wear;
                    // The difference above rounds at the size of W.
                    let error = (flow.gain(0, wear) - gain).abs() / gain;
                    assert!(error < ERROR + 1e-15 * wear / gain, "{first} {exponent} {wear}: {error}");
                    let time = flow.time(0, wear, after(wear, 0.4));
                    let life = 8e-5 / first;
                    assert!((time - 0.4).abs() < 1e-9 + 1e-14 * life, "{first} {exponent} {wear}: {time}");
                }
            }
        }
    }

    #[test]
    fn a_rate_with_kinks_in_its_curvature_is_met_between_them() {
        // Straight, then a parabola: C1, as curves through points are.
        let knot = 3e-5;
        let rate = |wear: f64| 3e-6 * (1.0 + 20.0 * ((wear - knot).max(0.0) / C0 / 10.0).powi(2));
        let flow = flow(8e-5, &[knot], &rate).expect("a rate");
        // Runge-Kutta of fourth order in 10,000 parts of the cycle.
        let after = |from: f64| {
            (0..10_000).fold(from, |wear, _| {
                let k1 = rate(wear);
                let k2 = rate(wear + 0.5e-4 * k1);
                let k3 = rate(wear + 0.5e-4 * k2);
                wear + 1e-4 / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(wear + 1e-4 * k3))
            })
        };
        for i in 0..200 {
            let wear = 8e-5 * f64::from(i) / 200.0;
            let gain = after(wear) - wear;
            // In the cells that hold the kink or come to it in a cycle the middle need not be worst: a few times more.
            assert!((flow.gain(0, wear) / gain - 1.0).abs() < 4.0 * ERROR, "{wear}");
        }
    }

    #[test]
    fn paths_that_leave_the_bearing_or_never_move_have_no_flow() {
        assert_eq!(flow(8e-5, &[], &|_| 0.0), None);
        assert_eq!(flow(8e-5, &[], &|wear| if wear < 4e-5 { 3e-6 } else { 0.0 }), None);
        assert_eq!(flow(8e-5, &[], &|wear| if wear < 4e-5 { 3e-6 } else { f64::NAN }), None);
        // The last cycle would end at a clearance of the journal's size.
        assert_eq!(flow(8e-5, &[], &power(0.5, 1e-1)), None);
        assert!(flow(8e-5, &[], &|_| 3e-6).expect("a path").gain(0, 9e-5).is_nan());
    }
}
