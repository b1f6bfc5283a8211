//! Nelder and Mead's simplex, for likelihoods without derivatives. In: a function, a start. Out: a place of a maximum.
//! Never knows the function.

/// Evaluations after which the best place so far is taken.
const MOST_CALLS: usize = 4000;

/// A local maximum of `value` from `start`, first steps of size `step`. Deterministic.
pub fn maximise_simplex(value: impl Fn(&[f64]) -> f64, start: &[f64], step: f64) -> Vec<f64> {
    let first = climb(&value, start, step);
    // Once more from there: a simplex can collapse before its time.
    climb(&value, &first, 0.1 * step)
}

fn climb(value: &impl Fn(&[f64]) -> f64, start: &[f64], step: f64) -> Vec<f64> {
    let size = start.len();
    // Minimises the negative; NaN counts as worst.
    let cost = |x: &[f64]| {
        let value = value(x);
        if value.is_nan() { f64::INFINITY } else { -value }
    };
    let mut corners: Vec<(f64, Vec<f64>)> = vec![(cost(start), start.to_vec())];
    for at in 0..size {
        let mut corner = start.to_vec();
        corner[at] += step;
        corners.push((cost(&corner), corner));
    }
    let mut calls = corners.len();
    while calls < MOST_CALLS {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (best, worst) = (&corners[0], &corners[size]);
        let width = (0..size).map(|k| (best.1[k] - worst.1[k]).abs()).fold(0.0, f64::max);
        if width < 1e-9 || (worst.0 - best.0 < 1e-13 && width < 1e-6) {
            break;
        }
        let centre: Vec<f64> =
            (0..size).map(|k| corners[..size].iter().map(|c| c.1[k]).sum::<f64>() / size as f64).collect();
        let along = |factor: f64| -> (f64, Vec<f64>) {
            let x: Vec<f64> =
                centre.iter().zip(&corners[size].1).map(|(c, w)| c + factor * (w - c)).collect();
            (cost(&x), x)
        };
        let mirrored = along(-1.0);
        calls += 1;
        let next = if mirrored.0 < corners[0].0 {
            calls += 1;
            let further = along(-2.0);
            Some(if further.0 < mirrored.0 { further } else { mirrored })
        } else if mirrored.0 < corners[size - 1].0 {
            Some(mirrored)
        } else {
            calls += 1;
            let nearer = along(if mirrored.0 < corners[size].0 { -0.5 } else { 0.5 });
            (nearer.0 < corners[size].0.min(mirrored.0)).then_some(nearer)
        };
        if let Some(next) = next {
            corners[size] = next;
            continue;
        }
        let best = corners[0].1.clone();
        for corner in &mut corners[1..] {
            let x: Vec<f64> = corner.1.iter().zip(&best).map(|(c, b)| 0.5 * (c + b)).collect();
            *corner = (cost(&x), x);
        }
        calls += size;
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners.swap_remove(0).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curved_valley_is_climbed_to_its_end() {
        let rosenbrock = |x: &[f64]| -(1.0 - x[0]).powi(2) - 100.0 * (x[1] - x[0] * x[0]).powi(2);
        let top = maximise_simplex(rosenbrock, &[-1.2, 1.0], 0.3);
        assert!((top[0] - 1.0).abs() < 1e-5 && (top[1] - 1.0).abs() < 1e-5, "{top:?}");
    }

    #[test]
    fn one_dimension_is_enough() {
        let top = maximise_simplex(|x| -(x[0] - 0.2).powi(2), &[1.0], 0.3);
        assert!((top[0] - 0.2).abs() < 1e-7, "{top:?}");
    }
}
