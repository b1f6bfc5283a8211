//! What differences between units add to a log-likelihood. In: exposure and wear of each unit, parameters. Out: value, gradient,
//! Hessian. Never knows increments, nor how the likelihood is maximised.
//!
//! The total of a unit's wear tells all that the unit says of its own parameter, so its part is the mixed ln density of the
//! total less that of the plain process, over the unit's exposure.

use crate::process::Process;

/// Step of differences, in logarithms: the gradient errs by 1e-13 of the shapes by curvature and 1e-13 of them by rounding, second
/// derivatives by 1e-7, ample for Newton's method and for standard errors.
const STEP: f64 = 1e-3;

/// Exposure and wear of one unit with derivatives of ln exposure by exponent and powers.
pub struct Total {
    pub ln_lambda: f64,
    pub slopes: Vec<f64>,
    pub bends: Vec<Vec<f64>>,
    pub wear: f64,
}

/// What units add.
pub struct Added {
    pub value: f64,
    pub gradient: Vec<f64>,
    /// Less the Hessian.
    pub information: Vec<Vec<f64>>,
}

/// The value of one unit.
pub fn value(process: &dyn Process, phi: &[f64], ln_lambda: f64, wear: f64) -> f64 {
    part(process, &at(process, phi, ln_lambda), wear)
}

/// Value and derivatives of all; the logarithm of the units' variation stands last in `phi`.
pub fn added(process: &dyn Process, phi: &[f64], totals: &[Total]) -> Added {
    let powers = process.exposure_powers();
    let (size, last) = (phi.len(), phi.len() - 1);
    let mut sum = Added { value: 0.0, gradient: vec![0.0; size], information: vec![vec![0.0; size]; size] };
    for total in totals {
        let middle = at(process, phi, total.ln_lambda);
        let (value, gradient, hessian) = differences(&|u| part(process, u, total.wear), &middle);
        // d u / d phi_i: u is the logarithms of the two parameters over the unit's exposure, and that of the variation.
        let slope = |i: usize| match i {
            0 => [1.0, 0.0, 0.0],
            1 => [0.0, 1.0, 0.0],
            _ if i == last => [0.0, 0.0, 1.0],
            _ => [powers[0] * total.slopes[i - 2], powers[1] * total.slopes[i - 2], 0.0],
        };
        let slopes: Vec<[f64; 3]> = (0..size).map(slope).collect();
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let through_lambda = gradient[0] * powers[0] + gradient[1] * powers[1];
        sum.value += value;
        for (i, a) in slopes.iter().enumerate() {
            sum.gradient[i] += dot(a, &gradient);
            for (j, b) in slopes.iter().enumerate() {
                let bent = hessian.map(|row| dot(&row, b));
                let is_inner = (2..last).contains(&i) && (2..last).contains(&j);
                let bend = if is_inner { total.bends[i - 2][j - 2] } else { 0.0 };
                sum.information[i][j] -= dot(a, &bent) + through_lambda * bend;
            }
        }
    }
    sum
}

/// The part of a unit by (logarithms of the parameters over its exposure, logarithm of the variation) and its wear; 0 for a
/// process whose units do not differ.
fn part(process: &dyn Process, u: &[f64; 3], wear: f64) -> f64 {
    let logs = [u[0], u[1]];
    let mixed = process.random_effect().map(|effect| effect.ln_density(logs, libm::exp(u[2]), wear));
    mixed.map_or(0.0, |mixed| mixed - process.ln_density(logs, wear))
}

/// Where that part is taken, for a unit of this exposure.
fn at(process: &dyn Process, phi: &[f64], ln_lambda: f64) -> [f64; 3] {
    let powers = process.exposure_powers();
    [phi[0] + powers[0] * ln_lambda, phi[1] + powers[1] * ln_lambda, phi[phi.len() - 1]]
}

/// Value, gradient and Hessian by central differences of order 4.
fn differences(f: &dyn Fn(&[f64; 3]) -> f64, middle: &[f64; 3]) -> (f64, [f64; 3], [[f64; 3]; 3]) {
    let moved = |moves: &[(usize, f64)]| {
        let mut u = *middle;
        for (i, by) in moves {
            u[*i] += by * STEP;
        }
        f(&u)
    };
    let value = f(middle);
    let along = |i: usize| [-2.0, -1.0, 1.0, 2.0].map(|by| moved(&[(i, by)]));
    let slope =
        |[far_down, down, up, far_up]: [f64; 4]| (8.0 * (up - down) - (far_up - far_down)) / (12.0 * STEP);
    let bend = |[far_down, down, up, far_up]: [f64; 4]| {
        (16.0 * (up + down) - 30.0 * value - (far_up + far_down)) / (12.0 * STEP * STEP)
    };
    let mixed = |i: usize, j: usize| {
        let corner = |a: f64, b: f64| moved(&[(i, a), (j, b)]);
        let square = |h: f64| (corner(h, h) - corner(h, -h) - corner(-h, h) + corner(-h, -h)) / (4.0 * h * h);
        (4.0 * square(1.0) - square(2.0)) / (3.0 * STEP * STEP)
    };
    let lines = [0, 1, 2].map(along);
    let (gradient, [aa, bb, cc]) = (lines.map(slope), lines.map(bend));
    let (ab, ac, bc) = (mixed(0, 1), mixed(0, 2), mixed(1, 2));
    let hessian = [[aa, ab, ac], [ab, bb, bc], [ac, bc, cc]];
    (value, gradient, hessian)
}
