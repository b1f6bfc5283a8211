//! The logarithm of the Gamma function. In and out: numbers. Never knows wear.

/// Euler's constant.
pub const EULER: f64 = 0.577_215_664_901_532_9;

/// ln Gamma(x), x > 0.
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}

/// ln Gamma(x) less Stirling's (x - 1/2) ln x - x + ln(2 pi) / 2, for large x, where the difference has no digits left.
pub fn stirling_rest(x: f64) -> f64 {
    let square = 1.0 / (x * x);
    (1.0 / 12.0
        - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square * (1.0 / 1680.0 - square / 1188.0))))
        / x
}

/// Shape from which on densities are taken by Stirling's series: at a scatter of a hundredth. As written they are differences of numbers
/// of the size of the shape, which leaves no digits for a climb to go by.
pub const LARGE_SHAPE: f64 = 1e4;

/// ln of a ratio that is 1 + `off`: by this where it is near 1, by the ratio where that has digits of `off` no longer.
pub fn ln_ratio(off: f64, ratio: f64) -> f64 {
    if off.abs() < 0.5 { libm::log1p(off) } else { libm::log(ratio) }
}

/// ln Gamma(1 + x), x > -1, right to the last digits at tiny x, where ln Gamma(1 + x) as written has lost x.
pub fn ln_gamma_1p(x: f64) -> f64 {
    if x.abs() >= 0.1 {
        return ln_gamma(1.0 + x);
    }
    // Sum of zeta(k) (-x)^k / k; term 15 is below 1e-16 of the first at x = 0.1.
    const ZETA: [f64; 14] = [
        1.644_934_066_848_226_4,
        1.202_056_903_159_594_3,
        1.082_323_233_711_138_2,
        1.036_927_755_143_37,
        1.017_343_061_984_449,
        1.008_349_277_381_922_8,
        1.004_077_356_197_944_3,
        1.002_008_392_826_082_2,
        1.000_994_575_127_818_1,
        1.000_494_188_604_119_5,
        1.000_246_086_553_308,
        1.000_122_713_347_578_5,
        1.000_061_248_135_058_7,
        1.000_030_588_236_307,
    ];
    let series = ZETA.iter().enumerate().rev().fold(0.0, |sum, (at, zeta)| {
        // Coefficient of x^(at + 2), sign (-1)^(at + 2).
        let sign = if at % 2 == 0 { 1.0 } else { -1.0 };
        sum * x + sign * zeta / (at + 2) as f64
    });
    x * (x * series - EULER)
}

/// ln(1 - exp(x)) for x <= 0, right at both ends.
pub(super) fn ln_1m_exp(x: f64) -> f64 {
    if x > -core::f64::consts::LN_2 { libm::log(-libm::expm1(x)) } else { libm::log1p(-libm::exp(x)) }
}
