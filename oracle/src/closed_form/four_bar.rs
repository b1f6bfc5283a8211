//! The planar four-bar by Freudenstein's equation (Norton, Design of Machinery, sections 4.5, 6.7, 7.3).

use super::Motion;

/// Lengths of a planar four-bar [m]: crank pivot at the origin, rocker pivot at (`ground`, 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBar {
    /// Between the two fixed pivots.
    pub ground: f64,
    /// From the origin to the first moving pivot.
    pub crank: f64,
    /// Between the moving pivots.
    pub coupler: f64,
    /// From the rocker pivot to the second moving pivot.
    pub rocker: f64,
}

/// Angles from the x axis to crank, coupler (seen from the crank) and rocker (seen from its fixed pivot).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBarMotion {
    /// Crank, as given.
    pub crank: Motion,
    /// Coupler.
    pub coupler: Motion,
    /// Rocker.
    pub rocker: Motion,
}

impl FourBar {
    /// Motion of coupler and rocker for a motion of the crank; `open` chooses the branch whose links do
    /// not cross. NaN where the lengths do not close.
    pub fn motion(&self, crank: Motion, open: bool) -> FourBarMotion {
        let Self { ground: d, crank: a, coupler: b, rocker: c } = *self;
        let (sin2, cos2) = crank.position.sin_cos();
        let (k1, k2, k4) = (d / a, d / c, d / b);
        let k3 = (a * a - b * b + c * c + d * d) / (2.0 * a * c);
        let k5 = (c * c - d * d - a * a - b * b) / (2.0 * a * b);
        let root = |p: f64, q: f64, r: f64| {
            let s = (q * q - 4.0 * p * r).sqrt();
            2.0 * (if open { -q - s } else { -q + s }).atan2(2.0 * p)
        };
        let rocker = root(cos2 - k1 - k2 * cos2 + k3, -2.0 * sin2, k1 - (k2 + 1.0) * cos2 + k3);
        let coupler = root(cos2 - k1 + k4 * cos2 + k5, -2.0 * sin2, k1 + (k4 - 1.0) * cos2 + k5);
        let w2 = crank.speed;
        let w3 = a * w2 / b * (rocker - crank.position).sin() / (coupler - rocker).sin();
        let w4 = a * w2 / c * (crank.position - coupler).sin() / (rocker - coupler).sin();
        let ((sin3, cos3), (sin4, cos4)) = (coupler.sin_cos(), rocker.sin_cos());
        let along =
            a * crank.acceleration * sin2 + a * w2 * w2 * cos2 + b * w3 * w3 * cos3 - c * w4 * w4 * cos4;
        let across =
            a * crank.acceleration * cos2 - a * w2 * w2 * sin2 - b * w3 * w3 * sin3 + c * w4 * w4 * sin4;
        let det = c * b * (sin4 * cos3 - sin3 * cos4);
        let a3 = (along * c * cos4 - c * sin4 * across) / det;
        let a4 = (along * b * cos3 - b * sin3 * across) / det;
        FourBarMotion {
            crank,
            coupler: Motion { position: wrapped(coupler), speed: w3, acceleration: a3 },
            rocker: Motion { position: wrapped(rocker), speed: w4, acceleration: a4 },
        }
    }
}

/// The same angle in (-pi, pi].
fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_branches_close_and_derivatives_fit() {
        let bars = FourBar { ground: 0.4, crank: 0.1, coupler: 0.35, rocker: 0.3 };
        for open in [true, false] {
            let at = |t: f64| {
                let crank =
                    Motion { position: 0.4 + 2.0 * t + t * t, speed: 2.0 + 2.0 * t, acceleration: 2.0 };
                bars.motion(crank, open)
            };
            let m = at(0.5);
            let tip = |angle: f64, r: f64| (r * angle.cos(), r * angle.sin());
            let (a, b, c) =
                (tip(m.crank.position, 0.1), tip(m.coupler.position, 0.35), tip(m.rocker.position, 0.3));
            // Rounding of numbers below 1.
            assert!((a.0 + b.0 - c.0 - 0.4).abs() < 1e-15 && (a.1 + b.1 - c.1).abs() < 1e-15);
            // Central differences, h² / 6 times third derivatives of order 100.
            let h = 1e-6;
            for link in [|m: FourBarMotion| m.coupler, |m: FourBarMotion| m.rocker] {
                let (low, high) = (link(at(0.5 - h)), link(at(0.5 + h)));
                assert!(((high.position - low.position) / (2.0 * h) - link(m).speed).abs() < 1e-8);
                assert!(((high.speed - low.speed) / (2.0 * h) - link(m).acceleration).abs() < 1e-7);
            }
        }
    }
}
