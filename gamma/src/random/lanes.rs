//! Draws of the Gamma law in log space, of several streams at once. In: places of the streams, shapes. Out: the bits that
//! [`LnGamma`](super::LnGamma) draws there first, one in each lane, whatever is in the others. Never knows wear.
//!
//! The method accepts its first candidate 95 times in 100 and more; a lane whose candidate is refused, whose shape is below 1, or
//! that has a number where `libm` branches, is left to the plain draw.

use super::width::{LANES, Numbers};
use super::{blocks, elementary};

/// exp(ln G - offset), G ~ Gamma(shape, 1), at the start of a cycle of each trajectory, with the streams of a seed and a joint;
/// and which lanes have it. The others are to be drawn one by one.
pub(crate) fn gamma_draws(
    streams: (u64, u64),
    trajectories: &[u64; LANES],
    cycles: &[u64; LANES],
    shapes: &Numbers,
    offset: f64,
) -> (Numbers, [bool; LANES]) {
    let [first, second, third] =
        blocks::first_numbers(streams, trajectories, cycles).map(|words| words.map(open01));
    let ln_first = elementary::ln(&first);
    let (cosines, mut holds) = elementary::cos(&second.map(|turn| 2.0 * core::f64::consts::PI * turn));
    let z: Numbers = std::array::from_fn(|lane| (-2.0 * ln_first[lane]).sqrt() * cosines[lane]);
    let d = shapes.map(|shape| shape - 1.0 / 3.0);
    let root: Numbers = std::array::from_fn(|lane| 1.0 + 1.0 / (9.0 * d[lane]).sqrt() * z[lane]);
    for lane in 0..LANES {
        // Not a number fails here too.
        holds[lane] &= (root[lane] > 1e-300) & (shapes[lane] >= 1.0) & (shapes[lane] < 1e300);
    }
    // What does not hold must not panic: any positive number does.
    let [safe_root, safe_d] =
        [&root, &d].map(|all| std::array::from_fn(|lane| if holds[lane] { all[lane] } else { 1.0 }));
    let ln_v = elementary::ln(&safe_root).map(|ln| 3.0 * ln);
    let (ln_third, ln_d) = (elementary::ln(&third), elementary::ln(&safe_d));
    for lane in 0..LANES {
        let (z, d, root) = (z[lane], d[lane], root[lane]);
        let v = root * root * root;
        holds[lane] &= ln_third[lane] < 0.5 * z * z + d - d * v + d * ln_v[lane];
    }
    let (drawn, are_plain) = elementary::exp(&std::array::from_fn(|lane| (ln_d[lane] + ln_v[lane]) - offset));
    for lane in 0..LANES {
        holds[lane] &= are_plain[lane];
    }
    (drawn, holds)
}

/// As `rand::distr::Open01` makes it of 64 random bits: (n + 1/2) 2^-52.
#[inline(always)]
fn open01(bits: u64) -> f64 {
    f64::from_bits((bits >> 12) | 1.0_f64.to_bits()) - (1.0 - 0.5 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::random::{LnGamma, Stream};

    #[test]
    fn lanes_draw_what_their_streams_draw() {
        let (seed, joint, offset) = (5, 1, 2.6);
        for shape in [1.0, 1.5, 7.0, 43.68, 1e6, 1e15, 0.5, 0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut held = 0;
            for round in 0..500_u64 {
                let trajectories = std::array::from_fn(|lane| round * LANES as u64 + lane as u64);
                let cycles = std::array::from_fn(|lane| (round + 3 * lane as u64) % 29);
                let shapes = std::array::from_fn(|lane| shape * (1.0 + 0.1 * lane as f64));
                let (drawn, holds) = gamma_draws((seed, joint), &trajectories, &cycles, &shapes, offset);
                for lane in (0..LANES).filter(|lane| holds[*lane]) {
                    let mut stream = Stream::new(seed, trajectories[lane], joint);
                    let one = libm::exp(stream.at(cycles[lane]).sample(LnGamma(shapes[lane])) - offset);
                    assert_eq!(drawn[lane].to_bits(), one.to_bits(), "{shape}, {round}, {lane}");
                    held += 1;
                }
            }
            // The first candidate is accepted with 95 % at shape 1, more above; below 1 never.
            let expected = if (1.0..1e300).contains(&shape) { 3700..=4000 } else { 0..=0 };
            assert!(expected.contains(&held), "{shape}: {held} of 4000");
        }
    }
}
