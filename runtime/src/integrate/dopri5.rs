//! Dormand-Prince 5(4): explicit, first same as last, dense output of order 4.
//! In: a problem, a step. Out: its end, its error, states within it.
//!
//! Tableau: Dormand & Prince, J. Comp. Appl. Math. 6 (1980) 19-26. Dense output: Hairer, Norsett, Wanner, Solving Ordinary
//! Differential Equations I, 2nd ed., II.6 (code DOPRI5).
//!
//! A projection comes before the last stage: the slope carried over to the next step belongs to the
//! projected state, and nothing is evaluated twice.

use super::adaptive::{Method, Step};
use super::dense::Cubics;
use super::problem::Problem;
use crate::error::RunError;
use crate::linear::add_scaled;

const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19_372.0 / 6_561.0, -25_360.0 / 2_187.0, 64_448.0 / 6_561.0, -212.0 / 729.0, 0.0, 0.0],
    [9_017.0 / 3_168.0, -355.0 / 33.0, 46_732.0 / 5_247.0, 49.0 / 176.0, -5_103.0 / 18_656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1_113.0, 125.0 / 192.0, -2_187.0 / 6_784.0, 11.0 / 84.0],
];
/// Difference of the solutions of order 5 and 4.
const E: [f64; 7] = [
    71.0 / 57_600.0,
    0.0,
    -71.0 / 16_695.0,
    71.0 / 1_920.0,
    -17_253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];
/// Weights of the fifth coefficient of the dense output.
const D: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// States that differ by no more than this part of their size differ by rounding.
const ROUNDED: f64 = 1e-13;

/// Storage of the stages.
#[derive(Clone, Debug)]
pub struct Dopri5 {
    slopes: [Vec<f64>; 7],
    /// Slopes in which rounding may show.
    rough: [bool; 7],
    stage: Vec<f64>,
    /// State of the last stage but one.
    beside: Vec<f64>,
    cubics: Cubics,
    /// What bends the cubics further.
    quartic: Vec<f64>,
}

impl Method for Dopri5 {
    const ORDER: f64 = 5.0;
    /// Errors of thousands of steps add up, and with a tenth the error of smooth runs over ten seconds stays near ten times
    /// the tolerance.
    const SHARE: f64 = 0.1;

    fn new(dimension: usize) -> Self {
        let zero = || vec![0.0; dimension];
        Self {
            slopes: std::array::from_fn(|_| zero()),
            rough: [false; 7],
            stage: zero(),
            beside: zero(),
            cubics: Cubics::new(dimension),
            quartic: zero(),
        }
    }

    fn begin(&mut self, problem: &mut dyn Problem, t: f64, y: &[f64]) -> Result<(), RunError> {
        problem.derivative(t, y, &mut self.slopes[0])?;
        self.rough[0] = problem.is_rough();
        Ok(())
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
        for stage in 1..7 {
            if stage == 6 {
                // The stage before lies at the same time.
                self.beside.copy_from_slice(next);
            }
            let (known, unknown) = self.slopes.split_at_mut(stage);
            weighted_sum(next, &A[stage], known);
            for (next, y) in next.iter_mut().zip(step.y) {
                *next = y + step.length * *next;
            }
            if stage == 6 {
                problem.project(step.end, step.y, next)?;
            }
            let t = if stage >= 5 { step.end } else { step.t + C[stage] * step.length };
            problem.derivative(t, next, &mut unknown[0])?;
            self.rough[stage] = problem.is_rough();
        }
        weighted_sum(error, &E, &self.slopes);
        Ok(())
    }

    fn noise(&mut self, problem: &mut dyn Problem, step: Step<'_>, next: &[f64]) -> f64 {
        let mut noise = 0.0;
        for stage in (0..7).filter(|stage| self.rough[*stage]) {
            // The last stage is the projected end of the step.
            self.stage.copy_from_slice(next);
            if stage < 6 {
                weighted_sum(&mut self.stage, &A[stage], &self.slopes[..stage]);
                for (stage, y) in self.stage.iter_mut().zip(step.y) {
                    *stage = y + step.length * *stage;
                }
            }
            let t = step.t + C[stage] * step.length;
            noise += E[stage].abs() * problem.noise(t, &self.stage, &self.slopes[stage]);
        }
        noise
    }

    fn accept(&mut self, step: Step<'_>, next: &[f64]) {
        self.cubics.set(step, next, [&self.slopes[0], &self.slopes[6]]);
        weighted_sum(&mut self.quartic, &D, &self.slopes);
        self.quartic.iter_mut().for_each(|x| *x *= step.length);
        self.take_back();
    }

    fn take_back(&mut self) {
        self.slopes.swap(0, 6);
        self.rough.swap(0, 6);
    }

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.slopes.iter_mut().flatten().chain(&mut self.quartic).for_each(&mut *visit);
        for rough in &mut self.rough {
            let mut flag = f64::from(u8::from(*rough));
            visit(&mut flag);
            *rough = flag != 0.0;
        }
        self.cubics.visit_memory(visit);
    }

    fn interpolate<const N: usize>(&self, s: [f64; N], y: &mut [[f64; N]]) {
        self.cubics.at(s, y, |i| self.quartic[i]);
    }
}

impl Dopri5 {
    /// How fast slopes change with the state at the end of the last step tried [1/s]: by the last two stages, which lie at one time (Hairer,
    /// Wanner, Solving Ordinary Differential Equations II, 2nd ed., IV.2). Zero where they are too close to tell.
    pub(super) fn fastest(&self, next: &[f64]) -> f64 {
        let square = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let (slopes, states) = (square(&self.slopes[6], &self.slopes[5]), square(next, &self.beside));
        let size: f64 = next.iter().map(|value| value * value).sum();
        if states > ROUNDED * ROUNDED * size { libm::sqrt(slopes / states) } else { 0.0 }
    }

    /// Goes on from where another method got, with the slope there.
    pub(super) fn go_on_with(&mut self, slope: &[f64]) {
        self.slopes[0].copy_from_slice(slope);
        self.rough[0] = false;
    }
}

/// `out = sum of weight * slope`, slope by slope: loops over long slices, which compilers vectorise.
fn weighted_sum(out: &mut [f64], weights: &[f64], slopes: &[Vec<f64>]) {
    out.fill(0.0);
    for (weight, slope) in weights.iter().zip(slopes) {
        if *weight != 0.0 {
            add_scaled(out, *weight, slope);
        }
    }
}
