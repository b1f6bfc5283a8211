//! Rodas5P: a Rosenbrock method of order 5, stiffly accurate and L-stable, with an error of order 4 and dense output of order 4.
//! In: a problem and the slopes' derivatives by its state. Out: the end of a step, its error, states within it.
//!
//! Every stage is a linear system with one matrix, so that nothing is iterated: what vibrates much faster than the motion goes
//! where it would come to rest, and steps are as long as the motion alone allows. Coefficients: G. Steinebach, Construction of
//! Rosenbrock-Wanner method Rodas5P and numerical benchmarks within the Julia Differential Equations package, BIT Numerical
//! Mathematics 63 (2023) 27. The form with `k` in place of slopes: Hairer, Wanner, Solving Ordinary Differential Equations II,
//! 2nd ed., IV.7.

use super::adaptive::{Method, Step};
use super::problem::Problem;
use super::stage_system::StageSystem;
use crate::error::RunError;
use crate::linear::add_scaled;

const GAMMA: f64 = 0.211_937_563_194_290_14;
/// Weights of earlier solutions in the state of a stage.
const A: [[f64; 7]; 8] = [
    [0.0; 7],
    [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.849_394_379_747_939, 0.458_422_422_044_639_23, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-6.954_028_509_809_101, 2.489_845_061_869_568, -10.358_996_098_473_584, 0.0, 0.0, 0.0, 0.0],
    [
        2.802_998_627_562_896_4,
        0.507_246_473_622_820_6,
        -0.398_831_254_177_052_4,
        -0.047_211_872_304_046_41,
        0.0,
        0.0,
        0.0,
    ],
    [LAST[0], LAST[1], LAST[2], LAST[3], LAST[4], 0.0, 0.0],
    [LAST[0], LAST[1], LAST[2], LAST[3], LAST[4], 1.0, 0.0],
    [LAST[0], LAST[1], LAST[2], LAST[3], LAST[4], 1.0, 1.0],
];
/// Of the last three stages, which lie at the end of the step, and of the end itself.
const LAST: [f64; 5] = [
    -7.502_846_399_306_121,
    2.561_846_144_803_919,
    -11.627_539_656_261_098,
    -0.182_687_676_599_422_56,
    0.030_198_172_008_377_946,
];
/// Weights of earlier solutions on the right-hand side of a stage, by the length of the step.
const C: [[f64; 7]; 8] = [
    [0.0; 7],
    [-14.155_112_264_123_755, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-17.972_960_358_859_52, -2.859_693_295_451_294, 0.0, 0.0, 0.0, 0.0, 0.0],
    [147.121_502_757_117_16, -1.412_214_027_182_13, 71.689_402_513_023_58, 0.0, 0.0, 0.0, 0.0],
    [
        165.435_170_248_716_76,
        -0.459_282_345_649_112_6,
        42.909_383_369_586_03,
        -5.961_986_721_573_306,
        0.0,
        0.0,
        0.0,
    ],
    [
        24.854_864_614_690_072,
        -3.000_922_700_283_218_6,
        47.493_111_002_076_8,
        5.581_419_782_155_812_5,
        -0.661_069_182_524_947_1,
        0.0,
        0.0,
    ],
    [
        30.912_732_140_285_99,
        -3.120_824_334_993_797_4,
        77.799_546_460_708_92,
        34.286_460_282_947_83,
        -19.097_331_116_725_623,
        -28.087_943_162_872_662,
        0.0,
    ],
    [
        37.802_771_233_905_63,
        -3.257_196_902_907_227_6,
        112.269_188_494_963_27,
        66.934_723_124_404_7,
        -40.066_189_370_910_02,
        -54.667_802_628_779_68,
        -9.488_616_523_096_27,
    ],
];
/// Parts of the step at which the stages lie.
const PARTS: [f64; 8] = [
    0.0,
    0.635_812_689_582_870_4,
    0.409_579_839_339_753_5,
    0.976_930_672_506_071_6,
    0.428_840_360_955_866_4,
    1.0,
    1.0,
    1.0,
];
/// Weights of the derivative by time, by the length of the step.
const D: [f64; 5] = [
    GAMMA,
    -0.423_875_126_388_580_27,
    -0.338_462_712_623_592_4,
    1.804_645_287_288_273_4,
    2.325_825_639_765_069,
];
/// Weights of the solutions in the three coefficients of the dense output.
const H: [[f64; 8]; 3] = [
    [
        25.948_786_856_663_858,
        -2.557_972_484_584_623_5,
        10.433_815_404_888_879,
        -2.367_925_102_268_520_4,
        0.524_948_541_321_073,
        1.124_108_831_045_040_4,
        0.427_287_619_443_187_4,
        -0.172_022_210_701_554_93,
    ],
    [
        -9.915_688_506_951_71,
        -0.968_994_459_411_515_4,
        3.043_803_724_297_845_3,
        -24.495_224_566_215_796,
        20.176_138_334_709_044,
        15.980_663_614_246_51,
        -6.789_040_303_419_874,
        -6.710_236_069_923_372,
    ],
    [
        11.419_903_575_922_262,
        2.887_964_514_613_699_4,
        72.921_379_959_960_29,
        80.125_118_346_226_43,
        -52.072_871_366_152_654,
        -59.789_936_252_667_29,
        -0.155_826_842_827_519_13,
        4.883_087_185_713_722,
    ],
];
/// Numbers that are worked on at once.
type Block = [f64; 4];

/// Solutions of the stages so far, component by component: sums over all of them are made without passing them again.
#[derive(Clone, Debug)]
struct Solutions(Vec<[Block; 8]>);

/// Storage of the stages.
#[derive(Clone, Debug)]
pub struct Rodas5P {
    /// Slopes at the begin of a step and at its end.
    slopes: [Vec<f64>; 2],
    solutions: Solutions,
    /// Right-hand side of a stage, and its solution.
    right: Vec<f64>,
    solution: Vec<f64>,
    system: StageSystem,
    /// Values at both ends of the last step, and what the dense output bends.
    ends: [Vec<f64>; 2],
    bends: [Vec<f64>; 3],
}

impl Solutions {
    fn new(dimension: usize) -> Self {
        Self(vec![[[0.0; 4]; 8]; dimension.div_ceil(4)])
    }

    fn put(&mut self, stage: usize, solution: &[f64]) {
        // Whole blocks first: those are moved as they are, what is left number by number.
        let (whole, rest) = solution.as_chunks::<4>();
        let (blocks, last) = self.0.split_at_mut(whole.len());
        blocks.iter_mut().zip(whole).for_each(|(block, values)| block[stage] = *values);
        for (place, value) in last.iter_mut().flat_map(|block| &mut block[stage]).zip(rest) {
            *place = *value;
        }
    }

    /// Adds the weighted sum of as many solutions as there are weights.
    fn add(&self, weights: &[f64], values: &mut [f64]) {
        let (whole, rest) = values.as_chunks_mut::<4>();
        let (blocks, last) = self.0.split_at(whole.len());
        for (values, block) in whole.iter_mut().zip(blocks) {
            let sums = sums(weights, block);
            *values = std::array::from_fn(|i| values[i] + sums[i]);
        }
        for (value, sum) in rest.iter_mut().zip(last.iter().flat_map(|block| sums(weights, block))) {
            *value += sum;
        }
    }
}

/// Weighted sums of a block's solutions, as many as there are weights.
#[inline(always)]
fn sums(weights: &[f64], solutions: &[Block; 8]) -> Block {
    let mut sums = [0.0; 4];
    for (weight, solution) in weights.iter().zip(solutions) {
        sums = std::array::from_fn(|i| sums[i] + weight * solution[i]);
    }
    sums
}

impl Method for Rodas5P {
    const ORDER: f64 = 5.0;
    /// Where modes ring, errors of forces are then 0.3 to 1 times the tolerance, 0.1 where they have died out (RSSR with a flexible
    /// coupler, 5e-4 to 1e-8).
    const SHARE: f64 = 2.5;

    fn new(dimension: usize) -> Self {
        let zero = || vec![0.0; dimension];
        Self {
            slopes: [zero(), zero()],
            solutions: Solutions::new(dimension),
            right: zero(),
            solution: zero(),
            system: StageSystem::default(),
            ends: [zero(), zero()],
            bends: [zero(), zero(), zero()],
        }
    }

    fn begin(&mut self, problem: &mut dyn Problem, t: f64, y: &[f64]) -> Result<(), RunError> {
        self.system.forget();
        problem.derivative(t, y, &mut self.slopes[0])
    }

    fn slope(&self) -> &[f64] {
        &self.slopes[0]
    }

    fn attempt(
        &mut self,
        problem: &mut dyn Problem,
        step: Step<'_>,
        (next, error): (&mut [f64], &mut [f64]),
    ) -> Result<(), RunError> {
        let Self { slopes: [begin, end], solutions, right, solution, system, .. } = self;
        system.linearise(problem, step, begin)?;
        system.factor(GAMMA * step.length);
        let per_step = 1.0 / step.length;
        for stage in 0..8 {
            next.copy_from_slice(step.y);
            solutions.add(&A[stage][..stage], next);
            if stage == 0 {
                right.copy_from_slice(begin);
            } else {
                let t = if stage >= 5 { step.end } else { step.t + PARTS[stage] * step.length };
                problem.derivative(t, next, right)?;
            }
            solutions.add(&C[stage].map(|weight| weight * per_step)[..stage], right);
            if let Some(weight) = D.get(stage) {
                add_scaled(right, weight * step.length, system.by_time());
            }
            system.solve(right, solution);
            solutions.put(stage, solution);
        }
        // The last solution is the difference to an embedded one of order 4.
        for (i, difference) in solution.iter().enumerate() {
            next[i] += difference;
            error[i] = difference * per_step;
        }
        // What vibrates by z radians in `gamma h` takes over 1/z of an error at most, and loses that within the step (L. F. Shampine,
        // L. S. Baca, Error estimators for stiff differential equations, J. Comput. Appl. Math. 11 (1984) 197): once modes have come to
        // rest, a quarter of the steps less, their forces still within .2 of the tolerance instead of .1.
        problem.pass_over(GAMMA * step.length, error);
        problem.project(step.end, step.y, next)?;
        problem.derivative(step.end, next, end)
    }

    fn accept(&mut self, step: Step<'_>, next: &[f64]) {
        self.ends[0].copy_from_slice(step.y);
        self.ends[1].copy_from_slice(next);
        for (bend, weights) in self.bends.iter_mut().zip(&H) {
            bend.fill(0.0);
            self.solutions.add(weights, bend);
        }
        self.take_back();
    }

    fn take_back(&mut self) {
        self.slopes.swap(0, 1);
        self.system.forget();
    }

    fn interpolate<const N: usize>(&self, s: [f64; N], y: &mut [[f64; N]]) {
        let ends = self.ends[0].iter().zip(&self.ends[1]);
        let [a, b, c] = &self.bends;
        let bends = a.iter().zip(b.iter().zip(c));
        for (values, ((begin, end), (a, (b, c)))) in y.iter_mut().zip(ends.zip(bends)) {
            *values = s.map(|s| {
                let r = 1.0 - s;
                r * begin + s * (end + r * (a + s * (b + s * c)))
            });
        }
    }

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.slopes.iter_mut().chain(&mut self.ends).chain(&mut self.bends).flatten().for_each(visit);
        self.system.forget();
    }
}

impl Rodas5P {
    /// Goes on from where another method got, with the slope there.
    pub(super) fn go_on_with(&mut self, slope: &[f64]) {
        self.slopes[0].copy_from_slice(slope);
        self.system.forget();
    }
}
