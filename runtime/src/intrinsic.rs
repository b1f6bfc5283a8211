//! Series-safe functions that symbolic closures need. Branch-free through `select`.
//! In: scalars. Out: scalars, finite with finite derivatives also where the textbook formula is 0/0.
#![expect(clippy::excessive_precision, reason = "digits as computed with many more")]

use crate::scalar::Scalar;

/// Coefficients of asin(s)/s in powers of s²: (2n)! / (4^n (n!)² (2n + 1)).
const ARCSINE: [f64; 8] = [
    1.0,
    1.0 / 6.0,
    3.0 / 40.0,
    15.0 / 336.0,
    105.0 / 3_456.0,
    945.0 / 42_240.0,
    10_395.0 / 599_040.0,
    135_135.0 / 9_676_800.0,
];

/// Below this sin² theta the series is used: its first left-out term is 0.0116 * 2^-64.
const SMALL_SINE_SQUARED: f64 = 0.003_906_25;

/// theta / sin theta for theta in [0, pi) from sin² theta and cos theta.
///
/// Relative error below 4 ulp. The two arguments need not fulfil s + c² = 1 exactly: near zero only
/// sin² counts, elsewhere theta = atan2(sqrt(sin²), cos).
#[inline]
pub fn angle_over_sine<T: Scalar>(sine_squared: T, cosine: T) -> T {
    let c = T::constant;
    // Past a right angle a small sine is not a small angle.
    let size = T::select(cosine.lt(c(0.0)), c(1.0), sine_squared);
    let small = size.lt(c(SMALL_SINE_SQUARED));
    let series = horner(&ARCSINE, sine_squared);
    // The side that is not chosen must not make infinities: dual numbers would carry them over as NaN.
    let sine = T::select(small, c(1.0), sine_squared).sqrt();
    T::select(small, series, sine.atan2(cosine) / sine)
}

/// Coefficients of b(x) - 2/(4 pi² - x) - 2/(16 pi² - x) in powers of x:
/// 2 (zeta(2n) - 1 - 4^-n) / (2 pi)^2n, n = 1, 2, ...
const REMAINDER: [f64; 16] = [
    2.000_759_355_687_222_6e-2,
    2.543_812_068_862_562_2e-5,
    5.584_568_390_494_415e-8,
    1.408_824_157_476_104_7e-10,
    3.756_716_200_215_798e-13,
    1.028_012_537_536_046e-15,
    2.850_022_129_213_791_2e-18,
    7.955_575_410_719_845e-21,
    2.228_932_664_553_701e-23,
    6.257_471_150_805_772e-26,
    1.758_673_049_290_968e-28,
    4.945_846_950_057_939e-31,
    1.391_382_678_908_088e-33,
    3.915_044_252_645_314_4e-36,
    1.101_726_891_467_142e-38,
    3.100_542_691_770_737_4e-41,
];

/// The coefficient b of phi^2 (phi^ the skew matrix of the rotation vector) in the inverse right
/// Jacobian of SO(3), `J_r^-1 = 1 + phi^/2 + b phi^2`, `rank` times differentiated by x = theta² [rad²]:
/// b(x) = 1/x - (1 + cos theta) / (2 theta sin theta).
///
/// Uses the partial fractions b(x) = sum over k >= 1 of 2 / ((2 pi k)² - x): the two nearest poles in
/// closed form, the rest as a power series. All terms are positive, so nothing cancels and there is no
/// switch: relative error below 2e-15 for rank 0 to 2 and 0 <= theta <= pi.
#[inline]
pub fn log_coefficient<T: Scalar>(rank: u8, theta_squared: T) -> T {
    const TURN_SQUARED: f64 = 4.0 * core::f64::consts::PI * core::f64::consts::PI;
    let rank = usize::from(rank);
    let factorial = (1..=rank).fold(1.0, |product, i| product * i as f64);
    let pole = |place: f64| {
        let reciprocal = T::constant(1.0) / (T::constant(place) - theta_squared);
        (0..rank).fold(T::constant(2.0 * factorial) * reciprocal, |power, _| power * reciprocal)
    };
    let mut rest = T::constant(0.0);
    for power in (rank..REMAINDER.len()).rev() {
        let slope = (0..rank).fold(1.0, |product, i| product * (power - i) as f64);
        rest = rest * theta_squared + T::constant(slope * REMAINDER[power]);
    }
    pole(TURN_SQUARED) + (pole(4.0 * TURN_SQUARED) + rest)
}

#[inline(always)]
fn horner<T: Scalar>(coefficients: &[f64], x: T) -> T {
    coefficients.iter().rev().fold(T::constant(0.0), |sum, coefficient| sum * x + T::constant(*coefficient))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;

    fn relative(value: f64, exact: f64) -> f64 {
        ((value - exact) / exact).abs()
    }

    /// x and b, b', b'' by 60-digit arithmetic (mpmath 1.3) from the textbook formula.
    const LOG_COEFFICIENT: [(f64, [f64; 3]); 5] = [
        (1e-6, [0.083_333_334_722_222_255_3, 0.001_388_888_955_026_457_51, 6.613_757_109_788_384_84e-5]),
        (0.25, [0.083_682_635_354_059_895, 0.001_405_579_605_540_907_76, 6.739_346_978_361_557_39e-5]),
        (2.25, [0.086_635_728_261_318_658_2, 0.001_551_278_087_027_640_98, 7.869_810_152_343_017e-5]),
        (6.25, [0.093_545_316_549_094_286_5, 0.001_924_487_152_352_497_94, 1.102_899_987_821_005_57e-4]),
        (9.61, [0.100_703_542_735_565_753, 0.002_359_330_781_250_743_48, 1.514_613_143_193_613_13e-4]),
    ];

    #[test]
    fn log_coefficient_agrees_with_high_precision_to_a_few_ulp() {
        for (x, exact) in LOG_COEFFICIENT {
            for (rank, exact) in (0_u8..).zip(exact) {
                // Up to nine rounded operations on positive terms: the function promises 2e-15.
                assert!(relative(log_coefficient(rank, x), exact) < 2e-15, "rank {rank} at {x}");
            }
        }
        assert!(relative(log_coefficient(0, 0.0), 1.0 / 12.0) < 1e-15);
        assert!(relative(log_coefficient(1, 0.0), 1.0 / 720.0) < 1e-15);
        assert!(relative(log_coefficient(2, 0.0), 2.0 / 30_240.0) < 1e-15);
    }

    #[test]
    fn each_rank_is_the_derivative_of_the_one_before() {
        for i in 0..=40 {
            let x = Dual::variable(f64::from(i) * 0.25);
            for rank in 0..3 {
                let slope = log_coefficient(rank, x).derivative;
                // Dual arithmetic rounds a few times more than the direct formula.
                assert!(relative(slope, log_coefficient(rank + 1, x.value)) < 4e-15);
            }
        }
    }

    /// sin², cos, theta / sin theta by 60-digit arithmetic from these doubles.
    const ANGLE_OVER_SINE: [(f64, f64, f64); 8] = [
        (1e-18, 1.0, 1.0),
        (0.000_899_730_032_397_917_2, 0.999_550_033_748_987_5, 1.000_150_015_751_494_754),
        (0.003_595_682_073_066_873_5, 0.998_200_539_935_204_2, 1.000_600_252_095_692_401),
        (0.003_913_643_780_567_519, 0.998_041_259_778_087_8, 1.000_653_425_392_209_266),
        (0.708_073_418_273_571_2, 0.540_302_305_868_139_8, 1.188_395_105_778_121_177),
        (0.826_821_810_431_805_9, -0.416_146_836_547_142_4, 2.199_500_340_589_233_021),
        (0.019_914_856_674_816_99, -0.989_992_496_600_445_4, 21.258_502_187_211_558_33),
        (7.041_538_791_385_784e-12, -0.999_999_999_996_479_3, 1_183_901.900_689_290_961),
    ];

    #[test]
    fn angle_over_sine_agrees_with_high_precision_to_a_few_ulp() {
        for (sine_squared, cosine, exact) in ANGLE_OVER_SINE {
            // Square root, atan2 and quotient round once each: 4 ulp.
            assert!(relative(angle_over_sine(sine_squared, cosine), exact) < 4.0 * f64::EPSILON, "{exact}");
        }
        assert_eq!(angle_over_sine(0.0, 1.0), 1.0);
    }

    #[test]
    fn angle_over_sine_has_a_finite_derivative_at_zero_and_at_the_switch() {
        let slope = |s: f64| {
            let cosine = (1.0 - s).sqrt();
            angle_over_sine(Dual::variable(s), Dual::new(cosine, -0.5 / cosine)).derivative
        };
        assert!(relative(slope(0.0), 1.0 / 6.0) < 1e-15);
        let (below, above) = (slope(SMALL_SINE_SQUARED * 0.999_999_999), slope(SMALL_SINE_SQUARED));
        // Over the step of 4e-12 in s the slope itself changes by 3.5e-12 (f''/f' = 0.9); the closed
        // form's derivative adds 256 roundings, 6e-14.
        assert!(relative(below, above) < 4e-12, "{below} {above}");
    }
}
