//! The end of a turn onto the constraints, with its tangents: positions, then speeds, by the shortest motion. In: a state near them. Out:
//! the state on them. Never knows steps.

use linkwear_runtime::{Motion, Sizes};
use nalgebra::DMatrix;

use super::tangents::Varied;
use super::turn::{TooLong, Turns, put_state};

/// Loops that are open by more at the end of a turn [m], [rad]: steps were too long.
const DRIFTED: f64 = 1e-5;
/// Loops count as closed then [m], [rad].
const CLOSED: f64 = 1e-13;
/// Corrections at most: each squares what is left.
const CORRECTIONS: usize = 5;
/// Singular values of the loops below this part of the largest are none.
const NO_ROW: f64 = 1e-12;

/// Loops at a state.
struct Loops<const N: usize> {
    /// Positions of all rows, speeds of those that are kept.
    residuals: Vec<Varied<N>>,
    /// Of their Jacobian; none if that is no number.
    inverse: Option<DMatrix<f64>>,
}

impl<const N: usize> Turns<N> {
    /// Puts a state onto the constraints.
    pub(super) fn close(&mut self, t: Varied<N>, state: &mut [Varied<N>]) -> Result<(), TooLong> {
        self.normalize(state);
        let Sizes { rows, all_rows, coordinates, speeds, .. } = self.sizes;
        if rows == 0 {
            return Ok(());
        }
        let mut loops = self.loops(t, state);
        for correction in 0.. {
            let positions: Vec<Varied<N>> = self.kept.iter().map(|row| loops.residuals[*row]).collect();
            // What is no number is open too.
            if positions.iter().any(|one| one.value.is_nan() || one.value.abs() > DRIFTED) {
                return Err(TooLong);
            }
            let Some(inverse) = loops.inverse.take() else { return Err(TooLong) };
            let delta = shortest(&inverse, &positions);
            self.advance(state, &delta);
            loops = self.loops(t, state);
            if positions.iter().all(|one| one.value.abs() <= CLOSED) || correction == CORRECTIONS {
                break;
            }
        }
        let Some(inverse) = loops.inverse else { return Err(TooLong) };
        let delta = shortest(&inverse, &loops.residuals[all_rows..all_rows + rows]);
        for (speed, delta) in state[coordinates..coordinates + speeds].iter_mut().zip(&delta) {
            *speed = speed.plus(1.0, delta);
        }
        Ok(())
    }

    fn loops(&mut self, t: Varied<N>, state: &[Varied<N>]) -> Loops<N> {
        put_state(&mut self.closure, self.sizes.parameters, (t, state));
        let Sizes { rows, all_rows, speeds, .. } = self.sizes;
        let (values, tangents) = self.closure.run();
        let residuals = values.iter().zip(tangents).take(all_rows + rows);
        let residuals = residuals.map(|(value, tangents)| Varied::answered(value, tangents)).collect();
        let jacobian: Vec<f64> = values[all_rows + rows..].iter().map(|value| value[0]).collect();
        let jacobian = DMatrix::from_row_slice(rows, speeds, &jacobian);
        let is_finite = jacobian.iter().all(|entry| entry.is_finite());
        let inverse = if is_finite { jacobian.pseudo_inverse(NO_ROW).ok() } else { None };
        Loops { residuals, inverse }
    }

    /// Moves coordinates by a small motion.
    fn advance(&self, state: &mut [Varied<N>], delta: &[Varied<N>]) {
        for group in self.layout.free() {
            let (q, delta) = (&mut state[group.coordinate..], &delta[group.speed..]);
            match group.motion {
                Motion::Scalar { .. } => q[0] = q[0].plus(1.0, &delta[0]),
                Motion::Rotation => rotate(q, delta),
                Motion::Pose => {
                    let (shift, [a, b, c, d]) = (&delta[3..6], [0, 1, 2, 3].map(|i| q[i].value));
                    // By first order, as the motion is small: a moved point by the body's axes.
                    let axes = [
                        [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
                        [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
                        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
                    ];
                    for (place, axis) in q[4..7].iter_mut().zip(axes) {
                        for (part, along) in axis.into_iter().zip(shift) {
                            *place = place.plus(part, along);
                        }
                    }
                    rotate(q, delta);
                }
            }
        }
        self.normalize(state);
    }

    /// Scales quaternions to unit length.
    fn normalize(&self, state: &mut [Varied<N>]) {
        for group in self.layout.free().filter(|group| !matches!(group.motion, Motion::Scalar { .. })) {
            let part = &mut state[group.coordinate..][..4];
            let length = part.iter().map(|one| one.value * one.value).sum::<f64>().sqrt();
            let along: [f64; N] = std::array::from_fn(|lane| {
                part.iter().map(|one| one.value * one.tangents[lane]).sum::<f64>() / (length * length)
            });
            for one in part {
                let tangents =
                    std::array::from_fn(|lane| (one.tangents[lane] - one.value * along[lane]) / length);
                *one = Varied { value: one.value / length, tangents };
            }
        }
    }
}

/// The shortest motion that takes residuals away.
fn shortest<const N: usize>(inverse: &DMatrix<f64>, residuals: &[Varied<N>]) -> Vec<Varied<N>> {
    let along = |speed: usize| {
        residuals
            .iter()
            .enumerate()
            .fold(Varied::ZERO, |sum, (row, one)| sum.plus(-inverse[(speed, row)], one))
    };
    (0..inverse.nrows()).map(along).collect()
}

/// Quaternion times a small rotation by the vector `angle` in the body's own frame.
fn rotate<const N: usize>(q: &mut [Varied<N>], angle: &[Varied<N>]) {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| q[i].value);
    let rows = [[-b, -c, -d], [a, -d, c], [d, a, -b], [-c, b, a]];
    for (part, row) in q[..4].iter_mut().zip(rows) {
        for (factor, angle) in row.into_iter().zip(angle) {
            *part = part.plus(0.5 * factor, angle);
        }
    }
}
