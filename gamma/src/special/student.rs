//! Quantiles of Student's law. In: degrees of freedom and probability. Out: a bound. Never knows what is asked for.

use std::f64::consts::PI;

use super::root::rising_root;

/// The t that is exceeded in size with probability 1 - `within` by Student's law: its closed forms for whole degrees of freedom
/// (Abramowitz & Stegun 26.7.3 and 26.7.4).
pub fn student_bound(degrees: usize, within: f64) -> f64 {
    let nu = degrees as f64;
    let probability = |t: f64| {
        let angle = libm::atan(t / libm::sqrt(nu));
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let is_odd = degrees % 2 == 1;
        // Powers of cos up to nu - 2, each term the one before times cos² k / (k + 1).
        let (mut term, mut sum, mut k) = if is_odd { (cos, 0.0, 1) } else { (1.0, 0.0, 0) };
        while k + 2 <= degrees {
            sum += term;
            term *= cos * cos * (k + 1) as f64 / (k + 2) as f64;
            k += 2;
        }
        if is_odd { 2.0 / PI * (angle + sin * sum) } else { sin * sum }
    };
    rising_root(&|t| probability(t) - within, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_the_tables() {
        for (degrees, t) in [
            (1, 12.706_205),
            (2, 4.302_653),
            (3, 3.182_446),
            (4, 2.776_445),
            (15, 2.131_450),
            (999, 1.962_341),
        ] {
            assert!(
                (student_bound(degrees, 0.95) - t).abs() < 1e-6,
                "{degrees}: {}",
                student_bound(degrees, 0.95)
            );
        }
    }
}
