//! Adaptive Gauss-Kronrod integration of several smooth integrands at once. In: functions and limits. Out: integrals
//! and the estimate of their error. Never knows what they mean.

/// Nodes and weights of the 15-point Kronrod rule on (-1, 1), and weights of the 7-point Gauss rule inside it
/// (QUADPACK, Piessens et al. 1983); the last node is the centre.
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// Halvings of an interval before its rest is taken as it is.
const DEEPEST: u32 = 40;

/// Pieces of one integral; a few hundred do. Where rounding keeps the estimate above the tolerance, halving would not end.
const MOST: usize = 20_000;

/// Integrals of `f` over neighbouring pieces of `limits` (ascending), and the sum of the error estimates of each.
/// A piece is halved until the estimate is below `tolerance[i]` times its share of the whole length.
pub fn integrate<const N: usize>(
    f: &dyn Fn(f64) -> [f64; N],
    limits: &[f64],
    tolerance: [f64; N],
) -> ([f64; N], [f64; N]) {
    let (mut sums, mut errors, mut pieces) = ([0.0; N], [0.0; N], 0);
    let length = limits.last().copied().unwrap_or(0.0) - limits.first().copied().unwrap_or(0.0);
    for pair in limits.windows(2) {
        let mut left = vec![(pair[0], pair[1], 0)];
        while let Some((a, b, depth)) = left.pop() {
            let (values, error) = rule(f, a, b);
            pieces += 1;
            // Half the share: errors of many pieces add up.
            let good = (0..N).all(|i| error[i] <= tolerance[i] * ((b - a) / length).max(1e-3));
            if good || depth >= DEEPEST || pieces >= MOST {
                for i in 0..N {
                    sums[i] += values[i];
                    errors[i] += error[i];
                }
            } else {
                let middle = 0.5 * (a + b);
                left.push((middle, b, depth + 1));
                left.push((a, middle, depth + 1));
            }
        }
    }
    (sums, errors)
}

/// One interval: the Kronrod sums, and how far the Gauss sums are from them.
fn rule<const N: usize>(f: &dyn Fn(f64) -> [f64; N], a: f64, b: f64) -> ([f64; N], [f64; N]) {
    let (centre, half) = (0.5 * (a + b), 0.5 * (b - a));
    let (mut kronrod, mut gauss) = ([0.0; N], [0.0; N]);
    for (k, node) in NODES.iter().enumerate() {
        let mut values = f(centre + half * node);
        if *node > 0.0 {
            let mirrored = f(centre - half * node);
            for i in 0..N {
                values[i] += mirrored[i];
            }
        }
        for i in 0..N {
            kronrod[i] += half * KRONROD[k] * values[i];
            if k % 2 == 1 {
                gauss[i] += half * GAUSS[k / 2] * values[i];
            }
        }
    }
    let mut error = [0.0; N];
    for i in 0..N {
        error[i] = (kronrod[i] - gauss[i]).abs();
    }
    (kronrod, error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_integral_whose_tolerance_is_below_its_rounding_ends_and_says_its_error() {
        // Noise of a part in 1e6, as rounding makes it.
        let noisy = |t: f64| [1.0 + 1e-6 * f64::from((t.to_bits() % 1009) as u32) / 1009.0];
        let (sums, errors) = integrate(&noisy, &[0.0, 1.0], [1e-14]);
        assert!((sums[0] - 1.0).abs() < 2e-6 && errors[0] > 1e-14, "{sums:?} {errors:?}");
    }

    #[test]
    fn a_steep_step_is_integrated_to_the_tolerance() {
        // Logistic of width 1e-3 at 0.3: integral of 1 - step over (0, 1) is 0.3 but for e^-300.
        let step = |t: f64| [1.0 / (1.0 + ((t - 0.3) / 1e-3).exp()), t];
        let (sums, errors) = integrate(&step, &[0.0, 1.0], [1e-12, 1e-12]);
        assert!((sums[0] - 0.3).abs() < 1e-12 && (sums[1] - 0.5).abs() < 1e-12, "{sums:?}");
        // At most a thousand pieces at a thousandth of the tolerance each, besides the shares.
        assert!(errors[0] < 2e-12);
    }
}
