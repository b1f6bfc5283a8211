//! Wheels by their pitch circles, and belts round them. In: centres, axes, radii. Out: places to draw lines between. Never knows
//! teeth or forces.

use std::f64::consts::TAU;

use serde::Serialize;

use super::vector::{cross, dot, minus, norm, plus};

/// A circle on a body.
#[derive(Debug, Serialize)]
pub struct Circle {
    pub body: usize,
    pub centre: [f64; 3],
    /// Across its plane.
    pub axis: [f64; 3],
    pub radius: f64,
    /// Whether the other wheel is inside it.
    pub hollow: bool,
}

/// A belt round two circles.
#[derive(Debug, Serialize)]
pub struct Belt {
    pub circles: [usize; 2],
    pub crossed: bool,
}

/// Points of a circle that is drawn.
const ROUND: usize = 48;

impl Circle {
    /// Places around it, the last one the first.
    pub fn places(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let helper = if self.axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let across = cross(self.axis, helper);
        let first = across.map(|x| x / norm(across));
        let second = cross(self.axis, first);
        (0..=ROUND).map(move |at| {
            #[allow(clippy::cast_precision_loss, reason = "small whole numbers")]
            let (sine, cosine) = (TAU * at as f64 / ROUND as f64).sin_cos();
            [0, 1, 2].map(|i| self.centre[i] + self.radius * (cosine * first[i] + sine * second[i]))
        })
    }
}

impl Belt {
    /// Its two straight parts, between circles with these centres and radii and an axis of length one; nothing if one circle is
    /// within the other.
    pub fn straights(
        &self,
        axis: [f64; 3],
        [first, second]: [([f64; 3], f64); 2],
    ) -> Option<[[[f64; 3]; 2]; 2]> {
        let between = minus(second.0, first.0);
        let apart = minus(between, axis.map(|x| x * dot(axis, between)));
        let distance = norm(apart);
        let turned = if self.crossed { -1.0 } else { 1.0 };
        let sine = (first.1 - turned * second.1) / distance;
        let cosine = (1.0 - sine * sine).sqrt();
        let along = apart.map(|x| x / distance);
        let across = cross(axis, along);
        let part = |side: f64| {
            let normal = [0, 1, 2].map(|i| sine * along[i] + side * cosine * across[i]);
            [(first, 1.0), (second, turned)]
                .map(|((centre, radius), sign)| plus(centre, normal.map(|x| sign * radius * x)))
        };
        (cosine > 0.0).then(|| [part(1.0), part(-1.0)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight parts touch both circles and stand across the radii there.
    #[test]
    fn belts_touch_their_pulleys() {
        let (axis, ends) = ([0.0, 0.0, 1.0], [([0.0, 0.0, 0.0], 0.1), ([0.3, 0.4, 0.0], 0.05)]);
        for crossed in [false, true] {
            let belt = Belt { circles: [0, 1], crossed };
            let straights = belt.straights(axis, ends).expect("the pulleys are apart");
            for straight in straights {
                for ((centre, radius), place) in ends.into_iter().zip(straight) {
                    let arm = minus(place, centre);
                    assert!((norm(arm) - radius).abs() < 1e-12, "rounding of numbers below 1");
                    assert!(dot(arm, minus(straight[1], straight[0])).abs() < 1e-12, "the same");
                }
            }
            // The middle line is on one side of both pulleys' arms, or between them.
            let [from, to] = straights[0];
            let side = |place: [f64; 3], centre| cross([0.3, 0.4, 0.0], minus(place, centre))[2];
            assert_eq!(side(from, ends[0].0) * side(to, ends[1].0) < 0.0, crossed);
        }
        let within = Belt { circles: [0, 1], crossed: false };
        assert!(within.straights(axis, [([0.0; 3], 0.1), ([0.01, 0.0, 0.0], 0.05)]).is_none());
    }
}
