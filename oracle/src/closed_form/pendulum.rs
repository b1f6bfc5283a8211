//! The plane pendulum at any amplitude.

use super::{Motion, arithmetic_geometric_mean, jacobi};

/// A pendulum released from rest: `angle'' = -frequency² sin(angle)`, angle from the lowest position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    /// Frequency of small swings [rad/s]: sqrt(m g l / I about the pivot).
    pub frequency: f64,
    /// Angle of release [rad], between 0 and pi.
    pub amplitude: f64,
}

impl Pendulum {
    fn modulus(&self) -> f64 {
        (0.5 * self.amplitude).sin()
    }

    /// Time of a full swing [s].
    pub fn period(&self) -> f64 {
        let mean = arithmetic_geometric_mean(1.0, (0.5 * self.amplitude).cos());
        2.0 * std::f64::consts::PI / (self.frequency * mean)
    }

    /// Angle, speed and acceleration at time `t` [s].
    pub fn motion(&self, t: f64) -> Motion {
        let k = self.modulus();
        let (sn, cn, _) = jacobi(self.frequency * (t + 0.25 * self.period()), k);
        let position = 2.0 * (k * sn).asin();
        let speed = 2.0 * k * self.frequency * cn;
        Motion { position, speed, acceleration: -self.frequency.powi(2) * position.sin() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_constant_and_the_swing_closes() {
        let pendulum = Pendulum { frequency: 3.1, amplitude: 2.4 };
        let energy = |t: f64| {
            let m = pendulum.motion(t);
            0.5 * m.speed * m.speed - 3.1 * 3.1 * m.position.cos()
        };
        for k in 0..20 {
            // A few rounding errors of numbers of order 20.
            assert!((energy(0.17 * f64::from(k)) - energy(0.0)).abs() < 1e-13);
        }
        assert!((pendulum.motion(0.0).position - 2.4).abs() < 1e-13);
        assert!((pendulum.motion(pendulum.period()).position - 2.4).abs() < 1e-13);
        // Speed is the derivative of the angle: central difference, error h² / 6 * angle''' = 1e-10 * 30.
        let h = 1e-5;
        let slope = (pendulum.motion(0.3 + h).position - pendulum.motion(0.3 - h).position) / (2.0 * h);
        assert!((slope - pendulum.motion(0.3).speed).abs() < 1e-8);
    }
}
