//! A step of the classical Runge-Kutta method of order 4 (Kutta 1901; Hairer, Norsett, Wanner, Solving Ordinary Differential Equations
//! I, 2nd ed., table II.1.2), in slices of the caller. In: a state and its slopes. Out: the next one. Never knows what is integrated.

use crate::linear::combine;

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

/// Writes the state at the end of a step from `y`, by the slopes of all stages.
pub(crate) fn advance(next: &mut [f64], y: &[f64], step: f64, slopes: [&[f64]; 4]) {
    let (n, sixth) = (next.len(), step / 6.0);
    let (y, [a, b, c, d]) = (&y[..n], slopes.map(|slope| &slope[..n]));
    for i in 0..n {
        next[i] = y[i] + sixth * ((a[i] + d[i]) + 2.0 * (b[i] + c[i]));
    }
}
