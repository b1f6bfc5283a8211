//! Logarithm, exponential and cosine of several numbers at once, without branches. In: numbers of the ranges that draws have.
//! Out: the bits that `libm` gives, which are those of FreeBSD's `e_log.c`, `e_exp.c`, `s_cos.c`, `k_sin.c` and `k_cos.c` (Sun
//! Microsystems, 1993); a mask where a number is in none of these ranges. Never knows what they are for.
#![expect(clippy::excessive_precision, reason = "digits as published")]

use super::width::{LANES, Numbers};

const LN2_HIGH: f64 = 6.931_471_803_691_238_164_90e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_700_02e-10;
/// 2^52: the bits of a whole number below it, put under its exponent.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// A function in each lane: a plain loop, which compilers make one of vectors.
#[inline(always)]
fn each(x: &Numbers, f: impl Fn(f64) -> f64) -> Numbers {
    let mut values = [0.0; LANES];
    for (value, x) in values.iter_mut().zip(x) {
        *value = f(*x);
    }
    values
}

/// Natural logarithms of positive normal numbers.
#[inline]
pub(super) fn ln(x: &Numbers) -> Numbers {
    each(x, ln_of)
}

#[inline(always)]
fn ln_of(x: f64) -> f64 {
    const LG1: f64 = 6.666_666_666_666_735_130e-1;
    const LG2: f64 = 3.999_999_999_940_941_908e-1;
    const LG3: f64 = 2.857_142_874_366_239_149e-1;
    const LG4: f64 = 2.222_219_843_214_978_396e-1;
    const LG5: f64 = 1.818_357_216_161_805_012e-1;
    const LG6: f64 = 1.531_383_769_920_937_332e-1;
    const LG7: f64 = 1.479_819_860_511_658_591e-1;
    /// The high word of sqrt(2)/2.
    const ROOT_HALF: u64 = 0x3fe6_a09e << 32;
    const ONE: u64 = 0x3ff << 52;
    // x = 2^k (1 + f), 1 + f from sqrt(2)/2 to sqrt(2).
    let moved = x.to_bits() + (ONE - ROOT_HALF);
    let k = f64::from_bits(WHOLE.to_bits() | (moved >> 52)) - (WHOLE + 1023.0);
    let f = f64::from_bits((moved & ((1 << 52) - 1)) + ROOT_HALF) - 1.0;
    let half_square = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (LG2 + w * (LG4 + w * LG6));
    let odd = z * (LG1 + w * (LG3 + w * (LG5 + w * LG7)));
    s * (half_square + (odd + even)) + k * LN2_LOW - half_square + f + k * LN2_HIGH
}

/// Exponentials, and whether a number was within -700 and 700 and not too near to 0.
#[inline]
pub(super) fn exp(x: &Numbers) -> (Numbers, [bool; LANES]) {
    (each(x, exp_of), x.map(|x| (x.abs() < 700.0) & (x.abs() > 1e-8)))
}

#[inline(always)]
fn exp_of(x: f64) -> f64 {
    const P1: f64 = 1.666_666_666_666_660_190_37e-1;
    const P2: f64 = -2.777_777_777_701_559_338_42e-3;
    const P3: f64 = 6.613_756_321_437_934_361_17e-5;
    const P4: f64 = -1.653_390_220_546_525_153_90e-6;
    const P5: f64 = 4.138_136_797_057_238_460_39e-8;
    /// 1.5 * 2^52: adding it leaves a whole number of either sign in the last bits.
    const SIGNED: f64 = 6_755_399_441_055_744.0;
    // Beyond these high words k is 1, and what is nearest.
    let (half, more) = (f64::from_bits(0x3fd6_2e43 << 32), f64::from_bits(0x3ff0_a2b2 << 32));
    let sign = f64::copysign(1.0, x);
    let nearest = core::f64::consts::LOG2_E * x + 0.5 * sign;
    // Towards zero, as a conversion to whole numbers goes.
    let rounded = (nearest.abs() + WHOLE) - WHOLE;
    let down = if rounded > nearest.abs() { rounded - 1.0 } else { rounded };
    let beyond = if x.abs() >= more { sign * down } else { sign };
    let k = if x.abs() >= half { beyond } else { 0.0 };
    let (high, low) = (x - k * LN2_HIGH, k * LN2_LOW);
    let r = high - low;
    let square = r * r;
    let c = r - square * (P1 + square * (P2 + square * (P3 + square * (P4 + square * P5))));
    let y = 1.0 + (r * c / (2.0 - c) - low + high);
    let whole = (k + SIGNED).to_bits().wrapping_sub(SIGNED.to_bits());
    y * f64::from_bits(whole.wrapping_add(1023) << 52)
}

/// Cosines of angles from 0 to 2 pi [rad], and whether an angle was not almost a multiple of pi/2.
#[inline]
pub(super) fn cos(x: &Numbers) -> (Numbers, [bool; LANES]) {
    /// High words that stand for multiples of pi/2, which `libm` takes apart in more words.
    const MULTIPLES: [u64; 4] = [0x3ff9_21fb, 0x4009_21fb, 0x4012_d97c, 0x4019_21fb];
    let is_multiple = |x: f64| MULTIPLES.iter().any(|word| x.to_bits() >> 32 == *word);
    (each(x, cos_of), x.map(|x| !is_multiple(x)))
}

#[inline(always)]
fn cos_of(x: f64) -> f64 {
    const PIO2_1: f64 = 1.570_796_326_734_125_614_17;
    const PIO2_1_TAIL: f64 = 6.077_100_506_506_192_249_32e-11;
    /// The high words up to which a number of quarter turns is taken away.
    const LAST: [u64; 4] = [0x3fe9_21fb, 0x4002_d97c, 0x400f_6a7a, 0x4015_fdbc];
    let mut quarters = 0.0;
    for last in LAST {
        quarters += if x >= f64::from_bits((last + 1) << 32) { 1.0 } else { 0.0 };
    }
    let (z, w) = (x - quarters * PIO2_1, quarters * PIO2_1_TAIL);
    let high = z - w;
    let low = (z - high) - w;
    let (sine, cosine) = (kernel_sin(high, low), kernel_cos(high, low));
    let is_odd = (quarters == 1.0) | (quarters == 3.0);
    let is_minus = (quarters == 1.0) | (quarters == 2.0);
    let value = if is_odd { sine } else { cosine };
    if is_minus { -value } else { value }
}

#[inline(always)]
fn kernel_sin(x: f64, low: f64) -> f64 {
    let z = x * x;
    let w = z * z;
    let r = 8.333_333_333_322_489_461_24e-3
        + z * (-1.984_126_982_985_794_931_34e-4 + z * 2.755_731_370_707_006_767_89e-6)
        + z * w * (-2.505_076_025_340_686_341_95e-8 + z * 1.589_690_995_211_550_102_21e-10);
    let v = z * x;
    x - ((z * (0.5 * low - v * r) - low) - v * -1.666_666_666_666_663_243_48e-1)
}

#[inline(always)]
fn kernel_cos(x: f64, low: f64) -> f64 {
    let z = x * x;
    let w = z * z;
    let r = z
        * (4.166_666_666_666_660_190_37e-2
            + z * (-1.388_888_888_887_410_957_49e-3 + z * 2.480_158_728_947_672_941_78e-5))
        + w * w
            * (-2.755_731_435_139_066_330_35e-7
                + z * (2.087_572_321_298_174_827_90e-9 + z * -1.135_964_755_778_819_482_65e-11));
    let half = 0.5 * z;
    let rough = 1.0 - half;
    rough + (((1.0 - rough) - half) + (z * r - x * low))
}

#[cfg(test)]
mod tests {
    use rand::{Rng, RngExt};

    use super::*;
    use crate::random::Stream;

    /// `f` has the bits of `libm` at numbers made of random ones, wherever it says it has.
    fn assert_bits(
        name: &str,
        f: impl Fn(&Numbers) -> (Numbers, [bool; LANES]),
        of: fn(f64) -> f64,
        make: impl Fn(f64, u64) -> f64,
    ) {
        let mut stream = Stream::new(17, 0, 0);
        let mut held = 0;
        for _ in 0..50_000 {
            let x: Numbers = std::array::from_fn(|_| make(stream.random(), stream.next_u64()));
            let (found, holds) = f(&x);
            for lane in (0..LANES).filter(|lane| holds[*lane]) {
                assert_eq!(found[lane].to_bits(), of(x[lane]).to_bits(), "{name} of {:e}", x[lane]);
                held += 1;
            }
        }
        assert!(held > 390_000, "{name} refuses too much: {held}");
    }

    #[test]
    fn logarithms_have_the_bits_of_libm() {
        let always = |x: &Numbers| (ln(x), [true; LANES]);
        assert_bits("ln", always, libm::log, |part, _| part.max(1e-300));
        // Every exponent of a normal number.
        let any =
            |_: f64, bits: u64| f64::from_bits((bits & ((1 << 63) - 1)).clamp(1 << 52, (0x7ff << 52) - 1));
        assert_bits("ln", always, libm::log, any);
        assert_bits("ln", always, libm::log, |part, _| 1.0 + 1e-8 * (part - 0.5));
        assert_eq!(ln(&[1.0; LANES])[0].to_bits(), 0);
    }

    #[test]
    fn exponentials_have_the_bits_of_libm() {
        for size in [1e-6, 0.1, 0.7, 1.1, 3.0, 30.0, 699.0] {
            assert_bits("exp", exp, libm::exp, |part, _| size * (2.0 * part - 1.0));
        }
        // Half-way between two powers of two, where rounding decides.
        assert_bits("exp", exp, libm::exp, |part, bits| {
            let at = ((bits % 1000) as f64 - 500.0 + 0.5) * core::f64::consts::LN_2;
            at * (1.0 + 1e-15 * (part - 0.5))
        });
    }

    #[test]
    fn cosines_have_the_bits_of_libm() {
        let turn = 2.0 * core::f64::consts::PI;
        assert_bits("cos", cos, libm::cos, |part, _| turn * part);
        assert_bits("cos", cos, libm::cos, |part, _| 1e-7 * part);
        // Beside odd multiples of pi/4, where the quadrant changes.
        assert_bits("cos", cos, libm::cos, |part, bits| {
            let at = (2.0 * (bits % 4) as f64 + 1.0) * core::f64::consts::FRAC_PI_4;
            at * (1.0 + 1e-5 * (part - 0.5))
        });
    }
}
