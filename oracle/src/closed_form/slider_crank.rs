//! The slider-crank, with offset.

use super::Motion;

/// Crank pivot at the origin, slider pin on the line y = `offset`, on the side of positive x. Lengths [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderCrank {
    /// Crank radius.
    pub crank: f64,
    /// Connecting rod.
    pub rod: f64,
    /// Height of the slider's line.
    pub offset: f64,
}

/// Motion of rod and slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderMotion {
    /// Angle from the x axis to the rod, seen from the crank pin [rad].
    pub rod: Motion,
    /// Slider pin along x [m].
    pub slider: Motion,
}

impl SliderCrank {
    /// Motion of rod and slider for a motion of the crank. NaN where the rod is too short.
    pub fn motion(&self, crank: Motion) -> SliderMotion {
        let Self { crank: r, rod: l, offset } = *self;
        let (sin, cos) = crank.position.sin_cos();
        let (w, alpha) = (crank.speed, crank.acceleration);
        // Height of the crank pin above the line, and the rod's projection on the line.
        let (s, v, a) = (r * sin - offset, r * cos * w, r * cos * alpha - r * sin * w * w);
        let reach = (l * l - s * s).sqrt();
        let reach_speed = -s * v / reach;
        let reach_acceleration = -(v * v + s * a + reach_speed * reach_speed) / reach;
        let rod_speed = -v / reach;
        SliderMotion {
            rod: Motion {
                position: (-s).atan2(reach),
                speed: rod_speed,
                acceleration: -(a + rod_speed * reach_speed) / reach,
            },
            slider: Motion {
                position: r * cos + reach,
                speed: -r * sin * w + reach_speed,
                acceleration: -r * sin * alpha - r * cos * w * w + reach_acceleration,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_fit_positions() {
        let slider = SliderCrank { crank: 0.1, rod: 0.3, offset: 0.04 };
        let at = |t: f64| {
            slider.motion(Motion {
                position: 0.7 + 3.0 * t - t * t,
                speed: 3.0 - 2.0 * t,
                acceleration: -2.0,
            })
        };
        let h = 1e-6;
        let (low, now, high) = (at(0.3 - h), at(0.3), at(0.3 + h));
        for part in [|m: SliderMotion| m.rod, |m: SliderMotion| m.slider] {
            // Central differences: h² / 6 times third derivatives of order 10, and rounding / h = 1e-10.
            let speed = (part(high).position - part(low).position) / (2.0 * h);
            let acceleration = (part(high).speed - part(low).speed) / (2.0 * h);
            assert!((speed - part(now).speed).abs() < 1e-9);
            assert!((acceleration - part(now).acceleration).abs() < 1e-8);
        }
    }
}
