//! Where true wear may lie around a reading, and what is known of it there. In: a gauge's step and error. Out: chances of the parts of
//! a window, means of exponentials over it. Never knows laws of wear.

use crate::data::Rounding;
use crate::special::normal_cdf;

/// Standard deviations of the error beyond which no reading lies: 6e-7 of them do.
const REACH: f64 = 5.0;
/// Parts of a step, or of a standard deviation of the error, whichever is larger: spreading wear evenly over one adds a variance
/// of (R / PARTS)² / 12 to that of the rounding, R² / 12; at shape 0.3, where half of all wear lies near 0, it changes the chance
/// of a reading by up to 2 %.
const PARTS: usize = 16;
/// By how much wider a part may be so that steps are whole numbers of parts, or parts of steps.
const NEAR: f64 = 1.05;

/// Variance of wear below which the parts of a window do not tell it from none.
pub fn least_variance(rounding: Rounding) -> f64 {
    let part = Window::new(rounding).part;
    part * part / 12.0
}

/// Where true wear may lie around a reading, in even parts.
pub(super) struct Window {
    pub part: f64,
    pub parts: usize,
    /// Parts in a step, or steps in a part: the other is 1. Edges of the parts of all windows lie on one lattice.
    pub ratio: [f64; 2],
    /// Chance of each part to give the reading, and a smaller one.
    pub chances: Vec<[f64; 2]>,
    /// Variance of the wear within it, for a density that is even.
    pub variance: f64,
}

impl Window {
    pub fn new(Rounding { step, error }: Rounding) -> Self {
        let part = libm::hypot(step, error) / PARTS as f64;
        let ratio = if part > step {
            [1.0, libm::floor(part * NEAR / step)]
        } else {
            [libm::ceil(step / (part * NEAR)), 1.0]
        };
        let part = step * ratio[1] / ratio[0];
        if error == 0.0 {
            return Self::of(part, ratio, vec![[1.0, 0.0]; PARTS]);
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most some hundred")]
        let parts = ((step + 2.0 * REACH * error) / part).ceil() as usize;
        let chance = |k: usize| {
            let off = (k as f64 + 0.5 - 0.5 * parts as f64) * part;
            let [below, above] = [-0.5, 0.5].map(|side| normal_cdf((side * step - off) / error));
            [above - below, below]
        };
        Self::of(part, ratio, (0..parts).map(chance).collect())
    }

    fn of(part: f64, ratio: [f64; 2], chances: Vec<[f64; 2]>) -> Self {
        let mut window = Self { part, parts: chances.len(), ratio, chances, variance: 0.0 };
        // Wear within a part counts as spread evenly over it.
        let square = |(k, mass): (usize, &f64)| mass * (window.off(k) * window.off(k) + part * part / 12.0);
        window.variance = window.tilted(0.0).iter().enumerate().map(square).sum();
        window
    }

    /// Middle of part `k`, beside the reading.
    pub fn off(&self, k: usize) -> f64 {
        (k as f64 + 0.5 - 0.5 * self.parts as f64) * self.part
    }

    /// Masses of the parts, for wear whose density goes as exp(`tilt` times wear) there.
    pub fn tilted(&self, tilt: f64) -> Vec<f64> {
        let mass = |(k, [here, _]): (usize, &[f64; 2])| here * libm::exp(tilt * self.off(k));
        let masses: Vec<f64> = self.chances.iter().enumerate().map(mass).collect();
        let all: f64 = masses.iter().sum();
        masses.into_iter().map(|mass| mass / all).collect()
    }
}

/// What is known of true wear around a reading, given it and all before.
pub(super) enum Place {
    /// Exact.
    Exact,
    /// Anywhere in the window, with a density that goes as the exponential of this times wear.
    Tilted(f64),
    /// Masses of the parts of the window.
    Parts(Vec<f64>),
}

/// The logarithm of a density around a difference of readings: value, slope and half its bend by wear.
#[derive(Clone, Copy)]
pub(super) struct Even {
    pub ln: f64,
    pub slope: f64,
    pub bend: f64,
}

impl Even {
    /// Chance of a reading after a place, beside the step of the gauge, and the place that it leaves.
    ///
    /// With x and y the wear within both windows the density is exp(ln + slope (y - x) + bend (y - x)²): tilts of x by -slope,
    /// of y by slope. The mean of exp(t x) over a window is exp(t² variance / 2) but for t⁴.
    pub fn follow(&self, place: &Place, window: &Window) -> (f64, Place) {
        let (s, variance) = (self.slope, window.variance);
        let mean = |tilt: f64| 0.5 * variance * tilt * tilt;
        let chance = match place {
            Place::Exact => libm::exp(self.ln + mean(s) + self.bend * variance),
            Place::Tilted(t) => {
                libm::exp(self.ln + mean(t - s) - mean(*t) + mean(s) + 2.0 * self.bend * variance)
            }
            Place::Parts(masses) => {
                let from = |(k, mass): (usize, &f64)| {
                    let x = window.off(k);
                    mass * libm::exp(self.bend * (x * x + variance) - s * x)
                };
                libm::exp(self.ln + mean(s)) * masses.iter().enumerate().map(from).sum::<f64>()
            }
        };
        (chance, Place::Tilted(s))
    }
}
