//! The regular branch of the N four-bar: all upright bars stay parallel.
//!
//! Library of computational benchmark problems of IFToMM, problem A02: N cells, 2 N + 1 unit bars of
//! 1 kg, upright at the start. With every upright bar at the angle theta from the vertical,
//! `((N+1)/3 + N) theta'' = ((N+1)/2 + N) g sin theta`.

/// Order of the Taylor series per step.
const ORDER: usize = 24;
/// Length of a step [s]; theta varies on a scale of 0.3 s, so 24 terms leave rounding only.
const STEP: f64 = 0.02;

/// The mechanism and its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NFourBar {
    /// Number of cells N.
    pub cells: u32,
    /// Gravity [m/s²], against y.
    pub gravity: f64,
    /// Speed of the first tip along x at t = 0 [m/s], upright.
    pub tip_speed: f64,
}

impl NFourBar {
    /// Benchmark A02 with `cells` cells.
    pub fn benchmark(cells: u32) -> Self {
        Self { cells, gravity: 9.81, tip_speed: 1.0 }
    }

    /// x, y [m], vx, vy [m/s] of the first tip B0 at time `t` [s].
    pub fn tip(&self, t: f64) -> [f64; 4] {
        let n = f64::from(self.cells);
        let factor = ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n) * self.gravity;
        let (mut angle, mut speed) = (0.0, self.tip_speed);
        let steps = (t / STEP).ceil().max(1.0);
        for _ in 0..steps as usize {
            (angle, speed) = taylor(angle, speed, factor, t / steps);
        }
        let (sin, cos) = f64::sin_cos(angle);
        [sin, cos, cos * speed, -sin * speed]
    }
}

/// One step of `angle'' = factor * sin(angle)` by power series.
fn taylor(angle: f64, speed: f64, factor: f64, h: f64) -> (f64, f64) {
    let mut theta = [0.0; ORDER + 2];
    let mut sin = [0.0; ORDER + 1];
    let mut cos = [0.0; ORDER + 1];
    (theta[0], theta[1], sin[0], cos[0]) = (angle, speed, angle.sin(), angle.cos());
    for k in 0..ORDER {
        theta[k + 2] = factor * sin[k] / ((k + 1) * (k + 2)) as f64;
        // (sin theta)' = cos theta * theta', coefficient by coefficient.
        let convolve = |other: &[f64]| -> f64 {
            (0..=k).map(|j| (j + 1) as f64 * theta[j + 1] * other[k - j]).sum::<f64>() / (k + 1) as f64
        };
        (sin[k + 1], cos[k + 1]) = (convolve(&cos), -convolve(&sin));
    }
    let position = theta.iter().rev().fold(0.0, |sum, c| sum * h + c);
    let rate = (1..ORDER + 2).rev().fold(0.0, |sum, k| sum * h + k as f64 * theta[k]);
    (position, rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tips_agree_with_a_thirty_digit_integration() {
        // Independent 30-digit integration of the same equation, 14 digits printed.
        // The motion passes an unstable point each turn: rounding grows to about 1e-10 in 20 s.
        let two = NFourBar::benchmark(2);
        let five = [-0.811_310_461_005_11, -0.584_615_545_348_98, -3.569_117_397_19, 4.953_105_171_31];
        let ten = [0.328_458_111_540_82, 0.944_518_538_178_6, 1.423_051_470_21, -0.494_868_845_487];
        for (t, expected) in [(5.0, five), (10.0, ten)] {
            for (a, b) in two.tip(t).iter().zip(expected) {
                assert!((a - b).abs() < 1e-9, "t = {t}: {a} {b}");
            }
        }
        let [x, y, ..] = NFourBar::benchmark(40).tip(20.0);
        assert!((x - 0.410_901_153_762_95).abs() < 1e-9 && (y - 0.911_679_900_971_98).abs() < 1e-9);
    }
}
