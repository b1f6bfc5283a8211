//! Order statistics. In: ascending values. Out: quantiles. Never knows what they are of.

/// Quantile of ascending values by linear interpolation (type 7 of Hyndman & Fan 1996), `p` in \[0, 1\].
pub fn sorted_quantile(sorted: &[f64], p: f64) -> f64 {
    quantile_of(sorted.len(), |rank| sorted[rank], p)
}

/// The same of so many values, at least one, by their rank.
pub fn quantile_of(count: usize, value: impl Fn(usize) -> f64, p: f64) -> f64 {
    let place = p * (count - 1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the length")]
    let below = place.floor() as usize;
    let above = (below + 1).min(count - 1);
    value(below) + (place - below as f64) * (value(above) - value(below))
}
