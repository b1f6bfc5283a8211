//! A step of the classical Runge-Kutta method of order 4 (Kutta 1901; Hairer, Norsett, Wanner, Solving Ordinary Differential Equations
//! I, 2nd ed., table II.1.2), in slices of the caller. In: a state and its slopes. Out: the next one. Never knows what is integrated.

use crate::linear::combine;
use crate::scalar::Scalar;
use crate::system::StageSum;

/// Parts of a step at which its inner stages lie.
#[cfg(feature = "std")]
pub(crate) const PARTS: [f64; 3] = [0.5, 0.5, 1.0];

/// Asked for a stage: its time and state in, slope out.
pub(crate) type Slope<'s, E> = &'s mut dyn FnMut(f64, &[f64], &mut [f64]) -> Result<(), E>;

/// Writes the slopes of the three stages within a step from `y`, where the slope is `k1`; `times` are those of its middle and its end,
/// `stage` is room for a state.
///
/// # Errors
/// What `slope` reports.
pub(crate) fn inner_stages<E>(
    ([middle, end], step): ([f64; 2], f64),
    y: &[f64],
    stage: &mut [f64],
    (k1, [k2, k3, k4]): (&[f64], [&mut [f64]; 3]),
    slope: Slope<'_, E>,
) -> Result<(), E> {
    combine(stage, y, 0.5 * step, k1);
    slope(middle, stage, k2)?;
    combine(stage, y, 0.5 * step, k2);
    slope(middle, stage, k3)?;
    combine(stage, y, step, k3);
    slope(end, stage, k4)
}

/// A number of the state at the end of a step of `length` from `y`, by its slopes at all stages.
#[inline(always)]
pub(crate) fn end_of_step<T: Scalar>(sum: StageSum, y: T, length: T, [a, b, c, d]: [T; 4]) -> T {
    let within = T::constant(2.0) * (b + c);
    let all = match sum {
        StageSum::EndsFirst => (a + d) + within,
        StageSum::InTurn => (a + within) + d,
    };
    y + length / T::constant(6.0) * all
}

/// Writes the state at the end of a step from `y`, by the slopes of all stages.
#[inline]
pub(crate) fn advance(sum: StageSum, next: &mut [f64], y: &[f64], step: f64, slopes: [&[f64]; 4]) {
    let n = next.len();
    let (y, [a, b, c, d]) = (&y[..n], slopes.map(|slope| &slope[..n]));
    for i in 0..n {
        next[i] = end_of_step(sum, y[i], step, [a[i], b[i], c[i], d[i]]);
    }
}
