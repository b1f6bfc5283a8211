//! A curve in one line of text.

const LEVELS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The values as a line of at most `width` blocks, lowest to highest; constant curves are a low line.
/// Each block shows the value at its middle, so that nothing is averaged away but peaks between.
pub fn sparkline(values: &[f64], width: usize) -> String {
    let (low, high) = range(values);
    let width = width.min(values.len());
    (0..width)
        .map(|block| {
            let value = values[(2 * block + 1) * values.len() / (2 * width)];
            let part = if high > low { (value - low) / (high - low) } else { 0.0 };
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 8")]
            let level = (part * 8.0) as usize;
            LEVELS[level.min(7)]
        })
        .collect()
}

/// Smallest and largest value.
pub fn range(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_climbs_through_all_levels() {
        let ramp: Vec<f64> = (0..16).map(f64::from).collect();
        assert_eq!(sparkline(&ramp, 8), "▁▂▃▄▅▆▇█");
        assert_eq!(sparkline(&[1.0, 1.0], 8), "▁▁");
        assert_eq!(sparkline(&[], 8), "");
    }
}
