//! Trajectories by Gragg-Bulirsch-Stoer extrapolation with projection after every step.
//! In: a consistent state. Out: consistent states at given times. Never knows joints or forces.
//!
//! Deliberately not a method the runtime uses: modified midpoint sums extrapolated in h² (Hairer,
//! Norsett, Wanner, Solving Ordinary Differential Equations I, II.9).

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::assemble::AssemblyError;
use crate::frame::BodyState;
use crate::model::Oracle;

/// Columns of the extrapolation table; 2, 4, .. 14 substeps: order 14, estimate of order 12.
const COLUMNS: usize = 7;
/// First step that is tried [s]; the error estimate finds the right one.
const FIRST_STEP: f64 = 1e-3;
/// Numbers per body: quaternion, centre, angular velocity, velocity.
const WIDTH: usize = 13;

/// Allowed error per step, relative to `1 + |y|` for each number of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance(pub f64);

/// Why an integration ended early.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum IntegrationError {
    /// No step size reaches the tolerance.
    #[error("step size underflow at t = {t} s")]
    StepUnderflow {
        /// Time reached [s].
        t: f64,
    },
    /// The constraints could not be restored.
    #[error("at t = {t} s: {source}")]
    Projection {
        /// Time reached [s].
        t: f64,
        /// What failed.
        source: AssemblyError,
    },
}

impl Oracle {
    /// States at `times` (ascending; the first is that of `start`).
    ///
    /// # Errors
    /// If the step size underflows or the loops cannot be kept closed.
    pub fn trajectory(
        &self,
        times: &[f64],
        start: &[BodyState],
        tolerance: Tolerance,
    ) -> Result<Vec<Vec<BodyState>>, IntegrationError> {
        let mut states = start.to_vec();
        let mut path = vec![states.clone()];
        let mut step = FIRST_STEP;
        for pair in times.windows(2) {
            states = self.advance(pair[0], pair[1], &states, tolerance, &mut step)?;
            path.push(states.clone());
        }
        Ok(path)
    }

    /// State at `t1` from the one at `t0`.
    ///
    /// # Errors
    /// As [`Oracle::trajectory`].
    pub fn integrate(
        &self,
        t0: f64,
        t1: f64,
        start: &[BodyState],
        tolerance: Tolerance,
    ) -> Result<Vec<BodyState>, IntegrationError> {
        let mut step = FIRST_STEP;
        self.advance(t0, t1, start, tolerance, &mut step)
    }

    fn advance(
        &self,
        t0: f64,
        t1: f64,
        start: &[BodyState],
        tolerance: Tolerance,
        proposal: &mut f64,
    ) -> Result<Vec<BodyState>, IntegrationError> {
        let (mut t, mut states) = (t0, start.to_vec());
        while t < t1 {
            let whole = t1 - t;
            // Equal parts, so that no tiny last step is left over.
            let h = if *proposal >= whole { whole } else { whole / (whole / *proposal).ceil() };
            if h <= 1e-14 * (1.0 + t.abs()) {
                return Err(IntegrationError::StepUnderflow { t });
            }
            let (y, error) = self.extrapolate(t, h, &pack(&states), tolerance.0);
            let factor = if error.is_finite() {
                (0.9 * error.max(1e-30).powf(-1.0 / (2.0 * COLUMNS as f64 - 1.0))).clamp(0.1, 3.0)
            } else {
                0.1
            };
            *proposal = factor * h;
            if error <= 1.0 {
                t = if h >= whole { t1 } else { t + h };
                states = self
                    .assemble(t, &unpack(&y), &[])
                    .map_err(|source| IntegrationError::Projection { t, source })?;
            }
        }
        Ok(states)
    }

    /// One step of the extrapolation and its error in units of the tolerance.
    fn extrapolate(&self, t: f64, h: f64, y: &[f64], tolerance: f64) -> (Vec<f64>, f64) {
        let slope = self.slope(t, y);
        // Aitken-Neville in h²: row j, column k uses 2 (j + 1) and 2 (j - k + 1) substeps.
        let mut row: Vec<Vec<f64>> = Vec::new();
        for j in 0..COLUMNS {
            let mut next = vec![self.midpoint(t, h, y, &slope, 2 * (j + 1))];
            for k in 1..=j {
                let ratio = (j + 1) as f64 / (j + 1 - k) as f64;
                let weight = 1.0 / (ratio * ratio - 1.0);
                let improve = |(new, old): (&f64, &f64)| new + (new - old) * weight;
                next.push(next[k - 1].iter().zip(&row[k - 1]).map(improve).collect());
            }
            row = next;
        }
        let best = row.swap_remove(COLUMNS - 1);
        let before = row.swap_remove(COLUMNS - 2);
        let error = best.iter().zip(&before).zip(y).fold(0.0_f64, |worst, ((a, b), y)| {
            let scaled = (a - b).abs() / (tolerance * (1.0 + y.abs()));
            if scaled.is_nan() { f64::INFINITY } else { worst.max(scaled) }
        });
        (best, error)
    }

    fn midpoint(&self, t: f64, whole: f64, y: &[f64], slope: &[f64], count: usize) -> Vec<f64> {
        let h = whole / count as f64;
        let along = |base: &[f64], h: f64, slope: &[f64]| -> Vec<f64> {
            base.iter().zip(slope).map(|(y, f)| y + h * f).collect()
        };
        let mut last = y.to_vec();
        let mut now = along(y, h, slope);
        for k in 1..count {
            let next = along(&last, 2.0 * h, &self.slope(t + k as f64 * h, &now));
            last = std::mem::replace(&mut now, next);
        }
        now
    }

    fn slope(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let states = unpack(y);
        let solution = self.accelerations(t, &states);
        let mut slope = Vec::with_capacity(y.len());
        for (body, state) in states.iter().enumerate() {
            let part = &y[WIDTH * body..];
            let q = Quaternion::new(part[0], part[1], part[2], part[3]);
            // Angular velocity in W axes multiplies from the left.
            let rate = Quaternion::from_imag(state.omega) * q * 0.5;
            slope.extend([rate.w, rate.i, rate.j, rate.k]);
            slope.extend(state.velocity.iter());
            slope.extend(solution.alpha[body].iter());
            slope.extend(solution.acceleration[body].iter());
        }
        slope
    }
}

fn pack(states: &[BodyState]) -> Vec<f64> {
    let mut y = Vec::with_capacity(WIDTH * states.len());
    for state in states {
        let rotation = Rotation3::from_matrix_unchecked(state.rotation);
        let q = UnitQuaternion::from_rotation_matrix(&rotation);
        y.extend([q.w, q.i, q.j, q.k]);
        y.extend(state.centre.iter().chain(&state.omega).chain(&state.velocity));
    }
    y
}

fn unpack(y: &[f64]) -> Vec<BodyState> {
    let state = |part: &[f64]| {
        let q = UnitQuaternion::from_quaternion(Quaternion::new(part[0], part[1], part[2], part[3]));
        BodyState {
            rotation: q.to_rotation_matrix().into_inner(),
            centre: Vector3::from_column_slice(&part[4..7]),
            omega: Vector3::from_column_slice(&part[7..10]),
            velocity: Vector3::from_column_slice(&part[10..13]),
        }
    };
    y.chunks_exact(WIDTH).map(state).collect()
}
