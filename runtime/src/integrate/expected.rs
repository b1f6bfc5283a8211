//! Formulas of generalised-alpha: where a step ends if the accelerations go on as before, and where with corrections.
//! In: the last point. Out: the next one, as far as no equations are needed. Never knows mechanisms.

use crate::linear::{combine, largest_of};

/// Coefficients for one spectral radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coefficients {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Coefficients {
    pub(super) fn new(rho: f64) -> Self {
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        let gamma = 0.5 + alpha_f - alpha_m;
        let beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
        Self { alpha_m, alpha_f, beta, gamma }
    }

    /// Time to which the method's own accelerations belong, in steps after the state's time.
    pub(super) fn shift(&self) -> f64 {
        self.alpha_m - self.alpha_f
    }
}

/// What the method carries from step to step.
#[derive(Clone)]
pub(super) struct Point {
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// Accelerations.
    pub(super) v_dot: Vec<f64>,
    /// The method's own accelerations, which belong to a shifted time.
    pub(super) a: Vec<f64>,
}

/// Where a step is expected to end, by its accelerations.
pub(super) struct Expected {
    coefficients: Coefficients,
    step: f64,
    a: Vec<f64>,
    v: Vec<f64>,
    v_dot: Vec<f64>,
    /// Increments of the coordinates, in speed space.
    increments: Vec<f64>,
    /// The method's own accelerations one step before the last point.
    before: Vec<f64>,
}

impl Expected {
    pub(super) fn new(rho: f64, now: &Point) -> Self {
        let Point { v, v_dot, a, .. } = now.clone();
        let (increments, before) = (vec![0.0; v.len()], a.clone());
        Self { coefficients: Coefficients::new(rho), step: 0.0, a, v, v_dot, increments, before }
    }

    /// Begins a step of `h` from `now`; `goes_on`: accelerations change as over the step before, else they stay.
    pub(super) fn begin(&mut self, now: &Point, h: f64, goes_on: bool) {
        let Coefficients { alpha_m, alpha_f, beta, gamma } = self.coefficients;
        self.step = h;
        for i in 0..self.a.len() {
            let (v, a) = (now.v[i], now.a[i]);
            let next = if goes_on { 2.0 * a - self.before[i] } else { a };
            self.before[i] = a;
            self.a[i] = next;
            self.increments[i] = h * (v + h * ((0.5 - beta) * a + beta * next));
            self.v[i] = v + h * ((1.0 - gamma) * a + gamma * next);
            self.v_dot[i] = ((1.0 - alpha_m) * next + alpha_m * a - alpha_f * now.v_dot[i]) / (1.0 - alpha_f);
        }
    }

    /// Writes speeds, accelerations and increments of the coordinates, where `x` is added to the expected increments.
    pub(super) fn corrected(&self, x: &[f64], next: &mut Point, increments: &mut [f64]) {
        let Coefficients { alpha_m, alpha_f, beta, gamma } = self.coefficients;
        let by_a = 1.0 / (self.step * self.step * beta);
        combine(increments, &self.increments, 1.0, x);
        combine(&mut next.a, &self.a, by_a, x);
        combine(&mut next.v, &self.v, by_a * self.step * gamma, x);
        combine(&mut next.v_dot, &self.v_dot, by_a * (1.0 - alpha_m) / (1.0 - alpha_f), x);
    }

    /// What the change of the accelerations within the step moves, times one over natural sizes, with `x` added: by this the
    /// step's own error goes.
    pub(super) fn moved(&self, now: &Point, x: &[f64], per_size: &[f64]) -> f64 {
        let scale = self.step * self.step * self.coefficients.beta;
        let ends = self.a.iter().zip(&now.a).zip(x.iter().zip(per_size));
        largest_of(ends.map(|((a, now), (x, per_size))| (scale * (a - now) + x) * per_size))
    }
}
