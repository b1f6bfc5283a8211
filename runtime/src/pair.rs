//! Unevaluated sums of two doubles, about 31 decimal digits: what tests measure functions against.

/// The sum of both, the second less than the last place of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair(pub(crate) f64, pub(crate) f64);

pub(crate) fn exact_sum(a: f64, b: f64) -> Pair {
    let s = a + b;
    let t = s - a;
    Pair(s, (a - (s - t)) + (b - t))
}

pub(crate) fn exact_product(a: f64, b: f64) -> Pair {
    let p = a * b;
    Pair(p, f64::mul_add(a, b, -p))
}

/// ln 2.
const LN2: Pair = Pair(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);

impl Pair {
    pub(crate) fn plus(self, other: Self) -> Self {
        let s = exact_sum(self.0, other.0);
        let t = exact_sum(self.1, other.1);
        let u = exact_sum(s.0, s.1 + t.0);
        exact_sum(u.0, u.1 + t.1)
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(Self(-other.0, -other.1))
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let p = exact_product(self.0, other.0);
        exact_sum(p.0, p.1 + (self.0 * other.1 + self.1 * other.0))
    }

    pub(crate) fn over(self, divisor: f64) -> Self {
        let q = self.0 / divisor;
        let p = exact_product(q, divisor);
        let rest = ((self.0 - p.0) - p.1) + self.1;
        exact_sum(q, rest / divisor)
    }

    /// first + first z / ((offset + 2)(offset + 1)) + ...: Taylor series of sine and cosine, with z = -x².
    pub(crate) fn alternate_series(first: Self, z: Self, offset: f64) -> Self {
        let (mut term, mut sum) = (first, first);
        for n in 1..16 {
            let n = 2.0 * f64::from(n) + offset;
            term = term.times(z).over(n * (n - 1.0));
            sum = sum.plus(term);
        }
        sum
    }

    /// e to the power of `x`, of normal numbers.
    pub(crate) fn exp(x: f64) -> Self {
        let k = (x / LN2.0).round();
        let r = Self(x, 0.0).minus(exact_product(k, LN2.0)).minus(exact_product(k, LN2.1));
        let (mut term, mut sum) = (Self(1.0, 0.0), Self(1.0, 0.0));
        for n in 1..30 {
            term = term.times(r).over(f64::from(n));
            sum = sum.plus(term);
        }
        let half = (0.5 * k).floor();
        let scale = |x: f64| libm::scalbn(libm::scalbn(x, half as i32), (k - half) as i32);
        Self(scale(sum.0), scale(sum.1))
    }

    /// The natural logarithm by a step of Newton's from that of doubles.
    pub(crate) fn ln(x: f64) -> Self {
        let k = libm::ilogb(x);
        let significand = libm::scalbn(libm::scalbn(x, -(k / 2)), -(k - k / 2));
        let (near, k) = (libm::log(significand), f64::from(k));
        let off = Self(significand, 0.0).times(Self::exp(-near)).minus(Self(1.0, 0.0));
        let step = off.minus(off.times(off).over(2.0));
        exact_product(k, LN2.0).plus(exact_product(k, LN2.1)).plus(Self(near, 0.0)).plus(step)
    }

    /// The angle of a vector by a step of Newton's from that of doubles.
    pub(crate) fn atan2(y: f64, x: f64) -> Self {
        let near = libm::atan2(y, x);
        let size = libm::ilogb(y.abs().max(x.abs()));
        let [y, x] = [y, x].map(|value| libm::scalbn(value, -size));
        if y.abs() < 1e-9 * x {
            return Self(y, 0.0).over(x).times(Self(1.0, 0.0).minus(exact_product(y / x, y / x).over(3.0)));
        }
        // By half of the angle, where both series are short.
        let half = Self(0.5 * near, 0.0);
        let z = half.times(Self(-half.0, 0.0));
        let (s, c) = (Self::alternate_series(half, z, 1.0), Self::alternate_series(Self(1.0, 0.0), z, 0.0));
        let (sine, cosine) = (s.times(c), c.times(c).minus(s.times(s)));
        let sine = sine.plus(sine);
        let across = cosine.times(Self(y, 0.0)).minus(sine.times(Self(x, 0.0)));
        let along = cosine.times(Self(x, 0.0)).plus(sine.times(Self(y, 0.0)));
        Self(near, 0.0).plus(across.over(along.0))
    }
}

/// Error in units of the last place of the exact value.
pub(crate) fn ulps(value: f64, exact: Pair) -> f64 {
    let spacing = f64::from_bits(exact.0.abs().to_bits() + 1) - exact.0.abs();
    (((value - exact.0) - exact.1) / spacing).abs()
}

/// So many pairs of a number in [0, 1) and a sign, the same in every run.
pub(crate) fn sweep(count: u32, mut visit: impl FnMut(f64, f64)) {
    let mut state = 1_u64;
    for i in 0..count {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let unit = (state >> 11) as f64 / 9_007_199_254_740_992.0;
        visit(unit, if i % 2 == 0 { 1.0 } else { -1.0 });
    }
}
