//! The root of a rising function. In and out: numbers. Never knows the function.

/// A step of Newton's method within a bracket that may still be open: where it leaves the bracket, its middle, or one unit
/// from `x` towards the open end.
pub(crate) fn guarded(next: f64, x: f64, (low, high): (f64, f64)) -> f64 {
    if next > low && next < high {
        return next;
    }
    match (low.is_finite(), high.is_finite()) {
        (true, true) => 0.5 * (low + high),
        (true, false) => x + 1.0,
        _ => x - 1.0,
    }
}

/// Positive root of a rising function, looked for from `start` > 0 on by doubling and halving, then by the method of
/// C. J. F. Ridders (1979): halving with exponential correction. Relative accuracy 1e-13.
pub(crate) fn rising_root(f: &dyn Fn(f64) -> f64, start: f64) -> f64 {
    let mut high = start;
    while f(high) < 0.0 && high < f64::MAX / 4.0 {
        high *= 2.0;
    }
    let mut low = 0.5 * high;
    while f(low) > 0.0 && low > 1e-300 {
        high = low;
        low *= 0.5;
    }
    let (mut f_low, mut f_high) = (f(low), f(high));
    for _ in 0..80 {
        if f_low == 0.0 {
            return low;
        }
        if f_high == 0.0 {
            return high;
        }
        let middle = 0.5 * (low + high);
        if high - low <= 1e-13 * middle {
            break;
        }
        let f_middle = f(middle);
        let spread = (f_middle * f_middle - f_low * f_high).sqrt();
        let step = if spread > 0.0 { (middle - low) * f_middle / spread } else { 0.0 };
        let better = (middle - step).clamp(low, high);
        let f_better = f(better);
        for (t, value) in [(middle, f_middle), (better, f_better)] {
            if value <= 0.0 && t > low {
                (low, f_low) = (t, value);
            }
            if value >= 0.0 && t < high {
                (high, f_high) = (t, value);
            }
        }
    }
    0.5 * (low + high)
}
