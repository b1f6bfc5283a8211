//! A step of the classical Runge-Kutta method of order 4 (Kutta 1901; Hairer, Norsett, Wanner, Solving Ordinary Differential Equations
//! I, 2nd ed., table II.1.2), in slices of the caller. In: a state and its slopes. Out: the next one. Never knows what is integrated.

use crate::linear::combine;

/// Asked for a stage: its number, time and state in, slope out.
pub(crate) type Slope<'s, E> = &'s mut dyn FnMut(usize, f64, &[f64], &mut [f64]) -> Result<(), E>;

/// Writes the state at the end of a step from `y` at `t` to `stage`; `slope` is asked four times, with the number of the stage.
///
/// # Errors
/// What `slope` reports.
pub(crate) fn rk4<E>(
    (t, step): (f64, f64),
    y: &[f64],
    stage: &mut [f64],
    [k1, k2, k3, k4]: [&mut [f64]; 4],
    slope: Slope<'_, E>,
) -> Result<(), E> {
    slope(0, t, y, k1)?;
    combine(stage, y, 0.5 * step, k1);
    slope(1, t + 0.5 * step, stage, k2)?;
    combine(stage, y, 0.5 * step, k2);
    slope(2, t + 0.5 * step, stage, k3)?;
    combine(stage, y, step, k3);
    slope(3, t + step, stage, k4)?;
    advance(stage, y, step / 6.0, [k1, k2, k3, k4]);
    Ok(())
}

/// As [`combine`], with the four slopes of a step.
fn advance(next: &mut [f64], y: &[f64], sixth: f64, slopes: [&[f64]; 4]) {
    let n = next.len();
    let (y, [a, b, c, d]) = (&y[..n], slopes.map(|slope| &slope[..n]));
    for i in 0..n {
        next[i] = y[i] + sixth * ((a[i] + d[i]) + 2.0 * (b[i] + c[i]));
    }
}
