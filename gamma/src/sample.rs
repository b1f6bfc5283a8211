//! Gamma variates as logarithms. In: shape, stream. Out: ln G. Never knows wear.
//!
//! Wear of one cycle may have a shape of 1e-8: nearly all draws are then below the smallest number there is, and only
//! their logarithm can be told. Everything runs through `libm`, so that debug and release give the same bits.

use crate::stream::Stream;

/// ln of a draw from Gamma(shape, rate 1), shape above 0: Marsaglia and Tsang (ACM Trans. Math. Softw. 26 (2000)
/// 363-372); below 1 by G(a) = G(a + 1) U^(1/a).
pub fn ln_gamma_variate(shape: f64, stream: &mut Stream) -> f64 {
    if shape < 1.0 {
        let boost = libm::log(stream.uniform()) / shape;
        return ln_gamma_variate(shape + 1.0, stream) + boost;
    }
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / libm::sqrt(9.0 * d);
    loop {
        let z = stream.normal();
        let root = 1.0 + c * z;
        if root > 0.0 {
            let v = root * root * root;
            let ln_v = 3.0 * libm::log(root);
            if libm::log(stream.uniform()) < 0.5 * z * z + d * (1.0 - v + ln_v) {
                return libm::log(d) + ln_v;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::{gamma_p, ln_gamma};

    /// P(ln G <= x): where e^x is small, the first terms of the series of the lower function, in logarithms.
    fn distribution(shape: f64, x: f64) -> f64 {
        if x < -30.0 {
            // P(a, y) = y^a / Gamma(a + 1) (1 - a y / (a + 1) ...); y < 1e-13 leaves the first term.
            return (shape * x - ln_gamma(shape + 1.0)).exp();
        }
        gamma_p(shape, x.exp())
    }

    #[test]
    fn logarithms_follow_the_exact_law_for_shapes_down_to_1e_8() {
        let count = 20_000;
        for (trajectory, shape) in [1e-8, 1e-4, 0.1, 1.0, 50.0].into_iter().enumerate() {
            let mut stream = Stream::new(11, trajectory as u64, 0);
            let mut drawn: Vec<f64> = (0..count).map(|_| ln_gamma_variate(shape, &mut stream)).collect();
            assert!(drawn.iter().all(|ln| ln.is_finite()), "{shape}");
            drawn.sort_by(f64::total_cmp);
            let n = f64::from(count);
            let miss = |(at, ln): (usize, &f64)| {
                let p = distribution(shape, *ln);
                (p - at as f64 / n).abs().max(((at + 1) as f64 / n - p).abs())
            };
            let distance = drawn.iter().enumerate().map(miss).fold(0.0, f64::max);
            // Kolmogorov-Smirnov, level 1e-3: 1.949 / sqrt(n).
            assert!(distance < 1.949 / n.sqrt(), "{shape}: {distance}");
        }
    }

    #[test]
    fn no_shape_gives_infinity_or_nan() {
        for shape in [1e-8, 1e-3, 1.0, 1e3, 1e6, 1e12] {
            for trajectory in 0..2_000 {
                let ln = ln_gamma_variate(shape, &mut Stream::new(0, trajectory, 0));
                assert!(ln.is_finite(), "{shape}, {trajectory}: {ln}");
            }
        }
    }
}
